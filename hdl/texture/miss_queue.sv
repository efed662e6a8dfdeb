// SPDX-License-Identifier: MIT
// Sends missed lines to memory in order, one per cycle (docs/reference/texture/cache.md, "Time of a miss"). Accepts up
// to four lines of a request in one cycle if there are entries for all; an entry that is sent in this cycle counts as
// free.
`include "tokens.svh"
`include "tables.svh"
module miss_queue #(
  parameter integer LINE_BYTES = `CHOSEN_CACHE_LINE_BYTES,
  parameter integer ENTRIES = `CHOSEN_CACHE_OUTSTANDING,
  parameter integer ENTRY_BITS = $clog2(ENTRIES)
) (
  input  logic                            clk,
  input  logic                            rst_n,
  input  logic                            in_valid,
  output logic                            in_pop,
  input  logic [`MISS_TOKEN_BITS-1:0]     in_data,
  output logic                            request_push,
  input  logic                            request_ready,
  output logic [`MEMORY_REQUEST_BITS-1:0] request_data,
  output logic                            reserve,
  input  logic                            can_reserve,
  input  logic [ENTRY_BITS-1:0]           reserved
);
  localparam integer LINE_BITS = 32 - $clog2(LINE_BYTES);
  localparam integer COUNT_BITS = $clog2(ENTRIES + 1);
  localparam integer LINES_A_BURST = LINE_BYTES < 64 ? 1 : LINE_BYTES / 64;

  logic [LINE_BITS-1:0] lines[0:ENTRIES-1];
  logic [COUNT_BITS-1:0] waiting;
  logic [ENTRY_BITS-1:0] read_place, write_place;

  wire send = waiting != {COUNT_BITS{1'b0}} && request_ready && can_reserve;
  wire [2:0] count = in_data[`MISS_TOKEN_COUNT];
  wire [COUNT_BITS:0] left = {1'b0, waiting} - {{COUNT_BITS{1'b0}}, send};
  wire [COUNT_BITS:0] with_these = left + {{(COUNT_BITS - 2) {1'b0}}, count};
  localparam logic [COUNT_BITS:0] FULL = ENTRIES[COUNT_BITS:0];
  assign in_pop = in_valid && with_these <= FULL;

  // The entry i after another one.
  function automatic [ENTRY_BITS-1:0] behind(input [ENTRY_BITS-1:0] place, input [2:0] i);
    logic [ENTRY_BITS:0] sum;
    begin
      sum = {1'b0, place} + {{(ENTRY_BITS - 2) {1'b0}}, i};
      if (sum >= ENTRIES[ENTRY_BITS:0]) sum = sum - ENTRIES[ENTRY_BITS:0];
      behind = sum[ENTRY_BITS-1:0];
    end
  endfunction
  wire [4*LINE_BITS-1:0] missed = in_data[`MISS_TOKEN_LINE];
  always_ff @(posedge clk)
    if (in_pop) begin
      lines[write_place] <= missed[0 +: LINE_BITS];
      if (count > 3'd1) lines[behind(write_place, 3'd1)] <= missed[LINE_BITS +: LINE_BITS];
      if (count > 3'd2) lines[behind(write_place, 3'd2)] <= missed[2*LINE_BITS +: LINE_BITS];
      if (count > 3'd3) lines[behind(write_place, 3'd3)] <= missed[3*LINE_BITS +: LINE_BITS];
    end
  always_ff @(posedge clk)
    if (!rst_n) begin
      waiting <= {COUNT_BITS{1'b0}};
      read_place <= {ENTRY_BITS{1'b0}};
      write_place <= {ENTRY_BITS{1'b0}};
    end else begin
      waiting <= in_pop ? with_these[COUNT_BITS-1:0] : left[COUNT_BITS-1:0];
      if (send) read_place <= behind(read_place, 3'd1);
      if (in_pop) write_place <= behind(write_place, count);
    end

  assign reserve = send;
  assign request_push = send;
  wire [LINE_BITS-1:0] line = lines[read_place];
  localparam logic [`MEMORY_REQUEST_LINES_BITS-1:0] BURST = LINES_A_BURST[`MEMORY_REQUEST_LINES_BITS-1:0];
  always_comb begin
    // A read request: without data and mask.
    request_data = {`MEMORY_REQUEST_BITS{1'b0}};
    request_data[`MEMORY_REQUEST_ADDRESS] = {line, {(32 - LINE_BITS) {1'b0}}};
    request_data[`MEMORY_REQUEST_TAG] = reserved;
    request_data[`MEMORY_REQUEST_LINES] = BURST;
  end

`ifdef FORMAL
  // A proof observes one entry (tb/hdl/formal/miss_path_proof.sv).
  wire [ENTRY_BITS-1:0] f_place;
  wire [LINE_BITS-1:0] f_line = lines[f_place];
`endif
endmodule
