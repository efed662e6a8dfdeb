// SPDX-License-Identifier: MIT
// Length of one side of a footprint by the configurations without a root, in two stages: first from its components
// (`low`, `high`, to be registered), then the longer of both results (docs/reference/texture/formats.md, "Footprint").
`include "tables.svh"
module side_length #(
  parameter integer RULE = `CHOSEN_FOOTPRINT
) (
  input  logic [30:0] s,
  input  logic [30:0] t,
  output logic [31:0] low,  // U16.16
  output logic [31:0] high
);
  wire [30:0] a = s > t ? s : t;
  wire [30:0] b = s > t ? t : s;
  generate
    if (RULE == `FOOTPRINT_HALF) begin : g_half
      assign low = {1'b0, a} + {2'b0, b[30:1]};
      assign high = low;
      wire unused = &{1'b0, b[0]};
    end else if (RULE == `FOOTPRINT_QUARTER) begin : g_quarter
      assign low = {1'b0, a} + {3'b0, b[30:2]};
      assign high = low;
      wire unused = &{1'b0, b[1:0]};
    end else if (RULE == `FOOTPRINT_TWO_SEGMENT) begin : g_two_segment
      assign low = {1'b0, a} + {4'b0, b[30:3]};
      assign high = {1'b0, a} - {4'b0, a[30:3]} + {2'b0, b[30:1]};
      wire unused = &{1'b0, b[0]};
    end else begin : g_max
      assign low = {1'b0, a};
      assign high = low;
      wire unused = &{1'b0, b};
    end
  endgenerate
endmodule
