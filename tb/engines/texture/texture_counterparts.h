// SPDX-License-Identifier: MIT
// RTL counterparts: SystemVerilog models that replace SystemC units of the texture unit in a run
// (`--hdl`, docs/explanation/hdl.md). The program's link line decides which exist: tb/hdl registers
// its models before main(); most programs link none.
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

// Run parameters that only the texture unit has.
struct CounterpartParameters {
  std::string units;
};

template <class Visitor>
void describe(CounterpartParameters& p, Visitor& v) {
  v.text("hdl", p.units, "list of address, cache, filter, all",
         "Units that run as SystemVerilog (through Verilator), if the build has them "
         "(docs/explanation/hdl.md); must not change results. Empty: none.");
}

// A Verilator model of a unit.
struct TextureCounterpart {
  std::string unit;  // "address", "cache" or "filter"
  spec::texture::Parameters parameters;
  // Constructs the model in the texture unit instead of the SystemC unit. The seed randomises
  // registers before their reset and the payload of empty links.
  std::function<std::unique_ptr<sc_core::sc_module>(rtl::texture::TextureUnit&, rtl::LatencyProbe&,
                                                    std::uint64_t seed)>
      make;
};
void add_texture_counterpart(TextureCounterpart counterpart);

// Units named in a text, in that order. Throws ConfigError for an unknown unit and in a program
// without counterparts.
std::vector<std::string> counterpart_units(const std::string& text);
// Models of these units for the built parameters, including the FIFO depth. Throws ConfigError,
// listing the available models, if one is missing.
rtl::texture::TextureUnit::StandIns texture_counterparts(const std::vector<std::string>& units,
                                                         const spec::texture::Parameters& as_built,
                                                         std::uint64_t seed);
// All available models, for suites that run with many configurations.
rtl::texture::TextureUnit::StandIns available_texture_counterparts(
    const spec::texture::Parameters& as_built, std::uint64_t seed);
// Units whose links have not moved a beat since reset.
std::vector<std::string> idle_counterparts(const rtl::texture::TextureUnit& unit);

// Throws ConfigError for options that look inside units, if counterparts are used.
void reject_views_inside(const ParameterSet& set);

}  // namespace deburr::tb
