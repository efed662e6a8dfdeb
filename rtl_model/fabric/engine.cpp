// SPDX-License-Identifier: MIT
#include "rtl_model/fabric/engine.h"

#include <fmt/format.h>

namespace deburr::rtl {
namespace {

template <class T>
void collect(const sc_core::sc_object& root, std::vector<const T*>& found) {
  for (const sc_core::sc_object* child : root.get_child_objects()) {
    if (const auto* wanted = dynamic_cast<const T*>(child)) found.push_back(wanted);
    collect(*child, found);
  }
}
template <class T>
std::vector<const T*> below(const sc_core::sc_object& root) {
  std::vector<const T*> found;
  collect(root, found);
  return found;
}

}  // namespace

void RangeCheck::refuse_range(std::string_view name, std::int32_t value, std::int32_t min,
                              std::int32_t max, std::string_view unit) const {
  throw spec::ConfigError(
      fmt::format("{}.{}: expected {}..{} {}, got {}", unit_, name, min, max, unit, value));
}

void RangeCheck::refuse_choice(std::string_view name, int value,
                               std::span<const std::string_view> names) const {
  std::string known;
  for (const std::string_view one : names)
    known += fmt::format("{}{}", known.empty() ? "" : ", ", one);
  throw spec::ConfigError(
      fmt::format("{}.{}: no such choice: {}; expected one of {}", unit_, name, value, known));
}

Engine::Engine(const sc_core::sc_module_name& name, ClockDomain& clock,
               std::span<const spec::RegisterInfo> table, const ControlLayout& layout)
    : sc_module(name), control("registers", table, layout) {
  control.on_busy([this] { return !idle(); });
  control.on_clear_counters([this] { clear_counters(); });
  clock.on_reset([this] { control.reset(); });
}

void Engine::clear_counters() {
  for_each<Counter>(*this, [](Counter& counter) { counter.reset(); });
}

std::vector<const Unit*> Engine::units() const { return below<Unit>(*this); }
std::vector<const Counter*> Engine::counters() const { return below<Counter>(*this); }
std::vector<const MemoryBase*> Engine::memories() const { return below<MemoryBase>(*this); }
std::vector<const Histogram*> Engine::histograms() const { return below<Histogram>(*this); }
std::vector<const LinkBase*> Engine::links() const { return below<LinkBase>(*this); }

}  // namespace deburr::rtl
