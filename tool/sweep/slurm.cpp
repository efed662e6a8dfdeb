// SPDX-License-Identifier: MIT
#include "tool/sweep/slurm.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <system_error>
#include <thread>
#include <utility>

#include "spec/error.h"
#include "tb/base/atomic_file.h"
#include "tb/base/file.h"
#include "tb/base/headline.h"
#include "tb/base/interrupt.h"
#include "tb/base/json_text.h"
#include "tb/base/shell.h"
#include "tb/base/yaml_file.h"
#include "tb/run/amount.h"

namespace deburr::tool {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using spec::ConfigError;
using spec::FileError;
using std::chrono::steady_clock;

constexpr std::size_t kMaxProfileBytes = 1 << 20;
constexpr auto kPatience = std::chrono::seconds(20);
constexpr std::uint64_t kMostProcessors = 4096, kMostTasks = 1000;
constexpr int kLooksASecond = 10;  // checks for Ctrl-C while waiting for a job

fs::path folder_of(const SweepPlace& place) { return place.directory / "slurm"; }
fs::path job_file(const SweepPlace& place) { return folder_of(place) / "job.json"; }

struct Answer {
  int code = 0;
  bool late = false;  // it timed out and was killed
  std::string text;   // of both streams
};

Answer ask(const std::vector<std::string>& words, const std::string& conf) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw FileError(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
  const pid_t child = ::fork();
  if (child < 0) throw FileError(fmt::format("cannot fork: {}", std::strerror(errno)));
  if (child == 0) {
    ::dup2(ends[1], STDOUT_FILENO);
    ::dup2(ends[1], STDERR_FILENO);
    if (!conf.empty()) ::setenv("SLURM_CONF", conf.c_str(), 1);
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::execvp(arguments[0], arguments.data());
    ::_exit(tb::kNoSuchProgram);
  }
  ::close(ends[1]);
  Answer answer;
  const auto end = steady_clock::now() + kPatience;
  for (std::array<char, 4096> part{};;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(end - steady_clock::now()).count();
    pollfd wanted{ends[0], POLLIN, 0};
    const int ready = left <= 0 ? 0 : ::poll(&wanted, 1, static_cast<int>(left));
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) {
      answer.late = true;
      ::kill(child, SIGKILL);
      break;
    }
    const ssize_t got = ::read(ends[0], part.data(), part.size());
    if (got <= 0) break;
    answer.text.append(part.data(), static_cast<std::size_t>(got));
  }
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  answer.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  while (!answer.text.empty() && answer.text.back() == '\n') answer.text.pop_back();
  return answer;
}

// If the configuration is wrong, clients hang for a minute, so it is checked first.
void require_slurm(const std::string& conf) {
  std::string file = conf;
  const char* given = std::getenv("SLURM_CONF");
  if (file.empty()) file = given ? given : "/etc/slurm/slurm.conf";
  std::error_code error;
  if (!fs::is_regular_file(file, error))
    throw FileError(fmt::format(
        "Slurm configuration '{}' not found: name it with 'conf' in the profile, or with "
        "SLURM_CONF",
        file));
  const Answer ping = ask({"scontrol", "ping"}, conf);
  if (ping.code == tb::kNoSuchProgram)
    throw FileError("scontrol was not found: install Slurm's clients (Debian: slurm-client)");
  if (ping.late || ping.code != 0 || ping.text.find("UP") == std::string::npos)
    throw FileError(fmt::format(
        "Slurm's controller does not answer ('scontrol ping', {}): {}", file,
        ping.late ? fmt::format("nothing for {} s", kPatience.count()) : tb::headline(ping.text)));
}

std::vector<std::vector<std::string>> table_of(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream in(text);
  for (std::string row; std::getline(in, row);) {
    std::vector<std::string> cells;
    std::istringstream cell_in(row);
    for (std::string cell; std::getline(cell_in, cell, '|');) cells.push_back(cell);
    if (!cells.empty()) rows.push_back(std::move(cells));
  }
  return rows;
}

}  // namespace

SlurmProfile read_profile(const fs::path& file) {
  const tb::YamlFile yaml(file, kMaxProfileBytes);
  const YAML::Node& root = yaml.root();
  yaml.require_keys(root,
                    {"conf", "partition", "time", "memory", "cpus", "tasks", "options", "setup"});
  const auto line = [&](const YAML::Node& node, const char* key) {
    std::string text = yaml.scalar(node, key);
    if (text.find('\n') != std::string::npos)
      yaml.fail(node, fmt::format("'{}' must be a single line", key));
    return text;
  };
  SlurmProfile profile;
  const auto read_line = [&](const char* key, std::string& text) {
    if (root[key]) text = line(root[key], key);
  };
  const auto read_lines = [&](const char* key, std::vector<std::string>& lines) {
    const YAML::Node list = root[key];
    if (!list) return;
    if (!list.IsSequence())
      yaml.fail(list,
                fmt::format("'{}' must be a list of lines, got {}", key, tb::YamlFile::kind(list)));
    for (const auto& entry : list) lines.push_back(line(entry, key));
  };
  const auto read_count = [&](const char* key, std::uint64_t& count, std::uint64_t most) {
    if (root[key]) count = yaml.count(root[key], key, most);
  };
  read_line("conf", profile.conf);
  read_line("partition", profile.partition);
  read_line("time", profile.time);
  read_line("memory", profile.memory);
  read_count("cpus", profile.cpus, kMostProcessors);
  read_count("tasks", profile.tasks, kMostTasks);
  read_lines("options", profile.options);
  read_lines("setup", profile.setup);
  return profile;
}

