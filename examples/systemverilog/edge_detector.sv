// SPDX-License-Identifier: MIT
// A small device under test: the first block of a morphological engine, colour edges. It takes one
// pixel per cycle, row by row, and outputs its edges one cycle later. `bug` injects a fault; 0 is
// the correct device.
module edge_detector #(
    parameter int WIDTH = 64
) (
    input  logic        clock,
    input  int unsigned bug,
    input  logic [ 7:0] least,  // in codes; an equal or larger step of R, G or B is an edge
    input  logic        valid,
    input  logic        first,  // first pixel of the frame
    input  logic [31:0] rgba,   // R in bits 7..0
    output logic        edges_valid,
    output logic [ 1:0] edges   // bit 0: to the left neighbour, bit 1: to the upper one
);
  logic [31:0] row[WIDTH];
  logic [31:0] left;
  int unsigned x, y;

  function automatic logic is_edge(input logic [31:0] a, input logic [31:0] b);
    logic [7:0] p, q, d, step;
    step = 0;
    for (int c = 0; c < 3; c = c + 1) begin
      p = a[8*c+:8];
      q = b[8*c+:8];
      d = p > q ? p - q : q - p;
      // 5: compares only two channels
      if (d > step && !(bug == 5 && c == 2)) step = d;
    end
    return bug == 4 ? step > least : step >= least;  // 4: a step equal to the threshold is no edge
  endfunction

  int unsigned at, line;  // of this pixel
  assign at = first ? 0 : x;
  assign line = first ? 0 : y;
  // 6: reads the row above one pixel too far
  logic [31:0] above;
  assign above = row[bug == 6 ? (at + 1) % WIDTH : at];

  always_ff @(posedge clock) begin
    edges_valid <= valid;
    if (valid) begin
      edges[0] <= at != 0 && is_edge(rgba, left);
      edges[1] <= line != 0 && is_edge(rgba, above);
      left <= rgba;
      row[at] <= rgba;
      x <= at == WIDTH - 1 ? 0 : at + 1;
      y <= at == WIDTH - 1 ? line + 1 : line;
    end
  end
endmodule
