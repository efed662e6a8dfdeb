// SPDX-License-Identifier: MIT
// An engine with everything that a run needs: memory, register host, golden model, scoreboards,
// faults, figures. A Simulation runs one environment; a composition of several is itself an
// environment (frame_composition.h).
//
// A single environment has no name. In a composition each environment has a name ("painter"), which
// is the prefix of its figures and faults: work.painter_fragments, --fault painter.flip-bit.
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

// Unit of a run's progress, for the progress display and the error of --max-cycles.
struct Amount {
  std::uint64_t delivered = 0, taken = 0, total = 0;
  std::string_view unit;  // "pixel"
};

class RegisterScoreboard;

// Compares counters with a second source: memory or the golden model.
class FigureScoreboard {
 public:
  void check(const std::string& name, std::uint64_t counted, std::uint64_t expected);
  // Checks a counter of this engine, unless the counter's unit is replaced by an RTL counterpart,
  // which does not count.
  void check(const rtl::Engine& engine, const rtl::Counter& counter, std::uint64_t expected);
  // Checks the requests of an engine to memory that no other client uses.
  void check(const rtl::Engine& engine, const rtl::MemoryPort& port,
             const platform::MemoryModel& memory);
  // Fault: every counter reads one too many.
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

  // ---- phases of a run, in the order in which Simulation calls them
  // After a reset: checks the identification registers and writes the registers that stay constant
  // during the run.
  virtual void configure() = 0;
  // Starts piece `piece` of the work, such as one of several frames; a piece ends before the next
  // one starts. Returns false if there are no more pieces.
  virtual bool begin(std::size_t piece) = 0;
  // Between cycles: checks everything recorded since the last call.
  virtual void watch() {}
  // Whether the piece is complete: all input was sent and nothing is in flight.
  virtual bool done() const = 0;
  // Called when a piece is done and its links are empty.
  virtual void end() = 0;
  // Called after configure() if a reset interrupted a piece. Starts the piece again; its earlier
  // output is discarded.
  virtual void restart() = 0;
  // Called when all pieces are done: checks counters.
  virtual void finish() = 0;
  // Throws SimulationError if memory answered with errors. Called after finish(), so their effects
  // on the output have been checked.
  virtual void reject_memory_errors() = 0;
  // Throws ConfigError if memory errors were configured for a range that was never accessed.
  virtual void reject_unused_errors() const = 0;
  virtual Amount amount() const = 0;
  // Whether memory has answered every request and completed every write.
  virtual bool memory_at_rest() const = 0;

  // ---- checking
  using Boards = std::vector<const ScoreboardBase*>;
  virtual Boards outputs() const = 0;   // pixels, colours
  virtual Boards traffic() const = 0;   // memory accesses
  virtual Boards counters() const = 0;  // the engine's own counters, which only echo earlier errors
  // If there is a golden model, throws Mismatch if a scoreboard found a difference or made fewer
  // comparisons than finish() requires.
  void check() const;

  // ---- results, available after an aborted run too

  // Adds units, memories, bytes and counters, prefixed by this environment's name.
  virtual void collect(Result& result) const = 0;
  // Shows the observer every observable part, under the name that the part has in collect().
  virtual void show_parts(Observer& observer) const = 0;
  // Per-pixel maps of the last frame; requires SimulationOptions::maps.
  virtual std::vector<PictureMap> maps() const = 0;
  // History of SimulationOptions::pixel in the last frame; empty if no part records one.
  virtual std::optional<PixelHistory> pixel_history() const { return std::nullopt; }
  // Functional coverage: every bin of the environment's engines, with its hits. Requires
  // SimulationOptions::coverage and a golden model.
  virtual Coverage coverage() const = 0;
  // Throughput, latency, headline figures and bottleneck; called for the main environment only.
  virtual void collect_headline(Result& result) const = 0;

 protected:
  Environment(Simulation& simulation, std::string name)
      : simulation_(simulation), name_(std::move(name)) {}

  Simulation& simulation() const { return simulation_; }
  // After a reset, runs until memory is idle. Otherwise a late write of an earlier request could
  // corrupt newly loaded data.
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
  // Declares memory_faults() and applies the range of `error_address`.
  void inject_in(platform::MemoryModel& memory, const MemoryParameters& parameters) const;
  // Declares the fault `blind-NAME` for each scoreboard of this run. With it the scoreboard skips
  // all comparisons, so the run must not pass.
  void let_blind(std::initializer_list<ScoreboardBase*> boards);
  // Declares the fault `miscount-NAME` for each register that is checked. With it the engine counts
  // one too many or too few.
  void let_miscount(RegisterScoreboard& board, std::span<const std::uint32_t> offsets);
  // Declares the fault `wrong-figures`. It adds one to every counter that is compared with a second
  // source.
  void let_miscount(FigureScoreboard& board);
  // Declares the fault `misdecode-REGISTER-FIELD` for each field of these registers. With it
  // hardware decodes a choice as the next one, a number as its half, and 0 as all ones; reads still
  // return the written value. `needs` says why these faults cannot be injected in this run.
  void let_misdecode(rtl::ControlRegisters& control, std::span<const std::uint32_t> offsets,
                     const std::string& needs);
  static void reject_untouched(const platform::MemoryModel& memory,
                               const MemoryParameters& parameters);

  const std::string& name() const { return name_; }

 private:
  Simulation& simulation_;
  std::string name_;
};

// Compares an engine's counters, read as a driver reads them, with those of the golden model.
class RegisterScoreboard {
 public:
  explicit RegisterScoreboard(std::span<const spec::RegisterInfo> table);
  void check(platform::RegisterBus& registers,
             std::span<const std::pair<std::uint32_t, std::uint64_t>> expected);
  // Fault: inverts the lowest bit when the register at this offset is read.
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

// FNV-1a hash over 64-bit words, for comparing runs whose outputs must be identical.
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
