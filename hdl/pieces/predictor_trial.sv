// SPDX-License-Identifier: MIT
// Function  One trial of an EndpointPredictor, of one side of a vertical run, with `contiguous` and a search range of
//           32 rows: tests the candidate lengths of a step, and chooses the step. It has no bounds of `safe`. Edges
//           outside the frame and the window arrive as 0.
// Latency   4: stage 0 addresses the columns, whose words arrive in stage 1; stage 3 is the choice.
// Interval  1: predictors and sides take turns.
// Source    docs/reference/datasheets.md, "EndpointPredictor", stages 0 to 2 and 4;
//           docs/reference/morphological/algorithm.md, "Extension".
//
// Runs are described as horizontal ones, as on the page: in the words, `run` are the edges of the lattice line of the
// step, `first` and `second` the crossing edges on its two sides. Bit j of a word is row j of the window.
module predictor_trial (
  input  logic        clk,
  input  logic        rst_n,
  input  logic        in_valid,
  input  logic [12:0] column,        // of the run
  input  logic        down,          // d is +1
  input  logic [4:0]  k,
  input  logic [5:0]  position,      // XR_k, 1 to 32
  input  logic [6:0]  origin,        // the row of corner XR_k in the window
  input  logic [5:0]  length,        // L
  input  logic [5:0]  other,         // L', if `known`
  input  logic        known,
  input  logic [3:0]  start_code,    // A: W + 2 E + 4 N + 8 S
  input  logic [3:0]  end_code,      // B
  output logic signed [13:0] address,  // column of `run` and `second`; `first` is of the column before it
  input  logic [66:0] run, first, second,
  output logic        out_valid,
  output logic        hit,
  output logic        beyond,        // the search range hid a candidate
  output logic [5:0]  step,          // s
  output logic [5:0]  next_position
);
  // 0: address; candidates within the search range, in their order.
  wire signed [13:0] by = {9'd0, k} + 14'd1;
  assign address = down ? {1'b0, column} + by : {1'b0, column} - by;
  wire [5:0] shorter = length - 6'd1, longer = length + 6'd1;
  wire [6:0] end_same = {1'b0, position} + {1'b0, length};
  wire [6:0] end_less = {1'b0, position} + {1'b0, known ? other : shorter};
  wire [6:0] end_more = {1'b0, position} + {1'b0, longer};
  wire in_same = end_same <= 7'd32;
  wire in_less = end_less <= 7'd32 && (known || length != 6'd1);
  wire in_more = end_more <= 7'd32 && !known;
  wire hidden = known ? !in_same || end_less > 7'd32 : end_more > 7'd32;

  logic [2:0] valid;
  logic hidden_0, hidden_1, hidden_2;
  logic [2:0] in_0, in_1;
  logic [6:0] origin_0;
  logic [2:0] origin_1;
  logic [5:0] same_0, less_0, position_0, same_1, less_1, position_1, same_2, less_2, position_2;
  logic [7:0] codes_0, codes_1;
  always_ff @(posedge clk) begin
    in_0 <= {in_more, in_less, in_same};
    {hidden_0, origin_0, position_0, codes_0} <= {hidden, origin, position, end_code, start_code};
    {same_0, less_0} <= {length, known ? other : shorter};
  end

  // 1: groups of eight rows: the group of the origin and the next two, with the row before them. A step that fits the
  // range is at most 16 rows, since the run is as long.
  wire [3:0] group = origin_0[6:3];
  wire [96:0] run_rows = {29'd0, run, 1'b0};
  wire [95:0] first_rows = {29'd0, first}, second_rows = {29'd0, second};
  logic [24:0] run_1;  // bit 0 is the row before the group
  logic [23:0] first_1, second_1;
  always_ff @(posedge clk) begin
    run_1 <= run_rows[{group, 3'd0} +: 25];
    first_1 <= first_rows[{group, 3'd0} +: 24];
    second_1 <= second_rows[{group, 3'd0} +: 24];
    {in_1, hidden_1, origin_1, position_1, codes_1} <= {in_0, hidden_0, origin_0[2:0], position_0, codes_0};
    {same_1, less_1} <= {same_0, less_0};
  end

  // 2: codes of the corners; edges from the origin to each candidate.
  wire [4:0] at_same = {2'd0, origin_1} + same_1[4:0];
  wire [4:0] at_less = {2'd0, origin_1} + less_1[4:0];
  wire [4:0] at_more = at_same + 5'd1;
  wire [3:0] code_origin = {second_1[{2'd0, origin_1}], first_1[{2'd0, origin_1}],
                            run_1[{2'd0, origin_1} + 5'd1], run_1[{2'd0, origin_1}]};
  wire [3:0] code_same = {second_1[at_same], first_1[at_same], run_1[at_same + 5'd1], run_1[at_same]};
  wire [3:0] code_less = {second_1[at_less], first_1[at_less], run_1[at_less + 5'd1], run_1[at_less]};
  wire [3:0] code_more = {second_1[at_more], first_1[at_more], run_1[at_more + 5'd1], run_1[at_more]};
  // Gaps at or after the origin.
  wire [23:0] gaps = ~run_1[24:1] & (24'hFFFFFF << origin_1);
  wire whole_same = (gaps & ~(24'hFFFFFF << at_same)) == 24'd0;
  wire whole_less = (gaps & ~(24'hFFFFFF << at_less)) == 24'd0;
  wire whole_more = (gaps & ~(24'hFFFFFF << at_more)) == 24'd0;
  wire from = code_origin == codes_1[3:0];
  logic [2:0] hits;
  always_ff @(posedge clk) begin
    hits[0] <= in_1[0] && from && whole_same && code_same == codes_1[7:4];
    hits[1] <= in_1[1] && from && whole_less && code_less == codes_1[7:4];
    hits[2] <= in_1[2] && from && whole_more && code_more == codes_1[7:4];
    {hidden_2, position_2, same_2, less_2} <= {hidden_1, position_1, same_1, less_1};
  end

  // 3: the first candidate that hits.
  wire [5:0] chosen = hits[0] ? same_2 : hits[1] ? less_2 : same_2 + 6'd1;
  always_ff @(posedge clk)
    if (!rst_n) {out_valid, valid} <= 4'd0;
    else {out_valid, valid} <= {valid, in_valid};
  always_ff @(posedge clk) begin
    hit <= hits != 3'd0;
    beyond <= hidden_2;
    step <= chosen;
    next_position <= position_2 + chosen;
  end
endmodule
