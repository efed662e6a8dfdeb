// SPDX-License-Identifier: MIT
// MissQueue and FillBuffer with a memory that responds in any order, one beat per cycle, after any time. The n-th
// incoming line becomes the n-th request, is requested once, and leaves as the n-th line with the memory's data.
// The solver chooses one line that is followed. A beat has 16 bits here, because the units do not interpret data.
`include "tokens.svh"
`include "tables.svh"
module miss_path_proof #(
  parameter integer LINE_BYTES = `CHOSEN_CACHE_LINE_BYTES,
  parameter integer ENTRIES = `CHOSEN_CACHE_OUTSTANDING
) (
  input logic                        clk,
  input logic                        rst_n,
  input logic                        in_valid,
  input logic [`MISS_TOKEN_BITS-1:0] in_data,
  input logic                        request_ready,
  input logic                        use_line,
  input logic                        arrive,
  input logic [$clog2(ENTRIES)-1:0]   arrive_place,
  input logic                        arrive_second,  // of two beats
  input logic [15:0]                 arrive_data
);
  localparam integer ENTRY_BITS = $clog2(ENTRIES);
  localparam integer COUNT_BITS = $clog2(ENTRIES + 1);
  localparam integer LINE_BITS = 32 - $clog2(LINE_BYTES);
  localparam integer BEATS = LINE_BYTES > 64 ? 2 : 1;
  localparam integer DATA_BITS = 16 * BEATS;
  localparam logic [COUNT_BITS:0] ALL = ENTRIES[COUNT_BITS:0];

  logic in_pop, request_push, reserve, can_reserve, line_valid;
  logic [`MEMORY_REQUEST_BITS-1:0] request_data;
  logic [ENTRY_BITS-1:0] reserved;
  logic [DATA_BITS-1:0] line;
  miss_queue #(.LINE_BYTES(LINE_BYTES), .ENTRIES(ENTRIES)) queue (
    .clk, .rst_n, .in_valid, .in_pop, .in_data, .request_push, .request_ready, .request_data, .reserve,
    .can_reserve, .reserved);
  reg [ENTRIES-1:0] owed_first, owed_second;  // beats still due from memory, by entry
  wire last = BEATS == 1 || !(arrive_second ? owed_first[arrive_place] : owed_second[arrive_place]);
  wire [1:0] beat = arrive_second ? 2'd2 : 2'd1;
  fill_buffer #(.LINE_BYTES(2 * BEATS), .BEAT_BYTES(2), .ENTRIES(ENTRIES)) fills (
    .clk, .rst_n, .reserve, .can_reserve, .reserved, .arrive, .arrive_place, .arrive_beat(beat[BEATS-1:0]),
    .arrive_last(last), .arrive_data(arrive_data), .line_valid, .line, .use_line);

  // Registers of both units.
  (* hierconn *) wire [COUNT_BITS-1:0] \queue.waiting ;
  (* hierconn *) wire [ENTRY_BITS-1:0] \queue.read_place , \queue.write_place , \queue.f_place ;
  (* hierconn *) wire [LINE_BITS-1:0] \queue.f_line ;
  (* hierconn *) wire [COUNT_BITS-1:0] \fills.held ;
  (* hierconn *) wire [ENTRY_BITS-1:0] \fills.read_place ;
  (* hierconn *) wire [ENTRIES-1:0] \fills.arrived ;
  (* hierconn *) wire [ENTRY_BITS-1:0] \fills.g_beat[0].lines.f_address , \fills.g_beat[1].lines.f_address ;
  (* hierconn *) wire [15:0] \fills.g_beat[0].lines.f_word , \fills.g_beat[1].lines.f_word ;
  wire [DATA_BITS-1:0] word;

  // The entry i after another one.
  function automatic [ENTRY_BITS-1:0] behind(input [ENTRY_BITS-1:0] place, input [COUNT_BITS-1:0] i);
    logic [COUNT_BITS:0] sum;
    begin
      sum = {{(COUNT_BITS + 1 - ENTRY_BITS) {1'b0}}, place} + {1'b0, i};
      if (sum >= ALL) sum = sum - ALL;
      behind = sum[ENTRY_BITS-1:0];
    end
  endfunction

  // Lines received, requested and used since the reset, modulo 2^16.
  reg past = 1'b0;
  reg [15:0] came, asked, used;
  wire [2:0] count = in_data[`MISS_TOKEN_COUNT];
  always @* begin
    if (!past) assume (!rst_n);
    assume (!in_valid || (count >= 3'd1 && count <= 3'd4));
    assume (!use_line || line_valid);
    assume (arrive_place < ALL && (!arrive || (arrive_second ? owed_second[arrive_place] : owed_first[arrive_place])));
    assume (BEATS == 2 || !arrive_second);
  end
  integer i;
  always @(posedge clk) begin
    past <= 1'b1;
    if (!rst_n) begin
      came <= 16'd0;
      asked <= 16'd0;
      used <= 16'd0;
      owed_first <= {ENTRIES{1'b0}};
      owed_second <= {ENTRIES{1'b0}};
    end else begin
      came <= came + (in_pop ? {13'd0, count} : 16'd0);
      asked <= asked + {15'd0, request_push};
      used <= used + {15'd0, use_line};
      for (i = 0; i < ENTRIES; i = i + 1) begin
        if (request_push && request_data[`MEMORY_REQUEST_TAG] == i) owed_first[i] <= 1'b1;
        else if (arrive && !arrive_second && arrive_place == i) owed_first[i] <= 1'b0;
        if (request_push && request_data[`MEMORY_REQUEST_TAG] == i) owed_second[i] <= BEATS == 2;
        else if (arrive && arrive_second && arrive_place == i) owed_second[i] <= 1'b0;
      end
    end
  end

  // The followed line: one line of a token, and its data in memory.
  (* anyseq *) wire pick;
  (* anyseq *) wire [1:0] which;
  (* anyconst *) wire [DATA_BITS-1:0] content;
  reg followed = 1'b0, sent, done;  // done: used
  reg [15:0] number;
  reg [LINE_BITS-1:0] address;
  reg [ENTRY_BITS-1:0] place;
  wire its_request = followed && !sent && request_push && asked == number;
  wire its_turn = followed && sent && !done && used == number;
  wire [4*LINE_BITS-1:0] missed = in_data[`MISS_TOKEN_LINE];
  always @(posedge clk)
    if (!rst_n) followed <= 1'b0;
    else if (in_pop && pick && !followed && {1'b0, which} < count) begin
      followed <= 1'b1;
      sent <= 1'b0;
      done <= 1'b0;
      number <= came + {14'd0, which};
      address <= missed[which*LINE_BITS +: LINE_BITS];
    end else begin
      if (its_request) begin
        sent <= 1'b1;
        place <= request_data[`MEMORY_REQUEST_TAG];
      end
      if (its_turn && use_line) done <= 1'b1;
    end
  wire its_beat = arrive && followed && sent && !done && arrive_place == place;
  wire [15:0] its_data = arrive_second ? content[DATA_BITS-1 -: 16] : content[15:0];
  always @* assume (!its_beat || arrive_data == its_data);

  // Proved properties.
  always @* if (past && rst_n) begin
    a_request: assert (!its_request || (request_data[`MEMORY_REQUEST_ADDRESS] ==
                       {address, {(32 - LINE_BITS) {1'b0}}} && request_data[`MEMORY_REQUEST_LINES] == BEATS));
    a_in_queue: assert (!(followed && !sent) || number - asked < came - asked);
    a_in_buffer: assert (!(followed && sent && !done) || number - used < asked - used);
    a_line: assert (!its_turn || !line_valid || line == content);
    a_free: assert (!reserve || !(followed && sent && !done) || reserved != place);
  end

  // Invariants for the induction: both rings and the followed line.
  wire [15:0] before_it = number - asked, in_front = number - used;
  assign \queue.f_place = behind(\queue.read_place , before_it[COUNT_BITS-1:0]);
  assign \fills.g_beat[0].lines.f_address = place;
  assign word[15:0] = \fills.g_beat[0].lines.f_word ;
  assign \fills.g_beat[1].lines.f_address = place;
  generate
    if (BEATS == 2) begin : g_second
      assign word[31:16] = \fills.g_beat[1].lines.f_word ;
    end
  endgenerate
  wire [COUNT_BITS-1:0] unread = \fills.held - {{(COUNT_BITS - 1) {1'b0}}, line_valid};
  wire [COUNT_BITS-1:0] front = in_front[COUNT_BITS-1:0] - {{(COUNT_BITS - 1) {1'b0}}, line_valid};
  wire on_register = line_valid && in_front == 16'd0;
  reg [ENTRIES-1:0] ring;  // entries that are reserved and not yet read
  always @*
    for (i = 0; i < ENTRIES; i = i + 1)
      ring[i] = (i >= \fills.read_place ? i - \fills.read_place : i + ENTRIES - \fills.read_place ) < unread;
  wire [ENTRIES-1:0] owed = owed_first | owed_second;
  always @* if (past && rst_n) begin
    i_waiting: assert (\queue.waiting <= ALL && came - asked == \queue.waiting );
    i_held: assert (\fills.held <= ALL && asked - used == \fills.held );
    i_places: assert (\queue.read_place < ALL && \queue.write_place < ALL && \fills.read_place < ALL &&
                      reserved < ALL);
    i_write: assert (\queue.write_place == behind(\queue.read_place , \queue.waiting ));
    i_reserved: assert (reserved == behind(\fills.read_place , unread));
    i_can_reserve: assert (can_reserve == (\fills.held != ALL));
    i_line_valid: assert (!line_valid || \fills.held != 0);
    i_ring: assert ((\fills.arrived & owed) == 0 && (\fills.arrived | owed) == ring);
    i_one_beat: assert (BEATS == 2 || owed_second == 0);
    i_queued: assert (!(followed && !sent) || \queue.f_line == address);
    i_place: assert (!(followed && sent && !done) ||
                     (on_register ? behind(place, 1) == \fills.read_place
                                  : place == behind(\fills.read_place , front)));
    i_first: assert (!(followed && sent && !done) || on_register || owed_first[place] ||
                     word[15:0] == content[15:0]);
    i_second: assert (BEATS == 1 || !(followed && sent && !done) || on_register || owed_second[place] ||
                      word[DATA_BITS-1 -: 16] == content[DATA_BITS-1 -: 16]);
  end
endmodule
