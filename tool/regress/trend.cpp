// SPDX-License-Identifier: MIT
#include "tool/regress/trend.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <ctime>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "spec/error.h"
#include "tb/base/file.h"
#include "tb/base/json_text.h"
#include "tool/pages/build_info.h"

namespace deburr::tool {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxTrendBytes = 64u << 20;
constexpr double kSlower = 0.8;            // relative to the earlier speed
constexpr double kSecondsOfASpeed = 60.0;  // minimum duration of a night whose speed is compared

double share(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

std::optional<Night> night_in(const std::string& line) {
  const Json json = tb::try_parse_json(line);
  const auto count = [&](const char* key) { return json.at(key).get<std::uint64_t>(); };
  try {
    return Night{.date = json.at("date").get<std::string>(),
                 .commit = json.at("commit").get<std::string>(),
                 .seed = count("seed"),
                 .holds = json.at("holds").get<bool>(),
                 .runs = count("runs"),
                 .passed = count("passed"),
                 .bins = count("bins"),
                 .met = count("met"),
                 .cycles = count("cycles"),
                 .seconds = json.at("seconds").get<double>()};
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace

double Night::cycles_a_second() const {
  return seconds > 0 ? static_cast<double>(cycles) / seconds : 0;
}

Night night_of(const RegressionResult& result, std::uint64_t base_seed) {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  Night night{.date = fmt::format("{:%Y-%m-%d}", fmt::gmtime(now)),
              .commit = build_info().commit,
              .seed = base_seed,
              .holds = result.holds(),
              .runs = result.runs.size(),
              .passed = result.passed};
  for (const auto& [engine, bins] : result.coverage)
    for (const auto& [bin, hits] : bins) {
      ++night.bins;
      night.met += hits > 0 ? 1 : 0;
    }
  for (const RegressionRun& run : result.runs) {
    night.cycles += run.cycles;
    night.seconds += run.seconds;
  }
  return night;
}

Json to_json(const Night& night) {
  return {{"date", night.date},      {"commit", night.commit}, {"seed", night.seed},
          {"holds", night.holds},    {"runs", night.runs},     {"passed", night.passed},
          {"bins", night.bins},      {"met", night.met},       {"cycles", night.cycles},
          {"seconds", night.seconds}};
}

std::vector<std::string> falls_between(const Night& before, const Night& after) {
  std::vector<std::string> falls;
  const double passed = share(before.passed, before.runs), passes = share(after.passed, after.runs);
  if (passes < passed)
    falls.push_back(fmt::format("pass rate from {:.1f} % to {:.1f} %", 100 * passed, 100 * passes));
  if (share(after.met, after.bins) < share(before.met, before.bins))
    falls.push_back(fmt::format("bins met from {} of {} to {} of {}", before.met, before.bins,
                                after.met, after.bins));
  const double fast = before.cycles_a_second(), slow = after.cycles_a_second();
  if (std::min(before.seconds, after.seconds) >= kSecondsOfASpeed && slow < kSlower * fast)
    falls.push_back(fmt::format("speed from {:.0f} to {:.0f} thousand cycles per second",
                                fast / 1e3, slow / 1e3));
  return falls;
}

fs::path trend_file(const fs::path& out, const std::string& testplan) {
  return out / "regressions" / (testplan + ".jsonl");
}

std::vector<Night> read_trend(const fs::path& file) {
  std::vector<Night> nights;
  if (!tb::is_there(file)) return nights;
  std::istringstream lines(tb::read_file(file, kMaxTrendBytes));
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::optional<Night> night = night_in(line);
    if (!night)
      throw spec::FileError(fmt::format(
          "'{}': line {} is not an entry of this version: move the file away, or fix the line",
          file.string(), number));
    nights.push_back(*night);
  }
  return nights;
}

std::vector<Night> with_night(std::vector<Night> nights, const Night& night) {
  std::erase_if(nights, [&](const Night& other) {
    return other.seed == night.seed && other.commit == night.commit;
  });
  nights.push_back(night);
  return nights;
}

std::string trend_text(const std::vector<Night>& nights) {
  std::string text;
  for (const Night& night : nights)
    text += tb::json_text(to_json(night), -1, tb::NotUtf8::kReplace) + "\n";
  return text;
}

TrendLock::TrendLock(const fs::path& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  while (descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) {
  }
}

// On a file system without locks, the file is written without a lock.
TrendLock::~TrendLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace deburr::tool
