// SPDX-License-Identifier: MIT
// Event counters. Each has a unit and a one-line meaning, from which tables, JSON and docs are
// generated.
// Cost      A 64-bit adder each; a 32-bit register may show part of it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <systemc>

namespace deburr::rtl {

// Declared as a member of the counting unit; its full name follows the hierarchy.
//   Counter lines_fetched_{"lines_fetched", "lines", "cache lines requested from memory"};
class Counter : public sc_core::sc_object {
 public:
  Counter(const char* name, const char* unit, const char* meaning);
  ~Counter() override;
  const char* kind() const override { return "deburr_counter"; }

  Counter& operator++() {
    ++value_;
    return *this;
  }
  Counter& operator+=(std::uint64_t amount) {
    value_ += amount;
    return *this;
  }
  // Keeps the larger value, for high-water marks.
  void raise_to(std::uint64_t value) {
    if (value <= value_) return;
    value_ = value;
    largest_ = true;
  }
  std::uint64_t value() const { return value_; }
  bool is_largest() const { return largest_; }  // a high-water mark: must not be added up
  void reset() { value_ = 0; }

  const std::string& unit() const { return unit_; }  // "lines", "bytes", "clk", ...
  const std::string& meaning() const { return meaning_; }

 private:
  std::uint64_t value_ = 0;
  bool largest_ = false;
  std::string unit_, meaning_;
};

// Calls `visit` for `root` and everything below it in the SystemC hierarchy, in declaration order;
// without a root, for every object of the simulation.
void walk(sc_core::sc_object& root, const std::function<void(sc_core::sc_object&)>& visit);
void walk_all(const std::function<void(sc_core::sc_object&)>& visit);

// The same for objects of one type: for_each<Counter>(unit, [](Counter& c) { ... }).
template <class T, class F>
void for_each(sc_core::sc_object& root, F&& visit) {
  walk(root, [&](sc_core::sc_object& object) {
    if (auto* wanted = dynamic_cast<T*>(&object)) visit(*wanted);
  });
}
template <class T, class F>
void for_each(F&& visit) {
  walk_all([&](sc_core::sc_object& object) {
    if (auto* wanted = dynamic_cast<T*>(&object)) visit(*wanted);
  });
}

}  // namespace deburr::rtl
