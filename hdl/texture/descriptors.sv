// SPDX-License-Identifier: MIT
// The 16 texture descriptors in flip-flops without output register: one word is written at a time, three units read the
// registers that they need (docs/reference/texture/index.md, "Registers of a descriptor", "Invalid descriptors").
`include "descriptor.svh"
module descriptors (
  input  logic                           clk,
  input  logic                           rst_n,
  input  logic                           write,
  input  logic [3:0]                     write_handle,
  input  logic [4:0]                     write_word,
  input  logic [31:0]                    write_data,
  input  logic [3:0]                     handle_derivative,
  output logic                           valid_derivative,
  output logic [`DESCRIPTOR_SIZE]        size_derivative,
  input  logic [3:0]                     handle_level,
  output logic [`DESCRIPTOR_SIZE]        size_level,
  output logic [`DESCRIPTOR_MODE]        mode_level,
  output logic [`DESCRIPTOR_LOD_BIAS]    lod_bias_level,
  output logic [`DESCRIPTOR_LOD_CLAMP]   lod_clamp_level,
  input  logic [3:0]                     handle_texel,
  output logic [`DESCRIPTOR_SIZE]        size_texel,
  output logic [`DESCRIPTOR_MODE]        mode_texel,
  output logic [`DESCRIPTOR_BASE]        bases_texel
);
  localparam integer WORDS = `DESCRIPTOR_WORDS;
  // A size above 4096 is stored as 0, which is invalid too; of the bits below a line only whether one of them is set.
  localparam logic [32*WORDS-1:0] KEPT = `DESCRIPTOR_KEPT;
  localparam integer BASE_WORD = `DESCRIPTOR_BASE_FIRST / 32;
  wire [15:0] height = write_data[31:16], width = write_data[15:0];
  wire [31:0] size = {height > 16'd4096 ? 16'd0 : height, width > 16'd4096 ? 16'd0 : width};
  wire [31:0] base = {write_data[31:6], 5'd0, |write_data[5:0]};

  wire [32*WORDS-1:0] stored[0:15];
  genvar h, w;
  generate
    for (h = 0; h < 16; h = h + 1) begin : g_handle
      localparam logic [3:0] HANDLE = h[3:0];
      logic [32*WORDS-1:0] words;
      assign stored[h] = words;
      for (w = 0; w < WORDS; w = w + 1) begin : g_word
        localparam logic [4:0] WORD = w[4:0];
        wire [31:0] kept = (w == 0 ? size : w < BASE_WORD ? write_data : base) & KEPT[32*w +: 32];
        always_ff @(posedge clk)
          if (!rst_n) words[32*w +: 32] <= 32'd0;
          else if (write && write_handle == HANDLE && write_word == WORD) words[32*w +: 32] <= kept;
      end
    end
  endgenerate

  wire [32*WORDS-1:0] of_derivative = stored[handle_derivative];
  wire [32*WORDS-1:0] of_level = stored[handle_level], of_texel = stored[handle_texel];
  wire unused = &{1'b0, of_level, of_texel};
  descriptor_check check (.words(of_derivative), .valid(valid_derivative));
  assign size_derivative = of_derivative[`DESCRIPTOR_SIZE];
  assign size_level = of_level[`DESCRIPTOR_SIZE];
  assign mode_level = of_level[`DESCRIPTOR_MODE];
  assign lod_bias_level = of_level[`DESCRIPTOR_LOD_BIAS];
  assign lod_clamp_level = of_level[`DESCRIPTOR_LOD_CLAMP];
  assign size_texel = of_texel[`DESCRIPTOR_SIZE];
  assign mode_texel = of_texel[`DESCRIPTOR_MODE];
  assign bases_texel = of_texel[`DESCRIPTOR_BASE];
endmodule
