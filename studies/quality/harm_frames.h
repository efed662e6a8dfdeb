// SPDX-License-Identifier: MIT
// Frames that smoothing can damage: their correct pixels must stay unchanged. All are procedural,
// and nothing was tuned or trained on them.
#pragma once

#include <cstdint>
#include <string>

#include "tb/scene/image.h"
#include "tb/scene/scenes.h"

namespace deburr::studies::harm {

// A hall with textures on floor, walls, pillars and crates; `view` 0..2 selects the camera.
tb::Scene textured_hall(int view);
// The frame with one sample per pixel, and the reference with smoothed edges.
struct Textured {
  tb::Image frame, reference;
};
Textured textured_frame(int view, int width, int height);
// The hall, supersampled including its textures, as a renderer with good anti-aliasing outputs it.
tb::Image smoothed_hall(int width, int height);

// Simulated photographs: sky, ridges and ground of fractal noise, or layered leaves, through a lens
// that blurs by 0.6 pixels, with sensor noise (2 codes).
tb::Image landscape_photo(int width, int height);
tb::Image foliage_photo(int width, int height);

// Pages of words. Vector letters have strokes 1.5 pixels thick and are 14 pixels high.
enum class Text : std::uint8_t {
  kAliased,      // each pixel is ink or paper
  kSmoothed,     // ink by coverage
  kLightOnDark,  // aliased
  kBitmapFont,   // letters of 5 x 9 dots, one pixel each
};
tb::Image text_page(Text kind, int width, int height);
// The aliased page's letters over the landscape.
tb::Image text_over_scene(int width, int height);

// Straight wires in two flat colours, 40 pixels apart, one sample per pixel; the reference is the
// mean of 8 x 8 samples in linear light. `thickness` is in pixels across the wire.
Textured wires(double thickness, double degrees, int width, int height);

// Tiles and figures in sixteen colours; each art pixel is `size` pixels wide.
tb::Image pixel_art(int size, int width, int height);

// The picture after JPEG compression at this quality, 1..100.
tb::Image compressed(const tb::Image& image, int quality);

}  // namespace deburr::studies::harm
