// SPDX-License-Identifier: MIT
// Progress of long work on the error stream: a bar with rate and time left on a terminal, in one
// line as wide as it is at the time, a plain line every few seconds otherwise. What was taken
// counts half: a pipeline that holds a whole window of its input delivers nothing for long.
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
  // `unit` is what is counted: "fragment". A quiet one says nothing.
  Progress(std::string_view label, std::uint64_t total, std::string_view unit, bool quiet = false);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Cheap enough to be called often: the clock is read once in a while.
  void update(std::uint64_t done) { update(done, done); }
  void update(std::uint64_t delivered, std::uint64_t taken);

  // Shown behind the line.
  void note(std::string text) { note_ = std::move(text); }

  // What counts as done: the mean of what was delivered and what was taken.
  static std::uint64_t done(std::uint64_t delivered, std::uint64_t taken) {
    return delivered + (taken > delivered ? (taken - delivered) / 2 : 0);
  }
  // The line shown, for tests: "texture  42 %  1.2 Mfragment/s  3 s left".
  static std::string line(std::string_view label, std::string_view unit, std::uint64_t done,
                          std::uint64_t total, double seconds);
  // That line in a terminal of so many columns, with a bar in front and a note behind. In a narrow
  // one first the bar goes, then the rate, then the time left, then the note; at last it is cut.
  static std::string fitted(std::size_t columns, std::string_view label, std::string_view unit,
                            std::uint64_t done, std::uint64_t total, double seconds,
                            std::string_view note);

 private:
  using Clock = std::chrono::steady_clock;
  void show(std::uint64_t done, Clock::time_point now);

  std::string label_, unit_, note_;
  std::uint64_t total_;
  std::uint64_t done_ = 0;
  bool quiet_, terminal_;
  bool shown_ = false;
  Clock::time_point start_, last_;
};

// Work of which nobody knows how much is left, such as a reference that is rendered: how long it
// takes.
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

// What the error says when --max-cycles is reached: how far the run came and what to raise.
std::string out_of_cycles(std::uint64_t cycles, std::uint64_t done, std::uint64_t total,
                          std::string_view unit);

}  // namespace deburr::tb
