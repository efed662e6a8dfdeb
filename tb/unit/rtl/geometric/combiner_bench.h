// SPDX-License-Identifier: MIT
// The WeightCombiner on its own, with memory. Its only outputs are memory accesses.
#pragma once

#include "rtl_model/geometric/common/sizing.h"
#include "rtl_model/geometric/weights/weight_combiner.h"
#include "tb/unit/rtl/geometric/parts.h"

namespace deburr::tb::geometric_rtl {

struct CombinerBench : Frame {
  explicit CombinerBench(const Parameters& p = {}, std::uint32_t latency = 20)
      : Frame(p, latency),
        unit("unit", clock, rtl::geometric::sized(p, {}), edge_latency),
        in("in"),
        source("source", clock) {
    arbiter.connect(rtl::geometric::Client::kWeights, unit.memory);
    unit.configuration_in(configuration);
    unit.weights_in(in);
    source.out(in);
    unit.phase_in(phase);
    wire(unit.cleared_out, &sequencer.weights_cleared_in);
    drawn = &wire(unit.drawn_out);
    bus.write(reg::kWeightBase, 0);
    begin(2048, 16);
  }
  static rtl::geometric::WeightToken token(int bx, int by) {
    rtl::geometric::WeightToken t{};
    t.block_x = static_cast<std::uint16_t>(bx);
    t.block_y = static_cast<std::uint16_t>(by);
    t.candidates = 1;
    t.coverage[0] = 100;
    return t;
  }
  static rtl::geometric::WeightToken end() {
    rtl::geometric::WeightToken t{};
    t.end = true;
    return t;
  }
  Cycle until_drawn() {
    const Cycle from = clock.cycle();
    while (!drawn->read(clock.cycle())) clock.run(1);
    return clock.cycle() - from;
  }
  rtl::geometric::WeightCombiner unit;
  const rtl::Wire<bool>* drawn = nullptr;
  rtl::Link<rtl::geometric::WeightToken> in;
  Source<rtl::geometric::WeightToken> source;
};
// The weights of pixel (x, y); its block must have left the cache.
inline spec::geometric::Weights weights_at(CombinerBench& b, int x, int y) {
  const std::vector<std::uint8_t> bytes = b.memory.dump(
      static_cast<std::uint64_t>(64 * (y / 4 * 512 + x / 4) + 4 * (y % 4 * 4 + x % 4)), 4);
  return {bytes[0], bytes[1], bytes[2], bytes[3]};
}

}  // namespace deburr::tb::geometric_rtl
