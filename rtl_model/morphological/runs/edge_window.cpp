// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/runs/edge_window.h"

#include <algorithm>
#include <bit>
#include <string>

#include "rtl_model/morphological/runs/port_schedule.h"
#include "spec/error.h"

namespace deburr::rtl::morphological {
namespace {

// The two columns next to vertical lattice line `line`. The first column holds the same rows as the
// second (up to `newest`) or one more.
struct BesideLine {
  const EdgeWindow& window;
  std::int32_t line;
  bool border;  // the line is the frame's right border
  std::int32_t newest, rows;

  void check(std::int32_t y) const {
    const std::int32_t age = newest - y;
    if (age < 0 || age >= rows) [[unlikely]]
      fail(y);
  }
  // Not inlined, to keep the check cheap.
  [[noreturn, gnu::cold, gnu::noinline]] void fail(std::int32_t y) const {
    throw spec::CheckFailed("edge_window: row " + std::to_string(y) + " is not among the last " +
                            std::to_string(rows) + " rows, up to row " + std::to_string(newest));
  }
  std::uint8_t code(std::int32_t y) const {
    check(y);
    check(y - 1);
    const int first = int{window.top(line - 1, y)} << 2;
    if (border) return static_cast<std::uint8_t>(first);
    return static_cast<std::uint8_t>(int{window.left(line, y - 1)} |
                                     int{window.left(line, y)} << 1 | first |
                                     int{window.top(line, y)} << 3);
  }
  bool along(std::int32_t y) const {
    check(y);
    return !border && window.left(line, y);
  }
  bool unbroken(std::int32_t from, std::int32_t end) const {
    check(end - 1);
    check(from);
    if (border) return from == end;
    while (from < end && window.left(line, from)) ++from;
    return from == end;
  }
};

MemoryShape shape(const spec::morphological::Parameters& p, std::int32_t lanes) {
  MemoryShape shape;
  const auto columns = static_cast<std::uint32_t>(std::max(2, lanes));
  shape.words = std::max(static_cast<std::uint32_t>(p.line_pixels), columns);
  shape.columns = static_cast<std::uint64_t>(p.line_pixels);
  const bool crossings = p.ends == spec::morphological::Ends::kCrossings;
  shape.word_bits = static_cast<std::uint32_t>(2 * (p.window_rows + 1) + (crossings ? 1 : 0));
  shape.read_ports = static_cast<std::uint32_t>(1 + PortSchedule(p).ports());
  // Readers detect from the raster position whether a column was shifted.
  shape.read_during_write = ReadDuringWrite::kOldWord;
  shape.banks = shape.span = columns;
  shape.content = "left and top edges of window_rows + 1 rows, one word per column";
  return shape;
}

}  // namespace

EdgeWindow::EdgeWindow(const char* name, const spec::morphological::Parameters& p)
    : memory(name, shape(p, built_lanes(p))),
      lanes_(built_lanes(p)),
      rows_(p.window_rows + 1),
      lane_bits_(static_cast<std::uint32_t>(std::countr_zero(static_cast<std::uint32_t>(lanes_)))),
      row_mask_(std::bit_ceil(static_cast<std::uint32_t>(rows_)) - 1),
      row_beats_(static_cast<std::size_t>(p.line_pixels / lanes_) + 2),
      beat_(memory, "extractor"),
      update_(memory, "extractor"),
      bits_((row_mask_ + 1) * row_beats_),
      entries_(row_beats_ * static_cast<std::size_t>(lanes_)) {
  for (int i = 0; i < PortSchedule(p).ports(); ++i)
    lines_.emplace_back(memory, "predictors " + std::to_string(i));
}

void EdgeWindow::clear(std::int32_t beat) {
  for (std::int32_t y = 0; y <= static_cast<std::int32_t>(row_mask_); ++y)
    bits_[place(beat, y)] = {};
  for (std::int32_t lane = 0; lane < lanes_; ++lane) {
    const std::int32_t column = beat * lanes_ + lane;
    entries_[static_cast<std::size_t>(column)] = 0;
  }
}

void EdgeWindow::read(Cycle cycle, const FrameConfiguration& configuration, std::size_t port,
                      Trial& trial) {
  const std::int32_t first = std::max(trial.line - 1, 0);
  const std::int32_t last = std::min(trial.line, configuration.width - 1);
  lines_[port].read(cycle, at(first), static_cast<std::uint32_t>(last - first + 1));
}

std::uint8_t EdgeWindow::hits(Cycle cycle, const FrameConfiguration& configuration,
                              std::size_t port, const Trial& trial) const {
  const std::int32_t line = trial.line;
  lines_[port].check(cycle, at(std::max(line - 1, 0)));
  const BesideLine edges{*this, line, line == configuration.width, newest_row(line), rows_};
  return hits_of(trial, edges, configuration.contiguous);
}

std::uint8_t EdgeWindow::crossing_class(Cycle cycle, const FrameConfiguration& configuration,
                                        std::size_t port, const Trial& trial) const {
  const std::int32_t line = trial.line;
  lines_[port].check(cycle, at(std::max(line - 1, 0)));
  return class_of(trial,
                  BesideLine{*this, line, line == configuration.width, newest_row(line), rows_});
}

}  // namespace deburr::rtl::morphological
