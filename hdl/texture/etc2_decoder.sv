// SPDX-License-Identifier: MIT
// Stages 1 and 2 of a BlockDecoder for the three forms of ETC2 (docs/reference/texture/compressed.md, "ETC2"). The
// outputs are the summands of block_decoder. All ports except the block and its format are in stage 2.
`include "tables.svh"
module etc2_decoder (
  input  logic        clk,
  input  logic        move,
  input  logic [63:0] colours,        // byte 0 highest
  input  logic [15:0] alpha,          // bytes 0 and 1 of etc2_rgba8
  input  logic [3:0]  format,
  input  logic [3:0]  format_1,
  input  logic [15:0] positions_1,    // of four texels
  input  logic [7:0]  selectors_1,
  input  logic [11:0] codes_1,        // selectors of alpha
  output logic [29:0] row_0, row_1,   // of each channel 10 bits: four times the two colours, or the start of a row of
  output logic [29:0] row_2, row_3,   // a planar block; plus 2, half of the divisor
  output logic [7:0]  rows,           // of each texel
  output logic [32:0] step_1, step_3, // of each channel 11 bits: one and three steps in x
  output logic        planar,
  output logic [35:0] offsets,
  output logic [7:0]  alpha_base,
  output logic [35:0] alpha_offsets
);
  // 1: mode, two colours of 8 bits per channel; of a planar block O, H and V.
  wire [5:0] red = {1'b0, colours[63:59]} + {{3{colours[58]}}, colours[58:56]};
  wire [5:0] green = {1'b0, colours[55:51]} + {{3{colours[50]}}, colours[50:48]};
  wire [5:0] blue = {1'b0, colours[47:43]} + {{3{colours[42]}}, colours[42:40]};
  wire individual = !colours[33] && format != `FORMAT_ETC2_RGB_A1;
  wire is_t = !individual && red[5];
  wire is_h = !individual && !red[5] && green[5];
  wire is_planar = !individual && !red[5] && !green[5] && blue[5];
  wire [11:0] first_4 = is_t ? {colours[60:59], colours[57:48]} :
                        is_h ? {colours[62:56], colours[52:51], colours[49:47]} :
                        {colours[63:60], colours[55:52], colours[47:44]};
  wire [11:0] second_4 = is_t ? colours[47:36] : is_h ? colours[46:35] :
                         {colours[59:56], colours[51:48], colours[43:40]};
  wire [23:0] planar_o = {colours[62:57], colours[62:61], colours[56], colours[54:49], colours[56],
                          colours[48], colours[44:43], colours[41:39], colours[48], colours[44]};
  wire [23:0] planar_h = {colours[38:34], colours[32], colours[38:37], colours[31:25], colours[31],
                          colours[24:19], colours[24:23]};
  wire four_bits = individual || is_t || is_h;
  logic [23:0] first, second;  // red highest
  logic [18:0] third;
  logic [7:0] tables;          // bits 39 to 32
  logic mode_t, mode_h, holes;
  always_ff @(posedge clk)
    if (move) begin
      first <= is_planar ? planar_o :
               four_bits ? {{2{first_4[11:8]}}, {2{first_4[7:4]}}, {2{first_4[3:0]}}} :
               {colours[63:59], colours[63:61], colours[55:51], colours[55:53], colours[47:43], colours[47:45]};
      second <= is_planar ? planar_h :
                four_bits ? {{2{second_4[11:8]}}, {2{second_4[7:4]}}, {2{second_4[3:0]}}} :
                {red[4:0], red[4:2], green[4:0], green[4:2], blue[4:0], blue[4:2]};
      third <= colours[18:0];
      tables <= colours[39:32];
      mode_t <= is_t;
      mode_h <= is_h;
      planar <= is_planar;
      holes <= format == `FORMAT_ETC2_RGB_A1 && !colours[33];
    end

  // 2: rows of a planar block: 4 O, 3 O + V, 2 O + 2 V, O + 3 V; a step is H - O.
  wire [23:0] planar_v = {third[18:13], third[18:17], third[12:6], third[12], third[5:0], third[5:4]};
  genvar c, t;
  generate
    for (c = 0; c < 3; c = c + 1) begin : g_channel
      wire [7:0] o = first[16-8*c +: 8], h = second[16-8*c +: 8], v = planar_v[16-8*c +: 8];
      wire [8:0] both = {1'b0, o} + {1'b0, v} + 9'd1;
      wire [10:0] step = {3'd0, h} - {3'd0, o};
      assign row_0[10*c +: 10] = {o, 2'd2};
      assign row_1[10*c +: 10] = planar ? {1'b0, both} + {1'b0, o, 1'b1} : {h, 2'd2};
      assign row_2[10*c +: 10] = {both, 1'b0};
      assign row_3[10*c +: 10] = {1'b0, both} + {1'b0, v, 1'b1};
      assign step_1[11*c +: 11] = step;
      assign step_3[11*c +: 11] = step + {step[9:0], 1'b0};
    end
  endgenerate

  // Offsets of the other modes, the same in all channels. Ends that are equal in the high bits are equal.
  localparam logic [127:0] MODIFIERS = `ETC_MODIFIERS;
  localparam logic [55:0] DISTANCES = `ETC_DISTANCES;
  wire falls = {first[23:20], first[15:12], first[7:4]} >= {second[23:20], second[15:12], second[7:4]};
  wire [2:0] of_distance = mode_t ? {tables[3:2], tables[0]} : {tables[2], tables[0], falls};
  wire [6:0] distance = DISTANCES[7*of_distance +: 7];

  // Alpha: the negative modifiers are the complements of the positive ones, of which the row has four.
  localparam logic [255:0] POSITIVES = `EAC_POSITIVES;
  logic [3:0] multiplier, table_of_alpha;
  always_ff @(posedge clk)
    if (move) {alpha_base, multiplier, table_of_alpha} <= alpha;
  wire [15:0] positives = POSITIVES[{table_of_alpha, 4'd0} +: 16];

  generate
    for (t = 0; t < 4; t = t + 1) begin : g_texel
      wire [1:0] selector = selectors_1[2*t +: 2];
      wire [3:0] position = positions_1[4*t +: 4];
      wire in_second = tables[0] ? position[3] : position[1];
      wire [2:0] of_modifier = in_second ? tables[4:2] : tables[7:5];
      wire [7:0] modifier = MODIFIERS[{of_modifier, selector[0], 3'd0} +: 8];
      wire second_colour = mode_t ? selector != 2'd0 : mode_h ? selector[1] : in_second;
      wire hole = holes && !planar && selector == 2'd2;
      wire none = planar || (mode_t && !selector[0]) || (holes && !mode_t && !mode_h && selector == 2'd0);
      wire negative = mode_h ? selector[0] : selector[1];
      wire [7:0] size = mode_t || mode_h ? {1'b0, distance} : modifier;
      assign rows[2*t +: 2] = planar ? position[3:2] : {1'b0, second_colour};
      assign offsets[9*t +: 9] = hole ? 9'h100 : none ? 9'd0 : {9{negative}} ^ {1'b0, size};

      wire [2:0] code = codes_1[3*t +: 3];
      wire [3:0] positive = positives[{code[1:0], 2'd0} +: 4];
      logic [7:0] product;
      integer i;
      always_comb begin
        product = {4'd0, multiplier & {4{!code[2]}}};
        for (i = 0; i < 4; i = i + 1) product = product + ({4'd0, positive & {4{multiplier[i]}}} << i);
      end
      assign alpha_offsets[9*t +: 9] = format_1 == `FORMAT_ETC2_RGBA8 ? {9{!code[2]}} ^ {1'b0, product} :
                                       {hole, {8{!hole}}};
    end
  endgenerate
endmodule
