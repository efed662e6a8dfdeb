// SPDX-License-Identifier: MIT
// What the texture unit did for each pixel, seen on its links: samples, level, misses, latency.
#pragma once

#include <memory>
#include <vector>

#include "rtl_model/texture/texture_unit.h"
#include "spec/texture/packets.h"
#include "tb/harness/monitor.h"
#include "tb/results/picture_map.h"
#include "tb/scene/rasteriser.h"

namespace deburr::tb {

class TextureMaps {
 public:
  // `quads` and `colours`: the links in front of the unit and behind it. All must outlive it.
  TextureMaps(rtl::ClockDomain& clock, rtl::texture::TextureUnit& unit,
              const rtl::Link<spec::texture::Quad>& quads,
              const rtl::Link<spec::texture::Colour>& colours, const FragmentStream& stream);
  void clear();
  // With what the unit counted itself.
  std::vector<PictureMap> maps() const;

 private:
  const rtl::texture::TextureUnit& unit_;
  const FragmentStream& stream_;
  PictureMap samples_, level_, misses_, latency_;
  std::vector<rtl::Cycle> taken_;  // by quad
  std::vector<std::unique_ptr<rtl::Clocked>> monitors_;
};

}  // namespace deburr::tb
