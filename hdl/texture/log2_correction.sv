// SPDX-License-Identifier: MIT
// Correction added to n + y by the configurations `corrected` and `segments`: constants and shift-adds of y
// (docs/reference/texture/formats.md, "Logarithm").
`include "tables.svh"
module log2_correction #(
  parameter integer RULE = `CHOSEN_LOG2
) (
  input  logic [11:0] y,
  output logic [9:0]  correction
);
  generate
    if (RULE == `LOG2_CORRECTED) begin : g_corrected
      localparam logic [8*`LOG2_CORRECTION_BITS-1:0] TABLE = `LOG2_CORRECTION;
      wire [`LOG2_CORRECTION_BITS-1:0] entry = TABLE[y[11:9]*`LOG2_CORRECTION_BITS +: `LOG2_CORRECTION_BITS];
      assign correction = {{(10 - `LOG2_CORRECTION_BITS) {1'b0}}, entry};
    end else begin : g_segments
      wire [9:0] r = y[9:0];
      always_comb
        case (y[11:10])
          2'd0: correction = 10'd20 + (r >> 2) + (r >> 5);
          2'd1: correction = 10'd305 + (r >> 4) - (r >> 7);
          2'd2: correction = 10'd356 - (r >> 3) + (r >> 6);
          default: correction = 10'd243 - (r >> 2) + (r >> 6);
        endcase
    end
  endgenerate
endmodule
