// SPDX-License-Identifier: MIT
// One channel of the colours of a BC block: the smaller end point, and how far the other three colours are above it
// (docs/reference/texture/compressed.md, "BC"). With the difference d = 3 q + rest, (2 p + q) / 3 is the smaller end
// point plus floor(d / 3) or floor(2 d / 3): one division of 8 bits.
`include "tables.svh"
module bc_channel #(
  parameter integer BC = `CHOSEN_BC,
  parameter integer BITS = 6
) (
  input  logic            clk,
  input  logic            move,
  input  logic [BITS-1:0] first, second,  // end points a and b
  output logic            above, same,    // a > b, a = b; in stage 1
  input  logic            three_1,        // three colours
  output logic            swapped,        // the smaller one is b; the outputs from here on are in stage 2
  output logic [7:0]      base,
  output logic [7:0]      step_1, step_2, step_3
);
  localparam logic ROUNDED = BC == `BC_ROUNDED;

  // 1: end points in order, widened; their order is the same before and after it.
  assign above = first > second;
  assign same = first == second;
  wire [BITS-1:0] low = above ? second : first, high = above ? first : second;
  wire [7:0] wide_low, wide_high;
  genvar v;
  generate
    if (ROUNDED) begin : g_rounded
      wire [8*(1<<BITS)-1:0] wide;
      for (v = 0; v < 1 << BITS; v = v + 1) begin : g_value
        localparam logic [31:0] SUM = BITS == 5 ? 527 * v + 23 : 259 * v + 33;
        assign wide[8*v +: 8] = SUM[13:6];
      end
      assign wide_low = wide[{low, 3'd0} +: 8];
      assign wide_high = wide[{high, 3'd0} +: 8];
    end else begin : g_truncated
      assign wide_low = {low, low[BITS-1:2*BITS-8]};
      assign wide_high = {high, high[BITS-1:2*BITS-8]};
    end
  endgenerate
  always_ff @(posedge clk)
    if (move) begin
      swapped <= above;
      base <= wide_low;
      step_3 <= wide_high - wide_low;
    end

  // 2: division by 3.
  wire [6:0] quotient;
  wire [2:0] rest;
  bc_divide #(.STEPS(7)) divide (
    .divisor(3'd3), .rest_in({2'd0, step_3[7]}), .dividend(step_3[6:0]), .quotient, .rest);
  wire unused = rest[2];
  wire [7:0] half = {1'b0, step_3[7:1]} + {7'd0, ROUNDED && step_3[0]};
  assign step_1 = three_1 ? half : {1'b0, quotient} + {7'd0, ROUNDED && rest[1]};
  assign step_2 = three_1 ? half : {quotient, rest[1] || (ROUNDED && rest[0])};
endmodule
