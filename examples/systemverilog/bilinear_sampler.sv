// SPDX-License-Identifier: MIT
// A small device under test: samples a texture of 16 x 16 RGBA8 texels bilinearly at level 0, with
// repeat addressing, one fragment per cycle. Latency: three cycles. Formats and rounding:
// docs/reference/texture/formats.md. `bug` injects a fault; 0 is the correct device.
module bilinear_sampler (
    input  logic               clock,
    input  int unsigned        bug,
    // One texel per cycle while `load` is high.
    input  logic               load,
    input  logic        [ 7:0] load_at,    // 16 y + x
    input  logic        [31:0] load_rgba,  // R in bits 7..0
    // Coordinates of a fragment, S7.24.
    input  logic               valid,
    input  logic signed [31:0] s,
    input  logic signed [31:0] t,
    output logic               colour_valid,
    output logic        [31:0] colour
);
  logic [31:0] texels[256];
  always_ff @(posedge clock) if (load) texels[load_at] <= load_rgba;

  // ---- cycle 1: the texel to the left and above, and the weights of its neighbours 16 p - 1/2 in
  // S.8 texels, rounded; p is the fraction of the coordinate.
  function automatic logic [12:0] position(input logic [23:0] p);
    logic signed [29:0] texel;
    texel = $signed({2'b0, p, 4'b0}) - 30'sd8388608 + 30'sd32768;
    return texel[28:16];
  endfunction
  logic        valid_1;
  logic [12:0] u_1, v_1;
  always_ff @(posedge clock) begin
    valid_1 <= valid;
    u_1 <= position(s[23:0]);
    v_1 <= position(t[23:0]);
  end

  // ---- cycle 2: four texels, blended in each of the two rows, U8.12
  function automatic logic [3:0] next(input logic [3:0] i, input logic clamps);
    return clamps && i == 15 ? i : i + 1;
  endfunction
  function automatic logic [20:0] across(input logic [7:0] a, input logic [7:0] b,
                                         input logic [7:0] f);
    return {9'b0, a, 4'b0} * (21'd256 - {13'b0, f}) + {9'b0, b, 4'b0} * {13'b0, f};
  endfunction
  logic        valid_2;
  logic [ 7:0] f_2;
  logic [20:0] above_2[4], below_2[4];
  logic [ 3:0] x0, x1, y0, y1;
  logic [ 7:0] f_u;
  always_comb begin
    x0 = u_1[11:8];
    y0 = v_1[11:8];
    x1 = next(x0, bug == 1);  // clamps at the right border
    y1 = next(y0, 1'b0);
    f_u = bug == 2 ? {u_1[7:1], 1'b0} : u_1[7:0];  // one bit of the weight is lost
  end
  always_ff @(posedge clock) begin
    valid_2 <= valid_1;
    f_2 <= v_1[7:0];
    for (int c = 0; c < 4; ++c) begin
      above_2[c] <= across(texels[{y0, x0}][8*c+:8], texels[{y0, x1}][8*c+:8], f_u);
      below_2[c] <= across(texels[{y1, x0}][8*c+:8], texels[{y1, x1}][8*c+:8], f_u);
    end
  end

  // ---- cycle 3: both rows blended, U8.12 rounded, then rounded to a code
  function automatic logic [7:0] down(input logic [20:0] a, input logic [20:0] b,
                                      input logic [7:0] f, input logic rounds);
    logic [29:0] mixed;
    mixed = {9'b0, a} * (30'd256 - {22'b0, f}) + {9'b0, b} * {22'b0, f} + (rounds ? 30'd128 : 30'd0);
    return 8'((mixed[29:8] + 22'd2048) >> 12);
  endfunction
  always_ff @(posedge clock) begin
    colour_valid <= valid_2;
    for (int c = 0; c < 4; ++c)
      colour[8*c+:8] <= down(above_2[c], below_2[c], f_2, bug != 3);  // 3: the blend is not rounded
  end
endmodule
