// SPDX-License-Identifier: MIT
#include "tool/sweep/worker.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "spec/error.h"
#include "tb/base/file.h"
#include "tb/base/headline.h"
#include "tb/base/interrupt.h"
#include "tb/scene/reference.h"
#include "tool/sweep/plan.h"
#include "tool/sweep/point.h"

namespace deburr::tool {

using tb::headline;

namespace {

namespace fs = std::filesystem;
using spec::ExitCode;

struct Ended {
  int status = 0;    // from waitpid
  std::string text;  // the child's last output
};

class Worker {
 public:
  explicit Worker(const WorkerOptions& options)
      : options_(options),
        plan_(read_plan(options.sweep)),
        place_{options.out, options.sweep},
        shared_(std::make_shared<SharedInputs>(place_.cache())) {
    for (const auto& [file, content] : plan_.files)
      if (shared_->files().content(file) != content)
        throw spec::ConfigError(
            fmt::format("'{}' has changed since the sweep was planned: run the sweep again", file));
  }

  int run() {
    for_each_point(
        options_.points,
        [&](const PlannedPoint& point) {
          if (!tb::interrupted()) run(point);
        },
        options_.lines);
    return tb::interrupted() ? tb::kInterruptedExit : 0;
  }

 private:
  void run(const PlannedPoint& planned) {
    const fs::path directory = point_directory(place_.points(), planned.name);
    if (state_of(directory) == PointState::kDone) {
      tick(kPointBegun);
      return tick(kPointDone);
    }
    if (planned.input != input_) shared_->forget();
    input_ = planned.input;
    tick(kPointBegun);
    const std::string& engine = plan_.engine_of(planned);
    const std::vector<Setting> settings = plan_.settings_of(planned);
    std::optional<Failure> failure;
    try {
      PointEngine point(engine, settings);
      point.bound.resolve();
      RunContext context(directory, point.bound.set, command_of(engine, settings),
                         static_cast<std::uint64_t>(point.bound.run.seed));
      context.set_quiet(true);
      context.set_report(plan_.reports);
      context.share(shared_, point.bound.engine.input_files(shared_->files().meshes()));
      failure = prepare(point.bound, context);
      if (!failure)
        failure = check(in_child([&] { return simulate(point.bound, context); }), directory);
    } catch (const tb::Interrupted&) {
      return;
    } catch (const spec::ConfigError& error) {
      failure = Failure{"configuration", headline(error.what()), false};
    }
    if (tb::interrupted() && failure && failure->again) return;
    if (failure)
      write_failure(directory, *failure);
    else
      remove_failure(directory);
    tick(failure ? kPointFailed : kPointDone);
  }

  // An unreadable input fails only the points that use it.
  static std::optional<Failure> prepare(BoundEngine& bound, RunContext& context) {
    try {
      bound.engine.prepare(bound.run, context);
      return std::nullopt;
    } catch (const spec::FileError& error) {
      return Failure{"file", headline(error.what()), true};
    }
  }

  // Runs in the child. If it fails, the output of the child is the reason.
  static std::pair<int, std::string> simulate(BoundEngine& bound, RunContext& context) {
    try {
      const fs::path& directory = context.directory();
      const RunEnd end = run_once(bound, context, IfTaken::kWait, [&] {
        return !has_result(directory) && !has_failed_result(directory);
      });
      // A partial run is not a point of a sweep.
      if (end.result.interrupted) return {tb::kInterruptedExit, "interrupted"};
      if (!end.begun) return {0, ""};  // another worker has done it meanwhile
      // Written before the directory is released, so that a failed result always has a reason.
      if (end.code != 0)
        write_failure(directory, {end.kind, headline(end.result.reason), true});
      else
        remove_failure(directory);
      context.finish(end.result);
      return {end.code, headline(end.result.reason)};
    } catch (const spec::Error& error) {
      return {static_cast<int>(error.code()), headline(error.what())};
    } catch (const std::bad_alloc&) {
      return {static_cast<int>(ExitCode::kSimulation), "out of memory"};
    } catch (const std::exception& error) {
      return {static_cast<int>(ExitCode::kSimulation), headline(error.what())};
    }
  }

