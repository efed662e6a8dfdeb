// SPDX-License-Identifier: MIT
// For every pair of logarithms and every valid descriptor: the level exists, and so does the next one where
// a fraction asks for it; N is 1 to N_max; magnification reads level 0. The token stays at the link until it
// leaves, so three clocks from any state are all that there is.
`include "tokens.svh"
`include "descriptor.svh"
module level_bounds_proof (
  input logic clk
);
  (* anyconst *) wire [`LOG2_TOKEN_BITS-1:0] token;
  (* anyconst *) wire [32*`DESCRIPTOR_WORDS-1:0] words;
  wire [`DESCRIPTOR_BITS-1:0] descriptor;
  descriptor_check check (.words, .descriptor);
  wire in_pop, out_push;
  wire [`LEVEL_TOKEN_BITS-1:0] out;
  wire [3:0] handle;
  level_unit unit (.clk, .rst_n(1'b1), .in_valid(1'b1), .in_pop, .in_data(token), .out_push,
                   .out_ready(1'b1), .out_data(out), .handle, .descriptor);
  reg [1:0] clocks = 2'd0;
  always @(posedge clk) if (clocks != 2'd3) clocks <= clocks + 2'd1;
  wire [3:0] last = out[`LEVEL_TOKEN_LAST_INDEX];
  wire [3:0] level = out[`LEVEL_TOKEN_LEVEL];
  wire [7:0] fraction = out[`LEVEL_TOKEN_FRACTION];
  wire [3:0] coarsest = words[`DESCRIPTOR_MODE_LEVELS] - 4'd1;
  wire [2:0] mode = words[`DESCRIPTOR_MODE_MIN_FILTER];
  wire [4:0] most = 5'd1 << words[`DESCRIPTOR_MODE_MAX_COUNT_LOG2];
  always @* assume (descriptor[`DESCRIPTOR_VALID]);
  always @*
    if (clocks >= 2'd2) begin
      a_level: assert (level <= coarsest);
      a_next_level: assert (fraction == 8'd0 || level < coarsest);
      a_count: assert ({1'b0, last} < most);
      a_one_level: assert (mode >= 3'd4 || fraction == 8'd0);
      a_no_levels: assert (mode >= 3'd2 || level == 4'd0);
    end
endmodule
