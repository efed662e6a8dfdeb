// SPDX-License-Identifier: MIT
// An engine with everything around it that makes a run: unit, memory, register host, golden model,
// scoreboards, faults, figures. A Simulation runs one; a composition of several is an environment
// again (frame_composition.h).
//
// An environment that stands alone has no name, and its figures and faults are called as they are.
// In a composition it has one ("painter"), which stands in front of them: work.painter_fragments,
// --fault painter.flip-bit.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rtl_model/fabric/control_registers.h"
#include "rtl_model/fabric/engine.h"
#include "rtl_model/platform/host.h"
#include "rtl_model/platform/memory_model.h"
#include "spec/registers.h"
#include "tb/base/fnv.h"
#include "tb/env/memory_parameters.h"
#include "tb/env/simulation.h"
#include "tb/harness/coverage.h"
#include "tb/harness/observer.h"
#include "tb/harness/scoreboard.h"
#include "tb/run/picture_map.h"
#include "tb/run/result.h"

namespace deburr::tb {

// What a run is counted in: for the progress shown and for the error of --max-cycles.
struct Amount {
  std::uint64_t delivered = 0, taken = 0, total = 0;
  std::string_view unit;  // "pixel"
};

class RegisterScoreboard;

// Figures of a run that have a second source: what a unit counted, against what memory or the
// golden model says.
class FigureScoreboard {
 public:
  void check(const std::string& name, std::uint64_t counted, std::uint64_t expected);
  // Of a counter of this engine, unless its unit is replaced and nobody counts for it.
  void check(const rtl::Engine& engine, const rtl::Counter& counter, std::uint64_t expected);
  // What it asked of memory that nobody else uses.
  void check(const rtl::Engine& engine, const rtl::MemoryPort& port,
             const platform::MemoryModel& memory);
  // A fault: each counter is one too large.
  void miscount() { too_many_ = 1; }
  ScoreboardBase& board() { return board_; }
  const ScoreboardBase& board() const { return board_; }

 private:
  using Figure = std::pair<std::string, std::uint64_t>;
  std::uint64_t checked_ = 0, too_many_ = 0;
  Scoreboard<Figure> board_{"figures", 1, [](const Figure& figure) {
                              return fmt::format("{} = {}", figure.first, figure.second);
                            }};
};

class Environment {
 public:
  virtual ~Environment() = default;
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

  // ---- the run, as Simulation leads it
  // After a reset: identification, and registers that stay for the whole run.
  virtual void configure() = 0;
  // Begins a piece of work (a frame of several) that is done before the next begins; false: there
  // are no more.
  virtual bool begin(std::size_t piece) = 0;
  // Between cycles: checks what has been recorded meanwhile.
  virtual void watch() {}
  // Everything of this piece was sent and nothing is inside any more.
  virtual bool done() const = 0;
  // A piece is done and its links are empty.
  virtual void end() = 0;
  // After a reset within a piece, and configure(): what came of it counts no more, it begins again.
  virtual void restart() = 0;
  // All pieces are done: counters are checked.
  virtual void finish() = 0;
  // SimulationError if memory answered with errors. After finish(), so that what they did to the
  // outputs has been checked.
  virtual void reject_memory_errors() = 0;
  // ConfigError if a range of memory was to answer with errors and nobody asked for it.
  virtual void reject_unused_errors() const = 0;
  virtual Amount amount() const = 0;
  // Memory has answered, and written, everything that it was asked.
  virtual bool memory_at_rest() const = 0;

  // ---- checking
  using Boards = std::vector<const ScoreboardBase*>;
  virtual Boards outputs() const = 0;   // pixels, colours
  virtual Boards traffic() const = 0;   // accesses of memory
  virtual Boards counters() const = 0;  // the engine's own, which echo what went wrong before
  // Throws Mismatch where the golden model ran and something differs, or a scoreboard compared less
  // than the run has: finish() says how much that is.
  void check() const;

