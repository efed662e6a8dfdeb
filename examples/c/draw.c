/* SPDX-License-Identifier: MIT */
/* Deburr's golden models from plain C: a checkerboard in perspective under a slanted horizon is
 * drawn quad by quad with the texture unit, smoothed with the morphological engine, and compared
 * with the expected picture.
 *
 *   cc -std=c99 draw.c $(pkg-config --cflags --libs deburr-golden-c) -o draw && ./draw [FILE.ppm]
 *
 * Exit code: 0 passed, 1 unexpected picture, 2 a call failed or the file cannot be written. */
#include <deburr_golden.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 192, HEIGHT = 128, SIDE = 64, LEVELS = 7 };
static const uint64_t known_picture = UINT64_C(0xc807d6205d1665b6);

/* Ends the program with the reason if a call has failed. */
static void check(deburr_golden* golden, int status) {
  char text[1000];
  if (status == DEBURR_OK) return;
  deburr_error(golden, status, text, sizeof text);
  fprintf(stderr, "draw: %s\n", text);
  exit(2);
}

/* ---- a texture with its mip chain -------------------------------------------------------------
 */

static void load_checkerboard(deburr_golden* unit) {
  static const char* const fields[][2] = {{"width", "64"},
                                          {"height", "64"},
                                          {"levels", "7"},
                                          {"format", "rgba8"},
                                          {"layout", "tiled"},
                                          {"min_filter", "linear_mipmap_linear"},
                                          {"mag_filter", "linear"},
                                          {"max_count_log2", "4"},
                                          {"max_lod", "3072"},
                                          {"wrap_s", "repeat"},
                                          {"wrap_t", "mirrored_repeat"}};
  uint8_t texels[SIDE * SIDE * 4];
  uint64_t end = 0;
  for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i)
    check(unit, deburr_texture_field(unit, 0, fields[i][0], fields[i][1]));
  check(unit, deburr_texture_place(unit, 0, 0, &end));
  check(unit, deburr_texture_memory(unit, end));
  for (int y = 0; y < SIDE; ++y) {
    for (int x = 0; x < SIDE; ++x) {
      const int light = ((x / 8) ^ (y / 8)) & 1;
      uint8_t* texel = &texels[4 * (y * SIDE + x)];
      texel[0] = light ? 240 : 40;
      texel[1] = light ? 220 : 40;
      texel[2] = light ? 180 : 60;
      texel[3] = 255;
    }
  }
  for (uint32_t level = 0; level < LEVELS; ++level) {
    const int side = SIDE >> level;
    check(unit, deburr_texture_level(unit, 0, level, texels, 4 * (size_t)(side * side), 0));
    /* The next level: averages of 2 x 2 texels, in place. */
    for (int y = 0; y < side / 2; ++y)
      for (int x = 0; x < side / 2; ++x)
        for (int c = 0; c < 4; ++c)
          texels[4 * (y * (side / 2) + x) + c] =
              (uint8_t)((texels[4 * (2 * y * side + 2 * x) + c] +
                         texels[4 * (2 * y * side + 2 * x + 1) + c] +
                         texels[4 * ((2 * y + 1) * side + 2 * x) + c] +
                         texels[4 * ((2 * y + 1) * side + 2 * x + 1) + c] + 2) /
                        4);
  }
}

/* ---- a floor in perspective -------------------------------------------------------------------
 */

static int above_horizon(int x, int y) { return 8 * y < 160 + x; }

/* S7.24 coordinates of the floor below a pixel. */
static void floor_at(int x, int y, int32_t* s, int32_t* t) {
  const int64_t depth = y + 24;
  *s = (int32_t)((((int64_t)(x - WIDTH / 2)) << 24) * 3 / (2 * depth));
  *t = (int32_t)(((int64_t)300 << 24) / (2 * depth));
}

static void draw(deburr_golden* unit, uint8_t* pixels) {
  for (int y = 0; y < HEIGHT; y += 2) {
    for (int x = 0; x < WIDTH; x += 2) {
      int32_t s[4], t[4];
      uint8_t rgba[16];
      uint32_t coverage = 0;
      for (int lane = 0; lane < 4; ++lane) {
        const int px = x + lane % 2, py = y + lane / 2;
        floor_at(px, py, &s[lane], &t[lane]);
        if (!above_horizon(px, py)) coverage |= 1u << lane;
      }
      check(unit, deburr_texture_quad(unit, 0, coverage, 0, s, t, rgba));
      for (int lane = 0; lane < 4; ++lane) {
        uint8_t* pixel = &pixels[4 * ((y + lane / 2) * WIDTH + x + lane % 2)];
        const uint8_t sky[4] = {120, 170, 230, 255};
        for (int c = 0; c < 4; ++c) pixel[c] = coverage >> lane & 1 ? rgba[4 * lane + c] : sky[c];
      }
    }
  }
}

/* ---- the rest ---------------------------------------------------------------------------------
 */

static void say(deburr_golden* golden, const char* counter) {
  uint64_t value = 0;
  check(golden, deburr_counter(golden, counter, &value));
  printf("%-14s %-16s %" PRIu64 "\n", deburr_engine(golden), counter, value);
}

static int write_ppm(const char* path, const uint8_t* pixels) {
  FILE* const file = fopen(path, "wb");
  int written = file != NULL && fprintf(file, "P6\n%d %d\n255\n", WIDTH, HEIGHT) > 0;
  for (int i = 0; written && i < WIDTH * HEIGHT; ++i)
    written = fwrite(&pixels[4 * i], 1, 3, file) == 3;
  if (file != NULL && fclose(file) != 0) written = 0;
  if (!written) perror(path);
  return written;
}

int main(int argc, char** argv) {
  static uint8_t pixels[WIDTH * HEIGHT * 4];
  uint64_t hash = UINT64_C(14695981039346656037);
  deburr_golden* const unit = deburr_texture_new();
  deburr_golden* const smoother = deburr_morphological_new();
  if (unit == NULL || smoother == NULL) {
    fprintf(stderr, "draw: no memory\n");
    return 2;
  }
  check(unit, deburr_set(unit, "axes", "eight"));
  load_checkerboard(unit);
  draw(unit, pixels);

  check(smoother, deburr_set(smoother, "preset", "deburr"));
  check(smoother, deburr_frame_begin(smoother, WIDTH, HEIGHT));
  check(smoother, deburr_frame_pixels(smoother, pixels, sizeof pixels, 0));
  check(smoother, deburr_frame_process(smoother));
  check(smoother, deburr_plane(smoother, "pixels", pixels, sizeof pixels, 0));

  say(unit, "fragments");
  say(unit, "samples");
  say(unit, "line_fills");
  say(smoother, "edge_pixels");
  say(smoother, "blended_pixels");
  deburr_close(unit);
  deburr_close(smoother);

  /* FNV-1a */
  for (size_t i = 0; i < sizeof pixels; ++i) hash = (hash ^ pixels[i]) * UINT64_C(1099511628211);
  if (argc > 1 && !write_ppm(argv[1], pixels)) return 2;
  if (hash != known_picture) {
    printf("FAIL picture 0x%016" PRIx64 ", expected 0x%016" PRIx64 "\n", hash, known_picture);
    return 1;
  }
  printf("PASS picture 0x%016" PRIx64 ", golden models of Deburr %s\n", hash, deburr_version());
  return 0;
}
