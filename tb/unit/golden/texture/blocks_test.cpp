// SPDX-License-Identifier: MIT
// Colours of compressed blocks. BC: every pair of end points, against real arithmetic. ETC2: blocks
// that are written mode by mode from their colours, as in the Khronos Data Format Specification.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <set>

#include "golden/texture/block_decoder.h"
#include "tb/base/random.h"

namespace deburr::blocks_test {
namespace {

using golden::texture::block_texel;
using golden::texture::decode_block;
using spec::texture::BlockRule;
using spec::texture::Format;

using Block = std::array<std::uint8_t, 16>;
using Texels = std::array<std::uint32_t, 16>;
constexpr BlockRule kRules[] = {BlockRule::kTruncated, BlockRule::kRounded};

std::uint32_t rgba(double r, double g, double b, double a = 255) {
  return static_cast<std::uint32_t>(r) | static_cast<std::uint32_t>(g) << 8 |
         static_cast<std::uint32_t>(b) << 16 | static_cast<std::uint32_t>(a) << 24;
}

// ---- BC -----------------------------------------------------------------------------------------

// A channel of 5 or 6 bits in real arithmetic. Truncated: repeating its bits multiplies by 33 / 4
// or 65 / 16. Rounded: the nearest value of 8 bits.
double widened(BlockRule rule, int v, int bits) {
  const double most = bits == 5 ? 31 : 63;
  if (rule == BlockRule::kRounded) return std::floor(v * 255 / most + 0.5);
  return std::floor(v * (bits == 5 ? 33.0 / 4 : 65.0 / 16));
}

// Truncated quotients; rounded: 1 more in the numerator.
double mean(BlockRule rule, double sum, int n) {
  return std::floor((sum + (rule == BlockRule::kRounded ? 1 : 0)) / n);
}

// The colour of a selector.
double colour(BlockRule rule, bool four, unsigned selector, double a, double b) {
  switch (selector) {
    case 0:
      return a;
    case 1:
      return b;
    case 2:
      return four ? mean(rule, a + a + b, 3) : mean(rule, a + b, 2);
    default:
      return four ? mean(rule, a + b + b, 3) : 0;
  }
}

// All pairs of 5 bits of red and of blue and all pairs of 6 bits of green, by both kinds of blocks.
TEST(Bc, ColoursOfAllEndPoints) {
  for (const BlockRule rule : kRules) {
    for (std::uint32_t ends = 0; ends < 65536; ++ends) {
      const auto p5 = static_cast<int>(ends & 31), q5 = static_cast<int>(ends >> 5 & 31);
      const auto p6 = static_cast<int>(ends & 63), q6 = static_cast<int>(ends >> 6 & 63);
      const auto r0 = static_cast<int>(ends >> 11), r1 = p5;
      const int c0 = r0 << 11 | p6 << 5 | q5, c1 = r1 << 11 | q6 << 5 | p5;
      Block block{};
      for (const std::size_t first : {std::size_t{0}, std::size_t{8}}) {
        block[first] = static_cast<std::uint8_t>(c0);
        block[first + 1] = static_cast<std::uint8_t>(c0 >> 8);
        block[first + 2] = static_cast<std::uint8_t>(c1);
        block[first + 3] = static_cast<std::uint8_t>(c1 >> 8);
        block[first + 4] = 0b11'10'01'00;
      }
      for (unsigned s = 0; s < 4; ++s) {
        for (const bool always_four : {false, true}) {
          const bool four = always_four || c0 > c1;
          const auto channel = [&](int p, int q, int bits) {
            return colour(rule, four, s, widened(rule, p, bits), widened(rule, q, bits));
          };
          const double alpha = four || s < 3 ? 255 : 0;
          const Format format = always_four ? Format::kBc3 : Format::kBc1;
          // Alpha of bc3 is that of its values.
          const std::uint32_t mask = always_four ? 0xFFFFFF : 0xFFFFFFFF;
          ASSERT_EQ(block_texel(format, rule, block.data(), s, 0) & mask,
                    rgba(channel(r0, r1, 5), channel(p6, q6, 6), channel(q5, p5, 5), alpha) & mask)
              << c0 << ", " << c1 << ", " << s;
        }
      }
    }
  }
}

TEST(Bc, ValuesOfAllEndPoints) {
  for (const BlockRule rule : kRules) {
    for (int ends = 0; ends < 65536; ++ends) {
      const int a = ends & 255, b = ends >> 8;
      // Selectors 0 to 7 in the first two rows: 3 bits each from the lowest on.
      const Block block = {static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b), 0x88, 0xC6,
                           0xFA};
      for (unsigned s = 0; s < 8; ++s) {
        const int n = a > b ? 7 : 5;
        double expected = s == 0 ? a : b;
        if (s > 1) {
          const double t = static_cast<int>(s) - 1;
          expected = s > 5 && a <= b ? (s == 6 ? 0 : 255) : mean(rule, (n - t) * a + t * b, n);
        }
        ASSERT_EQ(block_texel(Format::kBc4, rule, block.data(), s % 4, s / 4),
                  rgba(expected, expected, expected))
            << a << ", " << b << ", " << s;
      }
    }
  }
}

// Writes the selectors of a block of values or colours, little-endian, texel 0 lowest.
void put_selectors(std::uint8_t* bytes, int bits, const std::array<unsigned, 16>& selectors) {
  for (int bit = 0; bit < 16 * bits; ++bit) {
    const unsigned on = selectors[static_cast<std::size_t>(bit / bits)] >> bit % bits & 1;
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] | on << bit % 8);
  }
}

