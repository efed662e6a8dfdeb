// SPDX-License-Identifier: MIT
#include "rtl_model/fabric/storage.h"

#include <fmt/format.h>

#include <utility>

#include "spec/error.h"

namespace deburr::rtl {

Storage::Storage(const char* name, std::uint64_t words, std::uint32_t word_bits, std::string ports)
    : sc_object(name), words_(words), word_bits_(word_bits), ports_(std::move(ports)) {
  DEBURR_CHECK(words > 0 && word_bits > 0,
               fmt::format("{}: {} words of {} bits", this->name(), words, word_bits));
}

std::string Storage::inner_name(const char* suffix) const {
  return fmt::format("{}_{}", basename(), suffix);
}

}  // namespace deburr::rtl
