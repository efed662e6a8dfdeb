// SPDX-License-Identifier: MIT
// Function  The LineWalker with four walkers: steps along a line, one group of columns per cycle. A group is the
//           longest run of the next columns whose pixels are in one block of 4 x 4. The end token passes as a group
//           without columns.
// Latency   1 with its link.
// Interval  One group per cycle, also across the ends of lines.
// Stalls    out_ready.
// Source    docs/reference/datasheets.md, "LineWalker"; docs/reference/geometric/hardware.md, "Several walkers".
module line_walker (
  input  logic               clk,
  input  logic               rst_n,
  input  logic               in_valid,
  output logic               in_pop,
  input  logic signed [39:0] in_position,   // S15.24 at the first column
  input  logic signed [25:0] in_slope,      // S1.24
  input  logic signed [37:0] in_depth,      // S25.12 at the first column
  input  logic signed [37:0] in_step,
  input  logic        [12:0] in_column,
  input  logic        [13:0] in_count,      // columns, at least 1 unless it is the end token
  input  logic        [2:0]  in_line,       // horizontal, m1 > m0, crease
  input  logic               in_end,
  input  logic               out_ready,
  output logic               out_push,
  output logic        [31:0] out_position_0, out_position_1, out_position_2, out_position_3,  // P, S15.16
  output logic signed [25:0] out_slope,
  output logic signed [37:0] out_depth,
  output logic signed [37:0] out_step,
  output logic        [12:0] out_column,
  output logic        [2:0]  out_count,
  output logic        [2:0]  out_line,
  output logic               out_end
);
  // The rest of the line that is being walked.
  logic walking;
  logic signed [39:0] held_position;
  logic signed [25:0] held_slope;
  logic signed [37:0] held_depth, held_step;
  logic [12:0] held_column;
  logic [13:0] held_left;
  logic [2:0] held_line;

  wire signed [39:0] position = walking ? held_position : in_position;
  wire signed [25:0] slope = walking ? held_slope : in_slope;
  wire signed [37:0] depth = walking ? held_depth : in_depth;
  wire signed [37:0] step = walking ? held_step : in_step;
  wire [12:0] column = walking ? held_column : in_column;
  wire [13:0] left = walking ? held_left : in_count;
  wire [2:0] line = walking ? held_line : in_line;
  wire last = !walking && in_end;

  // Position and depth of the next four columns.
  wire signed [39:0] slope_1 = {{14{slope[25]}}, slope};
  wire signed [27:0] slope_3 = {{2{slope[25]}}, slope} + {slope[25], slope, 1'b0};
  wire signed [37:0] step_3 = step + {step[36:0], 1'b0};
  wire signed [39:0] position_1 = position + slope_1;
  wire signed [39:0] position_2 = position + {slope_1[38:0], 1'b0};
  wire signed [39:0] position_3 = position + {{12{slope_3[27]}}, slope_3};
  wire signed [39:0] position_4 = position + {slope_1[37:0], 2'b0};
  wire signed [37:0] depth_1 = depth + step;
  wire signed [37:0] depth_2 = depth + {step[36:0], 1'b0};
  wire signed [37:0] depth_3 = depth + step_3;
  wire signed [37:0] depth_4 = depth + {step[35:0], 2'b0};

  // A column joins the group if those before it do, it is in their block, and the line has it. Rows are monotone.
  wire [13:0] row_block = position[39:26];
  wire join_1 = column[1:0] != 2'd3 && position_1[39:26] == row_block && left > 14'd1;
  wire join_2 = join_1 && column[1:0] < 2'd2 && position_2[39:26] == row_block && left > 14'd2;
  wire join_3 = join_2 && column[1:0] == 2'd0 && position_3[39:26] == row_block && left > 14'd3;
  wire [2:0] count = join_3 ? 3'd4 : join_2 ? 3'd3 : join_1 ? 3'd2 : 3'd1;
  wire [13:0] rest = left - {11'd0, count};

  assign out_push = out_ready && (walking || in_valid);
  assign in_pop = out_ready && !walking && in_valid;
  always_ff @(posedge clk)
    if (!rst_n) walking <= 1'b0;
    else if (out_push) walking <= !last && rest != 14'd0;
  always_ff @(posedge clk)
    if (out_push) begin
      held_position <= join_3 ? position_4 : join_2 ? position_3 : join_1 ? position_2 : position_1;
      held_depth <= join_3 ? depth_4 : join_2 ? depth_3 : join_1 ? depth_2 : depth_1;
      held_column <= column + {10'd0, count};
      held_left <= rest;
      held_slope <= slope;
      held_step <= step;
      held_line <= line;
    end

  assign out_position_0 = position[39:8];
  assign out_position_1 = position_1[39:8];
  assign out_position_2 = position_2[39:8];
  assign out_position_3 = position_3[39:8];
  assign out_slope = slope;
  assign out_depth = depth;
  assign out_step = step;
  assign out_column = column;
  assign out_count = last ? 3'd0 : count;
  assign out_line = line;
  assign out_end = last;
endmodule
