// SPDX-License-Identifier: MIT
// Applies the wrap mode to a coordinate: U0.24, or unchanged S9.24 for clamping (docs/reference/texture/formats.md,
// "Addresses").
`include "tables.svh"
module wrap_coordinate (
  input  logic signed [33:0] position,  // S9.24
  input  logic [1:0]         wrap,
  output logic signed [33:0] wrapped
);
  wire [24:0] mirrored = position[24] ? ~position[24:0] : position[24:0];
  assign wrapped = wrap == `WRAP_REPEAT ? {10'd0, position[23:0]} :
                   wrap == `WRAP_MIRRORED_REPEAT ? {9'd0, mirrored} : position;
endmodule
