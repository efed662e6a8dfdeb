// SPDX-License-Identifier: MIT
#include "tool/soak/flat_memory.h"

#include <fmt/format.h>
#include <malloc.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace deburr::tool {
namespace {

std::uint64_t largest(std::span<const std::uint64_t> samples) {
  return samples.empty() ? 0 : *std::max_element(samples.begin(), samples.end());
}

std::span<const std::uint64_t> part(std::span<const std::uint64_t> samples, std::size_t index,
                                    std::size_t parts) {
  const std::size_t from = samples.size() * index / parts;
  return samples.subspan(from, samples.size() * (index + 1) / parts - from);
}

}  // namespace

std::uint64_t resident_bytes(pid_t process) {
  std::ifstream statm(fmt::format("/proc/{}/statm", process));
  std::uint64_t pages = 0, resident = 0;
  if (!(statm >> pages >> resident)) return 0;
  return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

double cpu_seconds(pid_t process) {
  clockid_t clock{};
  timespec time{};
  if (::clock_getcpuclockid(process, &clock) != 0 || ::clock_gettime(clock, &time) != 0) return 0;
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

std::uint64_t heap_bytes() {
  const struct mallinfo2 info = ::mallinfo2();
  return info.uordblks + info.hblkhd;
}

std::vector<std::uint64_t> tenths(std::span<const std::uint64_t> samples) {
  constexpr std::size_t kParts = 10;
  std::vector<std::uint64_t> all;
  for (std::size_t i = 0; i < kParts; ++i) all.push_back(largest(part(samples, i, kParts)));
  return all;
}

std::string growth(std::span<const std::uint64_t> samples, const Allowance& allowance) {
  constexpr std::size_t kParts = 5;
  if (samples.size() < kLeastSamples) return "";
  const std::uint64_t before = largest(part(samples, 1, kParts));
  const std::uint64_t after = largest(part(samples, kParts - 2, kParts));
  const std::uint64_t allowed =
      before + allowance.bytes +
      static_cast<std::uint64_t>(allowance.share * static_cast<double>(before));
  if (after <= allowed) return "";
  return fmt::format("from {} to {} bytes, {} are allowed", before, after, allowed);
}

}  // namespace deburr::tool
