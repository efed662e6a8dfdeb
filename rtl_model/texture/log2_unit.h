// SPDX-License-Identifier: MIT
// Computes the binary logarithms of both sides of the footprint, or of the longer side and of the
// area: leading-one position plus the bits below it, corrected by rule.
//
// Position  FootprintUnit or AxisUnit -> Log2Unit -> LevelUnit.
// Stalls    downstream  The whole unit stalls.
// Accuracy  The fraction is truncated. Largest error: 0.0864, 0.0228, 0.0057, 0.0006 for mitchell,
//           corrected, segments, exact (TextureRtlLog2.ErrorIsAsDocumented).
// Source    Paper 1.4, equation 13.
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
#include "rtl_model/texture/width.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

template <class Width>
class Log2UnitOf : public Unit {
 public:
  In<typename Width::template Fragments<FootprintToken>> footprints_in{"footprints_in"};
  Out<typename Width::template Fragments<Log2Token>> logs_out{"logs_out"};

  Log2UnitOf(const sc_core::sc_module_name& name, ClockDomain& clock, spec::texture::Log2Rule rule,
             std::int32_t fragments = 1);
  Activity tick(Cycle cycle) override;
  void reset() override { pipe_.reset(); }

  // All stages at once: lb d in S5.12 for d in U31.16.
  static std::int32_t log2(spec::texture::Log2Rule rule, std::uint64_t d);

  static Datasheet datasheet(const spec::texture::Parameters& parameters);

 private:
  static constexpr int kStages = 3;
  static constexpr std::size_t kReads = 4;  // per fragment
  // d = 2^n (1 + y).
  struct Normal {
    std::int32_t n;   // S5
    std::uint32_t y;  // U0.12
  };
  // Adjacent entries of the table, U1.12.
  struct Chord {
    std::uint32_t low, high;
  };
  struct Entry {
    FootprintToken token;
    Normal longer, shorter;
    Chord longer_chord, shorter_chord;  // `exact` only
  };
  static Normal normalise(std::uint64_t d);
  static std::int32_t correct(spec::texture::Log2Rule rule, Normal d, Chord chord);
  Activity tick_mitchell(Cycle cycle);
  void look_up(Cycle cycle, const Entry& entry, std::size_t port);
  void fetch(Cycle cycle, Entry& entry, std::size_t port);
  Log2Token correct_both(const Entry& entry) const;

  spec::texture::Log2Rule rule_;
  Pipe<typename Width::template Fragments<Entry>, kStages> pipe_;
  std::size_t fragments_;
  std::unique_ptr<Memory<std::uint16_t>> table_;  // `exact` only
  std::vector<ReadPort<std::uint16_t>>
      reads_;  // per fragment low and high entry for the longer, then for the shorter side
};

class Log2Unit final : public Log2UnitOf<Narrow> {
 public:
  using Log2UnitOf::Log2UnitOf;
};
namespace wide {
class Log2Unit final : public Log2UnitOf<Wide> {
 public:
  using Log2UnitOf::Log2UnitOf;
};
}  // namespace wide

}  // namespace deburr::rtl::texture
