// SPDX-License-Identifier: MIT
#include "tb/run/result.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "spec/error.h"
#include "tb/base/file.h"
#include "tb/base/json_text.h"
#include "tb/run/result_description.h"

namespace deburr::tb {
namespace {

using Json = nlohmann::ordered_json;
using spec::FileError;

// Converts values to what a reader of the file gets, so that pages made before and after writing
// are equal: non-negative numbers become unsigned, and non-finite numbers become null.
template <class T>
Json json_of(const T& value) {
  if constexpr (std::is_floating_point_v<T>)
    return std::isfinite(value) ? Json(value) : Json();
  else if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>)
    return std::cmp_less(value, 0) ? Json(value) : Json(static_cast<std::uint64_t>(value));
  else
    return Json(value);
}
Json json_of(const WorkValue& value) {
  return std::visit(
      [](auto known) {
        if constexpr (std::is_same_v<decltype(known), std::monostate>)
          return Json();
        else
          return json_of(known);
      },
      value);
}
Json json_of(const std::optional<double>& value) { return value ? json_of(*value) : Json(); }
Json json_of(const std::vector<LatencyBin>& bins) {
  Json json = Json::array();
  for (const LatencyBin& bin : bins) json.push_back({{"from", bin.from}, {"count", bin.count}});
  return json;
}
Json json_of(const std::vector<MismatchLine>& lines) {
  Json json = Json::array();
  for (const MismatchLine& m : lines)
    json.push_back({{"check", m.check},
                    {"where", m.where},
                    {"item", m.item},
                    {"field", m.field},
                    {"expected", m.expected},
                    {"got", m.got}});
  return json;
}
Json json_of(const std::vector<PixelStep>& steps) {
  Json json = Json::array();
  for (const PixelStep& s : steps)
    json.push_back({{"part", s.part},
                    {"step", s.step},
                    {"item", s.item},
                    {"golden", s.golden},
                    {"hardware", s.hardware},
                    {"clock", s.clock ? Json(*s.clock) : Json()},
                    {"differs", s.differs}});
  return json;
}
Json json_of(const std::vector<Figure>& figures) {
  Json json = Json::array();
  for (const Figure& figure : figures) {
    Json entry = {{"label", figure.label}, {"key", figure.key}};
    if (!figure.against_label.empty()) entry["against"] = {{"label", figure.against_label}};
    if (!figure.against.empty()) entry["against"]["key"] = figure.against;
    if (figure.tile) entry["tile"] = true;
    json.push_back(entry);
  }
  return json;
}

// Writes the file and collects unit and meaning of each value by its path: "units.address.busy".
class ResultWriter {
 public:
  explicit ResultWriter(const Result& result) { describe(result, *this); }
  Json file() && {
    Json meanings = Json::object();
    for (auto* const list : {&meanings_, &last_meanings_})
      for (auto& [path, meaning] : *list) meanings[path] = std::move(meaning);
    json_["meaning"] = std::move(meanings);
    return std::move(json_);
  }

  bool has(bool there) const { return there; }
  template <class T>
  void value(std::string_view name, const T& value, std::string_view unit,
             std::string_view meaning) {
    within(name, [&] { item(value, unit, meaning); });
  }
  // Many values that share one meaning.
  void value(std::string_view name, const std::map<std::string, std::uint64_t>& values,
             std::string_view unit, std::string_view meaning) {
    within(name, [&] { declared_item(values, unit, meaning); });
  }
  template <class Body>
  void group(std::string_view name, const Body& body) {
    within(name, [&] {
      *node_ = Json::object();
      body();
    });
  }
  template <class Items, class Key, class Body>
  void each(std::string_view name, const Items& items, Key key, const Body& body) {
    group(name, [&] {
      for (const auto& item : items) group(item.*key, [&] { body(item); });
    });
  }
  template <class T>
  void item(const T& value, std::string_view unit, std::string_view meaning) {
    *node_ = json_of(value);
    meanings_.emplace_back(path_, Json{{"unit", unit}, {"meaning", meaning}});
  }
  template <class T>
  void item(const T& value, std::string_view unit, std::string_view, std::string_view own) {
    item(value, unit, own);
  }
  // Entries declared by an engine follow those that every engine has.
  template <class T>
  void declared_item(const T& value, std::string_view unit, std::string_view meaning) {
    *node_ = json_of(value);
    last_meanings_.emplace_back(path_, Json{{"unit", unit}, {"meaning", meaning}});
  }

