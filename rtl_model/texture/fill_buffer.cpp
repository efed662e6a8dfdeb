// SPDX-License-Identifier: MIT
#include "rtl_model/texture/fill_buffer.h"

namespace deburr::rtl::texture {

void FillBuffer::reject(std::uint32_t entry, std::uint32_t offset, std::size_t bytes) const {
  DEBURR_CHECK(entry < entries_ && arrived_[entry] == kNever,
               std::string(memory_.name()) + ": entry " + std::to_string(entry) + " filled twice");
  DEBURR_CHECK(offset + bytes <= line_bytes_, std::string(memory_.name()) + ": a beat at byte " +
                                                  std::to_string(offset) + " of a line of " +
                                                  std::to_string(line_bytes_));
}

Datasheet FillBuffer::datasheet() {
  return {.unit = "FillBuffer",
          .does = "Lines on their way from memory, filled in any order and used in that of fills.",
          .latency = {2, "2 from a beat that completes a line to the line on the output register"},
          .interval = {1, "1: one reservation, one arriving beat and one release a clock"},
          .stages = {{"1", "the oldest line is read once it has arrived",
                      "choice of 1 in 256 arrived bits (64 by default), then the memory's read "
                      "enable"},
                     {"2", "its word"}},
          .cost =
              "outstanding x line bits, 1R1W, flip-flops up to 16 kbit and SRAM above, an arrived "
              "bit each."};
}

}  // namespace deburr::rtl::texture
