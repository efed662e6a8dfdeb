// SPDX-License-Identifier: MIT
// Stores the pixels of the frame from arrival until they are blended, R + 5 rows later: in line
// buffers on the chip, or in memory.
//
// Position  Next to the pipeline: SlotSequencer -> PixelStore -> Blender.
// Input     Stores one beat per cycle. storage = memory: gathers lines of 64 bytes and sends each
//           when its last pixel has arrived, with latency 1 to the memory port.
// Output    For each slot that blends: the beat of row y = s - R - 5, the beats above and below,
//           and the pixels left and right of it. storage = memory: loads rows up to y + 1, one line
//           per request, when their entry on the chip is free and their write has been answered.
//           Writes have priority over reads. An arriving line is stored eight words per cycle (two
//           cycles with one lane). Responses may arrive in any order; lines are retired in order,
//           one per cycle.
// Memory    Adjacent rows are in different memories, so each is read and written once per cycle.
//           Two beats of the middle row come from two banks.
// Stalls    memory      A line has not arrived, or cannot be sent.
//           rows        The entry for an incoming beat still holds a pixel that will be read. Only
//                       in rows shorter than the pipeline.
//           downstream
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

  // storage = memory: connects the links to the memory port.
  void connect(Link<MemoryRequest>& requests, Link<MemoryResponse>& responses);
  // Width of a request's tag.
  static constexpr std::uint32_t kTagBits = 19;

  Counter lines_written{"lines_written", "lines", "lines of 64 bytes sent to memory"};
  Counter lines_read{"lines_read", "lines", "lines of 64 bytes requested from memory"};
  Counter memory_errors{"memory_errors", "lines", "memory responses with an error"};

  static Datasheet datasheet(const spec::morphological::Parameters& parameters = {});

 private:
  // Result of one side in a cycle.
  enum class Did { kNothing, kWork, kWaitsForMemory, kWaitsForRows, kWaitsDownstream };

  // Lines in flight in one direction, in order.
  struct Flight {
    Flight(const char* name, std::uint32_t lines)
        : places(lines),
          bits(name, {.words = lines,
                      .word_bits = 1,
                      .kind = MemoryKind::kFlops,
                      .write_ports = 2,
                      .latency = 0,
                      .content = "per line in flight: has it arrived?"}),
          come(lines) {}
    bool full() const { return count == places; }
    std::uint32_t send() {
      const std::uint32_t place = next;
      next = next + 1 == places ? 0 : next + 1;
      ++count;
      return place;
    }
    // Call before settle() in a cycle. The oldest line bypasses its bit.
    void arrives(Cycle cycle, std::uint32_t place) {
      passes = place == oldest;
      if (passes) return;
      set.write(cycle, place);
      come[place] = true;
    }
    // Call in every cycle: retires the oldest line if it has arrived.
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
    bool passes = false;  // the line that arrives in this cycle is the oldest
  };
  // Position of a memory line in the frame; incremented, never divided.
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
  // Only with storage = memory.
  struct InMemory {
    explicit InMemory(std::uint32_t outstanding)
        : writes("writes_in_flight", outstanding), reads("reads_in_flight", outstanding) {}
    Memory<void> gather_line{"gather_line",
                             {.words = 1,
                              .word_bits = 8 * kLineBytes,
                              .kind = MemoryKind::kFlops,
                              .latency = 0,
                              .mask_bits = 32,
                              .content = "the line being gathered"}};
    // The last beat of a line bypasses the register.
    WritePort<void> gather{gather_line, "in"};
    ReadPort<void> send{gather_line, "requests"};
    Link<MemoryRequest>* requests = nullptr;
    Link<MemoryResponse>* responses = nullptr;
    Line gathered{};
    Flight writes, reads;
    LinePlace sent, answered;  // writes; all lines before `answered` are done
    LinePlace asked, loaded;   // reads; all lines before `loaded` are done
    std::uint32_t row_lines = 0;
    bool half = false;  // half of the line at `responses` is stored
  };

  using Word = LanePixels;
  // One of the four memories: every fourth row.
  struct Lines {
    Lines(const std::string& name, const MemoryShape& shape)
        : memory(name.c_str(), shape), words(shape.words) {}
    Memory<void> memory;
    ReadPort<void> read{memory, "blended row and its neighbours"};
    WritePort<void> write{memory, "in"};
    std::vector<Word> words;
  };
  static constexpr std::int32_t kLines = 4;

  // Each is called once per cycle from one place, hence inline.
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
  // Is the entry that row y overwrites free up to this beat?
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

  const std::int32_t lanes_, lag_;  // lag_: rows from a slot to the row that it blends
  const std::int32_t rows_;         // rows on the chip
  const std::size_t stride_;        // words per row
  Activity memory_stall_, rows_stall_;
  std::vector<std::unique_ptr<Lines>> lines_;
  Row in_;  // row of the incoming beat
  // Rows around the blended row of slot row `around_row_`.
  Row above_, centre_, below_;
  std::int32_t around_row_ = -1;
  std::optional<InMemory> memory_;

  // The next slot for stage 1.
  std::int32_t asked_row_ = 0;
  std::uint32_t asked_beat_ = 0;
  // Stage 2. The lines' output registers hold the words as read in the cycle of the address; later
  // writes do not change them.
  bool fetched_ = false;
  std::uint32_t beat_ = 0;
  PixelToken words_{};
};

}  // namespace deburr::rtl::morphological
