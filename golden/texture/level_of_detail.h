// SPDX-License-Identifier: MIT
// Number of samples, mip level, level fraction and filter of a fragment.
//
// Between the logarithms and the sample walker (paper 004, sections 1.1 and 1.3, equations 3 and
// 12; count = any follows Vulkan's rule and is an extension of this project). Pure function of
// integers; docs/reference/texture/formats.md, "Level and count".
#pragma once

#include <cstdint>

#include "spec/texture/descriptor.h"
#include "spec/texture/parameters.h"

namespace deburr::golden::texture {

struct LevelOfDetail {
  std::int32_t lb_d_max = 0, lb_d_min = 0;  // S5.12, S6.12
  std::int32_t anisotropy = 0;              // L, U6.12: lb(d_max / d_min), at least 0
  std::int32_t sampled = 0;                 // E, U3.12: the part of L that is covered by samples
  int samples = 1;                          // N, 1..16
  std::int32_t l = 0;                       // S8.12, after bias and clamp
  bool magnified = false;                   // l <= 0: level 0 with the magnification filter
  bool linear = false;                      // 2 x 2 texels per request, else the nearest one
  int level = 0;                            // level of the first request of a sample
  std::uint32_t fraction = 0;               // U0.8, weight of level + 1; 0: one request per sample

  int requests_per_sample() const { return fraction == 0 ? 1 : 2; }
  friend bool operator==(const LevelOfDetail&, const LevelOfDetail&) = default;
};

// lb_d_max and lb_d_min: from axis_logarithms(). The descriptor must be valid.
LevelOfDetail select_level(const spec::texture::Parameters& parameters,
                           const spec::texture::Descriptor& descriptor, std::int32_t lb_d_max,
                           std::int32_t lb_d_min);

}  // namespace deburr::golden::texture