// Each texel has its own selector, values in the first half of the block.
TEST(Bc, SelectorsBelongToTheirTexels) {
  tb::Random random(3);
  for (int trial = 0; trial < 1000; ++trial) {
    std::array<unsigned, 16> first{}, second{}, colours{};
    for (std::size_t i = 0; i < 16; ++i) {
      first[i] = random.below(2);
      second[i] = random.below(2);
      colours[i] = random.below(2);
    }
    Block bc3 = {10, 20, 0, 0, 0, 0, 0, 0, 0x00, 0xF8, 0x1F, 0x00};  // red and blue
    put_selectors(&bc3[2], 3, first);
    put_selectors(&bc3[12], 2, colours);
    Block bc5 = {10, 20, 0, 0, 0, 0, 0, 0, 30, 40};
    put_selectors(&bc5[2], 3, first);
    put_selectors(&bc5[10], 3, second);
    const Texels of_bc3 = decode_block(Format::kBc3, BlockRule::kTruncated, bc3.data());
    const Texels of_bc5 = decode_block(Format::kBc5, BlockRule::kTruncated, bc5.data());
    const Texels of_bc1 = decode_block(Format::kBc1, BlockRule::kTruncated, &bc3[8]);
    for (std::size_t i = 0; i < 16; ++i) {
      const double red = colours[i] == 0 ? 255 : 0, value = first[i] == 0 ? 10 : 20;
      ASSERT_EQ(of_bc1[i], rgba(red, 0, 255 - red));
      ASSERT_EQ(of_bc3[i], rgba(red, 0, 255 - red, value));
      ASSERT_EQ(of_bc5[i], rgba(value, second[i] == 0 ? 30 : 40, 0));
    }
  }
}

// ---- ETC2 ---------------------------------------------------------------------------------------

// The 64 bits of a half of a block, byte 0 highest.
class Bits {
 public:
  // The next fields of a colour: pairs of high and low bit, most significant first.
  void put(unsigned value, std::initializer_list<std::array<int, 2>> fields) {
    int width = 0;
    for (const auto& [high, low] : fields) width += high - low + 1;
    for (const auto& [high, low] : fields)
      for (int bit = high; bit >= low; --bit) put_bit(bit, value >> --width & 1);
  }
  void put_bit(int bit, unsigned on) {
    bits_ = (bits_ & ~(std::uint64_t{1} << bit)) | std::uint64_t{on} << bit;
  }
  void put_into(std::uint8_t* bytes) const {
    for (int byte = 0; byte < 8; ++byte)
      bytes[byte] = static_cast<std::uint8_t>(bits_ >> (56 - 8 * byte));
  }
  int bits(int high, int low) const {
    return static_cast<int>(bits_ >> low & ((std::uint64_t{2} << (high - low)) - 1));
  }

 private:
  std::uint64_t bits_ = 0;
};

// Distances and modifiers again, as the specification prints them.
constexpr std::array<std::array<int, 4>, 8> kTable = {{{-8, -2, 2, 8},
                                                       {-17, -5, 5, 17},
                                                       {-29, -9, 9, 29},
                                                       {-42, -13, 13, 42},
                                                       {-60, -18, 18, 60},
                                                       {-80, -24, 24, 80},
                                                       {-106, -33, 33, 106},
                                                       {-183, -47, 47, 183}}};
