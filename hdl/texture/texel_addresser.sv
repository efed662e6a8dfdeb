// SPDX-License-Identifier: MIT
// From a sample position to the addresses of its four texels and its fractions, in five stages
// (docs/reference/texture/formats.md, "Addresses"; docs/reference/datasheets.md, "TexelAddresser").
`include "tokens.svh"
`include "tables.svh"
`include "descriptor.svh"
module texel_addresser (
  input  logic                          clk,
  input  logic                          rst_n,
  input  logic                          in_valid,
  output logic                          in_pop,
  input  logic [`SAMPLE_TOKEN_BITS-1:0] in_data,
  output logic                          out_push,
  input  logic                          out_ready,
  output logic [`TEXEL_TOKEN_BITS-1:0]  out_data,
  output logic [3:0]                    handle,  // of the token at the link
  input  logic [`DESCRIPTOR_BITS-1:0]   descriptor
);
  logic move;
  logic [3:0] valid;
  pipe #(.STAGES(4)) stages (.clk, .rst_n, .in_valid, .in_pop, .out_ready, .out_push, .move, .valid);
  wire unused = &{1'b0, valid, descriptor};

  // 1: the descriptor.
  assign handle = in_data[`SAMPLE_TOKEN_TICKET_TEXTURE];
  logic [`SAMPLE_TOKEN_BITS-1:0] sample_1;
  logic [12:0] width_1, height_1;
  logic [2:0] format_1;
  logic tiled_1;
  logic [1:0] wrap_s_1, wrap_t_1;
  logic [32*`DESCRIPTOR_BASES-1:0] bases_1;
  always_ff @(posedge clk)
    if (move) begin
      sample_1 <= in_data;
      width_1 <= descriptor[`DESCRIPTOR_WIDTH_USED];
      height_1 <= descriptor[`DESCRIPTOR_HEIGHT_USED];
      format_1 <= descriptor[`DESCRIPTOR_MODE_FORMAT];
      tiled_1 <= descriptor[`DESCRIPTOR_MODE_LAYOUT];
      wrap_s_1 <= descriptor[`DESCRIPTOR_MODE_WRAP_S];
      wrap_t_1 <= descriptor[`DESCRIPTOR_MODE_WRAP_T];
      bases_1 <= descriptor[32*`DESCRIPTOR_BASE_WORD +: 32*`DESCRIPTOR_BASES];
    end

  // 2: the level within the descriptor, wrapping.
  localparam integer WITH_BITS = 40 + 9 + 4 + 4 + 1 + 1 + 1 + 3;
  wire [3:0] level = sample_1[`SAMPLE_TOKEN_LEVEL];
  wire [12:0] width_at = width_1 >> level;
  wire [12:0] height_at = height_1 >> level;
  wire signed [33:0] wrapped_s, wrapped_t;
  wrap_coordinate of_s (.position(sample_1[`SAMPLE_TOKEN_S]), .wrap(wrap_s_1), .wrapped(wrapped_s));
  wrap_coordinate of_t (.position(sample_1[`SAMPLE_TOKEN_T]), .wrap(wrap_t_1), .wrapped(wrapped_t));
  logic [WITH_BITS-1:0] with_2, with_3, with_4;
  logic [12:0] width_2, height_2, width_3, height_3, width_4, height_4;
  logic signed [33:0] s_2, t_2;
  logic tiled_2, tiled_3, tiled_4;
  logic [1:0] wrap_s_2, wrap_t_2, wrap_s_3, wrap_t_3;
  logic [31:0] base_2, base_3, base_4;
  always_ff @(posedge clk)
    if (move) begin
      with_2 <= {format_1, sample_1[`SAMPLE_TOKEN_LAST_OF_FRAGMENT], sample_1[`SAMPLE_TOKEN_LAST_OF_SAMPLE],
                 sample_1[`SAMPLE_TOKEN_LINEAR], sample_1[`SAMPLE_TOKEN_LAST_INDEX],
                 sample_1[`SAMPLE_TOKEN_INDEX], sample_1[`SAMPLE_TOKEN_LEVEL_WEIGHT],
                 sample_1[`SAMPLE_TOKEN_TICKET]};
      width_2 <= width_at == 13'd0 ? 13'd1 : width_at;
      height_2 <= height_at == 13'd0 ? 13'd1 : height_at;
      s_2 <= wrapped_s;
      t_2 <= wrapped_t;
      tiled_2 <= tiled_1;
      wrap_s_2 <= wrap_s_1;
      wrap_t_2 <= wrap_t_1;
      base_2 <= bases_1[32*level +: 32];
    end

  // 3: multiplication by the size of the level.
  logic signed [46:0] product_s, product_t;
  always_ff @(posedge clk)
    if (move) begin
      with_3 <= with_2;
      product_s <= $signed({{13{s_2[33]}}, s_2}) * $signed({34'd0, width_2});
      product_t <= $signed({{13{t_2[33]}}, t_2}) * $signed({34'd0, height_2});
      width_3 <= width_2;
      height_3 <= height_2;
      tiled_3 <= tiled_2;
      wrap_s_3 <= wrap_s_2;
      wrap_t_3 <= wrap_t_2;
      base_3 <= base_2;
    end

  // 4: texels and fractions.
  wire linear_3 = with_3[57];
  logic [11:0] x0, x1, y0, y1, x0_4, x1_4, y0_4, y1_4;
  logic [7:0] f_u, f_v, f_u_4, f_v_4;
  texel_axis of_x (.product(product_s), .size(width_3), .wrap(wrap_s_3), .linear(linear_3),
                   .first(x0), .second(x1), .fraction(f_u));
  texel_axis of_y (.product(product_t), .size(height_3), .wrap(wrap_t_3), .linear(linear_3),
                   .first(y0), .second(y1), .fraction(f_v));
  always_ff @(posedge clk)
    if (move) begin
      with_4 <= with_3;
      x0_4 <= x0;
      x1_4 <= x1;
      y0_4 <= y0;
      y1_4 <= y1;
      f_u_4 <= f_u;
      f_v_4 <= f_v;
      width_4 <= width_3;
      height_4 <= height_3;
      tiled_4 <= tiled_3;
      base_4 <= base_3;
    end

  // 5: column and row parts, and their sums.
  wire [2:0] format = with_4[62:60];
  wire [1:0] lb_bytes = format == `FORMAT_L8 ? 2'd0 :
                        format == `FORMAT_RGB565 || format == `FORMAT_RGBA4444 ? 2'd1 : 2'd2;
  logic [31:0] address_00, address_10, address_01, address_11;
  texel_address at_00 (.x(x0_4), .y(y0_4), .width(width_4), .height(height_4), .tiled(tiled_4), .lb_bytes,
                       .base(base_4), .address(address_00));
  texel_address at_10 (.x(x1_4), .y(y0_4), .width(width_4), .height(height_4), .tiled(tiled_4), .lb_bytes,
                       .base(base_4), .address(address_10));
  texel_address at_01 (.x(x0_4), .y(y1_4), .width(width_4), .height(height_4), .tiled(tiled_4), .lb_bytes,
                       .base(base_4), .address(address_01));
  texel_address at_11 (.x(x1_4), .y(y1_4), .width(width_4), .height(height_4), .tiled(tiled_4), .lb_bytes,
                       .base(base_4), .address(address_11));
  wire unused_linear = &{1'b0, with_4[57]};

  assign out_data[`TEXEL_TOKEN_TICKET] = with_4[39:0];
  assign out_data[`TEXEL_TOKEN_CONTROL_FRACTION_U] = f_u_4;
  assign out_data[`TEXEL_TOKEN_CONTROL_FRACTION_V] = f_v_4;
  assign out_data[`TEXEL_TOKEN_CONTROL_LEVEL_WEIGHT] = with_4[48:40];
  assign out_data[`TEXEL_TOKEN_CONTROL_INDEX] = with_4[52:49];
  assign out_data[`TEXEL_TOKEN_CONTROL_LAST_INDEX] = with_4[56:53];
  assign out_data[`TEXEL_TOKEN_CONTROL_FORMAT] = format;
  assign out_data[`TEXEL_TOKEN_CONTROL_LAST_OF_SAMPLE] = with_4[58];
  assign out_data[`TEXEL_TOKEN_CONTROL_LAST_OF_FRAGMENT] = with_4[59];
  assign out_data[`TEXEL_TOKEN_ADDRESS_0] = address_00;
  assign out_data[`TEXEL_TOKEN_ADDRESS_1] = address_10;
  assign out_data[`TEXEL_TOKEN_ADDRESS_2] = address_01;
  assign out_data[`TEXEL_TOKEN_ADDRESS_3] = address_11;
  // In the linear layout, lines of odd rows are stored turned.
  assign out_data[`TEXEL_TOKEN_TURNED_0] = !tiled_4 && y0_4[0];
  assign out_data[`TEXEL_TOKEN_TURNED_1] = !tiled_4 && y1_4[0];
endmodule
