// SPDX-License-Identifier: MIT
// The two ends of the pipe. The painter requests the colours of a floor from the texture unit, adds
// a plain board in the foreground and a sky in the background, and sends the frame to the smoother.
// The display receives the smoother's output.
//
//   Painter -> TextureUnit -> Painter -> MorphologicalEngine -> Display
//
// Both are units of the clock domain, like the blocks of the engines. The painter has one register,
// with which software starts a frame.
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
using deburr::spec::texture::ColourGroup;
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

// The painted content, independent of timing.
inline constexpr int kQuadsAcross = kWidth / 2, kQuads = kQuadsAcross * (kHeight / 2);
Quad quad_of(int number);          // covers the pixels of the floor
Rgba8 plain_colour(int x, int y);  // colour of board and sky
void put(
    Frame& frame,
    const Colour& colour);  // writes a colour of the floor to the pixel given by its tag and lane

class Painter final : public deburr::rtl::Unit {
 public:
  deburr::rtl::Out<Quad> quads_out{"quads_out"};
  deburr::rtl::In<ColourGroup> colours_in{"colours_in"};
  deburr::rtl::Out<deburr::spec::morphological::PixelBeat> pixels_out{"pixels_out"};
  deburr::rtl::RegisterBlock registers{"registers", kPainterRegisters};

  Painter(const sc_core::sc_module_name& name, deburr::rtl::ClockDomain& clock);
  deburr::rtl::Activity tick(deburr::rtl::Cycle cycle) override;
  void reset() override;

  const Frame& frame() const { return frame_; }

 private:
  bool send_quad(deburr::rtl::Cycle cycle);
  bool take_colours(deburr::rtl::Cycle cycle);
  bool send_pixel(deburr::rtl::Cycle cycle);

  Frame frame_;
  bool painting_ = false;
  int quad_ = 0;     // next quad of the frame
  int awaited_ = 0;  // requested colours that have not arrived
  int pixel_ = 0;    // next pixel to send, once all colours have arrived
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
