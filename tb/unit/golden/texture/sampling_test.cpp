// SPDX-License-Identifier: MIT
// Sample positions, sample weights and the texels that a coordinate selects, against exact rational
// arithmetic and GL's integer formulas for wrapping.
#include "golden/texture/sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>

#include "tb/base/random.h"

namespace deburr::sampling_test {
namespace {

using namespace golden::texture;
using spec::texture::Wrap;

constexpr std::int64_t kOne = spec::texture::kCoordinateOne;
constexpr Wrap kWraps[] = {Wrap::kRepeat, Wrap::kMirroredRepeat, Wrap::kClampToEdge};

// ---- walker -------------------------------------------------------------------------------------

// Counts offsets that differ from ((2 i + 1) / 2 N - 1/2) x spread / 64 x axis by more than their
// rounding and the error of 1 / N in 16 bits.
using Offset = std::function<std::int64_t(int i, int n, std::int32_t spread, std::int64_t axis)>;
int wrong_offsets(const Offset& offset) {
  tb::Random random(1);
  int wrong = 0;
  for (int n = 1; n <= 16; ++n) {
    const bool exact = (n & (n - 1)) == 0;
    for (int trial = 0; trial < 10000; ++trial) {
      const auto axis =
          static_cast<std::int64_t>(random.next() >> (31 + trial % 24)) * (trial % 2 == 0 ? 1 : -1);
      const auto spread = static_cast<std::int32_t>(trial % 129);
      for (int i = 0; i < n; ++i) {
        // Every product is below 2^53.
        const double real = (2.0 * i + 1 - n) * spread * static_cast<double>(axis) / (128.0 * n);
        const auto got = static_cast<double>(offset(i, n, spread, axis));
        const double lost = std::abs(real) * n / (2 * 65536.0);
        wrong += exact ? got != std::floor(real + 0.5) : std::abs(got - real) > 0.5001 + lost;
      }
    }
  }
  return wrong;
}

TEST(Walker, OffsetsAreRoundedFractionsOfTheAxis) { EXPECT_EQ(wrong_offsets(sample_offset), 0); }

TEST(Walker, CheckFindsAWrongReciprocal) {
  EXPECT_GT(wrong_offsets([](int i, int n, std::int32_t spread, std::int64_t axis) {
              const std::int64_t reciprocal =
                  n == 11 ? 5957 : spec::texture::kReciprocal.at(static_cast<std::size_t>(n));
              return round_shift((2 * i + 1 - n) * spread * axis * reciprocal, 23);
            }),
            0);
}

TEST(Walker, WeightsAreSymmetricAndSumToOne) {
  for (const auto kernel : {spec::texture::Kernel::kBox, spec::texture::Kernel::kTent}) {
    for (int n = 1; n <= 16; ++n) {
      std::uint32_t sum = 0;
      for (int i = 0; i < n; ++i) {
        sum += sample_weight(kernel, i, n);
        EXPECT_EQ(sample_weight(kernel, i, n), sample_weight(kernel, n - 1 - i, n));
      }
      EXPECT_EQ(sum, 256u);
    }
  }
  EXPECT_EQ(sample_weight(spec::texture::Kernel::kTent, 3, 8), 7u * 8);  // 1 3 5 7 7 5 3 1
}

TEST(Walker, TentOfFewSamplesIsABox) {
  using spec::texture::Kernel;
  for (int n = 1; n < 4; ++n) {
    EXPECT_EQ(spread_of(Kernel::kTent, n, 102), 64);
    EXPECT_EQ(spread_of(Kernel::kTent, n, 50), 50);
    for (int i = 0; i < n; ++i)
      EXPECT_EQ(sample_weight(Kernel::kTent, i, n), sample_weight(Kernel::kBox, i, n));
  }
  EXPECT_EQ(spread_of(Kernel::kTent, 4, 102), 102);
  EXPECT_EQ(spread_of(Kernel::kBox, 2, 102), 102);
}

// Candidates of the major axis whose fragments have a tent under `axis`.
TEST(Walker, KernelByAxisIsATentOnDiagonals) {
  using spec::texture::Axes, spec::texture::Kernel;
  spec::texture::Configuration p;
  for (const auto kernel : {Kernel::kBox, Kernel::kTent}) {
    p.kernel = kernel;
    EXPECT_EQ(fragment_kernel(p, 1, 16), kernel);
  }
  p.kernel = Kernel::kAxis;
  for (const auto& [axes, diagonals] :
       {std::pair{Axes::kTwo, 0b00}, {Axes::kFour, 0b1010}, {Axes::kEight, 0b01000100}}) {
    p.axes = axes;
    for (int k = 0; k < 2 << static_cast<int>(axes); ++k)
      for (int n = 1; n <= 16; ++n) {
        const bool tent = n >= 5 && (diagonals >> k & 1) != 0;
        EXPECT_EQ(fragment_kernel(p, k, n), tent ? Kernel::kAxis : Kernel::kBox) << k << " " << n;
      }
  }
  for (int n = 5; n <= 16; ++n)
    for (int i = 0; i < n; ++i)
      EXPECT_EQ(sample_weight(Kernel::kAxis, i, n), sample_weight(Kernel::kTent, i, n));
  for (int spread = 0; spread <= 128; ++spread)
    EXPECT_EQ(spread_of(Kernel::kAxis, 5, spread), std::lround(spread * std::sqrt(2.0))) << spread;
}

// ---- wrapping -----------------------------------------------------------------------------------

// GL 4.6, table 8.20, on integer texel coordinates.
int gl_wrap(Wrap wrap, std::int64_t i, int size) {
  const auto modulo = [](std::int64_t a, std::int64_t b) { return ((a % b) + b) % b; };
  const auto mirror = [](std::int64_t a) { return a >= 0 ? a : -(1 + a); };
  switch (wrap) {
    case Wrap::kRepeat:
      return static_cast<int>(modulo(i, size));
    case Wrap::kMirroredRepeat:
      return static_cast<int>((size - 1) - mirror(modulo(i, 2 * size) - size));
    case Wrap::kClampToEdge:
      break;
  }
  return static_cast<int>(std::clamp<std::int64_t>(i, 0, size - 1));
}

// A coordinate wraps as a texel index of a texture with one texel per step of the coordinate.
// Clamping is done later, per texel.
TEST(Wrap, CoordinatesWrapLikeTexelIndices) {
  for (std::int64_t whole = -4; whole <= 4; ++whole) {
    for (std::int64_t step = -2; step <= 2; ++step) {
      const std::int64_t p = whole * kOne + step;
      for (const Wrap wrap : {Wrap::kRepeat, Wrap::kMirroredRepeat})
        EXPECT_EQ(wrap_coordinate(wrap, p), gl_wrap(wrap, p, static_cast<int>(kOne)))
            << whole << ' ' << step;
      EXPECT_EQ(wrap_coordinate(Wrap::kClampToEdge, p), p);
    }
  }
}

using Position = std::function<TexelPosition(Wrap, std::int64_t, std::int32_t)>;

std::int64_t floor_divide(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

// Visits coordinates from -4 to 4: every texel edge and centre, up to two steps to either side, and
// an eighth of a texel after it.
void for_each_coordinate(int size, const std::function<void(std::int64_t)>& visit) {
  for (std::int64_t i = -8 * size; i <= 8 * size; ++i) {
    const std::int64_t at = floor_divide(i * kOne, 2 * size);
    for (std::int64_t step = -2; step <= 2; ++step) visit(at + step);
    visit(at + kOne / (8 * size));
  }
}

int nearest_differences(const Position& position, Wrap wrap, int size) {
  int count = 0;
  for_each_coordinate(size, [&](std::int64_t p) {
    const TexelPosition ours = position(wrap, p, size);
    const int gl = gl_wrap(wrap, floor_divide(p * size, kOne), size);
    if (ours.i0 == gl && ours.i1 == gl && ours.fraction == 0) return;
    // If the size is not a power of two, reflection at 2^25 - 1 - q may select the adjacent texel
    // within one step of a texel edge.
    const bool power_of_two = (size & (size - 1)) == 0;
    const std::int64_t to_edge = p * size - floor_divide(p * size, kOne) * kOne;
    const bool at_edge = to_edge <= size || to_edge >= kOne - size;
    if (wrap == Wrap::kMirroredRepeat && !power_of_two && at_edge && std::abs(ours.i0 - gl) <= 1 &&
        ours.i0 == ours.i1) {
      return;
    }
    ++count;
  });
  return count;
}

TEST(Wrapping, NearestMatchesGlForSmallSizes) {
  for (const Wrap wrap : kWraps) {
    for (int size = 1; size <= 33; ++size) {
      EXPECT_EQ(nearest_differences(nearest_position, wrap, size), 0)
          << static_cast<int>(wrap) << ' ' << size;
    }
    EXPECT_EQ(nearest_differences(nearest_position, wrap, 4096), 0);
    EXPECT_EQ(nearest_differences(nearest_position, wrap, 4095), 0);
  }
}

// Weight of each texel of a linear lookup, by GL's formulas with an exact fraction.
std::map<int, double> gl_weights(Wrap wrap, std::int64_t p, int size) {
  const std::int64_t u = p * size - kOne / 2;
  const std::int64_t i = floor_divide(u, kOne);
  const double f = static_cast<double>(u - i * kOne) / static_cast<double>(kOne);
  std::map<int, double> weights;
  weights[gl_wrap(wrap, i, size)] += 1 - f;
  weights[gl_wrap(wrap, i + 1, size)] += f;
  return weights;
}

int linear_differences(const Position& position, Wrap wrap, int size) {
  int count = 0;
  for_each_coordinate(size, [&](std::int64_t p) {
    const TexelPosition ours = position(wrap, p, size);
    std::map<int, double> difference = gl_weights(wrap, p, size);
    difference[ours.i0] -= (256 - ours.fraction) / 256.0;
    difference[ours.i1] -= ours.fraction / 256.0;
    // The fraction is rounded to 1/256; a reflected coordinate is off by one step.
    const double tolerance = 0.5 / 256 + 2.0 * size / static_cast<double>(kOne);
    for (const auto& [texel, weight] : difference) {
      if (std::abs(weight) > tolerance) {
        ++count;
        break;
      }
    }
  });
  return count;
}

TEST(Wrapping, LinearWeightsMatchGlForSmallSizes) {
  for (const Wrap wrap : kWraps) {
    for (int size = 1; size <= 33; ++size) {
      EXPECT_EQ(linear_differences(linear_position, wrap, size), 0)
          << static_cast<int>(wrap) << ' ' << size;
    }
    EXPECT_EQ(linear_differences(linear_position, wrap, 4096), 0);
    EXPECT_EQ(linear_differences(linear_position, wrap, 4095), 0);
  }
}

TEST(Wrapping, ChecksFindInjectedFaults) {
  const Position half_texel = [](Wrap wrap, std::int64_t p, std::int32_t size) {
    return linear_position(wrap, p + kOne / 2 / size, size);
  };
  const Position clamped = [](Wrap, std::int64_t p, std::int32_t size) {
    return linear_position(Wrap::kClampToEdge, p, size);
  };
  const Position mirror_off_by_one = [](Wrap wrap, std::int64_t p, std::int32_t size) {
    const std::int64_t q = p & (2 * kOne - 1);
    const std::int64_t wrong = q >= kOne ? (2 * kOne - q) : q;
    return nearest_position(wrap == Wrap::kMirroredRepeat ? Wrap::kClampToEdge : wrap,
                            wrap == Wrap::kMirroredRepeat ? wrong : p, size);
  };
  EXPECT_GT(linear_differences(half_texel, Wrap::kRepeat, 8), 0);
  EXPECT_GT(linear_differences(clamped, Wrap::kRepeat, 8), 0);
  EXPECT_GT(linear_differences(clamped, Wrap::kMirroredRepeat, 8), 0);
  EXPECT_GT(nearest_differences(mirror_off_by_one, Wrap::kMirroredRepeat, 8), 0);
}

TEST(Wrapping, ExtremeCoordinatesSelectValidTexels) {
  for (const Wrap wrap : kWraps) {
    for (const int size : {1, 2, 3, 4095, 4096}) {
      for (const std::int64_t p : {-(std::int64_t{1} << 33), (std::int64_t{1} << 33) - 1}) {
        for (const Position& position : {Position(linear_position), Position(nearest_position)}) {
          const TexelPosition x = position(wrap, p, size);
          EXPECT_GE(std::min(x.i0, x.i1), 0);
          EXPECT_LT(std::max(x.i0, x.i1), size);
          EXPECT_LE(x.fraction, 255u);
        }
      }
    }
  }
}

}  // namespace
}  // namespace deburr::sampling_test
