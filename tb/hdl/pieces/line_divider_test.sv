// SPDX-License-Identifier: MIT
// quotient * divisor + rest = dividend with a rest below the divisor, for random and extreme operands, with stalls and
// gaps; the latency without stalls.
`timescale 1ns/1ns
module line_divider_test;
  logic clk = 0, rst_n = 0, move = 0, in_valid = 0, out_valid;
  logic [35:0] dividend, sent[0:65535];
  logic [27:0] divisor, by[0:65535];
  logic [23:0] quotient;
  line_divider divider (.*);
  integer pushed = 0, popped = 0, cycle, latency = -1, kind;
  logic [63:0] largest, product;
  initial begin
    for (cycle = 0; cycle < 60000; cycle = cycle + 1) begin
      rst_n = cycle > 2;
      move = rst_n && (cycle < 100 || $random % 4 != 0);
      in_valid = rst_n && (cycle == 3 || (cycle > 100 && $random % 4 != 0));
      kind = $unsigned($random) % 4;
      divisor = kind == 0 ? 28'hFFFFFFF - {27'd0, cycle[0]} : 28'd1 + ({$random} >> (4 + {$random} % 28));
      if (divisor == 0) divisor = 1;
      // Quotients of all sizes, up to the largest.
      largest = ({36'd0, divisor} << 24) - 1;
      if (largest > 64'hFFFFFFFFF) largest = 64'hFFFFFFFFF;
      dividend = kind == 1 ? largest : {$random, $random} % ((largest >> ($unsigned($random) % 24)) + 1);
      if (in_valid && move) begin
        sent[pushed % 65536] = dividend;
        by[pushed % 65536] = divisor;
        pushed = pushed + 1;
      end
      #1;
      if (out_valid && move) begin
        if (latency < 0) latency = cycle - 3;
        product = {40'd0, quotient} * {36'd0, by[popped % 65536]};
        if (product > sent[popped % 65536] || sent[popped % 65536] - product >= by[popped % 65536])
          $fatal(1, "%0d / %0d is not %0d", sent[popped % 65536], by[popped % 65536], quotient);
        popped = popped + 1;
      end
      #1 clk = 1;
      #1 clk = 0;
    end
    if (latency != 22) $fatal(1, "latency %0d", latency);
    if (popped < 30000 || pushed - popped > 22) $fatal(1, "%0d of %0d quotients", popped, pushed);
    $display("%0d quotients", popped);
    $finish;
  end
endmodule
