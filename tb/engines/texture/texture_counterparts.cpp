// SPDX-License-Identifier: MIT
#include "tb/engines/texture/texture_counterparts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/tokens.h"
#include "spec/check_build.h"
#include "spec/error.h"

namespace deburr::tb {
namespace {

using StandIns = rtl::texture::TextureUnit::StandIns;

struct CounterpartUnit {
  std::string_view name;
  std::vector<std::string_view> parameters;  // those that are compiled into a model of the unit
};
const std::array<CounterpartUnit, 3>& known_units() {
  static const std::array<CounterpartUnit, 3> all = {
      {{"address",
        {"width", "fragments", "axes", "footprint", "log2", "count", "count_cap", "kernel",
         "spread", "axis_cycles", "derivatives", "blend"}},
       {"cache",
        {"width", "cache.bytes", "cache.line_bytes", "cache.ways", "cache.replacement",
         "cache.outstanding", "cache.fifo_depth"}},
       {"filter", {"width", "count", "kernel", "srgb_output", "blend"}}}};
  return all;
}

std::vector<TextureCounterpart>& counterparts() {
  static std::vector<TextureCounterpart> all;
  return all;
}

// "axes=two footprint=half ..."
std::string configuration(const CounterpartUnit& unit,
                          const spec::texture::Parameters& parameters) {
  std::string text;
  for (const std::string_view name : unit.parameters)
    text +=
        fmt::format("{}{}={}", text.empty() ? "" : " ", name, spec::value_text(parameters, name));
  // Requests then have one bit more.
  if (unit.name != "address" && rtl::texture::selects_kernel(parameters))
    text += fmt::format(" axes={}{}", spec::value_text(parameters, "axes"),
                        unit.name == "cache" ? " kernel=axis" : "");
  return text;
}

const TextureCounterpart* find(const CounterpartUnit& unit,
                               const spec::texture::Parameters& as_built) {
  if (as_built.width > 1 || as_built.decode != spec::texture::Decode::kNone) return nullptr;
  const std::string wanted = configuration(unit, as_built);
  for (const TextureCounterpart& counterpart : counterparts())
    if (counterpart.unit == unit.name && configuration(unit, counterpart.parameters) == wanted)
      return &counterpart;
  return nullptr;
}

const CounterpartUnit& unit_named(std::string_view name) {
  const auto found = std::find_if(known_units().begin(), known_units().end(),
                                  [&](const CounterpartUnit& unit) { return unit.name == name; });
  if (found == known_units().end())
    throw spec::ConfigError(fmt::format(
        "run.hdl: no unit '{}': give address, cache or filter, separated by commas, or all", name));
  return *found;
}

StandIns makers(std::vector<const TextureCounterpart*> chosen, std::uint64_t seed) {
  if (chosen.empty()) return {};
  return [chosen = std::move(chosen), seed](rtl::texture::TextureUnit& unit,
                                            rtl::LatencyProbe& probe) {
    std::vector<std::unique_ptr<sc_core::sc_module>> made;
    for (const TextureCounterpart* counterpart : chosen)
      made.push_back(counterpart->make(unit, probe, seed));
    return made;
  };
}

}  // namespace

void add_texture_counterpart(TextureCounterpart counterpart) {
  counterparts().push_back(std::move(counterpart));
}

std::vector<std::string> counterpart_units(const std::string& text) {
  std::set<std::string_view> named;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view name = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(rest.size(), name.size() + 1));
    if (name == "all")
      for (const CounterpartUnit& unit : known_units()) named.insert(unit.name);
    else
      named.insert(unit_named(name).name);
  }
  if (!named.empty() && counterparts().empty())
    throw spec::ConfigError(
        "run.hdl: this program was built without the units in SystemVerilog: configure with "
        "-DDEBURR_HDL=ON (cmake --preset hdl) where Verilator is installed (scripts/install hdl), "
        "or leave it out");
  std::vector<std::string> units;
  for (const CounterpartUnit& unit : known_units())
    if (named.contains(unit.name)) units.emplace_back(unit.name);
  return units;
}

StandIns texture_counterparts(const std::vector<std::string>& units,
                              const spec::texture::Parameters& as_built, std::uint64_t seed) {
  if (!units.empty() && as_built.width > 1)
    throw spec::ConfigError(
        fmt::format("run.hdl: the units in SystemVerilog are those of texture.width = 1, and "
                    "texture.width is {}: set it to 1, or leave out run.hdl (--hdl)",
                    as_built.width));
  if (!units.empty() && as_built.decode != spec::texture::Decode::kNone)
    throw spec::ConfigError(
        "run.hdl: a unit that decodes blocks does not run as SystemVerilog: set texture.decode = "
        "none, or leave out run.hdl (--hdl)");
  std::vector<const TextureCounterpart*> chosen;
  for (const std::string& name : units) {
    const CounterpartUnit& unit = unit_named(name);
    const TextureCounterpart* const counterpart = find(unit, as_built);
    if (!counterpart) {
      std::string there;
      for (const TextureCounterpart& other : counterparts())
        if (other.unit == name) there += "\n  " + configuration(unit, other.parameters);
      throw spec::ConfigError(fmt::format(
          "run.hdl: this build has no unit {} in SystemVerilog for\n  {}\nIt has those for{}\nTo "
          "add one, add a line with these settings to tb/hdl/configurations.txt and build again "
          "(docs/explanation/hdl.md)",
          name, configuration(unit, as_built), there));
    }
    chosen.push_back(counterpart);
  }
  return makers(std::move(chosen), seed);
}

StandIns available_texture_counterparts(const spec::texture::Parameters& as_built,
                                        std::uint64_t seed) {
  std::vector<const TextureCounterpart*> chosen;
  for (const CounterpartUnit& unit : known_units())
    if (const TextureCounterpart* const counterpart = find(unit, as_built))
      chosen.push_back(counterpart);
  return makers(std::move(chosen), seed);
}

std::vector<std::string> idle_counterparts(const rtl::texture::TextureUnit& unit) {
  std::vector<std::string> idle;
  for (const CounterpartUnit& known : known_units()) {
    std::uint64_t busy = 0;
    for (const sc_core::sc_object* const below : unit.get_child_objects())
      if (const auto* const counterpart = dynamic_cast<const rtl::Unit*>(below);
          counterpart && counterpart->basename() == fmt::format("{}_hdl", known.name))
        busy += counterpart->busy_cycles();
    if (busy == 0) idle.emplace_back(known.name);
  }
  return idle;
}

void reject_views_inside(const ParameterSet& set) {
  for (const char* name : {"run.maps", "run.coverage", "run.line_trace_lookups"})
    if (set.find(name)->text() == "true")
      throw spec::ConfigError(
          fmt::format("{}: a unit that runs as SystemVerilog is not looked into: leave out {} or "
                      "run.hdl (--hdl)",
                      name, name));
  if (!set.find("run.pixel")->text().empty())
    throw spec::ConfigError(
        "run.pixel: a unit that runs as SystemVerilog is not looked into: leave out run.pixel or "
        "run.hdl (--hdl)");
}

}  // namespace deburr::tb
