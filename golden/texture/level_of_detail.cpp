// SPDX-License-Identifier: MIT
#include "golden/texture/level_of_detail.h"

#include <algorithm>

#include "spec/texture/tables.h"

namespace deburr::golden::texture {
namespace {

constexpr std::int32_t kOneLevel = 1 << 12;  // in the 12 fraction bits of l

std::int32_t whole_levels_up(std::int32_t x) { return (x + kOneLevel - 1) >> 12 << 12; }

// E: the part of the anisotropy L that is covered by samples.
std::int32_t sampled_part(const spec::texture::Parameters& parameters,
                          const spec::texture::Descriptor& descriptor, std::int32_t lb_d_max,
                          std::int32_t anisotropy) {
  if (lb_d_max <= 0) return 0;
  std::int32_t wanted = anisotropy;
  std::int32_t texels = lb_d_max;  // limit of count_cap = texel
  switch (parameters.count) {
    case spec::texture::CountRule::kFloor:
      wanted = anisotropy >> 12 << 12;
      texels = whole_levels_up(lb_d_max);
      break;
    case spec::texture::CountRule::kCeil:
      wanted = whole_levels_up(anisotropy);
      texels = whole_levels_up(lb_d_max);
      break;
    case spec::texture::CountRule::kAny:
      break;
  }
  wanted = std::min(wanted, descriptor.max_anisotropy_log2 * kOneLevel);
  if (parameters.count_cap == spec::texture::CountCap::kTexel) wanted = std::min(wanted, texels);
  return wanted;
}

// The smallest N with lb N >= E.
int samples_for(std::int32_t sampled) {
  int n = 1;
  while (n < 16 && sampled > spec::texture::kLog2Count[static_cast<std::size_t>(n)]) ++n;
  return n;
}

bool filters_linearly(spec::texture::MinFilter filter) {
  return filter == spec::texture::MinFilter::kLinear ||
         filter == spec::texture::MinFilter::kLinearMipmapNearest ||
         filter == spec::texture::MinFilter::kLinearMipmapLinear;
}

// The level and filter of a fragment with the level of detail l.
void choose_level(const spec::texture::Descriptor& descriptor, LevelOfDetail& result) {
  result.magnified = result.l <= 0;
  if (result.magnified) {
    result.linear = descriptor.mag_filter == spec::texture::MagFilter::kLinear;
    return;
  }
  result.linear = filters_linearly(descriptor.min_filter);
  const int last = descriptor.levels - 1;
  switch (descriptor.min_filter) {
    case spec::texture::MinFilter::kNearest:
    case spec::texture::MinFilter::kLinear:
      break;
    case spec::texture::MinFilter::kNearestMipmapNearest:
    case spec::texture::MinFilter::kLinearMipmapNearest:
      result.level = std::min((result.l + kOneLevel / 2 - 1) >> 12, last);
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
}

}  // namespace

LevelOfDetail select_level(const spec::texture::Parameters& parameters,
                           const spec::texture::Descriptor& descriptor, std::int32_t lb_d_max,
                           std::int32_t lb_d_min) {
  LevelOfDetail result;
  result.lb_d_max = lb_d_max;
  result.lb_d_min = lb_d_min;
  result.anisotropy = std::max(lb_d_max - lb_d_min, 0);
  result.sampled = sampled_part(parameters, descriptor, lb_d_max, result.anisotropy);
  result.samples = samples_for(result.sampled);

  const std::int32_t low = descriptor.min_lod * 16, high = descriptor.max_lod * 16;
  result.l = lb_d_max - result.sampled + descriptor.lod_bias * 16;
  result.l = std::min(std::max(result.l, low), high);

  choose_level(descriptor, result);
  // Every sample of a level of 1 x 1 texels would be the same texel.
  if (std::max(descriptor.width, descriptor.height) >> result.level <= 1) result.samples = 1;
  return result;
}

}  // namespace deburr::golden::texture
