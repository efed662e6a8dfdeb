// SPDX-License-Identifier: MIT
// The vectors of SMAA's contract (docs/morphological_smaa.md): pixels by hash, work by number,
// whatever the lanes, the storage, the stalls or the order of evaluation.
#include <functional>
#include <string>
#include <vector>

#include "tb/unit/rtl/morphological/support.h"

namespace deburr::tb::morphological_rtl::smaa_vectors_test {
namespace {

using namespace spec::morphological;  // NOLINT: a test of these

struct Vector {
  const char* name;
  Frame (*image)();
  std::function<Parameters()> parameters;
  std::uint64_t hash;
  std::uint64_t edges, runs, long_runs, taken, blended;
};

Frame noise_image() { return noise(); }
Frame line_image() { return line(); }
Frame blocks_image() { return blocks(); }
Frame shades_image() { return stimuli::shades_image(90, 80); }

std::function<Parameters()> quality(Quality which) {
  return [which] { return smaa(which); };
}
std::function<Parameters()> high(std::function<void(Parameters&)> change) {
  return [change] {
    Parameters p = smaa();
    change(p);
    return p;
  };
}
std::function<Parameters()> dynamic(std::function<void(Parameters&)> change) {
  return [change] {
    Parameters p = smaa(Quality::kHigh, Preset::kSmaaDynamic);
    change(p);
    return p;
  };
}
void as_it_is(Parameters&) {}
// alpha of 0.8 with the smallest floor.
std::function<Parameters()> luma_rule(DynamicLuma rule) {
  return dynamic([rule](Parameters& p) {
    p.dynamic_luma = rule;
    p.alpha = 52429;
    p.floor = 1;
  });
}

const std::vector<Vector>& vectors() {
  static const std::vector<Vector> all = {
      {"noise_low", noise_image, quality(Quality::kLow), 0x605145727a436382, 4407, 4436, 0, 0,
       3623},
      {"noise_medium", noise_image, quality(Quality::kMedium), 0x605145727a436382, 4407, 4436, 0, 0,
       3623},
      {"noise_high", noise_image, quality(Quality::kHigh), 0x3d8c8d3867fd2bcc, 4407, 4436, 0, 233,
       3645},
      {"noise_ultra", noise_image, quality(Quality::kUltra), 0x3d8c8d3867fd2bcc, 4407, 4436, 0, 233,
       3645},
      {"line_low", line_image, quality(Quality::kLow), 0x6d7640674377e6eb, 436, 243, 0, 0, 491},
      {"line_medium", line_image, quality(Quality::kMedium), 0x5729d03a1f181768, 436, 243, 0, 0,
       491},
      {"line_high", line_image, quality(Quality::kHigh), 0x1038e74b0d3dfd71, 436, 243, 0, 44, 480},
      {"line_ultra", line_image, quality(Quality::kUltra), 0x1038e74b0d3dfd71, 436, 243, 0, 44,
       480},
      {"blocks_low", blocks_image, quality(Quality::kLow), 0x21fbea358d934b64, 1549, 1127, 0, 0,
       1331},
      {"blocks_medium", blocks_image, quality(Quality::kMedium), 0xe378f8a6cdf4e692, 1549, 1127, 0,
       0, 1371},
      {"blocks_high", blocks_image, quality(Quality::kHigh), 0x7091425e2ea8d179, 1549, 1127, 0, 4,
       1372},
      {"blocks_ultra", blocks_image, quality(Quality::kUltra), 0x8e93f1ba695ffc8a, 1808, 1331, 0, 8,
       1608},
      {"blocks_dynamic", blocks_image, dynamic(as_it_is), 0x8954dcb4dfbc0839, 1698, 1232, 0, 4,
       1502},
      {"blocks_longest", blocks_image, high([](auto& p) { p.blend = BlendRule::kLongest; }),
       0x3394fabdc8ce9a00, 1549, 1127, 0, 4, 1372},
      {"blocks_codes", blocks_image, high([](auto& p) { p.linear_light = false; }),
       0x04a67b4d5a8b7973, 1549, 1127, 0, 4, 1372},
      {"blocks_analytic", blocks_image, high([](auto& p) { p.area = AreaSource::kAnalytic; }),
       0xc0ea4a726d0468d5, 1549, 1127, 0, 4, 1311},
      {"blocks_runs_alone", blocks_image,
       high([](auto& p) { p.diagonals = p.round_corners = false; }), 0x475b72ab303e54ac, 1549, 1127,
       0, 0, 1376},
      {"blocks_gaps", blocks_image, high([](auto& p) { p.ends = Ends::kGaps; }), 0x3695452169102f8d,
       1549, 1034, 0, 4, 1283},
      {"blocks_small", blocks_image, high([](auto& p) {
         p.window_rows = 20;
         p.reach_columns = 9;
         p.diagonal_steps = 8;
       }),
       0x318127a57f0754f1, 1549, 1127, 13, 4, 1269},
      {"blocks_blunt", blocks_image, high([](auto& p) { p.corner_rounding = 256; }),
       0xcd1f206fe12a7f9f, 1549, 1127, 0, 4, 1376},
      {"blocks_mlaa", blocks_image,
       [] {
         Parameters p = preset(Preset::kMlaa);
         p.ends = Ends::kCrossings;
         p.diagonals = p.round_corners = true;
         p.diagonal_steps = 16;
         return p;
       },
       0x79094ad57908c708, 1595, 1179, 0, 4, 1407},
      {"blocks_paper", blocks_image,
       high([](auto& p) { p.local_contrast = LocalContrast::kPaper; }), 0x7091425e2ea8d179, 1549,
       1127, 0, 4, 1372},
      {"blocks_few_steps", blocks_image,
       [] {
         Parameters p = smaa(Quality::kUltra);
         p.search_steps = 1;
         p.diagonal_steps = 2;
         return p;
       },
       0x890ac47d7405b8c7, 1808, 1331, 0, 2, 1407},
      {"shades_high", shades_image, quality(Quality::kHigh), 0x707dcf0adeff2653, 722, 233, 0, 0,
       740},
      {"shades_514", shades_image, high([](auto& p) { p.threshold = 514; }), 0x6efbd85401fe9778,
       1763, 745, 0, 0, 1446},
      {"shades_514_paper", shades_image, high([](auto& p) {
         p.threshold = 514;
         p.local_contrast = LocalContrast::kPaper;
       }),
       0xcbdfbd0fa8c57f10, 1750, 739, 0, 0, 1455},
      {"shades_dynamic", shades_image, dynamic(as_it_is), 0xcbdfbd0fa8c57f10, 1750, 739, 0, 0,
       1455},
      {"shades_dynamic_floor", shades_image, dynamic([](auto& p) { p.floor = 1; }),
       0x2a0a4529eba2b538, 2771, 1813, 0, 19, 2203},
      {"shades_dynamic_alpha", shades_image, dynamic([](auto& p) { p.alpha = 13107; }),
       0x09daa7e5f48a7931, 1596, 663, 0, 0, 1353},
      {"shades_current", shades_image, luma_rule(DynamicLuma::kCurrent), 0x86b25eb49b0d2fee, 1233,
       837, 0, 10, 893},
      {"shades_max", shades_image, luma_rule(DynamicLuma::kMax), 0xba424a04a7396185, 901, 531, 0, 6,
       603},
      {"shades_min", shades_image, luma_rule(DynamicLuma::kMin), 0x1a3348ed21c1d79c, 2068, 1224, 0,
       15, 1672},
      {"shades_mean", shades_image, luma_rule(DynamicLuma::kMean), 0x5e97e28f2b5f7944, 1661, 826, 0,
       6, 1330}};
  return all;
}

void check(const Vector& v, const Parameters& p, EngineBench::Options options) {
  EngineBench bench(p, std::move(options));
  const Frame in = v.image();
  const Frame out = bench.run(in);
  const Work work = bench.engine.work();
  EXPECT_EQ(work.edge_pixels, v.edges);
  EXPECT_EQ(work.horizontal_runs + work.vertical_runs, v.runs);
  EXPECT_EQ(work.long_runs, v.long_runs);
  EXPECT_EQ(work.diagonal_pixels, v.taken);
  EXPECT_EQ(work.blended_pixels, v.blended);
  EXPECT_EQ(work.pixels, in.pixel.size());
  EXPECT_EQ(hash(out), v.hash);
}

class SmaaVectors : public ::testing::TestWithParam<std::size_t> {
 protected:
  const Vector& vector() const { return vectors()[GetParam()]; }
};

TEST_P(SmaaVectors, OneLane) { check(vector(), vector().parameters(), {}); }

TEST_P(SmaaVectors, FourLanesStalledShuffled) {
  Parameters p = vector().parameters();
  p.lanes = Lanes::kFour;
  EngineBench::Options options;
  options.bench.stall_permille = 100;
  options.bench.seed = 3 + GetParam();
  options.bench.shuffle = 17;
  check(vector(), p, options);
}

TEST_P(SmaaVectors, TwoLanesFromMemory) {
  Parameters p = vector().parameters();
  p.lanes = Lanes::kTwo;
  p.storage = Storage::kMemory;
  EngineBench::Options options;
  options.memory_latency = 15;
  options.memory_scatter = 40;
  options.sink = {300, 5};
  check(vector(), p, options);
}

// The layouts of the table give the same pixels.
TEST_P(SmaaVectors, MergedTable) {
  Parameters p = vector().parameters();
  if (p.area != AreaSource::kAnalytic) p.area = AreaSource::kTableMerged;
  p.lanes = Lanes::kTwo;
  check(vector(), p, {});
}

TEST_P(SmaaVectors, MinimalTable) {
  Parameters p = vector().parameters();
  if (p.area != AreaSource::kAnalytic) p.area = AreaSource::kTableMinimal;
  p.lanes = Lanes::kFour;
  check(vector(), p, {});
}

INSTANTIATE_TEST_SUITE_P(Contract, SmaaVectors, ::testing::Range(std::size_t{0}, vectors().size()),
                         [](const auto& param) { return vectors()[param.param].name; });

}  // namespace
}  // namespace deburr::tb::morphological_rtl::smaa_vectors_test
