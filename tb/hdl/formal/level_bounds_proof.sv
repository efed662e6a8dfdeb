// SPDX-License-Identifier: MIT
// For every pair of logarithms and every valid descriptor: N, level, fraction and filter are as specified
// (docs/reference/texture/formats.md, "Level and count"), computed here with extra bits; L, E and l fit their
// formats; the level exists, and so does the next one if the fraction is not zero; N is 1 to N_max; magnification
// reads level 0. The token stays at the link until it leaves, so three cycles from any state are sufficient.
`include "tokens.svh"
`include "tables.svh"
`include "descriptor.svh"
module level_bounds_proof #(
  parameter integer AXES = `CHOSEN_AXES,
  parameter integer COUNT = `CHOSEN_COUNT,
  parameter integer CAP = `CHOSEN_CAP
) (
  input logic clk
);
  (* anyconst *) wire [`LOG2_TOKEN_BITS-1:0] token;
  (* anyconst *) wire [32*`DESCRIPTOR_WORDS-1:0] words;
  wire valid;
  descriptor_check check (.words, .valid);
  wire in_pop, out_push;
  wire [`LEVEL_TOKEN_BITS-1:0] out;
  wire [3:0] handle;
  level_unit #(.AXES(AXES), .COUNT(COUNT), .CAP(CAP)) unit (
    .clk, .rst_n(1'b1), .in_valid(1'b1), .in_pop, .in_data(token), .out_push, .out_ready(1'b1),
    .out_data(out), .handle, .size(words[`DESCRIPTOR_SIZE]), .mode(words[`DESCRIPTOR_MODE]),
    .lod_bias(words[`DESCRIPTOR_LOD_BIAS]), .lod_clamp(words[`DESCRIPTOR_LOD_CLAMP]));
  reg [1:0] cycles = 2'd0;
  always @(posedge clk) if (cycles != 2'd3) cycles <= cycles + 2'd1;
  wire [3:0] last = out[`LEVEL_TOKEN_LAST_INDEX];
  wire [3:0] level = out[`LEVEL_TOKEN_LEVEL];
  wire [7:0] fraction = out[`LEVEL_TOKEN_FRACTION];
  wire [3:0] coarsest = words[`DESCRIPTOR_MODE_LEVELS] - 4'd1;
  wire [2:0] mode = words[`DESCRIPTOR_MODE_MIN_FILTER];
  wire [4:0] most = 5'd1 << words[`DESCRIPTOR_MODE_MAX_COUNT_LOG2];

  // The specification in 32 bits.
  wire signed [17:0] token_max = token[`LOG2_TOKEN_LB_MAX], token_minor = token[`LOG2_TOKEN_LB_MINOR];
  wire signed [15:0] bias = words[`DESCRIPTOR_LOD_BIAS_BIAS];
  wire signed [31:0] lb_max = token_max, lb_minor = token_minor, bias_wide = bias;
  wire signed [31:0] lb_d_min = AXES == `AXES_TWO ? lb_minor : lb_minor - lb_max;
  wire signed [31:0] longer = lb_max - lb_d_min;
  wire signed [31:0] l_of = longer < 0 ? 0 : longer;  // L
  wire signed [31:0] limit = {13'd0, words[`DESCRIPTOR_MODE_MAX_COUNT_LOG2], 12'd0};
  wire signed [31:0] taken = COUNT == `COUNT_FLOOR ? (l_of >>> 12) <<< 12 :
                             COUNT == `COUNT_CEIL ? ((l_of + 4095) >>> 12) <<< 12 : l_of;
  wire signed [31:0] limited = taken > limit ? limit : taken;
  wire signed [31:0] cap = COUNT == `COUNT_ANY ? lb_max : ((lb_max + 4095) >>> 12) <<< 12;
  wire signed [31:0] capped = CAP == `CAP_TEXEL && limited > cap ? cap : limited;
  wire signed [31:0] page_e = lb_max <= 0 || capped < 0 ? 0 : capped;
  // The unit's own E, proved equal to the specified one, so that the properties below are separate proof goals.
  (* hierconn *) wire [14:0] \unit.e_1 ;
  wire signed [31:0] e = {17'd0, \unit.e_1 };
  localparam logic [16*`LOG2_COUNT_BITS-1:0] STEPS = `LOG2_COUNT;
  integer n;
  reg [4:0] samples;
  // A level of 1 x 1 texels is sampled once.
  wire [15:0] level_width = words[`DESCRIPTOR_SIZE_WIDTH] >> level;
  wire [15:0] level_height = words[`DESCRIPTOR_SIZE_HEIGHT] >> level;
  wire point = level_width <= 16'd1 && level_height <= 16'd1;
  always @* begin
    samples = 5'd1 << e[14:12];
    if (COUNT == `COUNT_ANY) begin
      samples = 5'd1;
      for (n = 1; n < 16; n = n + 1)
        if (e[15:0] > STEPS[n*`LOG2_COUNT_BITS +: `LOG2_COUNT_BITS]) samples = samples + 5'd1;
    end
    if (point) samples = 5'd1;
  end
  wire signed [31:0] detail = lb_max - e + bias_wide * 16;
  wire signed [31:0] lowest = {12'd0, words[`DESCRIPTOR_LOD_CLAMP_MIN_LOD], 4'd0};
  wire signed [31:0] highest = {12'd0, words[`DESCRIPTOR_LOD_CLAMP_MAX_LOD], 4'd0};
  wire signed [31:0] raised = detail < lowest ? lowest : detail;
  wire signed [31:0] l = raised > highest ? highest : raised;
  wire magnified = l <= 0;
  wire signed [31:0] q = {28'd0, coarsest};
  wire signed [31:0] nearest = (l + 2047) >>> 12, l8 = (l + 8) >>> 4, mixed = l8 >>> 8;
  wire signed [31:0] page_level = magnified || mode < 3'd2 ? 0 : mode < 3'd4 ? (nearest > q ? q : nearest) :
                                  mixed > q ? q : mixed;
  wire [7:0] page_fraction = magnified || mode < 3'd4 || mixed >= q ? 8'd0 : l8[7:0];
  wire page_linear = magnified ? words[`DESCRIPTOR_MODE_MAG_FILTER] : mode[0];
  always @* begin
    assume (valid);
    // n is -16 to 15, for an area up to 30, and y + c at most 1.
    assume (lb_max >= -65536 && lb_max <= 65536 && lb_minor >= -65536);
    assume (lb_minor <= (AXES == `AXES_TWO ? 65536 : 126976));
  end
  always @*
    if (cycles >= 2'd2) begin
      a_e: assert (e == page_e);
      a_formats: assert (l_of < 262144 && page_e >= 0 && page_e < 32768 && detail >= -1048576 && detail < 1048576);
      a_samples: assert ({1'b0, last} + 5'd1 == samples);
      a_page: assert (page_level == {28'd0, level} && page_fraction == fraction);
      a_filter: assert (page_linear == out[`LEVEL_TOKEN_LINEAR]);
      a_level: assert (level <= coarsest);
      a_next_level: assert (fraction == 8'd0 || level < coarsest);
      a_count: assert ({1'b0, last} < most);
      a_point: assert (!point || fraction == 8'd0);
      a_one_level: assert (mode >= 3'd4 || fraction == 8'd0);
      a_no_levels: assert (mode >= 3'd2 || level == 4'd0);
    end
endmodule
