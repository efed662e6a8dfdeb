// SPDX-License-Identifier: MIT
// Keeps the pixels of the frame from their arrival until they are blended, R + 5 rows later: in
// line buffers on the chip, or written to memory and read back.
//
// Where: beside the pipe, from the SlotSequencer to the Blender. Two sides. In: a beat a clock is
// stored. Out: for each slot that blends, the beat of row y = s - R - 5 with the beats above and
// below and the pixels beside it. With storage = memory the in side gathers lines of 64 bytes and
// sends each when its last pixel has come (latency 1 to the memory port), the out side loads rows y
// + 1, a line a request, into the rows on the chip as soon as their place is free and their write
// has been answered; writes go before reads. A line that comes is stored eight words a clock (two
// cycles with one lane). Answers may come in any order; that all before a line have come is seen a
// line a clock.
// Neighbouring rows lie in different memories, so that each is read and written once a clock; two
// beats of the middle row come from two banks.
// Stalls: `memory` (a line is not there yet, or cannot be sent), `rows` (the place of a beat that
// comes in still holds a pixel that will be asked for: only if a row is shorter than the pipe),
// `downstream`.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/morphological/common/frame_configuration.h"
#include "rtl_model/morphological/common/tokens.h"

namespace deburr::rtl::morphological {

class PixelStore final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  In<BeatToken> beats_in{"beats_in"};
  In<FetchToken> fetches_in{"fetches_in"};
  Out<PixelToken> pixels_out{"pixels_out"};
  std::optional<PulseOut> memory_error_out;  // with storage = memory

  PixelStore(const sc_core::sc_module_name& name, ClockDomain& clock,
             const spec::morphological::Parameters& parameters);
  Activity tick(Cycle cycle) override;
  void reset() override;

  // storage = memory: between this and the memory port.
  void connect(Link<MemoryRequest>& requests, Link<MemoryResponse>& responses);
  // Bits of a request's tag.
  static constexpr std::uint32_t kTagBits = 19;

  Counter lines_written{"lines_written", "lines", "lines of 64 bytes written to memory"};
  Counter lines_read{"lines_read", "lines", "lines of 64 bytes requested from memory"};
  Counter memory_errors{"memory_errors", "lines", "memory responses with an error"};

  static Datasheet datasheet();

 private:
  // What a side did in a clock.
  enum class Did { kNothing, kWork, kWaitsForMemory, kWaitsForRows, kWaitsDownstream };

  // Lines under way in one direction, in their order.
  struct Flight {
    Flight(const char* name, std::uint32_t lines)
        : places(lines),
          bits(name, {.words = lines,
                      .word_bits = 1,
                      .kind = MemoryKind::kFlops,
                      .write_ports = 2,
                      .latency = 0,
                      .content = "lines under way: has it come?"}),
          come(lines) {}
    bool full() const { return count == places; }
    std::uint32_t send() {
      const std::uint32_t place = next;
      next = next + 1 == places ? 0 : next + 1;
      ++count;
      return place;
    }
    // Before settle() of its clock. What comes as the oldest goes past its bit.
    void arrives(Cycle cycle, std::uint32_t place) {
      passes = place == oldest;
      if (passes) return;
      set.write(cycle, place);
      come[place] = true;
    }
    // In every clock: has the oldest come? Then it is no longer under way.
    bool settle(Cycle cycle) {
      if (count == 0) return false;
      look.read(cycle, oldest);
      if (!come[oldest] && !passes) return false;
      if (!passes) clear.write(cycle, oldest);
      passes = come[oldest] = false;
      oldest = oldest + 1 == places ? 0 : oldest + 1;
      --count;
      return true;
    }
    void reset() {
      next = oldest = count = 0;
      passes = false;
      come.assign(places, false);
    }
    const std::uint32_t places;
    Memory<void> bits;
    ReadPort<void> look{bits, "oldest"};
    WritePort<void> set{bits, "responses"}, clear{bits, "oldest"};
    std::vector<bool> come;
    std::uint32_t next = 0, oldest = 0, count = 0;
    bool passes = false;  // the line that comes in this clock is the oldest
  };
  // A line of the frame, by row and place in it; counted, not divided.
  struct LinePlace {
    std::int32_t row = 0;
    std::uint32_t line = 0;
    std::uint32_t address = 0;  // bytes from the frame's base
    void step(std::uint32_t row_lines) {
      address += kLineBytes;
      if (++line != row_lines) return;
      line = 0;
      ++row;
    }
    bool before(const LinePlace& other) const {
      return row != other.row ? row < other.row : line < other.line;
    }
  };
  // storage = memory.
  struct InMemory {
    explicit InMemory(std::uint32_t outstanding)
        : writes("writes_in_flight", outstanding), reads("reads_in_flight", outstanding) {}
    Memory<void> gather_line{"gather_line",
                             {.words = 1,
                              .word_bits = 8 * kLineBytes,
                              .kind = MemoryKind::kFlops,
                              .latency = 0,
                              .mask_bits = 32,
                              .content = "the line that is being gathered"}};
    // The last beat of a line goes past it.
    WritePort<void> gather{gather_line, "in"};
    ReadPort<void> send{gather_line, "requests"};
    Link<MemoryRequest>* requests = nullptr;
    Link<MemoryResponse>* responses = nullptr;
    Line gathered{};
    Flight writes, reads;
    LinePlace sent, answered;  // writes; answered: all before this one
    LinePlace asked, loaded;   // reads; loaded: all before this one
    std::uint32_t row_lines = 0;
    bool half = false;  // of the line at the responses is stored
  };

