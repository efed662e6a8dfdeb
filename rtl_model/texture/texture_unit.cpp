// SPDX-License-Identifier: MIT
#include "rtl_model/texture/texture_unit.h"

#include "spec/texture/check_build.h"

namespace deburr::rtl::texture {
namespace {

spec::texture::Parameters sized(spec::texture::Parameters p, const MemoryCycles& memory) {
  p.cache_fifo_depth = LatencyFifo::depth(p, memory);
  return p;
}

}  // namespace

TextureUnit::TextureUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
                         const spec::texture::Parameters& parameters, const MemoryCycles& memory,
                         const StandIns& stand_ins)
    : Engine(name, clock, register_table(), control_layout()),
      parameters_(sized(check_build(parameters), memory)),
      descriptors_("descriptors", control, parameters_.width),
      address("address_unit", clock, parameters_, control, descriptors_, probe_),
      cache("texture_cache", clock, parameters_, control),
      filter("filter_pipeline", clock, parameters_, probe_) {
  uses(cache.memory_port);
  address.quads_in(quads_in);
  address.texels_out(texels_);
  cache.texels_in(texels_);
  cache.texels_out(texel_quads_);
  filter.texels_in(texel_quads_);
  filter.colours_out(colours_out);

  namespace reg = spec::texture::reg;
  control.set_resets(spec::texture::loaded_registers(parameters_));
  control.on_command(reg::kControlInvalidate, [this] { cache.tag_stage.invalidate(); });
  control.show(reg::kFragments, filter.fragments);
  control.show(reg::kBilinears, address.addresser.bilinears);
  control.show(reg::kLineFills, cache.miss_queue.line_fills);
  control.show(reg::kClamped, address.derivative.clamped);
  control.show(reg::kSaturated, address.derivative.saturated);
  control.show(reg::kMemoryErrors, cache.miss_queue.memory_errors);
  control.show(reg::kInvalidFragments, address.derivative.invalid);
  if (stand_ins) stand_ins_ = stand_ins(*this, probe_);
}

// Out of line, so that users do not instantiate it.
TextureUnit::~TextureUnit() = default;

bool TextureUnit::idle() const {
  return probe_.inside() == 0 && address.derivative.quads_in.link().empty();
}

Datasheet TextureUnit::datasheet(const spec::texture::Parameters& p) {
  Datasheet sheet = {
      .unit = "TextureUnit",
      .does = "Latency from taking a quad to its first colour: one sample, nearest, cache hit.",
      .interval = {1, "max(N x (1 or 2), `axis_cycles`) cycles per fragment"}};
  for (const Datasheet& part :
       {AddressUnit::datasheet(p), TextureCache::datasheet(), FilterPipeline::datasheet(p)})
    sheet.latency.cycles += part.latency.cycles;
  return sheet;
}

}  // namespace deburr::rtl::texture
