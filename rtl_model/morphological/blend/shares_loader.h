// SPDX-License-Identifier: MIT
// The registers that load the tables of learned shares: SHARES_ADDRESS, SHARES_DATA, SHARES_SUM.
//
// Where: between the registers and the LoadPort of the SharesRom; only in an engine that was built
// with learned shares. Timing: a word written to SHARES_DATA goes to the entry that SHARES_ADDRESS
// names, which counts on; no word is taken while a frame is inside (as any write). A reset keeps
// the tables. Source: ours (docs/reference/morphological/learned_shares.md).
#pragma once

#include <cstdint>

#include "rtl_model/fabric/control_registers.h"
#include "rtl_model/morphological/blend/shares_rom.h"

namespace deburr::rtl::morphological {

class SharesLoader {
 public:
  SharesLoader(ControlRegisters& registers, const SharesRom::LoadPort& tables);

 private:
  std::uint32_t address() const;
  void load(std::uint32_t value);

  ControlRegisters& registers_;
  SharesRom::LoadPort tables_;
};

}  // namespace deburr::rtl::morphological
