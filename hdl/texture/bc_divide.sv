// SPDX-License-Identifier: MIT
// Steps of a long division by a small number, most significant bit first.
module bc_divide #(
  parameter integer STEPS = 7
) (
  input  logic [2:0]       divisor,
  input  logic [2:0]       rest_in,   // below the divisor
  input  logic [STEPS-1:0] dividend,
  output logic [STEPS-1:0] quotient,
  output logic [2:0]       rest
);
  logic [3:0] twice;
  integer i;
  always_comb begin
    rest = rest_in;
    for (i = STEPS - 1; i >= 0; i = i - 1) begin
      twice = {rest, dividend[i]};
      quotient[i] = twice >= {1'b0, divisor};
      rest = quotient[i] ? twice[2:0] - divisor : twice[2:0];
    end
  end
endmodule
