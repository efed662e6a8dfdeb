// SPDX-License-Identifier: MIT
// Deburr's bit-exact golden models by way of DPI-C. Made from deburr_golden.h, where the same
// functions have the same names: a pointer and its size are an open array here, declared as
// [N] and of the type below; a text that comes back is a string. Compile deburr_golden_dpi.c
// beside it and link libdeburr-golden.
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

  // Ends a handle. NULL is taken; DEBURR_BUSY leaves it as it is.
  import "DPI-C" function int deburr_close(input chandle golden);

  // The engine's name, or "" for NULL.
  import "DPI-C" function string deburr_engine(input chandle golden);

  // What went wrong in the last call with this handle that returned `status`; "" for DEBURR_OK. The
  // text is cut to text_size with its zero.
  import "DPI-C" deburr_dpi_error = function int deburr_error(input chandle golden,
      input int status, output string text);

  // A parameter by its name and value as text, as in `deburr run --set`. What follows from a preset
  // gives way to what was set by name, in whatever order. It counts from the next quad or frame on.
  import "DPI-C" function int deburr_set(input chandle golden, input string name,
      input string text);

  // Its value as text.
  import "DPI-C" deburr_dpi_get = function int deburr_get(input chandle golden, input string name,
      output string text);

  // Whether hardware could be built with the parameters as they are.
  import "DPI-C" function int deburr_check(input chandle golden);

  // Names of the parameters, from 0 on.
  import "DPI-C" function int deburr_parameter_count(input chandle golden,
      output int unsigned count);
  import "DPI-C" deburr_dpi_parameter_name = function int deburr_parameter_name(
      input chandle golden, input int unsigned index, output string text);

  // Counters by name: of an engine that smooths frames those of the last one, of others since it was
  // made or reset.
  import "DPI-C" function int deburr_counter(input chandle golden, input string name,
      output longint unsigned value);
  import "DPI-C" function int deburr_counter_count(input chandle golden, output int unsigned count);
  import "DPI-C" deburr_dpi_counter_name = function int deburr_counter_name(input chandle golden,
      input int unsigned index, output string text);

  // As after a reset of the hardware: counters 0, caches empty, no frame. Parameters, memory and what
  // was put there stay.
  import "DPI-C" function int deburr_reset(input chandle golden);

  // ---- engines that smooth frames ---------------------------------------------------------------

  // A new frame to be smoothed: black, with neither depth nor edges.
  import "DPI-C" function int deburr_frame_begin(input chandle golden, input int unsigned width,
      input int unsigned height);

  // Its pixels, R, G, B, A bytes; rows from above, `stride` in bytes.
  import "DPI-C" deburr_dpi_frame_pixels = function int deburr_frame_pixels(input chandle golden,
      input byte unsigned pixels[], input int unsigned stride);

  // Its depths, 24 bits each, larger nearer; `stride` in depths.
  import "DPI-C" deburr_dpi_frame_depth = function int deburr_frame_depth(input chandle golden,
      input int unsigned depth[], input int unsigned stride);

  // One pixel and its depth, as a stream brings them; R in bits 7..0, A in bits 31..24.
  import "DPI-C" function int deburr_frame_put(input chandle golden, input int unsigned x,
      input int unsigned y, input int unsigned rgba, input int unsigned depth);

  // 1: the planes that only a slower model has are kept from the next frame on, 0: they are not.
  import "DPI-C" function int deburr_frame_detail(input chandle golden,
      input int unsigned everything);

  // Smooths the frame, which stays as it was given.
  import "DPI-C" function int deburr_frame_process(input chandle golden);

  // What came of the last frame that was smoothed, by the name of a plane: its size and bytes a
  // pixel, rows from above with `stride` in bytes, or one pixel, its first byte in bits 7..0.
  import "DPI-C" function int deburr_plane_shape(input chandle golden, input string plane,
      output int unsigned width, output int unsigned height, output int unsigned pixel_bytes);
  import "DPI-C" deburr_dpi_plane = function int deburr_plane(input chandle golden,
      input string plane, inout byte unsigned values[], input int unsigned stride);
  import "DPI-C" function int deburr_plane_pixel(input chandle golden, input string plane,
      input int unsigned x, input int unsigned y, output int unsigned value);

  // ---- texture unit -----------------------------------------------------------------------------

  // NULL without memory.
  import "DPI-C" function chandle deburr_texture_new();

  // Bytes of the memory that textures lie in, at most 2^32; 0 at first. What is there stays, what
  // comes is zero; counters begin again.
  import "DPI-C" function int deburr_texture_memory(input chandle golden,
      input longint unsigned bytes);
  import "DPI-C" deburr_dpi_texture_write = function int deburr_texture_write(input chandle golden,
      input longint unsigned address, input byte unsigned bytes[]);
  import "DPI-C" deburr_dpi_texture_read = function int deburr_texture_read(input chandle golden,
      input longint unsigned address, inout byte unsigned bytes[]);

  // Texture 0..15: a register of its descriptor, by its offset from the descriptor's first; or a
  // field of these registers by name and text, "format" "srgb8_a8", "base0" "4096".
  import "DPI-C" function int deburr_texture_register(input chandle golden,
      input int unsigned texture, input int unsigned offset, input int unsigned word);
  import "DPI-C" function int deburr_texture_field(input chandle golden, input int unsigned texture,
      input string name, input string text);

  // Whether quads may name it: the unit gives zero for those of an invalid descriptor.
  import "DPI-C" function int deburr_texture_check(input chandle golden,
      input int unsigned texture);

  // Sets the bases of all its levels, one after the other from `address` on, and says what is after
  // them.
  import "DPI-C" function int deburr_texture_place(input chandle golden, input int unsigned texture,
      input longint unsigned address, output longint unsigned behind);

  // Puts a level's texels into memory, in the layout that the descriptor says: rows from above, the
  // texels as they lie in memory; `stride` in bytes.
  import "DPI-C" deburr_dpi_texture_level = function int deburr_texture_level(input chandle golden,
      input int unsigned texture, input int unsigned level, input byte unsigned texels[],
      input int unsigned stride);

  // Filters a quad: s and t, S7.24, of its four lanes; bits of covered lanes and of those whose
  // coordinates were clamped; R, G, B, A of each lane, 0 where it is not covered.
  import "DPI-C" function int deburr_texture_quad(input chandle golden, input int unsigned texture,
      input int unsigned coverage, input int unsigned clamped, input int s[4], input int t[4],
      output byte unsigned rgba[16]);

  // What is decided about a lane of such a quad before its first texel is read. Changes nothing.
  import "DPI-C" function int deburr_texture_analyse(input chandle golden,
      input int unsigned texture, input int unsigned lane, input int s[4], input int t[4],
      input string what, output longint value);

  // Lines of memory that the last quad fetched, in order; `count` of them, of which lines_size are
  // given at most.
  import "DPI-C" deburr_dpi_texture_fills = function int deburr_texture_fills(input chandle golden,
      inout int unsigned lines[], output int unsigned count);

  // Empties the cache, as CONTROL does.
  import "DPI-C" function int deburr_texture_invalidate(input chandle golden);

  // ---- morphological engine ---------------------------------------------------------------------

  // NULL without memory.
  import "DPI-C" function chandle deburr_morphological_new();

  // Edges that someone else found, instead of those that the engine would: a byte a pixel, bit 0 to
  // the left neighbour, bit 1 to the upper one. For the frame that was begun.
  import "DPI-C" deburr_dpi_morphological_edges = function int deburr_morphological_edges(
      input chandle golden, input byte unsigned edges[], input int unsigned stride);

  // ---- geometric engine -------------------------------------------------------------------------

  // NULL without memory.
  import "DPI-C" function chandle deburr_geometric_new();

  // What the frame was drawn from, as words of memory: four a vertex, four an edge; a bit a face.
  // They stay until others are given.
  import "DPI-C" deburr_dpi_geometric_vertices = function int deburr_geometric_vertices(
      input chandle golden, input int unsigned words[]);
  import "DPI-C" deburr_dpi_geometric_edges = function int deburr_geometric_edges(
      input chandle golden, input int unsigned words[]);
  import "DPI-C" deburr_dpi_geometric_facing = function int deburr_geometric_facing(
      input chandle golden, input int unsigned faces, input byte unsigned bits[]);

  // What became of each edge of the last frame, with deburr_frame_detail.
  import "DPI-C" deburr_dpi_geometric_classes = function int deburr_geometric_classes(
      input chandle golden, inout byte unsigned classes[]);

endpackage
