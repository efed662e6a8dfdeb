// SPDX-License-Identifier: MIT
#include "tool/cost/estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>
#include <vector>

#include "spec/error.h"
#include "tool/cost/embedded_cost.h"

namespace deburr::tool {
namespace {

using Json = nlohmann::ordered_json;

tb::Ranged within(double value, double share) {
  return {value * (1 - share), value, value * (1 + share)};
}
tb::Ranged operator+(const tb::Ranged& a, const tb::Ranged& b) {
  return {a.low + b.low, a.value + b.value, a.high + b.high};
}

// A unit with its sheets and what it holds. `unit` is its name outside of a composition.
struct Part {
  std::string name, unit;
  std::vector<const rtl::Datasheet*> sheets;
  std::vector<const tb::MemoryFigures*> memories;
};

// A memory belongs to the unit that it is named after ("fill_buffer_arrived" of the MissQueue), or
// else to the unit that holds it, which may be one of several instances ("line_unit_h").
std::string owner_of(const tb::MemoryFigures& memory, const std::vector<Part>& parts) {
  const std::string within = memory.name.starts_with(memory.owner + "_")
                                 ? memory.name.substr(memory.owner.size() + 1)
                                 : memory.name;
  for (const Part& part : parts)
    if (within.starts_with(part.unit)) return part.name;
  for (const Part& part : parts)
    if (memory.name.starts_with(part.name)) return part.name;
  for (const Part& part : parts)
    if (memory.owner.starts_with(part.name)) return part.name;
  return memory.owner;
}

std::vector<Part> parts_of(const tb::Result& result) {
  std::vector<Part> parts;
  const auto part = [&](const std::string& name) -> Part& {
    const auto found = std::find_if(parts.begin(), parts.end(),
                                    [&](const Part& other) { return other.name == name; });
    return found != parts.end() ? *found : parts.emplace_back(Part{name, name, {}, {}});
  };
  for (const tb::UnitSheet& unit : result.sheets) {
    Part& one = part(unit.name);
    one.unit = instance_name(unit.sheet);
    one.sheets.push_back(&unit.sheet);
  }
  for (const tb::MemoryFigures& memory : result.memories)
    part(owner_of(memory, parts)).memories.push_back(&memory);
  return parts;
}

// Gates of flip-flop memories with their ports, of registers beside memories, and of the control
// and the output registers of FIFOs.
double memory_gates(const tb::MemoryFigures& m, const Primitives& p) {
  const auto bits = static_cast<double>(m.word_bits), words = static_cast<double>(m.words);
  double gates = 0;
  if (m.high_water)
    gates += p.gates("fifo", bits, words);
  else if (m.register_bits > 0)
    gates += p.gates("register_enable", static_cast<double>(m.register_bits));
  if (m.kind != "flops") return gates;
  gates += p.gates("memory", bits, words);
  if (m.write_ports > 1 && m.write_ports < m.words)
    gates += static_cast<double>(m.write_ports - 1) * p.gates("memory_write", bits, words);
  // A memory whose words are all seen at once needs no choice.
  if (m.read_ports < m.words)
    gates += static_cast<double>(m.read_ports) * p.gates("memory_read", bits, words);
  return gates;
}

bool is_arithmetic(rtl::OperatorKind kind) {
  using Kind = rtl::OperatorKind;
  return kind == Kind::kAdd || kind == Kind::kSubtract || kind == Kind::kCompare ||
         kind == Kind::kMaximum || kind == Kind::kMagnitude || kind == Kind::kMultiplyConstant ||
         kind == Kind::kCountOnes;
}

// An arithmetic operator that follows another one begins with the low bits of its result, before
// the high ones have come.
double ns_in_series(std::span<const rtl::Operator> operators, const Primitives& p) {
  double ns = 0;
  bool follows = false;
  for (rtl::Operator one : operators) {
    const std::uint32_t count = std::exchange(one.count, 1);
    const bool arithmetic = is_arithmetic(one.kind);
    for (std::uint32_t i = 0; i < count; ++i) {
      ns += p.ns(one) * (arithmetic && follows ? kOverlap : 1);
      follows = follows || arithmetic;
    }
  }
  return ns;
}

tb::UnitCost estimated(const Part& part, const Primitives& p) {
  tb::UnitCost cost;
  cost.name = part.name;
  cost.basis = "estimate";
  double gates = 0;
  for (const rtl::Datasheet* sheet : part.sheets) {
    for (const rtl::Operator& one : operators_of(*sheet)) gates += p.gates(one);
    const std::uint64_t registers = registers_of(*sheet);
    cost.flip_flops += registers;
    if (registers > 0) gates += p.gates("register_enable", static_cast<double>(registers));
    for (const rtl::Stage& stage : sheet->stages) {
      const double ns = ns_in_series(stage.longest, p);
      if (ns > cost.ns.value) {
        cost.ns = within(ns, kPathRange);
        cost.stage = stage.clock;
      }
    }
  }
  for (const tb::MemoryFigures* memory : part.memories) {
    gates += memory_gates(*memory, p);
    cost.flip_flops += memory->register_bits;
    (memory->kind == "flops" ? cost.flip_flops : cost.memory_bits) += memory->physical_bits;
  }
  cost.gates = within(gates, kUnitRange);
  cost.estimate = {gates, cost.ns.value, cost.flip_flops};
  return cost;
}

tb::UnitCost links_of(const tb::Result& result, const Primitives& p) {
  tb::UnitCost cost;
  cost.name = "links";
  cost.basis = "estimate";
  double gates = 0;
  for (const tb::LinkShape& link : result.link_shapes) {
    gates += p.gates("link", static_cast<double>(link.bits), static_cast<double>(link.depth));
    cost.flip_flops += link.bits * link.depth;
  }
  cost.gates = within(gates, kUnitRange);
  cost.estimate = {gates, 0, cost.flip_flops};
  return cost;
}

// Rows of docs/measurements/cost.json, of the engine that has RTL. The file has a row a line; only
// those of the build's units are parsed, since this is part of every run.
class MappedRows {
 public:
  explicit MappedRows(const ParameterValue& value) : value_(value) {
    const std::string_view text = embedded::mapped_json();
    constexpr std::string_view kEngine = "\"engine\": \"";
    const std::size_t engine = text.find(kEngine) + kEngine.size();
    prefix_ = fmt::format("{}.", text.substr(engine, text.find('"', engine) - engine));
    // Values without which there is no RTL.
    const Json only = object_in(text, "only");
    any_ = value && only.is_object();
    for (const auto& [name, wanted] : only.items()) any_ = any_ && value(prefix_ + name) == wanted;
  }