  using Word = LanePixels;
  // Every fourth row.
  struct Lines {
    Lines(const std::string& name, const MemoryShape& shape)
        : memory(name.c_str(), shape), words(shape.words) {}
    Memory<void> memory;
    ReadPort<void> read{memory, "blended row and its neighbours"};
    WritePort<void> write{memory, "in"};
    std::vector<Word> words;
  };
  static constexpr std::int32_t kLines = 4;

  // Once a clock each, from one place: inline.
  inline Did fetch(Cycle cycle, const FrameConfiguration& configuration);
  inline void address(Cycle cycle, const FrameConfiguration& configuration);
  inline void send(Cycle cycle, const FrameConfiguration& configuration);
  inline Did store(Cycle cycle, const FrameConfiguration& configuration);
  bool is_loaded(const FrameConfiguration& configuration, const Slot& slot) const;
  void look_around(const FrameConfiguration& configuration, std::int32_t slot_row);
  bool gather(Cycle cycle, const FrameConfiguration& configuration, const BeatToken& beat,
              std::int32_t x, std::int32_t count);
  bool receive(Cycle cycle);
  bool load(Cycle cycle, const MemoryResponse& response);
  bool settle(Cycle cycle);
  bool request(Cycle cycle, const FrameConfiguration& configuration);
  void begin_frame(const FrameConfiguration& configuration);
  // Has the row whose place row y takes been asked for up to this beat for the last time?
  bool is_free(std::int32_t y, std::uint32_t beat) const {
    const std::int32_t last = y - rows_ + 1 + lag_;
    return y < rows_ || asked_row_ > last || (asked_row_ == last && asked_beat_ > beat);
  }
  // A row on the chip.
  struct Row {
    Lines* lines = nullptr;  // nullptr: outside the frame
    std::size_t from = 0;    // its first word
  };
  Row row(std::int32_t y) {
    return {lines_[static_cast<std::size_t>(y % kLines)].get(),
            static_cast<std::size_t>(y % rows_ / kLines) * stride_};
  }

  const std::int32_t lanes_, lag_;  // lag: rows from a slot to the row that it blends
  const std::int32_t rows_;         // kept on the chip
  const std::size_t stride_;        // words a row
  Activity memory_stall_, rows_stall_;
  std::vector<std::unique_ptr<Lines>> lines_;
  Row in_;  // of the beat that comes in
  // Around the slot row `around_row_`.
  Row above_, centre_, below_;
  std::int32_t around_row_ = -1;
  std::optional<InMemory> memory_;

  // The slot that comes next into stage 1.
  std::int32_t asked_row_ = 0;
  std::uint32_t asked_beat_ = 0;
  // Stage 2. The output registers of the lines hold the words as they were in the clock of the
  // address, whatever is stored there from that clock on.
  bool fetched_ = false;
  std::uint32_t beat_ = 0;
  PixelToken words_{};
};

}  // namespace deburr::rtl::morphological
