// SPDX-License-Identifier: MIT
// What the digit recurrence of a square root keeps: the rest is at most twice the root, so that its upper
// bits, which no register has, are zero; and each digit is the larger one that fits.
module root_stage_proof (
  input logic [29:0] root,  // of 32 bits the two lowest are still to come
  input logic [33:0] rest,
  input logic [3:0]  digits
);
  logic [31:0] next_root;
  logic [33:0] next_rest;
  logic [63:0] next_digits;
  root_stage unit (.root({2'd0, root}), .rest, .digits({digits, 60'd0}), .next_root, .next_rest, .next_digits);
  always @* begin
    assume (rest <= {3'd0, root, 1'b0});
    a_rest: assert (next_rest <= {1'b0, next_root, 1'b0});
    a_prefix: assert (next_root[31:2] == root);
  end
endmodule
