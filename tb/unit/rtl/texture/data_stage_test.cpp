// SPDX-License-Identifier: MIT
// The DataStage in the cache: bank passes, texels anywhere in a line, and hits in lines that the
// same request replaces.
#include <cstring>
#include <tuple>
#include <utility>

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/cache_bench.h"

namespace deburr::tb::texture_rtl::data_stage_test {
namespace {

using namespace rtl::texture;
using testing::ElementsAre;

TEST(TextureRtlDataStage, ReadsOneAndTwoByteTexelsAnywhereInLine) {
  CacheBench b;
  for (const auto& [format, mask] : {std::pair{spec::texture::Format::kL8, 0xFFu},
                                     std::pair{spec::texture::Format::kRgb565, 0xFFFFu}}) {
    const std::uint32_t step = format == spec::texture::Format::kL8 ? 1 : 2;
    // Cold and warm: from the fill and from the banks.
    const std::uint32_t base = format == spec::texture::Format::kL8 ? 0x1000 : 0x2000;
    for (int twice = 0; twice < 2; ++twice)
      for (std::uint32_t at = base; at < base + 128; at += 4 * step) {
        TexelToken t = request({at, at + step, at + 2 * step, at + 3 * step});
        t.control.format = static_cast<std::uint8_t>(format);
        b.time_of(t);
        for (std::size_t k = 0; k < 4; ++k) {
          const std::uint32_t byte = t.address[k] & 3;
          EXPECT_EQ(b.ends.sink.taken.back().token.texel[k],
                    CacheBench::word(t.address[k] - byte) >> (8 * byte) & mask);
        }
      }
  }
}

// A hit, and a miss that overwrites its line, in one request.
TEST(TextureRtlDataStage, HitIsReadBeforeItsLineIsOverwritten) {
  spec::texture::Parameters p = small_cache();
  p.cache_ways = 1;
  CacheBench b(p);
  const std::vector<TexelToken> asked = {in_line(0), request({0, 4, 64 * 4, 64 * 4 + 4}),
                                         in_line(4)};
  for (const auto& t : asked) b.ends.source.add(t);
  b.clock.run(100);
  b.check_data(asked);
  EXPECT_THAT(b.memory.lines_read(), ElementsAre(0, 256));
}

// Word w of a line is in bank w: words 0 and 64 conflict, 0 and 4 or 0 and 68 do not.
TEST(TextureRtlDataStage, TakesOnePassPerConflictingWord) {
  spec::texture::Parameters p = small_cache();
  p.cache_bytes = 1024;
  CacheBench b(p);
  const TexelToken plain = request({0, 68, 136, 204}), columns = request({0, 64, 20, 84}),
                   rows = request({4, 8, 68, 72}), three = request({0, 64, 128, 12}),
                   four = request({0, 64, 128, 192}), words = request({0, 1, 66, 130});
  for (const auto& t : {plain, columns, rows, three, four}) b.time_of(t);  // loads all lines
  EXPECT_EQ(b.cache.data_stage.conflicts.value(), 4u);
  EXPECT_EQ(b.time_of(plain), kHit);
  EXPECT_EQ(b.time_of(columns), kHit + 1);
  EXPECT_EQ(b.time_of(rows), kHit + 1);
  EXPECT_EQ(b.time_of(three), kHit + 2);
  EXPECT_EQ(b.time_of(four), kHit + 3);
  EXPECT_EQ(b.time_of(words), kHit + 2);  // two bytes of one word are one read
  // One after the other: 1, 2, 1, 2, 4 and 1 cycles.
  const std::size_t first = b.ends.sink.taken.size();
  const Cycle start = b.clock.cycle() + 1;
  for (const auto& t : {plain, columns, plain, rows, four, plain}) b.ends.source.add(t);
  const auto conflicts = [&] { return b.cache.data_stage.stalls()[3].cycles; };
  ASSERT_EQ(b.cache.data_stage.stalls()[3].name, "bank_conflict");
  const std::uint64_t before = conflicts();
  b.clock.run(40);
  std::vector<Cycle> when;
  for (std::size_t i = first; i < b.ends.sink.taken.size(); ++i)
    when.push_back(b.ends.sink.taken[i].cycle - start - kHit);
  EXPECT_THAT(when, ElementsAre(0, 2, 3, 5, 9, 10));
  EXPECT_EQ(conflicts() - before, 1u + 1 + 3);
}

// A row of a linear texture has the same position in its lines as the row above: with turned rows
// they do not conflict.
void check_turned_rows(std::int32_t line_bytes) {
  spec::texture::Parameters p = small_cache();
  p.cache_bytes = 4096;
  p.cache_line_bytes = line_bytes;
  CacheBench b(p);
  std::vector<TexelToken> asked;
  for (std::uint32_t x = 0; x < 256; x += 4) {
    TexelToken t = request({x, x + 4, x + 1024, x + 1028});
    t.turned = {false, true};
    asked.push_back(t);
  }
  for (const auto& t : asked) b.time_of(t);
  for (const auto& t : asked) EXPECT_EQ(b.time_of(t), kHit);
  EXPECT_EQ(b.cache.data_stage.conflicts.value(), 0u);
  // The same lines through a descriptor that does not turn them: texels are still correct.
  asked.insert(asked.end(), asked.begin(), asked.end());
  asked.push_back(request({0, 4, 1024, 1028}));
  asked.push_back(request({32, 4, 1024, 1056}));
  for (std::size_t i = asked.size() - 2; i < asked.size(); ++i) b.time_of(asked[i]);
  b.check_data(asked);
}
TEST(TextureRtlDataStage, TurnedRowsDoNotConflictInLinesOf32) { check_turned_rows(32); }
TEST(TextureRtlDataStage, TurnedRowsDoNotConflictInLinesOf64) { check_turned_rows(64); }
TEST(TextureRtlDataStage, TurnedRowsDoNotConflictInLinesOf128) { check_turned_rows(128); }

// Even after a fragment that has texels.
TEST(TextureRtlDataStage, FragmentWithoutTextureHasNoTexels) {
  CacheBench b;
  TexelToken token = in_line(0);
  b.time_of(token);
  token.ticket.valid = false;
  b.time_of(token);
  EXPECT_THAT(b.ends.sink.taken.back().token.texel, ElementsAre(0, 0, 0, 0));
}

// Two hits of one bank, in lines that the two misses of the same request replace: the second line
// waits for the second pass.
TEST(TextureRtlDataStage, PassesPrecedeFills) {
  spec::texture::Parameters p = small_cache();
  p.cache_ways = 1;
  CacheBench b(p);
  const TexelToken clash = request({0, 64, 64 * 4, 64 * 5});
  const TexelToken one_hit = request({64 * 4, 64 * 4 + 4, 0, 4});
  const std::vector<TexelToken> asked = {in_line(0), in_line(1), clash, one_hit, in_line(5)};
  for (const auto& t : asked) b.ends.source.add(t);
  b.clock.run(100);
  b.check_data(asked);
  EXPECT_THAT(b.memory.lines_read(), ElementsAre(0, 64, 256, 320, 0));
}

// The data stage alone, with a fill buffer that stays empty.
struct StageBench {
  explicit StageBench(const CacheToken& first) {
    stage.requests_in(requests);
    stage.texels_out->bind(texels);
    stage.line_used_out(line_used);
    requests.push(0, first);
    clock.run(2);  // taken in 1
  }
  static spec::texture::Parameters parameters() {
    spec::texture::Parameters p = small_cache();
    p.cache_bytes = 1024;
    return p;
  }
  static CacheToken hit(std::array<std::uint32_t, 4> place) {
    const TexelToken asked = request({});
    CacheToken token{};
    token.ticket = asked.ticket;
    token.control = asked.control;
    token.place = place;
    return token;
  }
  ClockDomain clock{"clock", period()};
  FillBuffer fills{"fills", 4, 64};
  rtl::Link<CacheToken> requests{"requests"};
  rtl::Link<TexelQuadToken> texels{"texels"};
  rtl::Wire<bool> line_used{"line_used", false};
  DataStage stage{"stage", clock, parameters(), fills.reader()};
};

TEST(TextureRtlDataStage, LatencyMatchesDatasheet) {
  StageBench b(StageBench::hit({0, 4, 16, 20}));
  expect_latency(DataStage::datasheet(), ready_at(b.clock, b.texels) - 1);
}

// ---- Cycles of passes and fills ----------------------------------------------------------------

// The data stage alone: cycles of one request, given its passes and lines to write that have all
// arrived.
struct Cycles {
  Cycle taken;  // cycles from accepting the request to releasing it
  std::uint64_t wait_fill, write_fill, bank_conflict;
  friend bool operator==(const Cycles&, const Cycles&) = default;
  friend void PrintTo(const Cycles& c, std::ostream* out) {
    *out << c.taken << " cycles, wait_fill " << c.wait_fill << ", write_fill " << c.write_fill
         << ", bank_conflict " << c.bank_conflict;
  }
};
Cycles cycles_of(const CacheToken& token) {
  ClockDomain clock("clock", period());
  FillBuffer fills("fills", 4, 64);
  rtl::Link<CacheToken> requests("requests");
  rtl::Link<TexelQuadToken> texels("texels");
  rtl::Wire<bool> line_used("line_used", false);
  DataStage stage("stage", clock, StageBench::parameters(), fills.reader());
  stage.requests_in(requests);
  stage.texels_out->bind(texels);
  stage.line_used_out(line_used);
  const std::array<std::uint8_t, 64> line{};
  for (std::uint8_t i = 0; i < token.fills; ++i) {
    fills.fill(clock.cycle(), fills.reserve(clock.cycle()), 0, line, true);
    clock.run(1);
  }
  clock.run(3);
  const Cycle pushed = clock.cycle();
  requests.push(pushed, token);
  const Cycle ready = ready_at(clock, texels, 40);
  // Taken one cycle after the push; stage 1 ends one cycle before the push of the texels.
  const auto stalls = stage.stalls();
  // Lines are written at the end of a request, one per cycle: the wire is high once per line.
  EXPECT_EQ(line_used.high_cycles(clock.cycle()), token.fills);
  EXPECT_EQ(line_used.changes(), token.fills == 0 ? 0u : 2u);
  rtl::for_each<rtl::PortedMemory>(
      stage, [&](const rtl::PortedMemory& banks) { EXPECT_EQ(banks.writes(), token.fills); });
  return {ready - 1 - (pushed + 1), stalls[1].cycles, stalls[2].cycles, stalls[3].cycles};
}

// `passes` hits are in different words of one bank, the other hits in banks of their own. Misses
// are at the start of their lines, in the bank of the hits, and conflict with no hit.
CacheToken request_of(std::uint32_t hits, std::uint32_t passes, std::uint8_t lines,
                      bool misses_first) {
  CacheToken token = StageBench::hit({0, 0, 0, 0});
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t i = misses_first ? 3 - k : k;
    token.victim[i] = static_cast<std::uint16_t>(8 + i);
    if (k >= hits)
      token.source[i] = static_cast<std::uint8_t>(1 + (k - hits) % lines);
    else
      token.place[i] = k < passes ? 64 * (k + 1) : 4 * (k + 1);
  }
  token.fills = lines;
  return token;
}

struct PassesAndFills {
  std::uint32_t hits, passes;
  std::uint8_t lines;
  Cycles expected;
};
void PrintTo(const PassesAndFills& c, std::ostream* out) {
  *out << c.passes << " passes, " << int{c.lines} << " lines";
}
class DataStageCycles : public testing::TestWithParam<std::tuple<bool, PassesAndFills>> {};

// The first line is written in the cycle of the last pass, then one line per cycle.
TEST_P(DataStageCycles, FillsBeginInCycleOfLastPass) {
  const auto& [misses_first, c] = GetParam();
  EXPECT_EQ(cycles_of(request_of(c.hits, c.passes, c.lines, misses_first)), c.expected);
}
// While earlier texels wait, the request makes neither a pass nor a fill; once they move on, it
// takes the usual number of cycles.
TEST_P(DataStageCycles, BeginsWhenEarlierTexelsMoveOn) {
  const auto& [misses_first, c] = GetParam();
  const CacheToken before = StageBench::hit({0, 4, 16, 20});
  StageBench b(before);
  const std::array<std::uint8_t, 64> line{};
  for (std::uint8_t i = 0; i < c.lines; ++i) {
    b.fills.fill(b.clock.cycle(), b.fills.reserve(b.clock.cycle()), 0, line, true);
    b.clock.run(1);
  }
  for (int i = 0; i < 2; ++i) {
    b.requests.push(b.clock.cycle(), before);
    b.clock.run(1);
  }
  b.requests.push(b.clock.cycle(), request_of(c.hits, c.passes, c.lines, misses_first));
  b.clock.run(20);
  ASSERT_EQ(b.texels.occupancy(), 2u);
  ASSERT_EQ(b.requests.occupancy(), 1u);
  EXPECT_EQ(b.stage.stalls()[3].cycles, 0u) << "passes while texels wait";
  EXPECT_EQ(b.line_used.high_cycles(b.clock.cycle()), 0u) << "fills while texels wait";
  const Cycle from = b.clock.cycle();
  Cycle popped = 0;
  for (int texels = 0; texels < 4 && b.clock.cycle() < from + 40; b.clock.run(1)) {
    popped = b.clock.cycle();
    if (!b.texels.can_pop(popped)) continue;
    b.texels.pop(popped);
    ++texels;
  }
  // A link entry is free one cycle after the pop; the last cycle, the push, the pop.
  EXPECT_EQ(popped - from, c.expected.taken + 2);
}
INSTANTIATE_TEST_SUITE_P(TextureRtl, DataStageCycles,
                         testing::Combine(testing::Bool(),
                                          testing::Values(PassesAndFills{4, 1, 0, {1, 0, 0, 0}},
                                                          PassesAndFills{4, 2, 0, {2, 0, 0, 1}},
                                                          PassesAndFills{4, 4, 0, {4, 0, 0, 3}},
                                                          PassesAndFills{3, 1, 1, {1, 0, 0, 0}},
                                                          PassesAndFills{3, 2, 1, {2, 0, 0, 1}},
                                                          PassesAndFills{3, 3, 1, {3, 0, 0, 2}},
                                                          PassesAndFills{2, 1, 2, {2, 0, 1, 0}},
                                                          PassesAndFills{2, 2, 2, {3, 0, 1, 1}},
                                                          PassesAndFills{1, 1, 3, {3, 0, 2, 0}},
                                                          PassesAndFills{0, 0, 2, {2, 0, 1, 0}},
                                                          PassesAndFills{0, 0, 4, {4, 0, 3, 0}})));

// Two hits of one request take two passes if they are in different words of one bank, and one pass
// if they are in the same word. Holds for any pair of texels.
using TexelPair = std::pair<std::size_t, std::size_t>;
class TwoTexels : public testing::TestWithParam<std::tuple<TexelPair, bool>> {};
TEST_P(TwoTexels, ConflictUnlessTheyShareWord) {
  const auto [pair, share] = GetParam();
  const auto [first, second] = pair;
  CacheToken token = StageBench::hit({4, 8, 12, 16});
  token.place[second] = token.place[first] + (share ? 1 : 64);
  EXPECT_EQ(cycles_of(token), share ? (Cycles{1, 0, 0, 0}) : (Cycles{2, 0, 0, 1}));
}
INSTANTIATE_TEST_SUITE_P(TextureRtl, TwoTexels,
                         testing::Combine(testing::Values(TexelPair{0, 1}, TexelPair{0, 2},
                                                          TexelPair{0, 3}, TexelPair{1, 2},
                                                          TexelPair{1, 3}, TexelPair{2, 3}),
                                          testing::Bool()));

// Two words, each with two texels.
TEST(TextureRtlDataStage, TwoWordsOfOneBankTakeTwoPasses) {
  EXPECT_EQ(cycles_of(StageBench::hit({0, 64, 1, 65})), (Cycles{2, 0, 0, 1}));
}

// A line that has arrived waits for its own request while earlier requests take their passes.
TEST(TextureRtlDataStage, FillWaitsForRequestAfterBankConflicts) {
  CacheBench b(small_cache(), 5);
  std::vector<TexelToken> asked = {in_line(0), in_line(1)};
  for (std::uint32_t line = 2; line < 6; ++line) {
    for (int i = 0; i < 8; ++i) asked.push_back(request({64, 0, 68, 4}));
    asked.push_back(in_line(2 * line));
    asked.push_back(in_line(0));
  }
  for (const auto& t : asked) b.ends.source.add(t);
  b.clock.run(1000);
  b.check_data(asked);
  EXPECT_GE(b.cache.data_stage.conflicts.value(), 32u);
}

// ---- Misuse of the banks -----------------------------------------------------------------------

TEST(TextureRtlDataBanks, WordReadInSameCycleIsRejected) {
  StageBench b(StageBench::hit({0, 4, 16, 20}));
  EXPECT_THAT(read_one_cycle_early(b.stage, b.clock), Rejects("banks", kEarly));
}

// A second request, while the output registers hold words of the first.
std::string read_again_one_cycle_early(std::array<std::uint32_t, 4> place) {
  StageBench b(StageBench::hit({0, 4, 16, 20}));
  b.clock.run(2);
  b.requests.push(b.clock.cycle() - 1, StageBench::hit(place));
  b.clock.run(1);
  return read_one_cycle_early(b.stage, b.clock);
}
TEST(TextureRtlDataBanks, OtherWordOfPreviousRequestIsStale) {
  EXPECT_THAT(read_again_one_cycle_early({32, 36, 48, 52}), Rejects("banks", kEarly));
}
TEST(TextureRtlDataBanks, SameWordOfPreviousRequestIsStale) {
  EXPECT_THAT(read_again_one_cycle_early({0, 4, 16, 20}), Rejects("banks", kEarly));
}

TEST(TextureRtlDataBanks, SecondQuadInOneCycleIsRejected) {
  const CacheToken token = StageBench::hit({0, 4, 16, 20});
  StageBench b(token);
  EXPECT_THAT(of_a_second_token(b.stage, b.requests, token, b.clock), Rejects("banks", kTooMany));
}

// Texels 1 and 3 remain for the second pass; then one of them moves into the bank of the other.
TEST(TextureRtlDataBanks, BankUsedTwicePerCycleIsRejected) {
  StageBench b(StageBench::hit({0, 64, 20, 84}));
  ASSERT_EQ(b.stage.conflicts.value(), 1u);
  const CacheToken moved = StageBench::hit({0, 64, 20, 128});
  std::memcpy(b.requests.beat(0), &moved, sizeof moved);
  EXPECT_THAT(rejection([&] { b.clock.run(1); }),
              Rejects("banks", "bank 0 (address 32) is used twice"));
}

TEST(TextureRtlDataBanks, RejectsWordBeyondLastLine) {
  StageBench b(StageBench::hit({0, 4, 16, 20}));
  b.clock.run(1);
  b.requests.push(2, StageBench::hit({0, 4, 16, 1024}));
  EXPECT_THAT(rejection([&] { b.clock.run(2); }), Rejects("banks", "expected at most"));
}

TEST(TextureRtlDataBanks, RejectsExtraPort) {
  StageBench b(StageBench::hit({0, 4, 16, 20}));
  EXPECT_THAT((of_one_port_more<rtl::ReadPort<void>, void>(b.stage, "banks")),
              Rejects("banks", "one port more than 4R1W"));
  EXPECT_THAT((of_one_port_more<rtl::WritePort<void>, void>(b.stage, "banks")),
              Rejects("banks", "one port more than 4R1W"));
}

// ---- Blocks -------------------------------------------------------------------------------------

using spec::texture::Format;
constexpr Cycle kDecoder = 3;

struct BlockBench : CacheBench {
  explicit BlockBench(std::int32_t line_bytes = 64) : CacheBench(parameters(line_bytes)) {
    memory.preload(0, numbered_blocks());
  }
  static spec::texture::Parameters parameters(std::int32_t line_bytes) {
    spec::texture::Parameters p = with_decoders(small_cache());
    p.cache_bytes = 16384;
    p.cache_line_bytes = line_bytes;
    return p;
  }
  // Cycles of a hit, beyond those of one pass.
  Cycle passes_after_first(const TexelToken& t) {
    time_of(t);
    const Cycle cycles = time_of(t) - kHit - kDecoder;
    EXPECT_EQ(ends.sink.taken.back().token.texel, texels_of(t));
    EXPECT_EQ(ends.sink.taken[ends.sink.taken.size() - 2].token.texel, texels_of(t)) << "filled";
    return cycles;
  }
};

// Blocks of 8 bytes are in two of sixteen banks, those of 16 bytes in four.
TEST(TextureRtlDataStage, BlocksTakeOnePassPerWordOfABank) {
  BlockBench b;
  for (const auto& [format, address, more] :
       {std::tuple{Format::kBc4, std::array<std::uint32_t, 4>{0, 8, 16, 24}, 0u},
        {Format::kBc4, {0, 0, 0, 0}, 0},
        {Format::kBc4, {0, 64 + 8, 128 + 16, 192 + 24}, 0},
        {Format::kBc4, {0, 64, 8, 72}, 1},
        {Format::kBc4, {0, 64, 128, 8}, 2},
        {Format::kBc4, {0, 64, 128, 192}, 3},
        {Format::kBc4, {0, 64, 64, 0}, 1},
        {Format::kBc5, {0, 16, 32, 48}, 0},
        {Format::kBc5, {0, 64 + 16, 128 + 32, 192 + 48}, 0},
        {Format::kBc5, {16, 64 + 16, 32, 64 + 32}, 1},
        {Format::kBc5, {48, 64 + 48, 128 + 48, 192 + 48}, 3}})
    EXPECT_EQ(b.passes_after_first(in_blocks(format, address)), more) << address[1];
  // A line of another layout is read through this one, and texels through the same cache.
  EXPECT_EQ(b.passes_after_first(request({0, 8, 64, 1024})), 2u);
  EXPECT_EQ(b.passes_after_first(invalid_request()), 0u);
}

// Neighbours anywhere in a texture of 21 x 13 blocks, in both layouts: of `linear`, odd rows of
// blocks are turned.
class Neighbours
    : public testing::TestWithParam<std::tuple<Format, spec::texture::Layout, std::int32_t>> {};
TEST_P(Neighbours, BlocksTakeOnePass) {
  const auto& [format, layout, line_bytes] = GetParam();
  BlockBench b(line_bytes);
  const platform::TexelLayout blocks(layout, format, 4 * 21, 4 * 13);
  for (int y = 0; y < 12; ++y)
    for (int x = 0; x < 20; ++x) {
      const auto at = [&](int i, int j) { return blocks.offset_of(4 * (x + i), 4 * (y + j)); };
      TexelToken t = in_blocks(format, {at(0, 0), at(1, 0), at(0, 1), at(1, 1)});
      if (layout == spec::texture::Layout::kLinear) t.turned = {y % 2 == 1, y % 2 == 0};
      EXPECT_EQ(b.passes_after_first(t), 0u) << x << ' ' << y;
    }
  EXPECT_EQ(b.cache.data_stage.conflicts.value(), 0u);
}
INSTANTIATE_TEST_SUITE_P(TextureRtlDataStage, Neighbours,
                         testing::Combine(testing::Values(Format::kBc4, Format::kBc5),
                                          testing::Values(spec::texture::Layout::kLinear,
                                                          spec::texture::Layout::kTiled),
                                          testing::Values(64)));

// Distinct blocks are in the order of first use, whether they hit or miss: the stage alone.
TEST(TextureRtlDataStage, PassesDistinctBlocksInOrderOfUse) {
  ClockDomain clock("clock", period());
  FillBuffer fills("fills", 4, 64);
  rtl::Link<CacheToken> requests("requests");
  rtl::Link<BlockGroup> blocks("blocks");
  rtl::Wire<bool> line_used("line_used", false);
  DataStage stage("stage", clock, with_decoders(small_cache()), fills.reader());
  stage.requests_in(requests);
  stage.blocks_out->bind(blocks);
  stage.line_used_out(line_used);
  std::array<std::uint8_t, 64> line;
  for (std::uint8_t i = 0; i < 64; ++i) line[i] = i;
  fills.fill(clock.cycle(), fills.reserve(clock.cycle()), 0, line, true);
  clock.run(3);
  CacheToken token = StageBench::hit({32, 40, 32, 8});
  token.control.codec = codec_of(Format::kBc4);
  token.source = {1, 0, 1, 1};
  token.fills = 1;
  requests.push(clock.cycle(), token);
  ready_at(clock, blocks);
  const BlockGroup& got = blocks.front(clock.cycle());
  EXPECT_EQ(got.blocks, 3);
  EXPECT_THAT(got.at[0].index, ElementsAre(0, 1, 0, 2));
  EXPECT_THAT(got.block[0], ElementsAre(0x23222120, 0x27262524, 0, 0));
  EXPECT_THAT(got.block[1], ElementsAre(0, 0, 0, 0)) << "of the banks";
  EXPECT_THAT(got.block[2], ElementsAre(0x0B0A0908, 0x0F0E0D0C, 0, 0));
  EXPECT_THAT(got.at[0].texel, ElementsAre(0, 0, 0, 0));
}

// Requests of more blocks than are decoded at once hold back those behind them.
TEST(TextureRtlDataStage, DecoderTakesRequestsInPasses) {
  spec::texture::Parameters p = BlockBench::parameters(64);
  p.cache_decoders = 1;
  CacheBench b(p);
  b.memory.preload(0, numbered_blocks());
  const TexelToken four = in_blocks(Format::kBc4, {0, 8, 16, 24}),
                   one = in_blocks(Format::kBc4, {0, 0, 0, 0});
  b.time_of(four);
  EXPECT_EQ(b.time_of(four), kHit + kDecoder + 3);
  const std::size_t first = b.ends.sink.taken.size();
  const Cycle start = b.clock.cycle() + 1;
  for (const auto& t : {one, four, one, four, one}) b.ends.source.add(t);
  b.clock.run(40);
  std::vector<Cycle> when;
  for (std::size_t i = first; i < b.ends.sink.taken.size(); ++i)
    when.push_back(b.ends.sink.taken[i].cycle - start - kHit - kDecoder);
  EXPECT_THAT(when, ElementsAre(0, 4, 5, 9, 10));
  EXPECT_EQ(b.cache.block_decoder->blocks.value(), 4u + 4 + 11);
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::data_stage_test
