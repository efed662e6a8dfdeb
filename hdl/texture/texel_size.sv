// SPDX-License-Identifier: MIT
// Magnitude of a derivative in texels: the product of a difference and a size, U20.24, rounded to 16
// fraction bits and saturated to 2^31 - 1 (docs/reference/texture/formats.md).
module texel_size (
  input  logic signed [46:0] product,
  output logic [30:0]        size,
  output logic               saturated
);
  wire [46:0] magnitude = product < 0 ? -product : product;
  wire [46:0] rounded = magnitude + 47'd128;
  wire unused = &{1'b0, rounded[7:0]};
  assign saturated = rounded[46:39] != 8'd0;
  assign size = saturated ? 31'h7FFFFFFF : rounded[38:8];
endmodule
