// SPDX-License-Identifier: MIT
// Computes the byte addresses of a sample's four texels and its bilinear fractions.
//
// Position  SampleWalker -> TexelAddresser; last unit of the AddressUnit.
// Stalls    downstream  The whole unit stalls.
// Method    Address = base + column part + row part, so four texels need two column parts, two row
//           parts and four three-input adders; sums wrap. The model reads the parts from the
//           tables of the level, computes everything in stage 1, then delays.
// Source    Paper 2.2 (3) and (4); layouts are ours.
#pragma once

#include <cstdint>
#include <optional>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/descriptors.h"
#include "rtl_model/texture/tokens.h"
#include "rtl_model/texture/width.h"
#include "spec/texture/descriptor.h"

namespace deburr::rtl::texture {

// The part that does not depend on the width.
class TexelAddresserBase : public Unit {
 public:
  Counter bilinears{"bilinears", "requests", "bilinear requests sent to the cache"};

 protected:
  using Unit::Unit;
};

template <class Width>
class TexelAddresserOf : public TexelAddresserBase {
 public:
  In<typename Width::template Requests<SampleToken>> samples_in{"samples_in"};
  Out<typename Width::template Requests<TexelToken>> texels_out{"texels_out"};

  // `younger`: for a second quad in a group; not built at width 1.
  TexelAddresserOf(const sc_core::sc_module_name& name, ClockDomain& clock,
                   const Descriptors::Reader& descriptors,
                   const std::optional<Descriptors::Reader>& younger = {});
  Activity tick(Cycle cycle) override;
  void reset() override { pipe_.reset(); }

  static Datasheet datasheet(const spec::texture::Parameters& parameters = {});

 private:
  static constexpr int kStages = 5;
  // Two adjacent texels along one axis.
  struct Axis {
    std::uint32_t first, second;  // U12, in range
    std::uint8_t fraction;        // U0.8
  };
  [[gnu::always_inline]] void enter(Cycle cycle,
                                    const typename Width::template Requests<SampleToken>& samples);
  [[gnu::always_inline]] void request(const TextureState& texture, const SampleToken& sample,
                                      TexelToken& texels);
  static Axis scale(std::int64_t position, std::int32_t size, spec::texture::Wrap wrap,
                    bool linear);

  Descriptors::Reader descriptors_;
  std::optional<Descriptors::Reader> younger_;
  Pipe<typename Width::template Requests<TexelToken>, kStages> pipe_;
};

class TexelAddresser final : public TexelAddresserOf<Narrow> {
 public:
  using TexelAddresserOf::TexelAddresserOf;
};
namespace wide {
class TexelAddresser final : public TexelAddresserOf<Wide> {
 public:
  using TexelAddresserOf::TexelAddresserOf;
};
}  // namespace wide

}  // namespace deburr::rtl::texture
