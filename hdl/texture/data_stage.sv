// SPDX-License-Identifier: MIT
// Reads the texels of a request from the banks and writes the fills that it requested (docs/reference/texture/cache.md,
// "Banks" and "Order of fills"; docs/reference/datasheets.md, "DataStage"). Stage 1 processes the head of the
// LatencyFifo and pops the request in its last cycle; stage 2 holds its words. Both stall while stage 2 cannot leave.
`include "tokens.svh"
`include "tables.svh"
module data_stage #(
  parameter integer BYTES = `CHOSEN_CACHE_BYTES,
  parameter integer LINE_BYTES = `CHOSEN_CACHE_LINE_BYTES
) (
  input  logic                              clk,
  input  logic                              rst_n,
  input  logic                              in_valid,
  output logic                              in_pop,
  input  logic [`CACHE_TOKEN_BITS-1:0]      in_data,
  input  logic                              line_valid,
  input  logic [8*LINE_BYTES-1:0]           line,
  output logic                              use_line,
  output logic                              out_push,
  input  logic                              out_ready,
  output logic [`TEXEL_QUAD_TOKEN_BITS-1:0] out_data
);
  localparam integer OFFSET_BITS = $clog2(LINE_BYTES);
  localparam integer ENTRY_BITS = $clog2(BYTES);
  localparam integer SLOT_BITS = ENTRY_BITS - OFFSET_BITS;
  localparam integer LINES = BYTES / LINE_BYTES;
  localparam integer BANKS = LINE_BYTES / 4;
  localparam integer BANK_BITS = OFFSET_BITS - 2;
  localparam integer TURN_WORDS = LINE_BYTES / 2 < 32 ? LINE_BYTES / 8 : 8;

  logic valid_2;
  wire move = !valid_2 || out_ready;
  assign out_push = valid_2 && out_ready;

  // ---- 1: passes over the banks, then fills; the first fill in the cycle of the last pass
  wire [4*ENTRY_BITS-1:0] places = in_data[`CACHE_TOKEN_PLACE];
  wire [11:0] sources = in_data[`CACHE_TOKEN_SOURCE];
  wire [4*SLOT_BITS-1:0] victims = in_data[`CACHE_TOKEN_VICTIM];
  wire [3:0] turned = in_data[`CACHE_TOKEN_TURNED];
  wire [2:0] fills = in_data[`CACHE_TOKEN_FILLS];
  wire asks = in_data[`CACHE_TOKEN_TICKET_VALID];
  wire [3:0] hit;
  wire [4*(ENTRY_BITS-2)-1:0] words;
  wire [7:0] pass_of;
  wire [2:0] passes;
  bank_passes #(.WORD_BITS(ENTRY_BITS - 2), .BANK_BITS(BANK_BITS)) order (.hit, .words, .pass(pass_of), .passes);

  logic [2:0] pass, fill;  // completed passes and fills
  wire works = in_valid && move;
  wire read = works && pass < passes;
  wire passed = pass + 3'd1 >= passes;
  wire fills_left = fill < fills;
  assign use_line = works && passed && fills_left && line_valid;
  wire [2:0] filled = fill + {2'd0, use_line};
  wire last = passed && filled == fills;
  assign in_pop = works && last;
  always_ff @(posedge clk)
    if (!rst_n) begin
      valid_2 <= 1'b0;
      pass <= 3'd0;
      fill <= 3'd0;
    end else begin
      if (move) valid_2 <= in_valid && last;
      if (in_pop) begin
        pass <= 3'd0;
        fill <= 3'd0;
      end else if (works) begin
        pass <= pass + {2'd0, read};
        fill <= filled;
      end
    end

  // The banks: word w of a line that is not turned is in bank w.
  wire [SLOT_BITS-1:0] victim = victims[fill[1:0]*SLOT_BITS +: SLOT_BITS];
  localparam logic [BANK_BITS-1:0] TURN = TURN_WORDS[BANK_BITS-1:0];
  wire [BANK_BITS-1:0] turn = turned[fill[1:0]] ? TURN : {BANK_BITS{1'b0}};
  wire [32*BANKS-1:0] bank_words;
  genvar i, k;
  generate
    for (i = 0; i < BANKS; i = i + 1) begin : g_bank
      localparam logic [BANK_BITS-1:0] HERE = i[BANK_BITS-1:0];
      wire [3:0] wants;
      for (k = 0; k < 4; k = k + 1) begin : g_wants
        assign wants[k] = hit[k] && {1'b0, pass_of[2*k +: 2]} == pass &&
                          places[k*ENTRY_BITS + 2 +: BANK_BITS] == HERE;
      end
      wire [SLOT_BITS-1:0] slot =
          wants[0] ? places[0*ENTRY_BITS + OFFSET_BITS +: SLOT_BITS] :
          wants[1] ? places[1*ENTRY_BITS + OFFSET_BITS +: SLOT_BITS] :
          wants[2] ? places[2*ENTRY_BITS + OFFSET_BITS +: SLOT_BITS] :
                     places[3*ENTRY_BITS + OFFSET_BITS +: SLOT_BITS];
      wire [BANK_BITS-1:0] from = HERE ^ turn;
      sram_1r1w #(.BITS(32), .WORDS(LINES), .ADDRESS_BITS(SLOT_BITS)) bank (
        .clk, .read(read && |wants), .read_address(slot), .word(bank_words[32*i +: 32]),
        .write(use_line), .write_address(victim), .write_data(line[32*from +: 32]));
    end
  endgenerate

  // ---- 2: words of the last pass from their banks, other words and those of fills from registers
  logic [`TICKET_BITS-1:0] ticket;
  logic [`TEXEL_QUAD_TOKEN_CONTROL_BITS-1:0] control;
  always_ff @(posedge clk)
    if (in_pop) begin
      ticket <= in_data[`CACHE_TOKEN_TICKET];
      control <= in_data[`CACHE_TOKEN_CONTROL];
    end
  wire [127:0] texels;
  generate
    for (k = 0; k < 4; k = k + 1) begin : g_texel
      wire [OFFSET_BITS-1:0] offset = places[k*ENTRY_BITS +: OFFSET_BITS];
      wire [2:0] source = sources[3*k +: 3];
      assign hit[k] = asks && source == 3'd0;
      assign words[k*(ENTRY_BITS-2) +: ENTRY_BITS-2] = places[k*ENTRY_BITS + 2 +: ENTRY_BITS-2];
      wire from_fill = use_line && asks && source == fill + 3'd1;
      wire [31:0] line_word = line[32*offset[OFFSET_BITS-1:2] +: 32];
      logic fresh;  // its word is on a bank's output register
      logic [BANK_BITS-1:0] bank;
      logic [1:0] byte_in_word;
      logic [31:0] kept;
      wire [31:0] bank_word = bank_words[32*bank +: 32];
      assign texels[32*k +: 32] = fresh ? bank_word >> {byte_in_word, 3'd0} : kept;
      always_ff @(posedge clk)
        if (move) begin
          fresh <= read && hit[k] && {1'b0, pass_of[2*k +: 2]} == pass;
          bank <= offset[OFFSET_BITS-1:2];
          byte_in_word <= offset[1:0];
          kept <= from_fill ? line_word >> {offset[1:0], 3'd0} : texels[32*k +: 32];
        end
    end
  endgenerate
  assign out_data[`TEXEL_QUAD_TOKEN_TICKET] = ticket;
  assign out_data[`TEXEL_QUAD_TOKEN_CONTROL] = control;
  assign out_data[`TEXEL_QUAD_TOKEN_TEXEL] = texels;
endmodule
