// SPDX-License-Identifier: MIT
// Function  A link: a valid/ready channel with a registered hand-over, built of flip-flops for few entries (fifo.sv for
//           many).
// Latency   1: a beat pushed in cycle t can be popped from t + 1; an entry freed in t can be refilled from t + 1.
// Interval  1: one push and one pop per cycle.
// Source    docs/explanation/fabric.md, "A link".
//
// can_push and can_pop are registers: no combinational path passes through a link. A push without can_push or a pop
// without can_pop violates the protocol, which assertions under `ifdef FORMAL check.
module link #(
  parameter integer BITS = 8,
  parameter integer ENTRIES = 2
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
  localparam logic [COUNT_BITS-1:0] FULL = ENTRIES[COUNT_BITS-1:0];

  logic [COUNT_BITS-1:0] count;
  wire  [COUNT_BITS-1:0] next_count = count + {{(COUNT_BITS - 1) {1'b0}}, push} -
                                      {{(COUNT_BITS - 1) {1'b0}}, pop};
  always_ff @(posedge clk)
    if (!rst_n) begin
      count <= {COUNT_BITS{1'b0}};
      can_push <= 1'b1;
      can_pop <= 1'b0;
    end else begin
      count <= next_count;
      can_push <= next_count != FULL;
      can_pop <= next_count != {COUNT_BITS{1'b0}};
    end

  // The oldest beat is in entry 0; a pop shifts the others down, and a push goes to the first free entry.
  logic [BITS-1:0] place[0:ENTRIES-1];
  wire  [COUNT_BITS-1:0] behind = count - {{(COUNT_BITS - 1) {1'b0}}, pop};
  assign front = place[0];
  genvar i;
  generate
    for (i = 0; i < ENTRIES; i = i + 1) begin : g_place
      localparam logic [COUNT_BITS-1:0] HERE = i[COUNT_BITS-1:0];
      if (i + 1 < ENTRIES) begin : g_inner
        always_ff @(posedge clk)
          if (push && behind == HERE) place[i] <= push_data;
          else if (pop) place[i] <= place[i+1];
      end else begin : g_last
        always_ff @(posedge clk)
          if (push && behind == HERE) place[i] <= push_data;
      end
    end
  endgenerate

`ifdef FORMAL
  // If both sides keep the protocol: the count is right, and a beat that the solver picks among all pushed beats comes
  // out unchanged and in order. `ahead` counts the beats before it.
  reg f_past = 1'b0;
  always @(posedge clk) f_past <= 1'b1;
  always @* if (!f_past) assume (!rst_n);
  always @* begin
    assume (!push || can_push);
    assume (!pop || can_pop);
  end
  (* anyseq *) wire f_pick;
  reg f_held = 1'b0;               // the picked beat is in the link
  reg f_done = 1'b0;               // it has left: only one beat is followed
  reg [BITS-1:0] f_beat;
  reg [COUNT_BITS-1:0] f_ahead;
  reg [31:0] f_pushed, f_popped;   // since the reset, modulo 2^32
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
  wire [31:0] f_difference = f_pushed - f_popped;
  always @* if (f_past && rst_n) begin
    a_limit: assert (count <= FULL);
    a_count: assert (f_difference == {{(32 - COUNT_BITS) {1'b0}}, count});
    a_can_push: assert (can_push == (count != FULL));
    a_can_pop: assert (can_pop == (count != {COUNT_BITS{1'b0}}));
    a_ahead: assert (!f_held || f_ahead < count);
    a_beat: assert (!f_held || place[f_ahead] == f_beat);
    a_front: assert (!f_held || f_ahead != {COUNT_BITS{1'b0}} || (can_pop && front == f_beat));
  end
`endif
endmodule
