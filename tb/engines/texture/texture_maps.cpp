// SPDX-License-Identifier: MIT
#include "tb/engines/texture/texture_maps.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "rtl_model/texture/tokens.h"
#include "tb/engines/texture/texture_links.h"

namespace deburr::tb {
TextureMaps::TextureMaps(rtl::ClockDomain& clock, rtl::texture::TextureUnit& unit,
                         const rtl::Link<spec::texture::Quad>& quads,
                         const rtl::Link<spec::texture::Colour>& colours,
                         const FragmentStream& stream)
    : unit_(unit),
      stream_(stream),
      samples_("samples", "Samples", "samples",
               "Samples along the major axis of a fragment, N; of several in a pixel the sum.",
               stream.width, stream.height),
      level_("level", "Mip level", "level",
             "Level of detail that a fragment is filtered at, with its fraction.", stream.width,
             stream.height),
      misses_("misses", "Misses", "lines", "Lines of the cache that a fragment ordered.",
              stream.width, stream.height),
      latency_(
          "latency", "Latency", "clk",
          "Clocks from a fragment's quad being taken to its colour; of several in a pixel the sum.",
          stream.width, stream.height),
      taken_(stream.quads.size()) {
  const auto at = [this](std::uint32_t tag, std::uint8_t lane, const auto& visit) {
    if (tag >= stream_.quads.size() || lane >= 4) return;  // of a planted fault
    const FragmentStream::Pixel pixel = stream_.pixel(tag, lane);
    visit(pixel.x, pixel.y);
  };
  using rtl::texture::CacheToken;
  using rtl::texture::LevelToken;
  monitors_.push_back(std::make_unique<Monitor<LevelToken>>(
      clock, link_of<LevelToken>(unit, "address.levels"),
      [this, at](rtl::Cycle, const LevelToken& token) {
        at(token.ticket.tag, token.ticket.lane, [&](int x, int y) {
          constexpr double kFraction = 1.0 / 256;
          samples_.add(x, y, token.last_index + 1U);
          level_.set(x, y, token.level + kFraction * token.fraction);
          misses_.add(x, y, 0);
        });
      }));
  monitors_.push_back(std::make_unique<Monitor<CacheToken>>(
      clock, link_of<CacheToken>(unit, "cache.requests"),
      [this, at](rtl::Cycle, const CacheToken& token) {
        at(token.ticket.tag, token.ticket.lane,
           [&](int x, int y) { misses_.add(x, y, token.fills); });
      }));
  monitors_.push_back(std::make_unique<Monitor<spec::texture::Quad>>(
      clock, quads, Monitor<spec::texture::Quad>::Callback(),
      [this](rtl::Cycle cycle, const spec::texture::Quad& quad) {
        if (quad.tag < taken_.size()) taken_[quad.tag] = cycle;
      }));
  monitors_.push_back(std::make_unique<Monitor<spec::texture::Colour>>(
      clock, colours, [this, at](rtl::Cycle cycle, const spec::texture::Colour& colour) {
        at(colour.tag, colour.lane, [&](int x, int y) {
          // It can be taken in the clock behind.
          latency_.add(x, y, static_cast<double>(cycle + 1 - taken_[colour.tag]));
        });
      }));
}

void TextureMaps::clear() {
  for (PictureMap* map : {&samples_, &level_, &misses_, &latency_})
    std::fill(map->values.begin(), map->values.end(), std::numeric_limits<float>::quiet_NaN());
}

std::vector<PictureMap> TextureMaps::maps() const {
  std::vector<PictureMap> all = {samples_, level_, misses_, latency_};
  const auto account = [](PictureMap& map, std::string of, std::uint64_t counted) {
    map.account = {std::move(of), static_cast<double>(counted), map.sum()};
  };
  account(all[0], "work.walker_samples", unit_.address.walker.samples.value());
  account(all[2], "work.tag_stage_misses", unit_.cache.tag_stage.misses.value());
  account(all[3], "the sum of all latencies", unit_.fragment_latency.sum());
  return all;
}

}  // namespace deburr::tb
