// SPDX-License-Identifier: MIT
// Applies the wrap mode to a coordinate: U0.24, or unchanged S9.24 (S10.24) for clamping
// (docs/reference/texture/formats.md, "Addresses").
`include "tokens.svh"
`include "tables.svh"
module wrap_coordinate #(
  parameter integer BITS = `SAMPLE_TOKEN_S_BITS
) (
  input  logic signed [BITS-1:0] position,
  input  logic [1:0]             wrap,
  output logic signed [BITS-1:0] wrapped
);
  wire [24:0] mirrored = position[24] ? ~position[24:0] : position[24:0];
  assign wrapped = wrap == `WRAP_REPEAT ? {{(BITS - 24) {1'b0}}, position[23:0]} :
                   wrap == `WRAP_MIRRORED_REPEAT ? {{(BITS - 25) {1'b0}}, mirrored} : position;
endmodule
