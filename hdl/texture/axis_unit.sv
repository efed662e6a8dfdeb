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

  // The fields below the sizes accompany the fragment: ticket, coordinate, differences.
  localparam integer WITH_BITS = `DERIVATIVE_TOKEN_SIZE_S_X_FIRST;
  logic [WITH_BITS-1:0] with_it[1:REGISTERS];
  logic [46:0] area[2:REGISTERS];
  genvar i, k;
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

  // 1: multiples of the derivatives in texels, with the sign of their difference, in the order s and t along the row, s
  // and t along the column; products for the area, of magnitudes with 8 fraction bits.
  wire [4*31-1:0] sizes = {in_data[`DERIVATIVE_TOKEN_SIZE_T_Y], in_data[`DERIVATIVE_TOKEN_SIZE_S_Y],
                           in_data[`DERIVATIVE_TOKEN_SIZE_T_X], in_data[`DERIVATIVE_TOKEN_SIZE_S_X]};
  wire [3:0] minus = {in_data[`DERIVATIVE_TOKEN_T_Y_TOP], in_data[`DERIVATIVE_TOKEN_S_Y_TOP],
                      in_data[`DERIVATIVE_TOKEN_T_X_TOP], in_data[`DERIVATIVE_TOKEN_S_X_TOP]};
  logic [4*40-1:0] multiples[0:3];
  generate
    for (i = 0; i < 4; i = i + 1) begin : g_multiples
      wire signed [39:0] size = {9'd0, sizes[31*i +: 31]};
      wire [4*40-1:0] now;
      axis_multiples #(.BITS(40)) of_size (.value(minus[i] ? -size : size), .multiples(now));
      always_ff @(posedge clk)
        if (in_pop) multiples[i] <= now;
    end
  endgenerate
  logic [45:0] direct, crossed;
  logic subtract;  // the products have the same sign
  always_ff @(posedge clk)
    if (in_pop) begin
      with_it[1] <= in_data[WITH_BITS-1:0];
      direct <= {23'd0, sizes[8 +: 23]} * {23'd0, sizes[31*3+8 +: 23]};
      crossed <= {23'd0, sizes[31+8 +: 23]} * {23'd0, sizes[31*2+8 +: 23]};
      subtract <= ^minus == 1'b0;
    end

  // 2: candidates and area. A group has SLOTS neighbouring candidates.
  wire signed [47:0] determinant = {2'd0, direct} + ({2'd0, crossed} ^ {48{subtract}}) + {47'd0, subtract};
  wire [47:0] area_magnitude = determinant < 0 ? -determinant : determinant;
  always_ff @(posedge clk)
    if (move) area[2] <= area_magnitude[46:0];

  logic [SLOTS*MEASURE_BITS-1:0] measures;  // of group_4
  generate
    for (i = 0; i < SLOTS; i = i + 1) begin : g_slot
      localparam integer FIRST = i * STEP;
      wire [2:0] direction = FIRST[2:0] + GROUP_STEP * {1'b0, group_1};
      // Along s and t.
      wire [61:0] limited;
      for (k = 0; k < 2; k = k + 1) begin : g_side
        wire [39:0] of_x, of_y;
        wire carry;
        axis_terms #(.BITS(40)) terms (.direction, .x(multiples[k]), .y(multiples[k+2]), .of_x, .of_y, .carry);
        wire signed [40:0] sum = {of_x[39], of_x} + {of_y[39], of_y} + {40'd0, carry};
        wire [40:0] magnitude = sum < 0 ? -sum : sum;
        assign limited[31*k +: 31] = magnitude[40:38] != 3'd0 ? 31'h7FFFFFFF : magnitude[37:7];
      end
      logic [30:0] s, t;
      always_ff @(posedge clk)
        if (move) begin
          s <= limited[30:0];
          t <= limited[61:31];
        end
      // 3 and 4: its measure.
      if (EXACT != 0) begin : g_exact
        wire [61:0] square_s, square_t;
        square of_size_s (.value(s), .squared(square_s));
        square of_size_t (.value(t), .squared(square_t));
        logic [61:0] ss, tt;
        logic [62:0] squares;
        always_ff @(posedge clk)
          if (move) begin
            ss <= square_s;
            tt <= square_t;
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

  // 7: multiples of the coordinate differences for the chosen direction; 8: their sum, rounded at 7 bits away from zero,
  // so that mirrored coordinates give mirrored samples.
  wire [4*33-1:0] differences = {with_it[6][`DERIVATIVE_TOKEN_T_Y], with_it[6][`DERIVATIVE_TOKEN_S_Y],
                                 with_it[6][`DERIVATIVE_TOKEN_T_X], with_it[6][`DERIVATIVE_TOKEN_S_X]};
  wire [4*41-1:0] steps[0:3];
  wire [2*34-1:0] major;  // s, t
  generate
    for (i = 0; i < 4; i = i + 1) begin : g_steps
      axis_multiples #(.BITS(41)) of_difference (
        .value({{8{differences[33*i+32]}}, differences[33*i +: 33]}), .multiples(steps[i]));
    end
    for (i = 0; i < 2; i = i + 1) begin : g_axis
      wire [40:0] of_x, of_y;
      wire carry;
      axis_terms #(.BITS(41)) terms (.direction(direction_6), .x(steps[i]), .y(steps[i+2]), .of_x, .of_y, .carry);
      logic [40:0] x_7, y_7;
      logic carry_7;
      always_ff @(posedge clk)
        if (move) begin
          x_7 <= of_x;
          y_7 <= of_y;
          carry_7 <= carry;
        end
      wire [41:0] sum = {x_7[40], x_7} + {y_7[40], y_7} + {41'd0, carry_7};
      wire [41:0] rounded = sum + 42'd63 + {41'd0, !sum[41]};
      assign major[34*i +: 34] = rounded[40:7];
    end
  endgenerate

  logic [31:0] d_max;
  logic [2*34-1:0] axis_out;
  generate
    if (EXACT != 0) begin : g_root
      root_pipe longest_root (.clk, .move, .radicand(longest_6), .root(d_max));
      logic [2*34-1:0] axis_at[8:21];
      for (i = 8; i <= 21; i = i + 1) begin : g_axis
        always_ff @(posedge clk)
          if (move) axis_at[i] <= i == 8 ? major : axis_at[i > 8 ? i - 1 : 8];
      end
      assign axis_out = axis_at[21];
    end else begin : g_measured
      always_ff @(posedge clk)
        if (move) d_max <= longest_6;
      assign axis_out = major;
    end
  endgenerate

`ifdef FOOTPRINT_TOKEN_DIAGONAL
  // Directions 2 and 6 are the diagonals of the pixel.
  wire diagonal_6 = direction_6[1:0] == 2'd2;
  logic [REGISTERS:7] diagonal;
  generate
    for (i = 7; i <= REGISTERS; i = i + 1) begin : g_diagonal
      always_ff @(posedge clk)
        if (move) diagonal[i] <= i == 7 ? diagonal_6 : diagonal[i > 7 ? i - 1 : 7];
    end
  endgenerate
  assign out_data[`FOOTPRINT_TOKEN_DIAGONAL] = diagonal[REGISTERS];
`endif
  wire unused_with = &{1'b0, with_it[REGISTERS]};
  assign out_data[`FOOTPRINT_TOKEN_TICKET] = with_it[REGISTERS][`DERIVATIVE_TOKEN_TICKET];
  assign out_data[`FOOTPRINT_TOKEN_S] = with_it[REGISTERS][`DERIVATIVE_TOKEN_S];
  assign out_data[`FOOTPRINT_TOKEN_T] = with_it[REGISTERS][`DERIVATIVE_TOKEN_T];
  assign out_data[`FOOTPRINT_TOKEN_AXIS_S] = axis_out[33:0];
  assign out_data[`FOOTPRINT_TOKEN_AXIS_T] = axis_out[67:34];
  assign out_data[`FOOTPRINT_TOKEN_D_MAX] = d_max;
  assign out_data[`FOOTPRINT_TOKEN_MINOR] = area[REGISTERS];
endmodule
