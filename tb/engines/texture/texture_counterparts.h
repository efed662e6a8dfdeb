// SPDX-License-Identifier: MIT
// Units of the texture unit in SystemVerilog that do the work of SystemC ones in a run (`--hdl`,
// docs/explanation/hdl.md). Which there are is decided by what a program is linked with: tb/hdl
// adds its models before main(), most programs have none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/latency_probe.h"
#include "rtl_model/texture/texture_unit.h"
#include "spec/texture/parameters.h"
#include "tb/run/parameter_set.h"

namespace deburr::tb {

// Parameters of the run that only the texture unit has.
struct CounterpartParameters {
  std::string units;
};

template <class Visitor>
void describe(CounterpartParameters& p, Visitor& v) {
  v.text("hdl", p.units, "list of address, cache, filter, all",
         "Units that run as SystemVerilog (through Verilator), if the build has them "
         "(docs/explanation/hdl.md); must not change results. Empty: none.");
}

// A verilated model of a unit.
struct TextureCounterpart {
  std::string unit;  // "address", "cache" or "filter"
  spec::texture::Parameters parameters;
  // Makes it below the unit around it, in the place of the SystemC one. The seed is that of what
  // its registers hold before their reset and of what empty links show it.
  std::function<std::unique_ptr<sc_core::sc_module>(rtl::texture::TextureUnit&, rtl::LatencyProbe&,
                                                    std::uint64_t seed)>
      make;
};
void add_texture_counterpart(TextureCounterpart counterpart);

// The units that a text names, in the order in which they stand. ConfigError for a name that no
// unit has, and for a program without counterparts.
std::vector<std::string> counterpart_units(const std::string& text);
// Models of these units with parameters as built, the depth of the FIFO among them. ConfigError if
// there is none of a unit; it says which there are.
rtl::texture::TextureUnit::StandIns texture_counterparts(const std::vector<std::string>& units,
                                                         const spec::texture::Parameters& as_built,
                                                         std::uint64_t seed);
// Those of all units of which there is one, for suites that run with many configurations.
rtl::texture::TextureUnit::StandIns texture_counterparts_there_are(
    const spec::texture::Parameters& as_built, std::uint64_t seed);
// The units of which none below `unit` has moved a beat since reset.
std::vector<std::string> idle_counterparts(const rtl::texture::TextureUnit& unit);

// ConfigError for what looks inside of units, beside counterparts.
void reject_views_inside(const ParameterSet& set);

}  // namespace deburr::tb
