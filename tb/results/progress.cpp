// SPDX-License-Identifier: MIT
#include "tb/results/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "tb/results/report.h"

namespace deburr::tb {
namespace {

constexpr auto kTerminalPeriod = std::chrono::milliseconds(100);
constexpr auto kPlainPeriod = std::chrono::seconds(5);
constexpr int kBarWidth = 24;

std::string rate_text(double rate, std::string_view unit) {
  if (rate >= 1e6) return fmt::format("{:.2f} M{}/s", rate / 1e6, unit);
  if (rate >= 1e3) return fmt::format("{:.1f} k{}/s", rate / 1e3, unit);
  return fmt::format("{:.0f} {}/s", rate, unit);
}

std::string time_text(double seconds) {
  const auto whole = std::llround(seconds);
  if (whole >= 3600) return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
  if (whole >= 60) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} s", whole);
}

}  // namespace

std::string out_of_cycles(std::uint64_t cycles, std::uint64_t done, std::uint64_t total,
                          std::string_view unit) {
  return fmt::format(
      "not done after {} cycles, which is all that --max-cycles (run.max_cycles) allows: {} of {} "
      "{}s are done; raise it, or set it to 0 for no limit",
      grouped(cycles), grouped(done), grouped(total), unit);
}

std::string Progress::line(std::string_view label, std::string_view unit, std::uint64_t done,
                           std::uint64_t total, double seconds) {
  const double fraction =
      total ? std::min(1.0, static_cast<double>(done) / static_cast<double>(total)) : 1.0;
  const double rate = seconds > 0 ? static_cast<double>(done) / seconds : 0;
  std::string text =
      fmt::format("{}  {:3.0f} %  {}", label, std::floor(fraction * 100), rate_text(rate, unit));
  if (rate > 0 && done < total)
    text += fmt::format("  {} left", time_text(static_cast<double>(total - done) / rate));
  return text;
}

Progress::Progress(std::string_view label, std::uint64_t total, std::string_view unit, bool quiet)
    : label_(label),
      unit_(unit),
      total_(total),
      quiet_(quiet),
      terminal_(::isatty(STDERR_FILENO) == 1),
      start_(Clock::now()),
      last_(start_) {}

Progress::~Progress() {
  if (shown_ && terminal_) {
    show(done_, Clock::now());
    std::fputc('\n', stderr);
  }
}

void Progress::update(std::uint64_t delivered, std::uint64_t taken) {
  if (quiet_) return;
  done_ = done(delivered, taken);
  const Clock::time_point now = Clock::now();
  if (now - last_ < (terminal_ ? Clock::duration(kTerminalPeriod) : kPlainPeriod)) return;
  show(done_, now);
}

Waiting::Waiting(std::string label, bool quiet)
    : label_(std::move(label)),
      quiet_(quiet),
      terminal_(::isatty(STDERR_FILENO) == 1),
      start_(Clock::now()),
      last_(start_) {}

Waiting::~Waiting() {
  if (shown_ && terminal_) std::fputc('\n', stderr);
}

void Waiting::update() {
  const Clock::time_point now = Clock::now();
  if (quiet_ || now - last_ < (terminal_ ? Clock::duration(kTerminalPeriod) : kPlainPeriod)) return;
  last_ = now;
  shown_ = true;
  const std::string text =
      fmt::format("{}  {}", label_, time_text(std::chrono::duration<double>(now - start_).count()));
  if (terminal_)
    fmt::print(stderr, "\r{}\033[K", text);
  else
    fmt::print(stderr, "{}\n", text);
  std::fflush(stderr);
}

void Progress::show(std::uint64_t done, Clock::time_point now) {
  last_ = now;
  shown_ = true;
  std::string text =
      line(label_, unit_, done, total_, std::chrono::duration<double>(now - start_).count());
  if (!note_.empty()) text += "  " + note_;
  if (!terminal_) {
    fmt::print(stderr, "{}\n", text);
    return;
  }
  const auto filled = total_ ? static_cast<std::size_t>(std::min(done, total_) * kBarWidth / total_)
                             : std::size_t{kBarWidth};
  fmt::print(stderr, "\r[{}{}] {}\033[K", std::string(filled, '#'),
             std::string(kBarWidth - filled, '.'), text);
  std::fflush(stderr);
}

}  // namespace deburr::tb
