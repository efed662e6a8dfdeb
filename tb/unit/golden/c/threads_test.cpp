// SPDX-License-Identifier: MIT
// Threads with separate handles run in parallel with the results of a single thread; of concurrent
// calls with one handle all but one return DEBURR_BUSY.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "golden/c/handle.h"
#include "tb/base/random.h"
#include "tb/unit/golden/c/support.h"

namespace deburr::threads_test {
namespace {

using tb::c::error_of;
using tb::c::expect_ok;
using tb::c::Handle;

// The last of four smoothed noise frames, with thousands of calls in between.
std::vector<std::uint8_t> smoothed(deburr_golden* golden, std::uint64_t seed) {
  constexpr std::uint32_t kSide = 48;
  tb::Random random(seed);
  std::vector<std::uint8_t> result(std::size_t{4} * kSide * kSide);
  for (int frame = 0; frame < 4; ++frame) {
    EXPECT_EQ(deburr_frame_begin(golden, kSide, kSide), DEBURR_OK);
    for (std::uint32_t i = 0; i < kSide * kSide; ++i)
      EXPECT_EQ(deburr_frame_put(golden, i % kSide, i / kSide,
                                 random.chance(500) ? 0xFFFFFFFF : 0xFF000000, 0),
                DEBURR_OK);
    EXPECT_EQ(deburr_set(golden, "no such name", ""), DEBURR_ARGUMENT);
    EXPECT_EQ(deburr_frame_process(golden), DEBURR_OK);
    EXPECT_THAT(error_of(golden, DEBURR_ARGUMENT), testing::HasSubstr("'no such name'"));
    EXPECT_EQ(deburr_plane(golden, "pixels", result.data(), result.size(), 0), DEBURR_OK);
  }
  return result;
}

TEST(Threads, SeparateHandlesAreIndependent) {
  constexpr std::size_t kThreads = 4;
  std::array<std::vector<std::uint8_t>, kThreads> results;
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < kThreads; ++i)
      threads.emplace_back([&results, i] {
        const Handle handle(deburr_morphological_new());
        results[i] = smoothed(handle.get(), i / 2);
      });
  }
  const Handle single(deburr_morphological_new());
  for (std::size_t i = 0; i < kThreads; ++i)
    EXPECT_EQ(results[i], smoothed(single.get(), i / 2)) << "thread " << i;
  EXPECT_NE(results[0], results[2]);
}

// While one thread is in a call, calls from another thread return DEBURR_BUSY and change nothing.
// Testing a few functions is enough, since all of them go through golden::c::call.
TEST(Threads, ConcurrentCallReturnsBusy) {
  const Handle handle(deburr_geometric_new());
  deburr_golden* const golden = handle.get();
  expect_ok(golden, deburr_set(golden, "mark", "true"));
  EXPECT_EQ(deburr_set(golden, "mark", "perhaps"), DEBURR_ARGUMENT);
  char text[300] = "before";
  std::uint32_t number = 77;
  std::uint64_t value = 77;
  const int inside = golden::c::call(golden, "a call", [&](deburr_golden&) {
    const auto other = [&](auto&& calls) { std::jthread thread(calls); };
    other([&] {
      const std::vector<int> statuses = {deburr_set(golden, "mark", "false"),
                                         deburr_get(golden, "mark", text, sizeof text),
                                         deburr_check(golden),
                                         deburr_reset(golden),
                                         deburr_parameter_count(golden, &number),
                                         deburr_parameter_name(golden, 0, text, sizeof text),
                                         deburr_counter(golden, "edges", &value),
                                         deburr_counter_count(golden, &number),
                                         deburr_counter_name(golden, 0, text, sizeof text),
                                         deburr_frame_begin(golden, 4, 4),
                                         deburr_frame_process(golden),
                                         deburr_texture_memory(golden, 64),
                                         deburr_close(golden)};
      EXPECT_THAT(statuses, testing::Each(DEBURR_BUSY));
      EXPECT_STREQ(text, "before");
      EXPECT_EQ(number, 77u);
      EXPECT_EQ(value, 77u);
      EXPECT_STREQ(deburr_engine(golden), "geometric");
      // The text of DEBURR_BUSY can be read; the stored error belongs to the thread inside.
      EXPECT_EQ(deburr_error(golden, DEBURR_BUSY, text, sizeof text), DEBURR_OK);
      EXPECT_THAT(std::string(text), testing::HasSubstr("in use by another thread"));
      EXPECT_EQ(deburr_error(golden, DEBURR_ARGUMENT, text, sizeof text), DEBURR_BUSY);
      EXPECT_THAT(std::string(text), testing::HasSubstr("in use by another thread"));
    });
  });
  EXPECT_EQ(inside, DEBURR_OK);
  EXPECT_EQ(tb::c::value_of(golden, "mark"), "true");
  EXPECT_THAT(error_of(golden, DEBURR_ARGUMENT), testing::HasSubstr("'perhaps'"));
}

// Two threads contend for one handle: each call succeeds completely or returns DEBURR_BUSY.
TEST(Threads, SharedHandleNeverRaces) {
  const Handle handle(deburr_morphological_new());
  deburr_golden* const golden = handle.get();
  EXPECT_EQ(deburr_frame_begin(golden, 64, 64), DEBURR_OK);
  std::atomic<int> succeeded{0}, busy{0}, other{0};
  std::atomic<bool> done{false};
  const auto contend = [&](int own) {
    const std::string mine = std::to_string(own);
    char text[64];
    for (int i = 0; !done && i < 200'000; ++i) {
      for (const int status :
           {deburr_set(golden, "edges.threshold", mine.c_str()), deburr_frame_process(golden),
            deburr_get(golden, "edges.threshold", text, sizeof text)}) {
        ++(status == DEBURR_OK ? succeeded : status == DEBURR_BUSY ? busy : other);
      }
      if (busy > 20 && succeeded > 200) done = true;
    }
  };
  { const std::jthread first(contend, 1000), second(contend, 2000); }
  EXPECT_EQ(other, 0);
  EXPECT_GT(succeeded, 200);
  EXPECT_GT(busy, 20);
  EXPECT_THAT(tb::c::value_of(golden, "edges.threshold"), testing::AnyOf("1000", "2000"));
}

// The next call succeeds whatever the previous one threw.
TEST(Threads, FailedCallReleasesHandle) {
  const Handle handle(deburr_texture_new());
  for (const auto& [status, raise] :
       {std::pair<int, void (*)()>{DEBURR_MEMORY, [] { throw std::bad_alloc(); }},
        {DEBURR_MEMORY, [] { throw std::length_error("vector"); }},
        {DEBURR_INTERNAL, [] { throw std::logic_error("check failed"); }},
        {DEBURR_INTERNAL, [] { throw 7; }}}) {
    EXPECT_EQ(golden::c::call(handle.get(), "a call", [raise = raise](deburr_golden&) { raise(); }),
              status);
    EXPECT_THAT(error_of(handle.get(), status), testing::StartsWith("a call: "));
    EXPECT_EQ(deburr_check(handle.get()), DEBURR_OK);
  }
}

}  // namespace
}  // namespace deburr::threads_test
