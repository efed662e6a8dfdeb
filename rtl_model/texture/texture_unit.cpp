// SPDX-License-Identifier: MIT
#include "rtl_model/texture/texture_unit.h"

#include <utility>

#include "spec/texture/check_build.h"

namespace deburr::rtl::texture {
namespace {

spec::texture::Parameters sized(spec::texture::Parameters p, const MemoryCycles& memory) {
  p.cache_fifo_depth = LatencyFifo::depth(p, memory);
  p.cache_outstanding = MissQueue::entries(p, memory);
  return p;
}

template <class Part, class... Arguments>
std::unique_ptr<Part> made(bool built, const char* name, Arguments&&... arguments) {
  return built ? std::make_unique<Part>(name, std::forward<Arguments>(arguments)...) : nullptr;
}

}  // namespace

TextureUnit::TextureUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
                         const spec::texture::Parameters& parameters, const MemoryCycles& memory,
                         const StandIns& stand_ins)
    : Engine(name, clock, register_table(), control_layout()),
      parameters_(sized(check_build(parameters), memory)),
      descriptors_("descriptors", control, parameters_.width),
      address(made<AddressUnit>(parameters_.width == 1, "address_unit", clock, parameters_, control,
                                descriptors_, probe_)),
      wide_address(made<wide::AddressUnit>(!address, "address_unit", clock, parameters_, control,
                                           descriptors_, probe_)),
      cache("texture_cache", clock, parameters_, control),
      filter(made<FilterPipeline>(bool(address), "filter_pipeline", clock, parameters_, probe_)),
      wide_filter(made<wide::FilterPipeline>(!address, "filter_pipeline", clock, parameters_,
                                             probe_, parameters_.width)),
      taken(with_address([](const auto& a) -> auto& { return a.derivative.fragments; })),
      magnified(with_address([](const auto& a) -> auto& { return a.level.magnified; })),
      samples(with_address([](const auto& a) -> auto& { return a.walker.samples; })),
      bilinears(with_address([](const auto& a) -> auto& { return a.addresser.bilinears; })),
      fragments(with_filter([](const auto& f) -> auto& { return f.fragments; })),
      fragment_latency(with_filter([](const auto& f) -> auto& { return f.fragment_latency; })),
      texels_(made<Link<TexelToken>>(bool(address), "texels")),
      texel_quads_(made<Link<TexelQuadToken>>(bool(address), "texel_quads")),
      texel_groups_(
          made<Link<TexelGroup>>(!address, "texels", 2U, requests_shape<Wide>(parameters_))),
      texel_quad_groups_(
          made<Link<TexelQuadGroup>>(!address, "texel_quads", 2U, group_shape(parameters_.width))) {
  uses(cache.memory_port);
  if (address) {
    cache.texels_in(*texels_);
    cache.texels_out(*texel_quads_);
    connect(*address, *filter, *texels_, *texel_quads_);
  } else {
    cache.groups_in(*texel_groups_);
    cache.groups_out(*texel_quad_groups_);
    connect(*wide_address, *wide_filter, *texel_groups_, *texel_quad_groups_);
  }
  control.set_resets(spec::texture::loaded_registers(parameters_));
  if (stand_ins) stand_ins_ = stand_ins(*this, probe_);
}

template <class Address, class Filter, class Texels, class TexelQuads>
void TextureUnit::connect(Address& address_unit, Filter& filter_pipeline, Texels& texels,
                          TexelQuads& texel_quads) {
  address_unit.quads_in(quads_in);
  address_unit.texels_out(texels);
  filter_pipeline.texels_in(texel_quads);
  filter_pipeline.colours_out(colours_out);

  namespace reg = spec::texture::reg;
  control.on_command(reg::kControlInvalidate, [this] { cache.tag_stage.invalidate(); });
  control.show(reg::kFragments, filter_pipeline.fragments);
  control.show(reg::kBilinears, address_unit.addresser.bilinears);
  control.show(reg::kLineFills, cache.miss_queue.line_fills);
  control.show(reg::kClamped, address_unit.derivative.clamped);
  control.show(reg::kSaturated, address_unit.derivative.saturated);
  control.show(reg::kMemoryErrors, cache.miss_queue.memory_errors);
  control.show(reg::kInvalidFragments, address_unit.derivative.invalid);
}

// Out of line, so that users do not instantiate it.
TextureUnit::~TextureUnit() = default;

bool TextureUnit::idle() const {
  return probe_.inside() == 0 &&
         with_address([](const auto& a) { return a.derivative.quads_in.link().empty(); });
}

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
