// SPDX-License-Identifier: MIT
// Function  Combines the four weights of each pixel cut by a line, block by block, and marks the
//           touched blocks.
// Position  End of the edge pipeline. The resolve reads its memories through handles of its ports.
// Stalls    `weights` (the block has not arrived), `fills` (no fill entry is free), `spill` (the
//           block is still being written back, or the spill list is full), `downstream`.
//
// If second candidates are in another block than the first ones, the group is looked up a second
// time. A word written in stage 5 bypasses the memory to the next group. With a write buffer, a
// replaced block enters its ring and is written to memory when it leaves it, at the latest after
// the last token, then one per cycle. A write has priority over a read in the same cycle.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/fifo.h"
#include "rtl_model/fabric/histogram.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/geometric/common/edge_latency.h"
#include "rtl_model/geometric/common/frame_configuration.h"
#include "rtl_model/geometric/common/line_cache.h"
#include "rtl_model/geometric/common/memory_arbiter.h"
#include "rtl_model/geometric/common/tokens.h"
#include "rtl_model/geometric/weights/weight_memories.h"
#include "rtl_model/geometric/weights/write_buffer.h"

namespace deburr::rtl::geometric {

class WeightCombiner final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  WireIn<Phase> phase_in{"phase_in"};
  WireOut<bool> cleared_out{"cleared_out"};
  // True if the end token has arrived and every write is answered.
  WireOut<bool> drawn_out{"drawn_out"};
  In<WeightToken> weights_in{"weights_in"};
  MemoryClient memory;

  WeightCombiner(const sc_core::sc_module_name& name, ClockDomain& clock,
                 const spec::geometric::Parameters& parameters, EdgeLatency& latency);
  Activity tick(Cycle cycle) override;
  void reset() override;

  // --- For the resolve, which shares the ports in time ---
  ReadPort<std::uint32_t> tag_port() const { return cache_.tag_port(); }
  ReadPort<BlockWeights> data_port() const { return cache_.data_port(); }
  ReadPort<TouchedWord> touched_port() const { return touched_port_; }

  Counter lookups{"lookups", "blocks", "blocks looked up"};
  Counter misses{"misses", "blocks", "lookups of a block that is not in the cache"};
  Counter blocks_read{"blocks_read", "blocks", "blocks read back from memory"};
  Counter blocks_written{"blocks_written", "blocks", "replaced blocks written to memory"};
  Counter buffer_hits{"buffer_hits", "blocks", "blocks taken back from the write buffer"};
  Histogram buffered_blocks{"buffered_blocks", "blocks",
                            "blocks in the write buffer when all edges of a frame are drawn"};
  Histogram edge_latency{"edge_latency", "clk",
                         "from an edge leaving the EdgeReader to the write of its last group"};

  static Datasheet datasheet(const spec::geometric::Parameters& parameters = {});

 private:
  // A group reduced to the candidates of one block.
  struct Lookup {
    WeightToken group;
    bool more;            // those of the other block follow
    std::uint16_t index;  // U10
    bool missed, reads;   // reads: a missed block comes from memory, otherwise it is zero
    bool replaces;        // a block leaves the cache
    bool writes;  // a block is written to memory: the replaced one, or one of the write buffer
    std::uint16_t old_x, old_y;  // U11, the block to write
    std::uint8_t spill;          // U8, its entry in the spill list
    bool hit;                    // in the write buffer
    std::uint8_t ring;           // U7, its entry, or that of the block that leaves the cache
    template <class Self, class Visit>
    static constexpr void fields(Self& self, Visit&& visit) {
      visit("group", self.group);
      visit("more", self.more);
      visit("index", self.index, 10, "U10");
      visit("missed", self.missed);
      visit("reads", self.reads);
      visit("replaces", self.replaces);
      visit("writes", self.writes);
      visit("old_x", self.old_x, 11, "U11");
      visit("old_y", self.old_y, 11, "U11");
      visit("spill", self.spill, 8, "U8");
      visit("hit", self.hit);
      visit("ring", self.ring, 7, "U7");
    }
  };
  struct Work {
    Lookup lookup;
    BlockWeights block;
  };

  Activity clear(Cycle cycle);
  Activity look_up(Cycle cycle);
  void address(Cycle cycle);
  void keep_own_block();
  Activity look_up_block(Cycle cycle);
  Activity replace(std::uint32_t tag);
  Activity deliver(Cycle cycle);
  void move_out(Cycle cycle, Work& work, const BlockWeights& there);
  Activity flush(Cycle cycle);
  void combine(Cycle cycle, Work& work);
  bool answer(Cycle cycle);
  std::uint32_t address_of(Cycle cycle, std::uint32_t x, std::uint32_t y) const;
  bool spilling(std::uint32_t tag) const;
  bool spill(Lookup& lookup, std::uint32_t tag);
  void write_out(Cycle cycle, const Lookup& lookup, const BlockWeights& block);
  // True if the token writes a block to memory.
  bool writes(const Lookup& lookup) const { return lookup.replaces && (!buffer_ || lookup.writes); }
  void note(std::optional<Cycle> latency) {
    if (latency) edge_latency.record(*latency);
  }

  EdgeLatency& latency_;  // measuring instrument
  const WeightPlaces places_;
  Memory<TouchedWord> touched_;
  ReadPort<TouchedWord> touched_port_{touched_, "lookup"};
  WritePort<TouchedWord> touched_write_{touched_, "lookup"};
  LineCache<BlockWeights> cache_;
  MemoryBase spill_;                     // by entry: valid and tag, stored in spilled_
  std::unique_ptr<WriteBuffer> buffer_;  // with write_buffer > 0
  Fifo<Lookup> fifo_;
  const Activity stalled_spill_;
  std::uint32_t clearing_ = 0;  // U17

  // Stage 2.
  Lookup lookup_{};
  WeightToken waiting_{};         // the candidates of its group in the other block
  std::uint32_t touched_at_ = 0;  // U16, address of its touched bit's word
  bool looking_ = false;
  Cycle looked_ = 0;
  // Stages 3 to 5.
  Pipe<Work, 3> pipe_;
  std::vector<std::uint32_t> spilled_;  // 0: free
  std::uint32_t writes_ = 0;            // U9, unanswered writes
  bool ended_ = false;
};

}  // namespace deburr::rtl::geometric
