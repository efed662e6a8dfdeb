// SPDX-License-Identifier: MIT
#include "tb/engines/geometric/geometric_maps.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace deburr::tb {
namespace {

enum : std::size_t { kLines, kPassed, kWeight, kDepthReads };

}  // namespace

void GeometricMaps::begin(int width, int height) {
  maps_ = {
      PictureMap("lines", "Lines", "lines",
                 "Lines that cross a pixel and would blend it: candidates.", width, height),
      PictureMap("passed", "Passed", "lines", "Of these, those that passed the depth test.", width,
                 height),
      PictureMap("weight", "Weight", "of 256",
                 "Share of its neighbours that a pixel took, all together.", width, height),
      PictureMap("depth_reads", "Depth misses", "lines",
                 "Times that the line of memory with the pixel's depth was read.", width, height)};
  for (PictureMap& map : maps_) std::fill(map.values.begin(), map.values.end(), 0.0F);
}

void GeometricMaps::see(const spec::geometric::Candidate& candidate) {
  if (maps_.empty()) return;
  maps_[kLines].add(candidate.x, candidate.y, 1);
  if (candidate.passed) maps_[kPassed].add(candidate.x, candidate.y, 1);
}

void GeometricMaps::see(const spec::geometric::BlockRecord& block) {
  if (maps_.empty()) return;
  for (int i = 0; i < 16; ++i) {
    if (!(block.blended >> i & 1)) continue;
    const auto& weights = block.weights[static_cast<std::size_t>(i)];
    maps_[kWeight].set(4 * block.x + i % 4, 4 * block.y + i / 4,
                       std::accumulate(weights.begin(), weights.end(), 0));
  }
}

std::vector<PictureMap> GeometricMaps::maps(
    const rtl::geometric::GeometricEngine& engine,
    const std::function<std::uint64_t(int x, int y)>& line_of, std::span<const std::uint64_t> reads,
    bool only_frame) const {
  std::vector<PictureMap> all = maps_;
  if (all.empty()) return all;
  PictureMap& depth = all[kDepthReads];
  struct Line {
    std::uint64_t reads = 0;
    bool counted = false;
  };
  std::map<std::uint64_t, Line> lines;
  for (const std::uint64_t address : reads) ++lines[address].reads;
  std::uint64_t mapped = 0;
  for (int y = 0; y < depth.height; ++y)
    for (int x = 0; x < depth.width; ++x) {
      const auto found = lines.find(line_of(x, y));
      if (found == lines.end()) continue;
      depth.set(x, y, static_cast<double>(found->second.reads));
      if (!found->second.counted) mapped += found->second.reads;
      found->second.counted = true;
    }
  if (!only_frame) return all;
  const spec::geometric::Work work = engine.work();
  const auto account = [&](std::size_t map, const char* of, std::uint64_t counted, double sum) {
    all[map].account = {of, static_cast<double>(counted), sum};
  };
  account(kLines, "work.coverage_unit_candidates", work.candidates, all[kLines].sum());
  account(kPassed, "work.depth_test_passed", work.passed, all[kPassed].sum());
  account(kWeight, "the number of blended pixels", work.blended_pixels,
          static_cast<double>(all[kWeight].pixels_above_zero()));
  account(kDepthReads, "work.depth_test_misses", engine.depth_test.misses.value(),
          static_cast<double>(mapped));
  return all;
}

}  // namespace deburr::tb
