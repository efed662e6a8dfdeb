// SPDX-License-Identifier: MIT
// Layout of a level: the pitch of the linear layout, and the index bits of the tiled one, whose tiles have 4 x 4, 8 x 4
// and 8 x 8 texels of 4, 2 and 1 bytes (docs/reference/texture/formats.md, "Addresses").
module level_layout (
  input  logic [12:0] width, height,
  input  logic [1:0]  lb_bytes,  // log2 of the bytes of a texel
  output logic [8:0]  pitch,  // of a row, in 64 bytes
  output logic [9:0]  used_x, used_y  // ones up to the leading one of the last tile
);
  wire [15:0] padded = ({3'd0, width} << lb_bytes) + 16'd63;
  wire [12:0] last_x = width - 13'd1, last_y = height - 13'd1;
  wire [9:0] tile_x = lb_bytes != 2'd2 ? {1'b0, last_x[11:3]} : last_x[11:2];
  wire [9:0] tile_y = lb_bytes == 2'd0 ? {1'b0, last_y[11:3]} : last_y[11:2];
  assign pitch = padded[14:6];
  integer i;
  always_comb
    for (i = 0; i < 10; i = i + 1) begin
      used_x[i] = (tile_x >> i) != 10'd0;
      used_y[i] = (tile_y >> i) != 10'd0;
    end
endmodule
