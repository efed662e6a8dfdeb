// SPDX-License-Identifier: MIT
// Lengths of both sides of a footprint and the coordinate difference along the longer one, for `axes = two`. Two
// stages, 19 with `exact` (docs/reference/datasheets.md, "FootprintUnit").
`include "tokens.svh"
`include "tables.svh"
module footprint_unit #(
  parameter integer RULE = `CHOSEN_FOOTPRINT
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
  localparam integer STAGES = RULE == `FOOTPRINT_EXACT ? 18 : 1;
  logic move;
  logic [STAGES-1:0] valid;
  pipe #(.STAGES(STAGES)) stages (.clk, .rst_n, .in_valid, .in_pop, .out_ready, .out_push, .move, .valid);
  wire unused = &{1'b0, valid};

  wire [30:0] s_x = in_data[`DERIVATIVE_TOKEN_SIZE_S_X], t_x = in_data[`DERIVATIVE_TOKEN_SIZE_T_X];
  wire [30:0] s_y = in_data[`DERIVATIVE_TOKEN_SIZE_S_Y], t_y = in_data[`DERIVATIVE_TOKEN_SIZE_T_Y];
  // Ticket, coordinate and both differences, until the longer side is known.
  localparam integer WITH_BITS = `DERIVATIVE_TOKEN_SIZE_S_X_FIRST;
  wire [WITH_BITS-1:0] with_in = in_data[WITH_BITS-1:0];
  logic [WITH_BITS-1:0] with_out;
  logic [31:0] d_x, d_y;
  logic column;  // the longer side is along the column; if equal, the row

  generate
    if (RULE == `FOOTPRINT_EXACT) begin : g_exact
      // Registers 1 and 2: squares, sums; 3 to 17: root bits; 18: the sides and the choice of the longer one.
      wire [61:0] square_s_x, square_t_x, square_s_y, square_t_y;
      square of_s_x (.value(s_x), .squared(square_s_x));
      square of_t_x (.value(t_x), .squared(square_t_x));
      square of_s_y (.value(s_y), .squared(square_s_y));
      square of_t_y (.value(t_y), .squared(square_t_y));
      logic [61:0] ss_x, tt_x, ss_y, tt_y;
      logic [62:0] sum_x, sum_y;
      logic [15:0] longer;  // from register 3 on, the newest in bit 0
      logic [WITH_BITS-1:0] with_it[1:18];
      logic [31:0] root_x, root_y;
      root_pipe of_x (.clk, .move, .radicand(sum_x), .root(root_x));
      root_pipe of_y (.clk, .move, .radicand(sum_y), .root(root_y));
      always_ff @(posedge clk)
        if (move) begin
          ss_x <= square_s_x;
          tt_x <= square_t_x;
          ss_y <= square_s_y;
          tt_y <= square_t_y;
          sum_x <= {1'b0, ss_x} + {1'b0, tt_x};
          sum_y <= {1'b0, ss_y} + {1'b0, tt_y};
          longer <= {longer[14:0], sum_y > sum_x};
          d_x <= root_x;
          d_y <= root_y;
        end
      genvar i;
      for (i = 1; i <= 18; i = i + 1) begin : g_with
        always_ff @(posedge clk)
          if (move) with_it[i] <= i == 1 ? with_in : with_it[i > 1 ? i - 1 : 1];
      end
      assign with_out = with_it[18];
      assign column = longer[15];
    end else begin : g_rule
      logic [31:0] low_x, high_x, low_y, high_y;
      side_length #(.RULE(RULE)) of_x (.s(s_x), .t(t_x), .low(low_x), .high(high_x));
      side_length #(.RULE(RULE)) of_y (.s(s_y), .t(t_y), .low(low_y), .high(high_y));
      logic [31:0] low_x_1, high_x_1, low_y_1, high_y_1;
      always_ff @(posedge clk)
        if (move) begin
          low_x_1 <= low_x;
          high_x_1 <= high_x;
          low_y_1 <= low_y;
          high_y_1 <= high_y;
          with_out <= with_in;
        end
      assign d_x = low_x_1 > high_x_1 ? low_x_1 : high_x_1;
      assign d_y = low_y_1 > high_y_1 ? low_y_1 : high_y_1;
      assign column = d_y > d_x;
    end
  endgenerate

  assign out_data[`FOOTPRINT_TOKEN_TICKET] = with_out[`DERIVATIVE_TOKEN_TICKET];
  assign out_data[`FOOTPRINT_TOKEN_S] = with_out[`DERIVATIVE_TOKEN_S];
  assign out_data[`FOOTPRINT_TOKEN_T] = with_out[`DERIVATIVE_TOKEN_T];
  assign out_data[`FOOTPRINT_TOKEN_AXIS_S] =
      column ? with_out[`DERIVATIVE_TOKEN_S_Y] : with_out[`DERIVATIVE_TOKEN_S_X];
  assign out_data[`FOOTPRINT_TOKEN_AXIS_T] =
      column ? with_out[`DERIVATIVE_TOKEN_T_Y] : with_out[`DERIVATIVE_TOKEN_T_X];
  assign out_data[`FOOTPRINT_TOKEN_D_MAX] = column ? d_y : d_x;
  assign out_data[`FOOTPRINT_TOKEN_MINOR] = column ? d_x : d_y;
endmodule
