// SPDX-License-Identifier: MIT
#include "tool/sweep/status.h"

#include <fmt/format.h>
#include <sys/stat.h>

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

// At the pace of the most recently started run. A worker notes the end of a point together with the
// start of its next one, so the last note is about as old as the last result. The time left is
// counted down from there: it does not rise while slow points run.
void estimate(const SweepPlace& place, Status& status) {
  std::error_code error;
  const auto ended = static_cast<double>(read_progress(place.directory).ended());
  if (ended == 0 || !fs::exists(start_file(place), error)) return;
  const auto start = tb::try_parse_json(tb::read_file(start_file(place), 1 << 16));
  struct stat noted {};
  if (!start.is_object() || ::stat(progress_file(place.directory).c_str(), &noted) != 0) return;
  const auto last = static_cast<double>(noted.st_mtime);
  const double idle =
      static_cast<double>(duration_cast<seconds>(system_clock::now().time_since_epoch()).count()) -
      last;
  status.seconds_per_point = std::max(0.0, last - start.value("began", last)) / ended;
  const double left =
      status.seconds_per_point * (start.value("points", 0.0) - ended) - std::max(0.0, idle);
  if (left > 0) status.time_left = in_words(left);
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
  if (status.running > 0) estimate(place, status);
  return status;
}

void note_start(const SweepPlace& place, std::uint64_t points) {
  const auto now = duration_cast<seconds>(system_clock::now().time_since_epoch()).count();
  tb::write_file_atomically(
      start_file(place),
      tb::json_text(nlohmann::ordered_json{{"began", now}, {"points", points}}) + "\n");
}

}  // namespace deburr::tool
