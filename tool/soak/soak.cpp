// SPDX-License-Identifier: MIT
#include "tool/soak/soak.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <system_error>

#include "spec/error.h"
#include "tb/base/interrupt.h"
#include "tb/scene/reference.h"
#include "tool/run/random_configuration.h"
#include "tool/run/run_once.h"
#include "tool/soak/flat_memory.h"

namespace deburr::tool {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Settings = std::vector<std::pair<std::string, std::string>>;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string megabytes(std::uint64_t bytes) {
  return fmt::format("{:.1f}", static_cast<double>(bytes) / 1e6);
}

// A child's report on its run.
struct Said {
  int code = 0;
  std::string reason;
  std::uint64_t comparisons = 0, mismatches = 0, cycles = 0, frames = 1;
  bool reset = false;
};

Said said_of(const std::string& text) {
  const nlohmann::json json = nlohmann::json::parse(text);
  Said said;
  json.at("code").get_to(said.code);
  json.at("reason").get_to(said.reason);
  json.at("comparisons").get_to(said.comparisons);
  json.at("mismatches").get_to(said.mismatches);
  json.at("cycles").get_to(said.cycles);
  json.at("frames").get_to(said.frames);
  json.at("reset").get_to(said.reset);
  return said;
}

// Runs in the child.
std::string run(const std::string& engine, const Settings& settings, const fs::path& directory) {
  nlohmann::json said = {
      {"comparisons", 0}, {"mismatches", 0}, {"cycles", 0}, {"frames", 1}, {"reset", false}};
  try {
    const std::unique_ptr<Engine> made = engine_named(engine);
    BoundEngine bound(*made);
    for (const auto& [name, value] : settings) bound.set.set(name, value, "--set");
    bound.resolve();
    RunContext context(directory, bound.set, "", static_cast<std::uint64_t>(bound.run.seed));
    context.set_quiet(true);
    context.set_report(false);
    const RunEnd end = run_once(bound, context, IfTaken::kWait);
    context.finish(end.result);
    said["code"] = end.code;
    said["reason"] = end.result.reason;
    said["comparisons"] = end.result.comparisons + end.result.traffic_comparisons;
    said["mismatches"] = end.result.mismatches + end.result.traffic_mismatches;
    said["cycles"] = end.result.cycles;
    std::uint64_t frames = 1;
    for (const tb::Parameter& parameter : bound.set.all())
      if (parameter.kind == tb::ParameterKind::kInput && parameter.name.ends_with(".count"))
        frames = std::stoull(parameter.text());
    said["frames"] = frames;
    // A run that ends before its reset was not reset.
    said["reset"] = bound.run.reset_after > 0 &&
                    static_cast<std::uint64_t>(bound.run.reset_after) < end.result.cycles / frames;
  } catch (const std::exception& error) {
    said["code"] = 2;
    said["reason"] = error.what();
  }
  return said.dump();
}

struct Ended {
  Said said;
  std::vector<std::uint64_t> resident;  // sampled during the run
};

constexpr int kSamplePeriod = 20;        // ms
constexpr double kLongestSeconds = 600;  // per run; beyond it counts as hung

Ended run_in_child(const std::string& engine, const Settings& settings, const fs::path& directory) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw spec::FileError(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
  std::fflush(nullptr);
  const pid_t parent = ::getpid(), child = ::fork();
  if (child < 0) throw spec::FileError(fmt::format("cannot fork: {}", std::strerror(errno)));
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);
    ::close(ends[0]);
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(nowhere, STDERR_FILENO);
    const std::string text = run(engine, settings, directory);
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t n = ::write(ends[1], text.data() + done, text.size() - done);
      if (n <= 0) ::_exit(1);
      done += static_cast<std::size_t>(n);
    }
    ::_exit(0);
  }
  ::close(ends[1]);
  Ended ended;
  std::string text;
  const Clock::time_point start = Clock::now();
  double next_sample = 0;  // in CPU seconds of the child
  for (bool open = true; open;) {
    pollfd readable{ends[0], POLLIN, 0};
    if (::poll(&readable, 1, kSamplePeriod) > 0) {
      std::array<char, 4096> bytes{};
      const ssize_t n = ::read(ends[0], bytes.data(), bytes.size());
      if (n <= 0) open = false;
      text.append(bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
    } else {
      // Sampled by CPU time: a child waiting for a processor does not progress.
      if (const double worked = cpu_seconds(child); worked >= next_sample) {
        ended.resident.push_back(resident_bytes(child));
        next_sample = worked + kSamplePeriod * 1e-3;
      }
      if (tb::interrupted() || seconds_since(start) > kLongestSeconds) ::kill(child, SIGKILL);
    }
  }
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
    ended.said = said_of(text);
  } else {
    ended.said.code = 3;
    ended.said.reason = WIFSIGNALED(status) ? fmt::format("killed by signal {} after {:.0f} s",
                                                          WTERMSIG(status), seconds_since(start))
                                            : "the child process ended without a report";
  }
  return ended;
}