constexpr std::array<int, 8> kDistance = {3, 6, 11, 16, 23, 32, 41, 64};
constexpr std::array<int, 4> kColumn = {2, 3, 1, 0};  // of kTable, by selector
constexpr std::array<std::array<int, 8>, 16> kAlpha = {{{-3, -6, -9, -15, 2, 5, 8, 14},
                                                        {-3, -7, -10, -13, 2, 6, 9, 12},
                                                        {-2, -5, -8, -13, 1, 4, 7, 12},
                                                        {-2, -4, -6, -13, 1, 3, 5, 12},
                                                        {-3, -6, -8, -12, 2, 5, 7, 11},
                                                        {-3, -7, -9, -11, 2, 6, 8, 10},
                                                        {-4, -7, -8, -11, 3, 6, 7, 10},
                                                        {-3, -5, -8, -11, 2, 4, 7, 10},
                                                        {-2, -6, -8, -10, 1, 5, 7, 9},
                                                        {-2, -5, -8, -10, 1, 4, 7, 9},
                                                        {-2, -4, -8, -10, 1, 3, 7, 9},
                                                        {-2, -5, -7, -10, 1, 4, 6, 9},
                                                        {-3, -4, -7, -10, 2, 3, 6, 9},
                                                        {-1, -2, -3, -10, 0, 1, 2, 9},
                                                        {-4, -6, -8, -9, 3, 5, 7, 8},
                                                        {-3, -5, -7, -9, 2, 4, 6, 8}}};

using Rgb = std::array<int, 3>;

// A colour of n bits per channel. Repeating its bits multiplies by (2^n + 1) / 2^(2 n - 8).
Rgb wide(const Rgb& colour, int bits) {
  Rgb result{};
  for (std::size_t c = 0; c < 3; ++c)
    result[c] =
        static_cast<int>(std::floor(colour[c] * (std::exp2(bits) + 1) / std::exp2(2 * bits - 8)));
  return result;
}
std::uint32_t with(const Rgb& colour, int distance) {
  const auto channel = [&](std::size_t c) { return std::clamp(colour[c] + distance, 0, 255); };
  return rgba(channel(0), channel(1), channel(2));
}
Rgb any_colour(tb::Random& random, int bits) {
  const auto channel = [&] { return static_cast<int>(random.below(1u << bits)); };
  return {channel(), channel(), channel()};
}

// A block and its texels.
struct Sample {
  Bits bits;
  Texels texels{};
};
std::array<unsigned, 16> put_any_selectors(tb::Random& random, Bits& bits) {
  std::array<unsigned, 16> selectors{};  // by 4 y + x
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      const unsigned s = random.below(4);
      selectors[static_cast<std::size_t>(4 * y + x)] = s;
      bits.put_bit(16 + 4 * x + y, s >> 1);
      bits.put_bit(4 * x + y, s & 1);
    }
  }
  return selectors;
}

// Sets the spare bits of a mode so that R + dR, G + dG, B + dB (channels 0, 1, 2) select it:
// `outside` is the first one that is not in 0..31.
void put_mode(tb::Random& random, Bits& bits, std::initializer_list<int> spare, int outside) {
  const auto of = [&](int channel) {
    const int high = 63 - 8 * channel;
    const int base = bits.bits(high, high - 4), d = bits.bits(high - 5, high - 7);
    return base + (d < 4 ? d : d - 8);
  };
  const auto fits = [&] {
    for (int channel = 0; channel <= outside; ++channel) {
      const bool is_outside = of(channel) < 0 || of(channel) > 31;
      if (is_outside != (channel == outside)) return false;
    }
    return true;
  };
  do {
    for (const int bit : spare) bits.put_bit(bit, random.below(2));
  } while (!fits());
}

Sample two_colours(tb::Random& random, bool individual, bool opaque) {
  Sample sample;
  Bits& bits = sample.bits;
  std::array<Rgb, 2> colours = {any_colour(random, individual ? 4 : 5), any_colour(random, 4)};
  bits.put_bit(33, opaque ? 1 : 0);
  for (std::size_t c = 0; c < 3; ++c) {
    const int high = 63 - 8 * static_cast<int>(c);
    if (individual) {
      bits.put(static_cast<unsigned>(colours[0][c]), {{high, high - 3}});
      bits.put(static_cast<unsigned>(colours[1][c]), {{high - 4, high - 7}});
    } else {
      const int least = std::max(-4, -colours[0][c]), most = std::min(3, 31 - colours[0][c]);
      const int d = least + static_cast<int>(random.below(static_cast<unsigned>(most - least + 1)));
      colours[1][c] = colours[0][c] + d;
      bits.put(static_cast<unsigned>(colours[0][c]), {{high, high - 4}});
      bits.put(static_cast<unsigned>(d) & 7, {{high - 5, high - 7}});
    }
  }
  const std::array<unsigned, 2> tables = {random.below(8), random.below(8)};
  bits.put(tables[0], {{39, 37}});
  bits.put(tables[1], {{36, 34}});
  const bool flip = random.below(2) != 0;
  bits.put_bit(32, flip ? 1 : 0);
  const auto selectors = put_any_selectors(random, bits);
  const bool holes = !individual && !opaque;
  for (std::size_t i = 0; i < 16; ++i) {
    const std::size_t part = (flip ? i / 4 : i % 4) / 2;
    int modifier = kTable[tables[part]][static_cast<std::size_t>(kColumn[selectors[i]])];
    if (holes && selectors[i] == 0) modifier = 0;
    sample.texels[i] = with(wide(colours[part], individual ? 4 : 5), modifier);
    if (holes && selectors[i] == 2) sample.texels[i] = 0;
  }
  return sample;
}

