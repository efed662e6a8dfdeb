// SPDX-License-Identifier: MIT
// The LineCache on its own, cycle by cycle: lookups, requests and uses.
#include "rtl_model/geometric/common/line_cache.h"

#include <string>
#include <vector>

#include "spec/error.h"
#include "tb/unit/rtl/geometric/support.h"

namespace deburr::tb::geometric_rtl::line_cache_test {
namespace {

using namespace rtl::geometric;  // NOLINT
using rtl::Activity, rtl::kBusy, rtl::kIdle, rtl::kStalledDownstream;
using rtl::MemoryKind;

constexpr Activity kNoLine{5}, kNoFill{6};

// Eight lines of one byte. Line n has index n mod 8 and address 100 + n.
struct CacheBench {
  explicit CacheBench(MemoryKind kind = MemoryKind::kSram, std::int32_t fills = 8)
      : cache({.lines = 8,
               .ports = 2,
               .tags = {"tags", "line, valid", 8, kind},
               .data = {"data", "a byte", 8, kind},
               .fills = {"fills", "bytes", fills},
               .no_line = kNoLine,
               .no_fill = kNoFill}) {
    memory.requests_out(requests);
    memory.responses_in(responses);
    for (const Cycle cycle : {1, 2, 3, 4, 5, 6, 7, 8}) cache.clear(cycle);
  }
  void find(Cycle cycle, std::vector<std::uint32_t> wanted) {
    lines = std::move(wanted);
    for (std::size_t port = 0; port < lines.size(); ++port)
      cache.find(cycle, port, lines[port] % 8, 0x80 | lines[port]);
  }
  // "idle 2, 1 decided": a bit mask of lookups that have missed so far, and the number decided in
  // this cycle.
  std::string look_up(Cycle cycle) {
    const Activity did = cache.look_up(cycle, memory, [&](auto port) { return 100 + lines[port]; });
    return std::string(did == kIdle     ? "idle "
                       : did == kBusy   ? "busy "
                       : did == kNoFill ? "no fill "
                                        : "downstream ") +
           std::to_string(cache.missed()) + ", " + std::to_string(cache.decided(cycle)) +
           " decided";
  }
  // The address that memory takes; 0 without a request.
  std::uint64_t taken(Cycle cycle) {
    return requests.can_pop(cycle) ? requests.take(cycle).address : 0;
  }
  // finish() takes it in the next cycle.
  void answer(Cycle cycle, std::uint32_t entry, std::uint8_t byte) {
    rtl::MemoryResponse& response = responses.emplace(cycle);
    response.tag = entry;
    response.data[0] = byte;
  }
  Activity finish(Cycle cycle, Activity data = kIdle, Activity tags = kIdle) {
    return cache.finish(cycle, memory, data, tags,
                        [](std::uint8_t& word, const rtl::Line& line) { word = line[0]; });
  }
  Activity collect(Cycle cycle, std::vector<std::uint32_t> index, std::uint32_t missed,
                   std::uint32_t others = 0) {
    const auto take = [&](std::size_t port, std::uint8_t word) { installed[port] = word; };
    return cache.collect(cycle, index.data(), missed, others, take);
  }
  rtl::Link<rtl::MemoryRequest> requests{"requests"};
  rtl::Link<rtl::MemoryResponse> responses{"responses"};
  MemoryClient memory;
  LineCache<std::uint8_t> cache;
  std::vector<std::uint32_t> lines;
  std::array<int, 2> installed{};  // by port
};

// A tag is compared in the cycle after its address, or in the same cycle with flip-flops. If it is
// written in the cycle of its address, the new value is read.
TEST(LineCache, ComparesTagsAfterTheirLatency) {
  CacheBench b;
  b.find(10, {3});
  EXPECT_THROW(b.cache.tag(10, 0), spec::CheckFailed) << "a cycle early";
  EXPECT_EQ(b.look_up(11), "idle 1, 1 decided");
  b.find(11, {3});
  EXPECT_THROW(b.cache.tag(11, 0), spec::CheckFailed) << "that of before";
  EXPECT_EQ(b.look_up(12), "idle 0, 1 decided");
}
TEST(LineCache, ComparesTagsInFlipFlopsAtOnce) {
  CacheBench b(MemoryKind::kFlops);
  b.find(10, {3});
  EXPECT_EQ(b.look_up(10), "idle 1, 1 decided");
  b.find(11, {3});
  EXPECT_EQ(b.look_up(11), "idle 0, 1 decided");
}
// One token per cycle, plus one cycle if both of its lookups miss.
TEST(LineCache, RequestsOneLinePerCycle) {
  CacheBench b;
  Cycle cycle = 10;
  const auto next = [&](std::vector<std::uint32_t> wanted) {
    b.find(cycle, std::move(wanted));
    std::string text = b.look_up(++cycle);
    if (text.starts_with("busy")) text += "; " + b.look_up(++cycle);
    for (int i = 0; i < 2; ++i)
      if (const std::uint64_t address = b.taken(++cycle)) text += " " + std::to_string(address);
    return text;
  };
  EXPECT_EQ(next({1, 2}), "busy 1, 2 decided; idle 3, 0 decided 101 102");
  EXPECT_EQ(next({2, 3}), "idle 2, 2 decided 103");
  EXPECT_EQ(next({4, 1}), "idle 1, 2 decided 104");
  EXPECT_EQ(next({1, 4}), "idle 0, 2 decided");
  EXPECT_EQ(next({9}), "idle 1, 1 decided 109") << "another line of an index";
  // The second one's line is present when the tags are compared, but the first one replaces it.
  EXPECT_EQ(next({1, 9}), "busy 1, 2 decided; idle 3, 0 decided 101 109");
  EXPECT_EQ(next({9, 1}), "idle 2, 2 decided 101");
}
// Nothing is decided or changed until memory has room; a lookup that hits does not need room.
TEST(LineCache, WaitsForMemory) {
  CacheBench b;
  b.find(9, {7});
  b.look_up(10);
  b.find(10, {1, 2});
  EXPECT_EQ(b.look_up(11), "busy 1, 2 decided");
  EXPECT_EQ(b.look_up(12), "downstream 1, 0 decided");
  EXPECT_EQ(b.taken(12), 107u);
  EXPECT_EQ(b.look_up(13), "idle 3, 0 decided");
  b.find(13, {3, 1});
  EXPECT_EQ(b.look_up(14), "downstream 0, 0 decided");
  EXPECT_EQ(b.taken(14), 101u);
  EXPECT_EQ(b.look_up(15), "idle 1, 2 decided");
  b.find(15, {1, 3});
  EXPECT_EQ(b.look_up(16), "idle 0, 2 decided");
}
// Lines that arrive in cycle t are installed from t + 2 on, one per cycle, in the order of their
// requests. One cycle after a line is installed, its fill entry is free and its word can be read.
TEST(LineCache, InstallsOneLinePerCycleInTheOrderOfRequests) {
  CacheBench b(MemoryKind::kSram, 2);
  b.find(10, {1, 2});
  b.look_up(11);
  b.look_up(12);
  b.taken(12);
  b.taken(13);
  b.find(13, {3});
  b.answer(19, 1, 22);
  b.finish(20);
  b.answer(21, 0, 11);
  for (const Cycle cycle : {22, 23}) {
    EXPECT_EQ(b.collect(cycle, {1, 2}, 3), kNoLine) << "the second came first";
    b.finish(cycle);
  }
  EXPECT_EQ(b.collect(24, {1, 2}, 3), kBusy);
  EXPECT_THAT(b.installed, testing::ElementsAre(11, 0));
  EXPECT_EQ(b.look_up(24), "no fill 0, 0 decided");
  b.finish(24);
  EXPECT_EQ(b.look_up(25), "idle 1, 1 decided");
  EXPECT_EQ(b.collect(25, {1, 2}, 3), kIdle);
  EXPECT_THAT(b.installed, testing::ElementsAre(11, 22));
  EXPECT_EQ(b.collect(26, {2, 1}, 0, 3), kIdle);
  EXPECT_THROW(b.cache.word(26, 0, 2), spec::CheckFailed) << "a cycle early";
  EXPECT_EQ(b.cache.word(27, 0, 2), 22);
  EXPECT_EQ(b.cache.word(27, 1, 1), 11);
}
// Tags are updated early: a line stays in the data until the token that replaces it uses its own
// line.
TEST(LineCache, DataChangeInTheOrderOfTokens) {
  CacheBench b(MemoryKind::kFlops);
  const std::vector<std::uint32_t> tokens = {1, 1, 9, 9, 1};
  std::string misses, words;
  Cycle cycle = 10;
  for (const std::uint32_t line : tokens) {
    b.find(cycle, {line, 2});
    if (b.look_up(cycle).starts_with("busy")) {
      b.look_up(++cycle);
      b.taken(cycle);
    }
    b.taken(++cycle);
    misses += std::to_string(b.cache.missed());
  }
  EXPECT_EQ(misses, "30101");
  for (const std::uint32_t entry : {2, 0, 3, 1}) {
    b.answer(cycle, entry, static_cast<std::uint8_t>(30 + entry));
    b.finish(++cycle);
  }
  for (const char missed : misses) {
    const std::uint32_t bits = missed & 3u;
    b.finish(cycle);
    if (b.collect(++cycle, {1, 2}, bits, ~bits & 3) == kBusy) {
      b.finish(cycle);
      b.collect(++cycle, {1, 2}, bits);
    }
    words += std::to_string(bits & 1 ? b.installed[0] : b.cache.word(cycle, 0, 1)) + " ";
    words += std::to_string(bits & 2 ? b.installed[1] : b.cache.word(cycle, 1, 2)) + ", ";
  }
  EXPECT_EQ(words, "30 31, 30 31, 32 31, 32 31, 33 31, ");
}
// SRAM is cleared in one cycle per tag, flip-flops in one cycle.
TEST(LineCache, EmptiesTagsBeforeAFrame) {
  for (const Cycle clears : {8, 1}) {
    CacheBench b(clears == 1 ? MemoryKind::kFlops : MemoryKind::kSram);
    rtl::Wire<bool> wire("wire", false);
    rtl::WireOut<bool> cleared("cleared");
    cleared(wire);
    // For each lookup, whether the tag is empty; its line then fills it.
    const auto empty = [&](Cycle cycle) {
      std::string text;
      for (std::uint32_t line = 0; line < 8; ++line) {
        b.find(cycle++, {line});
        text += b.cache.tag(cycle++, 0) == 0 ? '1' : '0';
        b.look_up(cycle++);
        b.taken(cycle);
      }
      return text;
    };
    EXPECT_EQ(b.cache.clear(9, cleared), kIdle) << "they are empty";
    EXPECT_EQ(empty(10), "11111111");
    b.finish(39);
    for (Cycle cycle = 40; cycle < 40 + clears; ++cycle) {
      EXPECT_FALSE(wire.read(cycle));
      EXPECT_EQ(b.cache.clear(cycle, cleared), kBusy);
    }
    EXPECT_TRUE(wire.read(40 + clears));
    EXPECT_EQ(b.cache.clear(49, cleared), kIdle);
    b.cache.reset();
    EXPECT_EQ(empty(50), "11111111");
    EXPECT_EQ(b.cache.clear(80), kBusy) << "after a reset from the first one on";
  }
}
// Busy if either half worked or a response came; otherwise the stall of the data, or else that of
// the tags.
TEST(LineCache, ReportsTheActivityOfItsUnit) {
  CacheBench b;
  EXPECT_EQ(b.finish(10, kIdle, kIdle), kIdle);
  EXPECT_EQ(b.finish(11, kNoLine, kBusy), kBusy);
  EXPECT_EQ(b.finish(12, kBusy, kNoFill), kBusy);
  EXPECT_EQ(b.finish(13, kNoLine, kNoFill), kNoLine);
  EXPECT_EQ(b.finish(14, kIdle, kNoFill), kNoFill);
  b.find(14, {1});
  b.look_up(15);
  b.answer(15, 0, 1);
  EXPECT_EQ(b.finish(16, kNoLine, kNoFill), kBusy);
}

}  // namespace
}  // namespace deburr::tb::geometric_rtl::line_cache_test
