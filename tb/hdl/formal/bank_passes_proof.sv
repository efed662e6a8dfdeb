// SPDX-License-Identifier: MIT
// For any four words and any hits among them: no pass reads two words of a bank, each texel that hits has a pass
// among those that are made, and no pass is empty.
module bank_passes_proof #(
  parameter integer WORD_BITS = 12,
  parameter integer BANK_BITS = 4
) (
  input logic [3:0]             hit,
  input logic [4*WORD_BITS-1:0] words
);
  logic [7:0] pass;
  logic [2:0] passes;
  bank_passes #(.WORD_BITS(WORD_BITS), .BANK_BITS(BANK_BITS)) unit (.hit, .words, .pass, .passes);
  // Every pass reads from some bank: the texels of one bank that hit have passes 0, 1, ... in sequence, so the
  // number of passes is the largest number of distinct words in a bank.
  genvar i, j;
  generate
    for (i = 0; i < 4; i = i + 1) begin : g_texel
      wire [WORD_BITS-1:0] word = words[i*WORD_BITS +: WORD_BITS];
      wire [1:0] of = pass[2*i +: 2];
      // An earlier pass of the bank has a texel in it.
      wire [3:0] before_it;
      for (j = 0; j < 4; j = j + 1) begin : g_other
        wire [WORD_BITS-1:0] other = words[j*WORD_BITS +: WORD_BITS];
        wire meet = hit[i] && hit[j] && word[BANK_BITS-1:0] == other[BANK_BITS-1:0];
        assign before_it[j] = meet && pass[2*j +: 2] + 2'd1 == of;
        always @* begin
          // One word per pass; texels of the same word share a pass.
          assert (!meet || of != pass[2*j +: 2] || word == other);
          assert (!meet || word != other || of == pass[2*j +: 2]);
        end
      end
      always @* begin
        // The pass is made, and there is no gap before it.
        assert (!hit[i] || {1'b0, of} < passes);
        assert (!hit[i] || of == 2'd0 || before_it != 4'd0);
      end
    end
  endgenerate
  wire [3:0] in_last;
  generate
    for (i = 0; i < 4; i = i + 1) begin : g_last
      assign in_last[i] = hit[i] && {1'b0, pass[2*i +: 2]} + 3'd1 == passes;
    end
  endgenerate
  always @* a_not_in_vain: assert (passes == 3'd0 ? hit == 4'd0 : in_last != 4'd0);
endmodule