Sample t_mode(tb::Random& random, bool opaque) {
  Sample sample;
  Bits& bits = sample.bits;
  const Rgb a = any_colour(random, 4), b = any_colour(random, 4);
  const unsigned t = random.below(8);
  bits.put(static_cast<unsigned>(a[0]), {{60, 59}, {57, 56}});
  bits.put(static_cast<unsigned>(a[1]), {{55, 52}});
  bits.put(static_cast<unsigned>(a[2]), {{51, 48}});
  bits.put(static_cast<unsigned>(b[0]), {{47, 44}});
  bits.put(static_cast<unsigned>(b[1]), {{43, 40}});
  bits.put(static_cast<unsigned>(b[2]), {{39, 36}});
  bits.put(t, {{35, 34}, {32, 32}});
  bits.put_bit(33, opaque ? 1 : 0);
  put_mode(random, bits, {63, 62, 61, 58}, 0);
  const auto selectors = put_any_selectors(random, bits);
  for (std::size_t i = 0; i < 16; ++i) {
    const std::array<std::uint32_t, 4> paint = {with(wide(a, 4), 0), with(wide(b, 4), kDistance[t]),
                                                opaque ? with(wide(b, 4), 0) : 0,
                                                with(wide(b, 4), -kDistance[t])};
    sample.texels[i] = paint[selectors[i]];
  }
  return sample;
}

Sample h_mode(tb::Random& random, bool opaque) {
  Sample sample;
  Bits& bits = sample.bits;
  const Rgb a = any_colour(random, 4);
  const Rgb b = random.below(8) == 0 ? a : any_colour(random, 4);
  const auto number = [](const Rgb& c) { return c[0] * 256 + c[1] * 16 + c[2]; };
  const unsigned t = random.below(4) * 2 + (number(a) >= number(b) ? 1 : 0);
  bits.put(static_cast<unsigned>(a[0]), {{62, 59}});
  bits.put(static_cast<unsigned>(a[1]), {{58, 56}, {52, 52}});
  bits.put(static_cast<unsigned>(a[2]), {{51, 51}, {49, 47}});
  bits.put(static_cast<unsigned>(b[0]), {{46, 43}});
  bits.put(static_cast<unsigned>(b[1]), {{42, 39}});
  bits.put(static_cast<unsigned>(b[2]), {{38, 35}});
  bits.put(t / 2, {{34, 34}, {32, 32}});
  bits.put_bit(33, opaque ? 1 : 0);
  put_mode(random, bits, {63, 55, 54, 53, 50}, 1);
  const auto selectors = put_any_selectors(random, bits);
  for (std::size_t i = 0; i < 16; ++i) {
    const std::array<std::uint32_t, 4> paint = {
        with(wide(a, 4), kDistance[t]), with(wide(a, 4), -kDistance[t]),
        opaque ? with(wide(b, 4), kDistance[t]) : 0, with(wide(b, 4), -kDistance[t])};
    sample.texels[i] = paint[selectors[i]];
  }
  return sample;
}

Sample planar(tb::Random& random, bool opaque) {
  Sample sample;
  Bits& bits = sample.bits;
  std::array<std::array<unsigned, 3>, 3> v{};  // O, H, V
  for (auto& colour : v) colour = {random.below(64), random.below(128), random.below(64)};
  bits.put(v[0][0], {{62, 57}});
  bits.put(v[0][1], {{56, 56}, {54, 49}});
  bits.put(v[0][2], {{48, 48}, {44, 43}, {41, 39}});
  bits.put(v[1][0], {{38, 34}, {32, 32}});
  bits.put(v[1][1], {{31, 25}});
  bits.put(v[1][2], {{24, 19}});
  bits.put(v[2][0], {{18, 13}});
  bits.put(v[2][1], {{12, 6}});
  bits.put(v[2][2], {{5, 0}});
  bits.put_bit(33, opaque ? 1 : 0);
  put_mode(random, bits, {63, 55, 47, 46, 45, 42}, 2);
  for (int i = 0; i < 16; ++i) {
    std::array<double, 3> channels{};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto at = [&](std::size_t k) {
        return wide({static_cast<int>(v[k][c]), 0, 0}, c == 1 ? 7 : 6)[0];
      };
      const double x = i % 4, y = std::floor(i / 4.0);
      const double exact = at(0) + x / 4 * (at(1) - at(0)) + y / 4 * (at(2) - at(0));
      channels[c] = std::clamp(std::floor(exact + 0.5), 0.0, 255.0);
    }
    sample.texels[static_cast<std::size_t>(i)] = rgba(channels[0], channels[1], channels[2]);
  }
  return sample;
}

