// SPDX-License-Identifier: MIT
// Function  Copies the whole frame before the resolve, as the original method does (frame_copy). At
//           most copy_lines are in flight; they are written in order.
// Position  Parallel to the edge pipeline.
// Stalls    `memory` (the next line has not arrived), `downstream`.
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
  // True if every line is copied, or no copy is needed.
  WireOut<bool> copied_out{"copied_out"};
  MemoryClient memory;

  FrameCopier(const sc_core::sc_module_name& name, ClockDomain& clock,
              const spec::geometric::Parameters& parameters);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter lines_copied{"lines_copied", "lines", "lines read and written"};

  static Datasheet datasheet(const spec::geometric::Parameters& parameters = {});

 private:
  // A cycle with work to do.
  [[gnu::noinline]] Activity work(Cycle cycle);

  FillStore<Line> buffer_;
  Activity stalled_memory_;
  std::uint32_t asked_ = 0, written_ = 0,
                answered_ = 0;  // U23, requested, written and answered lines
};

}  // namespace deburr::rtl::geometric
