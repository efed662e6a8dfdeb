// SPDX-License-Identifier: MIT
// Fetches the fills of a cache of decoded blocks: keeps C lines of memory, decodes blocks from
// them, and passes lines of other textures on.
//
// Position  MissQueue -> BlockFetcher -> MemoryPort, and back; only with `decode = before`.
// Latency   5 for a block whose memory line is present, of which 4 in the decoder; 1 each way for a
//           line of another texture.
// Interval  1: one line from the MissQueue, one response and one decoded line per cycle.
// Stalls    downstream   The memory port, or the MissQueue, is not ready; or a response for another
//                        texture passes, which has priority over the decoder.
//           line_in_use  A waiting block needs the memory line that would be replaced.
//           wait_memory  Blocks wait for memory lines, and there is nothing else to do.
// Lines     Fully associative, replaced in the order of allocation. A line is present from its
//           request on; its blocks wait until it has been written.
// Errors    A response with an error counts once and sets a sticky status bit; its line reads as
//           zeros.
// Source    docs/reference/texture/compressed.md, "Before the cache".
#pragma once

#include <array>
#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/control_registers.h"
#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/block_colours.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class BlockFetcher final : public Unit {
 public:
  In<MemoryRequest> lines_in{"lines_in"};  // address: number of a line of the cache
  Out<MemoryRequest> requests_out{"requests_out"};
  In<MemoryResponse> responses_in{"responses_in"};
  Out<MemoryResponse> fills_out{"fills_out"};

  BlockFetcher(const sc_core::sc_module_name& name, ClockDomain& clock,
               const spec::texture::Parameters& parameters, ControlRegisters& registers);
  Activity tick(Cycle cycle) override;
  void reset() override;
  // While idle: the memory lines become absent in one cycle.
  void invalidate();

  // Faults that tests inject: those of the arithmetic; a line replaced while a block needs it;
  // lines kept by invalidate().
  BlockFault fault = BlockFault::kNone;
  bool replaces_used_lines = false, keeps_lines = false;

  Counter memory_lines{"memory_lines", "lines", "memory lines requested for blocks"};
  Counter blocks{"blocks", "blocks", "blocks decoded"};
  Counter memory_errors{"memory_errors", "lines", "responses with an error"};
  BlockKinds kinds{};

  // Bits of its tags: the entry of a fill, or the memory line, and which of the two.
  static std::uint32_t tag_bits(const spec::texture::Parameters& parameters);
  static Datasheet datasheet(const spec::texture::Parameters& parameters = {});

 private:
  // A block that waits for its memory line.
  struct Waiting {
    std::uint32_t entry;  // U8, of the FillBuffer
    std::uint8_t line;    // U6, its memory line
    std::uint8_t part;    // U3, the eight bytes of the line that it begins with
    std::uint8_t codec;   // U3
  };
  struct Decoding {
    Waiting block;
    Cycle read_at;                        // check only, no hardware
    std::array<std::uint32_t, 16> texel;  // computed in stage 2 of the model
  };
  static constexpr std::size_t kStages = 4;
  static constexpr std::uint32_t kAbsent = ~std::uint32_t{0};

  bool decode(Cycle cycle);
  void read_texels(Cycle cycle, Decoding& beat);
  bool receive(Cycle cycle, bool passes);
  Activity take_line(Cycle cycle, bool may_replace);
  Activity accept(Cycle cycle, const MemoryRequest& asked, bool may_replace);
  void request(Cycle cycle, std::uint32_t memory_line, std::uint32_t tag);
  std::uint32_t find(Cycle cycle, std::uint32_t memory_line);
  bool is_other(const MemoryResponse& response) const { return response.tag < lines_tag_; }

  ControlRegisters& registers_;
  const spec::texture::BlockRule rule_;
  const std::uint32_t lines_tag_;  // added to the number of a memory line
  Memory<Line> lines_;
  ReadPort<Line> line_read_{lines_, "decoder"};
  WritePort<Line> line_written_{lines_, "responses"};
  Memory<std::uint32_t> tags_;
  ReadPort<std::uint32_t> tags_read_{tags_, "new_line"};
  WritePort<std::uint32_t> tag_written_{tags_, "new_line"};
  Memory<std::uint8_t> arrived_;
  ReadPort<std::uint8_t> has_arrived_{arrived_, "decoder"};
  WritePort<std::uint8_t> arrives_{arrived_, "responses"}, replaced_{arrived_, "new_line"};
  Memory<std::uint32_t> uses_;
  ReadPort<std::uint32_t> uses_before_{uses_, "new_line"}, uses_left_{uses_, "decoder"};
  WritePort<std::uint32_t> used_{uses_, "new_line"}, unused_{uses_, "decoder"};
  Memory<Waiting> queue_;
  ReadPort<Waiting> oldest_{queue_, "decoder"};
  WritePort<Waiting> newest_{queue_, "new_line"};
  // Registers: oldest block and number of blocks; the line that is replaced next.
  std::uint32_t head_ = 0, waiting_ = 0;  // U8, U9
  std::uint32_t next_ = 0;                // U6
  Pipe<Decoding, kStages> pipe_;
  // This cycle only: memory lines of the blocks that left and entered the queue; waiting blocks of
  // the latter before this cycle.
  std::uint32_t left_ = kAbsent, entered_ = kAbsent, uses_of_entered_ = 0;
  Activity line_in_use_, wait_memory_;
};

}  // namespace deburr::rtl::texture
