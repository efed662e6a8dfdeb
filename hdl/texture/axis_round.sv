// SPDX-License-Identifier: MIT
// One component of an axis: the magnitude of the sum is rounded at 7 bits and then gets its sign, so that mirrored
// coordinates give mirrored samples (docs/reference/texture/formats.md, "Axes").
module axis_round (
  input  logic signed [41:0] sum,
  output logic signed [33:0] axis  // S9.24
);
  wire [41:0] magnitude = sum < 0 ? -sum : sum;
  wire [41:0] rounded = magnitude + 42'd64;
  wire signed [33:0] positive = rounded[40:7];
  wire unused = &{1'b0, rounded[41], rounded[6:0]};
  assign axis = sum < 0 ? -positive : positive;
endmodule
