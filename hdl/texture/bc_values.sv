// SPDX-License-Identifier: MIT
// Values of a BC block for four texels (docs/reference/texture/compressed.md, "BC"). With the smaller end point as base
// and the difference d = n q + rest, n = 7 or 5, every value is base + k q + floor((k rest + r) / n), k = 0..n: one
// division and three sums per block.
`include "tables.svh"
module bc_values #(
  parameter integer BC = `CHOSEN_BC
) (
  input  logic        clk,
  input  logic        move,
  input  logic [15:0] ends,     // a in the lower byte
  input  logic [11:0] codes_1,  // selectors; this and the outputs are in stage 2
  output logic [7:0]  base,
  output logic [35:0] offsets   // of each texel, as in block_decoder
);
  // 1: difference of the end points, upper half of the quotient.
  wire [7:0] a = ends[7:0], b = ends[15:8];
  wire falls = a > b;
  wire [7:0] distance = falls ? a - b : b - a;
  wire [3:0] upper;
  wire [2:0] rest_of_upper;
  bc_divide #(.STEPS(4)) divide_upper (
    .divisor({1'b1, falls, 1'b1}), .rest_in({1'b0, distance[7:6]}), .dividend(distance[5:2]), .quotient(upper),
    .rest(rest_of_upper));
  logic seven;
  logic [7:0] difference;
  logic [3:0] upper_1;
  logic [2:0] rest_1;
  always_ff @(posedge clk)
    if (move) begin
      seven <= falls;
      base <= falls ? b : a;
      difference <= distance;
      upper_1 <= upper;
      rest_1 <= rest_of_upper;
    end

  // 2: lower half, multiples of the quotient.
  wire [1:0] lower;
  wire [2:0] rest;
  bc_divide #(.STEPS(2)) divide_lower (
    .divisor({1'b1, seven, 1'b1}), .rest_in(rest_1), .dividend(difference[1:0]), .quotient(lower), .rest);
  wire [7:0] quotient = {2'd0, upper_1, lower};
  wire [63:0] multiples;
  assign multiples[7:0] = 8'd0;
  assign multiples[63:56] = difference;
  genvar k, t;
  generate
    for (k = 1; k < 7; k = k + 1) begin : g_multiple
      wire [63:0] carries;  // entry {seven, rest}
      for (t = 0; t < 16; t = t + 1) begin : g_carry
        localparam integer N = t < 8 ? 5 : 7;
        localparam logic [31:0] CARRY = t % 8 < N ? (k * (t % 8) + (BC == `BC_ROUNDED ? 1 : 0)) / N : 0;
        assign carries[4*t +: 4] = CARRY[3:0];
      end
      wire [7:0] one = k % 2 == 1 ? quotient : 8'd0;
      wire [7:0] two = k / 2 % 2 == 1 ? quotient << 1 : 8'd0;
      wire [7:0] four = k >= 4 ? quotient << 2 : 8'd0;
      assign multiples[8*k +: 8] = one + two + four + {4'd0, carries[{seven, rest, 2'd0} +: 4]};
    end
    for (t = 0; t < 4; t = t + 1) begin : g_texel
      wire [2:0] code = codes_1[3*t +: 3];
      logic [2:0] count;
      always_comb
        case (code)
          3'd0: count = seven ? 3'd7 : 3'd0;
          3'd1: count = seven ? 3'd0 : 3'd5;
          default: count = seven ? 3'd0 - code : code - 3'd1;
        endcase
      // 0 and 255: the clamp of block_decoder.
      assign offsets[9*t +: 9] = !seven && code >= 3'd6 ? {!code[0], {8{code[0]}}} :
                                 {1'b0, multiples[{count, 3'd0} +: 8]};
    end
  endgenerate
endmodule
