// SPDX-License-Identifier: MIT
#include "painter.h"

#include <bit>
#include <cstdio>

namespace platform {

using deburr::rtl::Activity;
using deburr::rtl::Cycle;

namespace {

constexpr Rgba8 kSky = {148, 184, 220, 255}, kBoard = {214, 62, 40, 255};
constexpr int kHorizon = 24;  // first row of the floor

// A board of slanted edges, in half pixels.
bool on_board(int x, int y) {
  const int u = 2 * x + 1, v = 2 * y + 1;
  return 7 * u + 2 * v > 840 && 7 * u + 2 * v < 1540 && 9 * v - 2 * u > 10 && 9 * v - 2 * u < 900;
}
bool on_floor(int x, int y) { return y >= kHorizon && !on_board(x, y); }

// Floor coordinates, S7.24. Depth is inversely proportional to the row's distance from the horizon.
std::int32_t along(int y) { return (16 << 24) / (2 * (y - kHorizon) + 5); }
std::int32_t across(int x, int y) { return (2 * x + 1 - kWidth) * (along(y) / 64); }

}  // namespace

std::uint32_t Frame::hash() const {
  std::uint32_t hash = 0x811C9DC5;
  for (const Rgba8& pixel : pixels)
    for (int c = 0; c < 3; ++c) hash = (hash ^ pixel[static_cast<std::size_t>(c)]) * 0x01000193;
  return hash;
}

bool Frame::write_ppm(const char* file) const {
  std::FILE* out = std::fopen(file, "wb");
  if (!out) return false;
  std::fprintf(out, "P6 %d %d 255\n", kWidth, kHeight);
  for (const Rgba8& pixel : pixels) std::fwrite(pixel.data(), 1, 3, out);
  const bool written = !std::ferror(out);
  return std::fclose(out) == 0 && written;
}

// Four pixels; only those of the floor need a colour. All four have coordinates, from which the
// texture unit computes the size of a pixel in the texture.
Quad quad_of(int number) {
  Quad quad;
  quad.tag = static_cast<std::uint32_t>(number);
  quad.coverage = 0;
  quad.x = static_cast<std::uint16_t>(number % kQuadsAcross * 2);
  quad.y = static_cast<std::uint16_t>(number / kQuadsAcross * 2);
  for (int lane = 0; lane < 4; ++lane) {
    const int x = quad.x + lane % 2, y = quad.y + lane / 2;
    if (y < kHorizon) continue;
    quad.s[static_cast<std::size_t>(lane)] = across(x, y);
    quad.t[static_cast<std::size_t>(lane)] = along(y);
    if (on_floor(x, y)) quad.coverage = static_cast<std::uint8_t>(quad.coverage | 1 << lane);
  }
  return quad;
}

Rgba8 plain_colour(int x, int y) { return on_board(x, y) ? kBoard : kSky; }

void put(Frame& frame, const Colour& colour) {
  const int quad = static_cast<int>(colour.tag);
  frame.at(quad % kQuadsAcross * 2 + colour.lane % 2, quad / kQuadsAcross * 2 + colour.lane / 2) =
      colour.rgba;
}

Painter::Painter(const sc_core::sc_module_name& name, deburr::rtl::ClockDomain& clock)
    : Unit(name, clock) {
  registers.on_write(registers.index_of("START"), [this](std::uint32_t) {
    reset();
    painting_ = true;
  });
}

void Painter::reset() {
  painting_ = false;
  quad_ = awaited_ = pixel_ = 0;
}

Activity Painter::tick(Cycle cycle) {
  if (!painting_) return deburr::rtl::kIdle;
  const bool took = take_colours(cycle), asked = send_quad(cycle), sent = send_pixel(cycle);
  return took || asked || sent ? deburr::rtl::kBusy : deburr::rtl::kStalledDownstream;
}

bool Painter::send_quad(Cycle cycle) {
  if (quad_ == kQuads || !quads_out.can_push(cycle)) return false;
  const Quad quad = quad_of(quad_);
  for (int lane = 0; lane < 4; ++lane) {
    const int x = quad.x + lane % 2, y = quad.y + lane / 2;
    frame_.at(x, y) = plain_colour(x, y);
  }
  awaited_ += std::popcount(quad.coverage);
  if (quad.coverage) quads_out.push(cycle, quad);
  ++quad_;
  return true;
}

bool Painter::take_colours(Cycle cycle) {
  if (!colours_in.can_pop(cycle)) return false;
  for (const Colour& colour : colours_in.take(cycle)) {
    put(frame_, colour);
    --awaited_;
  }
  return true;
}

bool Painter::send_pixel(Cycle cycle) {
  if (quad_ < kQuads || awaited_ > 0 || !pixels_out.can_push(cycle)) return false;
  const int x = pixel_ % kWidth, y = pixel_ / kWidth;
  deburr::spec::morphological::PixelBeat beat;
  beat.count = 1;
  beat.pixel[0] = frame_.at(x, y);
  beat.start_of_frame = pixel_ == 0;
  beat.end_of_row = x == kWidth - 1;
  pixels_out.push(cycle, beat);
  if (++pixel_ == kWidth * kHeight) painting_ = false;
  return true;
}

Activity Display::tick(Cycle cycle) {
  if (!pixels_in.can_pop(cycle)) return deburr::rtl::kIdle;
  const auto& beat = pixels_in.take(cycle);
  if (beat.start_of_frame) shown_ = 0;
  frame_.at(shown_ % kWidth, shown_ / kWidth) = beat.pixel[0];
  ++shown_;
  return deburr::rtl::kBusy;
}

}  // namespace platform
