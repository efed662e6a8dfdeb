// SPDX-License-Identifier: MIT
// Byte address of a texel in a level, row by row or in tiles of 64 bytes (docs/reference/texture/formats.md,
// "Addresses").
module texel_address (
  input  logic [11:0] x, y,
  input  logic [8:0]  pitch,  // of a row, in 64 bytes; 0 with tiles
  input  logic [9:0]  used_x, used_y,  // of tile_index.sv
  input  logic        tiled,
  input  logic [1:0]  lb_bytes,  // log2 of the bytes of a texel
  input  logic [31:0] base,
  output logic [31:0] address
);
  wire [31:0] column = {20'd0, x} << lb_bytes;
  wire [31:0] rows = {14'd0, y, 6'd0} * {23'd0, pitch};
  // Tiles of 4 x 4, 8 x 4 and 8 x 8 texels of 4, 2 and 1 bytes.
  wire wide = lb_bytes != 2'd2, tall = lb_bytes == 2'd0;
  wire [19:0] tile;
  tile_index tiles (.x(wide ? {1'b0, x[11:3]} : x[11:2]), .y(tall ? {1'b0, y[11:3]} : y[11:2]), .used_x, .used_y,
                    .index(tile));
  wire [5:0] in_tile = lb_bytes == 2'd2 ? {y[1:0], x[1:0], 2'd0} :
                      lb_bytes == 2'd1 ? {y[1:0], x[2:0], 1'd0} : {y[2:0], x[2:0]};
  assign address = base + rows + (tiled ? {6'd0, tile, in_tile} : column);
endmodule
