// SPDX-License-Identifier: MIT
// CachePredictor: which lookups of a sequence hit, for each replacement policy, and which lines of
// memory are requested with decode = before.
#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

#include "golden/texture/cache_predictor.h"
#include "spec/error.h"
#include "spec/texture/check_build.h"

namespace deburr::cache_test {
namespace {

using golden::texture::CachePredictor;
using spec::texture::Replacement;

spec::texture::Parameters geometry(int bytes, int line, int ways,
                                   Replacement replacement = Replacement::kLru) {
  spec::texture::Parameters p;
  p.cache_bytes = bytes;
  p.cache_line_bytes = line;
  p.cache_ways = ways;
  p.cache_replacement = replacement;
  return p;
}

struct Step {
  std::uint32_t line;
  bool hit;
  const char* why;
};

void expect_lookups(CachePredictor& cache, const std::vector<Step>& steps) {
  for (std::size_t i = 0; i < steps.size(); ++i) {
    EXPECT_EQ(cache.lookup(steps[i].line), steps[i].hit)
        << "step " << i << ", line " << steps[i].line << ": " << steps[i].why;
  }
}

// The shift register that selects random victims, bit by bit from the contract's rule: 0xACE1 ->
// 0x5670 -> 0xAB38 -> 0x559C.
std::vector<std::uint32_t> shift_register(int steps) {
  std::vector<std::uint32_t> values;
  std::uint32_t r = 0xACE1;
  for (int i = 0; i < steps; ++i) {
    const auto bit = [r](int n) { return r >> n & 1; };
    r = r >> 1 | (bit(0) ^ bit(2) ^ bit(3) ^ bit(5)) << 15;
    values.push_back(r);
  }
  return values;
}

TEST(Cache, RandomVictimsFollowTheShiftRegister) {
  EXPECT_EQ(shift_register(3), (std::vector<std::uint32_t>{0x5670, 0xAB38, 0x559C}));
  const auto values = shift_register(200);
  CachePredictor cache(geometry(256, 64, 4, Replacement::kRandom));  // one set of 4 ways
  std::vector<std::uint32_t> ways;
  for (std::uint32_t line = 0; line < 4; ++line) {
    EXPECT_FALSE(cache.lookup(line));  // invalid ways are filled first: the register does not step
    ways.push_back(line);
  }
  for (std::uint32_t i = 0; i < 200; ++i) {
    ASSERT_FALSE(cache.lookup(100 + i));
    ways[values[i] % 4] = 100 + i;
    for (const std::uint32_t line : ways) ASSERT_TRUE(cache.present(line)) << i;
    if (i % 3 == 0) {
      ASSERT_TRUE(cache.lookup(ways[i % 4]));  // nor does it step on hits
    }
  }
}

TEST(Cache, InvalidationKeepsTheRandomSequenceAndResetRestartsIt) {
  const auto victims = [](CachePredictor& cache) {
    std::vector<std::uint32_t> ways = {0, 1, 2, 3};
    std::string result;
    for (std::uint32_t line = 0; line < 4; ++line) cache.lookup(line);
    for (std::uint32_t line = 10; line < 26; ++line) {
      cache.lookup(line);
      for (std::size_t way = 0; way < 4; ++way) {
        if (!cache.present(ways[way])) {
          result += static_cast<char>('0' + way);
          ways[way] = line;
        }
      }
    }
    return result;
  };
  CachePredictor cache(geometry(256, 64, 4, Replacement::kRandom));
  const std::string first = victims(cache);
  cache.invalidate();
  EXPECT_FALSE(cache.present(0));
  const std::string second = victims(cache);
  cache.reset();
  EXPECT_EQ(victims(cache), first);
  EXPECT_NE(first, second);
}

// The predictor answers a repeated lookup of the same line without searching its set.
TEST(Cache, InvalidationClearsTheLastLine) {
  CachePredictor cache(geometry(512, 64, 2));
  expect_lookups(cache, {{5, false, "first use"}, {5, true, "the line of the last lookup"}});
  cache.invalidate();
  expect_lookups(cache, {{5, false, "the cache is empty"}});
}

std::vector<std::uint32_t> request(CachePredictor& cache, std::array<std::uint32_t, 4> lines) {
  std::vector<std::uint32_t> fills;
  cache.request(lines, [&](std::uint32_t line) { fills.push_back(line); });
  return fills;
}

// One of the four lines differs. The random comparison in unit_test.cpp covers other combinations.
TEST(Cache, ARequestLooksUpEachDistinctLineOnce) {
  using Lines = std::vector<std::uint32_t>;
  CachePredictor cache(geometry(512, 64, 2));
  EXPECT_EQ(request(cache, {20, 21, 20, 20}), (Lines{20, 21}));
  EXPECT_EQ(request(cache, {30, 30, 31, 30}), (Lines{30, 31}));
  EXPECT_EQ(request(cache, {40, 40, 40, 41}), (Lines{40, 41}));
}

// Four lines of one set with two ways: the third evicts the first within the request, so the next
// request fetches the first again.
TEST(Cache, ARequestMayEvictItsOwnLines) {
  using Lines = std::vector<std::uint32_t>;
  CachePredictor cache(geometry(512, 64, 2));
  EXPECT_EQ(request(cache, {0, 4, 8, 12}), (Lines{0, 4, 8, 12}));
  EXPECT_EQ(request(cache, {0, 4, 8, 12}), (Lines{0, 4, 8, 12}));
  EXPECT_EQ(request(cache, {8, 12, 8, 12}), (Lines{}));
  // Lines are used in the order of the request: 12, which hits last, is the most recent.
  EXPECT_EQ(request(cache, {16, 16, 16, 16}), (Lines{16}));
  EXPECT_TRUE(cache.present(12));
  EXPECT_FALSE(cache.present(8));
}

TEST(Cache, SupportsDirectMappedAndFullyAssociative) {
  CachePredictor direct(geometry(256, 32, 1));
  EXPECT_EQ(direct.sets(), 8u);
  expect_lookups(direct,
                 {{0, false, ""}, {8, false, "conflict"}, {0, false, "conflict"}, {1, false, ""}});
  CachePredictor full(geometry(512, 64, 8));
  EXPECT_EQ(full.sets(), 1u);
  for (std::uint32_t line = 0; line < 8; ++line) EXPECT_FALSE(full.lookup(line * 1000));
  for (std::uint32_t line = 0; line < 8; ++line) EXPECT_TRUE(full.lookup(line * 1000));
  EXPECT_EQ(full.memory_line(64 * 5 + 63), 5u);
}

// ---- decode = before ----------------------------------------------------------------------------

spec::texture::Parameters before(int compressed_lines) {
  spec::texture::Parameters p = geometry(16384, 64, 2);
  p.decode = spec::texture::Decode::kBefore;
  p.cache_compressed_lines = compressed_lines;
  return p;
}

TEST(CacheBefore, LineOfABlockIsItsCodecAndItsNumber) {
  using spec::texture::Format;
  const CachePredictor cache(before(4));
  EXPECT_EQ(cache.line_of(Format::kBc1, 0xFFFFFFF8), 0x3FFFFFFFu);
  EXPECT_EQ(cache.line_of(Format::kBc3, 0xFFFFFFF0), 0x4FFFFFFFu);
  EXPECT_EQ(cache.line_of(Format::kBc4, 0), 0x60000000u);
  EXPECT_EQ(cache.line_of(Format::kBc5, 0x100), 0x80000010u);
  EXPECT_EQ(cache.line_of(Format::kEtc2Rgb, 0x100), 0xA0000020u);
  EXPECT_EQ(cache.line_of(Format::kEtc2RgbA1, 0), 0xC0000000u);
  EXPECT_EQ(cache.line_of(Format::kEtc2Rgba8, 0x100), 0xE0000010u);
  EXPECT_EQ(cache.line_of(Format::kL8, 0xFFFFFFFF), 0x03FFFFFFu);
  EXPECT_EQ(cache.line_of(Format::kSrgb8A8, 0x100), 4u);
  spec::texture::Parameters after = geometry(16384, 64, 2);
  after.decode = spec::texture::Decode::kAfter;
  EXPECT_EQ(CachePredictor(after).line_of(Format::kBc1, 0x108), 4u);
}

constexpr std::uint32_t kBc1 = 1u << 29, kBc3 = 2u << 29;

// Fills of lines, each with its memory line and whether it is requested.
void expect_fetches(CachePredictor& cache,
                    const std::vector<std::tuple<std::uint32_t, std::uint32_t, bool>>& fills) {
  for (std::size_t i = 0; i < fills.size(); ++i) {
    const auto& [line, memory_line, requested] = fills[i];
    const CachePredictor::Fetch fetch = cache.fetch(line);
    EXPECT_EQ(fetch.memory_line, memory_line) << i;
    EXPECT_EQ(fetch.requested, requested) << i;
    EXPECT_EQ(fetch.decoded, line >= kBc1) << i;
  }
}

TEST(CacheBefore, BlocksOfAMemoryLineRequestItOnce) {
  CachePredictor cache(before(4));
  expect_fetches(cache, {{kBc1 | 8, 1, true},
                         {kBc1 | 15, 1, false},
                         {kBc1 | 16, 2, true},
                         {kBc3 | 4, 1, false},
                         {kBc3 | 12, 3, true},
                         {0xFFFFFFFF, 0x03FFFFFF, true},
                         {kBc1 | 0x1FFFFFFF, 0x03FFFFFF, false}});
}

TEST(CacheBefore, OtherTexturesDoNotTouchTheCompressedLines) {
  CachePredictor cache(before(4));
  expect_fetches(cache, {{1, 1, true}, {kBc1 | 8, 1, true}, {1, 1, true}, {2, 2, true}});
  for (std::uint32_t line = 10; line < 20; ++line) EXPECT_TRUE(cache.fetch(line).requested);
  expect_fetches(cache, {{kBc1 | 9, 1, false}});
}

TEST(CacheBefore, ReplacesTheCompressedLineAllocatedFirst) {
  for (const int lines : {4, 16, 64, 0}) {
    const auto n = static_cast<std::uint32_t>(lines == 0 ? 16 : lines);
    CachePredictor cache(before(lines));
    for (std::uint32_t i = 0; i < n; ++i) EXPECT_TRUE(cache.fetch(kBc1 | 8 * i).requested);
    for (std::uint32_t i = 0; i < n; ++i) EXPECT_FALSE(cache.fetch(kBc1 | 8 * i).requested);
    EXPECT_FALSE(cache.fetch(kBc1).requested);         // a use does not make it younger
    EXPECT_TRUE(cache.fetch(kBc1 | 8 * n).requested);  // replaces 0
    for (std::uint32_t i = 1; i <= n; ++i) EXPECT_FALSE(cache.fetch(kBc1 | 8 * i).requested);
    EXPECT_TRUE(cache.fetch(kBc1).requested);  // replaces 1
    EXPECT_FALSE(cache.fetch(kBc1 | 16).requested);
    EXPECT_TRUE(cache.fetch(kBc1 | 8).requested);  // replaces 2
    EXPECT_TRUE(cache.fetch(kBc1 | 16).requested);
  }
}

TEST(CacheBefore, InvalidationAndResetEmptyTheCompressedLines) {
  CachePredictor cache(before(4));
  for (const bool reset : {false, true}) {
    for (std::uint32_t i = 0; i < 3; ++i) EXPECT_TRUE(cache.fetch(kBc1 | 8 * i).requested);
    reset ? cache.reset() : cache.invalidate();
  }
  for (std::uint32_t i = 0; i < 4; ++i) EXPECT_TRUE(cache.fetch(kBc1 | 8 * i).requested);
  for (std::uint32_t i = 0; i < 4; ++i) EXPECT_FALSE(cache.fetch(kBc1 | 8 * i).requested);
}

// The predictor throws the same message as check_build().
TEST(Cache, RejectsWhatCheckBuildRejects) {
  for (const spec::texture::Parameters& p :
       {geometry(1000, 64, 2), geometry(1024, 48, 2), geometry(1024, 64, 3), geometry(1024, 64, 0),
        geometry(1024, 64, 16), geometry(256, 64, 8), geometry(65536, 64, 8)}) {
    std::string built = "taken", predicted = "taken";
    try {
      spec::texture::check_build(p);
    } catch (const spec::ConfigError& error) {
      built = error.what();
    }
    try {
      CachePredictor cache(p);
    } catch (const spec::ConfigError& error) {
      predicted = error.what();
    }
    EXPECT_NE(built, "taken");
    EXPECT_EQ(predicted, built);
  }
  EXPECT_NO_THROW(CachePredictor(geometry(512, 64, 8)));
}

}  // namespace
}  // namespace deburr::cache_test
