// SPDX-License-Identifier: MIT
// For all components of a candidate: d equals the specified function of a and b computed with unlimited bits, is
// below 2^32, and lies between the longer component and the sum of both.
`include "tables.svh"
module side_length_proof #(
  parameter integer RULE = `FOOTPRINT_HALF
) (
  input logic [30:0] s,
  input logic [30:0] t
);
  logic [31:0] low, high;
  side_length #(.RULE(RULE)) unit (.s, .t, .low, .high);
  wire [39:0] d = low > high ? {8'd0, low} : {8'd0, high};
  wire [39:0] a = s > t ? {9'd0, s} : {9'd0, t}, b = s > t ? {9'd0, t} : {9'd0, s};
  wire [39:0] segment_1 = a + (b >> 3), segment_2 = a - (a >> 3) + (b >> 1);
  wire [39:0] rule = RULE == `FOOTPRINT_HALF ? a + (b >> 1) : RULE == `FOOTPRINT_QUARTER ? a + (b >> 2) :
                     RULE == `FOOTPRINT_MAX ? a : segment_1 > segment_2 ? segment_1 : segment_2;
  always @* begin
    a_rule: assert (d == rule);
    a_fits: assert (rule < 40'h100000000);
    a_between: assert (d >= a && d <= a + b);
  end
endmodule
