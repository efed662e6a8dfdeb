// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/runs/edge_rows.h"

#include <algorithm>
#include <bit>
#include <string>

#include "rtl_model/morphological/runs/port_schedule.h"
#include "spec/error.h"

namespace deburr::rtl::morphological {
namespace {

constexpr std::int32_t kWordShift = 6, kWordColumns = 1 << kWordShift;

std::int32_t most_steps(const spec::morphological::Parameters& p) {
  return std::min(spec::morphological::kMaxSteps, p.window_rows / 2 - 2);
}

std::int32_t words_of_a_row(const spec::morphological::Parameters& p) {
  return (p.line_pixels + kWordColumns - 1) / kWordColumns;
}

MemoryShape shape(const spec::morphological::Parameters& p) {
  const std::uint32_t words = EdgeRows::words_per_read(p);
  MemoryShape shape;
  shape.banks = std::bit_ceil(words);
  shape.words =
      std::max(static_cast<std::uint32_t>((most_steps(p) + 2) * words_of_a_row(p)), shape.banks);
  shape.word_bits = 2 * kWordColumns;
  shape.read_ports = static_cast<std::uint32_t>(PortSchedule(p).ports());
  shape.read_during_write = ReadDuringWrite::kForbidden;
  shape.span = words;
  shape.columns = static_cast<std::uint64_t>(p.line_pixels);
  shape.content = "left and top edges of every second row, 64 columns per word";
  return shape;
}

// Result of a read: words of a row and of the row above; nullptr if outside the frame.
struct StepEdges {
  const EdgeWord *row, *above;
  std::int32_t first, last;  // columns that were read
  std::int32_t width;

  static unsigned bit(std::uint64_t word, std::int32_t x) {
    return word >> static_cast<std::uint32_t>(x) % kWordColumns & 1;
  }
  std::size_t word(std::int32_t x) const {
    return static_cast<std::size_t>((x >> kWordShift) - (first >> kWordShift));
  }
  // Not inlined, to keep the check cheap.
  [[noreturn, gnu::cold, gnu::noinline]] static void fail(std::int32_t x) {
    throw spec::CheckFailed("edge_rows: the corner before column " + std::to_string(x) +
                            " was used but not read");
  }
  std::uint8_t code(std::int32_t x) const {
    if (x < 0 || x > width) return 0;
    if (x > last + (last == width - 1) || (x != 0 && x <= first)) [[unlikely]]
      fail(x);
    unsigned code = 0;
    if (row != nullptr && x > 0) code |= bit(row[word(x - 1)].top, x - 1);
    if (x == width) return static_cast<std::uint8_t>(code);
    if (row != nullptr) code |= bit(row[word(x)].top, x) << 1 | bit(row[word(x)].left, x) << 3;
    if (above != nullptr) code |= bit(above[word(x)].left, x) << 2;
    return static_cast<std::uint8_t>(code);
  }
  bool along(std::int32_t x) const {
    return row != nullptr && x >= 0 && x < width && bit(row[word(x)].top, x) != 0;
  }
  // Both corners have an edge in this row.
  bool unbroken(std::int32_t from, std::int32_t end) const {
    for (std::int32_t next; from < end; from = next) {
      next = std::min(end, ((from >> kWordShift) + 1) << kWordShift);
      const std::uint64_t mask = ~std::uint64_t{0} >> (kWordColumns - (next - from))
                                                          << from % kWordColumns;
      if (~row[word(from)].top & mask) return false;
    }
    return true;
  }
};

}  // namespace

std::uint32_t EdgeRows::words_per_read(const spec::morphological::Parameters& p) {
  std::int32_t columns = p.contiguous ? (p.search_columns + 1) / 2 + 2 : 4;
  if (p.area == spec::morphological::AreaSource::kLearned)
    columns = std::max((p.search_columns + 1) / 2 + 2, kMostLooks + 1);
  return static_cast<std::uint32_t>((columns + kWordColumns - 2) / kWordColumns + 1);
}

EdgeRows::EdgeRows(const spec::morphological::Parameters& p)
    : memory{{{"edge_rows_even", shape(p)}, {"edge_rows_odd", shape(p)}}},
      lanes_(built_lanes(p)),
      steps_(most_steps(p)),
      rows_(2 * most_steps(p) + 4),
      words_(words_of_a_row(p)),
      update_{{{memory[0], "extractor"}, {memory[1], "extractor"}}} {
  for (std::size_t parity = 0; parity < 2; ++parity)
    for (int i = 0; i < PortSchedule(p).ports(); ++i)
      steps_of_[parity].emplace_back(memory[parity], "predictors " + std::to_string(i));
}

// From the corner before the step to the one after its longest candidate, and to the last edge of
// its class.
inline void EdgeRows::find_columns(const FrameConfiguration& configuration, Trial& trial) const {
  const std::int32_t most = trial.tries ? std::min(trial.length + 1, trial.room) : 0;
  const std::int32_t least = configuration.contiguous || trial.classes ? 0 : trial.length - 1;
  const std::int32_t first = trial.to_the_right
                                 ? trial.at(least) - 1
                                 : std::min(trial.at(most) - 1, trial.at(trial.looks));
  const std::int32_t last =
      trial.to_the_right ? std::max(trial.at(most), trial.at(trial.looks) - 1) : trial.at(least);
  trial.first = std::max(first, 0);
  trial.last = std::min(last, configuration.width - 1);
}

void EdgeRows::read(Cycle cycle, const FrameConfiguration& configuration, std::size_t port,
                    Trial& trial) {
  find_columns(configuration, trial);
  if (trial.first > trial.last) return;  // outside the frame
  const auto words =
      static_cast<std::uint32_t>(trial.last / kWordColumns - trial.first / kWordColumns + 1);
  for (const std::int32_t y : {trial.line, trial.line - 1})
    if (in_frame(configuration, y))
      steps_of_[parity(y)][port].read(cycle, address(y, trial.first), words);
}

template <class Ask>
std::uint8_t EdgeRows::ask(Cycle cycle, const FrameConfiguration& configuration, std::size_t port,
                           const Trial& trial, Ask&& ask) const {
  if (trial.first > trial.last) return 0;
  const auto words_of = [&](std::int32_t y) {
    return in_frame(configuration, y)
               ? &steps_of_[parity(y)][port].at(cycle, address(y, trial.first))
               : nullptr;
  };
  return ask(StepEdges{words_of(trial.line), words_of(trial.line - 1), trial.first, trial.last,
                       configuration.width});
}

std::uint8_t EdgeRows::hits(Cycle cycle, const FrameConfiguration& configuration, std::size_t port,
                            const Trial& trial) const {
  return ask(cycle, configuration, port, trial, [&](const StepEdges& edges) {
    return hits_of(trial, edges, configuration.contiguous);
  });
}

std::uint8_t EdgeRows::crossing_class(Cycle cycle, const FrameConfiguration& configuration,
                                      std::size_t port, const Trial& trial) const {
  return ask(cycle, configuration, port, trial,
             [&](const StepEdges& edges) { return class_of(trial, edges); });
}

}  // namespace deburr::rtl::morphological
