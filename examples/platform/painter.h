// SPDX-License-Identifier: MIT
// The two ends of the pipe. A painter that asks the texture unit for the colours of a floor, puts a
// plain board before it and a sky behind, and sends the frame to the smoother; a display that takes
// what the smoother gives.
//
//   Painter -> TextureUnit -> Painter -> MorphologicalEngine -> Display
//
// Both are units of the clock domain, as the engines' own blocks are; the painter has a register of
// its own, with which software starts a frame.
#pragma once

#include <array>
#include <cstdint>
#include <systemc>
#include <vector>

#include "memory_map.h"
#include "rtl_model/fabric/register_block.h"
#include "rtl_model/fabric/unit.h"
#include "spec/morphological/packets.h"
#include "spec/texture/packets.h"

namespace platform {

using deburr::spec::morphological::Rgba8;
using deburr::spec::texture::Colour;
using deburr::spec::texture::Quad;

struct Frame {
  std::vector<Rgba8> pixels = std::vector<Rgba8>(kWidth * kHeight);
  Rgba8& at(int x, int y) { return pixels[static_cast<std::size_t>(y * kWidth + x)]; }
  std::uint32_t hash() const;  // FNV-1a of R, G, B
  bool write_ppm(const char* file) const;
};

inline constexpr std::uint32_t kPainterStart = 0x00;
inline constexpr std::array kPainterStartFields =
    deburr::spec::number(deburr::spec::Access::kWriteOnly);
inline constexpr std::array<deburr::spec::RegisterInfo, 1> kPainterRegisters = {
    {{kPainterStart, "START", "Any write starts a frame.", kPainterStartFields}}};

// What is painted, apart from when.
inline constexpr int kQuadsAcross = kWidth / 2, kQuads = kQuadsAcross * (kHeight / 2);
Quad quad_of(int number);                      // covers the pixels of the floor
Rgba8 plain_colour(int x, int y);              // of board and sky
void put(Frame& frame, const Colour& colour);  // of the floor, where its tag and lane say

class Painter final : public deburr::rtl::Unit {
 public:
  deburr::rtl::Out<Quad> quads_out{"quads_out"};
  deburr::rtl::In<Colour> colours_in{"colours_in"};
  deburr::rtl::Out<deburr::spec::morphological::PixelBeat> pixels_out{"pixels_out"};
  deburr::rtl::RegisterBlock registers{"registers", kPainterRegisters};

  Painter(const sc_core::sc_module_name& name, deburr::rtl::ClockDomain& clock);
  deburr::rtl::Activity tick(deburr::rtl::Cycle cycle) override;
  void reset() override;

  const Frame& frame() const { return frame_; }

 private:
  bool send_quad(deburr::rtl::Cycle cycle);
  bool take_colour(deburr::rtl::Cycle cycle);
  bool send_pixel(deburr::rtl::Cycle cycle);

  Frame frame_;
  bool painting_ = false;
  int quad_ = 0;     // the next one of the frame
  int awaited_ = 0;  // colours that were asked for and have not come
  int pixel_ = 0;    // the next one to go out, once all have come
};

class Display final : public deburr::rtl::Unit {
 public:
  deburr::rtl::In<deburr::spec::morphological::BlendedBeat> pixels_in{"pixels_in"};

  Display(const sc_core::sc_module_name& name, deburr::rtl::ClockDomain& clock)
      : Unit(name, clock) {}
  deburr::rtl::Activity tick(deburr::rtl::Cycle cycle) override;
  void reset() override { shown_ = 0; }

  bool complete() const { return shown_ == kWidth * kHeight; }
  const Frame& frame() const { return frame_; }

 private:
  Frame frame_;
  int shown_ = 0;
};

}  // namespace platform