  // null if no row has these very parameters.
  Json of(const Part& part, const tb::Result& result) const {
    if (!any_) return nullptr;
    std::uint64_t in_data = 0;
    for (const tb::LinkShape& link : result.link_shapes)
      if (link.consumer == part.name) in_data += link.bits;
    const std::string_view text = embedded::mapped_json();
    const std::string begin = fmt::format("{{\"unit\": \"{}\",", part.unit);
    for (std::size_t at = 0; (at = text.find(begin, at)) != std::string_view::npos; ++at) {
      const std::string_view row = text.substr(at, text.find('\n', at) - at);
      const Json parameters = object_in(row, "parameters");
      bool same = parameters.is_object();
      for (const auto& [name, wanted] : parameters.items())
        same = same && (name == "in_data" ? Json(in_data) : value_(prefix_ + name)) == wanted;
      if (!same) continue;
      if (Json mapped = object_in(row, "osu018"); mapped.is_object()) return mapped;
    }
    return nullptr;
  }

 private:
  // An object without inner ones; null for a text.
  static Json object_in(std::string_view row, std::string_view name) {
    const std::size_t at = row.find(fmt::format("\"{}\": {{", name));
    if (at == std::string_view::npos) return nullptr;
    const std::size_t begin = row.find('{', at);
    return Json::parse(row.substr(begin, row.find('}', begin) + 1 - begin));
  }

