// SPDX-License-Identifier: MIT
// A memory with one read and one write port (docs/explanation/fabric.md, "Memories"): the word addressed in cycle t is
// on the output register in t + 1 and stays there until the next read. A read of a word that is written in the same
// cycle returns the old word.
module sram_1r1w #(
  parameter integer BITS = 8,
  parameter integer WORDS = 2,
  parameter integer ADDRESS_BITS = 1
) (
  input  logic                    clk,
  input  logic                    read,
  input  logic [ADDRESS_BITS-1:0] read_address,
  output logic [BITS-1:0]         word,
  input  logic                    write,
  input  logic [ADDRESS_BITS-1:0] write_address,
  input  logic [BITS-1:0]         write_data
);
  logic [BITS-1:0] memory[0:WORDS-1];
  always_ff @(posedge clk) begin
    if (read) word <= memory[read_address];
    if (write) memory[write_address] <= write_data;
  end

`ifdef FORMAL
  // A proof observes one word.
  wire [ADDRESS_BITS-1:0] f_address;
  wire [BITS-1:0] f_word = memory[f_address];
`endif
endmodule
