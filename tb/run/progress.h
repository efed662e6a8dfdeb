// SPDX-License-Identifier: MIT
// Progress of long work on the error stream. On a terminal that takes control sequences: a bar with
// rate and remaining time, fitted to the current width. Otherwise: a plain line every few seconds.
// Input that was taken counts as half of the progress, since a pipeline that first buffers input
// delivers nothing for a long time.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace deburr::tb {

class Progress {
 public:
  // `unit` is the counted item, such as "fragment". `quiet` disables output.
  Progress(std::string_view label, std::uint64_t total, std::string_view unit, bool quiet = false);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Cheap enough to call often: the clock is read only occasionally.
  void update(std::uint64_t done) { update(done, done); }
  void update(std::uint64_t delivered, std::uint64_t taken);

  // Shown after the line.
  void note(std::string text) { note_ = std::move(text); }

  // Progress count: mean of delivered and taken items.
  static std::uint64_t done(std::uint64_t delivered, std::uint64_t taken) {
    return delivered + (taken > delivered ? (taken - delivered) / 2 : 0);
  }
  // The line shown, for tests: "texture  42 %  1.2 Mfragment/s  3 s left". `idle`: seconds since
  // `done` last grew. Rate and remaining time are those of that moment, and the remaining time is
  // counted down from it: it does not rise while a slow item is under way.
  static std::string line(std::string_view label, std::string_view unit, std::uint64_t done,
                          std::uint64_t total, double seconds, double idle = 0);
  // Fits that line into `columns`, with a bar before it and a note after it. In a narrow terminal
  // the bar is dropped first, then rate, remaining time and note; finally the line is truncated.
  static std::string fitted(std::size_t columns, std::string_view label, std::string_view unit,
                            std::uint64_t done, std::uint64_t total, double seconds,
                            std::string_view note, double idle = 0);

 private:
  using Clock = std::chrono::steady_clock;
  void show(std::uint64_t done, Clock::time_point now);

  std::string label_, unit_, note_;
  std::uint64_t total_;
  std::uint64_t done_ = 0;
  bool quiet_, terminal_;
  bool shown_ = false;
  Clock::time_point start_, last_, grown_;
};

// Shows the elapsed time of work whose remaining amount is unknown, such as rendering a reference.
class Waiting {
 public:
  explicit Waiting(std::string label, bool quiet = false);
  ~Waiting();
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;
  void update();

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  bool quiet_, terminal_, shown_ = false;
  Clock::time_point start_, last_;
};

// Error text for --max-cycles: progress so far and which limit to raise.
std::string out_of_cycles(std::uint64_t cycles, std::uint64_t done, std::uint64_t total,
                          std::string_view unit);

}  // namespace deburr::tb
