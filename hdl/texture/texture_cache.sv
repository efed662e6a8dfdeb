// SPDX-License-Identifier: MIT
// From bilinear requests to their texels: TagStage, MissQueue with the FillBuffer, LatencyFifo and DataStage
// (docs/reference/texture/cache.md). Memory requests and responses use links outside.
`include "tokens.svh"
`include "tables.svh"
module texture_cache #(
  parameter integer BYTES = `CHOSEN_CACHE_BYTES,
  parameter integer LINE_BYTES = `CHOSEN_CACHE_LINE_BYTES,
  parameter integer WAYS = `CHOSEN_CACHE_WAYS,
  parameter integer REPLACEMENT = `CHOSEN_CACHE_REPLACEMENT,
  parameter integer OUTSTANDING = `CHOSEN_CACHE_OUTSTANDING,
  parameter integer FIFO_DEPTH = `CHOSEN_CACHE_FIFO_DEPTH
) (
  input  logic                              clk,
  input  logic                              rst_n,
  input  logic                              in_valid,
  output logic                              in_pop,
  input  logic [`TEXEL_TOKEN_BITS-1:0]      in_data,
  output logic                              out_push,
  input  logic                              out_ready,
  output logic [`TEXEL_QUAD_TOKEN_BITS-1:0] out_data,
  // Memory.
  output logic                              request_push,
  input  logic                              request_ready,
  output logic [`MEMORY_REQUEST_BITS-1:0]   request_data,
  input  logic                              response_valid,
  output logic                              response_pop,
  input  logic [`MEMORY_RESPONSE_BITS-1:0]  response_data,
  // CONTROL.invalidate, while the cache is empty.
  input  logic                              invalidate,
  // Activity of the internal links in this cycle, for a testbench: misses, requests, entries of the LatencyFifo.
  output logic [2:0]                        link_push,
  output logic [2:0]                        link_pop
);
  localparam integer ENTRY_BITS = $clog2(OUTSTANDING);
  localparam integer BEATS = LINE_BYTES < 64 ? 1 : LINE_BYTES / 64;

  logic miss_push, miss_ready, miss_valid, miss_pop;
  logic [`MISS_TOKEN_BITS-1:0] miss_in, miss_out;
  logic tagged_push, tagged_ready, tagged_valid;
  logic [`CACHE_TOKEN_BITS-1:0] tagged_in, tagged_out;
  tag_stage #(.BYTES(BYTES), .LINE_BYTES(LINE_BYTES), .WAYS(WAYS), .REPLACEMENT(REPLACEMENT)) tags (
    .clk, .rst_n, .invalidate, .in_valid, .in_pop, .in_data, .miss_push, .miss_ready, .miss_data(miss_in),
    .out_push(tagged_push), .out_ready(tagged_ready), .out_data(tagged_in));
  link #(.BITS(`MISS_TOKEN_BITS)) misses (
    .clk, .rst_n, .push(miss_push), .push_data(miss_in), .can_push(miss_ready),
    .pop(miss_pop), .front(miss_out), .can_pop(miss_valid));

  // The LatencyFifo: a beat advances as soon as there is room.
  logic entry_ready, entry_valid, entry_pop;
  logic [`CACHE_TOKEN_BITS-1:0] entry;
  wire entry_push = tagged_valid && entry_ready;
  link #(.BITS(`CACHE_TOKEN_BITS)) requests (
    .clk, .rst_n, .push(tagged_push), .push_data(tagged_in), .can_push(tagged_ready),
    .pop(entry_push), .front(tagged_out), .can_pop(tagged_valid));
  fifo #(.BITS(`CACHE_TOKEN_BITS), .ENTRIES(FIFO_DEPTH)) entries (
    .clk, .rst_n, .push(entry_push), .push_data(tagged_out), .can_push(entry_ready),
    .pop(entry_pop), .front(entry), .can_pop(entry_valid));

  logic reserve, can_reserve, line_valid, use_line;
  logic [ENTRY_BITS-1:0] reserved;
  logic [8*LINE_BYTES-1:0] line;
  miss_queue #(.LINE_BYTES(LINE_BYTES), .ENTRIES(OUTSTANDING)) queue (
    .clk, .rst_n, .in_valid(miss_valid), .in_pop(miss_pop), .in_data(miss_out), .request_push, .request_ready,
    .request_data, .reserve, .can_reserve, .reserved);

  // There is room for each response. A line with an error is already zero.
  assign response_pop = response_valid;
  wire [`MEMORY_RESPONSE_LINE_BITS-1:0] beat = response_data[`MEMORY_RESPONSE_LINE];
  wire [BEATS-1:0] beat_at;
  genvar i;
  generate
    for (i = 0; i < BEATS; i = i + 1) begin : g_beat
      assign beat_at[i] = beat == i[`MEMORY_RESPONSE_LINE_BITS-1:0];
    end
  endgenerate
  fill_buffer #(.LINE_BYTES(LINE_BYTES), .ENTRIES(OUTSTANDING)) fills (
    .clk, .rst_n, .reserve, .can_reserve, .reserved, .arrive(response_valid),
    .arrive_place(response_data[`MEMORY_RESPONSE_TAG]), .arrive_beat(beat_at),
    .arrive_last(response_data[`MEMORY_RESPONSE_LAST]),
    .arrive_data(response_data[`MEMORY_RESPONSE_DATA]), .line_valid, .line, .use_line);
  wire unused = &{1'b0, response_data};

  data_stage #(.BYTES(BYTES), .LINE_BYTES(LINE_BYTES)) data (
    .clk, .rst_n, .in_valid(entry_valid), .in_pop(entry_pop), .in_data(entry), .line_valid, .line, .use_line,
    .out_push, .out_ready, .out_data);

  assign link_push = {entry_push, tagged_push, miss_push};
  assign link_pop = {entry_pop, entry_push, miss_pop};
endmodule
