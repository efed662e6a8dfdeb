// SPDX-License-Identifier: MIT
// The logarithm `exact`, for all n and y and any stalls of the pipeline: equal to the specification, and monotone
// (docs/reference/texture/formats.md, "Logarithm").
`include "tables.svh"
module log2_exact_proof (
  input logic clk,
  input logic move,
  input logic signed [17:0] sum
);
  logic signed [17:0] here_1, here_2, next_1, next_2, lb_here, lb_next;
  reg [1:0] there = 2'd0;
  always_ff @(posedge clk)
    if (move) begin
      there <= {there[0], 1'b1};
      here_1 <= sum;
      next_1 <= sum + 18'sd1;
      here_2 <= here_1;
      next_2 <= next_1;
    end
  log2_exact of_here (.clk, .move, .y_1(here_1[11:0]), .sum_2(here_2), .lb(lb_here));
  log2_exact of_next (.clk, .move, .y_1(next_1[11:0]), .sum_2(next_2), .lb(lb_next));

  wire [11:0] y = here_2[11:0];
  wire [11:0] i = y / 12'd64, r = y % 12'd64;
  wire [65*`LOG2_TABLE_BITS-1:0] from_i = `LOG2_TABLE >> i * `LOG2_TABLE_BITS;
  wire [17:0] word = from_i[`LOG2_TABLE_BITS-1:0], above = from_i[2*`LOG2_TABLE_BITS-1:`LOG2_TABLE_BITS];
  wire [17:0] page = word + ((above - word) * r + 18'd32) / 18'd64;
  wire signed [17:0] n = here_2 >>> 12;
  always @* if (there == 2'd3) begin
    a_page: assert (lb_here == (n <<< 12) + $signed(page));
    a_rises: assert (here_2 == 18'sd131071 || lb_next >= lb_here);
  end
endmodule
