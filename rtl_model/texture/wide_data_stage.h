// SPDX-License-Identifier: MIT
// The DataStage of a wide build: reads the texels of a group from the data banks, and writes the
// group's fills when it reaches the head of the WideLatencyFifo.
//
// Position  WideLatencyFifo -> WideDataStage; last unit of a wide TextureCache.
// Banks     Lines are in B line banks by the low bits of the line number, and a line bank has a
//           bank for each word of a line. A bank of words is read R times per cycle (a copy per
//           read) and written once; so up to D fills of a cycle are for different line banks.
// Order     As in the DataStage: bank passes first, writes from the cycle of the last pass on.
//           Banks are read-first; texels that missed come from the fill.
// Blocks    With `decode = after` also the distinct blocks of a group, for the BlockDecoder.
// Stalls    wait_fill, write_fill, bank_conflict, downstream: as in the DataStage.
// Output    Registers: `lines_used_out`, the lines written in the previous cycle; `stall_out`, the
//           stall of the cycle before.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <systemc>
#include <tuple>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/texture/cache_units.h"
#include "rtl_model/texture/fill_buffer.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class WideDataStage final : public DataUnit {
 public:
  In<CacheGroup> requests_in{"requests_in"};
  // As in the DataStage.
  std::optional<Out<TexelQuadGroup>> texels_out;
  std::optional<Out<BlockGroup>> blocks_out;
  WireOut<std::uint8_t> lines_used_out{"lines_used_out"};
  WireOut<SlotStall> stall_out{"stall_out"};

  WideDataStage(const sc_core::sc_module_name& name, ClockDomain& clock,
                const spec::texture::Parameters& parameters, const FillBuffer::Reader& fills);
  Activity tick(Cycle cycle) override;
  void reset() override;

  static Datasheet datasheet(const spec::texture::Parameters& parameters = {});

 private:
  static constexpr std::size_t kMostTexels = 4 * kMostInGroup;
  // A copy of the banks: its ports, and what it reads in the current cycle.
  struct Copy {
    Memory<void> banks;
    std::vector<ReadPort<void>> reads;
    std::vector<WritePort<void>> writes;
    Copy(const char* name, const spec::texture::Parameters& p);
  };
  static constexpr std::size_t kMostReads =
      kMostTexels + spec::texture::kMostDecoders * std::tuple_size_v<Block>;
  // A texel that hits, or a word of a block that does; `first`: of those of its word.
  struct Read {
    std::uint32_t place;  // byte in the banks
    std::uint8_t to;      // the texel; kMostTexels + 4 k + n: word n of block k
    std::uint8_t pass, copy;
    bool first;
  };
  // Of which line of the group.
  struct BlockPlace {
    std::uint8_t line, offset, codec;
    friend bool operator==(const BlockPlace&, const BlockPlace&) = default;
  };
  // Distinct words of a bank; valid if `group` is the number of the group.
  struct Bank {
    std::uint64_t group;
    std::uint32_t words;
    std::array<std::uint32_t, kMostReads> word;
  };

  Activity work(Cycle cycle);
  bool read_at_once(Cycle cycle, const CacheGroup& group);
  [[gnu::noinline]] void schedule(const CacheGroup& group);
  void add_read(std::uint32_t place, std::size_t to);
  void add_block(const CacheGroup& group, BlockRequest& request, std::size_t texel,
                 const BlockPlace& at, std::uint32_t place);
  void read(Cycle cycle, std::uint32_t pass);
  std::uint32_t write_fills(Cycle cycle, const CacheGroup& group);
  void write_fill(Cycle cycle, const CacheGroup& group, std::size_t line, std::uint32_t port);
  void finish(Cycle cycle, const CacheGroup& group);
  std::uint32_t& texel(std::size_t number) { return waiting_.at[number / 4].texel[number % 4]; }

  FillBuffer::Reader fills_;
  std::uint32_t line_log2_, words_a_line_, turn_, line_bank_mask_, bank_mask_;
  std::uint32_t reads_, fill_writes_;
  std::vector<std::unique_ptr<Copy>> copies_;  // R
  std::vector<std::uint8_t> bytes_;            // content of the banks, word by word
  std::vector<Bank> banks_;
  std::uint64_t group_ = 0;  // number of the group
  // Registers of the group in stage 1.
  std::array<Read, kMostReads> schedule_{};
  std::array<BlockPlace, spec::texture::kMostDecoders> block_places_{};
  std::uint32_t hits_ = 0, passes_ = 0, passes_done_ = 0;
  std::uint32_t next_line_ = 0, fills_left_ = 0;
  SlotStall stall_ = SlotStall::kNone;  // of the previous cycle
  // The group in stage 2.
  TexelQuadGroup waiting_{};
  BlockGroup blocks_{};  // with decoders
};

}  // namespace deburr::rtl::texture
