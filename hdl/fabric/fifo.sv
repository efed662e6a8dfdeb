// SPDX-License-Identifier: MIT
// Function  A FIFO with many entries: a memory with one read and one write port, prefetched into two output registers.
//           A beat bypasses the memory while these have room. Both sides have the link protocol.
// Latency   1: pushed in t, poppable from t + 1; freed in t, refillable from t + 1.
// Source    docs/explanation/fabric.md, "Memories".
//
// ENTRIES counts all beats that it holds, in the memory and in the registers.
module fifo #(
  parameter integer BITS = 8,
  parameter integer ENTRIES = 64
) (
  input  logic            clk,
  input  logic            rst_n,
  input  logic            push,
  input  logic [BITS-1:0] push_data,
  output logic            can_push,
  input  logic            pop,
  output logic [BITS-1:0] front,
  output logic            can_pop
);
  localparam integer COUNT_BITS = $clog2(ENTRIES + 1);
  localparam integer ENTRY_BITS = ENTRIES > 1 ? $clog2(ENTRIES) : 1;
  localparam logic [COUNT_BITS-1:0] FULL = ENTRIES[COUNT_BITS-1:0];
  localparam integer LAST_INDEX = ENTRIES - 1;
  localparam logic [ENTRY_BITS-1:0] LAST = LAST_INDEX[ENTRY_BITS-1:0];

  // All beats; beats in the memory that are not being read.
  logic [COUNT_BITS-1:0] count, stored;
  logic [ENTRY_BITS-1:0] write_place, read_place;
  // Two output registers, the oldest beat in `first`; a read of the previous cycle delivers `word`.
  logic [1:0] ready;  // beats in the registers, 0 to 2
  logic reading;      // `word` holds a beat that is not in a register yet
  logic [BITS-1:0] first, second, word;
  logic [BITS-1:0] memory[0:ENTRIES-1];

  // Beats left after this cycle's pop, which decide on a read.
  wire [1:0] left = ready + {1'b0, reading} - {1'b0, pop};
  wire read = stored != {COUNT_BITS{1'b0}} && left < 2'd2;
  // The memory is empty and the registers have room: the beat bypasses it.
  wire past = push && stored == {COUNT_BITS{1'b0}} && left < 2'd2;
  wire write = push && !past;

  wire [COUNT_BITS-1:0] next_count = count + {{(COUNT_BITS - 1) {1'b0}}, push} -
                                     {{(COUNT_BITS - 1) {1'b0}}, pop};
  always_ff @(posedge clk) begin
    if (write) memory[write_place] <= push_data;
    if (read) word <= memory[read_place];
  end

  always_ff @(posedge clk)
    if (!rst_n) begin
      count <= {COUNT_BITS{1'b0}};
      stored <= {COUNT_BITS{1'b0}};
      write_place <= {ENTRY_BITS{1'b0}};
      read_place <= {ENTRY_BITS{1'b0}};
      ready <= 2'd0;
      reading <= 1'b0;
      can_push <= 1'b1;
      can_pop <= 1'b0;
    end else begin
      count <= next_count;
      can_push <= next_count != FULL;
      can_pop <= next_count != {COUNT_BITS{1'b0}};
      stored <= stored + {{(COUNT_BITS - 1) {1'b0}}, write} - {{(COUNT_BITS - 1) {1'b0}}, read};
      if (write) write_place <= write_place == LAST ? {ENTRY_BITS{1'b0}} : write_place + 1'b1;
      if (read) read_place <= read_place == LAST ? {ENTRY_BITS{1'b0}} : read_place + 1'b1;
      reading <= read;
      ready <= left + {1'b0, past};
    end

  // The beat that the consumer sees: from the registers or, if they are empty, the word just read.
  assign front = ready != 2'd0 ? first : word;
  always_ff @(posedge clk) begin
    // Beats in order: first, second, word (at most two of them), then the bypassing one.
    if (pop) begin
      if (ready == 2'd2) first <= second;
      else if (ready == 2'd1 && reading) first <= word;
      else if (past) first <= push_data;
    end else if (ready == 2'd0) begin
      if (reading) first <= word;
      else if (past) first <= push_data;
    end
    if (pop) begin
      if (ready + {1'b0, reading} == 2'd2 && past) second <= push_data;
    end else begin
      if (ready == 2'd1 && reading) second <= word;
      else if (left == 2'd1 && past) second <= push_data;
    end
  end

`ifdef FORMAL
  // The proof of a link: the count, and one beat that the solver picks among all pushed beats.
  reg f_past = 1'b0;
  always @(posedge clk) f_past <= 1'b1;
  always @* if (!f_past) assume (!rst_n);
  always @* begin
    assume (!push || can_push);
    assume (!pop || can_pop);
  end
  (* anyseq *) wire f_pick;
  reg f_held = 1'b0, f_done = 1'b0;
  reg [BITS-1:0] f_beat;
  reg [COUNT_BITS-1:0] f_ahead;
  reg [31:0] f_pushed, f_popped;
  wire [COUNT_BITS-1:0] behind = count - {{(COUNT_BITS - 1) {1'b0}}, pop};
  always @(posedge clk)
    if (!rst_n) begin
      f_held <= 1'b0;
      f_done <= 1'b0;
      f_pushed <= 32'd0;
      f_popped <= 32'd0;
    end else begin
      f_pushed <= f_pushed + {31'd0, push};
      f_popped <= f_popped + {31'd0, pop};
      if (push && f_pick && !f_held && !f_done) begin
        f_held <= 1'b1;
        f_beat <= push_data;
        f_ahead <= behind;
      end else if (f_held && pop) begin
        if (f_ahead == {COUNT_BITS{1'b0}}) begin
          f_held <= 1'b0;
          f_done <= 1'b1;
        end else f_ahead <= f_ahead - 1'b1;
      end
    end
  // Position of the picked beat, which has f_ahead beats before it.
  wire [COUNT_BITS-1:0] f_out = {{(COUNT_BITS - 2) {1'b0}}, ready} + {{(COUNT_BITS - 1) {1'b0}}, reading};
  wire [COUNT_BITS:0] f_far = {1'b0, f_ahead} - {1'b0, f_out} + {{(COUNT_BITS + 1 - ENTRY_BITS) {1'b0}}, read_place};
  wire [COUNT_BITS:0] f_wrapped = f_far >= {1'b0, FULL} ? f_far - {1'b0, FULL} : f_far;
  wire [BITS-1:0] f_stored = memory[f_wrapped[ENTRY_BITS-1:0]];
  wire [BITS-1:0] f_where = f_ahead >= f_out ? f_stored :
                            f_ahead >= {{(COUNT_BITS - 2) {1'b0}}, ready} ? word :
                            f_ahead == {COUNT_BITS{1'b0}} ? first : second;
  wire [COUNT_BITS:0] f_next = {{(COUNT_BITS + 1 - ENTRY_BITS) {1'b0}}, read_place} + {1'b0, stored};
  wire [COUNT_BITS:0] f_write = f_next >= {1'b0, FULL} ? f_next - {1'b0, FULL} : f_next;
  wire [31:0] f_difference = f_pushed - f_popped;
  always @* if (f_past && rst_n) begin
    a_limit: assert (count <= FULL);
    a_count: assert (f_difference == {{(32 - COUNT_BITS) {1'b0}}, count});
    a_parts: assert (count == stored + f_out);
    a_registers: assert (f_out <= 2 && stored <= count);
    a_waiting: assert (stored == {COUNT_BITS{1'b0}} || f_out != {COUNT_BITS{1'b0}});
    a_places: assert (read_place <= LAST && write_place <= LAST);
    a_write: assert (write_place == f_write[ENTRY_BITS-1:0]);
    a_can_push: assert (can_push == (count != FULL));
    a_can_pop: assert (can_pop == (count != {COUNT_BITS{1'b0}}));
    a_ahead: assert (!f_held || f_ahead < count);
    a_beat: assert (!f_held || f_where == f_beat);
    a_front: assert (!f_held || f_ahead != {COUNT_BITS{1'b0}} || (can_pop && front == f_beat));
  end
`endif
endmodule
