// SPDX-License-Identifier: MIT
// The term that `segments` adds to n + y, for all y (docs/reference/texture/formats.md, "Logarithm").
`include "tables.svh"
module log2_segments_proof (
  input logic [11:0] y
);
  logic [9:0] correction;
  log2_correction #(.RULE(`LOG2_SEGMENTS)) of_y (.y, .correction);
  wire [11:0] r = y % 12'd1024;
  wire [11:0] segment = y < 12'd1024 ? 12'd20 + r / 12'd4 + r / 12'd32 :
                        y < 12'd2048 ? 12'd305 + r / 12'd16 - r / 12'd128 :
                        y < 12'd3072 ? 12'd356 + r / 12'd64 - r / 12'd8 : 12'd243 + r / 12'd64 - r / 12'd4;
  always @* a_segment: assert ({2'd0, correction} == segment);
endmodule
