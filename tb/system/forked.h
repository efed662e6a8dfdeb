// SPDX-License-Identifier: MIT
// Runs a simulation in a process of its own, so that one test can compare several: SystemC
// elaborates once a process. Call it before the test itself elaborates anything.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace deburr::tb {

// The result of `work`, or its exception's text as a runtime_error.
template <class Result>
Result forked(const std::function<Result()>& work) {
  static_assert(std::is_trivially_copyable_v<Result>, "it comes back through a pipe");
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("pipe() failed");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork() failed");
  if (child == 0) {
    close(ends[0]);
    std::string message;
    Result result{};
    try {
      result = work();
    } catch (const std::exception& error) {
      message = error.what();
      if (message.empty()) message = "unknown error";
    }
    const void* bytes = message.empty() ? static_cast<const void*>(&result) : message.data();
    const std::size_t size = message.empty() ? sizeof(Result) : message.size();
    const ssize_t written = write(ends[1], bytes, size);
    std::_Exit(written != static_cast<ssize_t>(size) ? 2 : message.empty() ? 0 : 1);
  }
  close(ends[1]);
  std::string bytes;
  char buffer[4096];
  for (ssize_t n = 0; (n = read(ends[0], buffer, sizeof buffer)) > 0;)
    bytes.append(buffer, static_cast<std::size_t>(n));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw std::runtime_error(bytes.empty() ? "the child process died" : bytes);
  }
  if (bytes.size() != sizeof(Result)) throw std::runtime_error("the child process sent no result");
  Result result;
  bytes.copy(reinterpret_cast<char*>(&result), sizeof(Result));
  return result;
}

}  // namespace deburr::tb
