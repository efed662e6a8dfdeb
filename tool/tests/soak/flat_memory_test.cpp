// SPDX-License-Identifier: MIT
#include "tool/soak/flat_memory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace deburr::tool::flat_memory_test {
namespace {

constexpr Allowance kNone{0, 0};

std::vector<std::uint64_t> steps(std::size_t count, std::uint64_t from, std::uint64_t each) {
  std::vector<std::uint64_t> samples(count, from);
  for (std::size_t i = 0; i < count; ++i) samples[i] += i * each;
  return samples;
}

TEST(FlatMemory, ReportsGrowthFromBeginningToEnd) {
  EXPECT_EQ(growth(steps(100, 1000, 0), kNone), "");
  // In 100 samples the second fifth ends with number 39, the fourth with number 79.
  EXPECT_EQ(growth(steps(100, 1000, 1), kNone), "from 1039 to 1079 bytes, 1039 are allowed");
  EXPECT_EQ(growth(steps(100, 1000, 1), {0, 40}), "");
  EXPECT_NE(growth(steps(100, 1000, 1), {0, 39}), "");
  EXPECT_EQ(growth(steps(100, 1000, 1), {0.04, 0}), "");
  EXPECT_NE(growth(steps(100, 1000, 1), {0.03, 0}), "");
}

TEST(FlatMemory, IgnoresGrowthAtBothEnds) {
  std::vector<std::uint64_t> samples(100, 5000);
  for (std::size_t i = 0; i < 20; ++i) samples[i] = 10 * i;
  for (std::size_t i = 80; i < 100; ++i) samples[i] = 9000;
  EXPECT_EQ(growth(samples, kNone), "");
}

TEST(FlatMemory, SleepTakesNoProcessorTime) {
  const double before = cpu_seconds(::getpid());
  EXPECT_GT(before, 0);
  ::usleep(100'000);
  EXPECT_LT(cpu_seconds(::getpid()) - before, 0.05);
  while (cpu_seconds(::getpid()) < before + 0.05) {
  }
}

TEST(FlatMemory, FinishedProcessHasNoTime) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  EXPECT_EQ(cpu_seconds(child), 0);
}

TEST(FlatMemory, TooFewSamplesReportNoGrowth) { EXPECT_EQ(growth(steps(49, 0, 100), kNone), ""); }

TEST(FlatMemory, TenthsAreMaxima) {
  EXPECT_THAT(tenths(steps(20, 0, 1)), testing::ElementsAre(1, 3, 5, 7, 9, 11, 13, 15, 17, 19));
}

TEST(FlatMemory, MeasuresResidentMemory) {
  EXPECT_GT(resident_bytes(::getpid()), 1'000'000u);
  EXPECT_EQ(resident_bytes(-1), 0u);
}

TEST(FlatMemory, UnfreedMemoryIsOnTheHeap) {
  if (!kCheckMemory) GTEST_SKIP() << "AddressSanitizer has a heap of its own";
  constexpr std::size_t kBytes = 50'000;
  const std::uint64_t before = heap_bytes();
  auto bytes = std::make_unique<std::byte[]>(kBytes);
  EXPECT_GE(heap_bytes(), before + kBytes);
  bytes.reset();
  EXPECT_LT(heap_bytes(), before + kBytes);
}

}  // namespace
}  // namespace deburr::tool::flat_memory_test
