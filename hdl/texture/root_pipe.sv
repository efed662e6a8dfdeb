// SPDX-License-Identifier: MIT
// Integer square root of a 63-bit sum of squares, U31.32 to U16.16, two bits per stage. The radicand is registered at
// the input; 15 registers are inside, and the root is valid in the cycle of the 16th stage.
module root_pipe (
  input  logic        clk,
  input  logic        move,
  input  logic [62:0] radicand,
  output logic [31:0] root
);
  logic [31:0] roots[1:15];
  logic [33:0] rests[1:15];
  logic [63:0] digits[1:15];
`ifdef FORMAL
  reg [15:1] f_come = 15'd0;
  reg [63:0] f_radicands[1:15];
`endif
  genvar i;
  generate
    for (i = 0; i < 16; i = i + 1) begin : g_stage
      wire [31:0] known = i == 0 ? 32'd0 : roots[i > 0 ? i : 1];
      wire [33:0] rest = i == 0 ? 34'd0 : rests[i > 0 ? i : 1];
      wire [63:0] to_come = i == 0 ? {1'b0, radicand} : digits[i > 0 ? i : 1];
      logic [31:0] next_root;
      logic [33:0] next_rest;
      logic [63:0] next_digits;
      root_stage stage (.root(known), .rest, .digits(to_come), .next_root, .next_rest, .next_digits);
      if (i < 15) begin : g_register
        always_ff @(posedge clk)
          if (move) begin
            roots[i+1] <= next_root;
            rests[i+1] <= next_rest;
            digits[i+1] <= next_digits;
          end
      end else begin : g_out
        assign root = next_root;
        wire unused = &{1'b0, next_rest, next_digits};
      end
`ifdef FORMAL
      // In each stage, the remaining digits belong to the radicand of its root and remainder, and nothing is truncated.
      // The step of a stage is proved in tb/hdl/formal/root_stage_proof.sv.
      wire f_there = i == 0 ? 1'b1 : f_come[i > 0 ? i : 1];
      wire [63:0] f_whole = i == 0 ? {1'b0, radicand} : f_radicands[i > 0 ? i : 1];
      if (i < 15) begin : g_known
        always @(posedge clk)
          if (move) begin
            f_come[i+1] <= f_there;
            f_radicands[i+1] <= f_whole;
          end
      end
      always @* if (f_there) begin
        assert (to_come == f_whole << 4 * i);
        assert ({32'd0, known} < 64'd1 << 2 * i);
        assert (rest <= {1'b0, known, 1'b0});
      end
`endif
    end
  endgenerate
endmodule
