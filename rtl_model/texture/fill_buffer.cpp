// SPDX-License-Identifier: MIT
#include "rtl_model/texture/fill_buffer.h"

#include "rtl_model/texture/datasheets.h"

namespace deburr::rtl::texture {

void FillBuffer::reject(std::uint32_t entry, std::uint32_t offset, std::size_t bytes) const {
  DEBURR_CHECK(entry < entries_ && arrived_[entry] == kNever,
               std::string(memory_.name()) + ": entry " + std::to_string(entry) + " filled twice");
  DEBURR_CHECK(offset + bytes <= line_bytes_,
               std::string(memory_.name()) + ": beat at byte " + std::to_string(offset) +
                   " does not fit a line of bytes: " + std::to_string(line_bytes_));
}

Datasheet FillBuffer::datasheet(const spec::texture::Parameters& p) {
  const Sizes z(p);
  const auto entry = static_cast<std::uint32_t>(std::bit_width(z.outstanding - 1));
  return {.unit = "FillBuffer",
          .variant = std::to_string(z.outstanding) + " entries, " +
                     chosen("cache.fill_writes", z.fill_writes),
          .does = "Lines in flight from memory, filled in any order, used in the order of fills.",
          .latency = {2, "2, from the last beat of a line to the line on the output register"},
          .interval = {1, "1: one reservation, one beat and `fill_writes` releases per cycle"},
          .stages = {{.clock = "1",
                      .work = "the oldest line is read when it has arrived",
                      .path = "SRAM read enable",
                      .operators = {(z.fill_writes + 1) * op::add(entry), op::add(entry + 1),
                                    op::logic(10 * z.fill_writes + 20)},
                      .longest = {op::mux(1, z.outstanding)},
                      .registers = z.fill_writes * (entry + 1) + 2 * entry + 1},
                     {.clock = "2", .work = "its word", .path = "SRAM read"}}};
}

}  // namespace deburr::rtl::texture
