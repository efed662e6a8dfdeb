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
  input  logic [`DESCRIPTOR_SIZE]       size,
  input  logic [`DESCRIPTOR_MODE]       mode,
  input  logic [`DESCRIPTOR_BASE]       bases
);
  logic move;
  logic [3:0] valid;
  pipe #(.STAGES(4)) stages (.clk, .rst_n, .in_valid, .in_pop, .out_ready, .out_push, .move, .valid);
  wire unused = &{1'b0, valid, size};

  // 1: the descriptor. The token and the fields of the mode stay with the sample.
  assign handle = in_data[`SAMPLE_TOKEN_TICKET_TEXTURE];
  logic [`SAMPLE_TOKEN_BITS-1:0] sample[1:4];
  logic [`DESCRIPTOR_MODE] mode_of[1:4];
  logic [12:0] width_1, height_1;
  logic [32*`DESCRIPTOR_BASES-1:0] bases_1;
  always_ff @(posedge clk)
    if (move) begin
      sample[1] <= in_data;
      mode_of[1] <= mode;
      width_1 <= size[`DESCRIPTOR_WIDTH_USED];
      height_1 <= size[`DESCRIPTOR_HEIGHT_USED];
      bases_1 <= bases;
    end
  genvar i;
  generate
    for (i = 2; i <= 4; i = i + 1) begin : g_with
      always_ff @(posedge clk)
        if (move) begin
          sample[i] <= sample[i-1];
          mode_of[i] <= mode_of[i-1];
        end
    end
  endgenerate

  // 2: the level within the descriptor, wrapping.
  wire [3:0] level = sample[1][`SAMPLE_TOKEN_LEVEL];
  wire [12:0] width_at = width_1 >> level;
  wire [12:0] height_at = height_1 >> level;
  localparam integer POSITION_BITS = `SAMPLE_TOKEN_S_BITS;
  wire signed [POSITION_BITS-1:0] wrapped_s, wrapped_t;
  wrap_coordinate of_s (
    .position(sample[1][`SAMPLE_TOKEN_S]), .wrap(mode_of[1][`DESCRIPTOR_MODE_WRAP_S]), .wrapped(wrapped_s));
  wrap_coordinate of_t (
    .position(sample[1][`SAMPLE_TOKEN_T]), .wrap(mode_of[1][`DESCRIPTOR_MODE_WRAP_T]), .wrapped(wrapped_t));
  logic [12:0] width_2, height_2, width_3, height_3;
  logic signed [POSITION_BITS-1:0] s_2, t_2;
  logic [31:0] base_2, base_3, base_4;
  always_ff @(posedge clk)
    if (move) begin
      width_2 <= width_at == 13'd0 ? 13'd1 : width_at;
      height_2 <= height_at == 13'd0 ? 13'd1 : height_at;
      s_2 <= wrapped_s;
      t_2 <= wrapped_t;
      base_2 <= bases_1[32*level +: 32];
    end

  // 3: multiplication by the size of the level.
  logic signed [POSITION_BITS+12:0] product_s, product_t;
  always_ff @(posedge clk)
    if (move) begin
      product_s <= $signed({{13{s_2[POSITION_BITS-1]}}, s_2}) * $signed({{POSITION_BITS{1'b0}}, width_2});
      product_t <= $signed({{13{t_2[POSITION_BITS-1]}}, t_2}) * $signed({{POSITION_BITS{1'b0}}, height_2});
      width_3 <= width_2;
      height_3 <= height_2;
      base_3 <= base_2;
    end

  // 4: texels and fractions; the pitch of the level, 0 if it is tiled, and its tiles.
  wire linear_3 = sample[3][`SAMPLE_TOKEN_LINEAR];
  wire [2:0] format_3 = mode_of[3][`DESCRIPTOR_MODE_FORMAT_LOW];
  wire [1:0] lb_bytes_3 = format_3 == `FORMAT_L8 ? 2'd0 :
                          format_3 == `FORMAT_RGB565 || format_3 == `FORMAT_RGBA4444 ? 2'd1 : 2'd2;
  logic [11:0] x0, x1, y0, y1, x_4[0:1], y_4[0:1];
  logic [7:0] f_u, f_v, f_u_4, f_v_4;
  logic [8:0] pitch, pitch_4;
  logic [9:0] used_x, used_y, used_x_4, used_y_4;
  logic [1:0] lb_bytes_4;
  texel_axis of_x (.product(product_s), .size(width_3), .wrap(mode_of[3][`DESCRIPTOR_MODE_WRAP_S]), .linear(linear_3),
                   .first(x0), .second(x1), .fraction(f_u));
  texel_axis of_y (.product(product_t), .size(height_3), .wrap(mode_of[3][`DESCRIPTOR_MODE_WRAP_T]), .linear(linear_3),
                   .first(y0), .second(y1), .fraction(f_v));
  level_layout layout (.width(width_3), .height(height_3), .lb_bytes(lb_bytes_3), .pitch, .used_x, .used_y);
  always_ff @(posedge clk)
    if (move) begin
      x_4[0] <= x0;
      x_4[1] <= x1;
      y_4[0] <= y0;
      y_4[1] <= y1;
      f_u_4 <= f_u;
      f_v_4 <= f_v;
      pitch_4 <= mode_of[3][`DESCRIPTOR_MODE_LAYOUT] ? 9'd0 : pitch;
      used_x_4 <= used_x;
      used_y_4 <= used_y;
      lb_bytes_4 <= lb_bytes_3;
      base_4 <= base_3;
    end

  // 5: the addresses, left to right and top to bottom.
  wire tiled_4 = mode_of[4][`DESCRIPTOR_MODE_LAYOUT];
  wire [4*32-1:0] addresses;
  generate
    for (i = 0; i < 4; i = i + 1) begin : g_texel
      texel_address at (.x(x_4[i%2]), .y(y_4[i/2]), .pitch(pitch_4), .used_x(used_x_4), .used_y(used_y_4),
                        .tiled(tiled_4), .lb_bytes(lb_bytes_4), .base(base_4), .address(addresses[32*i +: 32]));
    end
  endgenerate
  assign out_data[`TEXEL_TOKEN_TICKET] = sample[4][`SAMPLE_TOKEN_TICKET];
  assign out_data[`TEXEL_TOKEN_CONTROL_FRACTION_U] = f_u_4;
  assign out_data[`TEXEL_TOKEN_CONTROL_FRACTION_V] = f_v_4;
  assign out_data[`TEXEL_TOKEN_CONTROL_LEVEL_WEIGHT] = sample[4][`SAMPLE_TOKEN_LEVEL_WEIGHT];
  assign out_data[`TEXEL_TOKEN_CONTROL_INDEX] = sample[4][`SAMPLE_TOKEN_INDEX];
  assign out_data[`TEXEL_TOKEN_CONTROL_LAST_INDEX] = sample[4][`SAMPLE_TOKEN_LAST_INDEX];
  assign out_data[`TEXEL_TOKEN_CONTROL_FORMAT] = mode_of[4][`DESCRIPTOR_MODE_FORMAT_LOW];
  assign out_data[`TEXEL_TOKEN_CONTROL_LAST_OF_SAMPLE] = sample[4][`SAMPLE_TOKEN_LAST_OF_SAMPLE];
  assign out_data[`TEXEL_TOKEN_CONTROL_LAST_OF_FRAGMENT] = sample[4][`SAMPLE_TOKEN_LAST_OF_FRAGMENT];
  assign out_data[`TEXEL_TOKEN_ADDRESS] = addresses;
  // In the linear layout, lines of odd rows are stored turned.
  assign out_data[`TEXEL_TOKEN_TURNED_0] = !tiled_4 && y_4[0][0];
  assign out_data[`TEXEL_TOKEN_TURNED_1] = !tiled_4 && y_4[1][0];
endmodule
