// SPDX-License-Identifier: MIT
// The terms of C x + S y for one of eight directions, 22.5 degrees apart; `kAxes` gives C and S in 1/128
// (docs/reference/texture/formats.md, "Axes"). A negative term is a complement and a carry.
module axis_terms #(
  parameter integer BITS = 41
) (
  input  logic [2:0]        direction,
  input  logic [4*BITS-1:0] x, y,  // multiples (axis_multiples.sv)
  output logic [BITS-1:0]   of_x, of_y,
  output logic              carry
);
  wire [BITS-1:0] x128 = x[0 +: BITS], x118 = x[BITS +: BITS], x90 = x[2*BITS +: BITS], x49 = x[3*BITS +: BITS];
  wire [BITS-1:0] y128 = y[0 +: BITS], y118 = y[BITS +: BITS], y90 = y[2*BITS +: BITS], y49 = y[3*BITS +: BITS];
  assign carry = direction > 3'd4;
  always_comb
    case (direction)
      3'd0: begin of_x = x128; of_y = {BITS{1'b0}}; end
      3'd1: begin of_x = x118; of_y = y49; end
      3'd2: begin of_x = x90; of_y = y90; end
      3'd3: begin of_x = x49; of_y = y118; end
      3'd4: begin of_x = {BITS{1'b0}}; of_y = y128; end
      3'd5: begin of_x = ~x49; of_y = y118; end
      3'd6: begin of_x = ~x90; of_y = y90; end
      default: begin of_x = ~x118; of_y = y49; end
    endcase
endmodule
