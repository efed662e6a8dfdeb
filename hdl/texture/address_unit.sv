// SPDX-License-Identifier: MIT
// From quads to bilinear requests: the units of the figure in docs/reference/texture/index.md in series, with links of
// two entries between them.
`include "tokens.svh"
`include "tables.svh"
`include "descriptor.svh"
module address_unit #(
  parameter integer AXES = `CHOSEN_AXES,
  parameter integer FOOTPRINT = `CHOSEN_FOOTPRINT,
  parameter integer LOG2 = `CHOSEN_LOG2,
  parameter integer COUNT = `CHOSEN_COUNT,
  parameter integer CAP = `CHOSEN_CAP,
  parameter integer KERNEL = `CHOSEN_KERNEL,
  parameter integer SPREAD = `CHOSEN_SPREAD,
  parameter integer AXIS_CYCLES = `CHOSEN_AXIS_CYCLES
) (
  input  logic                         clk,
  input  logic                         rst_n,
  input  logic                         in_valid,
  output logic                         in_pop,
  input  logic [`QUAD_BITS-1:0]        in_data,
  output logic                         out_push,
  input  logic                         out_ready,
  output logic [`TEXEL_TOKEN_BITS-1:0] out_data,
  // Descriptor registers, one word at a time.
  input  logic                         write,
  input  logic [3:0]                   write_handle,
  input  logic [4:0]                   write_word,
  input  logic [31:0]                  write_data,
  output logic                         saturated,  // increments SATURATED
  // Activity of the links between the units in this cycle, the first link in bit 0, for a testbench.
  output logic [4:0]                   link_push,
  output logic [4:0]                   link_pop
);
  logic [3:0] handle_derivative, handle_level, handle_texel;
  logic valid_derivative;
  logic [`DESCRIPTOR_SIZE] size_derivative, size_level, size_texel;
  logic [`DESCRIPTOR_MODE] mode_level, mode_texel;
  logic [`DESCRIPTOR_LOD_BIAS] lod_bias_level;
  logic [`DESCRIPTOR_LOD_CLAMP] lod_clamp_level;
  logic [`DESCRIPTOR_BASE] bases_texel;
  descriptors store (
    .clk, .rst_n, .write, .write_handle, .write_word, .write_data, .handle_derivative, .valid_derivative,
    .size_derivative, .handle_level, .size_level, .mode_level, .lod_bias_level, .lod_clamp_level, .handle_texel,
    .size_texel, .mode_texel, .bases_texel);

  logic derivative_push, derivative_ready, derivative_valid, derivative_pop;
  logic [`DERIVATIVE_TOKEN_BITS-1:0] derivative_in, derivative_out;
  derivative_unit derivative (
    .clk, .rst_n, .in_valid, .in_pop, .in_data, .out_push(derivative_push), .out_ready(derivative_ready),
    .out_data(derivative_in), .saturated, .handle(handle_derivative), .known(valid_derivative),
    .size(size_derivative));
  link #(.BITS(`DERIVATIVE_TOKEN_BITS)) derivatives (
    .clk, .rst_n, .push(derivative_push), .push_data(derivative_in), .can_push(derivative_ready),
    .pop(derivative_pop), .front(derivative_out), .can_pop(derivative_valid));

  logic footprint_push, footprint_ready, footprint_valid, footprint_pop;
  logic [`FOOTPRINT_TOKEN_BITS-1:0] footprint_in, footprint_out;
  generate
    if (AXES == `AXES_TWO) begin : g_footprint
      footprint_unit #(.RULE(FOOTPRINT)) footprint (
        .clk, .rst_n, .in_valid(derivative_valid), .in_pop(derivative_pop), .in_data(derivative_out),
        .out_push(footprint_push), .out_ready(footprint_ready), .out_data(footprint_in));
    end else begin : g_axis
      axis_unit #(.AXES(AXES), .RULE(FOOTPRINT), .AXIS_CYCLES(AXIS_CYCLES)) axis (
        .clk, .rst_n, .in_valid(derivative_valid), .in_pop(derivative_pop), .in_data(derivative_out),
        .out_push(footprint_push), .out_ready(footprint_ready), .out_data(footprint_in));
    end
  endgenerate
  link #(.BITS(`FOOTPRINT_TOKEN_BITS)) footprints (
    .clk, .rst_n, .push(footprint_push), .push_data(footprint_in), .can_push(footprint_ready),
    .pop(footprint_pop), .front(footprint_out), .can_pop(footprint_valid));

  logic log_push, log_ready, log_valid, log_pop;
  logic [`LOG2_TOKEN_BITS-1:0] log_in, log_out;
  log2_unit #(.RULE(LOG2)) log2 (
    .clk, .rst_n, .in_valid(footprint_valid), .in_pop(footprint_pop), .in_data(footprint_out),
    .out_push(log_push), .out_ready(log_ready), .out_data(log_in));
  link #(.BITS(`LOG2_TOKEN_BITS)) logs (
    .clk, .rst_n, .push(log_push), .push_data(log_in), .can_push(log_ready),
    .pop(log_pop), .front(log_out), .can_pop(log_valid));

  logic level_push, level_ready, level_valid, level_pop;
  logic [`LEVEL_TOKEN_BITS-1:0] level_in, level_out;
  level_unit #(.AXES(AXES), .COUNT(COUNT), .CAP(CAP)) level_of_detail (
    .clk, .rst_n, .in_valid(log_valid), .in_pop(log_pop), .in_data(log_out),
    .out_push(level_push), .out_ready(level_ready), .out_data(level_in),
    .handle(handle_level), .size(size_level), .mode(mode_level), .lod_bias(lod_bias_level),
    .lod_clamp(lod_clamp_level));
  link #(.BITS(`LEVEL_TOKEN_BITS)) levels (
    .clk, .rst_n, .push(level_push), .push_data(level_in), .can_push(level_ready),
    .pop(level_pop), .front(level_out), .can_pop(level_valid));

  logic sample_push, sample_ready, sample_valid, sample_pop;
  logic [`SAMPLE_TOKEN_BITS-1:0] sample_in, sample_out;
  sample_walker #(.COUNT(COUNT), .KERNEL(KERNEL), .SPREAD(SPREAD)) walker (
    .clk, .rst_n, .in_valid(level_valid), .in_pop(level_pop), .in_data(level_out),
    .out_push(sample_push), .out_ready(sample_ready), .out_data(sample_in));
  link #(.BITS(`SAMPLE_TOKEN_BITS)) samples (
    .clk, .rst_n, .push(sample_push), .push_data(sample_in), .can_push(sample_ready),
    .pop(sample_pop), .front(sample_out), .can_pop(sample_valid));

  assign link_push = {sample_push, level_push, log_push, footprint_push, derivative_push};
  assign link_pop = {sample_pop, level_pop, log_pop, footprint_pop, derivative_pop};

  texel_addresser addresser (
    .clk, .rst_n, .in_valid(sample_valid), .in_pop(sample_pop), .in_data(sample_out),
    .out_push, .out_ready, .out_data, .handle(handle_texel), .size(size_texel), .mode(mode_texel),
    .bases(bases_texel));
endmodule
