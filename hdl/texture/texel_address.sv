// SPDX-License-Identifier: MIT
// Byte address of a texel in a level, row by row or in tiles of 64 bytes (docs/reference/texture/formats.md,
// "Addresses").
module texel_address (
  input  logic [11:0] x, y,
  input  logic [12:0] width, height,
  input  logic        tiled,
  input  logic [1:0]  lb_bytes,  // log2 of the bytes of a texel
  input  logic [31:0] base,
  output logic [31:0] address
);
  // Row by row: the pitch is rounded up to 64 bytes.
  wire [14:0] row_bytes = {2'd0, width} << lb_bytes;
  wire [15:0] padded = {1'b0, row_bytes} + 16'd63;
  wire [31:0] column = {20'd0, x} << lb_bytes;
  wire [31:0] along_rows = {20'd0, y} * {22'd0, padded[15:6]};

  // Tiles of 4 x 4, 8 x 4 and 8 x 8 texels of 4, 2 and 1 bytes.
  wire [12:0] last_x = width - 13'd1, last_y = height - 13'd1;
  wire wide = lb_bytes != 2'd2, tall = lb_bytes == 2'd0;
  wire [19:0] tile;
  tile_index tiles (.x(wide ? {1'b0, x[11:3]} : x[11:2]), .y(tall ? {1'b0, y[11:3]} : y[11:2]),
                    .last_x(wide ? {1'b0, last_x[11:3]} : last_x[11:2]),
                    .last_y(tall ? {1'b0, last_y[11:3]} : last_y[11:2]), .index(tile));
  wire [5:0] in_tile = lb_bytes == 2'd2 ? {y[1:0], x[1:0], 2'd0} :
                      lb_bytes == 2'd1 ? {y[1:0], x[2:0], 1'd0} : {y[2:0], x[2:0]};
  wire unused = &{1'b0, padded[5:0], last_x[12], last_y[12], last_x[1:0], last_y[1:0], along_rows[31:26]};
  assign address = base + (tiled ? {6'd0, tile, in_tile} : {along_rows[25:0], 6'd0} + column);
endmodule
