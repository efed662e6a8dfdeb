// SPDX-License-Identifier: MIT
// Each column of random lines: position by multiplication, and groups that are as long as their block of 4 x 4 allows,
// with stalls and gaps.
`timescale 1ns/1ns
module line_walker_test;
  logic clk = 0, rst_n = 0, in_valid = 0, in_pop, in_end = 0, out_ready = 0, out_push, out_end;
  logic signed [39:0] in_position = 0;
  logic signed [25:0] in_slope = 0, out_slope;
  logic signed [37:0] in_depth = 0, in_step = 0, out_depth, out_step;
  logic [12:0] in_column = 0, out_column;
  logic [13:0] in_count = 0;
  logic [2:0] in_line = 0, out_line, out_count;
  logic [31:0] out_position_0, out_position_1, out_position_2, out_position_3;
  line_walker walker (.*);
  wire [31:0] out_position[0:3];
  assign out_position[0] = out_position_0;
  assign out_position[1] = out_position_1;
  assign out_position[2] = out_position_2;
  assign out_position[3] = out_position_3;

  integer cycle, i, lines = 0, ends = 0, groups[1:4], done = 0, longest, walked;
  logic there = 0;
  longint position, depth;
  longint first_position, slope, first_depth, step;
  integer first, count;
  logic is_end;
  logic [2:0] line;

  function longint at(input integer column);
    at = first_position + slope * column;
  endfunction
  function integer block(input integer column);
    block = (first + column) / 4 * 65536 + ((at(column) >>> 26) & 16'hFFFF);
  endfunction

  initial begin
    for (i = 1; i <= 4; i = i + 1) groups[i] = 0;
    for (cycle = 0; cycle < 100000; cycle = cycle + 1) begin
      rst_n = cycle > 2;
      if (!in_valid && rst_n && $random % 4 != 0) begin
        in_valid = 1;
        in_end = $unsigned($random) % 16 == 0;
        in_line = $random;
        in_column = $random;
        in_count = 1 + $unsigned($random) % ($random % 4 == 0 ? 40 : 6);
        in_slope = $random % 3 == 0 ? $random % 1024 : $random % 3 == 0 ? (1 << 24) * (1 - 2 * ($unsigned($random) % 2))
                   : $random % ((1 << 24) + 1);
        // Rows on both sides of the frame's border, so that they stay in S15.
        in_position = (40'sd1 << 30) * ($random % 64) + $random;
        in_depth = {$random, $random} & 38'h7FFFFFFFF;
        in_step = $random;
      end
      out_ready = rst_n && $random % 4 != 0;
      #1;
      if (out_push !== (out_ready && (there || in_valid))) $fatal(1, "push is %b", out_push);
      if (in_pop !== (out_ready && in_valid && !there)) $fatal(1, "pop is %b", in_pop);
      if (in_pop) begin
        first_position = in_position;
        slope = in_slope;
        first_depth = in_depth;
        step = in_step;
        first = in_column;
        count = in_count;
        line = in_line;
        is_end = in_end;
        done = 0;
      end
      if (out_push && is_end) begin
        if (!out_end || out_count != 0) $fatal(1, "no end");
        ends = ends + 1;
      end else if (out_push) begin
        longest = 1;
        while (longest < 4 && done + longest < count && block(done + longest) == block(done)) longest = longest + 1;
        depth = first_depth + step * done;
        if (out_end || out_count != longest || out_column != ((first + done) & 13'h1FFF) || out_line != line ||
            out_slope != slope || out_step != step || out_depth !== depth[37:0])
          $fatal(1, "column %0d: %0d columns, not %0d", first + done, out_count, longest);
        for (i = 0; i < longest; i = i + 1) begin
          position = at(done + i);
          if (out_position[i] !== position[39:8])
            $fatal(1, "column %0d + %0d: %h, not %h", first + done, i, out_position[i], position[39:8]);
        end
        done = done + longest;
        groups[longest] = groups[longest] + 1;
        lines = lines + (done == count);
      end
      there = out_push ? !is_end && done != count : there;
      #1 clk = 1;
      #1 clk = 0;
      if (popped_now) in_valid = 0;
    end
    if (lines < 5000 || ends < 500 || groups[1] < 1000 || groups[2] < 1000 || groups[3] < 1000 || groups[4] < 1000)
      $fatal(1, "%0d lines, %0d ends, groups %0d %0d %0d %0d", lines, ends, groups[1], groups[2], groups[3], groups[4]);
    $display("%0d lines, groups of 1 to 4 columns: %0d %0d %0d %0d", lines, groups[1], groups[2], groups[3], groups[4]);
    $finish;
  end
  // The pop of the cycle that ends with this edge.
  logic popped_now = 0;
  always @(posedge clk) popped_now = in_pop;
endmodule
