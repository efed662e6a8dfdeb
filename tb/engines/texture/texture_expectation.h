// SPDX-License-Identifier: MIT
// Golden results of a scene, computed once for several runs: colours and line fills in order, and
// the final counters.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "golden/texture/texture_golden.h"
#include "spec/texture/packets.h"
#include "spec/texture/parameters.h"
#include "tb/engines/texture/texture_scene.h"

namespace deburr::tb {

struct TextureExpectation {
  struct Totals {  // number of colours and fills after a quad
    std::size_t colours = 0, fills = 0;
  };
  std::vector<Totals> totals;  // per quad
  std::vector<spec::texture::Colour> colours;
  std::vector<std::uint32_t> fills;  // lines that are requested from memory
  golden::texture::TextureWork work;
};

// For a memory without errors.
TextureExpectation expected_of(const TextureScene& scene,
                               const spec::texture::Parameters& parameters);

}  // namespace deburr::tb
