// SPDX-License-Identifier: MIT
// For any position and wrap mode, both texels of an axis are within the level, and the two are neighbours, except
// where the level ends or repeats.
`include "tables.svh"
module texel_axis_proof (
  input logic signed [46:0] product,
  input logic [12:0]        size,
  input logic [1:0]         wrap,
  input logic               linear
);
  logic [11:0] first, second;
  logic [7:0] fraction;
  texel_axis unit (.product, .size, .wrap, .linear, .first, .second, .fraction);
  wire signed [46:0] whole = $signed({10'd0, size, 24'd0});
  always @* begin
    assume (size >= 13'd1 && size <= 13'd4096);
    // At most S9.24 times 4096.
    assume (product >= -47'sd35184372088832 && product < 47'sd35184372088832);
    // A repeated or mirrored coordinate lies within the level.
    assume (wrap == `WRAP_CLAMP_TO_EDGE || (wrap <= `WRAP_LAST && product >= 0 && product < whole));
    a_first: assert ({1'b0, first} < size);
    a_second: assert ({1'b0, second} < size);
    a_nearest: assert (linear || (first == second && fraction == 8'd0));
    a_neighbours: assert (second == first || second == first + 12'd1 ||
                          (wrap == `WRAP_REPEAT && second == 12'd0 && {1'b0, first} == size - 13'd1));
  end
endmodule
