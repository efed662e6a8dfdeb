// SPDX-License-Identifier: MIT
// Splits a quad into its covered fragments, each with the coordinate differences along its row and column, and their
// magnitudes in texels of level 0 (docs/reference/datasheets.md, "DerivativeUnit").
`include "tokens.svh"
`include "descriptor.svh"
module derivative_unit (
  input  logic                              clk,
  input  logic                              rst_n,
  input  logic                              in_valid,
  output logic                              in_pop,
  input  logic [`QUAD_BITS-1:0]             in_data,
  output logic                              out_push,
  input  logic                              out_ready,
  output logic [`DERIVATIVE_TOKEN_BITS-1:0] out_data,
  output logic                              saturated,  // increments SATURATED
  output logic [3:0]                        handle,  // of the fragment in stage 1
  input  logic                              known,   // its descriptor is valid
  input  logic [`DESCRIPTOR_SIZE]           size
);
  // 1: the next covered lane, of the quad at the link or of the quad taken before.
  logic [`QUAD_BITS-1:0] held;
  logic [3:0] left;  // lanes of `held` not yet processed
  wire  [`QUAD_BITS-1:0] quad = left == 4'd0 ? in_data : held;
  wire  [3:0] lanes = left == 4'd0 ? in_data[`QUAD_COVERAGE] & {4{in_valid}} : left;
  wire  [1:0] lane = lanes[0] ? 2'd0 : lanes[1] ? 2'd1 : lanes[2] ? 2'd2 : 2'd3;
  wire  [3:0] rest = lanes & ~(4'd1 << lane);
  wire  there = lanes != 4'd0;
  wire  unused = &{1'b0, quad, size};

  logic [1:0] valid;
  wire move = out_ready || !valid[1];
  assign in_pop = in_valid && move && left == 4'd0;
  assign out_push = out_ready && valid[1];
  always_ff @(posedge clk)
    if (!rst_n) begin
      left <= 4'd0;
      valid <= 2'd0;
    end else if (move) begin
      left <= rest;
      valid <= {valid[0], there};
    end
  always_ff @(posedge clk)
    if (in_pop) held <= in_data;

  wire signed [32:0] s_0 = {quad[`QUAD_S_0_TOP], quad[`QUAD_S_0]}, t_0 = {quad[`QUAD_T_0_TOP], quad[`QUAD_T_0]};
  wire signed [32:0] s_1 = {quad[`QUAD_S_1_TOP], quad[`QUAD_S_1]}, t_1 = {quad[`QUAD_T_1_TOP], quad[`QUAD_T_1]};
  wire signed [32:0] s_2 = {quad[`QUAD_S_2_TOP], quad[`QUAD_S_2]}, t_2 = {quad[`QUAD_T_2_TOP], quad[`QUAD_T_2]};
  wire signed [32:0] s_3 = {quad[`QUAD_S_3_TOP], quad[`QUAD_S_3]}, t_3 = {quad[`QUAD_T_3_TOP], quad[`QUAD_T_3]};
  wire [31:0] s = lane[1] ? (lane[0] ? s_3[31:0] : s_2[31:0]) : (lane[0] ? s_1[31:0] : s_0[31:0]);
  wire [31:0] t = lane[1] ? (lane[0] ? t_3[31:0] : t_2[31:0]) : (lane[0] ? t_1[31:0] : t_0[31:0]);

  // The quad carries an 8-bit handle, of which 4 bits select a descriptor.
  wire [7:0] texture = quad[`QUAD_TEXTURE];
  assign handle = texture[3:0];

  logic signed [32:0] s_x, t_x, s_y, t_y;
  logic [12:0] width, height;
  logic [`DERIVATIVE_TOKEN_S_X_FIRST-1:0] with_1, with_2;  // ticket and coordinate
  wire [`TICKET_BITS-1:0] ticket;
  assign ticket[`TICKET_TAG] = quad[`QUAD_TAG];
  assign ticket[`TICKET_LANE] = lane;
  assign ticket[`TICKET_LAST] = rest == 4'd0;
  assign ticket[`TICKET_VALID] = texture[7:4] == 4'd0 && known;
  assign ticket[`TICKET_TEXTURE] = texture[3:0];
  always_ff @(posedge clk)
    if (move) begin
      s_x <= lane[1] ? s_3 - s_2 : s_1 - s_0;
      t_x <= lane[1] ? t_3 - t_2 : t_1 - t_0;
      s_y <= lane[0] ? s_3 - s_1 : s_2 - s_0;
      t_y <= lane[0] ? t_3 - t_1 : t_2 - t_0;
      width <= size[`DESCRIPTOR_WIDTH_USED];
      height <= size[`DESCRIPTOR_HEIGHT_USED];
      with_1 <= {t, s, ticket};
    end

  // 2: multiplication by the size of level 0.
  logic signed [46:0] p_s_x, p_t_x, p_s_y, p_t_y;
  logic signed [32:0] s_x_2, t_x_2, s_y_2, t_y_2;
  wire signed [46:0] w = $signed({34'd0, width}), h = $signed({34'd0, height});
  always_ff @(posedge clk)
    if (move) begin
      p_s_x <= $signed({{14{s_x[32]}}, s_x}) * w;
      p_t_x <= $signed({{14{t_x[32]}}, t_x}) * h;
      p_s_y <= $signed({{14{s_y[32]}}, s_y}) * w;
      p_t_y <= $signed({{14{t_y[32]}}, t_y}) * h;
      s_x_2 <= s_x;
      t_x_2 <= t_x;
      s_y_2 <= s_y;
      t_y_2 <= t_y;
      with_2 <= with_1;
    end

  // 3: magnitude, rounded to 16 fraction bits, saturated.
  logic [30:0] size_s_x, size_t_x, size_s_y, size_t_y;
  logic saturated_s_x, saturated_t_x, saturated_s_y, saturated_t_y;
  texel_size of_s_x (.product(p_s_x), .size(size_s_x), .saturated(saturated_s_x));
  texel_size of_t_x (.product(p_t_x), .size(size_t_x), .saturated(saturated_t_x));
  texel_size of_s_y (.product(p_s_y), .size(size_s_y), .saturated(saturated_s_y));
  texel_size of_t_y (.product(p_t_y), .size(size_t_y), .saturated(saturated_t_y));
  assign saturated = out_push && with_2[`TICKET_VALID] && (saturated_s_x || saturated_t_x || saturated_s_y || saturated_t_y);
  assign out_data = {size_t_y, size_s_y, size_t_x, size_s_x, t_y_2, s_y_2, t_x_2, s_x_2, with_2};
endmodule
