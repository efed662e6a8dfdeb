// SPDX-License-Identifier: MIT
#include "rtl_model/texture/fill_buffer.h"

namespace deburr::rtl::texture {

void FillBuffer::reject(std::uint32_t entry, std::uint32_t offset, std::size_t bytes) const {
  DEBURR_CHECK(entry < entries_ && arrived_[entry] == kNever,
               std::string(memory_.name()) + ": entry " + std::to_string(entry) + " filled twice");
  DEBURR_CHECK(offset + bytes <= line_bytes_,
               std::string(memory_.name()) + ": beat at byte " + std::to_string(offset) +
                   " does not fit a line of bytes: " + std::to_string(line_bytes_));
}

Datasheet FillBuffer::datasheet() {
  return {
      .unit = "FillBuffer",
      .does = "Lines in flight from memory, filled in any order, used in the order of fills.",
      .latency = {2, "2, from the last beat of a line to the line on the output register"},
      .interval = {1, "1: one reservation, one beat and `fill_writes` releases per cycle"},
      .stages = {{"1", "the oldest line is read when it has arrived",
                  "256 : 1 mux of arrival bits (64 by default), then the memory's read enable"},
                 {"2", "its word"}},
      .cost =
          "outstanding x line bits, 1R1W in `fill_writes` banks, flip-flops up to 16 kbit, else "
          "SRAM; an arrival bit per line."};
}

}  // namespace deburr::rtl::texture
