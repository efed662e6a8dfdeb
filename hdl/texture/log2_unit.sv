// SPDX-License-Identifier: MIT
// Binary logarithms of the longer side of a footprint and of the other side or the area, from which the minor side
// follows. `mitchell` is wiring after the leading one, latency 1; other configurations take three stages: leading one
// and shift, table, correction (docs/reference/datasheets.md, "Log2Unit").
`include "tokens.svh"
`include "tables.svh"
module log2_unit #(
  parameter integer RULE = `CHOSEN_LOG2
) (
  input  logic                             clk,
  input  logic                             rst_n,
  input  logic                             in_valid,
  output logic                             in_pop,
  input  logic [`FOOTPRINT_TOKEN_BITS-1:0] in_data,
  output logic                             out_push,
  input  logic                             out_ready,
  output logic [`LOG2_TOKEN_BITS-1:0]      out_data
);
  localparam integer WITH_BITS = `FOOTPRINT_TOKEN_D_MAX_FIRST;  // the fields below the sides pass through

  logic signed [17:0] major, minor;
  log2_value #(.BITS(`FOOTPRINT_TOKEN_D_MAX_BITS)) of_major (
    .value(in_data[`FOOTPRINT_TOKEN_D_MAX]), .mitchell(major));
  log2_value #(.BITS(`FOOTPRINT_TOKEN_MINOR_BITS)) of_minor (
    .value(in_data[`FOOTPRINT_TOKEN_MINOR]), .mitchell(minor));
  wire [WITH_BITS-1:0] with_it = in_data[WITH_BITS-1:0];

  generate
    if (RULE == `LOG2_MITCHELL) begin : g_mitchell
      wire unused = &{1'b0, clk, rst_n};
      assign in_pop = in_valid && out_ready;
      assign out_push = in_pop;
      assign out_data[`LOG2_TOKEN_LB_MINOR_TOP:0] = {minor, major, with_it};
`ifdef LOG2_TOKEN_DIAGONAL
      assign out_data[`LOG2_TOKEN_DIAGONAL] = in_data[`FOOTPRINT_TOKEN_DIAGONAL];
`endif
    end else begin : g_table
      logic move;
      logic [1:0] valid;
      pipe #(.STAGES(2)) stages (.clk, .rst_n, .in_valid, .in_pop, .out_ready, .out_push, .move, .valid);
      wire unused = &{1'b0, valid};

      logic signed [17:0] major_1, minor_1, major_2, minor_2;
      logic [WITH_BITS-1:0] with_1, with_2;
      always_ff @(posedge clk)
        if (move) begin
          major_1 <= major;
          minor_1 <= minor;
          with_1 <= with_it;
          major_2 <= major_1;
          minor_2 <= minor_1;
          with_2 <= with_1;
        end

      logic signed [17:0] lb_major, lb_minor;
      if (RULE == `LOG2_EXACT) begin : g_exact
        log2_exact of_longer (.clk, .move, .y_1(major_1[11:0]), .sum_2(major_2), .lb(lb_major));
        log2_exact of_other (.clk, .move, .y_1(minor_1[11:0]), .sum_2(minor_2), .lb(lb_minor));
      end else begin : g_correct
        logic [9:0] c_major, c_minor, c_major_2, c_minor_2;
        log2_correction #(.RULE(RULE)) of_longer (.y(major_1[11:0]), .correction(c_major));
        log2_correction #(.RULE(RULE)) of_other (.y(minor_1[11:0]), .correction(c_minor));
        always_ff @(posedge clk)
          if (move) begin
            c_major_2 <= c_major;
            c_minor_2 <= c_minor;
          end
        assign lb_major = major_2 + $signed({8'd0, c_major_2});
        assign lb_minor = minor_2 + $signed({8'd0, c_minor_2});
      end
      assign out_data[`LOG2_TOKEN_LB_MINOR_TOP:0] = {lb_minor, lb_major, with_2};
`ifdef LOG2_TOKEN_DIAGONAL
      logic diagonal_1, diagonal_2;
      always_ff @(posedge clk)
        if (move) begin
          diagonal_1 <= in_data[`FOOTPRINT_TOKEN_DIAGONAL];
          diagonal_2 <= diagonal_1;
        end
      assign out_data[`LOG2_TOKEN_DIAGONAL] = diagonal_2;
`endif
    end
  endgenerate
endmodule
