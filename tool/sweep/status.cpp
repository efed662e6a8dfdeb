// SPDX-License-Identifier: MIT
#include "tool/sweep/status.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "tb/base/atomic_file.h"
#include "tb/base/file.h"
#include "tb/base/json_text.h"
#include "tool/sweep/worker.h"

namespace deburr::tool {
namespace {

namespace fs = std::filesystem;
using std::chrono::duration_cast;
using std::chrono::seconds;
using std::chrono::system_clock;

constexpr std::size_t kFailuresShown = 10;

fs::path start_file(const SweepPlace& place) { return place.directory / "start.json"; }

std::string in_words(double time) {
  const auto whole = static_cast<std::uint64_t>(std::llround(time));
  if (whole < 120) return fmt::format("{} s", whole);
  if (whole < 7200) return fmt::format("{} min", whole / 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

// At the rate of the most recently started run.
std::string time_left(const SweepPlace& place) {
  std::error_code error;
  const auto ended = static_cast<double>(read_progress(place.directory).ended());
  if (ended == 0 || !fs::exists(start_file(place), error)) return "";
  const auto start = tb::try_parse_json(tb::read_file(start_file(place), 1 << 16));
  if (!start.is_object()) return "";
  const double passed =
      static_cast<double>(duration_cast<seconds>(system_clock::now().time_since_epoch()).count()) -
      start.value("began", 0.0);
  const double rest = start.value("points", 0.0) - ended;
  return rest > 0 ? in_words(passed / ended * rest) : "";
}

}  // namespace

Status look(const SweepPlace& place, const Plan& plan) {
  Status status;
  for_each_point(points_file(place.directory), [&](const PlannedPoint& point) {
    const fs::path directory = point_directory(place.points(), point.name);
    switch (state_of(directory)) {
      case PointState::kDone:
        ++status.done;
        break;
      case PointState::kRunning:
        ++status.running;
        break;
      case PointState::kMissing:
        ++status.missing;
        break;
      case PointState::kFailed:
        if (status.failures.size() < kFailuresShown)
          status.failures.push_back({directory, read_failure(directory),
                                     arguments_of(plan.engine_of(point), plan.settings_of(point))});
        ++status.failed;
        break;
    }
  });
  if (status.running > 0) status.time_left = time_left(place);
  return status;
}

void note_start(const SweepPlace& place, std::uint64_t points) {
  const auto now = duration_cast<seconds>(system_clock::now().time_since_epoch()).count();
  tb::write_file_atomically(
      start_file(place),
      tb::json_text(nlohmann::ordered_json{{"began", now}, {"points", points}}) + "\n");
}

}  // namespace deburr::tool
