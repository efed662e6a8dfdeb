// SPDX-License-Identifier: MIT
// Filters four texels per cycle to the colour of a fragment.
//
// Position  TextureCache -> FilterPipeline.
// Latency   Stages 6 and 7 collect the requests of a sample and of a fragment, so a colour leaves
//           after the last request of its fragment.
// Interval  One request per cycle; above width 1 one group of requests, of which several can end a
//           fragment: their colours leave in one beat.
// Stalls    downstream  The whole pipeline stalls.
// Method    Stage 1 splits a texel into fields, the addresses of ROM `srgb`. Stage 2 reads it, and
//           the weight of the sample from ROM `weights` by N and i, with `kernel = axis` also by
//           kernel (`box` with N a power of two: 256 >> lb N, no ROM). Weights sum to 256, so no
//           division is needed. With `blend = level` stages 6 and 7 swap their factors: 6 sums the
//           samples of a level, 7 the levels. The model computes stages 2 to 5 in stage 2, then
//           delays.
// Source    Paper 2.3; weights and codes are ours.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/histogram.h"
#include "rtl_model/fabric/latency_probe.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/tokens.h"
#include "rtl_model/texture/width.h"
#include "spec/texture/packets.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

// The part that does not depend on the width.
class FilterPipelineBase : public Unit {
 public:
  static constexpr int kStages = 9;  // stage 9 only with `encoded`
  Out<spec::texture::ColourGroup> colours_out{"colours_out"};
  Counter fragments{"fragments", "fragments", "colours delivered"};
  Histogram fragment_latency{"fragment_latency", "clk",
                             "cycles from taking a quad to delivering one of its colours"};
  // Cycles in which a stage held a token.
  std::array<Counter, kStages> occupancy{
      Counter{"stage_1", "clk", "cycles with a request in stage 1, fields"},
      Counter{"stage_2", "clk", "cycles with a request in stage 2, unpack"},
      Counter{"stage_3", "clk", "cycles with a request in stage 3, products"},
      Counter{"stage_4", "clk", "cycles with a request in stage 4, sums"},
      Counter{"stage_5", "clk", "cycles with a request in stage 5, vertical lerp"},
      Counter{"stage_6", "clk", "cycles with a request in stage 6, level lerp"},
      Counter{"stage_7", "clk", "cycles with a sample in stage 7, accumulate"},
      Counter{"stage_8", "clk", "cycles with a fragment in stage 8, round"},
      Counter{"stage_9", "clk", "cycles with a fragment in stage 9, encode"}};

 protected:
  using Unit::Unit;
};

template <class Width>
class FilterPipelineOf : public FilterPipelineBase {
 public:
  In<typename Width::TexelQuads> texels_in{"texels_in"};

  FilterPipelineOf(const sc_core::sc_module_name& name, ClockDomain& clock,
                   const spec::texture::Configuration& configuration, LatencyProbe& probe,
                   std::int32_t width = 1);
  Activity tick(Cycle cycle) override;
  void reset() override;

  static Datasheet datasheet(const spec::texture::Parameters& parameters);

 private:
  // R, G, B and A. The model packs two channels per word so that one multiplication handles both;
  // no channel needs more than 32 bits.
  struct Channels {
    static constexpr std::uint64_t kBoth = 0x1'0000'0001;
    std::uint64_t rb, ga;  // R and G in the low halves

    static constexpr Channels of(std::uint32_t r, std::uint32_t g, std::uint32_t b,
                                 std::uint32_t a) {
      return {r | std::uint64_t{b} << 32, g | std::uint64_t{a} << 32};
    }
    constexpr std::array<std::uint32_t, 4> each() const {
      return {static_cast<std::uint32_t>(rb), static_cast<std::uint32_t>(ga),
              static_cast<std::uint32_t>(rb >> 32), static_cast<std::uint32_t>(ga >> 32)};
    }
    friend constexpr Channels operator+(const Channels& x, const Channels& y) {
      return {x.rb + y.rb, x.ga + y.ga};
    }
    friend constexpr Channels operator*(const Channels& x, std::uint32_t weight) {
      return {x.rb * weight, x.ga * weight};
    }
    // Rounds off the low `drop` >= 1 bits.
    constexpr Channels rounded(unsigned drop) const {
      const std::uint64_t half = kBoth << (drop - 1), kept = kBoth * (0xFFFF'FFFFU >> drop);
      return {(rb + half) >> drop & kept, (ga + half) >> drop & kept};
    }
  };
  // A request in stages 1 to 6.
  struct Request {
    TexelQuadToken token;
    std::uint32_t weight;  // U1.8, weight of the sample, from stage 2 on
    Channels row;          // U8.12, after stage 5
  };
  // A sample; with `blend = level` a level.
  struct Sample {
    Ticket ticket;
    std::uint32_t weight;  // U1.8
    std::uint8_t format;
    bool last_of_fragment;
    Channels value;  // U8.12; with `blend = level` U8.20
  };
  struct Total {
    Ticket ticket;
    std::uint8_t format;
    Channels value;  // U8.20
  };
  static constexpr int kRequestStages = 6;

