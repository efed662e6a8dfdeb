// SPDX-License-Identifier: MIT
// The BlockDecoder alone: its cycles, and blocks whose texels are computed by hand from
// docs/reference/texture/compressed.md.
#include "rtl_model/texture/block_decoder.h"

#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/cache_bench.h"

namespace deburr::tb::texture_rtl::block_decoder_test {
namespace {

using namespace rtl::texture;
using spec::texture::BlockRule;
using spec::texture::Format;
using testing::ElementsAre;

spec::texture::Parameters build(std::int32_t decoders = 0, BlockRule rule = BlockRule::kTruncated) {
  spec::texture::Parameters p;
  p.decode = spec::texture::Decode::kAfter;
  p.cache_decoders = decoders;
  p.bc = rule;
  return p;
}

struct Bench {
  explicit Bench(const spec::texture::Parameters& p, const std::string& name = "")
      : clock((name + "clock").c_str(), period()),
        ends(clock, name),
        unit((name + "unit").c_str(), clock, p) {
    unit.blocks_in(ends.in);
    unit.texels_out(ends.out);
  }
  ClockDomain clock;
  Ends<BlockGroup, TexelQuadToken> ends;
  BlockDecoder unit;
};

// A request of `blocks` distinct blocks; 0: of texels.
BlockGroup request_of(std::uint8_t blocks, std::uint32_t tag = 0) {
  BlockGroup group{};
  group.count = 1;
  group.at[0].ticket = ticket(tag);
  group.at[0].control.codec = blocks == 0 ? std::uint8_t{0} : codec_of(Format::kBc1);
  group.blocks = blocks;
  for (std::uint8_t i = 0; i < 4 && blocks != 0; ++i)
    group.at[0].index[i] = std::min<std::uint8_t>(i, static_cast<std::uint8_t>(blocks - 1));
  return group;
}

// ---- Cycles -------------------------------------------------------------------------------------

// Decoders, and blocks of each request.
class Timing : public testing::TestWithParam<std::tuple<std::int32_t, std::uint8_t>> {};
TEST_P(Timing, LatencyAndIntervalMatchDatasheet) {
  const auto& [decoders, blocks] = GetParam();
  Bench b(build(decoders));
  for (std::uint32_t i = 0; i < 6; ++i) b.ends.source.add(request_of(blocks, i));
  b.clock.run(60);
  ASSERT_EQ(b.ends.sink.taken.size(), 6u);
  rtl::Datasheet sheet = BlockDecoder::datasheet(build(decoders));
  const auto passes =
      std::max<std::uint32_t>(1, (blocks + static_cast<std::uint32_t>(decoders) - 1) /
                                     static_cast<std::uint32_t>(decoders));
  sheet.latency.cycles += passes - 1;
  sheet.interval.cycles = passes;
  const auto check = [&](const rtl::Datasheet& expected) {
    expect_cycles(expected, cycles_of(b.ends.sink), 1);
  };
  expect_detects_one_cycle(sheet, &rtl::Datasheet::latency, check);
  expect_detects_one_cycle(sheet, &rtl::Datasheet::interval, check);
  EXPECT_EQ(b.unit.blocks.value(), 6u * blocks);
  EXPECT_EQ(b.unit.stalled_cycles(), 0u);
}
INSTANTIATE_TEST_SUITE_P(TextureRtlBlockDecoder, Timing,
                         testing::Combine(testing::Range(1, 5),
                                          testing::Range<std::uint8_t>(0, 5)));

// The row "in a cycle" of the page, with a request in each cycle from 1 on and a link of two
// entries behind the unit. Returns the cycles in which the sink can take the results.
struct Behind {
  Cycle hold_from, hold_to;  // the sink takes nothing
  Cycle registers = 2;       // between three stages
};
std::vector<Cycle> by_the_page(const std::vector<std::uint8_t>& blocks, std::uint32_t decoders,
                               const Behind& behind) {
  std::vector<Cycle> seen;
  std::vector<bool> stage(behind.registers);  // true: a request with all its blocks
  std::size_t next = 0;
  std::uint32_t left = 0;
  std::vector<Cycle> freed, pushed;  // of the link
  for (Cycle t = 1; seen.size() < blocks.size(); ++t) {
    // The sink, which sees what was pushed before.
    if (seen.size() < pushed.size() && pushed[seen.size()] < t &&
        (t < behind.hold_from || t >= behind.hold_to)) {
      seen.push_back(t);
      freed.push_back(t);
    }
    const bool full =
        pushed.size() >= 2 && (freed.size() < pushed.size() - 1 || freed[pushed.size() - 2] >= t);
    if (stage.back() && full) continue;
    if (stage.back()) pushed.push_back(t);
    bool complete = false;
    if (left != 0) {
      complete = --left == 0;
    } else if (next < blocks.size()) {
      left = blocks[next] == 0 ? 0 : (blocks[next] - 1u) / decoders;
      complete = left == 0;
      ++next;
    }
    for (std::size_t s = stage.size(); s-- > 1;) stage[s] = stage[s - 1];
    stage[0] = complete;
  }
  return seen;
}

class Pressure : public testing::TestWithParam<std::tuple<std::int32_t, Cycle, Cycle>> {};
TEST_P(Pressure, StallsAsAWhole) {
  const auto& [decoders, from, length] = GetParam();
  const std::vector<std::uint8_t> blocks = {1, 4, 0, 2, 3, 3, 4, 1, 2, 4, 0, 0};
  Bench b(build(decoders));
  b.ends.sink.hold_from = from;
  b.ends.sink.hold_to = from + length;
  for (std::uint32_t i = 0; i < blocks.size(); ++i) b.ends.source.add(request_of(blocks[i], i));
  b.clock.run(120);
  Behind behind{from, from + length};
  const auto u = static_cast<std::uint32_t>(decoders);
  const std::vector<Cycle> seen = cycles_of(b.ends.sink);
  EXPECT_EQ(seen, by_the_page(blocks, u, behind));
  for (const Cycle registers : {1, 3}) {  // one cycle early, one late
    behind.registers = registers;
    if (from > 4) {  // the first result is not held
      EXPECT_NE(seen, by_the_page(blocks, u, behind));
    }
  }
  for (std::uint32_t i = 0; i < blocks.size(); ++i)
    EXPECT_EQ(b.ends.sink.taken[i].token.ticket.tag, i);
}
INSTANTIATE_TEST_SUITE_P(TextureRtlBlockDecoder, Pressure,
                         testing::Combine(testing::Range(1, 5),
                                          testing::Values<Cycle>(4, 5, 6, 7, 9),
                                          testing::Values<Cycle>(0, 1, 2, 3, 8)));

TEST(TextureRtlBlockDecoder, ResetForgetsARequestInPasses) {
  Bench b(build(1));
  b.ends.source.add(request_of(4));
  b.clock.run(3);
  b.clock.set_reset_n(false);
  b.clock.run(1);
  b.clock.set_reset_n(true);
  b.ends.in.reset();
  b.clock.run(10);
  EXPECT_TRUE(b.ends.sink.taken.empty());
  const Cycle begin = b.clock.cycle();
  b.ends.source.add(request_of(1));
  b.clock.run(10);
  EXPECT_THAT(cycles_of(b.ends.sink), ElementsAre(begin + 1 + 3));
}

spec::texture::Parameters fetcher_build(BlockRule rule) {
  spec::texture::Parameters p = with_fetcher(small_cache());
  p.bc = rule;
  return p;
}

// ---- Values -------------------------------------------------------------------------------------

using Rgba = std::array<int, 4>;
constexpr Rgba kHole = {0, 0, 0, 0};

// A decoder of each rule. The BlockFetcher decodes the same block.
class TextureRtlBlocks : public testing::Test {
 protected:
  // The sixteen texels of a block, row by row, of which four make a request.
  std::array<Rgba, 16> decoded(Format format, const std::vector<std::uint64_t>& halves,
                               BlockRule rule = BlockRule::kTruncated,
                               BlockDecoder::Fault fault = BlockDecoder::Fault::kNone) {
    Bench& b = rule == BlockRule::kTruncated ? truncated_ : rounded_;
    b.unit.fault = fault;
    for (std::uint8_t quarter = 0; quarter < 4; ++quarter) {
      BlockGroup group{};
      group.count = 1;
      group.blocks = 1;
      group.at[0].ticket = ticket();
      group.at[0].control.codec = codec_of(format);
      const auto x = static_cast<std::uint8_t>(quarter % 2 * 2),
                 y = static_cast<std::uint8_t>(quarter / 2 * 2);
      group.at[0].control.within =
          static_cast<std::uint8_t>(x | (x + 1) << 2 | y << 4 | (y + 1) << 6);
      for (std::size_t n = 0; n < halves.size(); ++n) {
        group.block[0][2 * n] = static_cast<std::uint32_t>(halves[n]);
        group.block[0][2 * n + 1] = static_cast<std::uint32_t>(halves[n] >> 32);
      }
      b.ends.source.add(group);
    }
    const std::size_t first = b.ends.sink.taken.size();
    b.clock.run(10);
    std::array<Rgba, 16> texels{};
    EXPECT_EQ(b.ends.sink.taken.size(), first + 4);
    for (std::size_t q = 0; first + q < b.ends.sink.taken.size(); ++q)
      for (std::size_t i = 0; i < 4; ++i) {
        const std::uint32_t word = b.ends.sink.taken[first + q].token.texel[i];
        const std::size_t at = 4 * (q / 2 * 2 + i / 2) + q % 2 * 2 + i % 2;
        for (std::size_t c = 0; c < 4; ++c) texels[at][c] = static_cast<int>(word >> (8 * c) & 255);
      }
    FetcherBench& fetcher = rule == BlockRule::kTruncated ? truncated_fetcher_ : rounded_fetcher_;
    fetcher.unit.fault = fault;
    fetcher.unit.invalidate();
    fetcher.ask(format, 0, 0);
    fetcher.answer(fetcher.asked().tag, bytes_of(halves));
    const rtl::MemoryResponse line = fetcher.filled();
    for (std::size_t i = 0; i < line.data.size() && fault < BlockFault::kEdge; ++i)
      EXPECT_EQ(line.data[i], texels[i / 4][i % 4]) << "texel " << i / 4;
    return texels;
  }