  const ParameterValue& value_;
  std::string prefix_;  // of the engine's parameters
  bool any_ = false;
};

void take_mapped(tb::UnitCost& cost, const Json& row) {
  cost.basis = "mapped";
  cost.gates = within(row["gates"].get<double>(), 0);
  cost.flip_flops = row["flip_flops"].get<std::uint64_t>();
  cost.memory_bits = row["memory_bits"].get<std::uint64_t>();
  if (!row["ns"].is_number()) return;
  cost.ns = within(row["ns"].get<double>(), 0);
  cost.stage = "to " + row["to"].get<std::string>();
}

// Area of the SRAM of each technology of sram.json.
std::vector<tb::SramArea> sram_areas(const tb::Result& result) {
  static const std::vector<std::pair<std::string, Fit>> fits = [] {
    std::vector<std::pair<std::string, Fit>> all;
    const Json json = Json::parse(without_rows(embedded::sram_json()));
    for (const auto& [name, technology] : json.at("technologies").items()) {
      const Json& area = technology.at("um2");
      all.emplace_back(name, Fit(area.at("form").get<std::string>(),
                                 area.at("coefficients").get<std::vector<double>>()));
    }
    return all;
  }();
  std::vector<tb::SramArea> areas;
  for (const auto& [name, fit] : fits) {
    double um2 = 0;
    for (const tb::MemoryFigures& m : result.memories) {
      if (m.kind != "sram") continue;
      const auto macros = static_cast<double>(m.copies * m.banks);
      um2 += macros * fit.at(static_cast<double>(m.word_bits),
                             static_cast<double>(m.words) / static_cast<double>(m.banks));
    }
    areas.push_back({name, um2 / 1e6});
  }
  return areas;
}

}  // namespace

tb::Cost estimate(const tb::Result& result, const ParameterValue& value, const Primitives& p) {
  tb::Cost cost;
  cost.technology = p.technology();
  const MappedRows mapped(value);
  for (const Part& part : parts_of(result)) {
    tb::UnitCost unit = estimated(part, p);
    // The RTL keeps small memories apart, which the unit has in flip-flops.
    if (const Json row = mapped.of(part, result);
        !row.is_null() && (unit.memory_bits > 0 || row["memory_bits"] == 0))
      take_mapped(unit, row);
    if (unit.gates.value > 0 || unit.memory_bits > 0) cost.units.push_back(std::move(unit));
  }
  cost.units.push_back(links_of(result, p));
  for (const tb::UnitCost& unit : cost.units) {
    const bool exact = unit.basis == "mapped";
    cost.gates = cost.gates + (exact ? unit.gates : within(unit.gates.value, kSumRange));
    cost.flip_flops += unit.flip_flops;
    cost.memory_bits += unit.memory_bits;
    cost.estimate.gates += unit.estimate.gates;
    cost.estimate.flip_flops += unit.estimate.flip_flops;
    cost.estimate.ns = std::max(cost.estimate.ns, unit.estimate.ns);
    if (unit.ns.value <= cost.ns.value) continue;
    cost.ns = unit.ns;
    cost.limited_by =
        unit.stage.empty()
            ? unit.name
            : fmt::format("{} {}{}", unit.name, unit.basis == "mapped" ? "" : "stage ", unit.stage);
  }
  const auto mhz = [](double ns) { return ns > 0 ? 1000 / ns : 0; };
  cost.clock_mhz = {mhz(cost.ns.high), mhz(cost.ns.value), mhz(cost.ns.low)};
  if (result.cycles > 0 && !result.interrupted && cost.ns.value > 0) {
    const double million_frames = 1e6 / static_cast<double>(result.cycles);
    const tb::Ranged& clock = cost.clock_mhz;
    cost.frames_per_s = {clock.low * million_frames, clock.value * million_frames,
                         clock.high * million_frames};
    cost.run_frames_per_s = result.clock_mhz * million_frames;
  }
  cost.yardstick_ratio = cost.ns.value / p.multiply_ns();
  cost.sram = sram_areas(result);
  return cost;
}

tb::Cost estimate(const tb::Result& result, const Primitives& p) { return estimate(result, {}, p); }

}  // namespace deburr::tool
