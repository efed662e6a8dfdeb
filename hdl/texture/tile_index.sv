// SPDX-License-Identifier: MIT
// Morton index of a tile in a level: the low bits of both axes are interleaved, x in the even positions, as far as both
// axes have tiles; the remaining bits of the longer axis are above (docs/reference/texture/formats.md, "Addresses").
module tile_index (
  input  logic [9:0]  x, y,
  input  logic [9:0]  used_x, used_y,  // bits that an axis needs: ones up to the leading one of its last tile
  output logic [19:0] index
);
  wire [9:0] both = used_x & used_y;
  wire [9:0] longer = (used_x & ~used_y) != 10'd0 ? x : y;
  // For each number of interleaved bits what is above them; one of the numbers is right.
  wire [10:0] shared = {both, 1'b1} & ~{1'b0, both};
  integer i;
  always_comb begin
    index = 20'd0;
    for (i = 0; i < 10; i = i + 1) begin
      index[2*i] = x[i] & both[i];
      index[2*i+1] = y[i] & both[i];
    end
    for (i = 0; i < 10; i = i + 1)
      index = index | ({20{shared[i]}} & ({10'd0, longer >> i} << (2 * i)));
  end
endmodule
