// SPDX-License-Identifier: MIT
#include "tb/engines/texture/texture_draws.h"

#include <cstdint>
#include <string>

#include "tb/results/parameter_set.h"

namespace deburr::tb {
namespace {

// A cache needs a line a way, and axes leave so many clocks for each.
bool can_be_built(const ParameterSet& set) {
  const std::int64_t line = number_of(set, "texture.cache.line_bytes"),
                     bytes = number_of(set, "texture.cache.bytes");
  constexpr std::int64_t kMostLines = 512;  // more take minutes
  if (bytes < line * number_of(set, "texture.cache.ways") || bytes > line * kMostLines)
    return false;
  const std::string axes = set.find("texture.axes")->text();
  return number_of(set, "texture.axis_clocks") <= (axes == "two" ? 1 : axes == "four" ? 2 : 4);
}

}  // namespace

RandomDraws texture_draws() {
  RandomDraws all;
  all.draws = {{"sampler.lod_bias", evenly<-1600, 1600>},
               {"sampler.min_lod", evenly<0, 1600>},
               {"sampler.max_lod", evenly<0, 4000>},
               {"texture.cache.bytes", power_of_two<8, 16>},
               {"texture.cache.line_bytes", power_of_two<5, 7>},
               {"texture.cache.ways", power_of_two<0, 3>},
               {"texture.cache.fifo_depth", magnitude<2, 300>},
               {"texture.axis_clocks", power_of_two<0, 2>}};
  // A file; and what is of frames behind each other, by the golden model alone.
  all.fixed = {"scene.fragments", "sequence.frames", "sequence.motion"};
  all.wanted = {can_be_built};
  return all;
}

}  // namespace deburr::tb
