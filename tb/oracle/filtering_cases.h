// SPDX-License-Identifier: MIT
// The fragments that filters are checked with: quads that each have their own affine map from
// pixels to the texture, with footprints of every size, shape and direction.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "golden/ideal/filtering_criterion.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/packets.h"

namespace deburr::tb::texture {

// The texture sizes of Khronos's tests.
struct Size {
  int width, height;
};
inline constexpr Size kFilteringSizes[] = {{4, 8}, {32, 64}, {128, 128},
                                           {3, 7}, {31, 55}, {127, 99}};

// `count` quads for a texture of the given size, their coordinates within -4..4: footprints along u
// alone, along v alone, square, rotated, sheared, magnified, mirrored and close to the thresholds
// of the level of detail, in turns. The levels of detail, `lod_bias` included, sweep -3 .. last
// level + 1.
std::vector<spec::texture::Quad> filtering_quads(const Size& size, int count, std::uint32_t seed,
                                                 double lod_bias = 0.0);

// A lane with its own row's and column's differences as derivatives, without rounding.
golden::ideal::Fragment fragment_of(const spec::texture::Quad& quad, int lane);

// The sampler state of a descriptor, in real numbers.
golden::ideal::Sampler sampler_of(const spec::texture::Descriptor& descriptor);

}  // namespace deburr::tb::texture
