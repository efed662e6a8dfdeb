// SPDX-License-Identifier: MIT
#include "tool/sweep/local_engine.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <system_error>
#include <thread>
#include <utility>

#include "spec/error.h"
#include "tb/base/atomic_file.h"
#include "tb/base/interrupt.h"
#include "tb/base/shell.h"
#include "tb/run/progress.h"
#include "tool/sweep/worker.h"

namespace deburr::tool {
namespace {

namespace fs = std::filesystem;
using spec::FileError;

constexpr std::uint64_t kMostInChunk = 64;
constexpr std::uint64_t kChunksPerJob = 4;  // so that the last one does not take long

// Escapes text as the value of a variable, since '|' cannot be written in a path.
std::string ninja_value(const std::string& value) {
  std::string text;
  for (const char c : value) {
    if (c == '\n')
      throw FileError(fmt::format("'{}': Ninja does not support names with a line break", value));
    if (c == '$' || (c == ' ' && text.empty())) text += '$';
    text += c;
  }
  return text;
}

std::string in_words(const PointCounts& counts, std::uint64_t points) {
  const auto rest = [](std::uint64_t all, std::uint64_t some) { return all - std::min(all, some); };
  return fmt::format("{} queued, {} running, {} passed, {} failed", rest(points, counts.begun),
                     rest(counts.begun, counts.ended()), counts.done, counts.failed);
}

class Sorter {
 public:
  Sorter(const SweepPlace& place, bool retry) : place_(place), retry_(retry) {}

  void take(const PlannedPoint& point) {
    const fs::path directory = point_directory(place_.points(), point.name);
    const PointState state = state_of(directory);
    if (state == PointState::kDone) {
      ++pending_.done;
    } else if (state == PointState::kFailed && !retry_ && !read_failure(directory).again) {
      ++pending_.failed;
    } else {
      if (state == PointState::kFailed) {
        // A result, if present, is not counted.
        std::error_code error;
        fs::remove(directory / "result.json", error);
        remove_failure(directory);
      }
      pending_.points.push_back(point);
    }
  }

  Pending sorted() {
    std::stable_sort(pending_.points.begin(), pending_.points.end(),
                     [](const PlannedPoint& a, const PlannedPoint& b) {
                       return std::pair(a.input, a.golden) < std::pair(b.input, b.golden);
                     });
    return std::move(pending_);
  }

 private:
  const SweepPlace& place_;
  bool retry_;
  Pending pending_;
};

}  // namespace

Pending find_pending(const SweepPlace& place, bool retry) {
  Sorter sorter(place, retry);
  for_each_point(points_file(place.directory),
                 [&](const PlannedPoint& point) { sorter.take(point); });
  return sorter.sorted();
}

Pending find_pending(const SweepPlace& place, const std::vector<PlannedPoint>& points, bool retry) {
  Sorter sorter(place, retry);
  for (const PlannedPoint& point : points) sorter.take(point);
  return sorter.sorted();
}

SweepLock::SweepLock(const fs::path& sweep) {
  const fs::path file = sweep / "run.lock";
  descriptor_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0)
    throw FileError(fmt::format("cannot create '{}': {}", file.string(), std::strerror(errno)));
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  ::close(descriptor_);
  throw FileError(fmt::format(
      "'{}' is being run by another process: wait for it, or see its progress with 'status'",
      sweep.string()));
}

SweepLock::~SweepLock() { ::close(descriptor_); }

std::uint64_t write_tasks(const Plan& plan, const SweepPlace& place, const fs::path& folder,
                          const std::vector<PlannedPoint>& points, const RunSettings& settings,
                          std::uint64_t most) {
  std::error_code ignored;
  fs::remove(progress_file(place.directory), ignored);
  const fs::path pending = folder / "pending.jsonl";
  const std::uint64_t jobs = most * std::max(1u, settings.jobs);
  const std::uint64_t size =
      plan.chunk > 0
          ? plan.chunk
          : std::clamp<std::uint64_t>(points.size() / (kChunksPerJob * jobs), 1, kMostInChunk);
  const std::uint64_t chunks = (points.size() + size - 1) / size;
  const std::uint64_t tasks = std::min(most, chunks);
  std::vector<std::string> ninja(
      tasks,
      fmt::format("# Written by deburr sweep: the targets are never made, so that all are run.\n"
                  "ninja_required_version = 1.8\n"
                  "rule chunk\n"
                  "  command = exec {} sweep-worker {} {} {} $lines\n"
                  "  description = chunk $lines\n",
                  ninja_value(tb::shell_quoted(settings.program)),
                  ninja_value(tb::shell_quoted(place.out.string())),
                  ninja_value(tb::shell_quoted(place.directory.string())),
                  ninja_value(tb::shell_quoted(pending.string()))));
  for (std::uint64_t task = 0; task < tasks; ++task)
    ninja[task] += fmt::format("folder = {}\nbuilddir = $folder/ninja_{}\n",
                               ninja_value(folder.string()), task);
  std::string lines;
  for (std::uint64_t chunk = 0; chunk < chunks; ++chunk) {
    const std::size_t from = chunk * size;
    const std::size_t to = std::min<std::size_t>(points.size(), from + size);
    // Consecutive points share inputs and stay in one task.
    ninja[chunk * tasks / chunks] += fmt::format("build $folder/chunk_{}: chunk\n  lines = {} {}\n",
                                                 chunk, lines.size(), to - from);
    for (std::size_t i = from; i < to; ++i) lines += line_of(points[i]) + "\n";
  }
  tb::write_file_atomically(pending, lines);
  for (std::uint64_t task = 0; task < tasks; ++task)
    tb::write_file_atomically(folder / fmt::format("task_{}.ninja", task), ninja[task]);
  return tasks;
}

int run_ninja(const SweepPlace& place, std::uint64_t points, const RunSettings& settings) {
  const pid_t parent = ::getpid();
  const pid_t ninja = ::fork();
  if (ninja < 0) throw FileError(fmt::format("cannot fork: {}", std::strerror(errno)));
  if (ninja == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(tb::kInterruptedExit);
    ::dup2(STDERR_FILENO, STDOUT_FILENO);  // standard output belongs to the command
    const std::string jobs = std::to_string(std::max(1u, settings.jobs));
    const std::string file = (place.directory / "task_0.ninja").string();
    ::execlp("ninja", "ninja", "--quiet", "-k", "0", "-j", jobs.c_str(), "-f", file.c_str(),
             static_cast<char*>(nullptr));
    ::_exit(tb::kNoSuchProgram);
  }
  tb::Progress progress(settings.what, points, "point",
                        settings.quiet || settings.watch != nullptr);
  int status = 0;
  for (bool told = false;;) {
    const pid_t ended = ::waitpid(ninja, &status, WNOHANG);
    if (ended < 0 && errno != EINTR)
      throw FileError(fmt::format("cannot wait for Ninja: {}", std::strerror(errno)));
    if (tb::interrupted() && !told && ended != ninja) {
      ::kill(ninja, SIGTERM);
      told = true;
    }
    const PointCounts counts = read_progress(place.directory);
    progress.note(in_words(counts, points));
    progress.update(counts.ended());
    if (settings.watch) settings.watch(counts.ended());
    if (ended == ninja) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  if (tb::interrupted()) return tb::kInterruptedExit;
  if (WIFEXITED(status) && WEXITSTATUS(status) == tb::kNoSuchProgram)
    throw FileError("ninja was not found: install it (Debian: apt-get install ninja-build)");
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace deburr::tool
