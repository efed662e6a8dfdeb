// SPDX-License-Identifier: MIT
// The unit with the descriptors that it reads, for a bench of its own.
`include "tokens.svh"
`include "descriptor.svh"
module derivative_unit_top (
  input  logic                clk,
  input  logic                rst_n,
  input  logic                in_valid,
  output logic                in_pop,
  input  logic [`QUAD_BITS-1:0] in_data,
  output logic                out_push,
  input  logic                out_ready,
  output logic [`DERIVATIVE_TOKEN_BITS-1:0] out_data,
  output logic                saturated,
  input  logic                write,
  input  logic [3:0]          write_handle,
  input  logic [4:0]          write_word,
  input  logic [31:0]         write_data
);
  logic [3:0] handle;
  logic [`DESCRIPTOR_BITS-1:0] descriptor, descriptor_1, descriptor_2;
  wire unused = &{1'b0, descriptor_1, descriptor_2};
  descriptors store (.clk, .rst_n, .write, .write_handle, .write_word, .write_data, .handle_0(handle),
                     .handle_1(4'd0), .handle_2(4'd0), .descriptor_0(descriptor), .descriptor_1,
                     .descriptor_2);
  derivative_unit unit (.clk, .rst_n, .in_valid, .in_pop, .in_data, .out_push, .out_ready, .out_data, .saturated, .handle,
               .descriptor);
endmodule
