// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/runs/edge_window.h"

#include <algorithm>
#include <string>

#include "rtl_model/morphological/runs/port_schedule.h"
#include "spec/error.h"

namespace deburr::rtl::morphological {
namespace {

// The two columns beside vertical lattice line `line`, and their newest rows.
struct BesideLine {
  const EdgeColumn &before, &after;
  std::int32_t newest_before, newest_after, rows;

  std::int32_t age(std::int32_t newest, std::int32_t y) const {
    const std::int32_t age = newest - y;
    if (age < 0 || age >= rows) [[unlikely]]
      throw spec::CheckFailed("edge_window: row " + std::to_string(y) + " is not among the " +
                              std::to_string(rows) + " up to row " + std::to_string(newest));
    return age;
  }
  std::uint8_t code(std::int32_t y) const {
    const std::int32_t here = age(newest_after, y), above = age(newest_after, y - 1);
    return static_cast<std::uint8_t>(int{after.left[above]} | int{after.left[here]} << 1 |
                                     int{before.top[age(newest_before, y)]} << 2 |
                                     int{after.top[here]} << 3);
  }
  bool unbroken(std::int32_t from, std::int32_t end) const {
    return after.left.all(age(newest_after, end - 1), age(newest_after, from));
  }
};

MemoryShape shape(const spec::morphological::Parameters& p, std::int32_t lanes) {
  MemoryShape shape;
  const auto columns = static_cast<std::uint32_t>(std::max(2, lanes));
  shape.words = std::max(static_cast<std::uint32_t>(p.line_pixels), columns);
  shape.columns = static_cast<std::uint64_t>(p.line_pixels);
  shape.word_bits = static_cast<std::uint32_t>(2 * (p.window_rows + 1));
  shape.read_ports = static_cast<std::uint32_t>(1 + PortSchedule(p).ports());
  shape.read_during_write = ReadDuringWrite::kOldWord;
  shape.banks = shape.span = columns;
  shape.content = "left and top edges of window_rows + 1 rows, a word a column";
  return shape;
}

}  // namespace

EdgeWindow::EdgeWindow(const char* name, const spec::morphological::Parameters& p,
                       const ParameterStore& store)
    : memory(name, shape(p, store.lanes())),
      store_(store),
      lanes_(store.lanes()),
      rows_(p.window_rows + 1),
      beat_(memory, "extractor"),
      update_(memory, "extractor"),
      columns_(static_cast<std::size_t>(p.line_pixels) + 1) {
  for (int i = 0; i < PortSchedule(p).ports(); ++i)
    lines_.emplace_back(memory, "predictors " + std::to_string(i));
}

void EdgeWindow::read(Cycle cycle, std::size_t port, const Trial& trial) {
  const std::int32_t first = std::max(trial.line - 1, 0);
  const std::int32_t last = std::min(trial.line, store_.rules().width - 1);
  lines_[port].read(cycle, at(first), static_cast<std::uint32_t>(last - first + 1));
}

std::uint8_t EdgeWindow::hits(Cycle cycle, std::size_t port, const Trial& trial) const {
  static constexpr EdgeColumn kNoEdges;
  const std::int32_t line = trial.line;
  lines_[port].check(cycle, at(std::max(line - 1, 0)));
  const EdgeColumn* const column = &columns_[at(line)];
  const BesideLine edges{column[0], line == store_.rules().width ? kNoEdges : column[1],
                         newest_row(line - 1), newest_row(line), rows_};
  return hits_of(trial, edges, store_.rules().contiguous);
}

}  // namespace deburr::rtl::morphological