class Soak {
 public:
  explicit Soak(const SoakOptions& options)
      : options_(options),
        directory_(fs::temp_directory_path() / fmt::format("deburr-soak-{}", ::getpid())) {
    heap_.reserve(kSamples);
    resident_.reserve(kSamples);
  }
  ~Soak() {
    std::error_code ignored;
    fs::remove_all(directory_, ignored);
  }
  Soak(const Soak&) = delete;
  Soak& operator=(const Soak&) = delete;

  int run() {
    for (std::uint64_t i = 0; !over(i); ++i) {
      const std::string& engine = options_.engines[i % options_.engines.size()];
      const std::uint64_t round = i / options_.engines.size();
      const bool is_long =
          options_.long_every > 0 &&
          i % options_.long_every >=
              options_.long_every -
                  std::min<std::uint64_t>(options_.engines.size(), options_.long_every);
      try {
        one(engine, options_.seed + round, is_long);
      } catch (const tb::Interrupted&) {
        break;
      }
      progress(i + 1);
    }
    return verdict();
  }

 private:
  struct Totals {
    std::uint64_t runs = 0, frames = 0, resets = 0, cycles = 0, comparisons = 0, mismatches = 0,
                  failures = 0;
    void add(const Said& said) {
      ++runs;
      frames += said.frames;
      resets += said.reset ? 1 : 0;
      cycles += said.cycles;
      comparisons += said.comparisons;
      mismatches += said.mismatches;
      failures += said.code != 0 ? 1 : 0;
    }
  };

  bool over(std::uint64_t runs) const {
    return tb::interrupted() || seconds_since(start_) >= options_.seconds ||
           (options_.runs > 0 && runs >= options_.runs);
  }

  // Makes the run long, as its engine declares.
  static void lengthen(const std::string& engine, Settings& settings) {
    const LongRun long_run = engine_named(engine)->long_run();
    std::erase_if(settings, [&](const auto& setting) {
      return std::any_of(long_run.without.begin(), long_run.without.end(),
                         [&](std::string_view end) { return setting.first.ends_with(end); });
    });
    settings.insert(settings.end(), long_run.settings.begin(), long_run.settings.end());
  }

  void one(const std::string& engine, std::uint64_t seed, bool is_long) {
    Settings settings = random_configuration(engine, seed);
    if (is_long) lengthen(engine, settings);
    settings.insert(settings.end(), options_.settings.begin(), options_.settings.end());
    const Ended ended = run_in_child(engine, settings, directory_);
    if (tb::interrupted()) return;
    totals_[engine].add(ended.said);
    if (ended.said.code != 0) complain(engine, settings, ended.said.reason);
    if (!is_long) return;
    const std::string grown =
        is_checked(ended.resident) ? growth(ended.resident, kResidentAllowance) : "";
    std::string tenth;
    for (const std::uint64_t bytes : tenths(ended.resident))
      tenth += fmt::format(" {}", megabytes(bytes));
    fmt::print("long run  {}, seed {}: {} frames, {} cycles, MB in each tenth{}{}\n", engine, seed,
               ended.said.frames, ended.said.cycles, tenth, grown.empty() ? "" : " GREW");
    ++long_runs_;
    if (is_checked(ended.resident)) ++checked_;
    if (grown.empty()) return;
    ++grown_;
    complain(engine, settings, "memory grew " + grown);
  }

