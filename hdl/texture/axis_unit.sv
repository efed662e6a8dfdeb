// SPDX-License-Identifier: MIT
// The major axis among four or eight directions, and the area of the footprint (`axes = four`, `eight`). `axis_cycles`
// measures the candidates in groups, one group per cycle (docs/reference/datasheets.md, "AxisUnit").
`include "tokens.svh"
`include "tables.svh"
module axis_unit #(
  parameter integer AXES = `CHOSEN_AXES,
  parameter integer RULE = `CHOSEN_FOOTPRINT,
  parameter integer AXIS_CYCLES = `CHOSEN_AXIS_CYCLES
) (
  input  logic                              clk,
  input  logic                              rst_n,
  input  logic                              in_valid,
  output logic                              in_pop,
  input  logic [`DERIVATIVE_TOKEN_BITS-1:0] in_data,
  output logic                              out_push,
  input  logic                              out_ready,
  output logic [`FOOTPRINT_TOKEN_BITS-1:0]  out_data
);
  localparam integer CANDIDATES = AXES == `AXES_EIGHT ? 8 : 4;
  localparam integer STEP = 8 / CANDIDATES;  // directions from one candidate to the next
  localparam integer SLOTS = CANDIDATES / AXIS_CYCLES;  // candidates per group
  localparam integer GROUP_DIRECTIONS = SLOTS * STEP;
  localparam logic [2:0] SLOT_STEP = STEP[2:0], GROUP_STEP = GROUP_DIRECTIONS[2:0];
  localparam integer EXACT = RULE == `FOOTPRINT_EXACT ? 1 : 0;
  localparam integer REGISTERS = EXACT != 0 ? 21 : 7;
  localparam integer MEASURE_BITS = EXACT != 0 ? 63 : 32;
  localparam integer LAST_GROUP_INDEX = AXIS_CYCLES - 1;
  localparam logic [1:0] LAST_GROUP = LAST_GROUP_INDEX[1:0];

  // A fragment stays in the first register while its groups leave it. Registers 2 to 5 hold groups; after the last
  // group, registers hold the fragment again.
  logic [REGISTERS:1] valid;
  logic [1:0] group_1, group_2, group_3, group_4, group_5;
  wire move = out_ready || !valid[REGISTERS];
  wire free = !valid[1] || group_1 == LAST_GROUP;
  assign in_pop = in_valid && move && free;
  assign out_push = out_ready && valid[REGISTERS];
  always_ff @(posedge clk)
    if (!rst_n) begin
      valid <= {REGISTERS{1'b0}};
      group_1 <= 2'd0;
    end else if (move) begin
      valid[1] <= free ? in_valid : 1'b1;
      group_1 <= free ? 2'd0 : group_1 + 2'd1;
      valid[5:2] <= valid[4:1];
      valid[6] <= valid[5] && group_5 == LAST_GROUP;
      valid[REGISTERS:7] <= valid[REGISTERS-1:6];
    end
  always_ff @(posedge clk)
    if (move) begin
      group_2 <= group_1;
      group_3 <= group_2;
      group_4 <= group_3;
      group_5 <= group_4;
    end

  // Data that accompany the fragment: ticket, coordinate, differences.
  localparam integer WITH_BITS = `DERIVATIVE_TOKEN_BITS - 4 * 31;
  logic [WITH_BITS-1:0] with_it[1:REGISTERS];
  logic [46:0] area[2:REGISTERS];
  genvar i;
  generate
    for (i = 2; i <= REGISTERS; i = i + 1) begin : g_with
      always_ff @(posedge clk)
        if (move) with_it[i] <= with_it[i-1];
    end
    for (i = 3; i <= REGISTERS; i = i + 1) begin : g_area
      always_ff @(posedge clk)
        if (move) area[i] <= area[i-1];
    end
  endgenerate

  // 1: multiples of the derivatives in texels, with the sign of their difference; products for the area, of magnitudes
  // with 8 fraction bits.
  wire [30:0] size_s_x = in_data[`DERIVATIVE_TOKEN_SIZE_S_X], size_t_x = in_data[`DERIVATIVE_TOKEN_SIZE_T_X];
  wire [30:0] size_s_y = in_data[`DERIVATIVE_TOKEN_SIZE_S_Y], size_t_y = in_data[`DERIVATIVE_TOKEN_SIZE_T_Y];
  wire minus_s_x = in_data[`DERIVATIVE_TOKEN_S_X_TOP], minus_t_x = in_data[`DERIVATIVE_TOKEN_T_X_TOP];
  wire minus_s_y = in_data[`DERIVATIVE_TOKEN_S_Y_TOP], minus_t_y = in_data[`DERIVATIVE_TOKEN_T_Y_TOP];
  wire signed [39:0] p_s_x = minus_s_x ? -$signed({9'd0, size_s_x}) : $signed({9'd0, size_s_x});
  wire signed [39:0] p_t_x = minus_t_x ? -$signed({9'd0, size_t_x}) : $signed({9'd0, size_t_x});
  wire signed [39:0] p_s_y = minus_s_y ? -$signed({9'd0, size_s_y}) : $signed({9'd0, size_s_y});
  wire signed [39:0] p_t_y = minus_t_y ? -$signed({9'd0, size_t_y}) : $signed({9'd0, size_t_y});
  logic signed [39:0] s_x[0:3], t_x[0:3], s_y[0:3], t_y[0:3];  // multiplied by 128, 118, 90 and 49
  logic signed [46:0] product_1, product_2;
  logic signed [46:0] direct, crossed;
  assign direct = $signed({24'd0, size_s_x[30:8]}) * $signed({24'd0, size_t_y[30:8]});
  assign crossed = $signed({24'd0, size_t_x[30:8]}) * $signed({24'd0, size_s_y[30:8]});
  always_ff @(posedge clk)
    if (in_pop) begin
      with_it[1] <= in_data[WITH_BITS-1:0];
      s_x[0] <= p_s_x <<< 7;
      t_x[0] <= p_t_x <<< 7;
      s_y[0] <= p_s_y <<< 7;
      t_y[0] <= p_t_y <<< 7;
      s_x[1] <= p_s_x * `AXIS_COSINE_1;
      t_x[1] <= p_t_x * `AXIS_COSINE_1;
      s_y[1] <= p_s_y * `AXIS_COSINE_1;
      t_y[1] <= p_t_y * `AXIS_COSINE_1;
      s_x[2] <= p_s_x * `AXIS_COSINE_2;
      t_x[2] <= p_t_x * `AXIS_COSINE_2;
      s_y[2] <= p_s_y * `AXIS_COSINE_2;
      t_y[2] <= p_t_y * `AXIS_COSINE_2;
      s_x[3] <= p_s_x * `AXIS_COSINE_3;
      t_x[3] <= p_t_x * `AXIS_COSINE_3;
      s_y[3] <= p_s_y * `AXIS_COSINE_3;
      t_y[3] <= p_t_y * `AXIS_COSINE_3;
      product_1 <= minus_s_x != minus_t_y ? -direct : direct;
      product_2 <= minus_t_x != minus_s_y ? -crossed : crossed;
    end

  // 2: candidates and area. A group has SLOTS neighbouring candidates.
  wire signed [47:0] determinant = $signed({product_1[46], product_1}) - $signed({product_2[46], product_2});
  wire [47:0] area_magnitude = determinant < 0 ? -determinant : determinant;
  wire unused_area = &{1'b0, area_magnitude[47]};
  always_ff @(posedge clk)
    if (move) area[2] <= area_magnitude[46:0];

  logic [SLOTS*MEASURE_BITS-1:0] measures;  // of group_4
  generate
    for (i = 0; i < SLOTS; i = i + 1) begin : g_slot
      localparam integer FIRST = i * STEP;
      wire [2:0] direction = FIRST[2:0] + GROUP_STEP * {1'b0, group_1};
      logic signed [40:0] sum_s, sum_t;
      axis_sum #(.BITS(40)) of_s (
        .direction, .x128(s_x[0]), .x118(s_x[1]), .x90(s_x[2]), .x49(s_x[3]),
        .y128(s_y[0]), .y118(s_y[1]), .y90(s_y[2]), .y49(s_y[3]), .sum(sum_s));
      axis_sum #(.BITS(40)) of_t (
        .direction, .x128(t_x[0]), .x118(t_x[1]), .x90(t_x[2]), .x49(t_x[3]),
        .y128(t_y[0]), .y118(t_y[1]), .y90(t_y[2]), .y49(t_y[3]), .sum(sum_t));
      wire [40:0] magnitude_s = sum_s < 0 ? -sum_s : sum_s;
      wire [40:0] magnitude_t = sum_t < 0 ? -sum_t : sum_t;
      wire unused = &{1'b0, magnitude_s[6:0], magnitude_t[6:0]};
      logic [30:0] s, t;
      always_ff @(posedge clk)
        if (move) begin
          s <= magnitude_s[40:38] != 3'd0 ? 31'h7FFFFFFF : magnitude_s[37:7];
          t <= magnitude_t[40:38] != 3'd0 ? 31'h7FFFFFFF : magnitude_t[37:7];
        end
      // 3 and 4: its measure.
      if (EXACT != 0) begin : g_exact
        logic [61:0] ss, tt;
        logic [62:0] squares;
        always_ff @(posedge clk)
          if (move) begin
            ss <= {31'd0, s} * {31'd0, s};
            tt <= {31'd0, t} * {31'd0, t};
            squares <= {1'b0, ss} + {1'b0, tt};
          end
        assign measures[i*MEASURE_BITS +: MEASURE_BITS] = squares;
      end else begin : g_rule
        logic [31:0] low, high, low_3, high_3, longer;
        side_length #(.RULE(RULE)) side (.s, .t, .low, .high);
        always_ff @(posedge clk)
          if (move) begin
            low_3 <= low;
            high_3 <= high;
            longer <= low_3 > high_3 ? low_3 : high_3;
          end
        assign measures[i*MEASURE_BITS +: MEASURE_BITS] = longer;
      end
    end
  endgenerate

  // 5: the longest of up to four; 6: of both halves of a group and of the previous groups. The first of equal
  // candidates wins, so only a longer one replaces another.
  localparam integer PARTS = SLOTS > 4 ? 2 : 1;
  localparam integer EACH = SLOTS / PARTS;
  logic [PARTS*MEASURE_BITS-1:0] longest_5;
  logic [PARTS*3-1:0] which_5;  // slot
  generate
    for (i = 0; i < PARTS; i = i + 1) begin : g_part
      logic [MEASURE_BITS-1:0] longest;
      logic [2:0] which;
      localparam integer BEGIN = i * EACH;
      integer j;
      always_comb begin
        longest = measures[i*EACH*MEASURE_BITS +: MEASURE_BITS];
        which = BEGIN[2:0];
        for (j = 1; j < EACH; j = j + 1)
          if (measures[(i*EACH+j)*MEASURE_BITS +: MEASURE_BITS] > longest) begin
            longest = measures[(i*EACH+j)*MEASURE_BITS +: MEASURE_BITS];
            which = BEGIN[2:0] + j[2:0];
          end
      end
      always_ff @(posedge clk)
        if (move) begin
          longest_5[i*MEASURE_BITS +: MEASURE_BITS] <= longest;
          which_5[i*3 +: 3] <= which;
        end
    end
  endgenerate

  logic [MEASURE_BITS-1:0] longest_6, group_longest;
  logic [2:0] direction_6, group_slot;
  generate
    if (PARTS == 2) begin : g_two_parts
      wire second = longest_5[MEASURE_BITS +: MEASURE_BITS] > longest_5[0 +: MEASURE_BITS];
      assign group_longest = second ? longest_5[MEASURE_BITS +: MEASURE_BITS] : longest_5[0 +: MEASURE_BITS];
      assign group_slot = second ? which_5[5:3] : which_5[2:0];
    end else begin : g_one_part
      assign group_longest = longest_5;
      assign group_slot = which_5;
    end
  endgenerate
  wire [2:0] group_direction = SLOT_STEP * group_slot + GROUP_STEP * {1'b0, group_5};
  always_ff @(posedge clk)
    if (move && valid[5] && (group_5 == 2'd0 || group_longest > longest_6)) begin
      longest_6 <= group_longest;
      direction_6 <= group_direction;
    end

  // 7: multiples of the coordinate differences; 8: their sum for the chosen direction.
  wire signed [40:0] d_s_x = {{8{with_it[6][`DERIVATIVE_TOKEN_S_X_TOP]}}, with_it[6][`DERIVATIVE_TOKEN_S_X]};
  wire signed [40:0] d_t_x = {{8{with_it[6][`DERIVATIVE_TOKEN_T_X_TOP]}}, with_it[6][`DERIVATIVE_TOKEN_T_X]};
  wire signed [40:0] d_s_y = {{8{with_it[6][`DERIVATIVE_TOKEN_S_Y_TOP]}}, with_it[6][`DERIVATIVE_TOKEN_S_Y]};
  wire signed [40:0] d_t_y = {{8{with_it[6][`DERIVATIVE_TOKEN_T_Y_TOP]}}, with_it[6][`DERIVATIVE_TOKEN_T_Y]};
  logic signed [40:0] m_s_x[0:3], m_t_x[0:3], m_s_y[0:3], m_t_y[0:3];
  logic [2:0] direction_7;
  always_ff @(posedge clk)
    if (move) begin
      direction_7 <= direction_6;
      m_s_x[0] <= d_s_x <<< 7;
      m_t_x[0] <= d_t_x <<< 7;
      m_s_y[0] <= d_s_y <<< 7;
      m_t_y[0] <= d_t_y <<< 7;
      m_s_x[1] <= d_s_x * `AXIS_COSINE_1;
      m_t_x[1] <= d_t_x * `AXIS_COSINE_1;
      m_s_y[1] <= d_s_y * `AXIS_COSINE_1;
      m_t_y[1] <= d_t_y * `AXIS_COSINE_1;
      m_s_x[2] <= d_s_x * `AXIS_COSINE_2;
      m_t_x[2] <= d_t_x * `AXIS_COSINE_2;
      m_s_y[2] <= d_s_y * `AXIS_COSINE_2;
      m_t_y[2] <= d_t_y * `AXIS_COSINE_2;
      m_s_x[3] <= d_s_x * `AXIS_COSINE_3;
      m_t_x[3] <= d_t_x * `AXIS_COSINE_3;
      m_s_y[3] <= d_s_y * `AXIS_COSINE_3;
      m_t_y[3] <= d_t_y * `AXIS_COSINE_3;
    end
  logic signed [41:0] axis_sum_s, axis_sum_t;
  axis_sum #(.BITS(41)) of_axis_s (
    .direction(direction_7), .x128(m_s_x[0]), .x118(m_s_x[1]), .x90(m_s_x[2]), .x49(m_s_x[3]),
    .y128(m_s_y[0]), .y118(m_s_y[1]), .y90(m_s_y[2]), .y49(m_s_y[3]), .sum(axis_sum_s));
  axis_sum #(.BITS(41)) of_axis_t (
    .direction(direction_7), .x128(m_t_x[0]), .x118(m_t_x[1]), .x90(m_t_x[2]), .x49(m_t_x[3]),
    .y128(m_t_y[0]), .y118(m_t_y[1]), .y90(m_t_y[2]), .y49(m_t_y[3]), .sum(axis_sum_t));
  logic signed [33:0] axis_s, axis_t;
  axis_round rounded_s (.sum(axis_sum_s), .axis(axis_s));
  axis_round rounded_t (.sum(axis_sum_t), .axis(axis_t));

  logic [31:0] d_max;
  logic signed [33:0] axis_s_out, axis_t_out;
  generate
    if (EXACT != 0) begin : g_root
      root_pipe longest_root (.clk, .move, .radicand(longest_6), .root(d_max));
      logic signed [33:0] axis_s_at[8:21], axis_t_at[8:21];
      for (i = 8; i <= 21; i = i + 1) begin : g_axis
        always_ff @(posedge clk)
          if (move) begin
            axis_s_at[i] <= i == 8 ? axis_s : axis_s_at[i > 8 ? i - 1 : 8];
            axis_t_at[i] <= i == 8 ? axis_t : axis_t_at[i > 8 ? i - 1 : 8];
          end
      end
      assign axis_s_out = axis_s_at[21];
      assign axis_t_out = axis_t_at[21];
    end else begin : g_measured
      always_ff @(posedge clk)
        if (move) d_max <= longest_6;
      assign axis_s_out = axis_s;
      assign axis_t_out = axis_t;
    end
  endgenerate

  wire unused_with = &{1'b0, with_it[REGISTERS]};
  assign out_data[`FOOTPRINT_TOKEN_TICKET] = with_it[REGISTERS][`DERIVATIVE_TOKEN_TICKET];
  assign out_data[`FOOTPRINT_TOKEN_S] = with_it[REGISTERS][`DERIVATIVE_TOKEN_S];
  assign out_data[`FOOTPRINT_TOKEN_T] = with_it[REGISTERS][`DERIVATIVE_TOKEN_T];
  assign out_data[`FOOTPRINT_TOKEN_AXIS_S] = axis_s_out;
  assign out_data[`FOOTPRINT_TOKEN_AXIS_T] = axis_t_out;
  assign out_data[`FOOTPRINT_TOKEN_D_MAX] = d_max;
  assign out_data[`FOOTPRINT_TOKEN_MINOR] = area[REGISTERS];
endmodule
