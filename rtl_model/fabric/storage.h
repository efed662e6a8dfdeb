// SPDX-License-Identifier: MIT
// What every memory inside a unit reports: words, bits a word, ports. The sum is the model's SRAM
// bits.
#pragma once

#include <cstdint>
#include <string>
#include <systemc>

namespace deburr::rtl {

class Storage : public sc_core::sc_object {
 public:
  const char* kind() const override { return "deburr_storage"; }
  std::uint64_t words() const { return words_; }
  std::uint32_t word_bits() const { return word_bits_; }
  std::uint64_t bits() const { return words_ * word_bits_; }
  const std::string& ports() const { return ports_; }  // "1R1W", "2RW", ...
  virtual void reset() = 0;

 protected:
  Storage(const char* name, std::uint64_t words, std::uint32_t word_bits, std::string ports);
  // A name for a part: "<own name>_<suffix>", since a storage is no module and has no children.
  std::string inner_name(const char* suffix) const;

 private:
  std::uint64_t words_;
  std::uint32_t word_bits_;
  std::string ports_;
};

}  // namespace deburr::rtl