  FetcherBench truncated_fetcher_{fetcher_build(BlockRule::kTruncated), "fetcher_"},
      rounded_fetcher_{fetcher_build(BlockRule::kRounded), "rounded_fetcher_"};
  Bench truncated_{build(4)}, rounded_{build(4, BlockRule::kRounded), "rounded_"};
};
Rgba opaque(int r, int g, int b) { return {r, g, b, 255}; }
Rgba grey(int v) { return {v, v, v, 255}; }

// Colours with the selectors 0, 1, 2, 3 in row 0, then rows of 1, of 2 and of 3.
constexpr std::uint64_t bc_colours(std::uint64_t c0, std::uint64_t c1) {
  return c0 | c1 << 16 | std::uint64_t{0xFFAA'55E4} << 32;
}
// Row 0 and the selectors of the others.
void expect_rows(const std::array<Rgba, 16>& texels, const std::array<Rgba, 4>& colours) {
  for (std::size_t x = 0; x < 4; ++x) {
    EXPECT_EQ(texels[x], colours[x]) << "selector " << x;
    for (std::size_t y = 1; y < 4; ++y) EXPECT_EQ(texels[4 * y + x], colours[y]) << x << ' ' << y;
  }
}

// 5 and 6 bits: R 3, G 11, B 31; differs between the rules.
constexpr std::uint64_t kColour = 3 << 11 | 11 << 5 | 31;

TEST_F(TextureRtlBlocks, Bc1HasFourColours) {
  expect_rows(decoded(Format::kBc1, {bc_colours(0xF800, 0x001F)}),
              {opaque(255, 0, 0), opaque(0, 0, 255), opaque(170, 0, 85), opaque(85, 0, 170)});
  expect_rows(decoded(Format::kBc1, {bc_colours(kColour, 0)}),
              {opaque(24, 44, 255), opaque(0, 0, 0), opaque(16, 29, 170), opaque(8, 14, 85)});
  expect_rows(decoded(Format::kBc1, {bc_colours(kColour, 0)}, BlockRule::kRounded),
              {opaque(25, 45, 255), opaque(0, 0, 0), opaque(17, 30, 170), opaque(8, 15, 85)});
}

TEST_F(TextureRtlBlocks, Bc1HasThreeColoursAndClear) {
  expect_rows(decoded(Format::kBc1, {bc_colours(0, kColour)}),
              {opaque(0, 0, 0), opaque(24, 44, 255), opaque(12, 22, 127), kHole});
  expect_rows(decoded(Format::kBc1, {bc_colours(0, kColour)}, BlockRule::kRounded),
              {opaque(0, 0, 0), opaque(25, 45, 255), opaque(13, 23, 128), kHole});
  expect_rows(decoded(Format::kBc1, {bc_colours(0xF800, 0xF800)}),
              {opaque(255, 0, 0), opaque(255, 0, 0), opaque(255, 0, 0), kHole});
}

// Selector of texel i: i mod 8.
constexpr std::uint64_t bc_values(std::uint64_t a, std::uint64_t b) {
  return a | b << 8 | std::uint64_t{07654'3210'7654'3210} << 16;
}
const std::array<int, 8> kDescending = {200, 50, 178, 157, 135, 114, 92, 71},
                         kDescendingRounded = {200, 50, 178, 157, 135, 114, 93, 71},
                         kAscending = {51, 200, 80, 110, 140, 170, 0, 255},
                         kAscendingRounded = {51, 200, 81, 110, 140, 170, 0, 255};

// Always four colours; alpha in both modes.
TEST_F(TextureRtlBlocks, Bc3HasFourColoursAndAlpha) {
  for (const auto& [a, b, rule, alpha] : {std::tuple{200, 50, BlockRule::kTruncated, kDescending},
                                          {200, 50, BlockRule::kRounded, kDescendingRounded},
                                          {51, 200, BlockRule::kTruncated, kAscending},
                                          {51, 200, BlockRule::kRounded, kAscendingRounded}}) {
    const bool up = rule == BlockRule::kRounded;
    const std::array<Rgba, 4> colours = {Rgba{}, up ? Rgba{25, 45, 255} : Rgba{24, 44, 255},
                                         up ? Rgba{8, 15, 85} : Rgba{8, 14, 85},
                                         up ? Rgba{17, 30, 170} : Rgba{16, 29, 170}};
    const auto texels =
        decoded(Format::kBc3,
                {bc_values(static_cast<std::uint64_t>(a), static_cast<std::uint64_t>(b)),
                 bc_colours(0, kColour)},
                rule);
    for (std::size_t i = 0; i < 16; ++i) {
      Rgba expected = colours[i < 4 ? i : i / 4];
      expected[3] = alpha[i % 8];
      EXPECT_EQ(texels[i], expected) << i;
    }
  }
}

TEST_F(TextureRtlBlocks, Bc4AndBc5HaveOneAndTwoValues) {
  const auto one = decoded(Format::kBc4, {bc_values(200, 50)}),
             two = decoded(Format::kBc5, {bc_values(51, 200), bc_values(200, 50)});
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_EQ(one[i], grey(kDescending[i % 8])) << i;
    EXPECT_EQ(two[i], opaque(kAscending[i % 8], kDescending[i % 8], 0)) << i;
  }
  EXPECT_EQ(decoded(Format::kBc4, {bc_values(50, 50)})[7], grey(255)) << "equal: not descending";
}

// A number of 64 bits, byte 0 highest, from fields by their lowest bit.
std::uint64_t big(const std::vector<std::pair<unsigned, std::uint64_t>>& fields) {
  std::uint64_t bits = 0, turned = 0;
  for (const auto& [low, value] : fields) bits |= value << low;
  for (unsigned i = 0; i < 8; ++i) turned |= (bits >> (56 - 8 * i) & 255) << (8 * i);
  return turned;
}
using Fields = std::vector<std::pair<unsigned, std::uint64_t>>;
// The selectors 0, 1, 2, 3 in the rows 0, 1, 2, 3.
Fields with_rows(Fields fields) {
  fields.insert(fields.end(), {{16, 0xCCCC}, {0, 0xAAAA}});
  return fields;
}
// One colour per row, of columns 0 and 1 and of columns 2 and 3.
void expect_columns(const std::array<Rgba, 16>& texels, const std::array<Rgba, 4>& left,
                    const std::array<Rgba, 4>& right) {
  for (std::size_t y = 0; y < 4; ++y)
    for (std::size_t x = 0; x < 4; ++x)
      EXPECT_EQ(texels[4 * y + x], (x < 2 ? left : right)[y]) << x << ' ' << y;
}

// Colours (1, 2, 3) and (15, 14, 13), tables 0 (2, 8) and 7 (47, 183).
Fields individual() {
  return with_rows({{60, 1}, {56, 15}, {52, 2}, {48, 14}, {44, 3}, {40, 13}, {37, 0}, {34, 7}});
}
TEST_F(TextureRtlBlocks, EtcIndividual) {
  const std::array<Rgba, 4> first = {opaque(19, 36, 53), opaque(25, 42, 59), opaque(15, 32, 49),
                                     opaque(9, 26, 43)},
                            second = {grey(255), grey(255), opaque(208, 191, 174),
                                      opaque(72, 55, 38)};
  expect_columns(decoded(Format::kEtc2Rgb, {big(individual())}), first, second);
  Fields flipped = individual();
  flipped.emplace_back(32, 1);
  const std::array<Rgba, 4> halves = {first[0], first[1], second[2], second[3]};
  expect_columns(decoded(Format::kEtc2Rgb, {big(flipped)}), halves, halves);
}

// Colours (10, 20, 31) and (6, 23, 30), tables 1 (5, 17) and 2 (9, 29).
Fields differential(std::uint64_t d) {
  return with_rows(
      {{59, 10}, {56, 4}, {51, 20}, {48, 3}, {43, 31}, {40, 7}, {37, 1}, {34, 2}, {33, d}});
}
TEST_F(TextureRtlBlocks, EtcDifferential) {
  const std::array<Rgba, 4> left = {opaque(87, 170, 255), opaque(99, 182, 255),
                                    opaque(77, 160, 250), opaque(65, 148, 238)},
                            right = {opaque(58, 198, 255), opaque(78, 218, 255),
                                     opaque(40, 180, 238), opaque(20, 160, 218)};
  expect_columns(decoded(Format::kEtc2Rgb, {big(differential(1))}), left, right);
  expect_columns(decoded(Format::kEtc2RgbA1, {big(differential(1))}), left, right);
  expect_columns(decoded(Format::kEtc2RgbA1, {big(differential(0))}),
                 {opaque(82, 165, 255), left[1], kHole, left[3]},
                 {opaque(49, 189, 247), right[1], kHole, right[3]});
}

// R = 2, dR = -3. a = (9, 2, 3), b = (4, 5, 6), distance 5 of the table: 32.
Fields t_mode(std::uint64_t d) {
  return with_rows(
      {{59, 2}, {56, 5}, {52, 2}, {48, 3}, {44, 4}, {40, 5}, {36, 6}, {34, 2}, {33, d}, {32, 1}});
}
TEST_F(TextureRtlBlocks, EtcT) {
  const std::array<Rgba, 4> colours = {opaque(153, 34, 51), opaque(100, 117, 134),
                                       opaque(68, 85, 102), opaque(36, 53, 70)},
                            holes = {colours[0], colours[1], kHole, colours[3]};
  expect_columns(decoded(Format::kEtc2Rgb, {big(t_mode(1))}), colours, colours);
  expect_columns(decoded(Format::kEtc2RgbA1, {big(t_mode(1))}), colours, colours);
  expect_columns(decoded(Format::kEtc2RgbA1, {big(t_mode(0))}), holes, holes);
}

// R = 5, dR = 3; G = 1, dG = -3. a = (5, 6, 11), b = (`red`, 8, 9).
Fields h_mode(std::uint64_t d, std::uint64_t red) {
  return with_rows(
      {{59, 5}, {56, 3}, {51, 1}, {48, 5}, {47, 1}, {43, red}, {39, 8}, {35, 9}, {34, 1}, {33, d}});
}
TEST_F(TextureRtlBlocks, EtcH) {
  // a < b: distance 4, which is 23.
  const std::array<Rgba, 4> less = {opaque(108, 125, 210), opaque(62, 79, 164),
                                    opaque(142, 159, 176), opaque(96, 113, 130)},
                            holes = {less[0], less[1], kHole, less[3]};
  expect_columns(decoded(Format::kEtc2Rgb, {big(h_mode(1, 7))}), less, less);
  expect_columns(decoded(Format::kEtc2RgbA1, {big(h_mode(0, 7))}), holes, holes);
  // a >= b: distance 5, which is 32.
  const std::array<Rgba, 4> more = {opaque(117, 134, 219), opaque(53, 70, 155),
                                    opaque(49, 168, 185), opaque(0, 104, 121)};
  expect_columns(decoded(Format::kEtc2Rgb, {big(h_mode(1, 1))}), more, more);
}

// B = 0, dB = -2. O = (16, 32, 4), H = (33, 100, 10), V = (5, 127, 63); widened (65, 64, 16), (134,
// 201, 40), (20, 255, 255).
Fields planar(std::uint64_t d) {
  return {{57, 16}, {56, 0}, {49, 32},  {48, 0},  {42, 1}, {39, 4},  {34, 16},
          {33, d},  {32, 1}, {25, 100}, {19, 10}, {13, 5}, {6, 127}, {0, 63}};
}
TEST_F(TextureRtlBlocks, EtcPlanar) {
  for (const auto& [format, d] : {std::pair{Format::kEtc2Rgb, 1},
                                  {Format::kEtc2RgbA1, 1},
                                  {Format::kEtc2RgbA1, 0}}) {  // without holes
    const auto texels = decoded(format, {big(planar(static_cast<std::uint64_t>(d)))});
    EXPECT_EQ(texels[0], opaque(65, 64, 16));
    EXPECT_EQ(texels[3], opaque(117, 167, 34));
    EXPECT_EQ(texels[12], opaque(31, 207, 195));
    EXPECT_EQ(texels[15], opaque(83, 255, 213));
  }
}

// Base 100, multiplier 3, table 0; then 250 x 15. Selector of texel i, by columns: i mod 8.
TEST_F(TextureRtlBlocks, EtcAlpha) {
  const std::uint64_t selectors = 0123'4567'0123'4567;
  const std::array<int, 8> inside = {91, 82, 73, 55, 106, 115, 124, 142},
                           beyond = {205, 160, 115, 25, 255, 255, 255, 255},
                           flat = {100, 100, 100, 100, 100, 100, 100, 100},
                           last = {97, 95, 93, 91, 102, 104, 106, 108};
  for (const auto& [base, factor, table, alpha] : {std::tuple{100, 3, 0, inside},
                                                   {250, 15, 0, beyond},
                                                   {100, 0, 0, flat},
                                                   {100, 1, 15, last}}) {
    const auto texels = decoded(Format::kEtc2Rgba8, {big({{56, static_cast<std::uint64_t>(base)},
                                                          {52, static_cast<std::uint64_t>(factor)},
                                                          {48, static_cast<std::uint64_t>(table)},
                                                          {0, selectors}}),
                                                     big(individual())});
    for (std::size_t y = 0; y < 4; ++y)
      for (std::size_t x = 0; x < 4; ++x) {
        EXPECT_EQ(texels[4 * y + x][3], alpha[(4 * x + y) % 8]) << x << ' ' << y;
        if (y == 0 && x < 2) {
          EXPECT_EQ(texels[x][0], 19);
        }
      }
  }
}

// Of a line whose fill had an error.
TEST_F(TextureRtlBlocks, BytesOfZeros) {
  for (const auto& [format, texel] : {std::pair{Format::kBc1, opaque(0, 0, 0)},
                                      {Format::kBc3, kHole},
                                      {Format::kBc4, opaque(0, 0, 0)},
                                      {Format::kBc5, opaque(0, 0, 0)},
                                      {Format::kEtc2Rgb, opaque(2, 2, 2)},
                                      {Format::kEtc2RgbA1, opaque(0, 0, 0)},
                                      {Format::kEtc2Rgba8, Rgba{2, 2, 2, 0}}})
    for (const Rgba& got : decoded(format, {0, 0}))
      EXPECT_EQ(got, texel) << spec::texture::kFormatNames[static_cast<std::size_t>(format)];
}

// Each injected fault changes the blocks that it is about, and no others.
TEST_F(TextureRtlBlocks, FaultsChangeTheirBlocks) {
  using Fault = BlockDecoder::Fault;
  const auto changes = [this](Fault fault, Format format,
                              const std::vector<std::uint64_t>& halves) {
    const BlockRule rule = BlockRule::kTruncated;
    return decoded(format, halves, rule, fault) != decoded(format, halves, rule);
  };
  EXPECT_TRUE(changes(Fault::kModes, Format::kEtc2Rgb, {big(t_mode(1))}));
  EXPECT_TRUE(changes(Fault::kModes, Format::kEtc2Rgb, {big(h_mode(1, 7))}));
  EXPECT_FALSE(changes(Fault::kModes, Format::kEtc2Rgb, {big(planar(1))}));
  EXPECT_FALSE(changes(Fault::kModes, Format::kEtc2Rgb, {big(differential(1))}));
  EXPECT_TRUE(changes(Fault::kSelectors, Format::kEtc2Rgb, {big(individual())}));
  EXPECT_TRUE(changes(Fault::kSelectors, Format::kBc1, {bc_colours(kColour, 0)}));
  EXPECT_FALSE(changes(Fault::kSelectors, Format::kBc4, {bc_values(200, 50)}));
  EXPECT_TRUE(changes(Fault::kValues, Format::kBc4, {bc_values(200, 50)}));
  EXPECT_TRUE(changes(Fault::kValues, Format::kBc3, {bc_values(51, 200), 0}));
  EXPECT_FALSE(changes(Fault::kValues, Format::kBc1, {bc_colours(kColour, 0)}));
  EXPECT_TRUE(changes(Fault::kHalf, Format::kBc5, {bc_values(200, 50), bc_values(51, 200)}));
  EXPECT_FALSE(changes(Fault::kHalf, Format::kBc4, {bc_values(200, 50)}));
  EXPECT_FALSE(changes(Fault::kEdge, Format::kBc1, {bc_colours(kColour, 0)})) << "one block";
  Bench& b = truncated_;
  b.unit.fault = Fault::kEdge;
  BlockGroup group = request_of(2);
  group.at[0].control.codec = codec_of(Format::kBc4);
  for (std::uint32_t k = 0; k < 2; ++k) group.block[k] = {10 + k, 0, 0, 0};
  b.ends.source.add(group);
  b.clock.run(10);
  EXPECT_EQ(b.ends.sink.taken.back().token.texel[1] & 255, 10u);
}

// ---- Requests -----------------------------------------------------------------------------------

// Each texel is taken from its block, at its place in it: of BC4, the value a of the block, or b in
// column 3.
Block block_of(std::uint32_t a, std::uint32_t b) { return {a | b << 8, 0, 0, 0}; }
TEST(TextureRtlBlockDecoder, TexelsComeFromTheirBlocks) {
  Bench b(build(2));
  BlockGroup group = request_of(3, 7);
  group.at[0].control.codec = codec_of(Format::kBc4);
  group.at[0].index = {2, 0, 1, 2};
  for (std::uint32_t k = 0; k < 3; ++k) group.block[k] = block_of(10 + k, 0);
  b.ends.source.add(group);
  b.clock.run(10);
  ASSERT_EQ(b.ends.sink.taken.size(), 1u);
  const TexelQuadToken& got = b.ends.sink.taken[0].token;
  EXPECT_EQ(got.ticket.tag, 7u);
  const std::array<std::uint32_t, 4> values = {12, 10, 11, 12};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(got.texel[i] & 255, values[i]) << i;
}

TEST(TextureRtlBlockDecoder, TexelsOutsideBlocksPass) {
  Bench b(build());
  BlockGroup group = request_of(0);
  group.at[0].texel = {1, 2, 3, 0xFFFF'FFFF};
  b.ends.source.add(group);
  group.at[0].ticket.valid = false;  // its other fields mean nothing
  group.at[0].texel = {};
  group.at[0].control.codec = 7;
  b.ends.source.add(group);
  b.clock.run(10);
  ASSERT_EQ(b.ends.sink.taken.size(), 2u);
  EXPECT_THAT(b.ends.sink.taken[0].token.texel, ElementsAre(1, 2, 3, 0xFFFF'FFFF));
  EXPECT_THAT(b.ends.sink.taken[1].token.texel, ElementsAre(0, 0, 0, 0));
}

// A group of four with three formats, in one cycle each.
TEST(TextureRtlBlockDecoder, GroupIsDecodedInOneCycle) {
  spec::texture::Parameters p = build();
  p.width = 4;
  ClockDomain clock("clock", period());
  Ends<BlockGroup, TexelQuadGroup> ends(clock);
  wide::BlockDecoder unit("unit", clock, p);
  unit.blocks_in(ends.in);
  unit.texels_out(ends.out);
  BlockGroup group{};
  group.count = 4;
  group.blocks = 6;
  for (std::uint8_t r = 0; r < 4; ++r) group.at[r].ticket = ticket(r);
  group.at[0].control.codec = codec_of(Format::kBc4);
  group.at[0].index = {0, 1, 2, 3};
  group.at[1].texel = {9, 8, 7, 6};
  group.at[2].control.codec = codec_of(Format::kBc5);
  group.at[2].index = {4, 4, 4, 5};
  group.at[3].control.codec = codec_of(Format::kBc4);
  group.at[3].index = {3, 3, 3, 0};
  for (std::uint32_t k = 0; k < 6; ++k) group.block[k] = {k + 1, 0, k + 101, 0};
  for (int i = 0; i < 5; ++i) ends.source.add(group);
  clock.run(20);
  ASSERT_EQ(ends.sink.taken.size(), 5u);
  expect_cycles(wide::BlockDecoder::datasheet(p), cycles_of(ends.sink), 1);
  const TexelQuadGroup& got = ends.sink.taken[0].token;
  EXPECT_EQ(got.count, 4);
  const std::uint32_t kGrey = 0x01'0101, kOpaque = 0xFF00'0000;
  EXPECT_THAT(got.at[0].texel, ElementsAre(kOpaque + kGrey, kOpaque + 2 * kGrey,
                                           kOpaque + 3 * kGrey, kOpaque + 4 * kGrey));
  EXPECT_THAT(got.at[1].texel, ElementsAre(9, 8, 7, 6));
  EXPECT_THAT(got.at[2].texel, ElementsAre(kOpaque + 5 + (105 << 8), kOpaque + 5 + (105 << 8),
                                           kOpaque + 5 + (105 << 8), kOpaque + 6 + (106 << 8)));
  EXPECT_EQ(got.at[3].texel[3], kOpaque + kGrey);
  EXPECT_EQ(got.at[3].ticket.tag, 3u);
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::block_decoder_test
