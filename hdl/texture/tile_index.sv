// SPDX-License-Identifier: MIT
// Morton index of a tile in a level: the low bits of both axes are interleaved, x in the even positions, as far as both
// axes have tiles; the remaining bits of the longer axis are above (docs/reference/texture/formats.md, "Addresses").
module tile_index (
  input  logic [9:0]  x, y,
  input  logic [9:0]  last_x, last_y,  // of the level's tiles
  output logic [19:0] index
);
  // Bits that an axis needs; the number of tiles is rounded up to a power of two.
  logic [9:0] used_x, used_y;  // ones below that position
  integer i;
  always_comb
    for (i = 0; i < 10; i = i + 1) begin
      used_x[i] = (last_x >> i) != 10'd0;
      used_y[i] = (last_y >> i) != 10'd0;
    end
  wire [9:0] both = used_x & used_y;
  logic [3:0] shared;
  logic [19:0] woven;
  always_comb begin
    shared = 4'd0;
    for (i = 0; i < 10; i = i + 1) begin
      shared = shared + {3'd0, both[i]};
      woven[2*i] = x[i] & both[i];
      woven[2*i+1] = y[i] & both[i];
    end
  end
  wire [9:0] longer = (used_x & ~used_y) != 10'd0 ? x : y;
  wire [9:0] above = longer >> shared;
  wire [19:0] raised = {10'd0, above} << {shared, 1'b0};
  assign index = woven | raised;
endmodule
