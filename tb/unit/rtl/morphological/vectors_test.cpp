// SPDX-License-Identifier: MIT
// The contract's test vectors (docs/number_formats_morphological.md): pixels by hash, work by
// number, whatever the lanes, the storage, the stalls or the order of evaluation.
#include "tb/unit/rtl/morphological/support.h"

namespace deburr::tb::morphological_rtl::vectors_test {
namespace {

using spec::morphological::Preset;

struct Vector {
  const char* name;
  Frame (*image)();
  Preset preset;
  int reach_rows, reach_columns;
  std::function<void(Parameters&)> change;
  std::uint64_t hash;
  std::uint64_t runs, long_runs, z_runs, extended, steps, probes, blended;
};

void nothing(Parameters&) {}

Frame noise_image() { return noise(); }
Frame line_image() { return line(); }
Frame blocks_image() { return blocks(); }

const std::vector<Vector>& vectors() {
  static const std::vector<Vector> all = {
      {"noise_mlaa", noise_image, Preset::kMlaa, 32, 256, nothing, 0x00b097db028f25fd,
       2958, 0, 1390, 0, 0, 0, 3175},
      {"noise_slope", noise_image, Preset::kMlaaSlope, 32, 256, nothing,
       0x6c40266cf03f3513, 2958, 0, 1390, 671, 1062, 9200, 3282},
      {"noise_deburr_line", noise_image, Preset::kDeburrLine, 32, 256, nothing,
       0x2820122eb9f04a52, 2958, 0, 1390, 10, 10, 7378, 3178},
      {"noise_deburr_line_codes", noise_image, Preset::kDeburrLine, 32, 256,
       [](auto& p) { p.linear_light = false; }, 0x8a5e9cf3676d7e0d, 2958, 0, 1390, 10, 10, 7378, 3178},
      {"line_mlaa", line_image, Preset::kMlaa, 32, 256, nothing, 0x5d62265609239471,
       241, 0, 232, 0, 0, 0, 418},
      {"line_slope", line_image, Preset::kMlaaSlope, 32, 256, nothing,
       0x75ccf871d174feaf, 241, 0, 232, 162, 871, 2560, 457},
      {"line_deburr_line", line_image, Preset::kDeburrLine, 32, 256, nothing,
       0x736d3ffd8a940ba4, 241, 0, 232, 128, 584, 2832, 425},
      {"line_deburr_line_16", line_image, Preset::kDeburrLine, 32, 256,
       [](auto& p) {
         p.steps = 16;
         p.local_contrast = spec::morphological::LocalContrast::kPaper;
       },
       0x460d3c72f9dd7681, 241, 0, 232, 128, 728, 3244, 425},
      {"line_slope_fit", line_image, Preset::kMlaaSlope, 32, 256,
       [](auto& p) { p.predictor = spec::morphological::Predictor::kFit; }, 0x60fe73fcc1c70e9f, 241, 0, 232, 162,
       871, 2560, 455},
      {"blocks_mlaa", blocks_image, Preset::kMlaa, 9, 9, nothing, 0xfd1df0fe5908eab2,
       1036, 19, 470, 0, 0, 0, 1186},
      {"blocks_slope", blocks_image, Preset::kMlaaSlope, 9, 9, nothing,
       0x5f03ca34a84ea782, 1036, 19, 470, 238, 626, 4119, 1193},
      {"blocks_deburr_line", blocks_image, Preset::kDeburrLine, 9, 9,
       [](auto& p) { p.steps = 4; }, 0xbc2f9325b6057e5e, 1198, 24, 536, 204, 528, 4235, 1386},
      {"blocks_chord_safe", blocks_image, Preset::kDeburrLine, 9, 9,
       [](auto& p) {
         p.predictor = spec::morphological::Predictor::kChord;
         p.contiguous = false;
         p.trim = false;
         p.threshold = 1311;
         p.steps = 4;
         p.local_contrast = spec::morphological::LocalContrast::kPaper;
         p.linear_light = false;
       },
       0xdda27397e1d7e1a8, 1213, 15, 531, 262, 655, 4442, 1354},
      {"blocks_deburr_line_small", blocks_image, Preset::kDeburrLine, 4, 7,
       [](auto& p) { p.steps = 3; }, 0xa765ccb0279eaaf0, 1198, 28, 536, 204, 314, 3587, 1364},
      {"blocks_slope_wide", blocks_image, Preset::kMlaaSlope, 9, 30,
       [](auto& p) { p.steps = 8; }, 0xdc30d70a15925762, 1036, 14, 470, 239, 1315, 5984, 1268},
      {"blocks_deburr_line_default", blocks_image, Preset::kDeburrLine, 32, 256, nothing,
       0xe86c7f9318eacf5e, 1198, 0, 538, 168, 660, 5382, 1552},
      {"blocks_slope_trim", blocks_image, Preset::kMlaaSlope, 9, 30,
       [](auto& p) {
         p.steps = 8;
         p.trim = true;
       },
       0x4a46970faa1de0ac, 1036, 14, 470, 180, 992, 5984, 1276}};
  return all;
}

Parameters parameters_of(const Vector& v) {
  Parameters p = preset(v.preset, v.reach_rows, v.reach_columns);
  v.change(p);
  return p;
}

void check(const Vector& v, const Parameters& p, EngineBench::Options options) {
  EngineBench bench(p, std::move(options));
  const Frame in = v.image();
  const Frame out = bench.run(in);
  const spec::morphological::Work work = bench.engine.work();
  EXPECT_EQ(work.horizontal_runs + work.vertical_runs, v.runs);
  EXPECT_EQ(work.long_runs, v.long_runs);
  EXPECT_EQ(work.z_runs, v.z_runs);
  EXPECT_EQ(work.extended_runs, v.extended);
  EXPECT_EQ(work.steps, v.steps);
  EXPECT_EQ(work.probes, v.probes);
  EXPECT_EQ(work.blended_pixels, v.blended);
  EXPECT_EQ(work.pixels, in.pixel.size());
  EXPECT_EQ(hash(out), v.hash);
}

class Vectors : public ::testing::TestWithParam<std::size_t> {
 protected:
  const Vector& vector() const { return vectors()[GetParam()]; }
};

TEST_P(Vectors, OneLane) { check(vector(), parameters_of(vector()), {}); }

TEST_P(Vectors, FourLanesStalledShuffled) {
  Parameters p = parameters_of(vector());
  p.lanes = spec::morphological::Lanes::kFour;
  EngineBench::Options options;
  options.bench.stall_permille = 100;
  options.bench.seed = 3 + GetParam();
  options.bench.shuffle = 17;
  check(vector(), p, options);
}

TEST_P(Vectors, TwoLanesFromMemory) {
  Parameters p = parameters_of(vector());
  p.lanes = spec::morphological::Lanes::kTwo;
  p.storage = spec::morphological::Storage::kMemory;
  EngineBench::Options options;
  options.memory_latency = 15;
  options.memory_scatter = 40;
  options.sink = {300, 5};
  check(vector(), p, options);
}

INSTANTIATE_TEST_SUITE_P(Contract, Vectors, ::testing::Range(std::size_t{0}, vectors().size()),
                         [](const auto& param) { return vectors()[param.param].name; });

}  // namespace
}  // namespace deburr::tb::morphological_rtl::vectors_test
