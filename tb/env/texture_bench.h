// SPDX-License-Identifier: MIT
// One simulation of the texture unit on a scene: clock, unit, memory, driver, sink, golden model
// and scoreboards. `deburr run texture` and the tests in tb/system use the same bench.
//
//   TextureScene ─► Driver ─► TextureUnit ─► Sink ─► scoreboard, frame
//                     │        │      └ registers ◄─ RegisterHost
//                     ▼      MemoryModel ─► scoreboard of line fills
//                   golden model (expected colours, expected fills)
//
// The golden model gets each quad when the driver sends it, so the comparison needs no more memory
// than what is in flight, and every output is judged as it comes.
#pragma once

#include <tlm_utils/simple_initiator_socket.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <systemc>
#include <vector>

#include "golden/texture/texture_golden.h"
#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/texture/texture_unit.h"
#include "spec/texture/packets.h"
#include "spec/texture/parameters.h"
#include "tb/env/memory_parameters.h"
#include "tb/env/simulation.h"
#include "tb/env/texture_scene.h"
#include "tb/harness/bench.h"
#include "tb/harness/driver.h"
#include "tb/harness/register_host.h"
#include "tb/harness/scoreboard.h"
#include "tb/results/result.h"
#include "tb/scene/rasteriser.h"

namespace deburr::tb {

struct TextureBenchOptions : SimulationOptions {
  spec::texture::Parameters texture;
  MemoryParameters memory;
};

// A fault by name, for `--fault`; docs/verification.md says what must catch it.
struct PlantedFault {
  std::string_view name, meaning;
};
std::span<const PlantedFault> planted_faults();

class TextureBench {
 public:
  // Called every few thousand cycles with the numbers of colours delivered and of fragments taken;
  // false ends the run early.
  using Progress = std::function<bool(std::uint64_t colours, std::uint64_t taken)>;

  // Elaborates; one a process. The scene must outlive the bench. ConfigError for wrong parameters.
  TextureBench(const TextureScene& scene, const TextureBenchOptions& options);
  ~TextureBench();

  // Resets, writes descriptors over the register socket, sends every quad and waits for the last
  // colour. Does not throw on mismatches: see check(). SimulationError for memory errors and broken
  // protocols, DeadlockError for no progress, OutOfCycles for max_cycles.
  void run(const Progress& progress = {});
  // Throws Mismatch when a colour, a fill or a status register differs from the golden model.
  void check() const;

  // Everything measured so far, also after an exception from run().
  void collect(Result& result) const;

  rtl::Cycle cycles() const { return cycles_; }
  std::uint64_t activations() const { return clock_.activations(); }
  bool complete() const { return complete_; }  // false when ended early
  const Image& frame() const { return frame_.frame(); }
  // The golden model's picture of the same fragments (empty without golden).
  const Image& golden_frame() const { return golden_frame_.frame(); }
  const golden::texture::TextureWork& golden_work() const { return golden_.work(); }
  std::uint64_t colours() const { return sink_.received(); }
  // A hash over all colours and tags in order, to compare runs that must not differ.
  std::uint64_t colour_hash() const { return colour_hash_; }

  rtl::ClockDomain& clock() { return clock_; }
  rtl::texture::TextureUnit& unit() { return unit_; }
  MemoryModel& memory() { return memory_; }

  RegisterHost& host() { return host_; }

 private:
  struct Fill {
    std::uint64_t address;
    friend bool operator==(const Fill&, const Fill&) = default;
  };
  struct Status {
    std::uint32_t offset, value;
    friend bool operator==(const Status&, const Status&) = default;
  };
  // For the fault of a fetch that nobody ordered.
  struct Stranger : sc_core::sc_module {
    explicit Stranger(const sc_core::sc_module_name& name) : sc_module(name) {}
    tlm_utils::simple_initiator_socket<Stranger> memory{"memory"};
  };

  void prepare_golden();
  void expect(const spec::texture::Quad& quad);
  void judge(rtl::Cycle cycle, const spec::texture::Colour& colour);
  void judge_fills();
  void fetch_again();
  void judge_registers();
  void check_memory_errors();
  std::string describe(const spec::texture::Colour& colour) const;

  const TextureScene& scene_;
  TextureBenchOptions options_;
  rtl::ClockDomain clock_;
  rtl::Link<spec::texture::Quad> quads_{"quads"};
  rtl::Link<spec::texture::Colour> colours_{"colours"};
  Driver<spec::texture::Quad> driver_;
  rtl::texture::TextureUnit unit_;
  Sink<spec::texture::Colour> sink_;
  MemoryModel memory_;
  RegisterHost host_;
  Stranger stranger_;
  std::unique_ptr<Bench> bench_;

  golden::texture::TextureGolden golden_;
  Scoreboard<spec::texture::Colour> colour_board_;
  Scoreboard<Fill> fill_board_;
  Scoreboard<Status> register_board_;
  FrameAssembler frame_, golden_frame_;
  std::size_t fills_judged_ = 0;
  std::uint64_t colour_hash_ = 0xCBF29CE484222325ULL;
  rtl::Cycle cycles_ = 0, started_ = 0;
  double host_seconds_ = 0, cpu_seconds_ = 0;
  bool running_ = false, complete_ = false, fetch_again_ = false;
};

}  // namespace deburr::tb
