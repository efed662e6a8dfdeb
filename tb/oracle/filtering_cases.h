// SPDX-License-Identifier: MIT
// Test fragments for filters: quads with their own affine map from pixels to the texture, with
// footprints of every size, shape and direction.
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

// Makes `count` quads for a texture of the given size, with coordinates within -4..4. Footprints
// alternate between along u only, along v only, square, rotated, sheared, magnified, mirrored and
// close to the thresholds of the level of detail. The levels of detail, including `lod_bias`, sweep
// -3 .. last level + 1.
std::vector<spec::texture::Quad> filtering_quads(const Size& size, int count, std::uint32_t seed,
                                                 double lod_bias = 0.0);

// A lane's fragment; derivatives are unrounded differences in its own row and column.
golden::ideal::Fragment fragment_of(const spec::texture::Quad& quad, int lane);

// A descriptor's sampler state in real numbers.
golden::ideal::Sampler sampler_of(const spec::texture::Descriptor& descriptor);

}  // namespace deburr::tb::texture
