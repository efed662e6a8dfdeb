// SPDX-License-Identifier: MIT
// The four data banks of the texture cache.
//
// Where: inside the DataStage. A bank gives one texel a clock, and takes its quarter of a line in
// the same clock (read-first: a read sees what was there before). Which texel lies in which bank is
// given by the parity of its coordinates, so that a 2 x 2 footprint touches each bank once.
// Hardware spreads a line over the banks when it is written; the model keeps the bytes of a line
// together and counts the ports by the bank that each access names. Cost: 4 x (lines x quarter
// line) bits, 1R1W.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/clocked.h"
#include "rtl_model/fabric/storage.h"
#include "spec/error.h"

namespace deburr::rtl::texture {

class DataBanks {
 public:
  DataBanks(std::uint32_t lines, std::uint32_t line_bytes)
      : line_bytes_(line_bytes),
        banks_{Bank{"bank_0", lines, line_bytes * 2}, Bank{"bank_1", lines, line_bytes * 2},
               Bank{"bank_2", lines, line_bytes * 2}, Bank{"bank_3", lines, line_bytes * 2}},
        bytes_(std::size_t{lines} * line_bytes + kWordBytes) {}

  // The word at byte `place` of the store: a texel in its low bits.
  std::uint32_t read(Cycle cycle, std::uint8_t bank, std::uint32_t place) {
    banks_[bank].claim_read(cycle, place);
    return word(&bytes_[place]);
  }
  void write(Cycle cycle, std::uint32_t slot, const std::uint8_t* line) {
    DEBURR_CHECK(written_at_ != cycle,
                 "two lines written to the data banks in cycle " + std::to_string(cycle));
    written_at_ = cycle;
    std::copy(line, line + line_bytes_, bytes_.begin() + slot * line_bytes_);
  }
  // Little-endian, whatever the host is.
  static std::uint32_t word(const std::uint8_t* bytes) {
    return std::uint32_t{bytes[0]} | std::uint32_t{bytes[1]} << 8 | std::uint32_t{bytes[2]} << 16 |
           std::uint32_t{bytes[3]} << 24;
  }
  void reset() {
    written_at_ = kNever;
    for (Bank& bank : banks_) bank.reset();
  }

 private:
  static constexpr std::uint32_t kWordBytes = 4;

  class Bank final : public Storage {
   public:
    Bank(const char* name, std::uint32_t words, std::uint32_t bits)
        : Storage(name, words, bits, "1R1W") {}
    void claim_read(Cycle cycle, std::uint32_t place) {
      DEBURR_CHECK(
          read_at_ != cycle || place == place_,
          std::string(this->name()) + ": two texels read in cycle " + std::to_string(cycle));
      read_at_ = cycle;
      place_ = place;
    }
    void reset() override { read_at_ = kNever; }

   private:
    Cycle read_at_ = kNever;
    std::uint32_t place_ = 0;
  };

  std::uint32_t line_bytes_;
  std::array<Bank, 4> banks_;
  std::vector<std::uint8_t> bytes_;
  Cycle written_at_ = kNever;
};

}  // namespace deburr::rtl::texture
