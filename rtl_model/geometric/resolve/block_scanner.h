// SPDX-License-Identifier: MIT
// Function  Finds the touched blocks of a frame, in raster order of blocks. The last block is
//           followed by the end token.
// Position  Start of the resolve.
// Stalls    `downstream`.
//
// The next group of 16 bits is loaded while the last bit of the previous one leaves.
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/geometric/common/frame_configuration.h"
#include "rtl_model/geometric/common/tokens.h"
#include "rtl_model/geometric/weights/weight_memories.h"

namespace deburr::rtl::geometric {

class BlockScanner final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  WireIn<Phase> phase_in{"phase_in"};
  Out<TouchedBlock> blocks_out{"blocks_out"};

  BlockScanner(const sc_core::sc_module_name& name, ClockDomain& clock,
               const spec::geometric::Parameters& parameters, const ReadPort<TouchedWord>& touched);
  Activity tick(Cycle cycle) override;
  void reset() override;

  static Datasheet datasheet();

 private:
  void load(Cycle cycle);

  ReadPort<TouchedWord> touched_port_;
  Memory<TouchedWord> above_;
  ReadPort<TouchedWord> above_read_{above_, "this row"};
  WritePort<TouchedWord> above_write_{above_, "next row"};
  std::uint32_t asked_ = 0, taken_ = 0;      // U17, requested and taken words
  std::uint32_t column_ = 0, row_ = 0;       // U5, U12: of the next word to take
  std::uint32_t block_x_ = 0, block_y_ = 0;  // first block of the word in stage 3
  TouchedWord left_, above_word_;            // of that word: blocks not yet sent; the row above
  bool ended_ = false;
};

}  // namespace deburr::rtl::geometric
