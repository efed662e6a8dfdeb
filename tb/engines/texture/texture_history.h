// SPDX-License-Identifier: MIT
// History of one pixel in the texture unit: decisions of the golden model side by side with values
// observed on the unit's links and at its tags (docs/reference/run.md, "One pixel").
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "golden/texture/texture_golden.h"
#include "rtl_model/texture/texture_unit.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/packets.h"
#include "tb/harness/monitor.h"
#include "tb/run/pixel_history.h"
#include "tb/traces/fragment_trace.h"

namespace deburr::tb {

class TextureHistory {
 public:
  // `quads` and `colours`: the unit's input and output links. All arguments must outlive it.
  TextureHistory(rtl::ClockDomain& clock, rtl::texture::TextureUnit& unit,
                 const rtl::Link<spec::texture::Quad>& quads,
                 const rtl::Link<spec::texture::ColourGroup>& colours, const PixelAddress& pixel);
  TextureHistory(const TextureHistory&) = delete;
  TextureHistory& operator=(const TextureHistory&) = delete;

  void clear();
  // Records a quad that is sent; returns whether one of its lanes covers the pixel.
  bool send(const traces::TracedQuad& quad);
  // Runs the golden model on the quad; call it instead of golden.process(quad) after send()
  // returned true.
  golden::texture::QuadColours expect(const traces::TracedQuad& quad,
                                      golden::texture::TextureGolden& golden);
  // `ended`: the frame is complete, so nothing more will be observed. `all_sent`: every quad was
  // sent.
  PixelHistory history(bool ended, bool all_sent) const;

 private:
  // A value carried by a link, and the cycle of its push.
  template <class T>
  using Seen = std::optional<std::pair<T, rtl::Cycle>>;
  template <class T>
  using AllSeen = std::vector<std::pair<T, rtl::Cycle>>;
  struct LookedUp {
    rtl::Cycle cycle;
    std::uint32_t line;
    rtl::texture::LookUp outcome;
  };
  struct Fragment {
    traces::TracedQuad quad;
    int lane = 0;
    bool golden = false;
    golden::texture::FragmentAnalysis analysis{};
    std::vector<golden::texture::BilinearRequest> requests{};
    std::array<std::uint8_t, 4> colour{};
    // With decode = before lines are blocks: their bytes, and the number above their own.
    std::uint32_t block_bytes = 0, codec = 0;

    std::optional<rtl::Cycle> taken{};
    Seen<rtl::texture::DerivativeToken> derivative{};
    Seen<rtl::texture::FootprintToken> footprint{};
    Seen<rtl::texture::Log2Token> log2{};
    Seen<rtl::texture::LevelToken> level{};
    AllSeen<rtl::texture::SampleToken> samples{};
    AllSeen<rtl::texture::TexelToken> texels{};
    AllSeen<std::vector<LookedUp>> lookups{};  // per request
    AllSeen<rtl::texture::TexelQuadToken> data{};
    AllSeen<spec::texture::Colour> delivered{};  // one, if the unit is correct
  };
  class Writer;

  int lane_of(const traces::TracedQuad& quad) const;  // -1 if none
  Fragment* find(std::uint32_t tag, int lane);
  template <class T>
  void see(rtl::ClockDomain& clock, const rtl::texture::TextureUnit& unit, const char* link,
           Seen<T> Fragment::*where);
  template <class Group, class T>
  void see_all(rtl::ClockDomain& clock, const rtl::texture::TextureUnit& unit, const char* link,
               AllSeen<T> Fragment::*where);

  PixelAddress pixel_;
  std::uint32_t line_bytes_;
  bool two_axes_;
  std::vector<Fragment> fragments_;
  std::vector<LookedUp> looked_up_;  // lookups of the last cycle that had any
  std::vector<std::unique_ptr<rtl::Clocked>> monitors_;
};

}  // namespace deburr::tb
