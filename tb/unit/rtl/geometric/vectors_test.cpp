// SPDX-License-Identifier: MIT
// The frames of spec/geometric/vectors.h: pixels, weights, the lists of accesses and the counts.
#include "spec/geometric/vectors.h"

#include "tb/unit/rtl/geometric/support.h"
#include "tb/unit/spec/geometric/vector_names.h"

namespace deburr::tb::geometric_rtl::vectors_test {
namespace {

using spec::geometric::DrawnFrame;
using spec::geometric::FrameResult;
using spec::geometric::FrameVector;

// The bits that memory.md ignores, of records at `base`, become 1.
void set_ignored(EngineBench& b, std::uint32_t base, std::size_t records,
                 const std::array<std::uint32_t, 4>& ignored) {
  std::vector<std::uint8_t> bytes = b.memory.dump(base, 16 * records);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<std::uint8_t>(bytes[i] | ignored[i / 4 % 4] >> 8 * (i % 4));
  b.memory.preload(base, bytes);
}

// The same of records of six bytes: bits 47 and 46, and what follows the tenth of a line.
void set_ignored_of_split(EngineBench& b, std::uint32_t base, std::uint64_t records, bool faces) {
  std::vector<std::uint8_t> bytes = b.memory.dump(base, platform::split_bytes(records));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const std::size_t at = i % 64;
    if (at >= 60) bytes[i] = 0xFF;
    if (faces && at % 6 == 5 && at < 60) bytes[i] |= 0xC0;
  }
  b.memory.preload(base, bytes);
}

void load(EngineBench& b, DrawnFrame frame) {
  const Scene scene = contract_scene(frame);
  b.load(scene);
  if (frame != DrawnFrame::kSpecial) return;
  if (b.p.records == spec::geometric::RecordsLayout::kSplit) {
    const std::uint64_t boundaries = platform::boundaries_of(scene.edges);
    set_ignored_of_split(b, b.bases.edges, scene.edges.size(), true);
    set_ignored_of_split(b, b.bases.pairs, boundaries, false);
    set_ignored_of_split(b, b.driver.regions().other_pairs(boundaries),
                         scene.edges.size() - boundaries, false);
  } else {
    set_ignored(b, b.bases.edges, scene.edges.size(), geometric::kIgnoredOfEdge);
  }
  set_ignored(b, b.bases.vertices, scene.vertices.size(), geometric::kIgnoredOfVertex);
}

// `rules`, if not 0, are written to CONFIG.
FrameResult result_of(const FrameVector& v, std::uint32_t configuration = 0) {
  Parameters p = preset_parameters(v.preset);
  apply_settings(p, v.settings);
  EngineOptions options;
  options.bench.check_widths = true;
  EngineBench b(p, options);
  load(b, v.frame);
  if (configuration != 0) b.bus.write(reg::kConfiguration, configuration);
  b.run();
  testing::Test::RecordProperty("edge_cycles", static_cast<int>(b.bus.read(reg::kEdgeCycles)));
  testing::Test::RecordProperty("resolve_cycles",
                                static_cast<int>(b.bus.read(reg::kResolveCycles)));
  return {{b.pixel_hash(), b.weight_hash(), b.traffic_hash()},
          b.engine.work(),
          {b.reads(b.bases.vertices).size(), b.reads(b.bases.depth).size(),
           b.reads(b.bases.weights).size(), b.writes(b.bases.weights).size(),
           b.reads(p.frame_copy ? b.bases.copy : b.bases.colour).size(),
           b.writes(b.bases.colour).size()}};
}

class Vectors : public ::testing::TestWithParam<FrameVector> {};

TEST_P(Vectors, PixelsWeightsAndTraffic) {
  EXPECT_EQ(differences(GetParam().result, result_of(GetParam())), "");
}
INSTANTIATE_TEST_SUITE_P(Page, Vectors, ::testing::ValuesIn(geometric::all_frame_vectors()),
                         [](const auto& test) { return std::string(1, test.param.name); });

// Of less traffic.
INSTANTIATE_TEST_SUITE_P(LessTraffic, Vectors,
                         ::testing::ValuesIn(spec::geometric::kTrafficFrameVectors),
                         [](const auto& test) { return std::string(1, test.param.name); });

TEST(FrameVectors, EachValueIsCompared) {
  const FrameVector& v = spec::geometric::kFrameVectors[0];
  expect_each_value_is_compared(v.result, result_of(v));
}

// Codes of CONFIG that no choice has, on frames where what they count as is seen.
struct Code {
  char name;
  spec::Field field;
  std::uint32_t code;
};
void PrintTo(const Code& c, std::ostream* out) {
  *out << c.name << ", " << c.field.name << " = " << c.code;
}
class Codes : public ::testing::TestWithParam<Code> {};

TEST_P(Codes, ThatNoChoiceHasCountAsThePageSays) {
  const auto& [name, field, code] = GetParam();
  const FrameVector v = geometric::frame_vector(name);
  const std::uint32_t word = spec::geometric::configuration_word(configuration(name).p);
  EXPECT_EQ(differences(v.result, result_of(v, (word & ~field.mask()) | field.in(code))), "");
}
INSTANTIATE_TEST_SUITE_P(Page, Codes,
                         ::testing::Values(Code{'p', reg::configuration::kDepthBias, 31},
                                           Code{'p', reg::configuration::kCreaseDepth, 31},
                                           Code{'q', reg::configuration::kDepthBias, 0},
                                           Code{'s', reg::configuration::kCrease, 3},
                                           Code{'h', reg::configuration::kDepthTest, 3},
                                           Code{'l', reg::configuration::kCombine, 3}));

}  // namespace
}  // namespace deburr::tb::geometric_rtl::vectors_test
