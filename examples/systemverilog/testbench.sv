// SPDX-License-Identifier: MIT
// A self-checking testbench: two small devices under test against Deburr's golden models by DPI-C.
//
//   +quads=N   quads for the sampler; each is one call of the golden model (1000000)
//   +frames=N  frames for the edge detector (20)
//   +bug=N     injects a fault: 1 to 3 in the sampler, 4 to 6 in the edge detector (0: none)
//   +rejected  shows the message of the golden model for an invalid call
//
// Prints what was compared and PASS, or the first difference and FAIL; FAIL exits with an error.
module testbench;
  import deburr_golden_pkg::*;

  localparam int SIDE = 16;
  localparam int WIDTH = 64, HEIGHT = 48;
  localparam int LATENCY = 3;  // latency of the sampler in cycles

  logic clock = 0;
  always #1 clock = !clock;
  int unsigned bug = 0, quads = 1_000_000, frames = 20;

  // The same random numbers in every simulator.
  int unsigned state = 1;
  function automatic int unsigned random();
    state = state * 1664525 + 1013904223;
    return state;
  endfunction
  function automatic int unsigned below(int unsigned bound);
    return int'((longint'(random()) * longint'(bound)) >> 32);
  endfunction

  // Ends the run when a call of the golden model has failed.
  task automatic check(chandle golden, int status);
    string text;
    if (status != DEBURR_OK) begin
      void'(deburr_error(golden, status, text));
      $fatal(1, "the golden model rejected: %s", text);
    end
  endtask

  // ---- a texture unit's filter ------------------------------------------------------------------

  logic load = 0;
  logic [7:0] load_at = 0;
  logic [31:0] load_rgba = 0;
  logic valid = 0;
  logic signed [31:0] s[4], t[4];
  logic colour_valid[4];
  logic [31:0] colour[4];
  for (genvar lane = 0; lane < 4; ++lane) begin : lanes
    bilinear_sampler sampler (
        .clock,
        .bug,
        .load,
        .load_at,
        .load_rgba,
        .valid,
        .s(s[lane]),
        .t(t[lane]),
        .colour_valid(colour_valid[lane]),
        .colour(colour[lane])
    );
  end

  task automatic test_sampler();
    chandle golden = deburr_texture_new();
    byte unsigned texels[SIDE*SIDE*4], rgba[16];
    byte unsigned expected[LATENCY+1][16];
    int quad_s[4], quad_t[4];
    int waiting[LATENCY+1][8];
    longint unsigned behind, fragments, checksum;
    if (golden == null) $fatal(1, "no memory for a golden model");
    check(golden, deburr_texture_field(golden, 0, "width", "16"));
    check(golden, deburr_texture_field(golden, 0, "height", "16"));
    check(golden, deburr_texture_field(golden, 0, "levels", "1"));
    check(golden, deburr_texture_field(golden, 0, "format", "rgba8"));
    check(golden, deburr_texture_field(golden, 0, "layout", "tiled"));
    check(golden, deburr_texture_field(golden, 0, "wrap_s", "repeat"));
    check(golden, deburr_texture_field(golden, 0, "wrap_t", "repeat"));
    check(golden, deburr_texture_field(golden, 0, "min_filter", "linear"));
    check(golden, deburr_texture_field(golden, 0, "mag_filter", "linear"));
    check(golden, deburr_texture_place(golden, 0, 0, behind));
    check(golden, deburr_texture_memory(golden, behind));
    for (int i = 0; i < SIDE * SIDE * 4; ++i) texels[i] = 8'(random() >> 24);
    check(golden, deburr_texture_level(golden, 0, 0, texels, 0));
    for (int i = 0; i < SIDE * SIDE; ++i) begin
      load = 1;
      load_at = 8'(i);
      load_rgba = {texels[4*i+3], texels[4*i+2], texels[4*i+1], texels[4*i]};
      @(negedge clock);
    end
    load = 0;

    checksum = 64'd14695981039346656037;
    for (int unsigned quad = 0; quad < quads + LATENCY; ++quad) begin
      // Predicts, as the monitor of a quad does.
      for (int stage = LATENCY; stage > 0; --stage) begin
        expected[stage] = expected[stage-1];
        waiting[stage] = waiting[stage-1];
      end
      valid = quad < quads;
      if (valid) begin
        for (int lane = 0; lane < 4; ++lane) begin
          quad_s[lane] = int'(random());
          quad_t[lane] = int'(random());
          s[lane] = quad_s[lane];
          t[lane] = quad_t[lane];
          waiting[0][2*lane] = quad_s[lane];
          waiting[0][2*lane+1] = quad_t[lane];
        end
        check(golden, deburr_texture_quad(golden, 0, 15, 0, quad_s, quad_t, rgba));
        expected[0] = rgba;
        for (int i = 0; i < 16; ++i)
          checksum = (checksum ^ longint'(rgba[i])) * 64'd1099511628211;
      end
      @(negedge clock);
      // Compares the output with the prediction made LATENCY cycles ago.
      if (quad + 1 >= LATENCY && quad + 1 < quads + LATENCY) begin
        for (int lane = 0; lane < 4; ++lane) begin
          automatic byte unsigned e[16] = expected[LATENCY-1];
          automatic logic [31:0] word = {e[4*lane+3], e[4*lane+2], e[4*lane+1], e[4*lane]};
          if (!colour_valid[lane] || colour[lane] != word)
            $fatal(1, "FAIL quad %0d, lane %0d, s %0d, t %0d: colour %h, expected %h",
                   quad + 1 - LATENCY, lane, waiting[LATENCY-1][2*lane],
                   waiting[LATENCY-1][2*lane+1], colour[lane], word);
        end
      end
    end
    check(golden, deburr_counter(golden, "fragments", fragments));
    if (fragments != 4 * longint'(quads)) $fatal(1, "FAIL the golden model has %0d fragments", fragments);
    $display("sampler: %0d quads, %0d colours, 0 differ, checksum %h", quads, fragments, checksum);
    check(golden, deburr_close(golden));
  endtask

  // ---- a morphological engine's edges -----------------------------------------------------------

  logic pixel_valid = 0, pixel_first = 0, edges_valid;
  logic [31:0] pixel = 0;
  logic [7:0] least = 0;
  logic [1:0] edges;
  edge_detector #(
      .WIDTH(WIDTH)
  ) detector (
      .clock,
      .bug,
      .least,
      .valid(pixel_valid),
      .first(pixel_first),
      .rgba(pixel),
      .edges_valid,
      .edges
  );

  task automatic test_detector();
    chandle golden = deburr_morphological_new();
    int unsigned picture[WIDTH*HEIGHT];
    logic [1:0] found[WIDTH*HEIGHT];
    byte unsigned expected[WIDTH*HEIGHT];
    longint unsigned count = 0, in_frame;
    if (golden == null) $fatal(1, "no memory for a golden model");
    check(golden, deburr_set(golden, "edges.source", "colour"));
    check(golden, deburr_set(golden, "edges.local_contrast", "off"));
    for (int unsigned frame = 0; frame < frames; ++frame) begin
      // Rectangles of similar colours, so that many steps are at the threshold.
      automatic int unsigned codes = 8 + below(24), threshold = codes * 65536;
      check(golden, deburr_set(golden, "edges.threshold", $sformatf("%0d", threshold)));
      least = 8'(codes);
      foreach (picture[i]) picture[i] = 32'hFF808080;
      for (int shape = 0; shape < 60; ++shape) begin
        automatic int unsigned x0 = below(WIDTH), y0 = below(HEIGHT), w = 1 + below(20), h = 1 + below(20);
        automatic int unsigned value = 32'hFF606060 + below(64) + (below(64) << 8) + (below(64) << 16);
        for (int unsigned y = y0; y < y0 + h && y < HEIGHT; ++y)
          for (int unsigned x = x0; x < x0 + w && x < WIDTH; ++x) picture[WIDTH*y+x] = value;
      end
      // The golden model gets the pixels as the monitor of a stream sees them.
      check(golden, deburr_frame_begin(golden, WIDTH, HEIGHT));
      for (int unsigned i = 0; i < WIDTH * HEIGHT; ++i) begin
        pixel_valid = 1;
        pixel_first = i == 0;
        pixel = picture[i];
        check(golden, deburr_frame_put(golden, i % WIDTH, i / WIDTH, pixel, 0));
        @(negedge clock);
        if (!edges_valid) $fatal(1, "FAIL frame %0d: no edges of pixel %0d", frame, i);
        found[i] = edges;
      end
      pixel_valid = 0;
      check(golden, deburr_frame_process(golden));
      check(golden, deburr_plane(golden, "edges", expected, 0));
      for (int unsigned i = 0; i < WIDTH * HEIGHT; ++i)
        if (found[i] != expected[i][1:0])
          $fatal(1, "FAIL frame %0d, pixel (%0d, %0d): edges %b, expected %b", frame, i % WIDTH,
                 i / WIDTH, found[i], expected[i][1:0]);
      check(golden, deburr_counter(golden, "edge_pixels", in_frame));
      count += in_frame;
    end
    if (count < 100 * longint'(frames)) $fatal(1, "FAIL %0d pixels with edges are too few", count);
    $display("edge detector: %0d frames, %0d pixels with edges, 0 differ", frames, count);
    check(golden, deburr_close(golden));
  endtask

  // ---- an invalid call -------------------------------------------------------------------------

  task automatic show_rejections();
    chandle golden = deburr_geometric_new();
    string text, name;
    int status;
    byte unsigned few[8];
    int unsigned count;
    status = deburr_set(golden, "depth_bias", "99");
    void'(deburr_error(golden, status, text));
    $display("status %0d: %s", status, text);
    check(golden, deburr_frame_begin(golden, 4, 4));
    foreach (few[i]) few[i] = 0;
    status = deburr_frame_pixels(golden, few, 0);
    void'(deburr_error(golden, status, text));
    $display("status %0d: %s", status, text);
    status = deburr_frame_process(null);
    void'(deburr_error(null, status, text));
    $display("status %0d: %s", status, text);
    check(golden, deburr_parameter_count(golden, count));
    check(golden, deburr_parameter_name(golden, 0, name));
    check(golden, deburr_get(golden, name, text));
    $display("%0d parameters of the engine %s: %s = %s, ...", count, deburr_engine(golden), name, text);
    check(golden, deburr_close(golden));
  endtask

  initial begin
    void'($value$plusargs("bug=%d", bug));
    void'($value$plusargs("quads=%d", quads));
    void'($value$plusargs("frames=%d", frames));
    $display("golden models of Deburr %s", deburr_version());
    if ($test$plusargs("rejected") != 0) show_rejections();
    @(negedge clock);
    test_sampler();
    test_detector();
    $display("PASS");
    $finish;
  end
endmodule