  // `lane`: number of a request in its group, of a colour in a beat.
  [[gnu::always_inline]] void look_up(Cycle cycle, const TexelQuadToken& token, std::size_t lane);
  [[gnu::always_inline]] std::uint32_t weight(Cycle cycle, const TexelQuadToken& token,
                                              std::size_t lane) const;
  [[gnu::always_inline]] void filter(Cycle cycle, Request& request, std::size_t lane) const;
  [[gnu::noinline]] void filter_other(Cycle cycle, Request& request, std::size_t lane) const;
  template <class Unpack>
  static void lerp(Request& request, Unpack&& unpack);
  [[gnu::always_inline]] static void lerp_bytes(Request& request);
  Channels unpack_srgb(Cycle cycle, const TexelQuadToken& token, std::size_t texel,
                       std::size_t lane) const;
  [[gnu::always_inline]] void lerp_levels(const Request& request);
  [[gnu::always_inline]] void accumulate(const Sample& sample);
  [[gnu::noinline]] void sum_level(const Request& request);
  [[gnu::noinline]] void blend_level(const Sample& sample);
  [[gnu::always_inline]] void round(Cycle cycle);
  void encode(Cycle cycle);
  [[gnu::always_inline]] spec::texture::ColourGroup& begin_beat(Cycle cycle, std::uint8_t colours);
  [[gnu::always_inline]] void deliver(Cycle cycle, spec::texture::Colour& colour,
                                      const Ticket& ticket,
                                      const std::array<std::uint32_t, 4>& rgba);
  [[gnu::always_inline]] bool coded(const Total& total) const;
  [[gnu::always_inline]] void count_stages(bool arrives);

  const bool by_level_;  // `blend = level`
  LatencyProbe& probe_;
  Memory<std::uint16_t> srgb_;
  std::vector<ReadPort<std::uint16_t>> linear_;  // 12 x lane + 3 x texel + channel
  // Tables that only some configurations need: weights at 16 (N - 1) + i, codes by U8.4 light.
  std::unique_ptr<Memory<std::uint16_t>> weights_;
  std::unique_ptr<Memory<std::uint8_t>> codes_;
  std::vector<ReadPort<std::uint16_t>> weight_reads_;  // by lane
  std::vector<std::uint16_t> weight_words_;            // content, for lanes above 0
  std::vector<ReadPort<std::uint8_t>> code_reads_;     // 3 x lane + channel: R, G, B
  // Registers after each stage; stage 8 (with `encoded` stage 9) writes the output link.
  Pipe<typename Width::template Fragments<Request>, kRequestStages> requests_;
  Channels level_sum_{};  // U8.20, over the levels of the current sample, or over the samples of
                          // the current level
  Some<Sample, Width::kMost> samples_;
  Channels kernel_sum_{};                     // U8.20, over the samples of the current fragment
  std::array<std::uint64_t, 4> blend_sum_{};  // U8.28, over its levels, with `blend = level`
  Some<Total, Width::kMost> totals_;
  Some<Total, Width::kMost> rounded_;  // U8.0; channels to be encoded U8.4
};

class FilterPipeline final : public FilterPipelineOf<Narrow> {
 public:
  using FilterPipelineOf::FilterPipelineOf;
};
namespace wide {
class FilterPipeline final : public FilterPipelineOf<Wide> {
 public:
  using FilterPipelineOf::FilterPipelineOf;
};
}  // namespace wide

}  // namespace deburr::rtl::texture
