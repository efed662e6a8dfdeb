// SPDX-License-Identifier: MIT
// A ROM with one read port: the word addressed in cycle t is on the output register in t + 1 and stays there until the
// next read.
module rom #(
  parameter integer BITS = 8,
  parameter integer WORDS = 2,
  parameter integer ADDRESS_BITS = 1,
  parameter logic [WORDS*BITS-1:0] CONTENTS = 0  // word 0 in the lowest bits
) (
  input  logic                    clk,
  input  logic                    read,
  input  logic [ADDRESS_BITS-1:0] address,
  output logic [BITS-1:0]         word
);
  // An array, from which synthesis infers a memory; indexing CONTENTS would give gates.
  logic [BITS-1:0] words[0:WORDS-1];
  integer i;
  initial
    for (i = 0; i < WORDS; i = i + 1) words[i] = CONTENTS[i*BITS +: BITS];
  always_ff @(posedge clk)
    if (read) word <= words[address];
endmodule
