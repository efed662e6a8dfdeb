// SPDX-License-Identifier: MIT
// Copies the whole frame before it is resolved, as the original method does (frame_copy).
//
// Where: beside the edges' pipe. copy_lines are on their way at most, and each is written in its
// turn. Stalls: `memory` (the next line has not come), `downstream`.
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/geometric/common/fill_store.h"
#include "rtl_model/geometric/common/frame_configuration.h"
#include "rtl_model/geometric/common/memory_arbiter.h"
#include "rtl_model/geometric/common/tokens.h"
#include "spec/geometric/parameters.h"

namespace deburr::rtl::geometric {

class FrameCopier final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  WireIn<Phase> phase_in{"phase_in"};
  // Every line is copied, or none is to be.
  WireOut<bool> copied_out{"copied_out"};
  MemoryClient memory;

  FrameCopier(const sc_core::sc_module_name& name, ClockDomain& clock,
              const spec::geometric::Parameters& parameters);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter lines_copied{"lines_copied", "lines", "lines read and written"};

  static Datasheet datasheet();

 private:
  // A clock in which there is something to do.
  [[gnu::noinline]] Activity work(Cycle cycle);

  FillStore<Line> buffer_;
  Activity stalled_memory_;
  std::uint32_t asked_ = 0, written_ = 0, answered_ = 0;  // U23, lines
};

}  // namespace deburr::rtl::geometric
