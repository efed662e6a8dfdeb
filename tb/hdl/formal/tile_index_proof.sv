// SPDX-License-Identifier: MIT
// Two tiles of a level never have the same index, and no index exceeds the level's tiles with their numbers
// rounded up to powers of two; for every level size.
module tile_index_proof (
  input logic [9:0] last_x, last_y, x, y, other_x, other_y
);
  // Ones up to the leading one of both ends.
  wire [9:0] used_x = last_x | last_x >> 1 | last_x >> 2 | last_x >> 3 | last_x >> 4 | last_x >> 5 |
                      last_x >> 6 | last_x >> 7 | last_x >> 8 | last_x >> 9;
  wire [9:0] used_y = last_y | last_y >> 1 | last_y >> 2 | last_y >> 3 | last_y >> 4 | last_y >> 5 |
                      last_y >> 6 | last_y >> 7 | last_y >> 8 | last_y >> 9;
  logic [19:0] index, other, most;
  tile_index unit (.x, .y, .used_x, .used_y, .index);
  tile_index of_other (.x(other_x), .y(other_y), .used_x, .used_y, .index(other));
  tile_index of_last (.x(used_x), .y(used_y), .used_x, .used_y, .index(most));
  always @* begin
    assume (x <= last_x && y <= last_y && other_x <= last_x && other_y <= last_y);
    a_different: assert (index != other || (x == other_x && y == other_y));
    a_within: assert (index <= most);
  end
endmodule
