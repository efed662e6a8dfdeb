// SPDX-License-Identifier: MIT
// One channel of the filter pipeline, stages 2 to 8: unpacked texels in U8.4, both lerps, the level lerp,
// the accumulator (docs/reference/texture/formats.md, docs/reference/datasheets.md "FilterPipeline").
`include "tables.svh"
module filter_channel #(
  parameter integer COLOUR = 1  // red, green or blue, which sRGB encodes; 0: alpha
) (
  input  logic        clk,
  input  logic        move,
  input  logic [31:0] texels_1,  // four codes, texel 00 in the lowest bits
  input  logic        srgb_1,
  input  logic        srgb_2,
  input  logic [7:0]  u_2, v_4,
  input  logic [8:0]  level_weight_5,
  input  logic        second_5,  // second of two levels: the sum holds the first one
  input  logic        valid_5,   // a request is in register 5
  input  logic [8:0]  weight_6,
  input  logic        first_sample_6,
  input  logic        done_6,    // a sample is complete in register 6
  output logic [27:0] sum        // U8.20 of the fragment, in register 7
);
  // 2: unpack.
  logic [47:0] channel_2;
  genvar i;
  generate
    for (i = 0; i < 4; i = i + 1) begin : g_texel
      wire [7:0] code = texels_1[8*i +: 8];
      logic [7:0] code_2;
      always_ff @(posedge clk)
        if (move) code_2 <= code;
      if (COLOUR != 0) begin : g_colour
        logic [`SRGB_TO_LINEAR_BITS-1:0] light;
        rom #(.BITS(`SRGB_TO_LINEAR_BITS), .WORDS(256), .ADDRESS_BITS(8), .CONTENTS(`SRGB_TO_LINEAR)) srgb (
          .clk, .read(move && srgb_1), .address(code), .word(light));
        assign channel_2[12*i +: 12] = srgb_2 ? light : {code_2, 4'd0};
      end else begin : g_alpha
        assign channel_2[12*i +: 12] = {code_2, 4'd0};
      end
    end
    if (COLOUR == 0) begin : g_unused
      wire unused = &{1'b0, srgb_1, srgb_2};
    end
  endgenerate

  // 3 and 4: horizontal products and sums, exact in U8.12.
  wire [8:0] u_near = 9'd256 - {1'b0, u_2};
  logic [20:0] low_00, low_10, low_01, low_11;
  logic [19:0] upper_4, lower_4;
  always_ff @(posedge clk)
    if (move) begin
      low_00 <= {9'd0, channel_2[11:0]} * {12'd0, u_near};
      low_10 <= {9'd0, channel_2[23:12]} * {13'd0, u_2};
      low_01 <= {9'd0, channel_2[35:24]} * {12'd0, u_near};
      low_11 <= {9'd0, channel_2[47:36]} * {13'd0, u_2};
      upper_4 <= low_00[19:0] + low_10[19:0];
      lower_4 <= low_01[19:0] + low_11[19:0];
    end
  wire unused_high = &{1'b0, low_00[20], low_10[20], low_01[20], low_11[20]};

  // 5: vertical lerp, rounded to U8.12.
  wire [8:0] v_near = 9'd256 - {1'b0, v_4};
  wire [28:0] vertical = {9'd0, upper_4} * {20'd0, v_near} + {9'd0, lower_4} * {21'd0, v_4} + 29'd128;
  logic [19:0] bilinear_5;
  always_ff @(posedge clk)
    if (move) bilinear_5 <= vertical[27:8];

  // 6: level lerp: the sum of one or two requests, U8.20.
  logic [27:0] levels_6;
  wire [28:0] weighted = {9'd0, bilinear_5} * {20'd0, level_weight_5};
  wire [28:0] both = weighted + (second_5 ? {1'b0, levels_6} : 29'd0);
  always_ff @(posedge clk)
    if (move && valid_5) levels_6 <= both[27:0];

  // 7: accumulate, of samples that are complete.
  wire [28:0] rounded = {1'b0, levels_6} + 29'd128;
  wire [28:0] share = {9'd0, rounded[27:8]} * {20'd0, weight_6};
  wire [28:0] total = share + (first_sample_6 ? 29'd0 : {1'b0, sum});
  wire unused_top = &{1'b0, vertical[28], vertical[7:0], both[28], rounded[28], rounded[7:0], total[28]};
  always_ff @(posedge clk)
    if (move && done_6) sum <= total[27:0];
endmodule
