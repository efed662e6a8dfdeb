// SPDX-License-Identifier: MIT
#include "rtl_model/fabric/engine.h"

#include <type_traits>

namespace deburr::rtl {
namespace {

const Unit* unit_of_port(const std::string& port) {
  const sc_core::sc_object* const found = sc_core::sc_find_object(port.c_str());
  return found ? dynamic_cast<const Unit*>(found->get_parent_object()) : nullptr;
}
// True for a link between two replaced units of one module: their replacement has its own links.
bool unused(const LinkBase& link) {
  const auto within = [&](const std::string& port) {
    const Unit* const unit = unit_of_port(port);
    return unit && unit->replaced() && unit->get_parent_object() == link.get_parent_object();
  };
  return within(link.producer()) && within(link.consumer());
}

template <class T>
void collect(const sc_core::sc_object& root, std::vector<const T*>& found) {
  for (const sc_core::sc_object* child : root.get_child_objects()) {
    if (const auto* unit = dynamic_cast<const Unit*>(child); unit && unit->replaced()) {
      if constexpr (std::is_same_v<T, Counter>)
        found.insert(found.end(), unit->counted_for_it().begin(), unit->counted_for_it().end());
      continue;
    }
    if constexpr (std::is_same_v<T, LinkBase>)
      if (const auto* link = dynamic_cast<const LinkBase*>(child); link && unused(*link)) continue;
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

Engine::Engine(const sc_core::sc_module_name& name, ClockDomain& clock,
               std::span<const spec::RegisterInfo> table, const ControlLayout& layout)
    : sc_module(name), control("registers", table, layout) {
  clock.adopt(*this);
  control.on_busy([this] { return !idle(); });
  control.on_clear_counters([this] { clear_counters(); });
  clock.on_reset([this] { control.reset(); });
  control.on_interrupt([this, &clock] { clock.notify(interrupt_changed_); });
  interrupt.bind(interrupt_level_);
  SC_METHOD(drive_interrupt);
  sensitive << interrupt_changed_;
  dont_initialize();
}

void Engine::clear_counters() {
  for_each<Counter>(*this, [](Counter& counter) { counter.reset(); });
}

std::vector<const Unit*> Engine::units() const { return below<Unit>(*this); }
std::vector<const Counter*> Engine::counters() const { return below<Counter>(*this); }
std::vector<const MemoryBase*> Engine::memories() const { return below<MemoryBase>(*this); }
std::vector<const Histogram*> Engine::histograms() const { return below<Histogram>(*this); }
std::vector<const LinkBase*> Engine::links() const { return below<LinkBase>(*this); }

// Out of line, to keep the code of its users small.
Engine::~Engine() = default;

}  // namespace deburr::rtl
