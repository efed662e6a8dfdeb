// SPDX-License-Identifier: MIT
// What the golden texture unit expects of a scene, made once for several runs: colours and line
// fills in order, and the counters at the end.
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
  struct Behind {  // a quad: so many there are by then
    std::size_t colours = 0, fills = 0;
  };
  std::vector<Behind> behind;
  std::vector<spec::texture::Colour> colours;
  std::vector<std::uint32_t> fills;  // line numbers
  golden::texture::TextureWork work;
};

// Of memory without errors.
TextureExpectation expected_of(const TextureScene& scene,
                               const spec::texture::Parameters& parameters);

}  // namespace deburr::tb
