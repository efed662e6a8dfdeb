// SPDX-License-Identifier: MIT
// The term that `corrected` adds to n + y, for all y: word y / 512 of its table
// (docs/reference/texture/formats.md, "Logarithm").
`include "tables.svh"
module log2_corrected_proof (
  input logic [11:0] y
);
  logic [9:0] correction;
  log2_correction #(.RULE(`LOG2_CORRECTED)) of_y (.y, .correction);
  wire [8*`LOG2_CORRECTION_BITS-1:0] words = `LOG2_CORRECTION >> y / 12'd512 * `LOG2_CORRECTION_BITS;
  always @* a_word: assert (correction == words % (1 << `LOG2_CORRECTION_BITS));
endmodule
