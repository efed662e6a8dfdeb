// SPDX-License-Identifier: MIT
// The vectors of docs/geometric.md: pixels, weights, the lists of accesses and the counts of eight
// configurations.
#include <map>

#include "tb/unit/rtl/geometric/support.h"

namespace deburr::tb::geometric_rtl::vectors_test {
namespace {

// The second table: boundary .. blended.
const std::map<char, std::array<std::uint64_t, 17>>& counts() {
  static const std::map<char, std::array<std::uint64_t, 17>> table = {
      {'a', {164, 63, 29, 20, 12, 12, 247, 5, 1, 15, 226, 6686, 2332, 5953, 4779, 191, 2148}},
      {'b', {164, 63, 29, 20, 12, 12, 247, 5, 1, 15, 226, 6686, 2332, 5953, 4779, 191, 2148}},
      {'c', {164, 63, 29, 20, 12, 12, 247, 5, 1, 15, 226, 6686, 6686, 5953, 4779, 191, 2148}},
      {'d', {164, 63, 29, 20, 12, 12, 247, 5, 1, 15, 226, 6686, 3777, 5953, 4779, 191, 2148}},
      {'e', {164, 63, 29, 16, 16, 12, 243, 5, 1, 15, 222, 6607, 2311, 5861, 4683, 191, 2126}},
      {'f', {166, 0, 0, 0, 0, 4, 296, 5, 1, 18, 272, 8105, 2864, 7264, 5815, 191, 2302}},
      {'g', {164, 63, 29, 0, 32, 12, 227, 5, 1, 15, 206, 6087, 3446, 5390, 3512, 187, 1746}},
      {'h', {166, 0, 0, 0, 0, 4, 296, 5, 1, 18, 272, 8105, 2864, 7264, 7264, 191, 2461}}};
  return table;
}
// Its last columns: vertex, depth, weight lines read; weight lines written; colour read, written.
const std::map<char, std::array<std::size_t, 6>>& traffic() {
  static const std::map<char, std::array<std::size_t, 6>> table = {
      {'a', {50, 722, 438, 438, 579, 191}},     {'b', {50, 1086, 438, 438, 989, 686}},
      {'c', {351, 2347, 1763, 1763, 579, 191}}, {'d', {351, 3949, 1763, 1763, 989, 686}},
      {'e', {50, 707, 421, 421, 535, 191}},     {'f', {50, 871, 539, 539, 574, 191}},
      {'g', {50, 912, 330, 330, 941, 664}},     {'h', {50, 0, 2372, 2372, 1069, 701}}};
  return table;
}

class Vectors : public ::testing::TestWithParam<char> {};

TEST_P(Vectors, PixelsWeightsAndTraffic) {
  const Configuration c = configuration(GetParam());
  EngineOptions options;
  options.bench.check_widths = true;
  EngineBench b(c.p, options);
  b.load(contract_scene());
  b.run();
  const spec::geometric::Work w = b.engine.work();
  EXPECT_EQ(w.edges, 300u);
  EXPECT_THAT(
      (std::array<std::uint64_t, 17>{
          w.boundary_edges, w.silhouette_edges, w.back_edges, w.crease_edges, w.flat_edges,
          w.invalid_edges, w.kept_edges, w.outside_edges, w.degenerate_edges, w.empty_edges,
          w.lines, w.columns, w.groups, w.candidates, w.passed, w.blocks, w.blended_pixels}),
      testing::ElementsAreArray(counts().at(c.name)));
  const std::uint32_t colours = c.p.frame_copy ? b.bases.copy : b.bases.colour;
  EXPECT_THAT(
      (std::array<std::size_t, 6>{b.reads(b.bases.vertices).size(), b.reads(b.bases.depth).size(),
                                  b.reads(b.bases.weights).size(), b.writes(b.bases.weights).size(),
                                  b.reads(colours).size(), b.writes(b.bases.colour).size()}),
      testing::ElementsAreArray(traffic().at(c.name)));
  EXPECT_EQ(b.weight_hash(), c.weights);
  EXPECT_EQ(b.pixel_hash(), c.pixels);
  EXPECT_EQ(b.traffic_hash(), c.traffic);
  RecordProperty("edge_cycles", static_cast<int>(b.bus.read(reg::kEdgeCycles)));
  RecordProperty("resolve_cycles", static_cast<int>(b.bus.read(reg::kResolveCycles)));
}
INSTANTIATE_TEST_SUITE_P(Page, Vectors, ::testing::Values('a', 'b', 'c', 'd', 'e', 'f', 'g', 'h'));

}  // namespace
}  // namespace deburr::tb::geometric_rtl::vectors_test
