// SPDX-License-Identifier: MIT
// A trial against the rule, edge by edge: every L, L' and XR_k with a step of every length, and random edges.
`timescale 1ns/1ns
module predictor_trial_test;
  logic clk = 0, rst_n = 0, in_valid = 0, down, known, out_valid, hit, beyond;
  logic [12:0] column;
  logic [4:0] k;
  logic [5:0] position, length, other, step, next_position;
  logic [6:0] origin;
  logic [3:0] start_code, end_code;
  logic signed [13:0] address;
  logic [66:0] run, first, second, run_next, first_next, second_next;
  predictor_trial trial (.*);

  integer cycle = 0, at, i, tried = 0, checked = 0, none = 0, firsts = 0, seconds = 0, thirds = 0;
  integer want_step[0:7], want_next[0:7];
  logic want_hit[0:7], want_beyond[0:7];

  function logic bit_of(input logic [66:0] word, input integer row);
    bit_of = row >= 0 && row < 67 ? word[row] : 1'b0;
  endfunction
  function [3:0] code(input integer row);
    code = {bit_of(second_next, row), bit_of(first_next, row), bit_of(run_next, row), bit_of(run_next, row - 1)};
  endfunction
  function logic hits(input integer s);
    hits = s >= 1 && position + s <= 32 && code(origin + s) == end_code && code(origin) == start_code;
    for (int row = 0; row < s; row = row + 1) if (!bit_of(run_next, origin + row)) hits = 0;
  endfunction

  // One cycle: the words of the trial of the previous cycle, and a trial with `*_next`.
  task tick;
    integer a, b, c, m, slot, far;
    begin
      slot = cycle % 8;
      a = length;
      b = known ? other : length - 1;
      c = known ? 0 : length + 1;
      want_step[slot] = hits(a) ? a : hits(b) ? b : c;
      want_hit[slot] = want_step[slot] != c || (c != 0 && hits(c));
      m = known ? (other > length ? other : length) : length + 1;
      want_beyond[slot] = position + m > 32;
      want_next[slot] = position + want_step[slot];
      #1;
      far = down ? column + k + 1 : column - k - 1;
      if (address !== far[13:0]) $fatal(1, "address %0d", address);
      slot = (cycle + 4) % 8;
      if (out_valid !== (cycle >= 4)) $fatal(1, "valid is %b in cycle %0d", out_valid, cycle);
      if (out_valid) begin
        if (hit !== want_hit[slot] || beyond !== want_beyond[slot] ||
            (hit && (step != want_step[slot] || next_position != want_next[slot])))
          $fatal(1, "hit %b, %0d; not %b, %0d", hit, step, want_hit[slot], want_step[slot]);
        checked = checked + 1;
        none = none + !hit;
      end
      slot = cycle % 8;
      firsts = firsts + (want_hit[slot] && want_step[slot] == a);
      seconds = seconds + (want_hit[slot] && want_step[slot] == b && b != a);
      thirds = thirds + (want_hit[slot] && want_step[slot] == c);
      #1 clk = 1;
      #1 clk = 0;
      run = run_next;
      first = first_next;
      second = second_next;
      cycle = cycle + 1;
    end
  endtask

  // Codes of a clean Z, and the words of a staircase with a step of s rows from the origin on.
  task staircase(input integer s, input logic side);
    begin
      // The run ends with a crossing on one side, and starts with one on the other.
      start_code = side ? 4'b0110 : 4'b1010;
      end_code = side ? 4'b1001 : 4'b0101;
      run_next = ((67'd1 << s) - 67'd1) << origin;
      first_next = side ? 67'd1 << origin : 67'd1 << (origin + s);
      second_next = side ? 67'd1 << (origin + s) : 67'd1 << origin;
    end
  endtask

  integer l, o, s, x, gap;
  initial begin
    {column, k, position, length, other, known, down, origin, start_code, end_code} = 0;
    {run, first, second, run_next, first_next, second_next} = 0;
    #1 clk = 1;
    #1 clk = 0;
    rst_n = 1;
    in_valid = 1;
    // L' = 0 is unknown. `gap` takes an edge of the step away, or leaves it whole.
    for (l = 1; l <= 20; l = l + 1)
      for (o = 0; o <= 2; o = o + 1)
        for (x = l; x <= 32; x = x + 1)
          for (s = 1; s <= 17; s = s + 1) begin
            {length, position, known} = {l[5:0], x[5:0], o != 0 && (o != 1 || l > 1)};
            other = o == 1 ? l - 1 : l + 1;
            origin = x + 33;
            {column, k, down} = $random;
            staircase(s, $random);
            gap = $unsigned($random) % (4 * s);
            if (gap < s) run_next[origin + gap] = 0;
            tick;
          end
    // Random edges, so dense that steps are frequent, at any row of the window.
    for (i = 0; i < 30000; i = i + 1) begin
      l = 1 + $unsigned($random) % 12;
      length = l;
      position = l + $unsigned($random) % (33 - l);
      known = $random;
      other = l == 1 || $random % 2 == 0 ? l + 1 : l - 1;
      origin = $unsigned($random) % 67;
      {column, k, down} = $random;
      staircase($unsigned($random) % 3 + (l > 1 ? l - 1 : 1), $random);
      run_next = run_next ^ (67'd1 << ($unsigned($random) % 128));
      first_next = first_next ^ (67'd1 << ($unsigned($random) % 128));
      second_next = second_next | (67'd1 << ($unsigned($random) % 128));
      // Codes that no clean Z has: with these, more than one candidate may hit.
      if ($random % 2 == 0) begin
        {first_next, second_next} = 134'd0;
        start_code = code(origin);
        end_code = code(origin + $unsigned($random) % (l + 2));
      end
      tick;
    end
    if (firsts < 1000 || seconds < 1000 || thirds < 1000 || none < 1000)
      $fatal(1, "hits %0d %0d %0d, none %0d", firsts, seconds, thirds, none);
    $display("%0d trials: %0d, %0d, %0d hits of the candidates, %0d without", checked, firsts, seconds, thirds, none);
    $finish;
  end
endmodule
