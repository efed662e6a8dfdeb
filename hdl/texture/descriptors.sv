// SPDX-License-Identifier: MIT
// The 16 texture descriptors in flip-flops without output register: one word is written at a time, three units read
// (docs/reference/texture/index.md, "Registers of a descriptor"). A read returns the words of a descriptor, word 0 in
// the lowest bits, and above them its validity ("Invalid descriptors").
`include "descriptor.svh"
module descriptors (
  input  logic                        clk,
  input  logic                        rst_n,
  input  logic                        write,
  input  logic [3:0]                  write_handle,
  input  logic [4:0]                  write_word,
  input  logic [31:0]                 write_data,
  input  logic [3:0]                  handle_0, handle_1, handle_2,
  output logic [`DESCRIPTOR_BITS-1:0] descriptor_0, descriptor_1, descriptor_2
);
  localparam integer WORDS = `DESCRIPTOR_WORDS;
  wire [32*WORDS-1:0] stored[0:15];
  genvar h, w;
  generate
    for (h = 0; h < 16; h = h + 1) begin : g_handle
      localparam logic [3:0] HANDLE = h[3:0];
      logic [32*WORDS-1:0] words;
      assign stored[h] = words;
      for (w = 0; w < WORDS; w = w + 1) begin : g_word
        localparam logic [4:0] WORD = w[4:0];
        always_ff @(posedge clk)
          if (!rst_n) words[32*w +: 32] <= 32'd0;
          else if (write && write_handle == HANDLE && write_word == WORD) words[32*w +: 32] <= write_data;
      end
    end
  endgenerate
  descriptor_check check_0 (.words(stored[handle_0]), .descriptor(descriptor_0));
  descriptor_check check_1 (.words(stored[handle_1]), .descriptor(descriptor_1));
  descriptor_check check_2 (.words(stored[handle_2]), .descriptor(descriptor_2));
endmodule
