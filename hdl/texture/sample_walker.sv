// SPDX-License-Identifier: MIT
// Walks N samples along the major axis and emits the bilinear requests of each, one request per cycle; its stages
// advance independently (docs/reference/texture/formats.md, "Sample walker"; docs/reference/datasheets.md,
// "SampleWalker").
`include "tokens.svh"
`include "tables.svh"
module sample_walker #(
  parameter integer COUNT = `CHOSEN_COUNT,
  parameter integer KERNEL = `CHOSEN_KERNEL,
  parameter integer SPREAD = `CHOSEN_SPREAD  // U2.6
) (
  input  logic                          clk,
  input  logic                          rst_n,
  input  logic                          in_valid,
  output logic                          in_pop,
  input  logic [`LEVEL_TOKEN_BITS-1:0]  in_data,
  output logic                          out_push,
  input  logic                          out_ready,
  output logic [`SAMPLE_TOKEN_BITS-1:0] out_data
);
  localparam logic [7:0] WIDE = SPREAD[7:0];
  localparam logic [7:0] NARROW = SPREAD > 64 ? 8'd64 : SPREAD[7:0];
  // With `kernel = axis` the tent of a diagonal is sqrt(2) times as long.
  localparam integer LONGER_SPREAD = (181 * SPREAD + 64) / 128;
  localparam logic [7:0] LONGER = LONGER_SPREAD[7:0];
  localparam integer POSITION_BITS = `SAMPLE_TOKEN_S_BITS;
  localparam integer AXIS_BITS = `LEVEL_TOKEN_AXIS_S_BITS;

  // ---- 1: spread times axis
  wire signed [33:0] axis_s = {{(35 - AXIS_BITS) {in_data[`LEVEL_TOKEN_AXIS_S_TOP]}},
                               in_data[`LEVEL_TOKEN_AXIS_S_LOW]};
  wire signed [33:0] axis_t = {{(35 - AXIS_BITS) {in_data[`LEVEL_TOKEN_AXIS_T_TOP]}},
                               in_data[`LEVEL_TOKEN_AXIS_T_LOW]};
  // The fragment of an invalid descriptor takes one request and one cycle. The fields below and above the axis pass to
  // the requests.
  logic [`LEVEL_TOKEN_BITS-1:0] with_in;
  always_comb begin
    with_in = in_data;
    if (!in_data[`LEVEL_TOKEN_TICKET_VALID]) begin
      with_in[`LEVEL_TOKEN_LAST_INDEX] = 4'd0;
      with_in[`LEVEL_TOKEN_FRACTION] = 8'd0;
    end
  end
  wire [3:0] last_index = with_in[`LEVEL_TOKEN_LAST_INDEX];
`ifdef LEVEL_TOKEN_DIAGONAL
  wire longer = in_data[`LEVEL_TOKEN_DIAGONAL] && last_index >= 4'd4;
