// SPDX-License-Identifier: MIT
// One axis of a texel position: the product of a wrapped coordinate and a level's size becomes one or two
// texels within the level, and a fraction (docs/reference/texture/formats.md, "Addresses").
`include "tables.svh"
module texel_axis (
  input  logic signed [46:0] product,  // 24 fraction bits
  input  logic [12:0]        size,
  input  logic [1:0]         wrap,
  input  logic               linear,
  output logic [11:0]        first,
  output logic [11:0]        second,
  output logic [7:0]         fraction
);
  // Minus half a texel, rounded to 8 fraction bits; the nearest texel is truncated.
  wire signed [46:0] rounded = product - 47'sd8388608 + 47'sd32768;  // 2^23, 2^15
  wire signed [22:0] low = linear ? rounded[46:24] : product[46:24];
  wire signed [22:0] high = linear ? low + 23'sd1 : low;
  wire signed [22:0] end_of = $signed({10'd0, size});
  wire signed [22:0] last = end_of - 23'sd1;
  wire signed [22:0] low_in = low < 0 ? (wrap == `WRAP_REPEAT ? last : 23'sd0) : low > last ? last : low;
  wire signed [22:0] high_in = high < 0 ? 23'sd0 :
                               high > last ? (wrap == `WRAP_REPEAT ? 23'sd0 : last) : high;
  wire unused = &{1'b0, rounded[15:0], low_in[22:12], high_in[22:12]};
  assign first = low_in[11:0];
  assign second = high_in[11:0];
  assign fraction = linear ? rounded[23:16] : 8'd0;
endmodule