  template <class Work>
  static Ended in_child(Work work) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail("make a pipe");
    const pid_t parent = ::getpid();
    const pid_t child = ::fork();
    if (child < 0) fail("fork");
    if (child == 0) {
      // If its worker dies, the point ends too; the next worker repeats it.
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (::getppid() != parent) ::_exit(tb::kInterruptedExit);
      ::close(ends[0]);
      const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
      ::dup2(nowhere, STDOUT_FILENO);
      ::dup2(nowhere, STDERR_FILENO);
      const auto [code, text] = work();
      // Output beyond the pipe's capacity is dropped.
      [[maybe_unused]] const ssize_t written =
          ::write(ends[1], text.data(), std::min<std::size_t>(text.size(), 4000));
      ::_exit(code);
    }
    ::close(ends[1]);
    Ended ended;
    while (::waitpid(child, &ended.status, 0) < 0) {
      if (errno != EINTR) fail("wait for a point");
      if (tb::interrupted()) ::kill(child, SIGKILL);
    }
    std::array<char, 4096> text{};
    if (const ssize_t got = ::read(ends[0], text.data(), text.size()); got > 0)
      ended.text.assign(text.data(), static_cast<std::size_t>(got));
    ::close(ends[0]);
    return ended;
  }

  static std::optional<Failure> left_by_another(const fs::path& directory) {
    if (!has_failed_result(directory)) return std::nullopt;
    Failure failure = read_failure(directory);
    failure.again = false;
    return failure;
  }

  static std::optional<Failure> check(const Ended& ended, const fs::path& directory) {
    if (WIFSIGNALED(ended.status))
      return Failure{"killed",
                     fmt::format("killed by signal {} ({})", WTERMSIG(ended.status),
                                 ::strsignal(WTERMSIG(ended.status))),
                     true};
    switch (WEXITSTATUS(ended.status)) {
      case 0:
        return left_by_another(directory);
      case tb::kInterruptedExit:
        return Failure{"interrupted", "interrupted", true};
      case static_cast<int>(ExitCode::kMismatch):
        return Failure{"mismatch", ended.text, false};
      case static_cast<int>(ExitCode::kUsage):
        return Failure{"configuration", ended.text, false};
      case static_cast<int>(ExitCode::kDeadlock):
        return Failure{"deadlock", ended.text, false};
      case static_cast<int>(ExitCode::kFile):
        // The next point would fail in the same way.
        throw spec::FileError(fmt::format("point '{}': {}", directory.string(), ended.text));
      default:
        return Failure{"simulation", ended.text, false};
    }
  }

  void tick(char mark) const {
    const fs::path file = progress_file(options_.sweep);
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor < 0 || ::write(descriptor, &mark, 1) != 1) fail("write progress");
    ::close(descriptor);
  }

  [[noreturn]] static void fail(const char* action) {
    throw spec::FileError(fmt::format("cannot {}: {}", action, std::strerror(errno)));
  }

  const WorkerOptions& options_;
  Plan plan_;
  SweepPlace place_;
  std::shared_ptr<SharedInputs> shared_;
  std::uint64_t input_ = 0;
};

}  // namespace

fs::path progress_file(const fs::path& sweep) { return sweep / "progress"; }

PointCounts read_progress(const fs::path& sweep) {
  std::ifstream file(progress_file(sweep));
  std::ostringstream marks;
  marks << file.rdbuf();
  const auto count = [text = marks.str()](char mark) {
    return static_cast<std::uint64_t>(std::count(text.begin(), text.end(), mark));
  };
  return {count(kPointBegun), count(kPointDone), count(kPointFailed)};
}

int run_chunk(const WorkerOptions& options) {
  tb::catch_interrupts();
  // If Ninja is killed, its workers end too.
  const pid_t parent = ::getppid();
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) return tb::kInterruptedExit;
  return Worker(options).run();
}

}  // namespace deburr::tool
