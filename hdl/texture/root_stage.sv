// SPDX-License-Identifier: MIT
// Two bits of an integer square root, most significant first, by two subtractions in series. `root` holds the known
// bits, right-aligned; `rest` the remainder for the digits of the radicand used so far; `digits` the remaining digits,
// left-aligned. A root of 32 bits takes 16 stages.
module root_stage (
  input  logic [31:0] root,
  input  logic [33:0] rest,
  input  logic [63:0] digits,
  output logic [31:0] next_root,
  output logic [33:0] next_rest,
  output logic [63:0] next_digits
);
  wire [35:0] with_1 = {rest, digits[63:62]};
  wire [35:0] try_1 = {2'b0, root, 2'b01};
  wire bit_1 = with_1 >= try_1;
  wire [35:0] rest_1 = bit_1 ? with_1 - try_1 : with_1;
  wire [35:0] with_2 = {rest_1[33:0], digits[61:60]};
  wire [35:0] try_2 = {1'b0, root, bit_1, 2'b01};
  wire bit_2 = with_2 >= try_2;
  wire [35:0] rest_2 = bit_2 ? with_2 - try_2 : with_2;
  assign next_root = {root[29:0], bit_1, bit_2};
  assign next_rest = rest_2[33:0];
  assign next_digits = {digits[59:0], 4'd0};
  // A remainder is at most twice the root, so its upper bits are zero.
  wire unused = &{1'b0, rest_1[35:34], rest_2[35:34]};
endmodule
