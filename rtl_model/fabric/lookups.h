// SPDX-License-Identifier: MIT
// What a cache shows of its lookups to traces and checks. A base class of the unit that performs
// the lookups; find all with for_each<Lookups>. Costs one comparison per lookup when not observed.
#pragma once

#include <cstdint>
#include <functional>

#include "rtl_model/fabric/clocked.h"

namespace deburr::rtl {

// The line is present, its fill is pending, or its fill is requested in this cycle.
enum class LookUp : std::uint8_t { kHit, kMerged, kMiss };

class Lookups {
 public:
  virtual ~Lookups() = default;
  // Called with the line number and result of every lookup, in order.
  std::function<void(Cycle, std::uint32_t line, LookUp)> observer;
  // The address of a line is its number times this.
  std::uint32_t watched_line_bytes() const { return line_bytes_; }

 protected:
  explicit Lookups(std::uint32_t line_bytes) : line_bytes_(line_bytes) {}
  Lookups(const Lookups&) = default;
  Lookups& operator=(const Lookups&) = default;

 private:
  std::uint32_t line_bytes_;
};

}  // namespace deburr::rtl