  // ---- results, also of a run that was broken off
  // Units, memories, bytes and counters, with this environment's name in front.
  virtual void collect(Result& result) const = 0;
  // Every part that a run can be watched by, under the names of collect().
  virtual void show_parts(Observer& observer) const = 0;
  // What was done for each pixel, with SimulationOptions::maps; of the last frame.
  virtual std::vector<PictureMap> maps() const = 0;
  // What happened to SimulationOptions::pixel, of the last frame; nothing: no part of it keeps
  // that.
  virtual std::optional<PixelHistory> pixel_history() const { return std::nullopt; }
  // Functional coverage: every bin of its engines, with what was met so far. With
  // SimulationOptions::coverage and a golden model.
  virtual Coverage coverage() const = 0;
  // Throughput, latency, figures and bottleneck: of the one environment that the run is about.
  virtual void collect_headline(Result& result) const = 0;

 protected:
  Environment(Simulation& simulation, std::string name)
      : simulation_(simulation), name_(std::move(name)) {}

  Simulation& simulation() const { return simulation_; }
  // After a reset, runs until memory is at rest: a write of before that came later would spoil what
  // is loaded next.
  void drain_memory() const;
  bool golden() const { return simulation_.options().golden; }
  bool programs() const { return simulation_.options().program; }

  // ---- faults
  void know(std::vector<InjectedFault> faults) {
    simulation_.faults().know(name_, std::move(faults));
  }
  bool injected(std::string_view fault) const {
    return simulation_.faults().injected(name_, fault);
  }
  // memory_faults(), and the range of `error_address`.
  void inject_in(platform::MemoryModel& memory, const MemoryParameters& parameters) const;
  // `blind-NAME` for each scoreboard of this run: it compares nothing, which is no pass.
  void let_blind(std::initializer_list<ScoreboardBase*> boards);
  // `miscount-NAME` for each register that is checked: the engine counted one too many or too few.
  void let_miscount(RegisterScoreboard& board, std::span<const std::uint32_t> offsets);
  // `wrong-figures`: all counters that are checked a second time are one too large.
  void let_miscount(FigureScoreboard& board);
  // `misdecode-REGISTER-FIELD` for each field of these registers: of what software writes there the
  // hardware takes a choice for the next one, a number for its half, and 0 for all ones. It reads
  // back as it was written. `needs`: why none can be injected in this run.
  void let_misdecode(rtl::ControlRegisters& control, std::span<const std::uint32_t> offsets,
                     const std::string& needs);
  static void reject_untouched(const platform::MemoryModel& memory,
                               const MemoryParameters& parameters);

  const std::string& name() const { return name_; }

 private:
  Simulation& simulation_;
  std::string name_;
};

// An engine's counters, read as a driver would, against the golden model's.
class RegisterScoreboard {
 public:
  explicit RegisterScoreboard(std::span<const spec::RegisterInfo> table);
  void check(platform::RegisterBus& registers,
             std::span<const std::pair<std::uint32_t, std::uint64_t>> expected);
  // A fault: the register of this offset reads wrong by its lowest bit.
  void misread(std::uint32_t offset) { misread_ = offset; }
  std::string_view name_of(std::uint32_t offset) const;
  ScoreboardBase& board() { return board_; }
  const ScoreboardBase& board() const { return board_; }

 private:
  struct Status {
    std::uint32_t offset, value;
    friend bool operator==(const Status&, const Status&) = default;
  };
  std::span<const spec::RegisterInfo> table_;
  std::optional<std::uint32_t> misread_;
  Scoreboard<Status> board_;
};

// To compare runs that must not differ: FNV-1a of words, mixed after each.
class OutputHash {
 public:
  void add(std::uint64_t value) {
    hash_ = fnv_step(hash_, value);
    hash_ ^= hash_ >> 29;
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = kFnvStart;
};

}  // namespace deburr::tb
