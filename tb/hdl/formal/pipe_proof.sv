// SPDX-License-Identifier: MIT
// A pipeline neither loses nor creates tokens, and stalls as a whole while its last stage cannot leave.
module pipe_proof #(
  parameter integer STAGES = 5
) (
  input logic clk,
  input logic rst_n,
  input logic in_valid,
  input logic out_ready
);
  logic in_pop, out_push, move;
  logic [STAGES-1:0] valid;
  pipe #(.STAGES(STAGES)) unit (.clk, .rst_n, .in_valid, .in_pop, .out_ready, .out_push, .move, .valid);

  reg past = 1'b0, stood = 1'b0;
  reg [STAGES-1:0] before_it;
  reg [7:0] inside;
  always @(posedge clk) begin
    past <= 1'b1;
    stood <= rst_n && valid[STAGES-1] && !out_ready;
    before_it <= valid;
    inside <= !rst_n ? 8'd0 : inside + {7'd0, in_pop} - {7'd0, out_push};
  end
  reg [7:0] ones;
  integer i;
  always @* begin
    ones = 8'd0;
    for (i = 0; i < STAGES; i = i + 1) ones = ones + {7'd0, valid[i]};
  end
  always @* if (!past) assume (!rst_n);
  always @* if (past) begin
    a_conserved: assert (inside == ones);
    a_pop: assert (!in_pop || in_valid);
    a_push: assert (!out_push || out_ready);
    a_stands: assert (!stood || valid == before_it);
    a_no_pop: assert (!(valid[STAGES-1] && !out_ready) || (!in_pop && !out_push));
    a_free: assert (!out_ready || in_pop == in_valid);
  end
endmodule
