// SPDX-License-Identifier: MIT
// Sends one missed line per cycle to memory, in order of the misses, and collects the lines in the
// fill buffer.
//
// Position  TagStage -> MissQueue -> MemoryPort. A fill-buffer entry is held from issue until the
//           DataStage has used the line; the queue has the same number of entries.
// Stalls    fill_buffer_full  All entries are held.
//           downstream        The memory port is not ready.
//           wait_memory       Lines are in flight or held, and there is nothing else to do.
// Blocks    With `decode = before` a BlockFetcher is between this unit and the MemoryPort: the
//           address of a request is a line number, and no response has an error.
// Errors    A line answered with an error reads as zero, is counted and sets a sticky status bit.
// Source    Igehy et al., 1998.
#pragma once

#include <algorithm>
#include <cstdint>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/control_registers.h"
#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/memory_cycles.h"
#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/fill_buffer.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class MissQueue final : public Unit {
 public:
  In<MissToken> misses_in{"misses_in"};
  Out<MemoryRequest> requests_out{"requests_out"};
  In<MemoryResponse> responses_in{"responses_in"};

  MissQueue(const sc_core::sc_module_name& name, ClockDomain& clock,
            const spec::texture::Parameters& parameters, ControlRegisters& registers);
  Activity tick(Cycle cycle) override;
  void reset() override;

  FillBuffer fills;

  Counter line_fills{"line_fills", "lines", "lines that the cache requested"};
  Counter fill_bytes{"fill_bytes", "bytes", "bytes of the lines requested"};
  Counter memory_errors{"memory_errors", "lines", "line fills answered with an error"};
  Counter max_waiting{"max_waiting", "lines", "largest number of lines waiting to be requested"};

  // Configured number of entries; for 0 those that cover the latency of memory.
  static constexpr std::int32_t entries(const spec::texture::Build& build,
                                        const MemoryCycles& memory) {
    if (build.cache_outstanding != 0) return build.cache_outstanding;
    // A fill takes 12 cycles outside of memory; 32 entries per request and 112 cycles.
    constexpr std::int32_t kEntries = 32, kOutside = 12, kCycles = 112, kMultiple = 4, kLeast = 8;
    const std::int32_t entries =
        (kEntries * build.width * (memory.latency + kOutside) + kCycles * kMultiple - 1) /
        (kCycles * kMultiple) * kMultiple;
    return std::clamp(entries, kLeast, spec::texture::kMostOutstanding);
  }

  static Datasheet datasheet(const spec::texture::Parameters& parameters = {});

 private:
  [[gnu::noinline]] Activity work(Cycle cycle);
  bool receive(Cycle cycle);
  Activity issue(Cycle cycle);
  bool accept(Cycle cycle);

  ControlRegisters& registers_;
  std::uint32_t line_bytes_;
  std::uint32_t address_unit_;   // `decode = before`: addresses are line numbers
  Memory<std::uint32_t> lines_;  // line numbers in a ring buffer
  ReadPort<std::uint32_t> next_line_{lines_, "issue"};
  std::vector<WritePort<std::uint32_t>> new_lines_;
  std::uint32_t head_ = 0, waiting_ = 0;  // U8, oldest line and number of lines
  Memory<std::uint8_t> failed_;
  ReadPort<std::uint8_t> had_error_{failed_, "responses"};
  WritePort<std::uint8_t> has_error_{failed_, "responses"};
  Activity fill_buffer_full_, wait_memory_;
};

}  // namespace deburr::rtl::texture
