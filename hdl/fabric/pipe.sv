// SPDX-License-Identifier: MIT
// Valid bits of a pipeline that stalls as a whole while its last stage cannot leave (docs/explanation/fabric.md;
// docs/reference/texture/hardware.md, "Stages"). STAGES is the number of registers: a unit with a latency of n cycles
// has n - 1, since the output link is the last one. The unit owns the data registers and enables them with `move`.
module pipe #(
  parameter integer STAGES = 1
) (
  input  logic              clk,
  input  logic              rst_n,
  input  logic              in_valid,
  output logic              in_pop,
  input  logic              out_ready,
  output logic              out_push,
  output logic              move,
  output logic [STAGES-1:0] valid  // of each register, the first one in bit 0
);
  assign move = out_ready || !valid[STAGES-1];
  assign in_pop = in_valid && move;
  assign out_push = out_ready && valid[STAGES-1];

  generate
    if (STAGES == 1) begin : g_one
      always_ff @(posedge clk)
        if (!rst_n) valid <= 1'b0;
        else if (move) valid <= in_valid;
    end else begin : g_more
      always_ff @(posedge clk)
        if (!rst_n) valid <= {STAGES{1'b0}};
        else if (move) valid <= {valid[STAGES-2:0], in_valid};
    end
  endgenerate
endmodule
