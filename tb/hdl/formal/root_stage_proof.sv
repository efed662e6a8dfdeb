// SPDX-License-Identifier: MIT
// Invariant of the square root's digit recurrence: the remainder is at most twice the root, so its upper bits,
// which have no registers, are zero. With b the two new bits of the root x, the remainder decreases by (4 x + b)^2
// - (4 x)^2 = b (8 x + b). So it remains the difference between the digits used so far and the square of the root;
// since it is at most twice the root, the root is the largest whose square fits.
module root_stage_proof (
  input logic [29:0] root,  // the two lowest of 32 bits are not known yet
  input logic [33:0] rest,
  input logic [3:0]  digits
);
  logic [31:0] next_root;
  logic [33:0] next_rest;
  logic [63:0] next_digits;
  root_stage unit (.root({2'd0, root}), .rest, .digits({digits, 60'd0}), .next_root, .next_rest, .next_digits);
  wire [1:0] bits = next_root[1:0];
  wire [37:0] once = {3'd0, root, 3'd0} + {36'd0, bits};
  wire [37:0] lost = (bits[0] ? once : 38'd0) + (bits[1] ? once << 1 : 38'd0);
  always @* begin
    assume (rest <= {3'd0, root, 1'b0});
    a_rest: assert (next_rest <= {1'b0, next_root, 1'b0});
    a_lost: assert ({4'd0, next_rest} + lost == {rest, digits});
    a_prefix: assert (next_root[31:2] == root);
  end
endmodule
