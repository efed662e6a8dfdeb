// SPDX-License-Identifier: MIT
// Runs the texture unit on arbitrary quads and descriptors against its golden model: colours, line
// fills and status registers. In contrast to TextureEnvironment, input need not come from a
// picture, and the unit can be reset in mid-run.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <systemc>
#include <utility>
#include <vector>

#include "golden/texture/texture_golden.h"
#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/platform/memory_model.h"
#include "rtl_model/platform/register_host.h"
#include "rtl_model/platform/texture_memory.h"
#include "rtl_model/texture/texture_unit.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/packets.h"
#include "spec/texture/parameters.h"
#include "spec/texture/registers.h"
#include "tb/harness/bench.h"
#include "tb/harness/driver.h"

namespace deburr::tb {

struct QuadInput {
  std::vector<spec::texture::Descriptor> textures;  // by handle, at most 16
  std::vector<std::uint8_t> memory;                 // from address 0, a multiple of 128 bytes
  std::vector<spec::texture::Quad> quads;
};

// Results of a run.
struct QuadOutcome {
  std::vector<spec::texture::Colour> colours;
  std::vector<std::uint64_t> fills;     // addresses in the order seen by memory
  std::vector<std::uint64_t> counters;  // of every block
  rtl::Cycle cycles = 0;
  friend bool operator==(const QuadOutcome&, const QuadOutcome&) = default;
};

class QuadBench {
 public:
  // One instance per process. `input` goes to the hardware and must outlive the bench.
  QuadBench(const QuadInput& input, const spec::texture::Parameters& parameters,
            platform::MemoryModelParameters memory = {}, const BenchOptions& options = {},
            const rtl::texture::TextureUnit::StandIns& stand_ins = {})
      : input_(input),
        colours_("colours", 2, rtl::texture::colours_shape(parameters)),
        unit_("texture", clock_, parameters, memory_cycles(memory), stand_ins),
        memory_("memory", clock_.period(), sized(memory, input)),
        parameters_(parameters) {
    driver_.beats_out(quads_);
    unit_.quads_in(quads_);
    unit_.colours_out(colours_);
    sink_.beats_in(colours_);
    unit_.memory()->bind(memory_.ports);
    host_.bus.bind(unit_.registers);
    bench_ = std::make_unique<Bench>(clock_, options);
    memory_.preload(0, input.memory);
    driver_.send(input.quads);
  }

  // Resets for `cycles` and writes the descriptors. Only memory responses in flight remain from an
  // earlier run; the unit must ignore them.
  void reset(rtl::Cycle cycles = 4) {
    clock_.set_reset_n(false);
    clock_.run(cycles);
    clock_.set_reset_n(true);
    memory_.clear_statistics();
    for (std::size_t h = 0; h < input_.textures.size(); ++h)
      for (const auto& [offset, value] :
           platform::descriptor_registers(static_cast<int>(h), input_.textures[h]))
        host_.write(offset, value);
  }
  // Sends the same quads again, without a reset.
  void repeat() { driver_.send(input_.quads); }
  // Runs the first `cycles` cycles.
  void run_for(rtl::Cycle cycles) { clock_.run(cycles); }
  // Sets the expected parameters, which may differ from those built.
  void order(const spec::texture::Parameters& parameters) { parameters_ = parameters; }
  std::uint64_t received() const { return sink_.received(); }
  // Runs to the end. Throws DeadlockError, or the protocol error of a link.
  QuadOutcome run(rtl::Cycle limit = 50'000'000) {
    QuadOutcome outcome;
    outcome.cycles = bench_->run(
        [&] { return driver_.done() && unit_.idle() && quads_.empty() && colours_.empty(); },
        limit);
    for (const spec::texture::ColourGroup& group : sink_.beats())
      outcome.colours.insert(outcome.colours.end(), group.begin(), group.end());
    outcome.fills = memory_.lines_read();
    for (const rtl::Counter* counter : unit_.counters())
      outcome.counters.push_back(counter->value());
    return outcome;
  }

