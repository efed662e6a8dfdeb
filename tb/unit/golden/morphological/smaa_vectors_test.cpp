// SPDX-License-Identifier: MIT
// Compares the golden model with docs/reference/morphological/vectors.md: weights of every edge of
// the SMAA patterns, the search limit, and the tables. vectors_test.cpp compares the frames.
#include <gmock/gmock.h>

#include <sstream>
#include <string>

#include "golden/morphological/area_table.h"
#include "golden/morphological/arithmetic.h"
#include "golden/morphological/diagonals.h"
#include "spec/morphological/parameters.h"
#include "spec/morphological/tables.h"
#include "spec/morphological/vectors.h"
#include "tb/stimuli/vector_hash.h"
#include "tb/unit/golden/morphological/support.h"
#include "tb/unit/spec/morphological/vector_images.h"
#include "tb/unit/spec/vectors.h"

namespace deburr::smaa_vectors_test {
namespace {

using golden::morphological::EdgeWeights;
using golden::morphological::MorphologicalGolden;
using golden::morphological::preset_parameters;
using spec::morphological::Preset;
using spec::morphological::Quality;
using tb::differences;
using tb::morphological::Frame;

// ---- patterns -----------------------------------------------------------------------------------

std::ostream& put(std::ostream& out, EdgeWeights s) {
  return out << int{s.first} << '/' << int{s.second};
}

// All edges with weights, as "t(x,y) first/second": top edges, then left edges (l).
std::string weights_of(const MorphologicalGolden& golden) {
  std::ostringstream all;
  const char* comma = "";
  const auto list = [&](const char* name, auto&& of) {
    for (int y = 0; y < golden.height(); ++y) {
      for (int x = 0; x < golden.width(); ++x) {
        if (of(x, y) == EdgeWeights{}) continue;
        put(all << comma << name << '(' << x << ',' << y << ") ", of(x, y));
        comma = ", ";
      }
    }
  };
  list("t", [&](int x, int y) { return golden.top_weights(x, y); });
  list("l", [&](int x, int y) { return golden.left_weights(x, y); });
  return all.str();
}

TEST(SmaaPatterns, WeightsMatchContract) {
  for (const spec::morphological::PatternVector& v : spec::morphological::kPatternVectors) {
    SCOPED_TRACE(v.name);
    const Frame input = tb::morphological::vector_image(v);
    MorphologicalGolden golden(preset_parameters(Preset::kSmaa, v.quality));
    Frame output = input;
    output.pixels = golden.process(input.view());
    EXPECT_EQ(weights_of(golden), v.weights);
    const spec::morphological::PatternResult got = {hash(output), golden.work().diagonal_pixels};
    EXPECT_EQ(differences(v.result, got), "");
    tb::expect_each_value_is_compared(v.result, got);
  }
}

// ---- search limit -------------------------------------------------------------------------------

TEST(SmaaLimits, LimitSearchOfEachPixel) {
  for (const spec::morphological::LimitVector& v : spec::morphological::kLimitVectors) {
    MorphologicalGolden golden(preset_parameters(Preset::kSmaa, Quality::kLow));
    const Frame frame = tb::morphological::vector_image(v);
    Frame output = frame;
    output.pixels = golden.process(frame.view());
    std::ostringstream weights;
    for (int x = 1; x <= v.length; ++x)
      put(weights << (x > 1 ? " " : ""), golden.top_weights(x, 2));
    EXPECT_EQ(weights.str(), v.weights) << v.length;
    const spec::morphological::LimitResult got = {hash(output)};
    EXPECT_EQ(differences(v.result, got), "") << v.length;
    tb::expect_each_value_is_compared(v.result, got);
  }
}

// ---- tables -------------------------------------------------------------------------------------

using tb::stimuli::VectorHash;

std::uint64_t hash_of(const golden::morphological::AreaTile& tile) {
  VectorHash hash;
  for (const auto& row : tile)
    for (const std::uint8_t entry : row) hash.byte(entry);
  return hash.value();
}

std::uint64_t hash_of(const golden::morphological::DiagonalTable& table) {
  VectorHash hash;
  for (int e1 = 0; e1 < 4; ++e1)
    for (int e2 = 0; e2 < 4; ++e2)
      for (int d1 = 0; d1 < spec::morphological::kDiagonalDistances; ++d1)
        for (int d2 = 0; d2 < spec::morphological::kDiagonalDistances; ++d2) {
          const auto areas = table.at(e1, e2, d1, d2);
          hash.byte(areas.a);
          hash.byte(areas.b);
        }
  return hash.value();
}

TEST(SmaaTables, HashesMatchContract) {
  VectorHash roots, mix;
  for (int d = 0; d < spec::morphological::kTableDistances; ++d)
    roots.highest_first(static_cast<std::uint64_t>(golden::morphological::table_root(d)), 2);
  for (int s = 0; s < spec::morphological::kMixSums; ++s)
    mix.highest_first(golden::morphological::mix_reciprocal(s), 3);
  using spec::morphological::AreaValues;
  const spec::morphological::TableHashes got = {
      hash_of(golden::morphological::half_tile()),
      hash_of(golden::morphological::dip_tile()),
      roots.value(),
      mix.value(),
      hash_of(golden::morphological::diagonal_table()),
      hash_of(golden::morphological::half_tile(AreaValues::kPublished)),
      hash_of(golden::morphological::dip_tile(AreaValues::kPublished)),
      hash_of(golden::morphological::diagonal_table(AreaValues::kPublished))};
  EXPECT_EQ(differences(spec::morphological::kTableHashes, got), "");
  tb::expect_each_value_is_compared(spec::morphological::kTableHashes, got);
}

TEST(SmaaTables, WeightsMatchContract) {
  for (const spec::morphological::TableVector& v : spec::morphological::kTableVectors) {
    SCOPED_TRACE(testing::Message() << v.l << ' ' << v.r);
    // Shapes 1 (L-first-none) and 5 (U-first).
    const EdgeWeights half = golden::morphological::table_weights(1, v.l, v.r),
                      dip = golden::morphological::table_weights(5, v.l, v.r);
    const spec::morphological::TableResult got = {half.first, dip.first};
    EXPECT_EQ(differences(v.result, got), "");
    tb::expect_each_value_is_compared(v.result, got);
    EXPECT_EQ(half.second, 0);
    EXPECT_EQ(dip.second, 0);
    // Shape 8 (L-none-second) is the mirror image, with the weight on the second side.
    EXPECT_EQ(golden::morphological::table_weights(8, v.r, v.l), (EdgeWeights{0, half.first}));
  }
}

}  // namespace
}  // namespace deburr::smaa_vectors_test