std::optional<SlurmJob> submitted_job(const SweepPlace& place) {
  std::error_code error;
  if (!fs::exists(job_file(place), error)) return std::nullopt;
  const Json json = tb::try_parse_json(tb::read_file(job_file(place), kMaxProfileBytes));
  if (!json.is_object()) return std::nullopt;
  return SlurmJob{json.value("id", ""), json.value("conf", ""), json.value("tasks", 0u)};
}

void forget_job(const SweepPlace& place) {
  std::error_code ignored;
  fs::remove(job_file(place), ignored);
}

SlurmJob submit(const Plan& plan, const SweepPlace& place, const std::vector<PlannedPoint>& points,
                const SlurmProfile& profile, const RunSettings& settings) {
  require_slurm(profile.conf);
  const fs::path folder = folder_of(place);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw FileError(
        fmt::format("cannot make the folder '{}': {}", folder.string(), error.message()));
  RunSettings each = settings;
  each.jobs = static_cast<unsigned>(profile.cpus);
  const std::uint64_t tasks = write_tasks(plan, place, folder, points, each, profile.tasks);
  std::string script = "#!/bin/sh\n# Written by deburr.\n";
  const auto option = [&](const std::string& text) { script += "#SBATCH " + text + "\n"; };
  option(fmt::format("--job-name=deburr-{}", place.directory.filename().string()));
  option(fmt::format("--array=0-{}", tasks - 1));
  option("--ntasks=1");
  option(fmt::format("--cpus-per-task={}", profile.cpus));
  option("--requeue");
  option("--open-mode=append");
  option(fmt::format("--output={}", (fs::absolute(folder) / "task_%a.log").string()));
  if (!profile.partition.empty()) option("--partition=" + profile.partition);
  if (!profile.time.empty()) option("--time=" + profile.time);
  if (!profile.memory.empty()) option("--mem=" + profile.memory);
  for (const std::string& line : profile.options) option(line);
  script += fmt::format("cd {} || exit 1\n", tb::shell_quoted(fs::current_path().string()));
  for (const std::string& line : profile.setup) script += line + "\n";
  // Ninja's exit code reports a failed point, which is not a failure of the task.
  script += fmt::format("ninja --quiet -k 0 -j {} -f {}/task_$SLURM_ARRAY_TASK_ID.ninja\nexit 0\n",
                        profile.cpus, tb::shell_quoted(folder.string()));
  const fs::path file = folder / "submit.sh";
  tb::write_file_atomically(file, script);
  const Answer answer = ask({"sbatch", "--parsable", file.string()}, profile.conf);
  if (answer.late) throw FileError("sbatch did not answer; the controller may be busy: try again");
  if (answer.code != 0)
    throw ConfigError(
        fmt::format("sbatch rejects '{}': {}", file.string(), tb::headline(answer.text)));
  SlurmJob job{answer.text.substr(0, answer.text.find(';')), profile.conf, tasks};
  tb::write_file_atomically(
      job_file(place),
      tb::json_text(Json{{"id", job.id}, {"conf", job.conf}, {"tasks", job.tasks}}, 1) + "\n");
  return job;
}

SlurmStatus ask_slurm(const SlurmJob& job) {
  require_slurm(job.conf);
  const auto rows = [&](const std::vector<std::string>& words) {
    const Answer answer = ask(words, job.conf);
    // A finished job that Slurm has forgotten is not queued.
    return table_of(answer.code == 0 ? answer.text : "");
  };
  SlurmStatus status;
  std::set<std::string> held;
  for (const auto& row : rows({"squeue", "-h", "-r", "-j", job.id, "-o", "%i|%t|%r"})) {
    if (row.size() < 3) continue;
    ++(row[1] == "R" || row[1] == "CG" ? status.running : status.queued);
    if (row[2].find("Held") != std::string::npos) held.insert(row[2]);
  }
  for (const std::string& why : held)
    status.advice.push_back(fmt::format("tasks are held ({}): scontrol release {}", why, job.id));
  if (status.queued + status.running == 0) return status;
  std::set<std::string> told;
  for (const auto& row : rows({"sinfo", "-h", "-N", "-o", "%N|%T"})) {
    if (row.size() < 2 || !told.insert(row[0]).second) continue;
    if (row[1].find("drain") != std::string::npos || row[1].find("down") != std::string::npos)
      status.advice.push_back(fmt::format(
          "node {0} is {1}: scontrol update NodeName={0} State=RESUME", row[0], row[1]));
  }
  return status;
}

void reject_while_submitted(const SweepPlace& place) {
  const auto job = submitted_job(place);
  if (!job) return;
  const SlurmStatus slurm = ask_slurm(*job);
  if (slurm.queued + slurm.running > 0)
    throw FileError(fmt::format(
        "job {0} still has {1} tasks of this sweep: wait for it, or end it with 'scancel {0}'",
        job->id, tb::grouped(slurm.queued + slurm.running)));
  forget_job(place);
}

int wait_for(const SlurmJob& job) {
  for (;;) {
    const SlurmStatus slurm = ask_slurm(job);
    if (slurm.queued + slurm.running == 0) return 0;
    for (int i = 0; i < kLooksASecond && !tb::interrupted(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1000 / kLooksASecond));
    if (tb::interrupted()) return tb::kInterruptedExit;
  }
}

}  // namespace deburr::tool
