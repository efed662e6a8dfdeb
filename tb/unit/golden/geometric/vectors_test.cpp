// SPDX-License-Identifier: MIT
// The golden model against the contract's vectors: the frames and lines of
// spec/geometric/vectors.h, and every entry of the ROM (docs/reference/geometric/algorithm.md).
#include "spec/geometric/vectors.h"

#include <gmock/gmock.h>

#include <string>

#include "golden/geometric/line.h"
#include "spec/geometric/tables.h"
#include "tb/unit/golden/geometric/support.h"
#include "tb/unit/spec/geometric/vector_names.h"
#include "tb/unit/spec/vectors.h"

namespace deburr::vectors_test {
namespace {

using golden::geometric::GeometricGolden;
using golden::geometric::LineFate;
using golden::geometric::preset_parameters;
using golden::geometric::set_up_line;
using spec::geometric::Axis;
using spec::geometric::FrameResult;
using spec::geometric::FrameVector;
using spec::geometric::LineEnd;
using spec::geometric::LineRecord;
using spec::geometric::LineResult;
using spec::geometric::LineVector;
using spec::geometric::Parameters;
using spec::geometric::Region;
using spec::geometric::Vertex;
using tb::differences;

// ---- frames -------------------------------------------------------------------------------------

Parameters parameters_of(const FrameVector& v) {
  Parameters p = preset_parameters(v.preset);
  tb::apply_settings(p, v.settings);
  return p;
}

FrameResult result_of(const FrameVector& v) {
  const Parameters p = parameters_of(v);
  GeometricGolden golden(p);
  golden.process(tb::geometric::vector_drawing(v.frame).input(tb::geometric::kVectorBases));
  const auto& t = golden.traffic();
  return {{tb::geometric::hash_of(golden.pixels()), tb::geometric::hash_of(golden.weights()),
           tb::geometric::hash_of(t, p.frame_copy)},
          golden.work(),
          {t.read(Region::kVertices).size(), t.read(Region::kDepth).size(),
           t.read(Region::kWeights).size(), t.write(Region::kWeights).size(),
           t.read(p.frame_copy ? Region::kCopy : Region::kColour).size(),
           t.write(Region::kColour).size()}};
}

class Frames : public testing::TestWithParam<FrameVector> {};

TEST_P(Frames, MatchTheContract) {
  EXPECT_EQ(differences(GetParam().result, result_of(GetParam())), "");
}

// The fast mode gives the same pixels, weights and work.
TEST_P(Frames, FastModeGivesTheSameResult) {
  const FrameVector& v = GetParam();
  GeometricGolden golden(parameters_of(v), GeometricGolden::Detail::kPixels);
  golden.process(tb::geometric::vector_drawing(v.frame).input(tb::geometric::kVectorBases));
  EXPECT_EQ(tb::geometric::hash_of(golden.pixels()), v.result.hashes.pixels);
  EXPECT_EQ(tb::geometric::hash_of(golden.weights()), v.result.hashes.weights);
  EXPECT_EQ(golden.work(), v.result.work);
  EXPECT_TRUE(golden.candidates().empty());
}

INSTANTIATE_TEST_SUITE_P(All, Frames, testing::ValuesIn(tb::geometric::all_frame_vectors()),
                         [](const auto& test) { return std::string(1, test.param.name); });

INSTANTIATE_TEST_SUITE_P(LessTraffic, Frames,
                         testing::ValuesIn(spec::geometric::kTrafficFrameVectors),
                         [](const auto& test) { return std::string(1, test.param.name); });

TEST(FrameVectors, EachValueIsCompared) {
  const FrameVector& v = spec::geometric::kFrameVectors[0];
  tb::expect_each_value_is_compared(v.result, result_of(v));
}

TEST(FrameVectors, SettingsNameExistingParameters) {
  Parameters p;
  tb::apply_settings(p, "walkers=1 mark=true depth_bias=4");
  EXPECT_EQ(p.walkers, spec::geometric::Lanes::kOne);
  EXPECT_TRUE(p.mark);
  EXPECT_EQ(p.depth_bias, 4);
  for (const char* wrong : {"walker=1", "walkers=3", "mark=on", "depth_bias=0", "depth_bias=4x",
                            "depth_bias=", "mark", "=", "mark=true  fills=8"})
    EXPECT_THROW(tb::apply_settings(p, wrong), std::invalid_argument) << wrong;
}

// ---- lines --------------------------------------------------------------------------------------

class Lines : public testing::TestWithParam<LineVector> {};

TEST_P(Lines, MatchTheContract) {
  const LineVector& v = GetParam();
  const bool horizontal = v.axis == Axis::kHorizontal;
  const auto vertex = [&](const LineEnd& end) {
    return horizontal ? Vertex{end.major, end.minor, end.depth, true}
                      : Vertex{end.minor, end.major, end.depth, true};
  };
  const Vertex a = vertex(v.a), b = vertex(v.b);
  for (const bool swapped : {false, true}) {
    LineRecord line;
    ASSERT_EQ(set_up_line(swapped ? b : a, swapped ? a : b, spec::geometric::kLineVectorWidth,
                          spec::geometric::kLineVectorHeight, line),
              LineFate::kLine);
    EXPECT_EQ(line.axis, v.axis);
    EXPECT_EQ(line.tie_forward, horizontal && v.b.minor > v.a.minor);
    const LineResult got = {line.first, line.count, line.position,
                            line.slope, line.depth, line.depth_step};
    EXPECT_EQ(differences(v.result, got), "");
    tb::expect_each_value_is_compared(v.result, got);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Lines, testing::ValuesIn(spec::geometric::kLineVectors));

// ---- tables -------------------------------------------------------------------------------------

TEST(Tables, DeficitsMatchTheFormula) {
  for (std::uint64_t i = 0; i < 1024; ++i) {
    const std::uint64_t deficit = spec::geometric::kReciprocalDeficit[i];
    EXPECT_EQ(deficit, (std::uint64_t{1} << 26) - (std::uint64_t{1} << 36) / (1024 + i));
    EXPECT_LT(deficit, 1u << 25);
    // For a length whose low twelve bits are 0 the division gives the same reciprocal.
    EXPECT_EQ((1u << 26) - deficit,
              golden::geometric::reciprocal(static_cast<std::uint32_t>((1024 + i) << 12)));
  }
}

}  // namespace
}  // namespace deburr::vectors_test
