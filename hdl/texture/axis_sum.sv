// SPDX-License-Identifier: MIT
// C x + S y for one of eight directions, 22.5 degrees apart; `kAxes` gives C and S in 1/128
// (docs/reference/texture/formats.md, "Axes"). The inputs are registered multiples, the sum is exact.
module axis_sum #(
  parameter integer BITS = 41
) (
  input  logic [2:0]             direction,
  input  logic signed [BITS-1:0] x128, x118, x90, x49,  // multiples of x
  input  logic signed [BITS-1:0] y128, y118, y90, y49,
  output logic signed [BITS:0]   sum
);
  logic signed [BITS-1:0] x, y;
  always_comb begin
    case (direction)
      3'd0: begin x = x128; y = {BITS{1'b0}}; end
      3'd1: begin x = x118; y = y49; end
      3'd2: begin x = x90; y = y90; end
      3'd3: begin x = x49; y = y118; end
      3'd4: begin x = {BITS{1'b0}}; y = y128; end
      3'd5: begin x = -x49; y = y118; end
      3'd6: begin x = -x90; y = y90; end
      default: begin x = -x118; y = y49; end
    endcase
  end
  assign sum = $signed({x[BITS-1], x}) + $signed({y[BITS-1], y});
endmodule
