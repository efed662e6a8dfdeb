// SPDX-License-Identifier: MIT
// Compares the block decoder of hdl/texture with the golden model, under random stalls.
#include <VBlockRounded.h>
#include <VBlockSwapsModes.h>
#include <VBlockSwapsSelectors.h>
#include <VBlockTruncated.h>
#include <VBlockWrongAlpha.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>

#include "golden/texture/block_decoder.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/parameters.h"
#include "tb/base/random.h"

namespace deburr::tb::counterpart_block_decoder_test {
namespace {

using spec::texture::BlockRule;
using spec::texture::Format;

using Block = std::array<std::uint8_t, 16>;
using Positions = std::array<std::uint8_t, 4>;  // 4 y + x
// All texels of a block, four per cycle.
constexpr std::array<Positions, 4> kAll = {
    {{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10, 11}, {12, 13, 14, 15}}};

template <class Model>
class Comparison {
 public:
  explicit Comparison(std::uint64_t seed = 1) : random_(seed, "comparison") {
    context_.randReset(2);
    context_.randSeed(static_cast<int>(seed));
  }
  ~Comparison() { model_.final(); }

  void decode(Format format, const Block& block, const Positions& positions) {
    while (random_.chance(30)) {  // a stall: nothing changes
      clock(false, Format(random_.below(12)), random_block(), {});
      compare();
    }
    clock(true, format, block, positions);
    known_ = requests_++ != 0;  // the previous request is at the output
    expected_ = std::exchange(next_, golden(format, block, positions));
    compare();
  }
  void decode(Format format, const Block& block) {
    for (const Positions& positions : kAll) decode(format, block, positions);
  }
  void expect_equal(std::uint64_t requests) {
    decode(Format::kBc1, {}, {});
    EXPECT_EQ(differ_, 0u) << first_;
    EXPECT_GT(requests_, requests);
  }
  std::uint64_t differ() const { return differ_; }
  Random& random() { return random_; }
  Block random_block() {
    const std::array<std::uint64_t, 2> words = {random_.next(), random_.next()};
    Block block;
    std::memcpy(block.data(), words.data(), sizeof block);
    return block;
  }

 private:
  using Texels = std::array<std::uint32_t, 4>;
  static constexpr BlockRule kRule =
      std::is_same_v<Model, VBlockRounded> ? BlockRule::kRounded : BlockRule::kTruncated;

  static Texels golden(Format format, const Block& block, const Positions& positions) {
    Texels texels;
    for (std::size_t i = 0; i < 4; ++i)
      texels[i] = golden::texture::block_texel(format, kRule, block.data(), positions[i] % 4u,
                                               positions[i] / 4u);
    return texels;
  }
  void clock(bool move, Format format, const Block& block, const Positions& positions) {
    model_.move = move;
    model_.format = static_cast<CData>(format);
    std::memcpy(&model_.block[0], block.data(), sizeof block);
    model_.positions = static_cast<SData>(positions[0] | positions[1] << 4 | positions[2] << 8 |
                                          positions[3] << 12);
    model_.clk = 0;
    model_.eval();
    model_.clk = 1;
    model_.eval();
  }
  void compare() {
    if (!known_) return;
    for (std::size_t i = 0; i < 4; ++i)
      if (model_.texels[i] != expected_[i] && differ_++ == 0)
        first_ = "request " + std::to_string(requests_ - 2) + ", texel " + std::to_string(i) +
                 ": golden/counterpart " + std::to_string(expected_[i]) + "/" +
                 std::to_string(model_.texels[i]);
  }

