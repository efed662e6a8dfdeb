// SPDX-License-Identifier: MIT
// SlotSequencer, LumaUnit and EdgeDetector in sequence: pixels in, edge bits out.
#pragma once

#include <vector>

#include "tb/unit/rtl/morphological/parts.h"

namespace deburr::tb::morphological_rtl {

struct Bits {
  bool left, top;
  friend bool operator==(const Bits&, const Bits&) = default;
};

// Frame in, edge bits out; the configuration may be written before each frame.
struct Front {
  explicit Front(const Parameters& p)
      : lanes(lanes_of(p)),
        registers(p),
        sequencer("sequencer", clock, p, probe),
        luma("luma", clock, p),
        edges("edges", clock, p) {
    registers.join(sequencer);
    luma.configuration_in(registers.configuration);
    edges.configuration_in(registers.configuration);
    driver.beats_out(in);
    sequencer.pixels_in(in);
    sequencer.frames_done_in(done);
    sequencer.slots_out(slots);
    sequencer.beats_out(beats);
    beat_sink.beats_in(beats);
    luma.slots_in(slots);
    luma.lumas_out(lumas);
    edges.lumas_in(lumas);
    edges.edges_out(bits);
    sink.beats_in(bits);
    clock.add(done);
  }
  // Returns the edge bits of each pixel in raster order.
  std::vector<Bits> detect(const Frame& frame, const Parameters* configuration = nullptr) {
    reset_by(clock);
    if (configuration != nullptr) registers.software.set_configuration(*configuration);
    registers.software.set_size(frame.width, frame.height);
    const auto all = beats_of(frame, lanes);
    driver.send([all](std::uint64_t i, spec::morphological::PixelBeat& beat) {
      if (i >= all.size()) return false;
      beat = all[i];
      return true;
    });
    clock.run(static_cast<Cycle>((frame.height + 40) * frame.width + 20));
    std::vector<Bits> found;
    for (const rtl::morphological::EdgeToken& token : sink.beats())
      for (int lane = 0; lane < lanes; ++lane)
        if (token.slot.row >= 1 && token.slot.row <= frame.height &&
            token.slot.beat * lanes + lane < frame.width)
          found.push_back({(token.left >> lane & 1) != 0, (token.top >> lane & 1) != 0});
    return found;
  }

  int lanes;
  ClockDomain clock{"clock", period()};
  WiredRegisters registers;
  rtl::LatencyProbe probe;
  Link<spec::morphological::PixelBeat> in{"in"};
  Link<rtl::morphological::FrameDoneToken> done{"done"};
  Link<rtl::morphological::SlotToken> slots{"slots"};
  Link<rtl::morphological::BeatToken> beats{"beats"};
  Link<rtl::morphological::LumaToken> lumas{"lumas"};
  Link<rtl::morphological::EdgeToken> bits{"bits"};
  Driver<spec::morphological::PixelBeat> driver{"driver", clock};
  rtl::morphological::SlotSequencer sequencer;
  rtl::morphological::LumaUnit luma;
  rtl::morphological::EdgeDetector edges;
  Sink<rtl::morphological::BeatToken> beat_sink{"beat_sink", clock};
  Sink<rtl::morphological::EdgeToken> sink{"sink", clock};
};

inline Frame row(std::initializer_list<int> values) {
  Frame frame(static_cast<int>(values.size()), 1);
  std::size_t i = 0;
  for (const int v : values) frame.pixel[i++] = grey(v);
  return frame;
}

}  // namespace deburr::tb::morphological_rtl
