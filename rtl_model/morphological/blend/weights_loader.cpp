// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/weights_loader.h"

#include "spec/morphological/registers.h"

namespace deburr::rtl::morphological {

namespace reg = spec::morphological::reg;

WeightsLoader::WeightsLoader(ControlRegisters& registers, const WeightsRom::LoadPort& tables)
    : registers_(registers), tables_(tables) {
  registers_.on_read(reg::kWeightsAddress, [this] { return address(); });
  registers_.on_read(reg::kWeightsData, [this] { return tables_.entry(address()); });
  registers_.on_read(reg::kWeightsSum, [this] { return tables_.sum(); });
  registers_.on_taken(reg::kWeightsData, [this](std::uint32_t value) { load(value); });
}

std::uint32_t WeightsLoader::address() const {
  return reg::weights_address::kEntry.of(registers_.value(reg::kWeightsAddress));
}

void WeightsLoader::load(std::uint32_t value) {
  const std::uint32_t entry = address();
  tables_.load(entry, static_cast<std::uint8_t>(value));
  registers_.set(reg::kWeightsAddress, reg::weights_address::kEntry.in(entry + 1));
}

}  // namespace deburr::rtl::morphological
