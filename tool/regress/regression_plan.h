// SPDX-License-Identifier: MIT
// A testplan's points: each feature's configurations, each with its seeds.
//
//   OUT/regressions/NAME-SEED/         plan.json and points.jsonl as of a sweep; junit.xml,
//                                      regression.json and index.html
//   OUT/regressions/NAME-SEED/waves/   the same of the failures that are run again with waves
//   OUT/points/, OUT/cache/            shared with all sweeps under OUT
//
// Every random choice of a point follows from the base seed and the point's own name, so a point
// is the same whatever else the testplan has.
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
// Of those runs of it that leave waves.
SweepPlace waves_place_of(const SweepPlace& regression);

// The day of the world (UTC) as YYYYMMDD.
std::uint64_t seed_of_today();
// What `purpose` of a point is seeded with.
std::uint64_t derived_seed(std::uint64_t base_seed, std::string_view point,
                           std::string_view purpose);

// Where a point comes from: what its sample says.
struct PointOrigin {
  std::string feature, stimulus, configuration, index;
  // "texture-rules/presets/texture.preset=paper/3"
  std::string name() const;
};
PointOrigin origin_of(const PlannedPoint& point);

// Expands the testplan into the place, unless the plan there was made from the same. ConfigError
// for a stimulus without points, and for points that the engine rejects.
Plan make_regression_plan(const Testplan& testplan, std::uint64_t base_seed,
                          const SweepPlace& place);

}  // namespace deburr::tool
