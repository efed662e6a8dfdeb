// SPDX-License-Identifier: MIT
// The resolve on its own, from the WeightCombiner on, with memory.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "rtl_model/geometric/common/sizing.h"
#include "rtl_model/geometric/resolve/block_fetch.h"
#include "rtl_model/geometric/resolve/block_scanner.h"
#include "rtl_model/geometric/resolve/colour_store.h"
#include "rtl_model/geometric/resolve/resolver.h"
#include "rtl_model/geometric/weights/weight_combiner.h"
#include "tb/unit/rtl/geometric/parts.h"

namespace deburr::tb::geometric_rtl {

// The test sends groups to the combiner.
struct ResolveBench : Frame {
  explicit ResolveBench(const Parameters& p = {}, int width = 1024, int height = 64,
                        std::uint32_t latency = 20)
      : Frame(p, latency),
        combiner("combiner", clock, rtl::geometric::sized(p, {}), edge_latency),
        scanner("scanner", clock, p, combiner.touched_port()),
        colour_store(rtl::geometric::sized(p, {})),
        fetch("fetch", clock, rtl::geometric::sized(p, {}), combiner.tag_port(),
              combiner.data_port(), colour_store.filler()),
        resolver("resolver", clock, p, colour_store.reader()),
        weights("weights"),
        touched("touched"),
        blocks("blocks", 16),
        source("source", clock) {
    arbiter.connect(rtl::geometric::Client::kWeights, combiner.memory);
    arbiter.connect(rtl::geometric::Client::kBlocks, fetch.memory);
    arbiter.connect(rtl::geometric::Client::kResolve, resolver.memory);
    source.out(weights);
    combiner.configuration_in(configuration);
    scanner.configuration_in(configuration);
    fetch.configuration_in(configuration);
    resolver.configuration_in(configuration);
    combiner.weights_in(weights);
    scanner.blocks_out(touched);
    fetch.blocks_in(touched);
    fetch.blocks_out(blocks);
    resolver.blocks_in(blocks);
    for (rtl::WireIn<rtl::geometric::Phase>* const in :
         {&combiner.phase_in, &scanner.phase_in, &fetch.phase_in, &resolver.phase_in})
      (*in)(phase);
    wire(combiner.cleared_out, &sequencer.weights_cleared_in);
    wire(combiner.drawn_out, &sequencer.drawn_in);
    sequencer.copied_in(high);
    wire(resolver.resolved_out, &sequencer.resolved_in);
    bus.write(reg::kColourBase, 0x40000);
    bus.write(reg::kWeightBase, 0x80000);
    begin(width, height);
    resolver.observer = [this](const spec::geometric::BlockRecord& block) {
      resolved.push_back(block);
    };
  }
  // Sends a block in which these pixels take from above or, if vertical, from the left; with
  // `forward` from below or from the right.
  void touch(int bx, int by, std::uint16_t pixels, bool vertical = false, bool forward = false) {
    for (std::uint32_t left = pixels; left != 0; left &= left - 1) {
      rtl::geometric::WeightToken t{};
      t.block_x = static_cast<std::uint16_t>(bx);
      t.block_y = static_cast<std::uint16_t>(by);
      t.vertical = vertical;
      t.candidates = 1;
      t.forward = forward;
      t.place[0] = static_cast<std::uint8_t>(std::countr_zero(left));
      t.coverage[0] = 128;
      source.add(t);
    }
  }
  // Draws, and records the cycles in which each link got its beats.
  void run() {
    rtl::geometric::WeightToken last{};
    last.end = true;
    source.add(last);
    while (phase.read(clock.cycle()) != rtl::geometric::Phase::kResolve) clock.run(1);
    if (before_resolve) before_resolve();
    resolve_from = clock.cycle();
    const std::uint64_t sent = arbiter.requests_out.link().pushes();
    while (!sequencer.idle()) {
      if (before_cycle) before_cycle();
      clock.run(1);
      const Cycle now = clock.cycle();
      const auto note = [&](const char* name, std::uint64_t count) {
        auto& times = at[name];
        while (times.size() < count) times.push_back(now - 1);
      };
      note("touched", touched.pushes());
      note("fetched", touched.pops());
      note("blocks", blocks.pushes());
      note("resolved", blocks.pops());
      note("writes", resolver.lines_written.value());
      note("reads", fetch.lines_read.value());
      note("hits", fetch.lines_kept.value());
      note("requests", arbiter.requests_out.link().pushes() - sent);
    }
  }
  rtl::geometric::WeightCombiner combiner;
  rtl::geometric::BlockScanner scanner;
  rtl::geometric::ColourStore colour_store;
  rtl::geometric::BlockFetch fetch;
  rtl::geometric::Resolver resolver;
  rtl::Link<rtl::geometric::WeightToken> weights;
  rtl::Link<rtl::geometric::TouchedBlock> touched;
  rtl::Link<rtl::geometric::BlockToken> blocks;
  Source<rtl::geometric::WeightToken> source;
  Cycle resolve_from = 0;
  std::function<void()> before_resolve, before_cycle;
  std::map<std::string, std::vector<Cycle>> at;  // cycles of the beats
  std::vector<spec::geometric::BlockRecord> resolved;
};

}  // namespace deburr::tb::geometric_rtl
