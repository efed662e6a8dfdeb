// SPDX-License-Identifier: MIT
#include "rtl_model/texture/address_unit.h"

namespace deburr::rtl::texture {

AddressUnit::AddressUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
                         const spec::texture::Parameters& p, ControlRegisters& registers,
                         const Descriptors& descriptors, LatencyProbe& probe)
    : sc_module(name),
      derivative("derivative", clock, registers, descriptors.for_derivatives, probe),
      footprint("footprint", clock, p.footprint),
      log2("log2", clock, p.log2),
      level("level", clock, descriptors.for_levels, p.count, p.count_cap),
      walker("walker", clock, p.kernel, p.spread),
      addresser("addresser", clock, descriptors.for_texels) {
  derivative.quads_in(quads_in);
  derivative.derivatives_out(derivatives_);
  footprint.derivatives_in(derivatives_);
  footprint.footprints_out(footprints_);
  log2.footprints_in(footprints_);
  log2.logs_out(logs_);
  level.logs_in(logs_);
  level.levels_out(levels_);
  walker.levels_in(levels_);
  walker.samples_out(samples_);
  addresser.samples_in(samples_);
  addresser.texels_out(texels_out);
}

}  // namespace deburr::rtl::texture
