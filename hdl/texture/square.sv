// SPDX-License-Identifier: MIT
// The square of a number, folded: the product of two different bits occurs once, doubled, so that no column of the sum
// has more than BITS / 2 + 1 terms.
module square #(
  parameter integer BITS = 31
) (
  input  logic [BITS-1:0]   value,
  output logic [2*BITS-1:0] squared
);
  integer i;
  always_comb begin
    squared = {2 * BITS{1'b0}};
    for (i = 0; i < BITS; i = i + 1)
      squared = squared + ({2 * BITS{value[i]}} & ({{(BITS - 2) {1'b0}}, value >> (i + 1), 2'b01} << (2 * i)));
  end
endmodule
