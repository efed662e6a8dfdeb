/* SPDX-License-Identifier: MIT */
/* Deburr's bit-exact golden models for C99, for C++ and, by way of DPI-C, for SystemVerilog. The
 * contract, with the layouts of arrays and tables of names: docs/reference/c_interface.md.
 *
 * A handle is one model of one engine. Functions that return an int return one of the DEBURR_
 * constants; whatever is not DEBURR_OK has changed nothing, and deburr_error() says what was wrong,
 * where, and what to do. Handles share nothing: each may be used by a thread of its own, and a
 * handle that is used by two at once says DEBURR_BUSY to one of them.
 *
 * An array that is given as `x, x_size` has x_size elements. Rows of a frame begin `stride`
 * elements apart; 0 says that there are no gaps between them. Nothing keeps a pointer that it was
 * given. */
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
  DEBURR_OK = 0,
  DEBURR_ARGUMENT = 1,      /* a null pointer, a wrong size, an unknown name, out of range */
  DEBURR_CONFIGURATION = 2, /* what cannot be built, or a frame that the engine refuses */
  DEBURR_BUSY = 3,          /* another thread is in a call with this handle */
  DEBURR_MEMORY = 4,        /* the machine has no memory left */
  DEBURR_INTERNAL = 5       /* a fault of the model; report it */
};

typedef struct deburr_golden deburr_golden;

/* ---- every engine -----------------------------------------------------------------------------
 */

/* The version of the library, "0.3.0". */
const char* deburr_version(void);

/* Ends a handle. NULL is taken; DEBURR_BUSY leaves it as it is. */
int deburr_close(deburr_golden* golden);

/* The engine's name, or "" for NULL. */
const char* deburr_engine(const deburr_golden* golden);

/* What went wrong in the last call with this handle that returned `status`; "" for DEBURR_OK. The
 * text is cut to text_size with its zero. */
int deburr_error(deburr_golden* golden, int status, char* text, size_t text_size);

/* A parameter by its name and value as text, as in `deburr run --set`. What follows from a preset
 * gives way to what was set by name, in whatever order. It counts from the next quad or frame on.
 */
int deburr_set(deburr_golden* golden, const char* name, const char* text);
/* Its value as text. */
int deburr_get(deburr_golden* golden, const char* name, char* text, size_t text_size);
/* Whether hardware could be built with the parameters as they are. */
int deburr_check(deburr_golden* golden);
/* Names of the parameters, from 0 on. */
int deburr_parameter_count(deburr_golden* golden, uint32_t* count);
int deburr_parameter_name(deburr_golden* golden, uint32_t index, char* text, size_t text_size);

/* Counters by name: of a texture unit since it was made or reset, of the others of the last frame.
 */
int deburr_counter(deburr_golden* golden, const char* name, uint64_t* value);
int deburr_counter_count(deburr_golden* golden, uint32_t* count);
int deburr_counter_name(deburr_golden* golden, uint32_t index, char* text, size_t text_size);

/* As after a reset of the hardware: counters 0, caches empty, no frame. Parameters, textures and
 * memory stay. */
int deburr_reset(deburr_golden* golden);

/* ---- texture unit -----------------------------------------------------------------------------
 */

/* NULL without memory. */
deburr_golden* deburr_texture_new(void);

/* Bytes of the memory that textures lie in, at most 2^32; 0 at first. What is there stays, what
 * comes is zero; counters begin again. */
int deburr_texture_memory(deburr_golden* golden, uint64_t bytes);
int deburr_texture_write(deburr_golden* golden, uint64_t address, const uint8_t* bytes,
                         size_t bytes_size);
int deburr_texture_read(deburr_golden* golden, uint64_t address, uint8_t* bytes, size_t bytes_size);

/* Texture 0..15: a register of its descriptor, by its offset from the descriptor's first; or a
 * field of these registers by name and text, "format" "srgb8_a8", "base0" "4096". */
int deburr_texture_register(deburr_golden* golden, uint32_t texture, uint32_t offset,
                            uint32_t word);
int deburr_texture_field(deburr_golden* golden, uint32_t texture, const char* name,
                         const char* text);
/* Whether quads may name it: the unit gives zero for those of an invalid descriptor. */
int deburr_texture_check(deburr_golden* golden, uint32_t texture);
/* Sets the bases of all its levels, one behind the other from `address` on, and says what is behind
 * them.
 */