  Random random_;
  VerilatedContext context_;
  Model model_{&context_, "model"};
  Texels expected_{}, next_{};
  bool known_ = false;
  std::uint64_t requests_ = 0, differ_ = 0;
  std::string first_;
};

// ---- blocks

void put(Block& block, std::size_t first, std::uint64_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i)
    block[first + i] = static_cast<std::uint8_t>(value >> 8 * i);
}
std::size_t colours_of(Format format) {
  return format == Format::kBc3 || format == Format::kEtc2Rgba8 ? 8 : 0;
}

// ETC2: a channel's byte holds 5 bits and a signed difference of 3. The mode depends on which sum
// is not in 0..31.
enum Mode : std::uint32_t { kIndividual, kDifferential, kT, kH, kPlanar, kModes };
std::uint8_t channel_byte(Random& random, bool outside) {
  for (;;) {
    const std::uint32_t byte = random.below(256);
    const int sum = static_cast<int>(byte >> 3) + static_cast<int>((byte & 7) ^ 4) - 4;
    if ((sum < 0 || sum > 31) == outside) return static_cast<std::uint8_t>(byte);
  }
}
void set_mode(Block& block, Format format, Mode mode, Random& random) {
  std::uint8_t* const bytes = &block[colours_of(format)];
  bytes[3] = static_cast<std::uint8_t>(mode == kIndividual ? bytes[3] & ~2u : bytes[3] | 2u);
  if (format == Format::kEtc2RgbA1 && random.chance(500)) bytes[3] ^= 2u;
  if (mode == kIndividual) return;
  bytes[0] = channel_byte(random, mode == kT);
  if (mode != kT) bytes[1] = channel_byte(random, mode == kH);
  if (mode != kT && mode != kH) bytes[2] = channel_byte(random, mode == kPlanar);
}
// A random block; each mode is as likely as the others.
template <class Model>
Block any_block(Comparison<Model>& with, Format format) {
  Block block = with.random_block();
  Random& random = with.random();
  if (format >= Format::kEtc2Rgb) {
    set_mode(block, format, static_cast<Mode>(random.below(kModes)), random);
  } else if (random.chance(10)) {  // equal end points
    put(block, 0, 0x0101u * block[0], 2);
    std::memcpy(&block[colours_of(format) + 2], &block[colours_of(format)], 2);
  }
  return block;
}
template <class Model>
std::uint64_t differing(Format format, int blocks) {
  Comparison<Model> with;
  for (int i = 0; i < blocks; ++i) {
    const std::uint32_t at = with.random().word();
    Positions positions;
    for (std::size_t k = 0; k < 4; ++k) positions[k] = static_cast<std::uint8_t>(at >> 4 * k & 15);
    with.decode(format, any_block(with, format), positions);
  }
  if (blocks >= 1'000'000) with.expect_equal(1'000'000);
  return with.differ();
}

template <class Model>
class CounterpartBlockDecoderOf : public testing::Test {};
using Rules = testing::Types<VBlockTruncated, VBlockRounded>;
TYPED_TEST_SUITE(CounterpartBlockDecoderOf, Rules);

// All 2^16 end points c0; each channel has all pairs, and green and blue in both modes.
TYPED_TEST(CounterpartBlockDecoderOf, MatchesAllColourEndPoints) {
  Comparison<TypeParam> with;
  for (const Format format : {Format::kBc1, Format::kBc3})
    for (std::uint32_t n = 0; n < 1u << 16; ++n) {
      const std::uint32_t red = n >> 11, blue = n & 31;
      const std::uint64_t pairs[] = {
          n | (blue << 11 | blue << 6 | (red & 1) << 5 | red) << 16,
          (31u << 11 | (n & 63) << 5 | n >> 11) | ((n >> 6 & 63) << 5 | blue) << 16,
          ((n & 63) << 5 | n >> 11) | (31u << 11 | (n >> 6 & 63) << 5 | blue) << 16};
      for (const std::uint64_t ends : pairs) {
        Block block{};
        put(block, colours_of(format), 0xE4E4E4E4ull << 32 | ends, 8);
        with.decode(format, block, kAll[n % 4]);
      }
    }
  with.expect_equal(6 << 16);
}
TYPED_TEST(CounterpartBlockDecoderOf, MatchesAllValues) {
  Comparison<TypeParam> with;
  for (const Format format : {Format::kBc3, Format::kBc4, Format::kBc5})
    for (std::uint32_t ends = 0; ends < 1u << 16; ++ends) {
      Block block{};
      put(block, 0, 0xFAC688FAC688ull << 16 | ends, 8);
      put(block, 8, 0xFAC688FAC688ull << 16 | (~ends & 0xFFFF), 8);
      with.decode(format, block, kAll[0]);
      with.decode(format, block, kAll[1]);
    }
  with.expect_equal(6 << 16);
}
TYPED_TEST(CounterpartBlockDecoderOf, MatchesRandomBc1) {
  differing<TypeParam>(Format::kBc1, 1'000'000);
}
TYPED_TEST(CounterpartBlockDecoderOf, MatchesRandomBc3) {
  differing<TypeParam>(Format::kBc3, 1'000'000);
}
TYPED_TEST(CounterpartBlockDecoderOf, MatchesRandomBc4) {
  differing<TypeParam>(Format::kBc4, 1'000'000);
}
TYPED_TEST(CounterpartBlockDecoderOf, MatchesRandomBc5) {
  differing<TypeParam>(Format::kBc5, 1'000'000);
}
TEST(CounterpartBlockDecoder, MatchesRandomEtc2Rgb) {
  differing<VBlockTruncated>(Format::kEtc2Rgb, 1'000'000);
}
TEST(CounterpartBlockDecoder, MatchesRandomEtc2RgbA1) {
  differing<VBlockTruncated>(Format::kEtc2RgbA1, 1'000'000);
}
TEST(CounterpartBlockDecoder, MatchesRandomEtc2Rgba8) {
  differing<VBlockTruncated>(Format::kEtc2Rgba8, 1'000'000);
}

// All bytes of a channel with all tables, distances, flips and selectors, in each mode that the
// byte allows.
void expect_equal_tables(Format format) {
  Comparison<VBlockTruncated> with;
  for (std::size_t channel = 0; channel < 3; ++channel)
    for (std::uint32_t n = 0; n < kModes << 16; ++n) {
      Block block = with.random_block();
      set_mode(block, format, static_cast<Mode>(n >> 16), with.random());
      block[channel] = static_cast<std::uint8_t>(n);
      block[3] = static_cast<std::uint8_t>(n >> 8);
      // Selector (x + y) mod 4: both halves have all of them, whatever the flip.
      put(block, 4, 0x5A5A'6C93u, 4);
      with.decode(format, block);
    }
  with.expect_equal(60 << 16);
}
TEST(CounterpartBlockDecoder, MatchesAllTablesOfEtc2Rgb) { expect_equal_tables(Format::kEtc2Rgb); }
TEST(CounterpartBlockDecoder, MatchesAllTablesOfEtc2RgbA1) {
  expect_equal_tables(Format::kEtc2RgbA1);
}
TEST(CounterpartBlockDecoder, MatchesAllTablesOfEtc2Alpha) {
  Comparison<VBlockTruncated> with;
  for (std::uint32_t n = 0; n < 1u << 16; ++n) {
    Block block{};
    put(block, 0, 0x7739'0577'3905ull << 16 | n, 8);
    with.decode(Format::kEtc2Rgba8, block);
  }
  with.expect_equal(4 << 16);
}
// All O, H and V of each channel, at all positions.
TEST(CounterpartBlockDecoder, MatchesAllPlanarBlocks) {
  Comparison<VBlockTruncated> with;
  for (std::uint32_t n = 0; n < 1u << 21; ++n) {
    std::uint64_t number = 1ull << 33;
    const auto field = [&number](unsigned high, unsigned low, std::uint32_t value) {
      number |= (value & ((std::uint64_t{2} << (high - low)) - 1)) << low;
    };
    const std::uint32_t red = n, green = n, blue = ~n;  // O lowest
    field(62, 57, red), field(38, 34, red >> 7), field(32, 32, red >> 6), field(18, 13, red >> 12);
    field(56, 56, green >> 6), field(54, 49, green), field(31, 25, green >> 7);
    field(12, 6, green >> 14);
    field(48, 48, blue >> 5), field(44, 43, blue >> 3), field(41, 39, blue);
    field(24, 19, blue >> 6), field(5, 0, blue >> 12);
    // Bits that are not of the colours: the sums of red and green are in 0..31, that of blue not.
    if ((number >> 59 & 15) < 4) field(63, 63, 1);
    if ((number >> 51 & 15) < 4) field(55, 55, 1);
    const bool above = (number >> 43 & 3) + (number >> 40 & 3) >= 4;
    field(47, 45, above ? 7 : 0), field(42, 42, !above);
    Block block{};
    for (std::size_t i = 0; i < 8; ++i)
      block[i] = static_cast<std::uint8_t>(number >> (56 - 8 * i));
    with.decode(Format::kEtc2Rgb, block);
  }
  with.expect_equal(4 << 21);
}

// ---- injected faults in the SystemVerilog

TEST(CounterpartBlockDecoderFaults, SwappedModesAreDetected) {
  EXPECT_GE(differing<VBlockSwapsModes>(Format::kEtc2Rgb, 1000), 1u);
}
TEST(CounterpartBlockDecoderFaults, SwappedSelectorBitsAreDetected) {
  EXPECT_GE(differing<VBlockSwapsSelectors>(Format::kBc1, 1000), 1u);
}
TEST(CounterpartBlockDecoderFaults, WrongAlphaModeIsDetected) {
  EXPECT_GE(differing<VBlockWrongAlpha>(Format::kBc3, 1000), 1u);
}

}  // namespace
}  // namespace deburr::tb::counterpart_block_decoder_test
