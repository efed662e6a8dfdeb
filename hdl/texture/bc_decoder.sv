// SPDX-License-Identifier: MIT
// Stages 1 and 2 of a BlockDecoder for BC1, BC3, BC4 and BC5 (docs/reference/texture/compressed.md, "BC"). The outputs
// are the summands of block_decoder. All ports except the block and its format are in stage 2.
`include "tables.svh"
module bc_decoder #(
  parameter integer BC = `CHOSEN_BC
) (
  input  logic         clk,
  input  logic         move,
  input  logic [127:0] block,
  input  logic [3:0]   format,
  input  logic [3:0]   format_1,
  input  logic [7:0]   selectors_1,  // of four texels
  input  logic [11:0]  codes_1,      // selectors of values in bytes 0 to 7
  input  logic [11:0]  seconds_1,    // selectors of values in bytes 8 to 15
  output logic [23:0]  base,
  output logic [23:0]  step_1, step_2, step_3,
  output logic [2:0]   swapped,      // steps of a channel count from the end point b
  output logic [7:0]   count,        // steps of each texel
  output logic [3:0]   hole,
  output logic [35:0]  offsets,
  output logic [7:0]   alpha_base,
  output logic [35:0]  alpha_offsets
);
  wire [31:0] ends = format == `FORMAT_BC3 ? block[95:64] : block[31:0];
  wire red_above, red_same, green_above, green_same, blue_above, blue_same;
  logic three_1;
  wire [23:0] colour;
  bc_channel #(.BC(BC), .BITS(5)) red (
    .clk, .move, .first(ends[15:11]), .second(ends[31:27]), .above(red_above), .same(red_same), .three_1,
    .swapped(swapped[0]), .base(colour[7:0]), .step_1(step_1[7:0]), .step_2(step_2[7:0]), .step_3(step_3[7:0]));
  bc_channel #(.BC(BC), .BITS(6)) green (
    .clk, .move, .first(ends[10:5]), .second(ends[26:21]), .above(green_above), .same(green_same), .three_1,
    .swapped(swapped[1]), .base(colour[15:8]), .step_1(step_1[15:8]), .step_2(step_2[15:8]), .step_3(step_3[15:8]));
  bc_channel #(.BC(BC), .BITS(5)) blue (
    .clk, .move, .first(ends[4:0]), .second(ends[20:16]), .above(blue_above), .same(blue_same), .three_1,
    .swapped(swapped[2]), .base(colour[23:16]), .step_1(step_1[23:16]), .step_2(step_2[23:16]), .step_3(step_3[23:16]));
  wire falls = red_above || (red_same && (green_above || (green_same && blue_above)));
  wire unused = blue_same;
  always_ff @(posedge clk)
    if (move) three_1 <= format == `FORMAT_BC1 && !falls;

  wire [7:0] second_base;
  wire [35:0] first_offsets, second_offsets;
  bc_values #(.BC(BC)) values (
    .clk, .move, .ends(block[15:0]), .codes_1, .base(alpha_base), .offsets(first_offsets));
  bc_values #(.BC(BC)) seconds (
    .clk, .move, .ends(block[79:64]), .codes_1(seconds_1), .base(second_base), .offsets(second_offsets));

  // The second values of BC5 take the place of green.
  wire two_values = format_1 == `FORMAT_BC5;
  assign base = {colour[23:16], two_values ? second_base : colour[15:8], colour[7:0]};
  genvar t;
  generate
    for (t = 0; t < 4; t = t + 1) begin : g_texel
      wire [1:0] selector = selectors_1[2*t +: 2];
      assign count[2*t +: 2] = {selector[0], selector[1] ^ selector[0]};  // selectors 0, 2, 3, 1
      assign hole[t] = three_1 && selector == 2'd3;
      assign offsets[9*t +: 9] = two_values ? second_offsets[9*t +: 9] : 9'h100;
      assign alpha_offsets[9*t +: 9] = format_1 == `FORMAT_BC1 ? {hole[t], {8{!hole[t]}}} : first_offsets[9*t +: 9];
    end
  endgenerate
  wire unused_block = &{1'b0, unused, block};
endmodule
