// SPDX-License-Identifier: MIT
// Behind the texture unit of a whole frame: takes its colours, gives complete rows to the
// morphological engine, as they come or once the geometric engine is done with the frame.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/unit.h"
#include "spec/morphological/packets.h"
#include "spec/texture/packets.h"
#include "tb/engines/morphological/morphological_input.h"
#include "tb/engines/texture/texture_scene.h"

namespace deburr::tb {

enum class Rows : std::uint8_t { kAsTheyCome, kWhenReleased, kNever };

// Takes a colour a clock, gives a beat of a complete row a clock. Its memory is
// not modelled in time. Stalls: `texture` (the next row, or any, still lacks fragments),
// `geometric` (the frame is complete and not yet released), `downstream`.
class FrameBuffer final : public rtl::Unit {
 public:
  rtl::In<spec::texture::Colour> colours_in{"colours_in"};
  // None if rows never go out.
  std::unique_ptr<rtl::Out<spec::morphological::PixelBeat>> pixels_out;

  FrameBuffer(const sc_core::sc_module_name& name, rtl::ClockDomain& clock,
              const TextureScene& scene, int lanes, Rows rows = Rows::kAsTheyCome);
  rtl::Activity tick(rtl::Cycle cycle) override;
  void reset() override;

  bool done() const { return pixels_out ? y_ == input_.image.height : complete(); }
  // Every fragment has come.
  bool complete() const { return all_missing_ == 0; }
  // Rows of this frame go out from the next clock on, instead of what has come.
  void release(Image frame);
  // What has come, over the sky.
  const Image& frame() const { return released_ ? before_ : input_.image; }
  std::function<void(rtl::Cycle, const spec::texture::Colour&)> on_colour;
  std::function<void(int x, int y, const Rgba8&)> on_pixel;  // that is seen
  rtl::Cycle last_colour() const { return last_colour_; }
  rtl::Cycle first_beat() const { return first_beat_; }
  rtl::Counter bytes_written{"bytes_written", "byte", "bytes of colours written"};
  rtl::Counter bytes_read{"bytes_read", "byte", "bytes of pixels read"};

 private:
  void store(rtl::Cycle cycle, const spec::texture::Colour& colour);
  const TextureScene& scene_;
  bool may_send() const;
  int lanes_;
  Rows rows_;
  rtl::Activity waiting_, held_{};
  MorphologicalInput input_;  // what goes out
  Image sky_, before_;
  std::vector<std::uint32_t> missing_;  // fragments that each row still lacks
  std::uint64_t all_missing_ = 0;
  bool released_ = false;
  int x_ = 0, y_ = 0;
  rtl::Cycle last_colour_ = 0, first_beat_ = 0;
};

}  // namespace deburr::tb
