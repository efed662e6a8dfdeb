// SPDX-License-Identifier: MIT
// The multiples of a component for the eight directions, by 128, 118, 90 and 49, the first in the lowest bits.
`include "tables.svh"
module axis_multiples #(
  parameter integer BITS = 41
) (
  input  logic signed [BITS-1:0] value,
  output logic [4*BITS-1:0]      multiples
);
  wire signed [BITS-1:0] by_118 = value * `AXIS_COSINE_1, by_90 = value * `AXIS_COSINE_2;
  wire signed [BITS-1:0] by_49 = value * `AXIS_COSINE_3;
  assign multiples = {by_49, by_90, by_118, value <<< 7};
endmodule
