// SPDX-License-Identifier: MIT
#include "rtl_model/texture/address_unit.h"

namespace deburr::rtl::texture {

template <class Width>
AddressUnitOf<Width>::AddressUnitOf(const sc_core::sc_module_name& name, ClockDomain& clock,
                                    const spec::texture::Parameters& p, ControlRegisters& registers,
                                    const Descriptors& descriptors, LatencyProbe& probe)
    : sc_module(name),
      derivative("derivative_unit", clock, registers, descriptors.for_derivatives, probe,
                 p.derivatives, p.fragments),
      footprint(p.axes == spec::texture::Axes::kTwo
                    ? std::make_unique<FootprintUnit>("footprint_unit", clock, p.footprint)
                    : nullptr),
      axis(footprint ? nullptr
                     : std::make_unique<AxisUnit>("axis_unit", clock, p.axes, p.footprint,
                                                  p.axis_cycles)),
      log2("log2_unit", clock, p.log2, p.fragments),
      level("level_unit", clock, descriptors.for_levels, p.axes, p.count, p.count_cap),
      walker("sample_walker", clock, p.count, p.kernel, p.spread, p.blend, p),
      addresser("texel_addresser", clock, descriptors.for_texels, descriptors.for_younger_texels),
      derivatives_("derivatives", 2, fragment_links<Width>(p, {})),
      footprints_("footprints", 2, fragment_links<Width>(p, footprint_shape(p))),
      logs_("logs", 2, fragment_links<Width>(p, axis_shape(p))),
      levels_("levels", 2, fragment_links<Width>(p, axis_shape(p))),
      samples_("samples", 2, request_links<Width>(p, sample_shape(p))) {
  const auto between = [&](auto& unit) {
    unit->derivatives_in(derivatives_);
    unit->footprints_out(footprints_);
  };
  derivative.quads_in(quads_in);
  derivative.derivatives_out(derivatives_);
  if (footprint)
    between(footprint);
  else
    between(axis);
  log2.footprints_in(footprints_);
  log2.logs_out(logs_);
  level.logs_in(logs_);
  level.levels_out(levels_);
  walker.levels_in(levels_);
  walker.samples_out(samples_);
  addresser.samples_in(samples_);
  addresser.texels_out(texels_out);
}

template <class Width>
Datasheet AddressUnitOf<Width>::datasheet(const spec::texture::Parameters& p) {
  const bool two = p.axes == spec::texture::Axes::kTwo;
  Datasheet sheet = {.unit = "AddressUnit",
                     .does = "From quads to bilinear requests: the units above in series.",
                     .interval = {1, "max(N x (1 or 2), `axis_cycles`) cycles per fragment"}};
  for (const Datasheet& block :
       {DerivativeUnit::datasheet(), two ? FootprintUnit::datasheet(p) : AxisUnit::datasheet(p),
        Log2Unit::datasheet(p), LevelUnit::datasheet(), SampleWalker::datasheet(p),
        TexelAddresser::datasheet()})
    sheet.latency.cycles += block.latency.cycles;
  return sheet;
}

template class AddressUnitOf<Narrow>;
template class AddressUnitOf<Wide>;

}  // namespace deburr::rtl::texture
