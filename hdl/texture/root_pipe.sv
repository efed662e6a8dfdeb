// SPDX-License-Identifier: MIT
// Integer square root of a 63-bit sum of squares, U31.32 to U16.16, two bits a stage. The radicand
// stands in a register before it; 15 registers are inside, and the root comes in the same clock as the
// 16th stage works.
module root_pipe (
  input  logic        clk,
  input  logic        move,
  input  logic [62:0] radicand,
  output logic [31:0] root
);
  logic [31:0] roots[1:15];
  logic [33:0] rests[1:15];
  logic [63:0] digits[1:15];
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
    end
  endgenerate
endmodule
