// SPDX-License-Identifier: MIT
// Binary logarithms of the two sides of the footprint, or of the longer one and of the area:
// leading one plus the bits below it, and a correction by rule.
//
// Where: after the FootprintUnit or the AxisUnit. Stalled by `downstream`, and then holds still as
// a whole. The fraction is truncated. Largest error: 0.0864, 0.0228, 0.0057, 0.0006
// (TextureRtlLog2.ErrorIsAsDocumented). Source: paper 1.4, equation 13.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class Log2Unit final : public Unit {
 public:
  In<FootprintToken> footprints_in{"footprints_in"};
  Out<Log2Token> logs_out{"logs_out"};

  Log2Unit(const sc_core::sc_module_name& name, ClockDomain& clock, spec::texture::Log2Rule rule);
  Activity tick(Cycle cycle) override;
  void reset() override { pipe_.reset(); }

  // All stages at once: lb d in S5.12 of d in U31.16.
  static std::int32_t log2(spec::texture::Log2Rule rule, std::uint64_t d);

  static Datasheet datasheet(const spec::texture::Parameters& parameters);

 private:
  static constexpr int kStages = 3;
  // d as a power of two and what is left of it.
  struct Normal {
    std::int32_t n;   // S5
    std::uint32_t y;  // U0.12
  };
  // Neighbouring entries of the table, U1.12.
  struct Chord {
    std::uint32_t low, high;
  };
  struct Entry {
    FootprintToken token;
    Normal longer, shorter;
    Chord longer_chord, shorter_chord;  // `exact` alone
  };
  static Normal normalise(std::uint64_t d);
  static std::int32_t correct(spec::texture::Log2Rule rule, Normal d, Chord chord);
  Activity tick_mitchell(Cycle cycle);
  void look_up(Cycle cycle, const Entry& entry);
  void fetch(Cycle cycle, Entry& entry);
  Log2Token correct_both(const Entry& entry) const;

  spec::texture::Log2Rule rule_;
  Pipe<Entry, kStages> pipe_;
  std::unique_ptr<Memory<std::uint16_t>> table_;  // `exact` alone
  std::vector<ReadPort<std::uint16_t>> reads_;    // low and high of the longer, of the shorter side
};

}  // namespace deburr::rtl::texture
