// SPDX-License-Identifier: MIT
// Runs a simulation in a child process, so that one test can compare several: SystemC elaborates
// once per process. Call it before the test itself elaborates anything.
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

// From libgcov, in coverage builds: without it a process that ends with _Exit() loses its counts.
extern "C" [[gnu::weak]] void __gcov_dump();

namespace deburr::tb {

// Returns whether an expectation of the test has failed; null outside tests. Without it, failures
// in a child would be lost (forked_expectations.cpp).
inline bool (*expectation_failed)() = nullptr;

// Runs `work` in a child process and returns its text. An exception in it, or a failed expectation,
// is rethrown as a runtime_error with the same text.
inline std::string forked_text(const std::function<std::string()>& work) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("pipe() failed");
  std::fflush(nullptr);
  const bool failed_before = expectation_failed && expectation_failed();
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork() failed");
  if (child == 0) {
    close(ends[0]);
    std::string text;
    int status = 0;
    try {
      text = work();
      if (expectation_failed && expectation_failed() && !failed_before)
        throw std::runtime_error("an expectation failed in the child process: " + text);
    } catch (const std::exception& error) {
      text = error.what();
      status = 1;
    }
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t n = write(ends[1], text.data() + done, text.size() - done);
      if (n <= 0) std::_Exit(2);
      done += static_cast<std::size_t>(n);
    }
    if (__gcov_dump) __gcov_dump();
    std::_Exit(status);
  }
  close(ends[1]);
  std::string text;
  char buffer[4096];
  for (ssize_t n = 0; (n = read(ends[0], buffer, sizeof buffer)) > 0;)
    text.append(buffer, static_cast<std::size_t>(n));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFSIGNALED(status))
    throw std::runtime_error("the child ended by signal " + std::to_string(WTERMSIG(status)));
  if (WEXITSTATUS(status) != 0) throw std::runtime_error(text);
  return text;
}

// As above for a trivially copyable value.
template <class Result>
Result forked(const std::function<Result()>& work) {
  static_assert(std::is_trivially_copyable_v<Result>, "it comes back through a pipe");
  const std::string bytes = forked_text([&] {
    const Result result = work();
    return std::string(reinterpret_cast<const char*>(&result), sizeof result);
  });
  if (bytes.size() != sizeof(Result)) throw std::runtime_error("the child process sent no result");
  Result result;
  bytes.copy(reinterpret_cast<char*>(&result), sizeof(Result));
  return result;
}

}  // namespace deburr::tb
