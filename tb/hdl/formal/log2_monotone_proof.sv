// SPDX-License-Identifier: MIT
// The largest decrease of a logarithm from a number to the next one: 118/4096 with `corrected`, 4/4096 with
// `segments`, in the middle of an octave (docs/reference/texture/formats.md, "Logarithm"). For all y, including
// the end of the octave.
`include "tables.svh"
module log2_monotone_proof #(
  parameter integer RULE = `LOG2_SEGMENTS,
  parameter integer FALL = 4
) (
  input logic [11:0] y
);
  logic [9:0] here, next;
  log2_correction #(.RULE(RULE)) of_here (.y, .correction(here));
  log2_correction #(.RULE(RULE)) of_next (.y(y + 12'd1), .correction(next));
  wire [13:0] lb_here = {2'd0, y} + {4'd0, here};
  wire [13:0] lb_next = {1'b0, {1'b0, y} + 13'd1} + {4'd0, next};
  always @* a_falls: assert (lb_here <= lb_next + FALL);
endmodule
