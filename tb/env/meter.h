// SPDX-License-Identifier: MIT
// Base class that collects an engine's figures for a result: units, memories, counters and own
// values, under its environment's name in a composition.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rtl_model/fabric/counters.h"
#include "rtl_model/fabric/engine.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/platform/memory_model.h"
#include "tb/harness/observer.h"
#include "tb/run/picture_map.h"
#include "tb/run/result.h"

namespace deburr::tb {

class Meter {
 public:
  // `name`: of the environment; empty outside a composition.
  explicit Meter(std::string name) : name_(std::move(name)) {}

  std::vector<PictureMap> named(std::vector<PictureMap> maps) const;

 protected:
  // "fragments" -> "texture_fragments"
  std::string figure(std::string_view name) const;
  std::string key(std::string_view name) const { return "work." + figure(name); }
  void add(Result& result, std::string_view name, WorkValue value, std::string unit,
           std::string meaning) const;
  void add(Result& result, std::string_view name, const rtl::Counter& counter) const;
  void add(Result& result, std::string_view name, const rtl::Unit& unit) const;
  void add(Result& result, std::string_view name, const rtl::MemoryBase& memory, int width) const;
  static void add(Result& result, const platform::MemoryModel& memory);
  // Adds units and memories of the engine, for frames of this width; 0: no size depends on a width.
  void add_parts(Result& result, const rtl::Engine& engine, int width) const;
  void add_counters(Result& result, const rtl::Engine& engine) const;
  // Shows all units, counters, links and memory ports of the engine.
  void show(Observer& observer, const rtl::Engine& engine) const;
  // Shows a link outside every engine, named by the port that it is bound to.
  void show(Observer& observer, std::string_view port, const rtl::LinkBase& link) const {
    observer.see(figure(port), link);
  }

 private:
  std::string name_;
};

inline double number(std::uint64_t value) { return static_cast<double>(value); }
inline double ratio(double a, double b) { return b > 0 ? a / b : 0.0; }
inline double ratio(std::uint64_t a, std::uint64_t b) { return ratio(number(a), number(b)); }
// Clock for 60 frames per second, in MHz.
inline double clock_for_60(std::uint64_t frame_cycles) { return number(frame_cycles) * 60 / 1e6; }

}  // namespace deburr::tb
