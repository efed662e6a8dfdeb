// SPDX-License-Identifier: MIT
// One axis of a texel position: the product of a wrapped coordinate and a level's size becomes one or two
// texels within the level, and a fraction (docs/reference/texture/formats.md, "Addresses").
`include "tokens.svh"
`include "tables.svh"
module texel_axis #(
  parameter integer BITS = `SAMPLE_TOKEN_S_BITS + 13
) (
  input  logic signed [BITS-1:0] product,  // 24 fraction bits
  input  logic [12:0]            size,
  input  logic [1:0]             wrap,
  input  logic                   linear,
  output logic [11:0]            first,
  output logic [11:0]            second,
  output logic [7:0]             fraction
);
  localparam integer WHOLE = BITS - 24;
  // Minus half a texel, rounded to 8 fraction bits; the nearest texel is truncated.
  localparam logic signed [BITS-1:0] HALF = 8388608, UP = 32768;  // 2^23, 2^15
  wire signed [BITS-1:0] rounded = product - HALF + UP;
  localparam logic signed [WHOLE-1:0] ZERO = 0, ONE = 1;
  wire signed [WHOLE-1:0] low = linear ? rounded[BITS-1:24] : product[BITS-1:24];
  wire signed [WHOLE-1:0] high = linear ? low + ONE : low;
  wire signed [WHOLE-1:0] end_of = $signed({{(WHOLE - 13) {1'b0}}, size});
  wire signed [WHOLE-1:0] last = end_of - ONE;
  wire signed [WHOLE-1:0] low_in = low < 0 ? (wrap == `WRAP_REPEAT ? last : ZERO) : low > last ? last : low;
  wire signed [WHOLE-1:0] high_in = high < 0 ? ZERO : high > last ? (wrap == `WRAP_REPEAT ? ZERO : last) : high;
  wire unused = &{1'b0, rounded[15:0], low_in[WHOLE-1:12], high_in[WHOLE-1:12]};
  assign first = low_in[11:0];
  assign second = high_in[11:0];
  assign fraction = linear ? rounded[23:16] : 8'd0;
endmodule
