// SPDX-License-Identifier: MIT
#include "tb/engines/texture/texture_maps.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "rtl_model/texture/tokens.h"
#include "tb/engines/texture/texture_links.h"

namespace deburr::tb {
TextureMaps::TextureMaps(rtl::ClockDomain& clock, rtl::texture::TextureUnit& unit,
                         const rtl::Link<spec::texture::Quad>& quads,
                         const rtl::Link<spec::texture::ColourGroup>& colours,
                         const SentQuads& sent, int width, int height)
    : unit_(unit),
      sent_(sent),
      samples_("samples", "Samples", "samples",
               "Samples along the major axis of a fragment, N; of several in a pixel the sum.",
               width, height),
      level_("level", "Mip level", "level",
             "Level of detail that a fragment is filtered at, with its fraction.", width, height),
      misses_("misses", "Misses", "lines", "Cache lines that a fragment requested from memory.",
              width, height),
      latency_(
          "latency", "Latency", "clk",
          "Cycles from a fragment's quad being taken to its colour; of several in a pixel the sum.",
          width, height) {
  const auto add = [this](std::uint32_t tag, std::uint8_t lane, PictureMap& map, double value,
                          double* unplaced) {
    const traces::TracedQuad* quad = sent_.find(tag);
    if (!quad || lane >= 4) return;  // corrupted by an injected fault
    if (quad->placed)
      map.add(quad->x(lane), quad->y(lane), value);
    else if (unplaced)
      *unplaced += value;
  };
  using namespace rtl::texture;
  monitors_.push_back(watch_tokens<LevelToken, FragmentGroup<LevelToken>>(
      clock, unit, "address_unit.levels", [this, add](rtl::Cycle, const LevelToken& token) {
        const auto& [tag, lane] = std::pair(token.ticket.tag, token.ticket.lane);
        add(tag, lane, samples_, token.last_index + 1U, &unplaced_.samples);
        add(tag, lane, misses_, 0, nullptr);
        constexpr double kFraction = 1.0 / 256;
        const traces::TracedQuad* quad = sent_.find(tag);
        if (quad && quad->placed && lane < 4)
          level_.set(quad->x(lane), quad->y(lane), token.level + kFraction * token.fraction);
      }));
  if (unit.cache.wide) {
    monitors_.push_back(std::make_unique<Monitor<CacheGroup>>(
        clock, link_of<CacheGroup>(unit, "texture_cache.requests"),
        [this, add](rtl::Cycle, const CacheGroup& group) {
          std::array<bool, spec::texture::kMostLookups> counted{};
          for (std::size_t i = 0; i < group.count; ++i) {
            const GroupRequest& request = group.at[i];
            if (!request.ticket.valid) continue;
            int fills = 0;  // of lines that no earlier request of the group used
            for (const std::uint8_t line : request.index)
              if (group.missed[line] && !std::exchange(counted[line], true)) ++fills;
            add(request.ticket.tag, request.ticket.lane, misses_, fills, &unplaced_.misses);
          }
        }));
  } else {
    monitors_.push_back(std::make_unique<Monitor<CacheToken>>(
        clock, link_of<CacheToken>(unit, "texture_cache.requests"),
        [this, add](rtl::Cycle, const CacheToken& token) {
          add(token.ticket.tag, token.ticket.lane, misses_, token.fills, &unplaced_.misses);
        }));
  }
  monitors_.push_back(std::make_unique<Monitor<spec::texture::Quad>>(
      clock, quads, Monitor<spec::texture::Quad>::Callback(),
      [this](rtl::Cycle cycle, const spec::texture::Quad& quad) {
        taken_[quad.tag % kKept] = cycle;
      }));
  monitors_.push_back(std::make_unique<Monitor<spec::texture::ColourGroup>>(
      clock, colours, [this, add](rtl::Cycle cycle, const spec::texture::ColourGroup& group) {
        // The colour can be taken from the next cycle on.
        for (const spec::texture::Colour& colour : group)
          add(colour.tag, colour.lane, latency_,
              static_cast<double>(cycle + 1 - taken_[colour.tag % kKept]), &unplaced_.latency);
      }));
}

void TextureMaps::clear() {
  for (PictureMap* map : {&samples_, &level_, &misses_, &latency_})
    std::fill(map->values.begin(), map->values.end(), std::numeric_limits<float>::quiet_NaN());
  unplaced_ = {};
}

std::vector<PictureMap> TextureMaps::maps() const {
  std::vector<PictureMap> all = {samples_, level_, misses_, latency_};
  const auto account = [](PictureMap& map, std::string of, std::uint64_t counted, double unplaced) {
    map.account = {std::move(of), static_cast<double>(counted), map.sum() + unplaced};
  };
  account(all[0], "work.sample_walker_samples", unit_.address.walker.samples.value(),
          unplaced_.samples);
  account(all[2], "work.tag_stage_misses", unit_.cache.tag_stage.misses.value(), unplaced_.misses);
  account(all[3], "the sum of all latencies", unit_.fragment_latency.sum(), unplaced_.latency);
  return all;
}

}  // namespace deburr::tb
