// SPDX-License-Identifier: MIT
// Function  Fetches the data for the resolve of a touched block: its weights, from the cache or
//           from memory, and the colour lines that hold its blended pixels and their neighbours.
// Position  Between BlockScanner and Resolver, which takes the lines from the ColourStore.
// Stalls    `weights` (a block has not arrived), `colours` (no entry for a line), `downstream`.
//
// Weights and colours have separate entries, so weights of later blocks cannot take those of the
// lines for which the oldest block waits. A line kept in the ColourStore is not requested. Colour
// requests have priority over weight requests. Whatever weights are read from memory, a pixel takes
// at most half of each neighbour and nothing from outside the frame.
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/fifo.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/geometric/common/fill_store.h"
#include "rtl_model/geometric/common/frame_configuration.h"
#include "rtl_model/geometric/common/memory_arbiter.h"
#include "rtl_model/geometric/common/tokens.h"
#include "rtl_model/geometric/resolve/colour_store.h"
#include "rtl_model/geometric/weights/weight_memories.h"

namespace deburr::rtl::geometric {

class BlockFetch final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  WireIn<Phase> phase_in{"phase_in"};
  In<TouchedBlock> blocks_in{"blocks_in"};
  Out<BlockToken> blocks_out{"blocks_out"};
  MemoryClient memory;

  BlockFetch(const sc_core::sc_module_name& name, ClockDomain& clock,
             const spec::geometric::Parameters& parameters, const ReadPort<std::uint32_t>& tags,
             const ReadPort<BlockWeights>& weights, const ColourStore::Filler& colours);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter weights_read{"weights_read", "lines", "blocks of weights read from memory"};
  Counter lines_read{"lines_read", "lines", "lines of colours read, of the frame or its copy"};
  Counter lines_kept{"lines_kept", "lines", "lines of colours that were kept and not read again"};
  Counter lines_replaced{"lines_replaced", "lines", "lines read that replaced a kept line"};

  static Datasheet datasheet(const spec::geometric::Parameters& parameters = {});

 private:
  struct Lookup {
    TouchedBlock block;
    std::uint16_t index;  // U10
    bool cached;
    template <class Self, class Visit>
    static constexpr void fields(Self& self, Visit&& visit) {
      visit("block", self.block);
      visit("index", self.index, 10, "U10");
      visit("cached", self.cached);
    }
  };
  Activity look_up(Cycle cycle);
  Activity deliver(Cycle cycle);
  Activity ask(Cycle cycle);
  Activity ask_for_line(Cycle cycle);
  static void choose(const FrameConfiguration& configuration, BlockToken& block);
  static void limit(const FrameConfiguration& configuration, BlockToken& block);
  static std::uint32_t lines_of_pixel(bool tiled, const BlockToken& block, std::uint32_t pixel,
                                      bool horizontal);

  const bool keeps_lines_;
  const WeightPlaces places_;
  ReadPort<std::uint32_t> tag_port_;
  ReadPort<BlockWeights> data_port_;
  FillStore<BlockWeights> weights_;
  ColourStore::Filler colours_;
  Fifo<Lookup> fifo_;
  Activity stalled_weights_, stalled_colours_;

  TouchedBlock block_{};  // stage 2
  bool looking_ = false;
  Cycle looked_ = 0;
  Lookup fetched_{};  // stage 4
  BlockToken token_{};
  bool is_fetched_ = false;
  BlockToken asking_{};  // stage 5
  std::uint32_t to_ask_ = 0;
  bool is_asking_ = false, handed_ = false;
};

}  // namespace deburr::rtl::geometric