 private:
  template <class Body>
  void within(std::string_view name, const Body& body) {
    Json* const outer = node_;
    const std::size_t length = path_.size();
    path_ += fmt::format("{}{}", path_.empty() ? "" : ".", name);
    node_ = &(*outer)[std::string(name)];
    body();
    node_ = outer;
    path_.resize(length);
  }

  Json json_;
  Json* node_ = &json_;
  std::string path_;
  std::vector<std::pair<std::string, Json>> meanings_, last_meanings_;
};

}  // namespace

Json to_json(const Result& result) { return ResultWriter(result).file(); }

// ---- memories -----------------------------------------------------------------------------------

std::vector<MemoryBits> memory_bits(std::span<const MemoryFigures> memories,
                                    const LinkBits& links) {
  std::vector<MemoryBits> all = {{"flops"}, {"sram"}, {"rom"}, {"total"}};
  for (const MemoryFigures& m : memories)
    for (MemoryBits& bits : all) {
      if (bits.kind != m.kind && bits.kind != "total") continue;
      ++bits.memories;
      bits.logical += m.logical_bits;
      bits.physical += m.physical_bits;
      bits.logical_at_frame_width += m.logical_bits_at_frame_width;
    }
  MemoryBits registers{"registers"};
  for (const MemoryFigures& m : memories) {
    if (m.register_bits == 0) continue;
    ++registers.memories;
    registers.logical += m.register_bits;
  }
  registers.physical = registers.logical_at_frame_width = registers.logical;
  all.push_back(registers);
  all.push_back({"links", links.links, links.bits, links.bits, links.bits});
  std::erase_if(all, [](const MemoryBits& b) { return b.kind != "total" && b.memories == 0; });
  return all;
}

std::vector<std::string> not_implementable_memories(const Json& result) {
  std::vector<std::string> all;
  const auto found = result.find("not_implementable");
  if (found == result.end() || !found->is_object()) return all;
  for (const auto& [name, why] : found->items())
    all.push_back(fmt::format("{} ({})", name, why.is_string() ? why.get<std::string>() : "?"));
  return all;
}

// ---- the bottleneck -----------------------------------------------------------------------------

namespace {

constexpr std::string_view kDownstream = "downstream";
// A unit that stalls with this cause waits for the unit that completes run descriptors.
constexpr std::string_view kDescriptors = "descriptors";
constexpr std::array<std::string_view, 5> kFinishDescriptors = {
    "endpoint_predictor_h", "endpoint_predictor_v", "line_unit_h", "line_unit_v", "area_unit"};
// Fractions of a unit's cycles: stalls below kNegligible are not a bottleneck; units within kTie
// are equally busy.
constexpr double kNegligible = 0.01, kTie = 0.001;

double cycles_of(const UnitCycles& unit) {
  std::uint64_t cycles = unit.busy + unit.idle;
  for (const StallCycles& stall : unit.stalls) cycles += stall.cycles;
  return static_cast<double>(cycles);
}
double share(std::uint64_t cycles, const UnitCycles& unit) {
  const double all = cycles_of(unit);
  return all > 0 ? static_cast<double>(cycles) / all : 0.0;
}

// The first among the busiest units.
template <class Wanted>
const UnitCycles* busiest(std::span<const UnitCycles> units, Wanted wanted) {
  const UnitCycles* found = nullptr;
  for (const UnitCycles& unit : units)
    if (wanted(unit) && (!found || share(unit.busy, unit) > share(found->busy, *found) + kTie))
      found = &unit;
  return found;
}

Bottleneck busy(const UnitCycles& unit) {
  return {unit.name, "busy", std::string(find_statistic("units.*.busy")->meaning), unit.busy};
}

}  // namespace

