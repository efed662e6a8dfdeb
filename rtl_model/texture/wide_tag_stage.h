// SPDX-License-Identifier: MIT
// The TagStage of a wide build: looks up the lines of a group, allocates those that miss, and sends
// them to the MissQueue.
//
// Position  GroupFormer -> WideTagStage -> WideLatencyFifo and MissQueue.
// Interval  1 if the group misses at most A lines: max(1, misses / A) cycles.
// Order     Every use of a line by a request counts, in the order of the requests, so replacement
//           is that of width 1. All lookups of a group are made in its first cycle in stage 2;
//           nothing sees the tags before its last one, in which the lookups are counted.
// Stalls    allocate         More lines to allocate.
//           miss_queue_full  The group misses and the MissQueue is not ready.
//           fifo_full        The LatencyFifo is full.
// Output    `stall_out`, a register, names the stall of the previous cycle; for a full FIFO the one
//           that `stall_in` reports of the DataStage two cycles ago.
// Source    Igehy, Eldridge, Proudfoot, "Prefetching in a texture cache architecture", 1998.
#pragma once

#include <array>
#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/texture/cache_units.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class WideTagStage final : public TagUnit {
 public:
  In<LineGroup> groups_in{"groups_in"};
  Out<CacheGroup> requests_out{"requests_out"};
  Out<MissToken> misses_out{"misses_out"};
  WireIn<std::uint8_t> lines_used_in{"lines_used_in"};  // fills that the DataStage has used
  WireIn<SlotStall> stall_in{"stall_in"};
  WireOut<SlotStall> stall_out{"stall_out"};

  WideTagStage(const sc_core::sc_module_name& name, ClockDomain& clock,
               const spec::texture::Parameters& parameters);
  Activity tick(Cycle cycle) override;
  void reset() override;

  static Datasheet datasheet(const spec::texture::Parameters& parameters = {});

 private:
  Activity work(Cycle cycle, SlotStall& stall);
  void read_sets(Cycle cycle);
  void look_up(Cycle cycle);
  [[gnu::noinline]] void allocate(std::size_t k);
  void count_uses(Cycle cycle);
  template <class Use>
  static void each_use(const GroupRequest& request, const Use& use);
  void report_uses(Cycle cycle) const;

  // A line of the group.
  struct Line {
    std::uint32_t number, slot;
    std::uint32_t uses;  // by requests
    std::uint64_t fill;  // number of its fill
  };

  std::uint32_t allocations_, set_log2_, way_mask_, ways_log2_;
  Activity allocate_;
  // Registers of the group in stage 2; its requests are in `out_`.
  std::array<Line, spec::texture::kMostLookups> lines_{};
  bool occupied_ = false, looked_up_ = false;
  CacheGroup out_{};
  MissToken missed_{};
  std::uint32_t left_ = 0;            // further cycles of allocation
  Cycle read_at_ = 0;                 // check only, no hardware
  std::uint32_t valid_requests_ = 0;  // counter only
};

}  // namespace deburr::rtl::texture
