// SPDX-License-Identifier: MIT
// Deburr's bit-exact golden models through DPI-C, generated from deburr_golden.h with the same
// function names. A pointer with its size becomes an open array, declared as [N] and of the
// type below; a returned text becomes a string. Also compile deburr_golden_dpi.c, and link
// libdeburr-golden.
package deburr_golden_pkg;
  localparam int DEBURR_OK = 0;
  localparam int DEBURR_ARGUMENT = 1;
  localparam int DEBURR_CONFIGURATION = 2;
  localparam int DEBURR_BUSY = 3;
  localparam int DEBURR_MEMORY = 4;
  localparam int DEBURR_INTERNAL = 5;

  // ---- every engine -----------------------------------------------------------------------------

  // The version of the library, "0.3.0".
  import "DPI-C" function string deburr_version();

  // Closes a handle. NULL is accepted. DEBURR_BUSY: the handle stays open.
  import "DPI-C" function int deburr_close(input chandle golden);

  // The name of the engine, or "" for NULL.
  import "DPI-C" function string deburr_engine(input chandle golden);

  // The error text of the last call with this handle that returned `status`; "" for DEBURR_OK. The
  // text is truncated to text_size, including its terminating zero.
  import "DPI-C" deburr_dpi_error = function int deburr_error(input chandle golden,
      input int status, output string text);

  // Sets a parameter by name and text, as `deburr run --set` does. Parameters set by name override
  // those of a preset, in any order. The value applies from the next quad or frame on.
  import "DPI-C" function int deburr_set(input chandle golden, input string name,
      input string text);

  // Gets the value of a parameter as text.
  import "DPI-C" deburr_dpi_get = function int deburr_get(input chandle golden, input string name,
      output string text);

  // Whether hardware can be built with the current parameters.
  import "DPI-C" function int deburr_check(input chandle golden);

  // Number and names of the parameters; the first index is 0.
  import "DPI-C" function int deburr_parameter_count(input chandle golden,
      output int unsigned count);
  import "DPI-C" deburr_dpi_parameter_name = function int deburr_parameter_name(
      input chandle golden, input int unsigned index, output string text);

  // Counters by name. Engines that smooth frames count the last frame; others count from creation
  // or reset on.
  import "DPI-C" function int deburr_counter(input chandle golden, input string name,
      output longint unsigned value);
  import "DPI-C" function int deburr_counter_count(input chandle golden, output int unsigned count);
  import "DPI-C" deburr_dpi_counter_name = function int deburr_counter_name(input chandle golden,
      input int unsigned index, output string text);

  // Memory lines that memory answers with an error: their bytes read as zero. They are addresses, or
  // line numbers for an engine whose functions return line numbers. They replace earlier ones, apply
  // from the next quad or frame on, and remain until the next call; lines_size 0: no errors.
  import "DPI-C" deburr_dpi_error_lines = function int deburr_error_lines(input chandle golden,
      input int unsigned lines[]);

  // Acts like a hardware reset: clears counters and caches, and drops the frame. Parameters, memory
  // and its contents are kept.
  import "DPI-C" function int deburr_reset(input chandle golden);

  // ---- engines that smooth frames ---------------------------------------------------------------

  // Starts a new frame: opaque black, without depth and edges.
  import "DPI-C" function int deburr_frame_begin(input chandle golden, input int unsigned width,
      input int unsigned height);

  // Sets the pixels of the frame: bytes R, G, B, A, top row first; `stride` in bytes.
  import "DPI-C" deburr_dpi_frame_pixels = function int deburr_frame_pixels(input chandle golden,
      input byte unsigned pixels[], input int unsigned stride);

  // Sets the depths of the frame: 24 bits each, larger is nearer; `stride` in depths.
  import "DPI-C" deburr_dpi_frame_depth = function int deburr_frame_depth(input chandle golden,
      input int unsigned depth[], input int unsigned stride);

  // Sets one pixel and its depth, for input from a stream; R in bits 7..0, A in bits 31..24.
  import "DPI-C" function int deburr_frame_put(input chandle golden, input int unsigned x,
      input int unsigned y, input int unsigned rgba, input int unsigned depth);

  // 1: also keep the planes that need a slower model, from the next frame on; 0: do not.
  import "DPI-C" function int deburr_frame_detail(input chandle golden,
      input int unsigned everything);

  // Smooths the frame; the input is kept.
  import "DPI-C" function int deburr_frame_process(input chandle golden);

  // Results of the last smoothed frame, by the name of a plane: its size and bytes per pixel; all
  // pixels, top row first, `stride` in bytes; or one pixel, its first byte in bits 7..0.
  import "DPI-C" function int deburr_plane_shape(input chandle golden, input string plane,
      output int unsigned width, output int unsigned height, output int unsigned pixel_bytes);
  import "DPI-C" deburr_dpi_plane = function int deburr_plane(input chandle golden,
      input string plane, inout byte unsigned values[], input int unsigned stride);
  import "DPI-C" function int deburr_plane_pixel(input chandle golden, input string plane,
      input int unsigned x, input int unsigned y, output int unsigned value);

  // ---- texture unit -----------------------------------------------------------------------------

  // Returns NULL if out of memory.
  import "DPI-C" function chandle deburr_texture_new();

  // Sets the size of the texture memory in bytes, at most 2^32; initially 0. Existing contents are
  // kept, new bytes are zero; counters restart.
  import "DPI-C" function int deburr_texture_memory(input chandle golden,
      input longint unsigned bytes);
  import "DPI-C" deburr_dpi_texture_write = function int deburr_texture_write(input chandle golden,
      input longint unsigned address, input byte unsigned bytes[]);
  import "DPI-C" deburr_dpi_texture_read = function int deburr_texture_read(input chandle golden,
      input longint unsigned address, inout byte unsigned bytes[]);

  // Sets a part of the descriptor of texture 0..15: a register, by its offset in the descriptor; or
  // a field by name and text, such as "format" "srgb8_a8" or "base0" "4096".
  import "DPI-C" function int deburr_texture_register(input chandle golden,
      input int unsigned texture, input int unsigned offset, input int unsigned word);
  import "DPI-C" function int deburr_texture_field(input chandle golden, input int unsigned texture,
      input string name, input string text);

  // Whether the descriptor is valid. Quads with an invalid descriptor get zero.
  import "DPI-C" function int deburr_texture_check(input chandle golden,
      input int unsigned texture);

  // Sets the bases of all levels, one after the other from `address` on, each a multiple of 64;
  // `behind`: the first such address after them.
  import "DPI-C" function int deburr_texture_place(input chandle golden, input int unsigned texture,
      input longint unsigned address, output longint unsigned behind);

  // Writes the texels of a level to memory in the layout of the descriptor. Input: top row first,
  // each texel as it is stored, or rows of blocks of 4 x 4 texels; `stride` in bytes.
  import "DPI-C" deburr_dpi_texture_level = function int deburr_texture_level(input chandle golden,
      input int unsigned texture, input int unsigned level, input byte unsigned texels[],
      input int unsigned stride);

  // Filters a quad: s and t, S7.24, of its four lanes; bit masks of covered and of clamped lanes.
  // Output: R, G, B, A per lane, 0 for lanes that are not covered.
  import "DPI-C" function int deburr_texture_quad(input chandle golden, input int unsigned texture,
      input int unsigned coverage, input int unsigned clamped, input int s[4], input int t[4],
      output byte unsigned rgba[16]);

  // A decision about a lane of such a quad before its first texel is read. Changes nothing.
  import "DPI-C" function int deburr_texture_analyse(input chandle golden,
      input int unsigned texture, input int unsigned lane, input int s[4], input int t[4],
      input string what, output longint value);

  // Memory lines fetched by the last quad, in order. `count`: their number; at most lines_size of
  // them are written.
  import "DPI-C" deburr_dpi_texture_fills = function int deburr_texture_fills(input chandle golden,
      inout int unsigned lines[], output int unsigned count);

  // Invalidates the cache, like CONTROL.
  import "DPI-C" function int deburr_texture_invalidate(input chandle golden);

  // ---- morphological engine ---------------------------------------------------------------------

  // Returns NULL if out of memory.
  import "DPI-C" function chandle deburr_morphological_new();

  // Sets the edges of the current frame instead of edge detection: one byte per pixel, bit 0 for
  // the edge to the left neighbour, bit 1 for the edge to the upper one.
  import "DPI-C" deburr_dpi_morphological_edges = function int deburr_morphological_edges(
      input chandle golden, input byte unsigned edges[], input int unsigned stride);

  // ---- geometric engine -------------------------------------------------------------------------

  // Returns NULL if out of memory.
  import "DPI-C" function chandle deburr_geometric_new();

  // Sets the base address of a region of memory, a multiple of 64, by its name; initially 0. It
  // decides which reads deburr_error_lines hits.
  import "DPI-C" function int deburr_geometric_base(input chandle golden, input string region,
      input int unsigned address);

  // Inputs of the frame, in the layout of memory: four words per vertex, four words per edge, one
  // facing bit per face. They are kept until they are replaced.
  import "DPI-C" deburr_dpi_geometric_vertices = function int deburr_geometric_vertices(
      input chandle golden, input int unsigned words[]);
  import "DPI-C" deburr_dpi_geometric_edges = function int deburr_geometric_edges(
      input chandle golden, input int unsigned words[]);
  import "DPI-C" deburr_dpi_geometric_facing = function int deburr_geometric_facing(
      input chandle golden, input int unsigned faces, input byte unsigned bits[]);

  // The class of each edge of the last frame; needs deburr_frame_detail.
  import "DPI-C" deburr_dpi_geometric_classes = function int deburr_geometric_classes(
      input chandle golden, inout byte unsigned classes[]);

endpackage
