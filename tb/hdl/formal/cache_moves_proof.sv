// SPDX-License-Identifier: MIT
// The queues of the cache never deadlock. In every cycle with a request inside, a beat, a line or a pass moves, or
// the environment stalls the cache: the link to memory or the downstream link is full, or a memory response is
// outstanding. The solver chooses hits, misses and data freely in every cycle. Reason: the number of lines that
// requests after the TagStage still have to write equals the number of lines in flight.
`include "tokens.svh"
`include "tables.svh"
module cache_moves_proof (
  input logic                             clk,
  input logic                             rst_n,
  input logic                             in_valid,
  input logic [`TEXEL_TOKEN_BITS-1:0]     in_data,
  input logic                             out_ready,
  input logic                             request_ready,
  input logic                             answer,
  input logic [1:0]                       answer_place,
  input logic [`MEMORY_RESPONSE_BITS-1:0] answer_rest
);
  logic in_pop, out_push, request_push, response_pop;
  logic [`MEMORY_REQUEST_BITS-1:0] request_data;
  logic [`MEMORY_RESPONSE_BITS-1:0] response_data;
  always_comb begin
    response_data = answer_rest;
    response_data[`MEMORY_RESPONSE_TAG] = answer_place;
    response_data[`MEMORY_RESPONSE_LINE] = 0;
    response_data[`MEMORY_RESPONSE_LAST] = 1'b1;
  end
  logic [2:0] link_push, link_pop;
  texture_cache #(.BYTES(256), .WAYS(2), .OUTSTANDING(4), .FIFO_DEPTH(2)) cache (
    .clk, .rst_n, .in_valid, .in_pop, .in_data, .out_push, .out_ready, .out_data(), .request_push, .request_ready,
    .request_data, .response_valid(answer), .response_pop, .response_data, .invalidate(1'b0), .link_push, .link_pop);

  // Memory responds to its requests in any order.
  reg past = 1'b0;
  reg [3:0] owed;
  wire [3:0] asked = request_push ? 4'd1 << request_data[`MEMORY_REQUEST_TAG] : 4'd0;
  wire [3:0] answered = answer ? 4'd1 << answer_place : 4'd0;
  always @(posedge clk) begin
    past <= 1'b1;
    owed <= !rst_n ? 4'd0 : (owed | asked) & ~answered;
  end
  always @* begin
    if (!past) assume (!rst_n);
    assume (!answer || owed[answer_place]);
  end

  (* hierconn *) wire \cache.tags.valid_2 , \cache.data.valid_2 , \cache.data.read , \cache.use_line ;
  (* hierconn *) wire [1:0] \cache.misses.count , \cache.requests.count , \cache.entries.count ;
  (* hierconn *) wire \cache.misses.can_push , \cache.misses.can_pop , \cache.requests.can_push ;
  (* hierconn *) wire \cache.requests.can_pop , \cache.entries.can_push , \cache.entries.can_pop ;
  (* hierconn *) wire [`MISS_TOKEN_BITS-1:0] \cache.misses.place[0] , \cache.misses.place[1] ;
  (* hierconn *) wire [`CACHE_TOKEN_BITS-1:0] \cache.requests.place[0] , \cache.requests.place[1] ;
  (* hierconn *) wire [`CACHE_TOKEN_BITS-1:0] \cache.entries.first , \cache.entries.second , \cache.entries.word ;
  (* hierconn *) wire [`CACHE_TOKEN_BITS-1:0] \cache.entries.memory[0] , \cache.entries.memory[1] ;
  (* hierconn *) wire [1:0] \cache.entries.stored , \cache.entries.ready ;
  (* hierconn *) wire \cache.entries.reading , \cache.entries.read_place , \cache.entries.write_place ;
  (* hierconn *) wire [2:0] \cache.data.pass , \cache.data.fill , \cache.data.passes , \cache.queue.waiting ;
  (* hierconn *) wire [2:0] \cache.fills.held ;
  (* hierconn *) wire [3:0] \cache.fills.arrived ;
  (* hierconn *) wire [1:0] \cache.fills.read_place , \cache.fills.reserved ;
  (* hierconn *) wire \cache.fills.line_valid , \cache.fills.can_reserve , \cache.fills.read ;

  wire moved = in_pop || out_push || link_push != 3'd0 || link_pop != 3'd0 || request_push || answer ||
               \cache.use_line || \cache.fills.read || \cache.data.read ;
  wire empty = !\cache.tags.valid_2 && \cache.requests.count == 0 && \cache.misses.count == 0 &&
               \cache.entries.count == 0 && !\cache.data.valid_2 && \cache.queue.waiting == 0 && \cache.fills.held == 0;
  wire outside = (\cache.data.valid_2 && !out_ready) || (\cache.queue.waiting != 0 && !request_ready) || owed != 4'd0;

  // Lines that requests still have to write, oldest first, and lines in flight.
  wire [2:0] to_write_0 = \cache.requests.place[0] [`CACHE_TOKEN_FILLS];
  wire [2:0] to_write_1 = \cache.requests.place[1] [`CACHE_TOKEN_FILLS];
  wire [2:0] first = \cache.entries.first [`CACHE_TOKEN_FILLS], second = \cache.entries.second [`CACHE_TOKEN_FILLS];
  wire [2:0] word = \cache.entries.word [`CACHE_TOKEN_FILLS];
  wire [2:0] memory_0 = \cache.entries.memory[0] [`CACHE_TOKEN_FILLS];
  wire [2:0] memory_1 = \cache.entries.memory[1] [`CACHE_TOKEN_FILLS];
  wire [2:0] stored_0 = \cache.entries.read_place ? memory_1 : memory_0;
  wire [2:0] stored_1 = \cache.entries.read_place ? memory_0 : memory_1;
  wire [2:0] missed_0 = \cache.misses.place[0] [`MISS_TOKEN_COUNT];
  wire [2:0] missed_1 = \cache.misses.place[1] [`MISS_TOKEN_COUNT];
  wire [2:0] head = \cache.entries.ready != 0 ? first : word;
  wire two_links = \cache.requests.count == 2'd2, one_link = \cache.requests.count != 2'd0;
  wire [5:0] to_write = (one_link ? to_write_0 : 3'd0) + (two_links ? to_write_1 : 3'd0) +
                        (\cache.entries.ready != 0 ? first : 3'd0) + (\cache.entries.ready == 2 ? second : 3'd0) +
                        (\cache.entries.reading ? word : 3'd0) + (\cache.entries.stored != 0 ? stored_0 : 3'd0) +
                        (\cache.entries.stored == 2 ? stored_1 : 3'd0) - {3'd0, \cache.data.fill };
  wire [5:0] coming = (\cache.misses.count != 0 ? missed_0 : 3'd0) + (\cache.misses.count == 2 ? missed_1 : 3'd0) +
                      \cache.queue.waiting + \cache.fills.held ;
  wire [2:0] out_of = {1'b0, \cache.entries.ready } + {2'd0, \cache.entries.reading };
  wire [2:0] unread = \cache.fills.held - {2'd0, \cache.fills.line_valid };
  wire [3:0] ones = (4'd1 << unread) - 4'd1;
  wire [7:0] turned = {4'd0, ones} << \cache.fills.read_place ;
  always @* if (past && rst_n) begin
    a_moves: assert (moved || empty || outside);
    i_lines: assert (to_write == coming);
    i_links: assert (\cache.misses.count <= 2 && \cache.requests.count <= 2 && \cache.entries.count <= 2);
    i_ready: assert (\cache.misses.can_push == (\cache.misses.count != 2) &&
                     \cache.misses.can_pop == (\cache.misses.count != 0) &&
                     \cache.requests.can_push == (\cache.requests.count != 2) &&
                     \cache.requests.can_pop == (\cache.requests.count != 0) &&
                     \cache.entries.can_push == (\cache.entries.count != 2) &&
                     \cache.entries.can_pop == (\cache.entries.count != 0));
    i_misses: assert ((\cache.misses.count == 0 || (missed_0 >= 1 && missed_0 <= 4)) &&
                      (\cache.misses.count != 2 || (missed_1 >= 1 && missed_1 <= 4)));
    i_requests: assert ((!one_link || to_write_0 <= 4) && (!two_links || to_write_1 <= 4));
    i_registers: assert ((\cache.entries.ready == 0 || first <= 4) && (\cache.entries.ready != 2 || second <= 4) &&
                         (!\cache.entries.reading || word <= 4));
    i_stored: assert ((\cache.entries.stored == 0 || stored_0 <= 4) && (\cache.entries.stored != 2 || stored_1 <= 4));
    i_parts: assert (\cache.entries.count == \cache.entries.stored + out_of && out_of <= 2 &&
                     \cache.entries.stored <= \cache.entries.count &&
                     (\cache.entries.stored == 0 || out_of != 0));
    i_ring: assert (\cache.entries.write_place == (\cache.entries.read_place ^ \cache.entries.stored [0]));
    i_head: assert (\cache.entries.count != 0 ? \cache.data.pass <= \cache.data.passes && \cache.data.fill <= head
                                             : \cache.data.pass == 0 && \cache.data.fill == 0);
    i_queue: assert (\cache.queue.waiting <= 4 && \cache.fills.held <= 4);
    i_fills: assert (\cache.fills.can_reserve == (\cache.fills.held != 4) &&
                     (!\cache.fills.line_valid || \cache.fills.held != 0));
    i_reserved: assert (\cache.fills.reserved == \cache.fills.read_place + unread[1:0]);
    i_places: assert ((\cache.fills.arrived & owed) == 0 &&
                      (\cache.fills.arrived | owed) == (turned[3:0] | turned[7:4]));
  end
endmodule
