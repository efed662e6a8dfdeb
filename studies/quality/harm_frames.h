// SPDX-License-Identifier: MIT
// Frames on which smoothing does harm: what is right in them must stay as it is. All by formula,
// and nothing was chosen or trained on them.
#pragma once

#include <cstdint>
#include <string>

#include "tb/scene/image.h"
#include "tb/scene/scenes.h"

namespace deburr::studies::harm {

// A hall whose floor, walls, pillars and crates all have textures; `view` 0..2 is the camera.
tb::Scene textured_hall(int view);
// The frame with one sample a pixel, and the same with smoothed edges.
struct Textured {
  tb::Image frame, reference;
};
Textured textured_frame(int view, int width, int height);
// The hall, supersampled with all that is in it, as a renderer with good anti-aliasing has it.
tb::Image smoothed_hall(int width, int height);

// What a camera leaves: sky, ridges and ground of fractal noise, or leaves over leaves, seen
// through a lens that blurs by 0.6 pixels, with the noise of a sensor (2 codes).
tb::Image landscape_photo(int width, int height);
tb::Image foliage_photo(int width, int height);

// Pages of words. Vector letters have strokes 1.5 pixels thick and are 14 pixels high.
enum class Text : std::uint8_t {
  kAliased,      // a pixel is ink or paper
  kSmoothed,     // ink by coverage
  kLightOnDark,  // aliased
  kBitmapFont,   // letters of 5 x 9 dots, a pixel each
};
tb::Image text_page(Text kind, int width, int height);
// The aliased page's letters over the landscape.
tb::Image text_over_scene(int width, int height);

// Straight wires of two flat colours, 40 pixels apart, one sample a pixel; the reference is the
// mean of 8 x 8 samples in linear light. `thickness` is in pixels across the wire.
Textured wires(double thickness, double degrees, int width, int height);

// Tiles and figures in sixteen colours, each pixel of it `size` pixels wide.
tb::Image pixel_art(int size, int width, int height);

// The picture as it comes back from a JPEG file of this quality, 1..100.
tb::Image compressed(const tb::Image& image, int quality);

}  // namespace deburr::studies::harm
