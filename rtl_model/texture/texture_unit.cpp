// SPDX-License-Identifier: MIT
#include "rtl_model/texture/texture_unit.h"

#include "rtl_model/texture/datasheets.h"
#include "spec/texture/check_build.h"

namespace deburr::rtl::texture {
namespace {

spec::texture::Parameters sized(spec::texture::Parameters p, const MemoryCycles& memory) {
  p.cache_fifo_depth = LatencyFifo::depth(p, memory);
  p.cache_outstanding = MissQueue::entries(p, memory);
  return p;
}

template <class Unit>
TextureUnit::Address units_of(Unit& unit) {
  return {unit.derivative, unit.level, unit.walker, unit.addresser};
}

}  // namespace

TextureUnit::TextureUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
                         const spec::texture::Parameters& parameters, const MemoryCycles& memory,
                         const StandIns& stand_ins)
    : Engine(name, clock, register_table(), control_layout()),
      parameters_(sized(check_build(parameters), memory)),
      descriptors_("descriptors", control, parameters_),
      narrow_address(parameters_.width == 1
                         ? std::make_unique<AddressUnit>("address_unit", clock, parameters_,
                                                         control, descriptors_, probe_)
                         : nullptr),
      wide_address(narrow_address
                       ? nullptr
                       : std::make_unique<wide::AddressUnit>("address_unit", clock, parameters_,
                                                             control, descriptors_, probe_)),
      cache("texture_cache", clock, parameters_, control),
      narrow_filter(narrow_address ? std::make_unique<FilterPipeline>("filter_pipeline", clock,
                                                                      parameters_, probe_)
                                   : nullptr),
      wide_filter(narrow_address
                      ? nullptr
                      : std::make_unique<wide::FilterPipeline>(
                            "filter_pipeline", clock, parameters_, probe_, parameters_.width)),
      address(narrow_address ? units_of(*narrow_address) : units_of(*wide_address)),
      filter(narrow_filter ? static_cast<FilterPipelineBase&>(*narrow_filter) : *wide_filter) {
  uses(cache.memory_port);
  filter.colours_out(colours_out);
  if (narrow_address) {
    texels_ = std::make_unique<Link<TexelToken>>("texels", 2, texel_shape(parameters_));
    texel_quads_ =
        std::make_unique<Link<TexelQuadToken>>("texel_quads", 2, texel_quad_shape(parameters_));
    narrow_address->quads_in(quads_in);
    narrow_address->texels_out(*texels_);
    cache.texels_in(*texels_);
    cache.texels_out(*texel_quads_);
    narrow_filter->texels_in(*texel_quads_);
  } else {
    texel_groups_ = std::make_unique<Link<TexelGroup>>(
        "texels", 2, request_links<Wide>(parameters_, texel_shape(parameters_)));
    texel_quad_groups_ = std::make_unique<Link<TexelQuadGroup>>(
        "texel_quads", 2, links_of_groups(parameters_.width, texel_quad_shape(parameters_)));
    wide_address->quads_in(quads_in);
    wide_address->texels_out(*texel_groups_);
    cache.groups_in(*texel_groups_);
    cache.groups_out(*texel_quad_groups_);
    wide_filter->texels_in(*texel_quad_groups_);
  }

  namespace reg = spec::texture::reg;
  control.set_resets(spec::texture::loaded_registers(parameters_));
  control.on_command(reg::kControlInvalidate, [this] { cache.invalidate(); });
  control.show(reg::kFragments, filter.fragments);
  control.show(reg::kBilinears, address.addresser.bilinears);
  control.show(reg::kLineFills, cache.miss_queue.line_fills);
  control.show(reg::kClamped, address.derivative.clamped);
  control.show(reg::kSaturated, address.derivative.saturated);
  control.show(reg::kMemoryErrors, cache.memory_errors());
  control.show(reg::kInvalidFragments, address.derivative.invalid);
  if (stand_ins) stand_ins_ = stand_ins(*this, probe_);
}

// Out of line, so that users do not instantiate it.
TextureUnit::~TextureUnit() = default;

bool TextureUnit::idle() const {
  return probe_.inside() == 0 && address.derivative.quads_in.link().empty();
}

std::vector<Datasheet> TextureUnit::datasheets() const { return texture::datasheets(parameters_); }

Datasheet TextureUnit::datasheet(const spec::texture::Parameters& p) {
  Datasheet sheet = {
      .unit = "TextureUnit",
      .does = "Latency from taking a quad to its first colour: one sample, nearest, cache hit.",
      .interval = {1, "max(N x (1 or 2), `axis_cycles`) cycles per fragment"}};
  for (const Datasheet& part :
       {AddressUnit::datasheet(p), TextureCache::datasheet(p), FilterPipeline::datasheet(p)})
    sheet.latency.cycles += part.latency.cycles;
  return sheet;
}

}  // namespace deburr::rtl::texture
