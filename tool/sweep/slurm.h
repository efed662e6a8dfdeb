// SPDX-License-Identifier: MIT
// Runs a sweep on a cluster: one Slurm job array whose tasks each run Ninja on a share of the
// chunks (a task a point would be more than a scheduler starts in time).
//
// Slurm is believed in nothing but where its tasks are: a point is done when its result is there,
// tasks may be killed, requeued or run twice, and `run` again submits what is missing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tool/sweep/local_engine.h"
#include "tool/sweep/plan.h"

namespace deburr::tool {

// What the user's cluster asks for, from a YAML file.
struct SlurmProfile {
  std::string conf;  // slurm.conf; empty: as SLURM_CONF or the system says
  std::string partition, time, memory;
  std::uint64_t cpus = 1;            // of a task: so many points at a time
  std::uint64_t tasks = 100;         // at most
  std::vector<std::string> options;  // further ones of sbatch
  std::vector<std::string> setup;    // lines before the work: modules, paths
};
// ConfigError with file and line.
SlurmProfile read_profile(const std::filesystem::path& file);

struct SlurmJob {
  std::string id, conf;
  std::uint64_t tasks = 0;
};
// The job that was submitted last, if any.
std::optional<SlurmJob> submitted_job(const SweepPlace& place);
// Once it is over.
void forget_job(const SweepPlace& place);

// Writes task_NNNN.ninja and submit.sh under slurm/ and submits them. FileError when there is no
// Slurm, its configuration is not there or its controller does not answer; ConfigError for what
// sbatch rejects.
SlurmJob submit(const Plan& plan, const SweepPlace& place, const std::vector<PlannedPoint>& points,
                const SlurmProfile& profile, const RunSettings& settings);

struct SlurmStatus {
  std::uint64_t queued = 0, running = 0;
  std::vector<std::string> advice;  // "task 3 is held (JobHeldUser): scontrol release 12_3"
};
// FileError as submit().
SlurmStatus ask_slurm(const SlurmJob& job);
// What is queued would be run twice: FileError while the job that was submitted last has tasks; one
// that is over is forgotten.
void reject_while_submitted(const SweepPlace& place);
// Returns when none of its tasks is queued or running any more, or kInterruptedExit.
int wait_for(const SlurmJob& job);

}  // namespace deburr::tool
