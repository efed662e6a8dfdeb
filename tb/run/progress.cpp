// SPDX-License-Identifier: MIT
#include "tb/run/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "tb/base/terminal.h"
#include "tb/run/amount.h"

namespace deburr::tb {
namespace {

constexpr auto kTerminalPeriod = std::chrono::milliseconds(100);
constexpr auto kPlainPeriod = std::chrono::seconds(5);
constexpr std::size_t kLeastBar = 8, kMostBar = 24;

std::string rate_text(double rate, std::string_view unit) {
  if (rate >= 1e6) return fmt::format("{:.2f} M{}/s", rate / 1e6, unit);
  if (rate >= 1e3) return fmt::format("{:.1f} k{}/s", rate / 1e3, unit);
  if (rate <= 0) return "";
  if (rate < 1) return fmt::format("{:.{}f} s/{}", 1 / rate, rate > 0.1 ? 1 : 0, unit);
  return fmt::format("{:.0f} {}/s", rate, unit);
}

std::string time_text(double seconds) {
  const auto whole = std::llround(seconds);
  if (whole >= 3600) return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
  if (whole >= 60) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} s", whole);
}

// Each character takes one column, as labels are names.
bool begins_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }
std::string cut(std::string_view text, std::size_t columns) {
  std::size_t end = 0;
  for (std::size_t shown = 0; end < text.size(); ++end)
    if (begins_character(text[end]) && shown++ == columns) break;
  return std::string(text.substr(0, end));
}

// Parts of the line; empty ones are omitted.
struct Parts {
  std::string start, rate, left;
};
Parts parts_of(std::string_view label, std::string_view unit, std::uint64_t done,
               std::uint64_t total, double seconds, double idle) {
  const double fraction =
      total ? std::min(1.0, static_cast<double>(done) / static_cast<double>(total)) : 1.0;
  const double active = seconds - idle;
  const double rate = active > 0 ? static_cast<double>(done) / active : 0;
  Parts parts{fmt::format("{}  {:3.0f} %", label, std::floor(fraction * 100)),
              rate_text(rate, unit), ""};
  if (rate > 0 && done < total)
    if (const double left = static_cast<double>(total - done) / rate - idle; left > 0)
      parts.left = fmt::format("{} left", time_text(left));
  return parts;
}

std::string joined(std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const std::string_view part : parts)
    if (!part.empty()) text += (text.empty() ? "" : "  ") + std::string(part);
  return text;
}

// A failed write is ignored: the terminal may have gone, and progress output must not fail a run.
void tell(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

// The last column stays free, because some terminals start a new line once it is filled.
std::size_t room() { return std::max<std::size_t>(terminal_columns(STDERR_FILENO), 2) - 1; }

}  // namespace

std::string out_of_cycles(std::uint64_t cycles, std::uint64_t done, std::uint64_t total,
                          std::string_view unit) {
  return fmt::format(
      "not done after {} cycles, the limit of --max-cycles (run.max_cycles): {} of {} {}s are "
      "done; raise the limit, or set it to 0 for none",
      grouped(cycles), grouped(done), grouped(total), unit);
}

std::string Progress::line(std::string_view label, std::string_view unit, std::uint64_t done,
                           std::uint64_t total, double seconds, double idle) {
  const Parts parts = parts_of(label, unit, done, total, seconds, idle);
  return joined({parts.start, parts.rate, parts.left});
}

std::string Progress::fitted(std::size_t columns, std::string_view label, std::string_view unit,
                             std::uint64_t done, std::uint64_t total, double seconds,
                             std::string_view note, double idle) {
  const Parts parts = parts_of(label, unit, done, total, seconds, idle);
  const std::string whole = joined({parts.start, parts.rate, parts.left, note});
  constexpr std::size_t kFrame = 3;  // "[] "
  if (const std::size_t used = columns_of(whole) + kFrame; used + kLeastBar <= columns) {
    const std::size_t width = std::min(kMostBar, columns - used);
    const auto filled =
        total ? static_cast<std::size_t>(std::min(done, total) * width / total) : width;
    return fmt::format("[{}{}] {}", std::string(filled, '#'), std::string(width - filled, '.'),
                       whole);
  }
  for (const std::string& text :
       {whole, joined({parts.start, parts.left, note}), joined({parts.start, note}),
        joined({parts.start, parts.rate, parts.left}), joined({parts.start, parts.left})})
    if (columns_of(text) <= columns) return text;
  return cut(parts.start, columns);
}

Progress::Progress(std::string_view label, std::uint64_t total, std::string_view unit, bool quiet)
    : label_(label),
      unit_(unit),
      total_(total),
      quiet_(quiet),
      terminal_(takes_control_sequences(STDERR_FILENO)),
      start_(Clock::now()),
      last_(start_),
      grown_(start_) {}

Progress::~Progress() {
  if (shown_ && terminal_) {
    show(done_, Clock::now());
    std::fputc('\n', stderr);
  }
}

void Progress::update(std::uint64_t delivered, std::uint64_t taken) {
  if (quiet_) return;
  const Clock::time_point now = Clock::now();
  if (const std::uint64_t known = done_; (done_ = done(delivered, taken)) != known) grown_ = now;
  if (now - last_ < (terminal_ ? Clock::duration(kTerminalPeriod) : kPlainPeriod)) return;
  show(done_, now);
}

Waiting::Waiting(std::string label, bool quiet)
    : label_(std::move(label)),
      quiet_(quiet),
      terminal_(takes_control_sequences(STDERR_FILENO)),
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
  tell(terminal_ ? fmt::format("\r{}\033[K", cut(text, room())) : text + "\n");
}

void Progress::show(std::uint64_t done, Clock::time_point now) {
  last_ = now;
  shown_ = true;
  const double seconds = std::chrono::duration<double>(now - start_).count(),
               idle = std::chrono::duration<double>(now - grown_).count();
  tell(terminal_ ? fmt::format("\r{}\033[K",
                               fitted(room(), label_, unit_, done, total_, seconds, note_, idle))
                 : joined({line(label_, unit_, done, total_, seconds, idle), note_}) + "\n");
}

}  // namespace deburr::tb
