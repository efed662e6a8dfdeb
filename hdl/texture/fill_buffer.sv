// SPDX-License-Identifier: MIT
// Buffer for lines in flight from memory (docs/reference/datasheets.md, "FillBuffer"): entries are reserved in order,
// filled in any order, and used in the order of reservation. The oldest line is prefetched: it is on the output
// register two cycles after the beat that completes it.
`include "tokens.svh"
`include "tables.svh"
module fill_buffer #(
  parameter integer LINE_BYTES = `CHOSEN_CACHE_LINE_BYTES,
  parameter integer ENTRIES = `CHOSEN_CACHE_OUTSTANDING,
  parameter integer ENTRY_BITS = $clog2(ENTRIES),
  parameter integer BEAT_BYTES = LINE_BYTES < 64 ? LINE_BYTES : 64,
  parameter integer BEATS = LINE_BYTES / BEAT_BYTES
) (
  input  logic                     clk,
  input  logic                     rst_n,
  // Reserves an entry for a requested line.
  input  logic                     reserve,
  output logic                     can_reserve,
  output logic [ENTRY_BITS-1:0]    reserved,
  // A beat of an entry's line.
  input  logic                     arrive,
  input  logic [ENTRY_BITS-1:0]    arrive_place,
  input  logic [BEATS-1:0]         arrive_beat,  // one-hot
  input  logic                     arrive_last,  // completes the line
  input  logic [8*BEAT_BYTES-1:0]  arrive_data,
  // The oldest line; using it frees its entry.
  output logic                     line_valid,
  output logic [8*LINE_BYTES-1:0]  line,
  input  logic                     use_line
);
  localparam integer COUNT_BITS = $clog2(ENTRIES + 1);
  localparam logic [COUNT_BITS-1:0] FULL = ENTRIES[COUNT_BITS-1:0];
  localparam integer LAST_INDEX = ENTRIES - 1;
  localparam logic [ENTRY_BITS-1:0] LAST = LAST_INDEX[ENTRY_BITS-1:0];

  logic [COUNT_BITS-1:0] held;  // reserved and not yet used
  logic [ENTRY_BITS-1:0] read_place;
  logic [ENTRIES-1:0] arrived;   // arrived and not yet read
  wire read = arrived[read_place] && (!line_valid || use_line);
  wire [COUNT_BITS-1:0] next_held = held + {{(COUNT_BITS - 1) {1'b0}}, reserve} -
                                    {{(COUNT_BITS - 1) {1'b0}}, use_line};
  always_ff @(posedge clk)
    if (!rst_n) begin
      held <= {COUNT_BITS{1'b0}};
      can_reserve <= 1'b1;
      reserved <= {ENTRY_BITS{1'b0}};
      read_place <= {ENTRY_BITS{1'b0}};
      arrived <= {ENTRIES{1'b0}};
      line_valid <= 1'b0;
    end else begin
      held <= next_held;
      can_reserve <= next_held != FULL;
      if (reserve) reserved <= reserved == LAST ? {ENTRY_BITS{1'b0}} : reserved + 1'b1;
      if (arrive && arrive_last) arrived[arrive_place] <= 1'b1;
      if (read) begin
        arrived[read_place] <= 1'b0;
        read_place <= read_place == LAST ? {ENTRY_BITS{1'b0}} : read_place + 1'b1;
      end
      line_valid <= read || (line_valid && !use_line);
    end

  genvar i;
  generate
    for (i = 0; i < BEATS; i = i + 1) begin : g_beat
      sram_1r1w #(.BITS(8 * BEAT_BYTES), .WORDS(ENTRIES), .ADDRESS_BITS(ENTRY_BITS)) lines (
        .clk, .read, .read_address(read_place), .word(line[8*BEAT_BYTES*i +: 8*BEAT_BYTES]),
        .write(arrive && arrive_beat[i]), .write_address(arrive_place), .write_data(arrive_data));
    end
  endgenerate
endmodule
