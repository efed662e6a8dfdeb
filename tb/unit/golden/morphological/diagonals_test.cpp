// SPDX-License-Identifier: MIT
// Diagonals of docs/reference/morphological/smaa.md: staircases of every length with every crossing
// code at their ends, rising and falling, open and closed, and at borders; the table compared with
// the areas of its lines; and the weights of taken pixels.
#include "golden/morphological/diagonals.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "golden/ideal/smaa.h"
#include "tb/base/random.h"
#include "tb/unit/golden/morphological/support.h"

namespace deburr::diagonals_test {
namespace {

using golden::morphological::BitPlane;
using golden::morphological::diagonal_table;
using golden::morphological::diagonal_weights;
using golden::morphological::DiagonalAreas;
using golden::morphological::DiagonalEnds;
using golden::morphological::DiagonalWeights;
using golden::morphological::EdgePlanes;
using golden::morphological::falling_diagonal;
using golden::morphological::MorphologicalGolden;
using golden::morphological::preset_parameters;
using golden::morphological::rising_diagonal;
using spec::morphological::Parameters;
using spec::morphological::Preset;
using tb::Random;
using tb::morphological::Frame;

bool operator==(const DiagonalEnds& a, const DiagonalEnds& b) {
  return a.d1 == b.d1 && a.d2 == b.d2 && a.e1 == b.e1 && a.e2 == b.e2 && a.open1 == b.open1 &&
         a.open2 == b.open2;
}

constexpr int kSize = 60, kX = 30, kY = 30;

EdgePlanes empty(int width = kSize, int height = kSize) {
  return {BitPlane(width, height), BitPlane(width, height)};
}

// Edges of a diagonal through (kX, kY) with `down` and `up` further steps.
EdgePlanes rising(int down, int up) {
  EdgePlanes e = empty();
  for (int i = -down; i <= up; ++i) {
    e.top.set(kX + i, kY - i);
    e.left.set(kX + i, kY - i);
  }
  return e;
}
EdgePlanes falling(int up, int down) {
  EdgePlanes e = empty();
  for (int i = -up; i <= down; ++i) {
    e.top.set(kX + i, kY + i);
    e.left.set(kX + i + 1, kY + i);
  }
  return e;
}

TEST(Diagonal, SearchFindsBothEnds) {
  for (const int steps : {1, 2, 3, 8, 16}) {
    for (int a = 0; a <= steps + 1; ++a) {
      for (int b = 0; b <= steps + 1; ++b) {
        const DiagonalEnds up = rising_diagonal(rising(a, b), steps, kX, kY);
        // A staircase that continues past the search has the top edge of "plus 1".
        const int further = a >= steps ? 1 : 0;
        EXPECT_EQ(up.d1, std::min(a, steps - 1) + further);
        EXPECT_EQ(up.d2, std::min(b, steps - 1));
        EXPECT_EQ(up.open1, a >= steps);
        EXPECT_EQ(up.open2, b >= steps);
        const DiagonalEnds down = falling_diagonal(falling(a, b), steps, kX, kY);
        EXPECT_EQ(down.d1, std::min(a, steps - 1));
        EXPECT_EQ(down.d2, std::min(b, steps - 1) + (b >= steps ? 1 : 0));
        EXPECT_EQ(down.open1, a >= steps);
        EXPECT_EQ(down.open2, b >= steps);
        EXPECT_EQ(up.counts(), up.d1 + up.d2 >= 3);
      }
    }
  }
}

// Sets each bit of a code at the position that the contract names; an open end has code 0.
TEST(Diagonal, ReadsCrossingCodesOfBothEnds) {
  for (int code1 = 0; code1 < 4; ++code1) {
    for (int code2 = 0; code2 < 4; ++code2) {
      EdgePlanes e = rising(3, 4);
      if (code1 & 2) e.top.set(kX - 4, kY + 3);
      if (code1 & 1) e.left.set(kX - 3, kY + 3);  // already set by the diagonal
      if (code2 & 2) e.top.set(kX + 5, kY - 4);
      if (code2 & 1) e.left.set(kX + 5, kY - 5);
      const DiagonalEnds up = rising_diagonal(e, 8, kX, kY);
      EXPECT_EQ(up.e1, (code1 & 2) | 1);
      EXPECT_EQ(up.e2, code2);
      const DiagonalEnds open = rising_diagonal(e, 3, kX, kY);
      EXPECT_TRUE(open.open1 && open.open2);
      EXPECT_EQ(open.e1, 0);
      EXPECT_EQ(open.e2, 0);

      EdgePlanes f = falling(3, 4);
      if (code1 & 2) f.top.set(kX - 4, kY - 3);
      if (code1 & 1) f.left.set(kX - 3, kY - 4);
      if (code2 & 2) f.top.set(kX + 5, kY + 4);
      const DiagonalEnds down = falling_diagonal(f, 8, kX, kY);
      EXPECT_EQ(down.e1, code1);
      EXPECT_EQ(down.e2, (code2 & 2) | 1);  // left(x + d2 + 1, y + d2) belongs to the diagonal
    }
  }
  // With "plus 1" the end is one pixel further on. Only bit 1 is tested there: a left edge for bit
  // 0 would be another step of the diagonal.
  for (int code = 0; code < 4; ++code) {
    EdgePlanes e = rising(3, 4);
    e.top.set(kX - 4, kY + 4);
    if (code & 2) e.top.set(kX - 5, kY + 4);
    const DiagonalEnds up = rising_diagonal(e, 8, kX, kY);
    EXPECT_EQ(up.d1, 4);
    EXPECT_EQ(up.e1, code & 2);
    EdgePlanes f = falling(3, 4);
    f.top.set(kX + 5, kY + 5);
    if (code & 2) f.top.set(kX + 6, kY + 5);
    const DiagonalEnds down = falling_diagonal(f, 8, kX, kY);
    EXPECT_EQ(down.d2, 5);
    EXPECT_EQ(down.e2, code & 2);
  }
}

// border = end matches a larger frame with an empty margin, border = clamp one whose margin repeats
// the outermost edges.
TEST(Diagonal, BorderOptionMatchesFrameWithMargin) {
  using spec::morphological::Border;
  constexpr int kSteps = 4, kMargin = 12;
  Random random(8);
  int counted = 0, differing = 0;
  for (int width = 1; width <= 2 * kSteps + 3; ++width) {
    for (int height : {1, 2, 3, 5, 11}) {
      EdgePlanes small = empty(width, height);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          if (x > 0 && random.chance(800)) small.left.set(x, y);
          if (y > 0 && random.chance(800)) small.top.set(x, y);
        }
      for (const Border border : {Border::kEnd, Border::kClamp}) {
        EdgePlanes large = empty(width + 2 * kMargin, height + 2 * kMargin);
        for (int y = 0; y < large.left.height(); ++y)
          for (int x = 0; x < large.left.width(); ++x) {
            const int from_x = std::clamp(x - kMargin, 0, width - 1),
                      from_y = std::clamp(y - kMargin, 0, height - 1);
            const bool inside = from_x == x - kMargin && from_y == y - kMargin;
            if (!inside && border == Border::kEnd) continue;
            if (small.left.at(from_x, from_y)) large.left.set(x, y);
            if (small.top.at(from_x, from_y)) large.top.set(x, y);
          }
        for (int y = 0; y < height; ++y) {
          for (int x = 0; x < width; ++x) {
            const DiagonalEnds up = rising_diagonal(small, kSteps, x, y, border);
            const DiagonalEnds down = falling_diagonal(small, kSteps, x, y, border);
            EXPECT_TRUE(up == rising_diagonal(large, kSteps, x + kMargin, y + kMargin));
            EXPECT_TRUE(down == falling_diagonal(large, kSteps, x + kMargin, y + kMargin));
            counted += up.counts() + down.counts();
            differing += !(up == rising_diagonal(small, kSteps, x, y)) +
                         !(down == falling_diagonal(small, kSteps, x, y));
          }
        }
      }
    }
  }
  EXPECT_GT(counted, 200);
  EXPECT_GT(differing, 30);
}

// ---- the table ----------------------------------------------------------------------------------

TEST(DiagonalTable, ApproximatesAreasCutByLine) {
  // Codes (2, 2): one line from (1, 1) to (1 + n, n); its areas in pixel (1 + d1, d1) and in the
  // pixel below, integrated over columns.
  const auto clipped = [](double v) { return std::clamp(v, 0.0, 1.0); };
  for (int d1 = 0; d1 < 20; ++d1) {
    for (int d2 = 0; d2 < 20; ++d2) {
      const double n = d1 + d2 + 1, slope = (n - 1) / n;
      double above = 0, below = 0;
      constexpr int kColumns = 1000;
      for (int i = 0; i < kColumns; ++i) {
        const double x = 1 + d1 + (i + 0.5) / kColumns, y = 1 + (x - 1) * slope;
        above += 1 - clipped(y - d1);
        below += clipped(y - (d1 + 1));
      }
      // Sample points include the pixel's border, so an area is off by at most 1/30 and rounding.
      constexpr double kOff = 1.0 / 30 + 1.0 / 512 + 1.0 / kColumns;
      EXPECT_NEAR(diagonal_table().at(2, 2, d1, d2).a / 256.0, above / kColumns, kOff);
      EXPECT_NEAR(diagonal_table().at(2, 2, d1, d2).b / 256.0, below / kColumns, kOff);
    }
  }
}

TEST(DiagonalTable, PublishedEntriesMatchAreaTexBytes) {
  const auto& table = diagonal_table(spec::morphological::AreaValues::kPublished);
  int differing = 0;
  for (int e1 = 0; e1 < 4; ++e1)
    for (int e2 = 0; e2 < 4; ++e2)
      for (int d1 = 0; d1 < 20; ++d1)
        for (int d2 = 0; d2 < 20; ++d2) {
          const auto bytes = golden::ideal::smaa_diagonal_bytes(e1, e2, d1, d2);
          const DiagonalAreas entry = table.at(e1, e2, d1, d2);
          const auto value = [](int byte) { return byte == 255 ? 255 : (512 * byte + 255) / 510; };
          EXPECT_EQ(entry.a, value(bytes.r)) << e1 << ' ' << e2 << ' ' << d1 << ' ' << d2;
          EXPECT_EQ(entry.b, value(bytes.g)) << e1 << ' ' << e2 << ' ' << d1 << ' ' << d2;
          differing += !(entry == diagonal_table().at(e1, e2, d1, d2));
        }
  EXPECT_GT(differing, 3000);
}

TEST(DiagonalWeights, AddBothDirectionsWithFallingSwapped) {
  const DiagonalEnds up{3, 1, 2, 0}, down{2, 4, 0, 3};
  const DiagonalAreas a = diagonal_table().at(2, 0, 3, 1), b = diagonal_table().at(0, 3, 2, 4);
  const DiagonalWeights both = diagonal_weights(up, down), one = diagonal_weights(up, {});
  EXPECT_EQ(both.second, a.a + b.b);
  EXPECT_EQ(both.first, a.b + b.a);
  EXPECT_EQ(both.span, 7);
  EXPECT_EQ(one.second, a.a);
  EXPECT_EQ(one.first, a.b);
  EXPECT_EQ(one.span, 5);
}

// ---- frames -------------------------------------------------------------------------------------

TEST(DiagonalPixels, ReplaceWeightsOfRuns) {
  Parameters p = preset_parameters(Preset::kSmaa);
  const Frame frame = tb::morphological::noise_image();
  MorphologicalGolden with(p);
  with.process(frame.view());
  p.diagonals = false;
  MorphologicalGolden without(p);
  without.process(frame.view());
  EXPECT_EQ(with.edges(), without.edges());
  std::uint64_t taken = 0, of_left = 0;
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const DiagonalWeights found =
          with.edges().top.at(x, y)
              ? diagonal_weights(rising_diagonal(with.edges(), p.diagonal_steps, x, y, p.border),
                                 falling_diagonal(with.edges(), p.diagonal_steps, x, y, p.border))
              : DiagonalWeights{};
      if (found.taken()) {
        ++taken;
        of_left += without.left_weights(x, y) != golden::morphological::EdgeWeights{};
        EXPECT_EQ(with.top_weights(x, y).first, std::min(255, found.first));
        EXPECT_EQ(with.top_weights(x, y).second, std::min(255, found.second));
        EXPECT_EQ(with.left_weights(x, y), golden::morphological::EdgeWeights{});
      } else {
        EXPECT_EQ(with.top_weights(x, y), without.top_weights(x, y));
        EXPECT_EQ(with.left_weights(x, y), without.left_weights(x, y));
      }
    }
  }
  EXPECT_EQ(with.work().diagonal_pixels, taken);
  EXPECT_GT(taken, 100u);
  EXPECT_GT(of_left, 10u);
}

}  // namespace
}  // namespace deburr::diagonals_test
