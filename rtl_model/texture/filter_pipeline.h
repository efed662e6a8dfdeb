// SPDX-License-Identifier: MIT
// Filters four texels a clock to the colour of a fragment.
//
// Where: after the TextureCache. Stages 6 and 7 wait for the requests that belong together, so a
// colour leaves after the last request of its fragment. Stage 1 cuts a texel into its fields, which
// are the addresses of the ROM `srgb`; its words are there in stage 2, and so is the weight of the
// sample, from the ROM `weights` by N and i (`box` with N a power of two: 256 shifted by lb N, no
// ROM). The weights sum to 256, so nothing is divided. The model does stages 2 to 5 in stage 2,
// then delays. When a colour cannot leave (`downstream`), the whole pipeline holds still. Source:
// paper 2.3; weights and codes are ours.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/histogram.h"
#include "rtl_model/fabric/latency_probe.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/packets.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class FilterPipeline final : public Unit {
 public:
  static constexpr int kStages = 9;  // the last with `encoded` alone

  In<TexelQuadToken> texels_in{"texels_in"};
  Out<spec::texture::Colour> colours_out{"colours_out"};

  FilterPipeline(const sc_core::sc_module_name& name, ClockDomain& clock,
                 const spec::texture::Configuration& configuration, LatencyProbe& probe);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter fragments{"fragments", "fragments", "colours delivered"};
  Histogram fragment_latency{"fragment_latency", "clk",
                             "from a quad being taken to a colour of it being delivered"};
  // Cycles in which a stage had a token to work on.
  std::array<Counter, kStages> occupancy;

  static Datasheet datasheet(const spec::texture::Parameters& parameters);

 private:
  // R, G, B and A. The model keeps two channels in a word, so that one of its multiplications does
  // the work of two: no channel ever needs more than 32 bits.
  struct Channels {
    static constexpr std::uint64_t kBoth = 0x1'0000'0001;
    std::uint64_t rb, ga;  // R and G in the low halves

    static constexpr Channels of(std::uint32_t r, std::uint32_t g, std::uint32_t b,
                                 std::uint32_t a) {
      return {r | std::uint64_t{b} << 32, g | std::uint64_t{a} << 32};
    }
    // `of` of the bytes of an RGBA8 texel.
    static constexpr Channels of_bytes(std::uint64_t rgba) {
      constexpr std::uint64_t kBytes = kBoth * 0xFF;
      return {(rgba | rgba << 16) & kBytes, (rgba >> 8 | rgba << 8) & kBytes};
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
    // Rounds `drop` bits off, at least one.
    constexpr Channels rounded(unsigned drop) const {
      const std::uint64_t half = kBoth << (drop - 1), kept = kBoth * (0xFFFF'FFFFU >> drop);
      return {(rb + half) >> drop & kept, (ga + half) >> drop & kept};
    }
  };
  // A request in stages 1 to 6.
  struct Request {
    TexelQuadToken token;
    std::uint32_t weight;  // U1.8, of its sample, from stage 2 on
    Channels row;          // U8.12, after stage 5
  };
  struct Sample {
    Ticket ticket;
    std::uint32_t weight;  // U1.8
    std::uint8_t format;
    bool last_of_fragment;
    Channels value;  // U8.12
  };
  struct Total {
    Ticket ticket;
    std::uint8_t format;
    Channels value;  // U8.20
  };
  static constexpr int kRequestStages = 6;

  void look_up(Cycle cycle, const TexelQuadToken& token);
  std::uint32_t weight(Cycle cycle, const TexelQuadToken& token) const;
  void filter(Cycle cycle, Request& request) const;
  [[gnu::noinline]] void filter_other(Cycle cycle, Request& request) const;
  template <unsigned kFractionBits, class Unpack>
  static void lerp(Request& request, Unpack&& unpack);
  Channels unpack_srgb(Cycle cycle, const TexelQuadToken& token, std::size_t texel) const;
  void lerp_levels(const Request& request);
  void accumulate();
  void round(Cycle cycle);
  void encode(Cycle cycle);
  void deliver(Cycle cycle, const Ticket& ticket, const std::array<std::uint32_t, 4>& rgba);
  bool coded(const Total& total) const;
  void count_stages(bool arrives);

  LatencyProbe& probe_;
  Memory<std::uint16_t> srgb_;
  std::vector<ReadPort<std::uint16_t>> linear_;  // 3 x texel + channel
  // Tables that not every rule needs: weights by 16 (N - 1) + i, and codes by U8.4 light.
  std::unique_ptr<Memory<std::uint16_t>> weights_;
  std::unique_ptr<Memory<std::uint8_t>> codes_;
  std::optional<ReadPort<std::uint16_t>> weight_read_;
  std::vector<ReadPort<std::uint8_t>> code_reads_;  // R, G, B
  // The registers after each stage; stage 8 writes the output link, or with `encoded` stage 9.
  Pipe<Request, kRequestStages> requests_;
  Channels level_sum_{};  // U8.20, of the levels of the sample in hand
  Sample sample_{};
  bool has_sample_ = false;
  Channels kernel_sum_{};  // U8.20, of the samples of the fragment in hand
  Total total_{};
  bool has_total_ = false;
  Total rounded_{};  // U8.0, what leaves as codes U8.4
  bool has_rounded_ = false;
};

}  // namespace deburr::rtl::texture
