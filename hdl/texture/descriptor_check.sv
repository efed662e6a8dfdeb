// SPDX-License-Identifier: MIT
// Validity of a descriptor's words: size, levels, codes, N_max, bases of the existing levels
// (docs/reference/texture/index.md, "Invalid descriptors").
`include "descriptor.svh"
`include "tables.svh"
module descriptor_check (
  input  logic [32*`DESCRIPTOR_WORDS-1:0] words,
  output logic                            valid
);
  wire [15:0] width = words[`DESCRIPTOR_SIZE_WIDTH];
  wire [15:0] height = words[`DESCRIPTOR_SIZE_HEIGHT];
  wire [3:0] levels = words[`DESCRIPTOR_MODE_LEVELS];
  wire [15:0] longer = width > height ? width : height;
  wire [32*`DESCRIPTOR_BASES-1:0] bases = words[`DESCRIPTOR_BASE];
  wire unused = &{1'b0, words};

  // Level k exists if the longer side shifted right by k is not 0.
  wire [15:0] coarsest = longer >> (levels - 4'd1);
  wire size_ok = width != 16'd0 && height != 16'd0 && longer <= 16'd4096;
  wire levels_ok = levels != 4'd0 && coarsest != 16'd0;
  wire codes_ok = words[`DESCRIPTOR_MODE_FORMAT] <= `FORMAT_SRGB8_A8 && !words[`DESCRIPTOR_MODE_SRGB] &&
                  words[`DESCRIPTOR_MODE_WRAP_S] <= `WRAP_LAST &&
                  words[`DESCRIPTOR_MODE_WRAP_T] <= `WRAP_LAST &&
                  words[`DESCRIPTOR_MODE_MIN_FILTER] <= `MIN_FILTER_LAST &&
                  words[`DESCRIPTOR_MODE_MAX_COUNT_LOG2] <= 3'd4;
  logic bases_ok;
  integer k;
  always_comb begin
    bases_ok = 1'b1;
    for (k = 0; k < `DESCRIPTOR_BASES; k = k + 1)
      if (k < {28'd0, levels} && bases[32*k +: 6] != 6'd0) bases_ok = 1'b0;
  end
  assign valid = size_ok && levels_ok && codes_ok && bases_ok;
endmodule
