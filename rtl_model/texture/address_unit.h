// SPDX-License-Identifier: MIT
// Converts quads of texture coordinates to bilinear requests: address calculation module of the
// paper (2.2, figure 4).
//
//     quads_in -> DerivativeUnit -> FootprintUnit -> Log2Unit -> LevelUnit -> SampleWalker
//                                 or AxisUnit      -> TexelAddresser -> texels_out
//
// Structure `axes = four` or `eight` builds the AxisUnit instead of the FootprintUnit. Links with
//           two entries connect the units; above width 1 they carry groups of fragments, then of
//           requests.
// Stalls    downstream
// Source    Paper 2.2, figure 4.
#pragma once

#include <memory>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/link.h"
#include "rtl_model/texture/axis_unit.h"
#include "rtl_model/texture/derivative_unit.h"
#include "rtl_model/texture/descriptors.h"
#include "rtl_model/texture/footprint_unit.h"
#include "rtl_model/texture/level_unit.h"
#include "rtl_model/texture/log2_unit.h"
#include "rtl_model/texture/sample_walker.h"
#include "rtl_model/texture/texel_addresser.h"

namespace deburr::rtl::texture {

template <class Width>
class AddressUnitOf : public sc_core::sc_module {
  using DerivativeUnit = Built<Width, texture::DerivativeUnit, wide::DerivativeUnit>;
  using FootprintUnit = Built<Width, texture::FootprintUnit, wide::FootprintUnit>;
  using AxisUnit = Built<Width, texture::AxisUnit, wide::AxisUnit>;
  using Log2Unit = Built<Width, texture::Log2Unit, wide::Log2Unit>;
  using LevelUnit = Built<Width, texture::LevelUnit, wide::LevelUnit>;
  using SampleWalker = Built<Width, texture::SampleWalker, wide::SampleWalker>;
  using TexelAddresser = Built<Width, texture::TexelAddresser, wide::TexelAddresser>;

 public:
  In<spec::texture::Quad> quads_in{"quads_in"};
  Out<typename Width::template Requests<TexelToken>> texels_out{"texels_out"};

  AddressUnitOf(const sc_core::sc_module_name& name, ClockDomain& clock,
                const spec::texture::Parameters& parameters, ControlRegisters& registers,
                const Descriptors& descriptors, LatencyProbe& probe);

  DerivativeUnit derivative;
  // Exactly one of the two is built.
  std::unique_ptr<FootprintUnit> footprint;
  std::unique_ptr<AxisUnit> axis;
  Log2Unit log2;
  LevelUnit level;
  SampleWalker walker;
  TexelAddresser addresser;

  static Datasheet datasheet(const spec::texture::Parameters& parameters);

 private:
  Link<typename Width::template Fragments<DerivativeToken>> derivatives_;
  Link<typename Width::template Fragments<FootprintToken>> footprints_;
  Link<typename Width::template Fragments<Log2Token>> logs_;
  Link<typename Width::template Fragments<LevelToken>> levels_;
  Link<typename Width::template Requests<SampleToken>> samples_;
};

class AddressUnit final : public AddressUnitOf<Narrow> {
 public:
  using AddressUnitOf::AddressUnitOf;
};
namespace wide {
class AddressUnit final : public AddressUnitOf<Wide> {
 public:
  using AddressUnitOf::AddressUnitOf;
};
}  // namespace wide

}  // namespace deburr::rtl::texture
