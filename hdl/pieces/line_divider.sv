// SPDX-License-Identifier: MIT
// Function  The divider of a LineUnit: dividend // divisor by long division, most significant bit first. With dividend
//           2 a 2^24 + b and divisor 2 b the quotient is rdiv(a 2^24, b). The dividend is below divisor * 2^24.
// Latency   STAGES cycles, at most two of 24 quotient bits each.
// Interval  1.
// Stalls    All stages advance with `move`.
// Source    docs/reference/datasheets.md, "LineUnit", stages from 3.
module line_divider #(
  parameter integer STAGES = 22  // 12 to 24
) (
  input  logic        clk,
  input  logic        rst_n,
  input  logic        move,
  input  logic        in_valid,
  input  logic [35:0] dividend,
  input  logic [27:0] divisor,
  output logic        out_valid,
  output logic [23:0] quotient
);
  localparam integer TWICE = 24 - STAGES;  // the first stages, which find two bits

  // After stage i: the remainder, below the divisor; the divisor; the bits of the dividend to come, left-aligned, with
  // the known bits of the quotient behind them.
  logic [27:0] rests[1:STAGES];
  logic [27:0] divisors[1:STAGES];
  logic [23:0] digits[1:STAGES];
  logic [STAGES:1] valid;
  assign out_valid = valid[STAGES];
  assign quotient = digits[STAGES];
  always_ff @(posedge clk)
    if (!rst_n) valid <= {STAGES{1'b0}};
    else if (move) valid <= {valid[STAGES-1:1], in_valid};

  genvar i;
  generate
    for (i = 0; i < STAGES; i = i + 1) begin : g_stage
      wire [27:0] rest = i == 0 ? {16'd0, dividend[35:24]} : rests[i > 0 ? i : 1];
      wire [27:0] by = i == 0 ? divisor : divisors[i > 0 ? i : 1];
      wire [23:0] to_come = i == 0 ? dividend[23:0] : digits[i > 0 ? i : 1];
      wire [27:0] rest_1;
      wire        bit_1;
      divider_step first (.rest, .digit(to_come[23]), .by, .next_rest(rest_1), .found(bit_1));
      if (i < TWICE) begin : g_two
        wire [27:0] rest_2;
        wire        bit_2;
        divider_step second (.rest(rest_1), .digit(to_come[22]), .by, .next_rest(rest_2), .found(bit_2));
        always_ff @(posedge clk)
          if (move) begin
            rests[i+1] <= rest_2;
            digits[i+1] <= {to_come[21:0], bit_1, bit_2};
          end
      end else begin : g_one
        always_ff @(posedge clk)
          if (move) begin
            rests[i+1] <= rest_1;
            digits[i+1] <= {to_come[22:0], bit_1};
          end
      end
      always_ff @(posedge clk)
        if (move) divisors[i+1] <= by;
    end
  endgenerate
  // The last remainder is not needed: the half for rounding is in the dividend.
  wire unused = &{1'b0, rests[STAGES], divisors[STAGES]};
endmodule
