// SPDX-License-Identifier: MIT
// Looks up the lines of a request, allocates those that miss and requests them, in two stages
// (docs/reference/texture/cache.md, "Tags"; docs/reference/texture/formats.md, "Cache and traffic").
`include "tokens.svh"
`include "tables.svh"
module tag_stage #(
  parameter integer BYTES = `CHOSEN_CACHE_BYTES,
  parameter integer LINE_BYTES = `CHOSEN_CACHE_LINE_BYTES,
  parameter integer WAYS = `CHOSEN_CACHE_WAYS,
  parameter integer REPLACEMENT = `CHOSEN_CACHE_REPLACEMENT
) (
  input  logic                         clk,
  input  logic                         rst_n,
  input  logic                         invalidate,  // all tags, while the cache is empty
  input  logic                         in_valid,
  output logic                         in_pop,
  input  logic [`TEXEL_TOKEN_BITS-1:0] in_data,
  output logic                         miss_push,
  input  logic                         miss_ready,
  output logic [`MISS_TOKEN_BITS-1:0]  miss_data,
  output logic                         out_push,
  input  logic                         out_ready,
  output logic [`CACHE_TOKEN_BITS-1:0] out_data
);
  localparam integer OFFSET_BITS = $clog2(LINE_BYTES);
  localparam integer LINE_BITS = 32 - OFFSET_BITS;
  localparam integer SETS = BYTES / (LINE_BYTES * WAYS);
  localparam integer SET_BITS = $clog2(SETS);
  localparam integer INDEX_BITS = SETS > 1 ? SET_BITS : 1;
  localparam integer WAY_BITS = WAYS > 1 ? $clog2(WAYS) : 1;
  localparam integer TAG_BITS = LINE_BITS - SET_BITS;
  localparam integer ORDER_BITS = WAYS > 1 ? WAYS * (WAYS - 1) / 2 : 1;
  localparam integer SLOT_BITS = $clog2(BYTES) - OFFSET_BITS;
  localparam integer PLACE_BITS = SLOT_BITS + OFFSET_BITS;
  // A way stores the tag of its line, and above it whether the line is turned. The state of a set changes from lookup to
  // lookup: its valid ways, those filled by the request, the order of use.
  localparam integer WORD_BITS = TAG_BITS + 1;
  localparam integer STATE_BITS = 2 * WAYS + ORDER_BITS;
  // Odd rows of the linear layout: lines are turned, their words swapped by half a tile.
  localparam integer TURN_BYTES = LINE_BYTES / 2 < 32 ? LINE_BYTES / 2 : 32;
  localparam logic [OFFSET_BITS-1:0] TURN = TURN_BYTES[OFFSET_BITS-1:0];

  logic valid_2;
  wire leave;
  assign in_pop = in_valid && (!valid_2 || leave);
  always_ff @(posedge clk)
    if (!rst_n) valid_2 <= 1'b0;
    else if (!valid_2 || leave) valid_2 <= in_valid;

  logic [`TICKET_BITS-1:0] ticket;
  logic [`TEXEL_TOKEN_CONTROL_BITS-1:0] control;
  logic [1:0] turned;  // of each row
  logic [127:0] asked;
  always_ff @(posedge clk)
    if (in_pop) begin
      ticket <= in_data[`TEXEL_TOKEN_TICKET];
      control <= in_data[`TEXEL_TOKEN_CONTROL];
      turned <= in_data[`TEXEL_TOKEN_TURNED];
      asked <= in_data[`TEXEL_TOKEN_ADDRESS];
    end
  wire asks = valid_2 && ticket[`TICKET_VALID];
  wire fills_leave = asks && out_ready && miss_ready;  // if a line is missing; other requests fill no way

  // Of the four lookups in stage 2, in order.
  wire [4*INDEX_BITS-1:0] ats;      // sets
  wire [4*WAYS-1:0] valids_2, stored, was_turned;  // ways as read, those with the line, those with a turned line
  wire [4*STATE_BITS-1:0] nexts;    // their states after each
  wire [3:0] misses, hits_turned;
  wire [4*WAYS-1:0] takens;
  wire [4*WAY_BITS-1:0] ways;
  wire [7:0] owners;                // the first texel with the same line

  // Of the request in stage 1: sets, and for each the lookups of stage 2 in the same set.
  wire [4*INDEX_BITS-1:0] indices;
  wire [15:0] all_follow;

  // Updated when the request leaves; of several writes to a set the last one counts, which includes the others.
  logic [SETS*WAYS-1:0] valids;
  logic [ORDER_BITS-1:0] orders[0:SETS-1];
  always_ff @(posedge clk)
    if (!rst_n || invalidate) valids <= {(SETS * WAYS) {1'b0}};
    else if (fills_leave)
      for (integer n = 0; n < 4; n = n + 1)
        valids[ats[n*INDEX_BITS +: INDEX_BITS]*WAYS +: WAYS] <= nexts[n*STATE_BITS +: WAYS];
  always_ff @(posedge clk)
    if (leave && asks)
      for (integer n = 0; n < 4; n = n + 1)
        orders[ats[n*INDEX_BITS +: INDEX_BITS]] <= nexts[n*STATE_BITS + 2*WAYS +: ORDER_BITS];

  // Steps of the shift register, which only replacements take: its bits and the next four.
  logic [15:0] drawn;
  wire [19:0] steps = {drawn[3:0] ^ drawn[5:2] ^ drawn[6:3] ^ drawn[8:5], drawn};
  always_ff @(posedge clk)
    if (!rst_n) drawn <= 16'hACE1;
    else if (leave) drawn <= g_texel[3].steps_left[15:0];

  genvar i, k, w;
  generate
    for (k = 0; k < 4; k = k + 1) begin : g_texel
      // ---- 1: distinct lines, read of their sets
      wire [31:0] address = in_data[`TEXEL_TOKEN_ADDRESS_FIRST + 32*k +: 32];
      wire [INDEX_BITS-1:0] index, at;
      if (SETS > 1) begin : g_index
        assign index = address[OFFSET_BITS +: INDEX_BITS];
        assign at = asked[32*k + OFFSET_BITS +: INDEX_BITS];
      end else begin : g_one_set
        assign index = 1'b0;
        assign at = 1'b0;
      end
      // Lookups of the request in stage 2 in the same set: their results count.
      wire [3:0] follows;
      assign indices[k*INDEX_BITS +: INDEX_BITS] = index;
      assign all_follow[4*k +: 4] = follows;
      wire [WAYS-1:0] valid_now = valids[index*WAYS +: WAYS];
      wire [ORDER_BITS-1:0] order_now = orders[index];
      logic [WAYS-1:0] valid_read, valid;
      logic [ORDER_BITS-1:0] order_read, order;
      always_comb begin
        valid_read = valid_now;
        order_read = order_now;
        for (integer n = 0; n < 4; n = n + 1)
          if (follows[n]) begin
            valid_read = nexts[n*STATE_BITS +: WAYS];
            order_read = nexts[n*STATE_BITS + 2*WAYS +: ORDER_BITS];
          end
      end
      // The first texel with the same line; the last lookup before it in the same set, or itself.
      wire [3:0] same_line, same_set;
      logic [1:0] owner_now, owner;
      logic [3:0] from_now, from;
      always_comb begin
        owner_now = k[1:0];
        from_now = 4'd0;
        from_now[k] = 1'b1;
        for (integer n = k - 1; n >= 0; n = n - 1)
          if (same_line[n]) owner_now = n[1:0];
        for (integer n = 0; n < k; n = n + 1)
          if (same_set[n]) from_now = 4'd1 << n;
      end
      always_ff @(posedge clk)
        if (in_pop) begin
          valid <= valid_read;
          order <= order_read;
          owner <= owner_now;
          from <= from_now;
        end

      // ---- 2: the lookup, in the set as updated by the previous ones
      wire [STATE_BITS-1:0] states[0:3];
      for (i = 0; i < 4; i = i + 1) begin : g_before
        assign follows[i] = asks && ats[i*INDEX_BITS +: INDEX_BITS] == index;
        if (i < k) begin : g_earlier
          assign same_line[i] = g_texel[i].address[31:OFFSET_BITS] == address[31:OFFSET_BITS];
          assign same_set[i] = g_texel[i].index == index;
          assign states[i] = from[i] ? g_texel[i].next : {STATE_BITS{1'b0}};
        end else begin : g_itself
          assign same_line[i] = 1'b0;
          assign same_set[i] = 1'b0;
          assign states[i] = i == k && from[i] ? {order, {WAYS{1'b0}}, valid} : {STATE_BITS{1'b0}};
        end
      end
      wire [STATE_BITS-1:0] seen = states[0] | states[1] | states[2] | states[3];
      wire [STATE_BITS-1:0] next;
      wire [WAYS-1:0] taken;
      wire miss, replaces;
      wire [19:0] steps_before, steps_left;
      if (k == 0) begin : g_first
        assign steps_before = steps;
      end else begin : g_next
        assign steps_before = g_texel[k-1].steps_left;
      end
      tag_look_up #(.WAYS(WAYS), .REPLACEMENT(REPLACEMENT)) look_up (
        .valid(seen[0 +: WAYS]), .filled(seen[WAYS +: WAYS]), .order(seen[2*WAYS +: ORDER_BITS]),
        .enable(asks && owner == k[1:0]), .stored(stored[k*WAYS +: WAYS]), .random(steps_before[WAY_BITS:1]), .miss, .replaces, .taken,
        .way(ways[k*WAY_BITS +: WAY_BITS]), .valid_next(next[0 +: WAYS]), .filled_next(next[WAYS +: WAYS]),
        .order_next(next[2*WAYS +: ORDER_BITS]));
      assign steps_left = replaces ? steps_before >> 1 : steps_before;
      assign ats[k*INDEX_BITS +: INDEX_BITS] = at;
      assign nexts[k*STATE_BITS +: STATE_BITS] = next;
      assign misses[k] = miss;
      assign takens[k*WAYS +: WAYS] = taken;
      assign hits_turned[k] = |(taken & was_turned[k*WAYS +: WAYS]);
      assign valids_2[k*WAYS +: WAYS] = valid;
      assign owners[2*k +: 2] = owner;
    end
    for (w = 0; w < WAYS; w = w + 1) begin : g_way
      logic [WORD_BITS-1:0] words[0:SETS-1];
      wire [4*WORD_BITS-1:0] fills_with;
      always_ff @(posedge clk)
        for (integer n = 0; n < 4; n = n + 1)
          if (fills_leave && misses[n] && takens[n*WAYS + w])
            words[ats[n*INDEX_BITS +: INDEX_BITS]] <= fills_with[n*WORD_BITS +: WORD_BITS];
      for (k = 0; k < 4; k = k + 1) begin : g_read
        assign fills_with[k*WORD_BITS +: WORD_BITS] = {turned[k/2], asked[32*k + 32 - TAG_BITS +: TAG_BITS]};
        wire [WORD_BITS-1:0] now = words[indices[k*INDEX_BITS +: INDEX_BITS]];
        logic [WORD_BITS-1:0] word_read, word;
        always_comb begin
          word_read = now;
          for (integer n = 0; n < 4; n = n + 1)
            if (all_follow[4*k+n] && misses[n] && takens[n*WAYS + w])
              word_read = fills_with[n*WORD_BITS +: WORD_BITS];
        end
        always_ff @(posedge clk)
          if (in_pop) word <= word_read;
        assign stored[k*WAYS+w] = valids_2[k*WAYS+w] &&
                                  word[0 +: TAG_BITS] == asked[32*k + 32 - TAG_BITS +: TAG_BITS];
        assign was_turned[k*WAYS+w] = word[TAG_BITS];
      end
    end
  endgenerate

  // Position of a line in the data banks: its set, then its way. Misses are numbered in order.
  function automatic [2:0] ones(input [3:0] bits);
    ones = {2'd0, bits[0]} + {2'd0, bits[1]} + {2'd0, bits[2]} + {2'd0, bits[3]};
  endfunction
  wire [4*SLOT_BITS-1:0] slots;
  wire [11:0] numbers;
  wire [2:0] fills = ones(misses);
  wire [4*PLACE_BITS-1:0] places;
  wire [11:0] sources;
  logic [4*SLOT_BITS-1:0] victims;
  logic [3:0] fills_turned;
  logic [4*LINE_BITS-1:0] lines;
  generate
    for (k = 0; k < 4; k = k + 1) begin : g_out
      localparam logic [3:0] BEFORE = (4'd1 << k) - 4'd1;
      assign numbers[3*k +: 3] = ones(misses & BEFORE);
      if (WAYS == 1) begin : g_direct
        wire unused = &{1'b0, ways};
        assign slots[k*SLOT_BITS +: SLOT_BITS] = ats[k*INDEX_BITS +: INDEX_BITS];
      end else if (SETS == 1) begin : g_associative
        assign slots[k*SLOT_BITS +: SLOT_BITS] = ways[k*WAY_BITS +: WAY_BITS];
      end else begin : g_both
        assign slots[k*SLOT_BITS +: SLOT_BITS] = {ats[k*INDEX_BITS +: INDEX_BITS], ways[k*WAY_BITS +: WAY_BITS]};
      end
      wire [1:0] owner = owners[2*k +: 2];
      wire [OFFSET_BITS-1:0] offset = asked[32*k +: OFFSET_BITS];
      assign places[k*PLACE_BITS +: PLACE_BITS] =
          misses[owner] ? {{SLOT_BITS{1'b0}}, offset}
                        : {slots[owner*SLOT_BITS +: SLOT_BITS], hits_turned[owner] ? offset ^ TURN : offset};
      assign sources[3*k +: 3] = misses[owner] ? numbers[3*owner +: 3] + 3'd1 : 3'd0;
      // Fill number k is the miss with k misses before it.
      localparam logic [2:0] NUMBER = k[2:0];
      always_comb begin
        victims[k*SLOT_BITS +: SLOT_BITS] = {SLOT_BITS{1'b0}};
        fills_turned[k] = 1'b0;
        lines[k*LINE_BITS +: LINE_BITS] = {LINE_BITS{1'b0}};
        for (integer n = k; n < 4; n = n + 1)
          if (misses[n] && numbers[3*n +: 3] == NUMBER) begin
            victims[k*SLOT_BITS +: SLOT_BITS] = slots[n*SLOT_BITS +: SLOT_BITS];
            fills_turned[k] = turned[n/2];
            lines[k*LINE_BITS +: LINE_BITS] = asked[32*n + OFFSET_BITS +: LINE_BITS];
          end
      end
    end
  endgenerate

  // Both links accept in the same cycle.
  assign leave = valid_2 && out_ready && (fills == 3'd0 || miss_ready);
  assign out_push = leave;
  assign miss_push = leave && fills != 3'd0;
  assign miss_data[`MISS_TOKEN_LINE] = lines;
  assign miss_data[`MISS_TOKEN_COUNT] = fills;
  assign out_data[`CACHE_TOKEN_TICKET] = ticket;
  assign out_data[`CACHE_TOKEN_CONTROL] = control;
  assign out_data[`CACHE_TOKEN_PLACE] = places;
  assign out_data[`CACHE_TOKEN_SOURCE] = sources;
  assign out_data[`CACHE_TOKEN_VICTIM] = victims;
  assign out_data[`CACHE_TOKEN_TURNED] = fills_turned;
  assign out_data[`CACHE_TOKEN_FILLS] = fills;
endmodule