  // Checks the last run with a golden model whose input is `reference`. Returns one line per kind
  // of difference; empty if all is equal. Also returns the amount of work.
  std::string check(const QuadInput& reference, const QuadOutcome& outcome,
                    golden::texture::TextureWork* work = nullptr) {
    golden::texture::TextureGolden golden(parameters_, reference.memory);
    for (std::size_t h = 0; h < reference.textures.size(); ++h)
      golden.set_texture(static_cast<int>(h), reference.textures[h]);
    std::vector<std::uint64_t> fills;
    const std::uint64_t line_bytes = golden.cache().line_bytes();
    golden.set_fill_sink([&](std::uint32_t line) {  // memory records 64 bytes at a time
      for (std::uint64_t at = 0; at < line_bytes; at += 64) fills.push_back(line * line_bytes + at);
    });
    std::string differences;
    std::size_t next = 0;
    for (const spec::texture::Quad& quad : reference.quads)
      for (const spec::texture::Colour& colour : golden.process(quad)) {
        const bool equal = next < outcome.colours.size() && outcome.colours[next] == colour;
        if (!equal && differences.empty())
          differences += "colour " + std::to_string(next) + " of quad " + std::to_string(quad.tag) +
                         ", texture " + std::to_string(quad.texture) + "\n";
        ++next;
      }
    if (next != outcome.colours.size())
      differences += std::to_string(outcome.colours.size()) + " colours, expected " +
                     std::to_string(next) + "\n";
    if (fills != outcome.fills) differences += "line fills\n";
    differences += check_registers(golden.work());
    if (work) *work = golden.work();
    return differences;
  }

  rtl::texture::TextureUnit& unit() { return unit_; }

  static rtl::MemoryCycles memory_cycles(const platform::MemoryModelParameters& memory) {
    return {static_cast<std::int32_t>(std::max(memory.latency_min, memory.latency_max)), 1};
  }

 private:
  static platform::MemoryModelParameters sized(platform::MemoryModelParameters memory,
                                               const QuadInput& input) {
    memory.bytes = input.memory.size();
    return memory;
  }

  std::string check_registers(const golden::texture::TextureWork& work) {
    namespace reg = spec::texture::reg;
    const std::uint64_t status = reg::kStatusIdle |
                                 (work.memory_errors ? reg::kStatusMemoryError : 0u) |
                                 (work.invalid_fragments ? reg::kStatusInvalidTexture : 0u);
    const std::pair<std::uint32_t, std::uint64_t> expected[] = {
        {reg::kStatus, status},
        {reg::kFragments, work.fragments},
        {reg::kBilinears, work.bilinears},
        {reg::kLineFills, work.line_fills},
        {reg::kClamped, work.clamped},
        {reg::kSaturated, work.saturated},
        {reg::kMemoryErrors, work.memory_errors},
        {reg::kInvalidFragments, work.invalid_fragments}};
    std::string differences;
    for (const auto& [offset, value] : expected)
      if (const std::uint32_t got = host_.read(offset); got != value)
        differences += "register " + std::to_string(offset) + " is " + std::to_string(got) +
                       ", expected " + std::to_string(value) + "\n";
    return differences;
  }

  const QuadInput& input_;
  rtl::ClockDomain clock_{"clock", sc_core::sc_time(6, sc_core::SC_NS)};
  rtl::Link<spec::texture::Quad> quads_{"quads"};
  rtl::Link<spec::texture::ColourGroup> colours_;
  Driver<spec::texture::Quad> driver_{"driver", clock_};
  rtl::texture::TextureUnit unit_;
  Sink<spec::texture::ColourGroup> sink_{"sink", clock_};
  platform::MemoryModel memory_;
  platform::RegisterHost host_{"host"};
  spec::texture::Parameters parameters_;
  std::unique_ptr<Bench> bench_;
};

}  // namespace deburr::tb
