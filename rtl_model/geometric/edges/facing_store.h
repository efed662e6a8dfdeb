// SPDX-License-Identifier: MIT
// Function  Stores the facing bits of a frame's faces, loaded in the begin phase. With select = all
//           nothing is loaded.
// Position  Next to the EdgeClassifier, which reads it.
// Stalls    `downstream` (requests), `memory` (responses are pending). A response is written in one
//           cycle, into 16 banks, so it never stalls the memory.
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/geometric/common/frame_configuration.h"
#include "rtl_model/geometric/common/memory_arbiter.h"
#include "rtl_model/geometric/common/tokens.h"
#include "spec/geometric/records.h"

namespace deburr::rtl::geometric {

class FacingStore final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  WireIn<Phase> phase_in{"phase_in"};
  WireOut<bool> loaded_out{"loaded_out"};
  MemoryClient memory;

  FacingStore(const sc_core::sc_module_name& name, ClockDomain& clock,
              const spec::geometric::Parameters& parameters);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Memory<std::uint32_t> words;

  Counter lines_read{"lines_read", "lines", "lines of facing bits read"};

  static Datasheet datasheet(const spec::geometric::Parameters& parameters = {});

 private:
  static constexpr std::size_t kWordsInLine = spec::geometric::kFacesInLine / 32;

  // A cycle with work to do.
  [[gnu::noinline]] Activity work(Cycle cycle);

  WritePort<std::uint32_t> write_{words, "responses"};
  Activity stalled_memory_;
  std::uint32_t asked_ = 0, answered_ = 0;  // U12, requested and received lines
};

}  // namespace deburr::rtl::geometric
