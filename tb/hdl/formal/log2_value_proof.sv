// SPDX-License-Identifier: MIT
// For every number: n is the position of its leading one, and y the 12 bits below, as specified.
module log2_value_proof #(
  parameter integer BITS = 32
) (
  input logic [BITS-1:0] value
);
  logic signed [17:0] mitchell;
  log2_value #(.BITS(BITS)) unit (.value, .mitchell);
  wire [5:0] place = mitchell[17:12] + 6'd16;
  wire [11:0] y = mitchell[11:0];
  // {1, y} times 2^place is the number with 12 more bits, except for the bits cut off below.
  wire [BITS+11:0] back = {{(BITS - 1) {1'b0}}, 1'b1, y} << place;
  wire [BITS+11:0] whole = {value, 12'd0};
  wire [BITS+11:0] one = {{(BITS + 11) {1'b0}}, 1'b1};
  always @* begin
    if (value == {BITS{1'b0}}) begin
      a_zero: assert (mitchell == -18'sd65536);
    end else begin
      a_not_above: assert (back <= whole);
      a_not_below: assert (whole - back < one << place);
    end
  end
endmodule
