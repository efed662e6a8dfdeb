// SPDX-License-Identifier: MIT
#include "golden/texture/level_of_detail.h"

#include <algorithm>

namespace deburr::golden::texture {
namespace {

constexpr std::int32_t kOne = 1 << 12;  // one level, in the 12 fraction bits of l

int log2_of_count(const spec::texture::Parameters& parameters,
                  const spec::texture::Descriptor& descriptor, std::int32_t lb_d_max,
                  std::int32_t anisotropy) {
  if (lb_d_max <= 0) return 0;
  const std::int32_t up = parameters.count == spec::texture::CountRule::kCeil ? kOne - 1 : 0;
  std::int32_t lb_n = (anisotropy + up) >> 12;
  lb_n = std::min<std::int32_t>(lb_n, descriptor.max_anisotropy_log2);
  if (parameters.count_cap == spec::texture::CountCap::kTexel) {
    lb_n = std::min(lb_n, (lb_d_max + kOne - 1) >> 12);
  }
  return lb_n;
}

bool filters_linearly(spec::texture::MinFilter filter) {
  return filter == spec::texture::MinFilter::kLinear ||
         filter == spec::texture::MinFilter::kLinearMipmapNearest ||
         filter == spec::texture::MinFilter::kLinearMipmapLinear;
}

}  // namespace

LevelOfDetail select_level(const spec::texture::Parameters& parameters,
                           const spec::texture::Descriptor& descriptor, std::int32_t lb_d_max,
                           std::int32_t lb_d_min) {
  LevelOfDetail result;
  result.lb_d_max = lb_d_max;
  result.lb_d_min = lb_d_min;
  result.anisotropy = std::max(lb_d_max - lb_d_min, 0);
  result.lb_n = log2_of_count(parameters, descriptor, lb_d_max, result.anisotropy);

  const std::int32_t low = descriptor.min_lod * 16, high = descriptor.max_lod * 16;
  result.l = lb_d_max - result.lb_n * kOne + descriptor.lod_bias * 16;
  result.l = std::min(std::max(result.l, low), high);

  result.magnified = result.l <= 0;
  if (result.magnified) {
    result.linear = descriptor.mag_filter == spec::texture::MagFilter::kLinear;
    return result;
  }
  result.linear = filters_linearly(descriptor.min_filter);
  const int last = descriptor.levels - 1;
  switch (descriptor.min_filter) {
    case spec::texture::MinFilter::kNearest:
    case spec::texture::MinFilter::kLinear:
      break;
    case spec::texture::MinFilter::kNearestMipmapNearest:
    case spec::texture::MinFilter::kLinearMipmapNearest:
      result.level = std::min((result.l + kOne / 2 - 1) >> 12, last);
      break;
    case spec::texture::MinFilter::kNearestMipmapLinear:
    case spec::texture::MinFilter::kLinearMipmapLinear: {
      const std::int32_t l8 = (result.l + 8) >> 4;
      result.level = l8 >> 8;
      result.fraction = static_cast<std::uint32_t>(l8 & 255);
      if (result.level >= last) {
        result.level = last;
        result.fraction = 0;
      }
      break;
    }
  }
  return result;
}

}  // namespace deburr::golden::texture
