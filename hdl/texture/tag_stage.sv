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
  // Contents of a set: tags, turned bits and order of use; the valid bits have a reset and are separate.
  localparam integer TURNED_AT = WAYS * TAG_BITS;
  localparam integer ORDER_AT = TURNED_AT + WAYS;
  localparam integer VALID_AT = ORDER_AT + ORDER_BITS;
  localparam integer STORED_BITS = VALID_AT;
  localparam integer STATE_BITS = VALID_AT + WAYS;
  // Odd rows of the linear layout: lines are turned, their words swapped by half a tile.
  localparam integer TURN_BYTES = LINE_BYTES / 2 < 32 ? LINE_BYTES / 2 : 32;

  logic valid_2;
  wire leave;
  assign in_pop = in_valid && (!valid_2 || leave);
  always_ff @(posedge clk)
    if (!rst_n) valid_2 <= 1'b0;
    else if (!valid_2 || leave) valid_2 <= in_valid;

  // ---- 1: distinct lines, read of their sets
  wire [31:0] address_0 = in_data[`TEXEL_TOKEN_ADDRESS_0];
  wire [31:0] address_1 = in_data[`TEXEL_TOKEN_ADDRESS_1];
  wire [31:0] address_2 = in_data[`TEXEL_TOKEN_ADDRESS_2];
  wire [31:0] address_3 = in_data[`TEXEL_TOKEN_ADDRESS_3];
  wire [LINE_BITS-1:0] line_0 = address_0[31:OFFSET_BITS];
  wire [LINE_BITS-1:0] line_1 = address_1[31:OFFSET_BITS];
  wire [LINE_BITS-1:0] line_2 = address_2[31:OFFSET_BITS];
  wire [LINE_BITS-1:0] line_3 = address_3[31:OFFSET_BITS];
  wire [INDEX_BITS-1:0] index_0, index_1, index_2, index_3;
  generate
    if (SETS > 1) begin : g_index
      assign index_0 = line_0[SET_BITS-1:0];
      assign index_1 = line_1[SET_BITS-1:0];
      assign index_2 = line_2[SET_BITS-1:0];
      assign index_3 = line_3[SET_BITS-1:0];
    end else begin : g_one_set
      assign index_0 = 1'b0;
      assign index_1 = 1'b0;
      assign index_2 = 1'b0;
      assign index_3 = 1'b0;
    end
  endgenerate

  logic [STORED_BITS-1:0] sets[0:SETS-1];
  logic [SETS*WAYS-1:0] valids;
  // The sets as updated by the request in stage 2; written when it leaves.
  wire [STATE_BITS-1:0] next_0, next_1, next_2, next_3;
  wire write_0, write_1, write_2, write_3;
  logic [INDEX_BITS-1:0] at_0, at_1, at_2, at_3;
  // Write-first: of four writes to a set the last one counts, which includes the others.
  wire [STATE_BITS-1:0] read_0 = write_3 && at_3 == index_0 ? next_3 : write_2 && at_2 == index_0 ? next_2 :
                                 write_1 && at_1 == index_0 ? next_1 : write_0 && at_0 == index_0 ? next_0 :
                                 {valids[index_0*WAYS +: WAYS], sets[index_0]};
  wire [STATE_BITS-1:0] read_1 = write_3 && at_3 == index_1 ? next_3 : write_2 && at_2 == index_1 ? next_2 :
                                 write_1 && at_1 == index_1 ? next_1 : write_0 && at_0 == index_1 ? next_0 :
                                 {valids[index_1*WAYS +: WAYS], sets[index_1]};
  wire [STATE_BITS-1:0] read_2 = write_3 && at_3 == index_2 ? next_3 : write_2 && at_2 == index_2 ? next_2 :
                                 write_1 && at_1 == index_2 ? next_1 : write_0 && at_0 == index_2 ? next_0 :
                                 {valids[index_2*WAYS +: WAYS], sets[index_2]};
  wire [STATE_BITS-1:0] read_3 = write_3 && at_3 == index_3 ? next_3 : write_2 && at_2 == index_3 ? next_2 :
                                 write_1 && at_1 == index_3 ? next_1 : write_0 && at_0 == index_3 ? next_0 :
                                 {valids[index_3*WAYS +: WAYS], sets[index_3]};
  always_ff @(posedge clk) begin
    if (write_0) sets[at_0] <= next_0[STORED_BITS-1:0];
    if (write_1) sets[at_1] <= next_1[STORED_BITS-1:0];
    if (write_2) sets[at_2] <= next_2[STORED_BITS-1:0];
    if (write_3) sets[at_3] <= next_3[STORED_BITS-1:0];
  end
  always_ff @(posedge clk)
    if (!rst_n || invalidate) valids <= {(SETS * WAYS) {1'b0}};
    else begin
      if (write_0) valids[at_0*WAYS +: WAYS] <= next_0[VALID_AT +: WAYS];
      if (write_1) valids[at_1*WAYS +: WAYS] <= next_1[VALID_AT +: WAYS];
      if (write_2) valids[at_2*WAYS +: WAYS] <= next_2[VALID_AT +: WAYS];
      if (write_3) valids[at_3*WAYS +: WAYS] <= next_3[VALID_AT +: WAYS];
    end

  logic [`TICKET_BITS-1:0] ticket;
  logic [`TEXEL_TOKEN_CONTROL_BITS-1:0] control;
  logic [1:0] turned;
  logic [31:0] asked_0, asked_1, asked_2, asked_3;
  logic [STATE_BITS-1:0] set_0, set_1, set_2, set_3;
  logic same_10, same_20, same_21, same_30, same_31, same_32;  // lines
  always_ff @(posedge clk)
    if (in_pop) begin
      ticket <= in_data[`TEXEL_TOKEN_TICKET];
      control <= in_data[`TEXEL_TOKEN_CONTROL];
      turned <= in_data[`TEXEL_TOKEN_TURNED];
      asked_0 <= address_0;
      asked_1 <= address_1;
      asked_2 <= address_2;
      asked_3 <= address_3;
      at_0 <= index_0;
      at_1 <= index_1;
      at_2 <= index_2;
      at_3 <= index_3;
      set_0 <= read_0;
      set_1 <= read_1;
      set_2 <= read_2;
      set_3 <= read_3;
      same_10 <= line_1 == line_0;
      same_20 <= line_2 == line_0;
      same_21 <= line_2 == line_1;
      same_30 <= line_3 == line_0;
      same_31 <= line_3 == line_1;
      same_32 <= line_3 == line_2;
    end

  // ---- 2: lookups, each in the set as updated by the previous ones
  wire asks = valid_2 && ticket[`TICKET_VALID];
  wire on_0 = asks;
  wire on_1 = asks && !same_10;
  wire on_2 = asks && !same_20 && !same_21;
  wire on_3 = asks && !same_30 && !same_31 && !same_32;
  wire [STATE_BITS-1:0] seen_1 = on_0 && at_0 == at_1 ? next_0 : set_1;
  wire [STATE_BITS-1:0] seen_2 = on_1 && at_1 == at_2 ? next_1 : on_0 && at_0 == at_2 ? next_0 : set_2;
  wire [STATE_BITS-1:0] seen_3 = on_2 && at_2 == at_3 ? next_2 : on_1 && at_1 == at_3 ? next_1 :
                                 on_0 && at_0 == at_3 ? next_0 : set_3;

  // Steps of the shift register, one before each use.
  logic [15:0] drawn;
  wire [15:0] step_0 = {drawn[0] ^ drawn[2] ^ drawn[3] ^ drawn[5], drawn[15:1]};
  wire replaces_0, replaces_1, replaces_2, replaces_3;
  wire [15:0] drawn_1 = replaces_0 ? step_0 : drawn;
  wire [15:0] step_1 = {drawn_1[0] ^ drawn_1[2] ^ drawn_1[3] ^ drawn_1[5], drawn_1[15:1]};
  wire [15:0] drawn_2 = replaces_1 ? step_1 : drawn_1;
  wire [15:0] step_2 = {drawn_2[0] ^ drawn_2[2] ^ drawn_2[3] ^ drawn_2[5], drawn_2[15:1]};
  wire [15:0] drawn_3 = replaces_2 ? step_2 : drawn_2;
  wire [15:0] step_3 = {drawn_3[0] ^ drawn_3[2] ^ drawn_3[3] ^ drawn_3[5], drawn_3[15:1]};
  always_ff @(posedge clk)
    if (!rst_n) drawn <= 16'hACE1;
    else if (leave) drawn <= replaces_3 ? step_3 : drawn_3;

  wire hit_0, hit_1, hit_2, hit_3, miss_0, miss_1, miss_2, miss_3;
  wire is_turned_0, is_turned_1, is_turned_2, is_turned_3;
  wire [WAY_BITS-1:0] way_0, way_1, way_2, way_3;
  tag_look_up #(.WAYS(WAYS), .TAG_BITS(TAG_BITS), .REPLACEMENT(REPLACEMENT)) look_up_0 (
    .valid(set_0[VALID_AT +: WAYS]), .turned(set_0[TURNED_AT +: WAYS]), .tags(set_0[0 +: WAYS*TAG_BITS]),
    .order(set_0[ORDER_AT +: ORDER_BITS]), .enable(on_0), .tag(asked_0[31 -: TAG_BITS]), .turn(turned[0]),
    .random(step_0[WAY_BITS-1:0]), .hit(hit_0), .miss(miss_0), .replaces(replaces_0), .way(way_0),
    .is_turned(is_turned_0), .valid_next(next_0[VALID_AT +: WAYS]), .turned_next(next_0[TURNED_AT +: WAYS]),
    .tags_next(next_0[0 +: WAYS*TAG_BITS]), .order_next(next_0[ORDER_AT +: ORDER_BITS]));
  tag_look_up #(.WAYS(WAYS), .TAG_BITS(TAG_BITS), .REPLACEMENT(REPLACEMENT)) look_up_1 (
    .valid(seen_1[VALID_AT +: WAYS]), .turned(seen_1[TURNED_AT +: WAYS]), .tags(seen_1[0 +: WAYS*TAG_BITS]),
    .order(seen_1[ORDER_AT +: ORDER_BITS]), .enable(on_1), .tag(asked_1[31 -: TAG_BITS]), .turn(turned[0]),
    .random(step_1[WAY_BITS-1:0]), .hit(hit_1), .miss(miss_1), .replaces(replaces_1), .way(way_1),
    .is_turned(is_turned_1), .valid_next(next_1[VALID_AT +: WAYS]), .turned_next(next_1[TURNED_AT +: WAYS]),
    .tags_next(next_1[0 +: WAYS*TAG_BITS]), .order_next(next_1[ORDER_AT +: ORDER_BITS]));
  tag_look_up #(.WAYS(WAYS), .TAG_BITS(TAG_BITS), .REPLACEMENT(REPLACEMENT)) look_up_2 (
    .valid(seen_2[VALID_AT +: WAYS]), .turned(seen_2[TURNED_AT +: WAYS]), .tags(seen_2[0 +: WAYS*TAG_BITS]),
    .order(seen_2[ORDER_AT +: ORDER_BITS]), .enable(on_2), .tag(asked_2[31 -: TAG_BITS]), .turn(turned[1]),
    .random(step_2[WAY_BITS-1:0]), .hit(hit_2), .miss(miss_2), .replaces(replaces_2), .way(way_2),
    .is_turned(is_turned_2), .valid_next(next_2[VALID_AT +: WAYS]), .turned_next(next_2[TURNED_AT +: WAYS]),
    .tags_next(next_2[0 +: WAYS*TAG_BITS]), .order_next(next_2[ORDER_AT +: ORDER_BITS]));
  tag_look_up #(.WAYS(WAYS), .TAG_BITS(TAG_BITS), .REPLACEMENT(REPLACEMENT)) look_up_3 (
    .valid(seen_3[VALID_AT +: WAYS]), .turned(seen_3[TURNED_AT +: WAYS]), .tags(seen_3[0 +: WAYS*TAG_BITS]),
    .order(seen_3[ORDER_AT +: ORDER_BITS]), .enable(on_3), .tag(asked_3[31 -: TAG_BITS]), .turn(turned[1]),
    .random(step_3[WAY_BITS-1:0]), .hit(hit_3), .miss(miss_3), .replaces(replaces_3), .way(way_3),
    .is_turned(is_turned_3), .valid_next(next_3[VALID_AT +: WAYS]), .turned_next(next_3[TURNED_AT +: WAYS]),
    .tags_next(next_3[0 +: WAYS*TAG_BITS]), .order_next(next_3[ORDER_AT +: ORDER_BITS]));
  assign write_0 = leave && on_0;
  assign write_1 = leave && on_1;
  assign write_2 = leave && on_2;
  assign write_3 = leave && on_3;
  wire unused = &{1'b0, hit_0, hit_1, hit_2, hit_3, way_0, way_1, way_2, way_3};

  // Position of a line in the data banks: its set, then its way.
  wire [SLOT_BITS-1:0] slot_0, slot_1, slot_2, slot_3;
  generate
    if (WAYS == 1) begin : g_direct
      assign slot_0 = at_0;
      assign slot_1 = at_1;
      assign slot_2 = at_2;
      assign slot_3 = at_3;
    end else if (SETS == 1) begin : g_associative
      assign slot_0 = way_0;
      assign slot_1 = way_1;
      assign slot_2 = way_2;
      assign slot_3 = way_3;
    end else begin : g_both
      assign slot_0 = {at_0, way_0};
      assign slot_1 = {at_1, way_1};
      assign slot_2 = {at_2, way_2};
      assign slot_3 = {at_3, way_3};
    end
  endgenerate

  // Misses in order: index within the request.
  wire [2:0] number_1 = {2'd0, miss_0};
  wire [2:0] number_2 = number_1 + {2'd0, miss_1};
  wire [2:0] number_3 = number_2 + {2'd0, miss_2};
  wire [2:0] fills = number_3 + {2'd0, miss_3};
  // The lookup of each texel: its own line's, or that of the first texel with the same line.
  wire [1:0] of_1 = same_10 ? 2'd0 : 2'd1;
  wire [1:0] of_2 = same_20 ? 2'd0 : same_21 ? 2'd1 : 2'd2;
  wire [1:0] of_3 = same_30 ? 2'd0 : same_31 ? 2'd1 : same_32 ? 2'd2 : 2'd3;
  wire [3:0] misses = {miss_3, miss_2, miss_1, miss_0};
  wire [3:0] turns = {is_turned_3, is_turned_2, is_turned_1, is_turned_0};
  wire [11:0] numbers = {number_3, number_2, number_1, 3'd0};
  wire [4*SLOT_BITS-1:0] slots = {slot_3, slot_2, slot_1, slot_0};
  localparam logic [OFFSET_BITS-1:0] TURN = TURN_BYTES[OFFSET_BITS-1:0];

  wire [7:0] owners = {of_3, of_2, of_1, 2'd0};
  wire [127:0] asked = {asked_3, asked_2, asked_1, asked_0};
  wire [4*(SLOT_BITS+OFFSET_BITS)-1:0] places;
  wire [11:0] sources;
  genvar k;
  generate
    for (k = 0; k < 4; k = k + 1) begin : g_texel
      wire [1:0] owner = owners[2*k +: 2];
      wire [OFFSET_BITS-1:0] offset = asked[32*k +: OFFSET_BITS];
      assign places[k*(SLOT_BITS+OFFSET_BITS) +: SLOT_BITS+OFFSET_BITS] =
          misses[owner] ? {{SLOT_BITS{1'b0}}, offset}
                        : {slots[owner*SLOT_BITS +: SLOT_BITS], turns[owner] ? offset ^ TURN : offset};
      assign sources[3*k +: 3] = misses[owner] ? numbers[3*owner +: 3] + 3'd1 : 3'd0;
    end
  endgenerate

  // Fill number k is the miss with k misses before it.
  wire [LINE_BITS-1:0] asks_0 = asked_0[31:OFFSET_BITS], asks_1 = asked_1[31:OFFSET_BITS];
  wire [LINE_BITS-1:0] asks_2 = asked_2[31:OFFSET_BITS], asks_3 = asked_3[31:OFFSET_BITS];
  wire [4*SLOT_BITS-1:0] victims;
  wire [3:0] fills_turned;
  wire [4*LINE_BITS-1:0] lines;
  generate
    for (k = 0; k < 4; k = k + 1) begin : g_fill
      localparam logic [2:0] NUMBER = k[2:0];
      wire is_0 = NUMBER == 3'd0 && miss_0;
      wire is_1 = number_1 == NUMBER && miss_1;
      wire is_2 = number_2 == NUMBER && miss_2;
      wire is_3 = number_3 == NUMBER && miss_3;
      assign victims[k*SLOT_BITS +: SLOT_BITS] =
          ({SLOT_BITS{is_0}} & slot_0) | ({SLOT_BITS{is_1}} & slot_1) |
          ({SLOT_BITS{is_2}} & slot_2) | ({SLOT_BITS{is_3}} & slot_3);
      assign fills_turned[k] = ((is_0 || is_1) && turned[0]) || ((is_2 || is_3) && turned[1]);
      assign lines[k*LINE_BITS +: LINE_BITS] =
          ({LINE_BITS{is_0}} & asks_0) | ({LINE_BITS{is_1}} & asks_1) |
          ({LINE_BITS{is_2}} & asks_2) | ({LINE_BITS{is_3}} & asks_3);
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
