// SPDX-License-Identifier: MIT
#include "tb/harness/statistics.h"

#include <nlohmann/json.hpp>
#include <optional>

#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/ownership.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"

namespace deburr::tb {

using Json = nlohmann::ordered_json;

Json to_json(const rtl::Histogram& histogram, std::size_t bins) {
  Json json{{"unit", histogram.unit()},        {"meaning", histogram.meaning()},
            {"count", histogram.count()},      {"sum", histogram.sum()},
            {"min", histogram.min()},          {"p50", histogram.percentile(50)},
            {"p95", histogram.percentile(95)}, {"p99", histogram.percentile(99)},
            {"max", histogram.max()}};
  Json& list = json["histogram"] = Json::array();
  for (const rtl::Histogram::Bin& bin : histogram.bins(bins))
    list.push_back({bin.low, bin.high, bin.count});
  return json;
}

Json statistics(const rtl::ClockDomain& clock, const std::string& prefix) {
  Json json{{"cycles", clock.cycles_since_reset()},
            {"units", Json::object()},
            {"counters", Json::object()},
            {"histograms", Json::object()},
            {"memories", Json::object()},
            {"links", Json::object()},
            {"wires", Json::object()}};
  const auto short_name = [&](const char* full) -> std::optional<std::string> {
    const std::string name = full;
    if (prefix.empty()) return name;
    if (name.rfind(prefix + ".", 0) != 0) return std::nullopt;
    return name.substr(prefix.size() + 1);
  };
  for (const rtl::Unit* unit : clock.units()) {
    const auto name = short_name(unit->name());
    if (!name) continue;
    Json& entry = json["units"][*name];
    entry = {
        {"busy", unit->busy_cycles()}, {"idle", unit->idle_cycles()}, {"stalls", Json::object()}};
    for (const rtl::Unit::StallCause& cause : unit->stalls())
      entry["stalls"][cause.name] = cause.cycles;
  }
  const rtl::Ownership ownership;
  const auto own = [&](const auto* part) { return part && ownership.of(*part) == &clock; };
  rtl::walk_all([&](sc_core::sc_object& object) {
    const auto name = short_name(object.name());
    if (!name) return;
    if (const auto* counter = dynamic_cast<const rtl::Counter*>(&object); own(counter)) {
      json["counters"][*name] = {
          {"value", counter->value()}, {"unit", counter->unit()}, {"meaning", counter->meaning()}};
    } else if (const auto* histogram = dynamic_cast<const rtl::Histogram*>(&object);
               own(histogram)) {
      json["histograms"][*name] = to_json(*histogram);
    } else if (const auto* memory = dynamic_cast<const rtl::MemoryBase*>(&object); own(memory)) {
      json["memories"][*name] = {{"kind", rtl::name_of(memory->memory_kind())},
                                 {"ports", memory->ports()},
                                 {"logical_bits", memory->logical_bits()},
                                 {"physical_bits", memory->physical_bits()}};
    } else if (const auto* link = dynamic_cast<const rtl::LinkBase*>(&object); own(link)) {
      json["links"][*name] = {{"depth", link->depth()},
                              {"payload_bits", link->payload_bits()},
                              {"beats", link->pops()}};
    } else if (const auto* wire = dynamic_cast<const rtl::WireBase*>(&object); own(wire)) {
      json["wires"][*name] = {{"bits", wire->bits()},
                              {"changes", wire->changes()},
                              {"high", wire->high_cycles(clock.cycle())}};
    }
  });
  return json;
}

}  // namespace deburr::tb
