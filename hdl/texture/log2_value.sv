// SPDX-License-Identifier: MIT
// Leading one of a number with 16 fraction bits, and the 12 bits below it
// (docs/reference/texture/formats.md, "Logarithm"). 0 counts as 1.
module log2_value #(
  parameter integer BITS = 32
) (
  input  logic [BITS-1:0]     value,
  output logic signed [17:0]  mitchell  // S5.12: n and y concatenated
);
  logic [5:0] position;
  integer i;
  always_comb begin
    position = 6'd0;
    for (i = 0; i < BITS; i = i + 1)
      if (value[i]) position = i[5:0];
  end
  // y is the number without its leading one, with 12 bits.
  wire [BITS+11:0] shifted = {value, 12'd0} >> position;
  wire [11:0] y = value == {BITS{1'b0}} ? 12'd0 : shifted[11:0];
  wire [5:0] n = position - 6'd16;
  assign mitchell = $signed({n, y});
endmodule
