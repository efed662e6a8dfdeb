// SPDX-License-Identifier: MIT
#include "rtl_model/texture/texture_unit.h"

#include <bit>
#include <string>

#include "spec/error.h"

namespace deburr::rtl::texture {
namespace {

constexpr std::int32_t kLeastFifo = 2;

void check_power_of_two(const char* name, std::int32_t value) {
  if (!std::has_single_bit(static_cast<std::uint32_t>(value)))
    throw spec::ConfigError(std::string("texture.") + name + ": expected a power of two, got " +
                            std::to_string(value));
}

spec::texture::Parameters checked(spec::texture::Parameters p) {
  p = checked_ranges("texture", p);
  check_power_of_two("cache.bytes", p.cache_bytes);
  check_power_of_two("cache.line_bytes", p.cache_line_bytes);
  check_power_of_two("cache.ways", p.cache_ways);
  if (p.cache_bytes < p.cache_line_bytes * p.cache_ways)
    throw spec::ConfigError("texture.cache.bytes: " + std::to_string(p.cache_bytes) +
                            " bytes do not hold one set of " + std::to_string(p.cache_ways) +
                            " ways x " + std::to_string(p.cache_line_bytes) +
                            " bytes: make it larger, or lines or ways fewer");
  if (p.cache_fifo_depth < kLeastFifo)
    throw spec::ConfigError("texture.cache.fifo_depth: a FIFO of " +
                            std::to_string(p.cache_fifo_depth) +
                            " cannot be built: reads and writes of every clock need at least 2 "
                            "places; 0 sizes it from the latency of memory, which only who knows "
                            "the memory can do");
  check_power_of_two("axis_clocks", p.axis_clocks);
  if (const std::int32_t most = 1 << static_cast<std::int32_t>(p.axes); p.axis_clocks > most)
    throw spec::ConfigError("texture.axis_clocks: " + std::to_string(p.axis_clocks) +
                            " clocks for " + std::to_string(2 * most) +
                            " directions: at least two are measured in a clock, so at most " +
                            std::to_string(most));
  if (p.cache_ways > TagStore::kMostWays)
    throw spec::ConfigError("texture.cache.ways: " + std::to_string(p.cache_ways) +
                            " ways cannot be built: four lines are looked up one behind the other "
                            "in a clock, which leaves time to choose among at most " +
                            std::to_string(TagStore::kMostWays) + " ways: make it smaller");
  if (const std::int32_t lines = p.cache_bytes / p.cache_line_bytes; lines > TagStore::kMostLines)
    throw spec::ConfigError(
        "texture.cache.bytes: the tags of " + std::to_string(lines) + " lines of " +
        std::to_string(p.cache_line_bytes) +
        " bytes cannot be built: they stand in flip-flops, four sets being read and written in a "
        "clock, and more than 16 kbit of flip-flops is no memory: at most " +
        std::to_string(TagStore::kMostLines) + " lines, so make it at most " +
        std::to_string(TagStore::kMostLines * p.cache_line_bytes) + ", or lines longer");
  return p;
}

}  // namespace

TextureUnit::TextureUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
                         const spec::texture::Parameters& parameters)
    : Engine(name, clock, register_table(), control_layout()),
      parameters_(checked(parameters)),
      address("address", clock, parameters_, control, descriptors_, probe_),
      cache("cache", clock, parameters_, control),
      filter("filter", clock, parameters_, probe_) {
  uses(cache.memory_port);
  address.quads_in(quads_in);
  address.texels_out(texels_);
  cache.texels_in(texels_);
  cache.texels_out(texel_quads_);
  filter.texels_in(texel_quads_);
  filter.colours_out(colours_out);

  namespace reg = spec::texture::reg;
  control.set_reset(reg::kRules, spec::texture::rules_word(parameters_));
  control.on_command(reg::kControlInvalidate, [this] { cache.tag_stage.invalidate(); });
  control.show(reg::kFragments, filter.fragments);
  control.show(reg::kBilinears, address.addresser.bilinears);
  control.show(reg::kLineFills, cache.miss_queue.line_fills);
  control.show(reg::kClamped, address.derivative.clamped);
  control.show(reg::kSaturated, address.derivative.saturated);
  control.show(reg::kMemoryErrors, cache.miss_queue.memory_errors);
  control.show(reg::kInvalidFragments, address.derivative.invalid);
}

bool TextureUnit::idle() const {
  return probe_.inside() == 0 && address.derivative.quads_in.link().empty();
}

Datasheet TextureUnit::datasheet(const spec::texture::Parameters& p) {
  Datasheet sheet = {
      .unit = "TextureUnit",
      .does = "From a quad taken to its first colour: one sample, nearest, warm cache.",
      .interval = {1, "N x (1 or 2) clocks a fragment, or `axis_clocks` if that is more"}};
  for (const Datasheet& part :
       {AddressUnit::datasheet(p), TextureCache::datasheet(), FilterPipeline::datasheet(p)})
    sheet.latency.clocks += part.latency.clocks;
  return sheet;
}

}  // namespace deburr::rtl::texture
