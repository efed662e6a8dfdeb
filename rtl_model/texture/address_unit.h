// SPDX-License-Identifier: MIT
// Converts quads of texture coordinates to bilinear requests: address calculation module of the
// paper (2.2, figure 4).
//
//     quads_in -> DerivativeUnit -> FootprintUnit -> Log2Unit -> LevelUnit -> SampleWalker
//                                 or AxisUnit      -> TexelAddresser -> texels_out
//
// Structure `axes = four` or `eight` builds the AxisUnit instead of the FootprintUnit. Links with
//           two entries connect the units.
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

class AddressUnit final : public sc_core::sc_module {
 public:
  In<spec::texture::Quad> quads_in{"quads_in"};
  Out<TexelToken> texels_out{"texels_out"};

  AddressUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
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
  Link<DerivativeToken> derivatives_{"derivatives"};
  Link<FootprintToken> footprints_;
  Link<Log2Token> logs_;
  Link<LevelToken> levels_;
  Link<SampleToken> samples_{"samples"};
};

}  // namespace deburr::rtl::texture