int deburr_texture_place(deburr_golden* golden, uint32_t texture, uint64_t address,
                         uint64_t* behind);
/* Puts a level's texels into memory, in the layout that the descriptor says: rows from above, the
 * texels as they lie in memory; `stride` in bytes. */
int deburr_texture_level(deburr_golden* golden, uint32_t texture, uint32_t level,
                         const uint8_t* texels, size_t texels_size, uint32_t stride);

/* Filters a quad: s and t, S7.24, of its four lanes; bits of covered lanes and of those whose
 * coordinates were clamped; R, G, B, A of each lane, 0 where it is not covered. */
int deburr_texture_quad(deburr_golden* golden, uint32_t texture, uint32_t coverage,
                        uint32_t clamped, const int32_t s[4], const int32_t t[4], uint8_t rgba[16]);
/* What is decided about a lane of such a quad before its first texel is read. Changes nothing. */
int deburr_texture_analyse(deburr_golden* golden, uint32_t texture, uint32_t lane,
                           const int32_t s[4], const int32_t t[4], const char* what,
                           int64_t* value);
/* Lines of memory that the last quad fetched, in order; `count` of them, of which lines_size are
 * given at most. */
int deburr_texture_fills(deburr_golden* golden, uint32_t* lines, size_t lines_size,
                         uint32_t* count);
/* Empties the cache, as CONTROL does. */
int deburr_texture_invalidate(deburr_golden* golden);

/* ---- engines that smooth frames ---------------------------------------------------------------
 */

/* NULL without memory. */
deburr_golden* deburr_morphological_new(void);
deburr_golden* deburr_geometric_new(void);

/* A new frame to be smoothed: black, with neither depth nor edges. */
int deburr_frame_begin(deburr_golden* golden, uint32_t width, uint32_t height);
/* Its pixels, R, G, B, A bytes; rows from above, `stride` in bytes. */
int deburr_frame_pixels(deburr_golden* golden, const uint8_t* pixels, size_t pixels_size,
                        uint32_t stride);
/* Its depths, 24 bits each, larger nearer; `stride` in depths. */
int deburr_frame_depth(deburr_golden* golden, const uint32_t* depth, size_t depth_size,
                       uint32_t stride);
/* One pixel and its depth, as a stream brings them; R in bits 7..0, A in bits 31..24. */
int deburr_frame_put(deburr_golden* golden, uint32_t x, uint32_t y, uint32_t rgba, uint32_t depth);

/* 1: the planes that only a slower model knows are kept from the next frame on, 0: they are not. */
int deburr_frame_detail(deburr_golden* golden, uint32_t everything);
/* Smooths the frame, which stays as it was given. */
int deburr_frame_process(deburr_golden* golden);

/* What came of the last frame that was smoothed, by the name of a plane: its size and bytes a
 * pixel, rows from above with `stride` in bytes, or one pixel, its first byte in bits 7..0. */
int deburr_plane_shape(deburr_golden* golden, const char* plane, uint32_t* width, uint32_t* height,
                       uint32_t* pixel_bytes);
int deburr_plane(deburr_golden* golden, const char* plane, uint8_t* values, size_t values_size,
                 uint32_t stride);
int deburr_plane_pixel(deburr_golden* golden, const char* plane, uint32_t x, uint32_t y,
                       uint32_t* value);

/* Edges that someone else found, instead of those that the engine would: a byte a pixel, bit 0 to
 * the left neighbour, bit 1 to the upper one. For the frame that was begun. */
int deburr_morphological_edges(deburr_golden* golden, const uint8_t* edges, size_t edges_size,
                               uint32_t stride);

/* What the frame was drawn from, as words of memory: four a vertex, four an edge; a bit a face.
 * They stay until others are given. */
int deburr_geometric_vertices(deburr_golden* golden, const uint32_t* words, size_t words_size);
int deburr_geometric_edges(deburr_golden* golden, const uint32_t* words, size_t words_size);
int deburr_geometric_facing(deburr_golden* golden, uint32_t faces, const uint8_t* bits,
                            size_t bits_size);
/* What became of each edge of the last frame, with deburr_frame_detail. */
int deburr_geometric_classes(deburr_golden* golden, uint8_t* classes, size_t classes_size);

#ifdef __cplusplus
}
#endif