  static void complain(const std::string& engine, const Settings& settings,
                       const std::string& reason) {
    std::string command = "deburr run " + engine;
    // The last setting of a name wins; `deburr run` accepts each once.
    std::map<std::string, std::string> last;
    for (const auto& [name, value] : settings) last[name] = value;
    for (const auto& [name, value] : last) command += fmt::format(" --set '{}={}'", name, value);
    fmt::print("FAIL      {}: {}\n          {}\n", engine, reason, command);
    std::fflush(stdout);
  }

  Totals all() const {
    Totals sum;
    for (const auto& [engine, t] : totals_) {
      sum.runs += t.runs;
      sum.frames += t.frames;
      sum.resets += t.resets;
      sum.cycles += t.cycles;
      sum.comparisons += t.comparisons;
      sum.mismatches += t.mismatches;
      sum.failures += t.failures;
    }
    return sum;
  }

  void progress(std::uint64_t runs) {
    const double time = seconds_since(start_) / options_.seconds;
    const double count =
        options_.runs > 0 ? static_cast<double>(runs) / static_cast<double>(options_.runs) : 0;
    const double done = std::max(time, count);
    if (done >= next_sample_) {
      // Memory that the allocator retains is not a leak.
      ::malloc_trim(0);
      heap_.push_back(heap_bytes());
      resident_.push_back(resident_bytes(::getpid()));
      while (next_sample_ <= done) next_sample_ += 0.01;
    }
    if (done < next_) return;
    while (next_ <= done) next_ += 0.1;
    const Totals t = all();
    const double seconds = seconds_since(start_);
    fmt::print(
        "{:6.0f} s  {} runs ({:.1f} per second), {} comparisons, {} mismatches, {} failures, {} MB "
        "resident, {} bytes on the heap\n",
        seconds, t.runs, static_cast<double>(t.runs) / seconds, t.comparisons, t.mismatches,
        t.failures, megabytes(resident_.back()), heap_.back());
    std::fflush(stdout);
  }

  int verdict() const {
    fmt::print(
        "\n| engine | runs | frames | resets during a run | cycles | comparisons | mismatches | "
        "failures |\n|---|---|---|---|---|---|---|---|\n");
    for (const auto& [engine, t] : totals_)
      fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} |\n", engine, t.runs, t.frames, t.resets,
                 t.cycles, t.comparisons, t.mismatches, t.failures);
    const Totals t = all();
    std::string grown;
    if (is_checked(heap_)) {
      if (const std::string heap = growth(heap_, kHeapAllowance); !heap.empty())
        grown += "; this process's heap grew " + heap;
      if (const std::string pages = growth(resident_, kResidentAllowance); !pages.empty())
        grown += "; this process's resident memory grew " + pages;
    }
    if (grown_ > 0) grown += fmt::format("; memory grew in {} of {} long runs", grown_, checked_);
    const bool good = t.mismatches + t.failures == 0 && grown.empty() && t.comparisons > 0;
    fmt::print(
        "RESULT: {} soak: {} runs in {:.0f} s, {} of them long, {} of these long enough to check "
        "their memory; {} comparisons, {} mismatches, {} failures, memory {}{}\n",
        !good               ? "FAIL"
        : tb::interrupted() ? "INTERRUPTED"
                            : "PASS",
        t.runs, seconds_since(start_), long_runs_, checked_, t.comparisons, t.mismatches,
        t.failures,
        !grown.empty()      ? "not flat"
        : is_checked(heap_) ? "flat"
                            : "not checked",
        grown);
    return !good ? 1 : tb::interrupted() ? tb::kInterruptedExit : 0;
  }

  static bool is_checked(const std::vector<std::uint64_t>& samples) {
    return kCheckMemory && samples.size() >= kLeastSamples;
  }

  static constexpr std::size_t kSamples = 101;

  const SoakOptions& options_;
  fs::path directory_;
  Clock::time_point start_ = Clock::now();
  double next_ = 0.1, next_sample_ = 0;
  std::map<std::string, Totals> totals_;
  std::vector<std::uint64_t> heap_, resident_;
  std::uint64_t long_runs_ = 0, checked_ = 0, grown_ = 0;
};

}  // namespace

int soak(SoakOptions options) {
  tb::catch_interrupts();
  if (options.engines.empty())
    for (const std::unique_ptr<Engine>& engine : engines())
      options.engines.emplace_back(engine->name());
  return Soak(options).run();
}

}  // namespace deburr::tool
