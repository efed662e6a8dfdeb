// SPDX-License-Identifier: MIT
#include "rtl_model/texture/texture_unit.h"

#include <bit>
#include <string>
#include <string_view>

#include "spec/error.h"

namespace deburr::rtl::texture {
namespace {

// Checks every parameter against its declared range.
struct RangeCheck {
  void integer(std::string_view name, std::int32_t value, std::int32_t min, std::int32_t max,
               std::string_view unit, std::string_view) const {
    if (value < min || value > max)
      throw spec::ConfigError("texture." + std::string(name) + ": expected " + std::to_string(min) +
                              ".." + std::to_string(max) + " " + std::string(unit) + ", got " +
                              std::to_string(value));
  }
  template <class Enum, std::size_t N>
  void choice(std::string_view name, Enum value, const std::array<std::string_view, N>&,
              std::string_view) const {
    if (static_cast<std::size_t>(value) >= N)
      throw spec::ConfigError("texture." + std::string(name) +
                              ": no such choice: " + std::to_string(static_cast<int>(value)));
  }
  void boolean(std::string_view, bool, std::string_view) const {}
};

void check_power_of_two(const char* name, std::int32_t value) {
  if (!std::has_single_bit(static_cast<std::uint32_t>(value)))
    throw spec::ConfigError(std::string("texture.") + name + ": expected a power of two, got " +
                            std::to_string(value));
}

spec::texture::Parameters checked(spec::texture::Parameters p) {
  const RangeCheck check;
  describe(p, check);
  check_power_of_two("cache.bytes", p.cache_bytes);
  check_power_of_two("cache.line_bytes", p.cache_line_bytes);
  check_power_of_two("cache.ways", p.cache_ways);
  if (p.cache_bytes < p.cache_line_bytes * p.cache_ways)
    throw spec::ConfigError("texture.cache.bytes: " + std::to_string(p.cache_bytes) +
                            " bytes do not hold one set of " + std::to_string(p.cache_ways) +
                            " ways x " + std::to_string(p.cache_line_bytes) +
                            " bytes: make it larger, or lines or ways fewer");
  return p;
}

// Fragments that fit into everything but the latency FIFO.
constexpr std::uint32_t kFragmentsElsewhere = 96;

}  // namespace

TextureUnit::TextureUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
                         const spec::texture::Parameters& parameters)
    : sc_module(name),
      parameters_(checked(parameters)),
      probe_(static_cast<std::uint32_t>(parameters_.cache_fifo_depth) + kFragmentsElsewhere),
      store("store", clock, parameters_),
      address("address", clock, parameters_, store, probe_),
      cache("cache", clock, parameters_, store),
      filter("filter", clock, probe_) {
  address.quads_in(quads_in);
  address.texels_out(texels_);
  cache.texels_in(texels_);
  cache.texels_out(texel_quads_);
  filter.texels_in(texel_quads_);
  filter.colours_out(colours_out);

  namespace reg = spec::texture::reg;
  Counter* const shown[] = {
      &filter.fragments,           &address.addresser.bilinears,  &cache.miss_queue.line_fills,
      &address.derivative.clamped, &address.derivative.saturated, &cache.miss_queue.memory_errors,
      &address.derivative.invalid};
  const std::uint32_t offsets[] = {reg::kFragments,       reg::kBilinears, reg::kLineFills,
                                   reg::kClamped,         reg::kSaturated, reg::kMemoryErrors,
                                   reg::kInvalidFragments};
  for (std::size_t i = 0; i < std::size(shown); ++i) store.show(offsets[i], *shown[i]);
  store.connect([this] { return idle(); }, [this] { cache.tag_stage.invalidate(); },
                [shown = std::to_array(shown)] {
                  for (Counter* counter : shown) counter->reset();
                });
}

bool TextureUnit::idle() const {
  return probe_.in_flight() == 0 && address.derivative.quads_in.link().empty();
}

namespace {

template <class T>
std::vector<const T*> collect(sc_core::sc_object& root) {
  std::vector<const T*> found;
  for_each<T>(root, [&](const T& object) { found.push_back(&object); });
  return found;
}

}  // namespace

std::vector<const Unit*> TextureUnit::units() { return collect<Unit>(*this); }
std::vector<const Counter*> TextureUnit::counters() { return collect<Counter>(*this); }
std::vector<const Storage*> TextureUnit::memories() { return collect<Storage>(*this); }

}  // namespace deburr::rtl::texture
