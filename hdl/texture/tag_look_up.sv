// SPDX-License-Identifier: MIT
// Looks up one line in its set and updates the set (docs/reference/texture/formats.md, "Cache and traffic"): a hit
// makes the line the most recently used one (only with `lru`); a miss takes the lowest invalid way, or replaces a line.
// One bit per pair of ways tells the older one.
`include "tables.svh"
module tag_look_up #(
  parameter integer WAYS = 2,
  parameter integer REPLACEMENT = `REPLACEMENT_LRU,
  parameter integer WAY_BITS = WAYS > 1 ? $clog2(WAYS) : 1,
  parameter integer ORDER_BITS = WAYS > 1 ? WAYS * (WAYS - 1) / 2 : 1
) (
  input  logic [WAYS-1:0]       valid,   // the set: one bit per way
  input  logic [WAYS-1:0]       filled,  // by an earlier lookup of the request, with another line
  input  logic [ORDER_BITS-1:0] order,   // for ways i < j: i is older
  input  logic                  enable,
  input  logic [WAYS-1:0]       stored,  // the way had the line before the request
  input  logic [WAY_BITS-1:0]   random,
  output logic                  miss,
  output logic                  replaces,  // a miss, and all ways are valid
  output logic [WAYS-1:0]       taken,   // way that has the line or gets it
  output logic [WAY_BITS-1:0]   way,     // its number
  output logic [WAYS-1:0]       valid_next,
  output logic [WAYS-1:0]       filled_next,
  output logic [ORDER_BITS-1:0] order_next
);
  wire [WAYS-1:0] equal = stored & ~filled;
  logic [WAYS-1:0] chosen;
  genvar i, j;
  generate
    for (i = 0; i < WAYS; i = i + 1) begin : g_way
      // Older than every other way.
      logic [WAYS-1:0] older;
      for (j = 0; j < WAYS; j = j + 1) begin : g_pair
        if (i < j) begin : g_older
          assign older[j] = order[i*WAYS - i*(i+1)/2 + j - i - 1];
        end else if (i > j) begin : g_younger
          assign older[j] = !order[j*WAYS - j*(j+1)/2 + i - j - 1];
        end else begin : g_itself
          assign older[j] = 1'b1;
        end
      end
      if (REPLACEMENT == `REPLACEMENT_RANDOM && WAYS > 1) begin : g_random
        localparam logic [WAY_BITS-1:0] HERE = i[WAY_BITS-1:0];
        assign chosen[i] = random == HERE;
        wire unused = &{1'b0, older};
      end else begin : g_oldest
        assign chosen[i] = &older;
      end
    end
  endgenerate
  wire unused = &{1'b0, random, order, touch};

  wire hit = |equal;
  assign miss = enable && !hit;
  assign replaces = miss && &valid;
  // The lowest invalid way.
  wire [WAYS-1:0] free = ~valid & (valid + {{(WAYS - 1) {1'b0}}, 1'b1});
  assign taken = hit ? equal : &valid ? chosen : free;
  always_comb begin
    way = {WAY_BITS{1'b0}};
    for (integer w = 0; w < WAYS; w = w + 1)
      if (taken[w]) way = way | w[WAY_BITS-1:0];
  end

  wire [WAYS-1:0] fill = taken & {WAYS{miss}};
  assign valid_next = valid | fill;
  assign filled_next = filled | fill;
  wire touch = miss || (enable && hit && REPLACEMENT == `REPLACEMENT_LRU);
  generate
    for (i = 0; i < WAYS; i = i + 1) begin : g_next
      for (j = i + 1; j < WAYS; j = j + 1) begin : g_pair
        localparam integer PAIR = i*WAYS - i*(i+1)/2 + j - i - 1;
        assign order_next[PAIR] = touch && taken[i] ? 1'b0 : touch && taken[j] ? 1'b1 : order[PAIR];
      end
    end
    if (WAYS == 1) begin : g_no_order
      assign order_next = order;
    end
  endgenerate
endmodule
