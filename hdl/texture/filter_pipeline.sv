// SPDX-License-Identifier: MIT
// Filters four texels per cycle to the colour of a fragment: eight stages, nine with `srgb_output = encoded`
// (docs/reference/texture/formats.md; docs/reference/datasheets.md, "FilterPipeline").
`include "tokens.svh"
`include "tables.svh"
module filter_pipeline #(
  parameter integer COUNT = `CHOSEN_COUNT,
  parameter integer KERNEL = `CHOSEN_KERNEL,
  parameter integer OUTPUT = `CHOSEN_SRGB_OUTPUT
) (
  input  logic                              clk,
  input  logic                              rst_n,
  input  logic                              in_valid,
  output logic                              in_pop,
  input  logic [`TEXEL_QUAD_TOKEN_BITS-1:0] in_data,
  output logic                              out_push,
  input  logic                              out_ready,
  output logic [`COLOUR_BITS-1:0]           out_data
);
  // Only requests that complete a fragment proceed to the last registers.
  localparam integer LAST = OUTPUT == `SRGB_OUTPUT_ENCODED ? 8 : 7;
  logic [LAST:1] valid;
  wire move = out_ready || !valid[LAST];
  assign in_pop = in_valid && move;
  assign out_push = out_ready && valid[LAST];

  // With `kernel = axis`, the bit above N - 1 selects a tent.
  localparam integer COUNT_BITS = `TEXEL_QUAD_TOKEN_CONTROL_LAST_INDEX_BITS;

  // 1: fields. Passed on: ticket, sample index, N - 1, format, ends, weights of a request.
  logic [`TICKET_BITS:0] ticket[1:LAST];  // the highest bit: sRGB format
  wire [2:0] format = in_data[`TEXEL_QUAD_TOKEN_CONTROL_FORMAT];
  wire is_srgb = format == `FORMAT_SRGB8_A8;
  wire [127:0] texels = in_data[`TEXEL_QUAD_TOKEN_TEXEL];
  wire [127:0] channels;
  logic [127:0] codes_1;
  logic [7:0] u[1:2], v[1:4];
  logic [8:0] level_weight[1:5];
  logic [3:0] index[1:6];
  logic [COUNT_BITS-1:0] last_index[1:6];
  logic [6:1] end_of_sample, end_of_fragment;
  always_ff @(posedge clk)
    if (move) begin
      codes_1 <= channels;
      ticket[1] <= {is_srgb, in_data[`TEXEL_QUAD_TOKEN_TICKET]};
      u[1] <= in_data[`TEXEL_QUAD_TOKEN_CONTROL_FRACTION_U];
      v[1] <= in_data[`TEXEL_QUAD_TOKEN_CONTROL_FRACTION_V];
      level_weight[1] <= in_data[`TEXEL_QUAD_TOKEN_CONTROL_LEVEL_WEIGHT];
      index[1] <= in_data[`TEXEL_QUAD_TOKEN_CONTROL_INDEX];
      last_index[1] <= in_data[`TEXEL_QUAD_TOKEN_CONTROL_LAST_INDEX];
      end_of_sample <= {end_of_sample[5:1], in_data[`TEXEL_QUAD_TOKEN_CONTROL_LAST_OF_SAMPLE]};
      end_of_fragment <= {end_of_fragment[5:1], in_data[`TEXEL_QUAD_TOKEN_CONTROL_LAST_OF_FRAGMENT]};
    end
  genvar i;
  generate
    for (i = 0; i < 4; i = i + 1) begin : g_unpack
      texel_unpack unpack (.texel(texels[32*i +: 32]), .format, .channels(channels[32*i +: 32]));
    end
    for (i = 2; i <= LAST; i = i + 1) begin : g_ticket
      always_ff @(posedge clk)
        if (move) ticket[i] <= ticket[i-1];
    end
    for (i = 2; i <= 6; i = i + 1) begin : g_index
      always_ff @(posedge clk)
        if (move) begin
          index[i] <= index[i-1];
          last_index[i] <= last_index[i-1];
        end
    end
    for (i = 2; i <= 5; i = i + 1) begin : g_level
      always_ff @(posedge clk)
        if (move) level_weight[i] <= level_weight[i-1];
    end
    for (i = 2; i <= 4; i = i + 1) begin : g_v
      always_ff @(posedge clk)
        if (move) v[i] <= v[i-1];
    end
  endgenerate
  always_ff @(posedge clk)
    if (move) u[2] <= u[1];

  always_ff @(posedge clk)
    if (!rst_n) valid <= {LAST{1'b0}};
    else if (move) begin
      valid[6:1] <= {valid[5:1], in_valid};
      valid[7] <= valid[6] && end_of_fragment[6];
      if (LAST > 7) valid[LAST] <= valid[LAST-1];
    end

  // True if the request in register 5 is the second one of its sample: the previous one was not its end.
  logic open_6;
  always_ff @(posedge clk)
    if (!rst_n) open_6 <= 1'b0;
    else if (move && valid[5]) open_6 <= !end_of_sample[5];

  // The weight of a sample: wiring for a box of 2^n samples, otherwise a ROM word.
  logic [8:0] weight_6;
  generate
    if (COUNT == `COUNT_ANY || KERNEL == `KERNEL_TENT || COUNT_BITS > 4) begin : g_weights
      localparam integer ADDRESS_BITS = COUNT_BITS + 4;
      rom #(.BITS(9), .WORDS(1 << ADDRESS_BITS), .ADDRESS_BITS(ADDRESS_BITS), .CONTENTS(`KERNEL_WEIGHTS)) weights (
        .clk, .read(move), .address({last_index[5], index[5]}), .word(weight_6));
    end else begin : g_power
      always_comb
        case (last_index[6][3:0])
          4'd0: weight_6 = 9'd256;
          4'd1: weight_6 = 9'd128;
          4'd3: weight_6 = 9'd64;
          4'd7: weight_6 = 9'd32;
          default: weight_6 = 9'd16;
        endcase
    end
  endgenerate

  logic [27:0] sum[0:3];
  generate
    for (i = 0; i < 4; i = i + 1) begin : g_channel
      wire [31:0] of_texels = {codes_1[96+8*i +: 8], codes_1[64+8*i +: 8], codes_1[32+8*i +: 8], codes_1[8*i +: 8]};
      logic [27:0] of_channel;
      filter_channel #(.COLOUR(i < 3 ? 1 : 0)) channel (
        .clk, .move, .texels_1(of_texels), .srgb_1(ticket[1][`TICKET_BITS]), .srgb_2(ticket[2][`TICKET_BITS]), .u_2(u[2]), .v_4(v[4]),
        .level_weight_5(level_weight[5]), .second_5(open_6), .valid_5(valid[5]), .weight_6,
        .first_sample_6(index[6] == 4'd0), .done_6(valid[6] && end_of_sample[6]), .sum(of_channel));
      always_comb sum[i] = of_channel;
    end
  endgenerate

  // 8: round, pack. The fragment of an invalid descriptor is zero.
  logic [31:0] rounded;
  generate
    for (i = 0; i < 4; i = i + 1) begin : g_round
      wire [28:0] near = {1'b0, sum[i]} + 29'd524288;  // 2^19
      wire unused = &{1'b0, near[28], near[19:0]};
      assign rounded[8*i +: 8] = ticket[7][`TICKET_VALID] ? near[27:20] : 8'd0;
    end
  endgenerate

  wire [31:0] rgba;
  generate
    if (OUTPUT == `SRGB_OUTPUT_ENCODED) begin : g_encoded
      // 9: codes of an sRGB texture.
      logic [31:0] rounded_8;
      always_ff @(posedge clk)
        if (move) rounded_8 <= rounded;
      for (i = 0; i < 3; i = i + 1) begin : g_code
        wire [28:0] light = {1'b0, sum[i]} + 29'd32768;  // 2^15: U8.4
        wire unused = &{1'b0, light[28], light[15:0]};
        logic [`LINEAR_TO_SRGB_BITS-1:0] code;
        rom #(.BITS(`LINEAR_TO_SRGB_BITS), .WORDS(4096), .ADDRESS_BITS(12), .CONTENTS(`LINEAR_TO_SRGB)) codes (
          .clk, .read(move), .address(light[27:16]), .word(code));
        assign rgba[8*i +: 8] = ticket[8][`TICKET_BITS] && ticket[8][`TICKET_VALID] ? code : rounded_8[8*i +: 8];
      end
      assign rgba[31:24] = rounded_8[31:24];
    end else begin : g_linear
      assign rgba = rounded;
    end
  endgenerate
  wire unused = &{1'b0, in_data, ticket[LAST], last_index[6]};

  assign out_data[`COLOUR_TAG] = ticket[LAST][`TICKET_TAG];
  assign out_data[`COLOUR_LANE] = ticket[LAST][`TICKET_LANE];
  assign out_data[`COLOUR_LAST] = ticket[LAST][`TICKET_LAST];
  assign out_data[`COLOUR_RGBA_R] = rgba[7:0];
  assign out_data[`COLOUR_RGBA_G] = rgba[15:8];
  assign out_data[`COLOUR_RGBA_B] = rgba[23:16];
  assign out_data[`COLOUR_RGBA_A] = rgba[31:24];
endmodule
