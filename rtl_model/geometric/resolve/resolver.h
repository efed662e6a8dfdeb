// SPDX-License-Identifier: MIT
// Function  Blends the pixels of a touched block and writes them back, in place. Results are
//           rounded by magnitude.
// Position  End of the resolve.
// Stalls    `colours` (the next line has not arrived), `downstream`.
// Source    Paper 002, eq (8).
//
// Loading, blending and writing work on three consecutive blocks. A neighbour that was already
// blended is replaced by its original value: `originals` stores the last row of each block column,
// registers store the last column of the block to the left. With frame_copy neighbours come from
// the copy and are not replaced. A block counts max(1, lines, beats) cycles as busy, however long
// it waits for lines.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/geometric/common/frame_configuration.h"
#include "rtl_model/geometric/common/memory_arbiter.h"
#include "rtl_model/geometric/common/tokens.h"
#include "rtl_model/geometric/resolve/colour_store.h"

namespace deburr::rtl::geometric {

class Resolver final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  WireIn<Phase> phase_in{"phase_in"};
  // True if the end token has arrived and every write is answered.
  WireOut<bool> resolved_out{"resolved_out"};
  In<BlockToken> blocks_in{"blocks_in"};
  MemoryClient memory;

  Resolver(const sc_core::sc_module_name& name, ClockDomain& clock,
           const spec::geometric::Parameters& parameters, const ColourStore::Reader& colours);
  Activity tick(Cycle cycle) override;
  void reset() override;

  std::function<void(const spec::geometric::BlockRecord&)> observer;

  Counter blocks{"blocks", "blocks", "touched blocks"};
  Counter blended_pixels{"blended_pixels", "pixels", "blended pixels"};
  Counter lines_written{"lines_written", "lines", "colour lines written"};

  static Datasheet datasheet(const spec::geometric::Parameters& parameters = {});

 private:
  using Rgba = spec::geometric::Rgba8;
  struct Window {
    std::array<Rgba, 16> own;
    std::array<Rgba, 4> up, down, left, right;
  };
  // A row or column of a block before blending, and which pixels were blended.
  struct Originals {
    std::array<Rgba, 4> pixel{};
    std::uint8_t blended = 0;
  };
  struct Operands {
    std::array<Rgba, 3> code;                           // centre, first, second
    std::array<std::uint8_t, 2> weight;                 // U0.8
    std::array<std::int32_t, 3> centre, first, second;  // differences to the centre; S13
    std::array<std::int32_t, 3> sum;                    // S22
    std::array<std::uint16_t, 3> value;                 // U0.12
    std::uint8_t pixel;                                 // U4, position in the block
  };
  struct Beat {
    std::uint8_t block;  // index in blocks_
    std::uint8_t count;  // U3, pixels
    bool last;           // of its block
    std::array<Operands, kLanes> operands;
  };

  BlockToken& block(std::uint32_t number) { return blocks_[number % kBlocks]; }
  Activity load(Cycle cycle);
  void place(bool tiled, const Line& line, std::uint32_t number);
  void move_on(Cycle cycle);
  void restore(Cycle cycle, const BlockToken& block);
  void take_pixels(Cycle cycle, Beat& beat);
  void subtract(Cycle cycle, Beat& beat);
  static void multiply(Beat& beat);
  void round(Cycle cycle, Beat& beat);
  void encode(Cycle cycle, const Beat& beat);
  void close(std::uint32_t number, bool tiled);
  bool write(Cycle cycle);
  bool blend(Cycle cycle);

  ColourStore::Reader colours_;  // filled by the BlockFetch
  const std::uint32_t lanes_;
  Memory<Originals> originals_;
  ReadPort<Originals> originals_read_{originals_, "above"};
  WritePort<Originals> originals_write_{originals_, "last row"};
  Memory<std::uint16_t> linear_rom_;
  std::vector<ReadPort<std::uint16_t>> light_;  // by lane, channel, operand
  Memory<std::uint8_t> encode_rom_;
  std::vector<ReadPort<std::uint8_t>> codes_;  // by lane, channel
  Activity stalled_colours_;

  // Tokens of the blocks in the pipeline. In hardware they move with the stages.
  static constexpr std::uint32_t kBlocks = 16;
  std::array<BlockToken, kBlocks> blocks_{};
  std::uint32_t newest_ = 0;  // number of the block in stage 1

  // Stage 1.
  bool loading_ = false;
  std::uint32_t to_load_ = 0;  // lines
  Window window_{};
  // Stage 2.
  Originals left_;  // last column of the previous block
  std::uint16_t left_x_ = 0, left_y_ = 0;
  bool has_left_ = false;
  // Stages 3 to 7.
  bool blending_ = false;
  std::uint32_t blended_block_ = 0;  // number
  std::uint32_t to_blend_ = 0;       // bit i: pixel i
  int loaded_beats_ = 0;             // for statistics: remaining beats hidden by loading
  Window sources_{};
  Pipe<Beat, 5> pipe_;
  std::array<Rgba, 16> results_{};
  // Stage 8.
  std::uint32_t written_block_ = 0;  // number
  std::uint32_t to_write_ = 0;       // lines, or rows if raster
  std::array<Rgba, 16> written_{};
  std::uint32_t writes_ = 0;  // U11, unanswered writes
  bool ended_ = false;
};

}  // namespace deburr::rtl::geometric
