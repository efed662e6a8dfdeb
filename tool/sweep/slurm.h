// SPDX-License-Identifier: MIT
// Runs a sweep on a cluster: one Slurm job array whose tasks each run Ninja on some of the chunks
// (one task per point would be more than a scheduler starts in time).
//
// Slurm is asked only for the state of its tasks; a point is done when its result is present. Tasks
// may be killed, requeued or run twice. `run` submits the missing points again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tool/sweep/local_engine.h"
#include "tool/sweep/plan.h"

namespace deburr::tool {

// Settings for the user's cluster, from a YAML file.
struct SlurmProfile {
  std::string conf;  // path of slurm.conf; empty: SLURM_CONF or the system's default
  std::string partition, time, memory;
  std::uint64_t cpus = 1;            // per task: the number of concurrent points
  std::uint64_t tasks = 100;         // maximum
  std::vector<std::string> options;  // additional ones for sbatch
  std::vector<std::string> setup;    // lines run before the work: modules, paths
};
// ConfigError with file and line.
SlurmProfile read_profile(const std::filesystem::path& file);

struct SlurmJob {
  std::string id, conf;
  std::uint64_t tasks = 0;
};
// The most recently submitted job, if any.
std::optional<SlurmJob> submitted_job(const SweepPlace& place);
// Call when the job is finished.
void forget_job(const SweepPlace& place);

// Writes task_NNNN.ninja and submit.sh under slurm/ and submits them. FileError if Slurm or its
// configuration is missing or its controller does not respond; ConfigError for what sbatch rejects.
SlurmJob submit(const Plan& plan, const SweepPlace& place, const std::vector<PlannedPoint>& points,
                const SlurmProfile& profile, const RunSettings& settings);

struct SlurmStatus {
  std::uint64_t queued = 0, running = 0;
  std::vector<std::string> advice;  // "task 3 is held (JobHeldUser): scontrol release 12_3"
};
// FileError as in submit().
SlurmStatus ask_slurm(const SlurmJob& job);
// Prevents queued points from being run twice: FileError while the most recently submitted job has
// tasks. A finished job is forgotten.
void reject_while_submitted(const SweepPlace& place);
// Waits until no task of the job is queued or running. Returns kInterruptedExit if interrupted.
int wait_for(const SlurmJob& job);

}  // namespace deburr::tool
