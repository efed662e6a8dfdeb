// SPDX-License-Identifier: MIT
// One bit of a quotient: subtracts the divisor if it fits. A remainder is below the divisor.
module divider_step (
  input  logic [27:0] rest,
  input  logic        digit,  // the next bit of the dividend
  input  logic [27:0] by,
  output logic [27:0] next_rest,
  output logic        found
);
  wire [28:0] with_digit = {rest, digit};
  wire [29:0] difference = {1'b0, with_digit} - {2'd0, by};
  assign found = !difference[29];
  assign next_rest = found ? difference[27:0] : with_digit[27:0];
endmodule
