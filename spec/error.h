// SPDX-License-Identifier: MIT
// Base type of all errors that a user can cause, and the check for errors of the models themselves.
#pragma once

#include <stdexcept>
#include <string>

namespace deburr::spec {

// The exit codes of the `deburr` command (docs/reference/command_line.md).
enum class ExitCode : int {
  kPass = 0,
  kMismatch = 1,
  kUsage = 2,
  kSimulation = 3,
  kDeadlock = 4,
  kFile = 5
};

// Base of every error caused by input, configuration or the environment. The text says what is
// wrong and where (file, line, instance, cycle, pixel), what was expected, what was given, and what
// to do.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& text) : std::runtime_error(text), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

// Invalid command line, configuration or parameter value.
class ConfigError : public Error {
 public:
  explicit ConfigError(const std::string& text) : Error(ExitCode::kUsage, text) {}
};

// A file that cannot be read, parsed or written.
class FileError : public Error {
 public:
  explicit FileError(const std::string& text) : Error(ExitCode::kFile, text) {}
};

// The simulated system reported an error (memory error response, protocol violation).
class SimulationError : public Error {
 public:
  explicit SimulationError(const std::string& text) : Error(ExitCode::kSimulation, text) {}
};

// No progress: the text of the watchdog contains the state of every link.
class DeadlockError : public Error {
 public:
  explicit DeadlockError(const std::string& text) : Error(ExitCode::kDeadlock, text) {}
};

// A broken invariant of the models themselves. Always compiled in.
class CheckFailed : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

[[noreturn]] inline void fail_check(const char* condition, const char* file, int line,
                                    const std::string& text) {
  throw CheckFailed(std::string(file) + ":" + std::to_string(line) +
                    ": check failed: " + condition + ": " + text);
}

}  // namespace deburr::spec

// DEBURR_CHECK(condition, text): an invariant that is checked in every build. `text` names the
// instance, cycle or pixel; it is evaluated only on failure.
#define DEBURR_CHECK(condition, text)                                     \
  do {                                                                    \
    if (!(condition)) [[unlikely]]                                        \
      ::deburr::spec::fail_check(#condition, __FILE__, __LINE__, (text)); \
  } while (false)
