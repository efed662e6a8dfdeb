// SPDX-License-Identifier: MIT
// The channels of a texel as stored, 8 bits each, red in the lowest ones
// (docs/reference/texture/formats.md: narrow channels repeat their high bits).
`include "tables.svh"
module texel_unpack (
  input  logic [31:0] texel,
  input  logic [2:0]  format,
  output logic [31:0] channels  // alpha, blue, green, red
);
  wire [4:0] red_5 = texel[15:11], blue_5 = texel[4:0];
  wire [5:0] green_6 = texel[10:5];
  always_comb
    case (format)
      `FORMAT_RGB565:
        channels = {8'd255, blue_5, blue_5[4:2], green_6, green_6[5:4], red_5, red_5[4:2]};
      `FORMAT_RGBA4444:
        channels = {texel[3:0], texel[3:0], texel[7:4], texel[7:4], texel[11:8], texel[11:8],
                    texel[15:12], texel[15:12]};
      `FORMAT_L8: channels = {8'd255, texel[7:0], texel[7:0], texel[7:0]};
      default: channels = texel;
    endcase
endmodule
