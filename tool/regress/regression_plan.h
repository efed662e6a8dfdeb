// SPDX-License-Identifier: MIT
// The points of a testplan: the configurations of each feature, each with its seeds.
//
//   OUT/regressions/NAME-SEED/         plan.json and points.jsonl as for a sweep; junit.xml,
//                                      regression.json and index.html
//   OUT/regressions/NAME-SEED/waves/   the same for failures repeated with waveforms
//   OUT/points/, OUT/cache/            shared with all sweeps under OUT
//
// Every random choice of a point is derived from the base seed and the point's name, so a point
// does not depend on the rest of the testplan.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "tool/regress/testplan.h"
#include "tool/sweep/plan.h"

namespace deburr::tool {

SweepPlace regression_place_of(const std::filesystem::path& out, const std::string& name,
                               std::uint64_t base_seed);
// The directory of runs repeated with waveforms.
SweepPlace waves_place_of(const SweepPlace& regression);

// Today's date (UTC) as YYYYMMDD.
std::uint64_t seed_of_today();
// The seed of `purpose` for a point.
std::uint64_t derived_seed(std::uint64_t base_seed, std::string_view point,
                           std::string_view purpose);

// The origin of a point, from its sample.
struct PointOrigin {
  std::string feature, stimulus, configuration, index;
  // "texture-rules/presets/texture.preset=paper/3"
  std::string name() const;
};
PointOrigin origin_of(const PlannedPoint& point);

// Expands the testplan and stores the plan at the place, unless an identical plan is already there.
// ConfigError if a stimulus has no points or the engine rejects a point.
Plan make_regression_plan(const Testplan& testplan, std::uint64_t base_seed,
                          const SweepPlace& place);

}  // namespace deburr::tool
