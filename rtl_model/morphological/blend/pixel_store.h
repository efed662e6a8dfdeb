// SPDX-License-Identifier: MIT
// Keeps the pixels of the frame from their arrival until they are blended, R + 5 rows later: in
// line buffers on the chip, or written to memory and read back.
//
// Where: beside the pipe, from the SlotSequencer to the Blender. Two sides. In: a beat a clock is
// stored. Out: for each slot that blends, the beat of row y = s - R - 5 with the beats above and
// below and the pixels beside it, latency 1, initiation interval 1. With storage = memory the
// in side gathers lines of 64 bytes and sends each when its last pixel has come (latency 1 to the
// memory port), the out side loads rows y + 1, a line a request, into three rows on the chip as
// soon as their place is free and their write has been answered; writes go before reads.
// Stalls: `memory` (a line is not there yet, or cannot be sent), `rows` (the place of a beat that
// comes in still holds a pixel that will be asked for: only if a row is shorter than the pipe),
// `downstream`. Cost: pixel_lines, R + 7 rows x 32 bits (storage = memory: 3 rows), one write
// and three reads of a column a clock, each in a row (bank) of its own; storage = memory also the
// line that is gathered, memory.outstanding lines that have come and tags of twice as many.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/morphological/line_memory.h"
#include "rtl_model/morphological/parameter_store.h"
#include "rtl_model/morphological/tokens.h"

namespace deburr::rtl::morphological {

class PixelStore final : public Unit {
 public:
  In<BeatToken> beats_in{"beats_in"};
  In<FetchToken> fetches_in{"fetches_in"};
  Out<PixelToken> pixels_out{"pixels_out"};

  PixelStore(const sc_core::sc_module_name& name, ClockDomain& clock,
             const spec::morphological::Parameters& parameters, ParameterStore& store);
  Activity tick(Cycle cycle) override;
  void reset() override;

  // storage = memory: between this and the memory port.
  void connect(Link<MemoryRequest>& requests, Link<MemoryResponse>& responses);

  Counter lines_written{"lines_written", "lines", "lines of 64 bytes sent to memory"};
  Counter lines_read{"lines_read", "lines", "lines of 64 bytes asked of memory"};
  Counter memory_errors{"memory_errors", "lines", "memory responses with an error"};

 private:
  // What a side did in a clock.
  enum class Did { kNothing, kWork, kWaitsForMemory, kWaitsForRows, kWaitsDownstream };

  Did fetch(Cycle cycle);
  Did store(Cycle cycle);
  bool gather(Cycle cycle, const BeatToken& beat, std::int32_t x, std::int32_t count);
  bool receive(Cycle cycle);
  bool request(Cycle cycle);
  void begin_frame();
  // 32 bits: a frame that begins below 4 GiB and ends above goes on at 0.
  std::uint32_t address_of(std::uint32_t line) const {
    return store_.rules().pixel_base + line * kLineBytes;
  }
  spec::morphological::Rgba8* row(std::int32_t y) {
    return pixels_.data() + static_cast<std::size_t>(y % rows_) * stride_;
  }

  ParameterStore& store_;
  const bool in_memory_;
  const std::int32_t rows_;  // kept on the chip
  const std::size_t stride_;
  const std::uint32_t outstanding_;  // lines, each direction
  Activity memory_, rows_stall_;
  LineMemory<spec::morphological::Rgba8> pixels_;
  std::deque<Buffer> buffers_;  // storage = memory

  std::uint32_t fetched_ = 0;  // number of the next slot that will ask for pixels
  spec::morphological::Rgba8 *in_row_ = nullptr, *above_ = nullptr, *centre_ = nullptr,
                             *below_ = nullptr;

  // storage = memory. Lines are numbered from 0 in each frame.
  Link<MemoryRequest>* requests_ = nullptr;
  Link<MemoryResponse>* responses_ = nullptr;
  Line gathered_{};
  std::uint32_t row_lines_ = 0, frame_lines_ = 0;
  std::uint32_t sent_ = 0, answered_ = 0;  // writes; answered: all before this one
  std::uint32_t asked_ = 0, loaded_ = 0;   // reads; loaded: all before this one
  std::int32_t asked_row_ = 0;
  std::uint32_t asked_line_ = 0;                    // of line `asked_`
  std::vector<bool> write_answered_, line_loaded_;  // of the lines in flight, by number
};

}  // namespace deburr::rtl::morphological