using Mode = Sample (*)(tb::Random&, bool);
constexpr int kSamples = 20'000;  // every table, selector and channel value is drawn many times

void expect_texels(Format format, Mode mode, bool opaque) {
  tb::Random random(17);
  for (int i = 0; i < kSamples; ++i) {
    const Sample sample = mode(random, opaque);
    Block block{};
    sample.bits.put_into(block.data());
    ASSERT_EQ(decode_block(format, BlockRule::kTruncated, block.data()), sample.texels) << i;
    ASSERT_EQ(decode_block(format, BlockRule::kRounded, block.data()), sample.texels) << i;
  }
}

Sample individual_mode(tb::Random& random, bool opaque) {
  return two_colours(random, true, opaque);
}
Sample differential_mode(tb::Random& random, bool opaque) {
  return two_colours(random, false, opaque);
}

TEST(Etc2, IndividualMode) { expect_texels(Format::kEtc2Rgb, individual_mode, false); }

TEST(Etc2, EveryOtherModeIsOpaqueInRgb) {
  for (const Mode mode : {differential_mode, t_mode, h_mode, planar})
    expect_texels(Format::kEtc2Rgb, mode, true);
}

TEST(Etc2, EveryModeOfTheFormatWithAlphaOfOneBit) {
  for (const Mode mode : {differential_mode, t_mode, h_mode, planar})
    for (const bool opaque : {false, true}) expect_texels(Format::kEtc2RgbA1, mode, opaque);
}

TEST(Etc2, AlphaOfAllBasesMultipliersTablesAndSelectors) {
  tb::Random random(5);
  for (unsigned table = 0; table < 16; ++table) {
    for (unsigned multiplier = 0; multiplier < 16; ++multiplier) {
      for (unsigned base = 0; base < 256; ++base) {
        Bits alpha;
        alpha.put(base, {{63, 56}});
        alpha.put(multiplier, {{55, 52}});
        alpha.put(table, {{51, 48}});
        const unsigned first = random.below(8);
        for (int i = 0; i < 16; ++i)
          alpha.put((first + 3 * static_cast<unsigned>(i)) % 8, {{47 - 3 * i, 45 - 3 * i}});
        const Sample colours = individual_mode(random, false);
        Block block{};
        alpha.put_into(block.data());
        colours.bits.put_into(&block[8]);
        for (unsigned i = 0; i < 16; ++i) {  // i = 4 x + y
          const int distance = kAlpha[table][(first + 3 * i) % 8] * static_cast<int>(multiplier);
          const auto expected =
              static_cast<std::uint32_t>(std::clamp(static_cast<int>(base) + distance, 0, 255));
          ASSERT_EQ(
              block_texel(Format::kEtc2Rgba8, BlockRule::kTruncated, block.data(), i / 4, i % 4),
              (colours.texels[i % 4 * 4 + i / 4] & 0xFFFFFF) | expected << 24)
              << table << ", " << multiplier << ", " << base;
        }
      }
    }
  }
}

// As after a memory error.
TEST(Blocks, ZeroBlocksHaveTheTexelsOfThePage) {
  const Block zero{};
  for (const BlockRule rule : kRules) {
    for (const auto& [format, texel] :
         {std::pair{Format::kBc1, 0xFF000000u}, std::pair{Format::kBc3, 0u},
          std::pair{Format::kBc4, 0xFF000000u}, std::pair{Format::kBc5, 0xFF000000u},
          std::pair{Format::kEtc2Rgb, 0xFF020202u}, std::pair{Format::kEtc2RgbA1, 0xFF000000u},
          std::pair{Format::kEtc2Rgba8, 0x00020202u}}) {
      Texels all{};
      all.fill(texel);
      EXPECT_EQ(decode_block(format, rule, zero.data()), all) << static_cast<int>(format);
    }
  }
}

}  // namespace
}  // namespace deburr::blocks_test
