// SPDX-License-Identifier: MIT
// Which edges the golden model keeps, and which parameters and frames it accepts.
#include "golden/geometric/classify.h"

#include <gmock/gmock.h>

#include "golden/geometric/configuration.h"
#include "spec/error.h"
#include "spec/geometric/check_build.h"

namespace deburr::classify_test {
namespace {

using golden::geometric::check_frame;
using golden::geometric::classify;
using golden::geometric::classify_faces;
using golden::geometric::FacingBits;
using golden::geometric::FrameCounts;
using golden::geometric::preset_parameters;
using golden::geometric::rejection;
using spec::geometric::CoarseLines;
using spec::geometric::Configuration;
using spec::geometric::Crease;
using spec::geometric::Cull;
using spec::geometric::Edge;
using spec::geometric::EdgeClass;
using spec::geometric::Parameters;
using spec::geometric::Preset;
using spec::geometric::RecordsLayout;
using spec::geometric::Rejection;
using spec::geometric::Select;
namespace flag = spec::geometric::flag;

constexpr Select kSelects[] = {Select::kAll, Select::kEdges, Select::kMesh};
constexpr Crease kCreases[] = {Crease::kOff, Crease::kPaper, Crease::kShading};

// The table of classes in docs/reference/geometric/algorithm.md, row by row.
EdgeClass expected_class(const Configuration& configuration, int flags, bool front0, bool front1) {
  if ((flags & 1) != 0) return EdgeClass::kBoundary;
  if (configuration.select == Select::kAll) return EdgeClass::kUnclassified;
  const bool edges = configuration.select == Select::kEdges;
  if (edges && front0 != front1) return EdgeClass::kSilhouette;
  if (edges && !front0 && configuration.cull == Cull::kBack) return EdgeClass::kBack;
  const bool paper = (flags & 2) != 0;
  const bool shading = (flags & 6) == 6 || (flags & 8) != 0;
  const bool crease = configuration.crease == Crease::kPaper     ? paper
                      : configuration.crease == Crease::kShading ? shading
                                                                 : false;
  return crease ? EdgeClass::kCrease : EdgeClass::kFlat;
}

TEST(Classify, MatchesTheTableForAllFlagsAndFacings) {
  int seen = 0;
  for (const Select select : kSelects) {
    for (const Crease crease : kCreases) {
      for (const Cull cull : {Cull::kNone, Cull::kBack}) {
        Configuration configuration;
        configuration.select = select;
        configuration.crease = crease;
        configuration.cull = cull;
        for (int flags = 0; flags < 256; ++flags) {
          for (int facings = 0; facings < 4; ++facings) {
            // Faces 3 and 10: bits of different bytes.
            const std::array<std::uint8_t, 2> bytes = {
                static_cast<std::uint8_t>((facings & 1) != 0 ? 8 : 0),
                static_cast<std::uint8_t>((facings & 2) != 0 ? 4 : 0)};
            const Edge edge{0, 1, 3, 10, static_cast<std::uint8_t>(flags)};
            const EdgeClass expected =
                expected_class(configuration, flags, (facings & 1) != 0, (facings & 2) != 0);
            EXPECT_EQ(classify(configuration, edge, 2, {bytes, 11}), expected)
                << flags << ' ' << facings;
            // Only classify() checks vertices; classify_faces() does not.
            EXPECT_EQ(classify_faces(configuration, edge, {bytes, 11}), expected);
            EXPECT_EQ(classify(configuration, edge, 1, {bytes, 11}), EdgeClass::kInvalid);
            ++seen;
          }
        }
      }
    }
  }
  EXPECT_EQ(seen, 3 * 3 * 2 * 256 * 4);
}

TEST(Classify, RejectsIndicesBeyondTheCounts) {
  const std::array<std::uint8_t, 1> bytes = {0xFF};
  const FacingBits facing{bytes, 5};
  Configuration edges, all, mesh;
  all.select = Select::kAll;
  mesh.select = Select::kMesh;
  const auto is_valid = [&](const Configuration& configuration, const Edge& edge) {
    return classify(configuration, edge, 4, facing) != EdgeClass::kInvalid;
  };
  EXPECT_TRUE(is_valid(edges, {3, 3, 4, 4, 0}));
  EXPECT_FALSE(is_valid(edges, {4, 3, 4, 4, 0}));
  EXPECT_FALSE(is_valid(edges, {3, 4, 4, 4, 0}));
  EXPECT_FALSE(is_valid(edges, {3, 3, 5, 4, 0}));
  EXPECT_FALSE(is_valid(edges, {3, 3, 4, 5, 0}));
  // A boundary has no second face, but its first face must be valid.
  EXPECT_TRUE(is_valid(edges, {3, 3, 4, 5, flag::kBoundary}));
  EXPECT_FALSE(is_valid(edges, {3, 3, 5, 0, flag::kBoundary}));
  // Faces matter only with select = edges.
  for (const Configuration& configuration : {all, mesh}) {
    EXPECT_TRUE(is_valid(configuration, {3, 3, 5, 5, 0}));
    EXPECT_TRUE(is_valid(configuration, {3, 3, 5, 5, flag::kBoundary}));
    EXPECT_FALSE(is_valid(configuration, {4, 3, 0, 0, 0}));
    EXPECT_FALSE(is_valid(configuration, {3, 4, 0, 0, flag::kBoundary}));
  }
}

// ---- configuration ------------------------------------------------------------------------------

TEST(Configuration, PresetsMatchThePage) {
  using spec::geometric::Combine;
  using spec::geometric::CoverageRule;
  const Parameters gpaa = preset_parameters(Preset::kGpaa),
                   optimised = preset_parameters(Preset::kGpaaOptimised), untouched;
  EXPECT_EQ(gpaa.select, Select::kAll);
  EXPECT_EQ(optimised.select, Select::kEdges);
  EXPECT_EQ(optimised.crease, Crease::kPaper);
  for (const Parameters& p : {gpaa, optimised}) {
    EXPECT_EQ(p.combine, Combine::kLast);
    EXPECT_EQ(p.coverage, CoverageRule::kDistance);
    EXPECT_EQ(p.crease_depth, 0);
    EXPECT_EQ(p.cull, Cull::kBack);
    EXPECT_TRUE(p.frame_copy);
    EXPECT_NO_THROW(check_build(p));
  }
  for (const Parameters& p : {preset_parameters(Preset::kDeburr), untouched}) {
    EXPECT_EQ(p.crease, Crease::kShading);
    EXPECT_EQ(p.combine, Combine::kOutermost);
    EXPECT_EQ(p.coverage, CoverageRule::kArea);
    EXPECT_EQ(p.crease_depth, 3);
    EXPECT_EQ(p.cull, Cull::kNone);
    EXPECT_FALSE(p.frame_copy);
    EXPECT_NO_THROW(check_build(p));
  }
}

void expect_rejected(void (*change)(Parameters&), const char* name) {
  Parameters p;
  change(p);
  EXPECT_THAT([&] { check_build(p); },
              testing::ThrowsMessage<spec::ConfigError>(testing::HasSubstr(name)));
}

TEST(Configuration, ErrorsNameTheParameter) {
  expect_rejected([](Parameters& p) { p.depth_bias = 0; }, "depth_bias = 0 is outside 1..24");
  expect_rejected([](Parameters& p) { p.depth_bias = 25; }, "depth_bias = 25 is outside 1..24");
  expect_rejected([](Parameters& p) { p.crease_depth = -1; }, "crease_depth = -1 is outside 0..24");
  expect_rejected([](Parameters& p) { p.crease_depth = 25; }, "crease_depth = 25 is outside 0..24");
  expect_rejected([](Parameters& p) { p.combine = static_cast<spec::geometric::Combine>(3); },
                  "combine");
  expect_rejected([](Parameters& p) { p.select = static_cast<Select>(3); }, "select");
  expect_rejected([](Parameters& p) { p.reciprocal_table = 10; }, "reciprocal_table");
  expect_rejected([](Parameters& p) { p.fills = 129; }, "memory.outstanding");
  expect_rejected([](Parameters& p) { p.face_limit = 8193; }, "face_limit");
  expect_rejected([](Parameters& p) { p.touched_words = 15; }, "touched_words");
  expect_rejected([](Parameters& p) { p.colour_lines = 257; },
                  "colour_lines = 257 is outside 0..256");
  expect_rejected([](Parameters& p) { p.write_buffer = 129; },
                  "write_buffer = 129 is outside 0..128");
  expect_rejected([](Parameters& p) { p.records = static_cast<RecordsLayout>(2); }, "records");
  expect_rejected([](Parameters& p) { p.coarse_lines = static_cast<CoarseLines>(6); },
                  "coarse_lines");
  expect_rejected(
      [](Parameters& p) {
        p.coarse_lines = CoarseLines::k4;
        p.depth_test = spec::geometric::DepthTest::kOff;
      },
      "must be none with depth_test = off");
  expect_rejected([](Parameters& p) { p.fills = 7; }, "fills = 7: must be at least 8 lines");
  Parameters fills;
  fills.fills = fills.memory_outstanding = 64;  // equal to memory.outstanding
  EXPECT_NO_THROW(check_build(fills));
  Parameters table;
  table.pipelined = false;
  table.reciprocal_table = 10;
  EXPECT_NO_THROW(check_build(table));
}

TEST(Configuration, RejectsFramesBeyondTheBuildLimits) {
  Parameters p;  // 2048 pixels, 1088 words, 32768 faces
  const auto why = [&](FrameCounts counts) { return rejection(p, counts); };
  EXPECT_EQ(why({1920, 1080, 1, 1, 1}), Rejection::kNone);
  EXPECT_EQ(why({2048, 1088, 1, 1, 1}), Rejection::kNone);
  EXPECT_EQ(why({2048, 1089, 1, 1, 1}), Rejection::kTouchedWords);
  EXPECT_EQ(why({2049, 1080, 1, 1, 1}), Rejection::kWidth);
  EXPECT_EQ(why({0, 10, 0, 0, 0}), Rejection::kSize);
  EXPECT_EQ(why({10, 0, 0, 0, 0}), Rejection::kSize);
  EXPECT_EQ(why({10, 8193, 0, 0, 0}), Rejection::kSize);
  EXPECT_EQ(why({512, 4352, 0, 0, 0}), Rejection::kNone);
  EXPECT_EQ(why({513, 4352, 0, 0, 0}), Rejection::kTouchedWords);
  EXPECT_EQ(why({8, 8, 1u << 24, 1u << 24, 32768}), Rejection::kNone);
  EXPECT_EQ(why({8, 8, (1u << 24) + 1, 0, 0}), Rejection::kEdgeCount);
  EXPECT_EQ(why({8, 8, 0, (1u << 24) + 1, 0}), Rejection::kVertexCount);
  EXPECT_EQ(why({8, 8, 0, 0, 32769}), Rejection::kFaceCount);
  for (const Select select : {Select::kAll, Select::kMesh}) {
    p.select = select;
    EXPECT_EQ(why({8, 8, 0, 0, 32769}), Rejection::kNone);
  }
  p.select = Select::kEdges;
  EXPECT_EQ(why({8, 8, 5, 0, 0, 6}), Rejection::kNone);
  p.records = RecordsLayout::kSplit;
  EXPECT_EQ(why({8, 8, 5, 0, 0, 6}), Rejection::kBoundaryCount);
  EXPECT_EQ(why({8, 8, 5, 0, 0, 5}), Rejection::kNone);
  EXPECT_EQ(why({8, 8, 0, 0, 0, 0}), Rejection::kNone);
  p.line_pixels = 8192;
  p.touched_words = 1 << 20;
  EXPECT_EQ(why({1, 1, 0, 0, 0}), Rejection::kNone);
  EXPECT_EQ(why({8192, 1, 0, 0, 0}), Rejection::kNone);
  EXPECT_EQ(why({1, 8192, 0, 0, 0}), Rejection::kNone);
  EXPECT_EQ(why({8193, 1, 0, 0, 0}), Rejection::kSize);
  EXPECT_EQ(why({-1, 1, 0, 0, 0}), Rejection::kSize);
}

// Each reason is reported once those before it are fixed.
TEST(Configuration, ReportsTheFirstOfSeveralReasons) {
  Parameters p;  // 2048 pixels, 1088 words, 32768 faces
  p.records = RecordsLayout::kSplit;
  FrameCounts f = {8193, 8192, (1u << 24) + 1, (1u << 24) + 1, 32769, (1u << 24) + 2};
  EXPECT_EQ(rejection(p, f), Rejection::kSize);
  f.width = 2049;
  EXPECT_EQ(rejection(p, f), Rejection::kWidth);
  f.width = 2048;
  EXPECT_EQ(rejection(p, f), Rejection::kTouchedWords);
  f.height = 1;
  EXPECT_EQ(rejection(p, f), Rejection::kEdgeCount);
  f.edge_count = 1u << 24;
  EXPECT_EQ(rejection(p, f), Rejection::kVertexCount);
  f.vertex_count = 1u << 24;
  EXPECT_EQ(rejection(p, f), Rejection::kFaceCount);
  f.face_count = 32768;
  EXPECT_EQ(rejection(p, f), Rejection::kBoundaryCount);
  f.boundary_count = 1u << 24;
  EXPECT_EQ(rejection(p, f), Rejection::kNone);
}

TEST(Configuration, MessagesGiveTheValueAndTheLimit) {
  const auto text = [](const FrameCounts& counts) -> std::string {
    Parameters p;
    p.records = RecordsLayout::kSplit;
    try {
      check_frame(p, counts);
    } catch (const spec::ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(text({1920, 1080, 1, 1, 1}), "");
  EXPECT_EQ(text({0, 10, 0, 0, 0}), "a frame of 0 x 10 pixels; width and height must be 1..8192");
  EXPECT_EQ(text({2049, 1080, 1, 1, 1}),
            "a frame of 2049 x 1080 pixels is wider than the row buffers of 2048 pixels; raise "
            "line_pixels");
  // Words of 512 x 4 pixels: 4 across and 273 down.
  EXPECT_EQ(text({2048, 1089, 1, 1, 1}),
            "a frame of 2048 x 1089 pixels needs 1092 touched words, but the build has 1088; "
            "raise touched_words");
  EXPECT_EQ(text({8, 8, (1u << 24) + 1, 0, 0}), "16777217 edges; the limit is 2^24");
  EXPECT_EQ(text({8, 8, 0, (1u << 24) + 1, 0}), "16777217 vertices; the limit is 2^24");
  EXPECT_EQ(text({8, 8, 0, 0, 32769}),
            "32769 faces, but the build stores facing bits for 32768; raise face_limit");
  EXPECT_EQ(text({8, 8, 5, 0, 0, 6}), "6 boundary edges, but only 5 edges");
}

}  // namespace
}  // namespace deburr::classify_test
