// SPDX-License-Identifier: MIT
// Configuration `exact`: interpolation between two neighbouring table entries, in stages 2 and 3 of a Log2Unit
// (docs/reference/texture/formats.md, "Logarithm").
`include "tables.svh"
module log2_exact (
  input  logic               clk,
  input  logic               move,
  input  logic [11:0]        y_1,    // in stage 2
  input  logic signed [17:0] sum_2,  // n and y in stage 3
  output logic signed [17:0] lb
);
  logic [`LOG2_TABLE_BITS-1:0] low, high;
  wire [6:0] index = {1'b0, y_1[11:6]};
  rom #(.BITS(`LOG2_TABLE_BITS), .WORDS(65), .ADDRESS_BITS(7), .CONTENTS(`LOG2_TABLE)) below (
    .clk, .read(move), .address(index), .word(low));
  rom #(.BITS(`LOG2_TABLE_BITS), .WORDS(65), .ADDRESS_BITS(7), .CONTENTS(`LOG2_TABLE)) above (
    .clk, .read(move), .address(index + 7'd1), .word(high));
  wire [`LOG2_TABLE_BITS-1:0] slope = high - low;
  wire [12:0] product = slope[6:0] * sum_2[5:0] + 13'd32;
  wire [12:0] fraction = low + {6'd0, product[12:6]};
  wire unused = &{1'b0, slope[`LOG2_TABLE_BITS-1:7], product[5:0], sum_2[11:6]};
  // T[64] is 4096: the sum may carry into n.
  assign lb = $signed({sum_2[17:12], 12'd0}) + $signed({5'd0, fraction});
endmodule
