// SPDX-License-Identifier: MIT
// Number of samples, mip level, level fraction and filter of a fragment, in three stages
// (docs/reference/texture/formats.md, "Level and count"; docs/reference/datasheets.md, "LevelUnit").
`include "tokens.svh"
`include "tables.svh"
`include "descriptor.svh"
module level_unit #(
  parameter integer AXES = `CHOSEN_AXES,
  parameter integer COUNT = `CHOSEN_COUNT,
  parameter integer CAP = `CHOSEN_CAP
) (
  input  logic                         clk,
  input  logic                         rst_n,
  input  logic                         in_valid,
  output logic                         in_pop,
  input  logic [`LOG2_TOKEN_BITS-1:0]  in_data,
  output logic                         out_push,
  input  logic                         out_ready,
  output logic [`LEVEL_TOKEN_BITS-1:0] out_data,
  output logic [3:0]                   handle,  // of the token at the link
  input  logic [`DESCRIPTOR_SIZE]      size,
  input  logic [`DESCRIPTOR_MODE]      mode,
  input  logic [`DESCRIPTOR_LOD_BIAS]  lod_bias,
  input  logic [`DESCRIPTOR_LOD_CLAMP] lod_clamp
);
  logic move;
  logic [1:0] valid;
  pipe #(.STAGES(2)) stages (.clk, .rst_n, .in_valid, .in_pop, .out_ready, .out_push, .move, .valid);
  wire unused = &{1'b0, valid, size, mode, lod_bias};

  localparam integer WITH_BITS = `LOG2_TOKEN_LB_MAX_FIRST;  // the fields below the logarithms pass through
  wire [WITH_BITS-1:0] with_it = in_data[WITH_BITS-1:0];
  assign handle = in_data[`LOG2_TOKEN_TICKET_TEXTURE];

  // 1: the part of L that is taken as samples. With an area, the minor side is the quotient, so L is twice the major
  // logarithm minus that of the area.
  wire signed [19:0] lb_max = {{2{in_data[`LOG2_TOKEN_LB_MAX_TOP]}}, in_data[`LOG2_TOKEN_LB_MAX]};
  wire signed [19:0] lb_minor = {{2{in_data[`LOG2_TOKEN_LB_MINOR_TOP]}}, in_data[`LOG2_TOKEN_LB_MINOR]};
  wire signed [19:0] quotient = AXES == `AXES_TWO ? lb_max - lb_minor : (lb_max <<< 1) - lb_minor;
  wire [19:0] l_above = quotient < 0 ? 20'd0 : quotient;
  wire [2:0] most = mode[`DESCRIPTOR_MODE_MAX_COUNT_LOG2];
  wire [14:0] limit = {most, 12'd0};
  wire positive = lb_max > 0;
  // The length of the footprint limits the count: samples are at least a texel apart. lb d_max is at most 16.
  wire [19:0] length_up = lb_max + 20'd4095;
  wire [19:0] cap = CAP == `CAP_NONE ? 20'hFFFFF :
                    COUNT == `COUNT_ANY ? lb_max : {length_up[19:12], 12'd0};
  wire [19:0] l_up = l_above + 20'd4095;
  wire [19:0] wanted = COUNT == `COUNT_ANY ? l_above :
                       COUNT == `COUNT_CEIL ? {l_up[19:12], 12'd0} : {l_above[19:12], 12'd0};
  wire [19:0] limited = wanted < {5'd0, limit} ? wanted : {5'd0, limit};
  wire [19:0] sampled = !positive ? 20'd0 : limited < cap ? limited : cap;
  wire unused_bits = &{1'b0, length_up[11:0], l_up[11:0], sampled[19:15]};

  // The coarsest level has 1 x 1 texels if no bit of a side is left one level further.
  wire [12:0] sides = size[`DESCRIPTOR_SIZE_WIDTH_FIRST +: 13] | size[`DESCRIPTOR_SIZE_HEIGHT_FIRST +: 13];
  wire [12:0] further = sides >> mode[`DESCRIPTOR_MODE_LEVELS];

  logic [WITH_BITS-1:0] with_1, with_2;
  logic to_point_1, to_point_2;
  logic [14:0] e_1;  // E, U3.12
  logic signed [17:0] lb_1;
  logic signed [15:0] bias_1;
  logic [15:0] min_1, max_1;
  logic [2:0] filter_1, filter_2;
  logic mag_1, mag_2;
  logic [3:0] levels_1, levels_2;
  always_ff @(posedge clk)
    if (move) begin
      with_1 <= with_it;
      e_1 <= sampled[14:0];
      lb_1 <= in_data[`LOG2_TOKEN_LB_MAX];
      bias_1 <= lod_bias[`DESCRIPTOR_LOD_BIAS_BIAS];
      min_1 <= lod_clamp[`DESCRIPTOR_LOD_CLAMP_MIN_LOD];
      max_1 <= lod_clamp[`DESCRIPTOR_LOD_CLAMP_MAX_LOD];
      filter_1 <= mode[`DESCRIPTOR_MODE_MIN_FILTER];
      mag_1 <= mode[`DESCRIPTOR_MODE_MAG_FILTER];
      levels_1 <= mode[`DESCRIPTOR_MODE_LEVELS];
      to_point_1 <= further == 13'd0;
    end

  // 2: level of detail in its range, number of samples.
  wire signed [21:0] detail = {{4{lb_1[17]}}, lb_1} - {7'd0, e_1} + {{2{bias_1[15]}}, bias_1, 4'd0};
  wire signed [21:0] lowest = {2'd0, min_1, 4'd0};
  wire signed [21:0] highest = {2'd0, max_1, 4'd0};
  wire signed [21:0] raised = detail < lowest ? lowest : detail;
  wire signed [21:0] clamped = raised > highest ? highest : raised;

  logic [3:0] last;  // N - 1
  generate
    if (COUNT == `COUNT_ANY) begin : g_any
      integer n;
      localparam logic [16*`LOG2_COUNT_BITS-1:0] STEPS = `LOG2_COUNT;
      always_comb begin
        last = 4'd0;
        for (n = 1; n < 16; n = n + 1)
          if (e_1 > {1'b0, STEPS[n*`LOG2_COUNT_BITS +: `LOG2_COUNT_BITS]}) last = last + 4'd1;
      end
    end else begin : g_power
      always_comb
        case (e_1[14:12])
          3'd0: last = 4'd0;
          3'd1: last = 4'd1;
          3'd2: last = 4'd3;
          3'd3: last = 4'd7;
          default: last = 4'd15;
        endcase
    end
  endgenerate

  logic [20:0] l_2;  // positive, U8.12 (a clamp is U8.8)
  logic magnified_2;
  logic [3:0] last_2;
  always_ff @(posedge clk)
    if (move) begin
      with_2 <= with_1;
      l_2 <= clamped[20:0];
      magnified_2 <= clamped <= 0;
      last_2 <= last;
      filter_2 <= filter_1;
      mag_2 <= mag_1;
      levels_2 <= levels_1;
      to_point_2 <= to_point_1;
    end

  // 3: level, fraction and filter by mode. Modes 2 to 5 use mip levels, 4 and 5 blend two of them; odd modes filter
  // linearly within a level. A level of one texel is sampled once.
  wire [3:0] coarsest = levels_2 - 4'd1;
  wire [20:0] nearest = l_2 + 21'd2047;
  wire [20:0] rounded = l_2 + 21'd8;
  wire [8:0] level_nearest = nearest[20:12];
  wire [8:0] level_mixed = rounded[20:12];
  wire near_end = level_nearest >= {5'd0, coarsest};
  wire mixed_end = level_mixed >= {5'd0, coarsest};
  wire unused_low = &{1'b0, nearest[11:0], rounded[3:0]};
  logic [3:0] level;
  logic [7:0] fraction;
  always_comb begin
    level = 4'd0;
    fraction = 8'd0;
    if (!magnified_2 && filter_2[2]) begin
      level = mixed_end ? coarsest : level_mixed[3:0];
      fraction = mixed_end ? 8'd0 : rounded[11:4];
    end else if (!magnified_2 && filter_2[1]) begin
      level = near_end ? coarsest : level_nearest[3:0];
    end
  end
`ifdef LEVEL_TOKEN_DIAGONAL
  logic diagonal_1, diagonal_2;
  always_ff @(posedge clk)
    if (move) begin
      diagonal_1 <= in_data[`LOG2_TOKEN_DIAGONAL];
      diagonal_2 <= diagonal_1;
    end
  assign out_data[`LEVEL_TOKEN_DIAGONAL] = diagonal_2;
`endif
  assign out_data[WITH_BITS-1:0] = with_2;
  assign out_data[`LEVEL_TOKEN_LAST_INDEX] = to_point_2 && level == coarsest ? 4'd0 : last_2;
  assign out_data[`LEVEL_TOKEN_LEVEL] = level;
  assign out_data[`LEVEL_TOKEN_FRACTION] = fraction;
  assign out_data[`LEVEL_TOKEN_LINEAR] = magnified_2 ? mag_2 : filter_2[0];
endmodule
