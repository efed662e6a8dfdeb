// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/shares_loader.h"

#include "spec/morphological/registers.h"

namespace deburr::rtl::morphological {

namespace reg = spec::morphological::reg;

SharesLoader::SharesLoader(ControlRegisters& registers, const SharesRom::LoadPort& tables)
    : registers_(registers), tables_(tables) {
  registers_.on_read(reg::kSharesAddress, [this] { return address(); });
  registers_.on_read(reg::kSharesData, [this] { return tables_.entry(address()); });
  registers_.on_read(reg::kSharesSum, [this] { return tables_.sum(); });
  registers_.on_taken(reg::kSharesData, [this](std::uint32_t value) { load(value); });
}

std::uint32_t SharesLoader::address() const {
  return reg::shares_address::kEntry.of(registers_.value(reg::kSharesAddress));
}

void SharesLoader::load(std::uint32_t value) {
  const std::uint32_t entry = address();
  tables_.load(entry, static_cast<std::uint8_t>(value));
  registers_.set(reg::kSharesAddress, reg::shares_address::kEntry.in(entry + 1));
}

}  // namespace deburr::rtl::morphological
