// SPDX-License-Identifier: MIT
// The pass over the banks in which each hitting texel is read (docs/reference/texture/cache.md, "Banks"): a bank reads
// one word per pass, and texels of the same word share it.
module bank_passes #(
  parameter integer WORD_BITS = 12,  // of the word address, the bank in its low bits
  parameter integer BANK_BITS = 4
) (
  input  logic [3:0]             hit,
  input  logic [4*WORD_BITS-1:0] words,
  output logic [7:0]             pass,   // of each texel
  output logic [2:0]             passes  // 0 to 4
);
  wire [WORD_BITS-1:0] word_0 = words[0 +: WORD_BITS], word_1 = words[WORD_BITS +: WORD_BITS];
  wire [WORD_BITS-1:0] word_2 = words[2*WORD_BITS +: WORD_BITS], word_3 = words[3*WORD_BITS +: WORD_BITS];
  wire [BANK_BITS-1:0] bank_0 = word_0[BANK_BITS-1:0], bank_1 = word_1[BANK_BITS-1:0];
  wire [BANK_BITS-1:0] bank_2 = word_2[BANK_BITS-1:0], bank_3 = word_3[BANK_BITS-1:0];
  // For each pair of texels: do they hit in the same bank, and in the same word?
  wire bank_10 = hit[1] && hit[0] && bank_1 == bank_0, word_10 = bank_10 && word_1 == word_0;
  wire bank_20 = hit[2] && hit[0] && bank_2 == bank_0, word_20 = bank_20 && word_2 == word_0;
  wire bank_21 = hit[2] && hit[1] && bank_2 == bank_1, word_21 = bank_21 && word_2 == word_1;
  wire bank_30 = hit[3] && hit[0] && bank_3 == bank_0, word_30 = bank_30 && word_3 == word_0;
  wire bank_31 = hit[3] && hit[1] && bank_3 == bank_1, word_31 = bank_31 && word_3 == word_1;
  wire bank_32 = hit[3] && hit[2] && bank_3 == bank_2, word_32 = bank_32 && word_3 == word_2;
  // The number of distinct words before it in its bank.
  wire first_1 = !word_10, first_2 = !word_20 && !word_21;
  wire [1:0] pass_1 = word_10 ? 2'd0 : {1'b0, bank_10};
  wire [1:0] pass_2 = word_20 ? 2'd0 : word_21 ? pass_1 : {1'b0, bank_20} + {1'b0, bank_21 && first_1};
  wire [1:0] pass_3 = word_30 ? 2'd0 : word_31 ? pass_1 : word_32 ? pass_2 :
                      {1'b0, bank_30} + {1'b0, bank_31 && first_1} + {1'b0, bank_32 && first_2};
  assign pass = {pass_3, pass_2, pass_1, 2'd0};
  wire [1:0] most_1 = hit[1] ? pass_1 : 2'd0;
  wire [1:0] most_2 = hit[2] && pass_2 > most_1 ? pass_2 : most_1;
  wire [1:0] most_3 = hit[3] && pass_3 > most_2 ? pass_3 : most_2;
  assign passes = hit == 4'd0 ? 3'd0 : {1'b0, most_3} + 3'd1;
endmodule
