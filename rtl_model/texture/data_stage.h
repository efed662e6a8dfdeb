// SPDX-License-Identifier: MIT
// Reads the four texels of a request from the data banks, and writes the request's fills when it
// reaches the head of the LatencyFifo.
//
// Position  LatencyFifo -> DataStage; last unit of the TextureCache.
// Banks     A bank holds one 32-bit word of each line (16 banks for lines of 64 bytes). A fill is
//           written in one cycle, and texels of one line are always in different banks. Consecutive
//           rows of a `linear` texture have the same offset in their lines, so the lines of odd
//           rows are stored with their banks rotated by half a tile.
// Order     Texels that hit are read before a fill of the same request can overwrite them: banks
//           are read-first, and fills begin in the cycle of the last pass that reads a hit. Texels
//           that missed are taken from the fill.
// Blocks    With `decode = after` also the distinct blocks of a request, of two or four words, for
//           the BlockDecoder. Two blocks of a request are in the same banks or in different ones.
// Stalls    wait_fill      A line has not arrived.
//           write_fill     More lines to write.
//           bank_conflict  More passes to read.
//           downstream     Each stage stalls independently.
// Output    `line_used_out`, a register, is high in the cycle after each written line.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/texture/cache_units.h"
#include "rtl_model/texture/fill_buffer.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class DataStage final : public DataUnit {
 public:
  In<CacheToken> requests_in{"requests_in"};
  // Exactly one of the two is built: to the FilterPipeline, or with decoders to the BlockDecoder.
  std::optional<Out<TexelQuadToken>> texels_out;
  std::optional<Out<BlockGroup>> blocks_out;
  WireOut<bool> line_used_out{"line_used_out"};

  DataStage(const sc_core::sc_module_name& name, ClockDomain& clock,
            const spec::texture::Parameters& parameters, const FillBuffer::Reader& fills);
  Activity tick(Cycle cycle) override {
    const Activity activity = work(cycle);
    fills_.read_ahead(cycle);
    if (line_used_out.driven() && line_used_ != cycle) line_used_out.drive(cycle, false);
    return activity;
  }

  static Datasheet datasheet(const spec::texture::Parameters& parameters = {});

 private:
  // When and through which port each texel that hits is read.
  struct Schedule {
    int passes;                 // 0..4: passes that read a hit
    std::array<int, 4> pass;    // pass of texel (of its block) i; -1: it missed
    std::array<bool, 4> again;  // same word (block) as an earlier texel
  };
  Schedule schedule(const CacheToken& request) const;
  Activity work(Cycle cycle);
  Activity advance(Cycle cycle, const CacheToken& request);
  void find_blocks(const CacheToken& request);
  bool read_at_once(Cycle cycle, const CacheToken& request);
  void read(Cycle cycle, const CacheToken& request, int pass);
  void read_blocks(Cycle cycle, const CacheToken& request, int pass);
  void write_fill(Cycle cycle, const CacheToken& request);
  void finish(Cycle cycle, const CacheToken& request);

  FillBuffer::Reader fills_;
  std::uint32_t line_log2_, words_a_line_, turn_;
  Memory<void> banks_;
  std::array<ReadPort<void>, 4> reads_{
      ReadPort<void>{banks_, "texel_0"}, ReadPort<void>{banks_, "texel_1"},
      ReadPort<void>{banks_, "texel_2"}, ReadPort<void>{banks_, "texel_3"}};
  std::vector<ReadPort<void>> more_reads_;  // for words of blocks
  WritePort<void> write_{banks_, "fill"};
  std::vector<std::uint8_t> bytes_;  // content of the banks, word by word
  // Registers of the request in stage 1.
  Schedule schedule_{};
  int passes_done_ = 0, fills_done_ = 0;
  Cycle line_used_ = kNever;  // last cycle in which a line was written
  // The request in stage 2.
  TexelQuadToken waiting_{};
  BlockGroup blocks_{};  // with decoders
};

}  // namespace deburr::rtl::texture