`else
  wire longer = 1'b0;
`endif
  wire [7:0] spread = longer ? LONGER : KERNEL == `KERNEL_TENT && last_index < 4'd3 ? NARROW : WIDE;
  wire signed [40:0] wide_spread = $signed({33'd0, spread});

  logic full_1;
  logic leave_1;  // the first register passes its fragment to the next one
  wire enter_1 = in_valid && (!full_1 || leave_1);
  assign in_pop = enter_1;
  logic [`LEVEL_TOKEN_BITS-1:0] with_1;
  logic signed [40:0] wide_s_1, wide_t_1;
  always_ff @(posedge clk)
    if (!rst_n) full_1 <= 1'b0;
    else full_1 <= enter_1 || (full_1 && !leave_1);
  always_ff @(posedge clk)
    if (enter_1) begin
      with_1 <= with_in;
      wide_s_1 <= $signed({{7{axis_s[33]}}, axis_s}) * wide_spread;
      wide_t_1 <= $signed({{7{axis_t[33]}}, axis_t}) * wide_spread;
    end

  // ---- input of the walking register
  logic walking;
  logic walk_takes;  // it accepts a fragment in this cycle
  logic arrives;     // a fragment for it
  logic [`LEVEL_TOKEN_BITS-1:0] arriving;
  logic signed [56:0] step_s, step_t, first_s, first_t;  // 46 fraction bits

  generate
    if (COUNT == `COUNT_ANY) begin : g_any
      // 2: multiplication by 1 / N from a ROM.
      logic [`RECIPROCAL_BITS-1:0] reciprocal;
      rom #(.BITS(`RECIPROCAL_BITS), .WORDS(17), .ADDRESS_BITS(5), .CONTENTS(`RECIPROCAL)) reciprocals (
        .clk, .read(enter_1), .address({1'b0, last_index} + 5'd1), .word(reciprocal));
      logic full_2;
      wire leave_2 = full_2 && walk_takes;
      assign leave_1 = full_1 && (!full_2 || leave_2);
      wire signed [56:0] factor = $signed({{(57 - `RECIPROCAL_BITS) {1'b0}}, reciprocal});
      always_ff @(posedge clk)
        if (!rst_n) full_2 <= 1'b0;
        else full_2 <= leave_1 || (full_2 && !leave_2);
      always_ff @(posedge clk)
        if (leave_1) begin
          arriving <= with_1;
          step_s <= $signed({{16{wide_s_1[40]}}, wide_s_1}) * factor;
          step_t <= $signed({{16{wide_t_1[40]}}, wide_t_1}) * factor;
        end
      // 3: offset of the first sample, (1 - N) times the step: a row for each bit of N - 1, each row the complement of
      // the step, and N - 1 for the carries.
      assign arrives = full_2;
      wire [3:0] less = arriving[`LEVEL_TOKEN_LAST_INDEX];
      always_comb begin
        first_s = {53'd0, less};
        first_t = {53'd0, less};
        for (integer i = 0; i < 4; i = i + 1) begin
          first_s = first_s + ({57{less[i]}} & (~step_s << i));
          first_t = first_t + ({57{less[i]}} & (~step_t << i));
        end
      end
    end else begin : g_power
      // 2: N is a power of two.
      assign leave_1 = full_1 && walk_takes;
      assign arrives = full_1;
      always_comb arriving = with_1;
      wire [3:0] last_1 = with_1[`LEVEL_TOKEN_LAST_INDEX];
      wire [2:0] lb_n = last_1[3] ? 3'd4 : last_1[2] ? 3'd3 : last_1[1] ? 3'd2 : last_1[0] ? 3'd1 : 3'd0;
      wire signed [56:0] whole_s = $signed({wide_s_1, 16'd0}), whole_t = $signed({wide_t_1, 16'd0});
      always_comb begin
        step_s = whole_s >>> lb_n;
        step_t = whole_t >>> lb_n;
        first_s = step_s - whole_s;
        first_t = step_t - whole_t;
      end
    end
  endgenerate

  // ---- the last stage: one request per cycle
  logic [`LEVEL_TOKEN_BITS-1:0] at;
  logic signed [56:0] offset_s, offset_t, stride_s, stride_t;
  logic [3:0] index;
  logic second;  // second of two levels
  wire [7:0] at_fraction = at[`LEVEL_TOKEN_FRACTION];
  wire [3:0] at_last = at[`LEVEL_TOKEN_LAST_INDEX];
  wire last_of_sample = second || at_fraction == 8'd0;
  wire last_of_fragment = last_of_sample && index == at_last;
  assign out_push = walking && out_ready;
  assign walk_takes = !walking || (out_push && last_of_fragment);
  wire takes = arrives && walk_takes;
  always_ff @(posedge clk)
    if (!rst_n) walking <= 1'b0;
    else walking <= takes || !walk_takes;
  always_ff @(posedge clk)
    if (takes) begin
      at <= arriving;
      offset_s <= first_s;
      offset_t <= first_t;
      stride_s <= step_s <<< 1;
      stride_t <= step_t <<< 1;
      index <= 4'd0;
      second <= 1'b0;
    end else if (out_push) begin
      second <= !last_of_sample;
      if (last_of_sample) begin
        index <= index + 4'd1;
        offset_s <= offset_s + stride_s;
        offset_t <= offset_t + stride_t;
      end
    end

  wire signed [56:0] rounded_s = offset_s + 57'sd4194304;  // 2^22: drops 23
  wire signed [56:0] rounded_t = offset_t + 57'sd4194304;
  wire signed [56:0] moved_s = rounded_s >>> 23, moved_t = rounded_t >>> 23;
  wire [31:0] at_s = at[`LEVEL_TOKEN_S], at_t = at[`LEVEL_TOKEN_T];
  assign out_data[`SAMPLE_TOKEN_TICKET] = at[`LEVEL_TOKEN_TICKET];
  assign out_data[`SAMPLE_TOKEN_S] = {{(POSITION_BITS - 32) {at_s[31]}}, at_s} + moved_s[POSITION_BITS-1:0];
  assign out_data[`SAMPLE_TOKEN_T] = {{(POSITION_BITS - 32) {at_t[31]}}, at_t} + moved_t[POSITION_BITS-1:0];
  assign out_data[`SAMPLE_TOKEN_LEVEL_WEIGHT] =
      second ? {1'b0, at_fraction} : 9'd256 - {1'b0, at_fraction};
  assign out_data[`SAMPLE_TOKEN_INDEX] = index;
`ifdef LEVEL_TOKEN_DIAGONAL
  // The bit above N - 1 selects a tent; the FilterPipeline addresses its weights with both.
  assign out_data[`SAMPLE_TOKEN_LAST_INDEX] = {at[`LEVEL_TOKEN_DIAGONAL] && at_last >= 4'd4, at_last};
`else
  assign out_data[`SAMPLE_TOKEN_LAST_INDEX] = at_last;
`endif
  assign out_data[`SAMPLE_TOKEN_LEVEL] = at[`LEVEL_TOKEN_LEVEL] + {3'd0, second};
  assign out_data[`SAMPLE_TOKEN_LINEAR] = at[`LEVEL_TOKEN_LINEAR];
  assign out_data[`SAMPLE_TOKEN_LAST_OF_SAMPLE] = last_of_sample;
  assign out_data[`SAMPLE_TOKEN_LAST_OF_FRAGMENT] = last_of_fragment;
endmodule
