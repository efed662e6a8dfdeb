// SPDX-License-Identifier: MIT
// Values of a BC block for four texels (docs/reference/texture/compressed.md, "BC"). With the smaller end point as base
// and the difference d = n q + rest, n = 7 or 5, every value is base + k q + floor((k rest + r) / n), k = 0..n: one
// division per block, and a product of 3 x 6 bits per texel.
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
  // 1: end points in order, their difference.
  wire [7:0] a = ends[7:0], b = ends[15:8];
  wire falls = a > b;
  logic seven;
  logic [7:0] difference;
  always_ff @(posedge clk)
    if (move) begin
      seven <= falls;
      base <= falls ? b : a;
      difference <= (falls ? a : b) - (falls ? b : a);
    end

  // 2: long division by 7 or 5.
  logic [5:0] quotient;
  logic [2:0] rest;
  logic [3:0] twice;
  integer i;
  always_comb begin
    rest = {1'b0, difference[7:6]};
    for (i = 5; i >= 0; i = i - 1) begin
      twice = {rest, difference[i]};
      quotient[i] = twice >= (seven ? 4'd7 : 4'd5);
      if (quotient[i]) twice = twice + (seven ? 4'd1 : 4'd3);  // modulo 8
      rest = twice[2:0];
    end
  end

  // Entry {seven, k, rest}.
  wire [511:0] carries;
  genvar t;
  generate
    for (t = 0; t < 128; t = t + 1) begin : g_carry
      localparam logic [31:0] CARRY = (t / 8 % 8 * (t % 8) + (BC == `BC_ROUNDED ? 1 : 0)) / (t < 64 ? 5 : 7);
      assign carries[4*t +: 4] = CARRY[3:0];
    end
    for (t = 0; t < 4; t = t + 1) begin : g_texel
      wire [2:0] code = codes_1[3*t +: 3];
      logic [2:0] k;
      always_comb
        case (code)
          3'd0: k = seven ? 3'd7 : 3'd0;
          3'd1: k = seven ? 3'd0 : 3'd5;
          default: k = seven ? 3'd0 - code : code - 3'd1;
        endcase
      wire [7:0] offset = {5'd0, k} * {2'd0, quotient} + {4'd0, carries[{seven, k, rest, 2'd0} +: 4]};
      // 0 and 255: the clamp of block_decoder.
      assign offsets[9*t +: 9] = seven || code < 3'd6 ? {1'b0, offset} : code[0] ? 9'h0ff : 9'h100;
    end
  endgenerate
endmodule