std::optional<Bottleneck> find_bottleneck(std::span<const UnitCycles> units,
                                          std::string_view output) {
  DEBURR_CHECK(units.empty() || std::any_of(units.begin(), units.end(),
                                            [&](const UnitCycles& u) { return u.name == output; }),
               fmt::format("no unit '{}' among those of the pipeline", output));
  struct Loss {
    const UnitCycles* unit;
    const StallCycles* stall;
    double share;
  };
  std::vector<Loss> losses;
  double largest = 0;
  for (const UnitCycles& unit : units)
    for (const StallCycles& stall : unit.stalls) {
      if (stall.cause == kDownstream && unit.name != output) continue;
      losses.push_back({&unit, &stall, share(stall.cycles, unit)});
      largest = std::max(largest, losses.back().share);
    }
  // A stall that does not reach the head of the pipeline costs nothing, since a FIFO absorbs it.
  const auto head = std::find_if(units.begin(), units.end(),
                                 [](const UnitCycles& unit) { return unit.busy > 0; });
  const bool felt =
      head != units.end() && 1 - share(head->busy, *head) - share(head->idle, *head) >= kNegligible;
  if (!felt || largest < kNegligible) {
    const UnitCycles* unit = busiest(units, [](const UnitCycles&) { return true; });
    if (!unit || unit->busy == 0) return std::nullopt;
    return busy(*unit);
  }
  const Loss* deepest = nullptr;
  for (const Loss& loss : losses) {
    if (loss.share < largest / 2) continue;
    // The two axes work in parallel, not in sequence.
    const bool beside = deepest && deepest->stall->cause == loss.stall->cause &&
                        deepest->unit->name.ends_with("_h") && loss.unit->name.ends_with("_v");
    if (!beside || loss.share > deepest->share) deepest = &loss;
  }
  if (deepest->stall->cause == kDescriptors) {
    const UnitCycles* unit = busiest(units, [](const UnitCycles& u) {
      return std::any_of(kFinishDescriptors.begin(), kFinishDescriptors.end(),
                         [&](std::string_view name) { return u.name.ends_with(name); });
    });
    if (unit) return busy(*unit);
  }
  return Bottleneck{deepest->unit->name, deepest->stall->cause, deepest->stall->meaning,
                    deepest->stall->cycles};
}

Json read_result(const std::filesystem::path& path) {
  const std::filesystem::path file = is_folder(path) ? path / "result.json" : path;
  Json json = try_parse_json(read_file(file, kMaxResultBytes));
  if (json.is_discarded()) throw FileError(fmt::format("'{}' is not valid JSON", file.string()));
  if (!json.is_object() || json.value("schema", Json()) != kResultSchema)
    throw FileError(fmt::format("'{}' is not a result of schema {}", file.string(), kResultSchema));
  for (const char* key : {"unit", "verdict", "checks", "cycles", "throughput", "latency", "memory",
                          "units", "memories", "memory_bits", "work", "host"})
    if (!json.contains(key))
      throw FileError(fmt::format("'{}' is incomplete: '{}' is missing", file.string(), key));
  return with_infinity(std::move(json));
}

const Statistic* find_statistic(std::string_view key) {
  // The longest matching pattern wins: "units.*.busy" before "units.*".
  const auto matches = [](std::string_view pattern, std::string_view name) {
    while (!pattern.empty() && !name.empty()) {
      const std::string_view p = pattern.substr(0, pattern.find('.'));
      const std::string_view n = name.substr(0, name.find('.'));
      if (p != "*" && p != n) return false;
      pattern.remove_prefix(std::min(pattern.size(), p.size() + 1));
      name.remove_prefix(std::min(name.size(), n.size() + 1));
    }
    return pattern.empty() && name.empty();
  };
  const Statistic* best = nullptr;
  for (const Statistic& s : statistics())
    if (matches(s.name, key) && (!best || s.name.size() > best->name.size())) best = &s;
  return best;
}

}  // namespace deburr::tb
