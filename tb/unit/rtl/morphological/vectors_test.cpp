// SPDX-License-Identifier: MIT
// The test vectors of the contract (spec/morphological/vectors.h): the hash of the pixels and the
// work counters, for every number of lanes, storage, stall pattern and evaluation order.
#include "tb/unit/rtl/morphological/vectors.h"

#include <string>
#include <utility>

#include "tb/base/sanitized.h"
#include "tb/unit/rtl/morphological/support.h"

namespace deburr::tb::morphological_rtl::vectors_test {
namespace {

using spec::morphological::AreaSource;
using spec::morphological::FrameResult;
using spec::morphological::FrameVector;
using spec::morphological::Lanes;
using spec::morphological::Preset;
using spec::morphological::Quality;

Parameters parameters_of(const FrameVector& v) {
  Parameters p = preset_parameters(v.preset, v.quality);
  apply_settings(p, v.settings);
  return p;
}

FrameResult result_of(const FrameVector& v, const Parameters& p, EngineBench::Options options) {
  EngineBench bench(p, std::move(options));
  const Frame in = morphological::vector_image(v.image);
  const Frame out = bench.run(in);
  const spec::morphological::Work w = bench.engine.work();
  EXPECT_EQ(w.pixels, in.pixel.size());
  return {hash(out),        w.edge_pixels,    w.horizontal_runs + w.vertical_runs,
          w.long_runs,      w.z_runs,         w.extended_runs,
          w.steps,          w.probes,         w.diagonal_pixels,
          w.blended_pixels, w.bypassed_pixels};
}

class Vectors : public ::testing::TestWithParam<FrameVector> {
 protected:
  void check(const Parameters& p, EngineBench::Options options) {
    EXPECT_EQ(differences(GetParam().result, result_of(GetParam(), p, std::move(options))), "");
  }
};

TEST_P(Vectors, OneLane) { check(parameters_of(GetParam()), {}); }

TEST_P(Vectors, FourLanesWithStallsAndShuffle) {
  Parameters p = parameters_of(GetParam());
  p.lanes = Lanes::kFour;
  EngineBench::Options options;
  options.bench.stall_permille = 100;
  options.bench.seed = 3 + GetParam().result.hash % 1000;
  options.bench.shuffle = 17;
  check(p, options);
}

TEST_P(Vectors, TwoLanesFromMemory) {
  Parameters p = parameters_of(GetParam());
  p.lanes = Lanes::kTwo;
  p.storage = spec::morphological::Storage::kMemory;
  EngineBench::Options options;
  options.memory_latency = 15;
  options.memory_scatter = 40;
  options.sink = {300, 5};
  check(p, options);
}

std::string name_of(const ::testing::TestParamInfo<FrameVector>& test) {
  return std::string(test.param.name);
}

INSTANTIATE_TEST_SUITE_P(Contract, Vectors,
                         ::testing::ValuesIn(third_if_sanitized(morphological::frame_vectors())),
                         name_of);

TEST(FrameVectors, EachValueIsCompared) {
  const FrameVector v = morphological::frame_vector("blocks_slope");
  expect_each_value_is_compared(v.result, result_of(v, parameters_of(v), {}));
}

// All layouts of the table give the same pixels.
class SmaaVectors : public Vectors {};

TEST_P(SmaaVectors, MergedTable) {
  Parameters p = parameters_of(GetParam());
  if (p.area != AreaSource::kAnalytic) p.area = AreaSource::kTableMerged;
  p.lanes = Lanes::kTwo;
  check(p, {});
}

TEST_P(SmaaVectors, MinimalTable) {
  Parameters p = parameters_of(GetParam());
  if (p.area != AreaSource::kAnalytic) p.area = AreaSource::kTableMinimal;
  p.lanes = Lanes::kFour;
  check(p, {});
}

INSTANTIATE_TEST_SUITE_P(
    Contract, SmaaVectors,
    ::testing::ValuesIn(third_if_sanitized(spec::morphological::kSmaaFrameVectors)), name_of);

// ---- SMAA: patterns, and the limit of the searches ----------------------------------------------

class Patterns : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Patterns, ResultMatchesTheContract) {
  const spec::morphological::PatternVector& v = spec::morphological::kPatternVectors[GetParam()];
  EngineBench bench(smaa(v.quality));
  const Frame out = bench.run(morphological::vector_image(v));
  const spec::morphological::PatternResult got = {hash(out), bench.engine.work().diagonal_pixels};
  EXPECT_EQ(differences(v.result, got), "") << v.name;
  expect_each_value_is_compared(v.result, got);
}

INSTANTIATE_TEST_SUITE_P(Contract, Patterns,
                         ::testing::Range(std::size_t{0},
                                          spec::morphological::kPatternVectors.size()));

class SearchLimits : public ::testing::TestWithParam<std::size_t> {};

TEST_P(SearchLimits, ResultMatchesTheContract) {
  const spec::morphological::LimitVector& v = spec::morphological::kLimitVectors[GetParam()];
  EngineBench bench(smaa(Quality::kLow));
  const spec::morphological::LimitResult got = {hash(bench.run(morphological::vector_image(v)))};
  EXPECT_EQ(differences(v.result, got), "") << v.length;
  expect_each_value_is_compared(v.result, got);
}

INSTANTIATE_TEST_SUITE_P(Contract, SearchLimits,
                         ::testing::Range(std::size_t{0},
                                          spec::morphological::kLimitVectors.size()));

}  // namespace
}  // namespace deburr::tb::morphological_rtl::vectors_test
