// SPDX-License-Identifier: MIT
// Between the two engines of a whole frame: takes the colours of the texture unit, gives complete
// rows to the morphological engine.
#pragma once

#include <cstdint>
#include <functional>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/unit.h"
#include "spec/morphological/packets.h"
#include "spec/texture/packets.h"
#include "tb/env/frame_source.h"
#include "tb/env/texture_scene.h"

namespace deburr::tb {

// Takes a colour a clock, gives a beat of a complete row a clock. Its memory is
// not modelled in time. Stalls: `texture` (the next row still lacks fragments), `downstream`.
class FrameBuffer final : public rtl::Unit {
 public:
  rtl::In<spec::texture::Colour> colours_in{"colours_in"};
  rtl::Out<spec::morphological::PixelBeat> pixels_out{"pixels_out"};

  FrameBuffer(const sc_core::sc_module_name& name, rtl::ClockDomain& clock,
              const TextureScene& scene, int lanes);
  rtl::Activity tick(rtl::Cycle cycle) override;
  void reset() override;

  bool done() const { return y_ == input_.image.height; }
  const Image& frame() const { return input_.image; }
  std::function<void(rtl::Cycle, const spec::texture::Colour&)> on_colour;
  rtl::Cycle last_colour() const { return last_colour_; }
  rtl::Cycle first_beat() const { return first_beat_; }
  rtl::Counter bytes_written{"bytes_written", "byte", "bytes of colours written"};
  rtl::Counter bytes_read{"bytes_read", "byte", "bytes of pixels read"};

 private:
  void store(rtl::Cycle cycle, const spec::texture::Colour& colour);
  const TextureScene& scene_;
  int lanes_;
  rtl::Activity waiting_;
  MorphologicalInput input_;
  Image sky_;
  std::vector<std::uint32_t> missing_;  // fragments that each row still lacks
  int x_ = 0, y_ = 0;
  rtl::Cycle last_colour_ = 0, first_beat_ = 0;
};

}  // namespace deburr::tb
