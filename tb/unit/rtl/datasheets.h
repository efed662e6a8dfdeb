// SPDX-License-Identifier: MIT
// Compares the cycles of simulated units with their datasheets, and lists the units that have one.
#pragma once

#include <cxxabi.h>
#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <string>
#include <typeinfo>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/engine.h"
#include "rtl_model/fabric/unit.h"

namespace deburr::tb {

// `seen`: cycles in which tokens can be popped from the output of a unit that is never short of
// input and popped the first token in `taken`.
inline void expect_cycles(const rtl::Datasheet& sheet, const std::vector<rtl::Cycle>& seen,
                          rtl::Cycle taken) {
  ASSERT_FALSE(seen.empty());
  std::vector<rtl::Cycle> expected;
  for (std::size_t i = 0; i < seen.size(); ++i)
    expected.push_back(taken + sheet.latency.cycles + i * sheet.interval.cycles);
  EXPECT_EQ(seen, expected) << "by the datasheet of " << title(sheet);
}
inline void expect_latency(const rtl::Datasheet& sheet, rtl::Cycle measured) {
  EXPECT_EQ(measured, sheet.latency.cycles) << "by the datasheet of " << title(sheet);
}
inline void expect_interval(const rtl::Datasheet& sheet, rtl::Cycle measured) {
  EXPECT_EQ(measured, sheet.interval.cycles) << "by the datasheet of " << title(sheet);
}

// Injected fault: the check must fail with a datasheet that is one cycle off in either direction.
template <class Check>
void expect_detects_one_cycle(const rtl::Datasheet& sheet, rtl::Cycles rtl::Datasheet::*which,
                              const Check& check) {
  rtl::Datasheet less = sheet, more = sheet;
  --(less.*which).cycles;
  ++(more.*which).cycles;
  check(sheet);
  EXPECT_NONFATAL_FAILURE(check(less), "by the datasheet of");
  EXPECT_NONFATAL_FAILURE(check(more), "by the datasheet of");
}

// Class name without namespaces.
inline std::string class_of(const sc_core::sc_object& unit) {
  const std::unique_ptr<char, decltype(&std::free)> name(
      abi::__cxa_demangle(typeid(unit).name(), nullptr, nullptr, nullptr), &std::free);
  const std::string whole = name.get();
  return whole.substr(whole.rfind(':') + 1);
}

// Each unit of the engine has a datasheet; that of the memory port belongs to the fabric.
inline void expect_datasheets(const rtl::Engine& engine,
                              const std::vector<rtl::Datasheet>& sheets) {
  for (const rtl::Unit* unit : engine.units()) {
    const std::string name = class_of(*unit);
    const bool found = std::any_of(sheets.begin(), sheets.end(),
                                   [&](const rtl::Datasheet& sheet) { return sheet.unit == name; });
    EXPECT_TRUE(found || name == "MemoryPort") << name << " has no datasheet";
  }
}

// The numbers of the contract, written by hand, so that datasheet and hardware cannot change
// together.
struct Contract {
  std::string title;
  rtl::Cycle latency, interval;
};
// Cycles of a stage: "4", "5-17", "18, 19", or "4 = 0'", which is 4. A stage begins after the first
// cycle of its predecessor, and at the latest in the cycle after its last one.
inline void expect_stages_in_order(const rtl::Datasheet& sheet) {
  int first = -1, last = 0;
  for (const rtl::Stage& stage : sheet.stages) {
    // "-", "from 3", "last": no fixed cycle, nor have the stages after it.
    if (!std::isdigit(static_cast<unsigned char>(stage.clock.front()))) return;
    const int begin = std::stoi(stage.clock);
    EXPECT_GT(begin, first) << title(sheet) << ", stage " << stage.clock;
    EXPECT_LE(begin, last + 1) << title(sheet) << ", stage " << stage.clock;
    const std::size_t behind = stage.clock.find_first_of("-,");
    first = begin;
    last = behind == std::string::npos ? begin : std::stoi(stage.clock.substr(behind + 1));
    EXPECT_GE(last, first) << title(sheet) << ", stage " << stage.clock;
  }
}

inline void expect_contract(const std::vector<rtl::Datasheet>& sheets,
                            const std::vector<Contract>& contract) {
  for (const rtl::Datasheet& sheet : sheets) {
    const auto row = std::find_if(contract.begin(), contract.end(),
                                  [&](const Contract& c) { return c.title == title(sheet); });
    if (row == contract.end()) {
      ADD_FAILURE() << "no number by hand of " << title(sheet);
      continue;
    }
    EXPECT_EQ(sheet.latency.cycles, row->latency) << row->title;
    EXPECT_EQ(sheet.interval.cycles, row->interval) << row->title;
    expect_stages_in_order(sheet);
  }
  EXPECT_EQ(sheets.size(), contract.size());
}

}  // namespace deburr::tb
