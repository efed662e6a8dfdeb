// SPDX-License-Identifier: MIT
// Per-pixel maps of the texture unit, observed on its links: samples, level, misses, latency.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "rtl_model/texture/texture_unit.h"
#include "spec/texture/packets.h"
#include "tb/engines/texture/sent_quads.h"
#include "tb/harness/monitor.h"
#include "tb/run/picture_map.h"

namespace deburr::tb {

class TextureMaps {
 public:
  // `quads` and `colours`: the unit's input and output links. `sent` gives the position of a quad
  // in the picture of `width` x `height` pixels. All arguments must outlive it.
  TextureMaps(rtl::ClockDomain& clock, rtl::texture::TextureUnit& unit,
              const rtl::Link<spec::texture::Quad>& quads,
              const rtl::Link<spec::texture::ColourGroup>& colours, const SentQuads& sent,
              int width, int height);
  void clear();
  // Returns the maps after checking their totals against the unit's own counts.
  std::vector<PictureMap> maps() const;

 private:
  // More quads than the unit holds at a time.
  static constexpr std::size_t kKept = 4096;
  // Counts of fragments without a position, so that totals match.
  struct Unplaced {
    double samples = 0, misses = 0, latency = 0;
  };

  const rtl::texture::TextureUnit& unit_;
  const SentQuads& sent_;
  PictureMap samples_, level_, misses_, latency_;
  Unplaced unplaced_;
  std::array<rtl::Cycle, kKept> taken_{};  // indexed by the quad's tag modulo kKept
  std::vector<std::unique_ptr<rtl::Clocked>> monitors_;
};

}  // namespace deburr::tb
