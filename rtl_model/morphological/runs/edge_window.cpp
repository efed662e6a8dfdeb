// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/runs/edge_window.h"

#include <algorithm>
#include <string>

#include "rtl_model/morphological/runs/port_schedule.h"
#include "spec/error.h"

namespace deburr::rtl::morphological {
namespace {

constexpr EdgeColumn kNoEdges;

// What a read of the two columns beside vertical lattice line `line` shows.
struct BesideLine {
  const EdgeColumn &before, &after;
  const std::array<std::int32_t, 2>& newest;
  std::int32_t rows;

  std::int32_t age(std::size_t side, std::int32_t y) const {
    const std::int32_t age = newest[side] - y;
    DEBURR_CHECK(age >= 0 && age < rows, "edge_window: row " + std::to_string(y) +
                                             " is not among the " + std::to_string(rows) +
                                             " up to row " + std::to_string(newest[side]));
    return age;
  }
  std::uint8_t code(std::int32_t y) const {
    const std::int32_t age_before = age(0, y), age_after = age(1, y);
    return static_cast<std::uint8_t>(int{after.left[age_after + 1]} |
                                     int{after.left[age_after]} << 1 |
                                     int{before.top[age_before]} << 2 |
                                     int{after.top[age_after]} << 3);
  }
  bool unbroken(std::int32_t from, std::int32_t end) const {
    return after.left.all(age(1, end - 1), age(1, from));
  }
};

MemoryShape shape(const spec::morphological::Parameters& p, std::int32_t lanes) {
  MemoryShape shape;
  const auto columns = static_cast<std::uint32_t>(std::max(2, lanes));
  shape.words = static_cast<std::uint64_t>(std::max(p.line_pixels, 2));
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
      update_(memory, "extractor") {
  for (int i = 0; i < PortSchedule(p).ports(); ++i)
    lines_.emplace_back(memory, "predictors " + std::to_string(i));
}

void EdgeWindow::write_beat(Cycle cycle, std::int32_t column, std::int32_t row,
                            std::span<const EdgeColumn> words) {
  update_.write(cycle, at(column), words);
  before_ = now_;
  now_ = {row, column + static_cast<std::int32_t>(words.size())};
  moved_ = cycle;
}

void EdgeWindow::read(Cycle cycle, std::size_t port, Trial& trial) {
  const std::int32_t width = store_.rules().width, line = trial.line;
  trial.newest = {newest_row(cycle, line - 1), newest_row(cycle, line)};
  const std::int32_t first = std::max(line - 1, 0), last = std::min(line, width - 1);
  lines_[port].read(cycle, at(first), static_cast<std::uint32_t>(last - first + 1));
}

std::uint8_t EdgeWindow::hits(Cycle cycle, std::size_t port, const Trial& trial) const {
  const std::int32_t width = store_.rules().width, line = trial.line;
  const EdgeColumn* const first = &lines_[port].at(cycle, at(std::max(line - 1, 0)));
  const EdgeColumn& before = line == 0 ? kNoEdges : *first;
  const EdgeColumn& after = line == width ? kNoEdges : line == 0 ? *first : first[1];
  return hits_of(trial, BesideLine{before, after, trial.newest, rows_}, store_.rules().contiguous);
}

}  // namespace deburr::rtl::morphological
