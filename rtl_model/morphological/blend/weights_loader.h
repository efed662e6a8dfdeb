// SPDX-License-Identifier: MIT
// Registers that load the tables of learned weights: WEIGHTS_ADDRESS, WEIGHTS_DATA, WEIGHTS_SUM.
//
// Position  Between the registers and the LoadPort of WeightsRom; only with learned weights.
// Timing    A write to WEIGHTS_DATA goes to the entry in WEIGHTS_ADDRESS, which increments. As with
//           any register, writes are ignored while a frame is inside. Reset keeps the tables.
// Source    Ours (docs/reference/morphological/learned_weights.md).
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
