// SPDX-License-Identifier: MIT
// Decodes four texels of a compressed block per cycle, in three stages: the part of a BlockDecoder that exists once per
// block (docs/reference/texture/compressed.md). A channel of a texel is the clamped sum of a row, of steps and of an
// offset, so BC, ETC2 and its planar blocks share the adders:
//
//   BC               row: the smaller end point; 0 to 3 steps towards the other one
//   BC5, ETC2        row: an end point or colour; offset
//   planar           row: of y; x steps of H - O
//   alpha, BC4, BC5  an end point or base, and an offset
//
// Rows and steps have two bits of fraction. An offset has a sign and 8 bits; a negative one is complemented, as the
// fraction of a row makes up for the missing one. 255 clamps to 255, and -255 to 0.
`include "tables.svh"
module block_decoder #(
  parameter integer BC = `CHOSEN_BC
) (
  input  logic         clk,
  input  logic         move,
  input  logic [127:0] block,      // byte 0 lowest; a block of 8 bytes is the lower half
  input  logic [3:0]   format,
  input  logic [15:0]  positions,  // 4 y + x of each texel
  output logic [127:0] texels      // alpha, blue, green, red of each; two cycles after the block
);
  // 1: selectors of the four texels: bits 1 and 0 for colours, 4 to 2 for values, 7 to 5 for values in the upper half.
  wire is_etc = format >= `FORMAT_ETC2_RGB;
  wire [63:0] colours = format == `FORMAT_BC3 || format == `FORMAT_ETC2_RGBA8 ? block[127:64] : block[63:0];
  wire [63:0] big_colours, big_values;  // byte 0 highest
  wire [127:0] planes;                  // of each bit 16 texels
  logic [31:0] selectors_1;
  genvar i, b, c, t;
  generate
    for (i = 0; i < 8; i = i + 1) begin : g_byte
      assign big_colours[8*i +: 8] = colours[56-8*i +: 8];
      assign big_values[8*i +: 8] = block[56-8*i +: 8];
    end
    for (i = 0; i < 16; i = i + 1) begin : g_select
      localparam integer TURNED = 4 * (i % 4) + i / 4;
      for (b = 0; b < 2; b = b + 1) begin : g_colour
        assign planes[16*b+i] = is_etc ? big_colours[16*b+TURNED] : colours[32+2*i+b];
      end
      for (b = 0; b < 3; b = b + 1) begin : g_value
        assign planes[32+16*b+i] = is_etc ? big_values[45-3*TURNED+b] : block[16+3*i+b];
        assign planes[80+16*b+i] = block[80+3*i+b];
      end
    end
    for (b = 0; b < 8; b = b + 1) begin : g_plane
      wire [15:0] plane = planes[16*b +: 16];
      for (t = 0; t < 4; t = t + 1) begin : g_texel
        always_ff @(posedge clk)
          if (move) selectors_1[8*t+b] <= plane[positions[4*t +: 4]];
      end
    end
  endgenerate
  logic [3:0] format_1;
  logic [15:0] positions_1;
  always_ff @(posedge clk)
    if (move) begin
      format_1 <= format;
      positions_1 <= positions;
    end

  // 2: summands of the texels.
  wire [7:0] of_colours;
  wire [11:0] of_values, of_seconds;
  generate
    for (t = 0; t < 4; t = t + 1) begin : g_of
      assign {of_seconds[3*t +: 3], of_values[3*t +: 3], of_colours[2*t +: 2]} = selectors_1[8*t +: 8];
    end
  endgenerate
  wire [23:0] bc_base, bc_step_1, bc_step_2, bc_step_3;
  wire [2:0] bc_swapped;
  wire [7:0] bc_count, bc_alpha, etc_rows, etc_alpha;
  wire [3:0] bc_hole;
  wire [35:0] bc_offsets, bc_alphas, etc_offsets, etc_alphas;
  wire [29:0] etc_row_0, etc_row_1, etc_row_2, etc_row_3;
  wire [32:0] etc_step_1, etc_step_3;
  wire planar;
  bc_decoder #(.BC(BC)) bc (
    .clk, .move, .block, .format, .format_1, .selectors_1(of_colours), .codes_1(of_values), .seconds_1(of_seconds),
    .base(bc_base), .step_1(bc_step_1), .step_2(bc_step_2), .step_3(bc_step_3), .swapped(bc_swapped),
    .count(bc_count), .hole(bc_hole), .offsets(bc_offsets), .alpha_base(bc_alpha), .alpha_offsets(bc_alphas));
  etc2_decoder etc2 (
    .clk, .move, .colours(big_colours), .alpha(big_values[63:48]), .format, .format_1, .positions_1,
    .selectors_1(of_colours), .codes_1(of_values), .row_0(etc_row_0), .row_1(etc_row_1), .row_2(etc_row_2),
    .row_3(etc_row_3), .rows(etc_rows), .step_1(etc_step_1), .step_3(etc_step_3), .planar, .offsets(etc_offsets),
    .alpha_base(etc_alpha), .alpha_offsets(etc_alphas));
  wire etc_1 = format_1 >= `FORMAT_ETC2_RGB;
  logic [3:0] format_2;
  logic [29:0] row[0:3];
  logic [32:0] step[1:3];
  logic [2:0] swapped_2;
  logic [7:0] rows_2, counts_2, alpha_2;
  logic [3:0] steps_2;  // a texel has steps; otherwise it has an offset
  logic [35:0] offsets_2, alphas_2;
  integer k;
  always_ff @(posedge clk)
    if (move) begin
      format_2 <= format_1;
      for (k = 0; k < 3; k = k + 1) begin
        row[0][10*k +: 10] <= etc_1 ? etc_row_0[10*k +: 10] : {bc_base[8*k +: 8], 2'd2};
        step[1][11*k +: 11] <= etc_1 ? etc_step_1[11*k +: 11] : {1'b0, bc_step_1[8*k +: 8], 2'd0};
        step[2][11*k +: 11] <= etc_1 ? {etc_step_1[11*k +: 10], 1'b0} : {1'b0, bc_step_2[8*k +: 8], 2'd0};
        step[3][11*k +: 11] <= etc_1 ? etc_step_3[11*k +: 11] : {1'b0, bc_step_3[8*k +: 8], 2'd0};
      end
      row[1] <= etc_row_1;
      row[2] <= etc_row_2;
      row[3] <= etc_row_3;
      rows_2 <= etc_rows & {8{etc_1}};
      swapped_2 <= bc_swapped & {3{!etc_1}};
      for (k = 0; k < 4; k = k + 1) begin
        counts_2[2*k +: 2] <= etc_1 ? positions_1[4*k +: 2] : bc_count[2*k +: 2];
        steps_2[k] <= etc_1 ? planar : format_1 != `FORMAT_BC5 && !bc_hole[k];
      end
      offsets_2 <= etc_1 ? etc_offsets : bc_offsets;
      alpha_2 <= etc_1 ? etc_alpha : bc_alpha;
      alphas_2 <= etc_1 ? etc_alphas : bc_alphas;
    end

  // 3: texels.
  wire one_value = format_2 == `FORMAT_BC4;
  wire two_values = format_2 == `FORMAT_BC5;
  generate
    for (t = 0; t < 4; t = t + 1) begin : g_texel
      wire [23:0] colour;
      for (c = 0; c < 3; c = c + 1) begin : g_channel
        wire [1:0] count = counts_2[2*t +: 2] ^ {2{swapped_2[c]}};
        wire [9:0] from = row[rows_2[2*t +: 2]][10*c +: 10];
        wire [10:0] steps = (step[1][11*c +: 11] & {11{count == 2'd1}}) | (step[2][11*c +: 11] & {11{count == 2'd2}}) |
                            (step[3][11*c +: 11] & {11{count == 2'd3}});
        wire [10:0] more = steps_2[t] ? steps : {offsets_2[9*t +: 9], {2{offsets_2[9*t+8]}}};
        wire [11:0] sum = {2'd0, from} + {more[10], more};
        assign colour[8*c +: 8] = sum[11] ? 8'd0 : sum[10] ? 8'd255 : sum[9:2];
        wire unused = &{1'b0, sum[1:0]};
      end
      wire [10:0] sum = {2'd0, alpha_2, 1'b1} + {alphas_2[9*t+8], alphas_2[9*t +: 9], alphas_2[9*t+8]};
      wire [7:0] value = sum[10] ? 8'd0 : sum[9] ? 8'd255 : sum[8:1];
      wire unused = &{1'b0, sum[0]};
      assign texels[32*t +: 32] = one_value ? {8'd255, value, value, value} :
                                  two_values ? {16'hff00, colour[15:8], value} : {value, colour};
    end
  endgenerate
endmodule
