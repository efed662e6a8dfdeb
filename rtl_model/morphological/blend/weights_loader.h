// SPDX-License-Identifier: MIT
// The registers that load the tables of learned weights: WEIGHTS_ADDRESS, WEIGHTS_DATA,
// WEIGHTS_SUM.
//
// Where: between the registers and the LoadPort of the WeightsRom; only in an engine that was built
// with learned weights. Timing: a word written to WEIGHTS_DATA goes to the entry that
// WEIGHTS_ADDRESS names, which counts on; no word is taken while a frame is inside (as any write).
// A reset keeps the tables. Source: ours (docs/reference/morphological/learned_weights.md).
#pragma once

#include <cstdint>

#include "rtl_model/fabric/control_registers.h"
#include "rtl_model/morphological/blend/weights_rom.h"

namespace deburr::rtl::morphological {

class WeightsLoader {
 public:
  WeightsLoader(ControlRegisters& registers, const WeightsRom::LoadPort& tables);

 private:
  std::uint32_t address() const;
  void load(std::uint32_t value);

  ControlRegisters& registers_;
  WeightsRom::LoadPort tables_;
};

}  // namespace deburr::rtl::morphological
