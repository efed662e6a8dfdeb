// SPDX-License-Identifier: MIT
// What a cache shows of its look-ups, to traces and checks.
//
// Where: a base of the unit that looks lines up; for_each<Lookups> finds them all. Costs a
// comparison a look-up where nobody watches.
#pragma once

#include <cstdint>
#include <functional>

#include "rtl_model/fabric/clocked.h"

namespace deburr::rtl {

// The line is there, its fill is under way, or its fill is ordered in this clock.
enum class LookUp : std::uint8_t { kHit, kMerged, kMiss };

class Lookups {
 public:
  virtual ~Lookups() = default;
  // Sees the number of every line that is looked up, in order, and what came of it.
  std::function<void(Cycle, std::uint32_t line, LookUp)> observer;
  // A line's number times this is its address.
  std::uint32_t watched_line_bytes() const { return line_bytes_; }

 protected:
  explicit Lookups(std::uint32_t line_bytes) : line_bytes_(line_bytes) {}
  Lookups(const Lookups&) = default;
  Lookups& operator=(const Lookups&) = default;

 private:
  std::uint32_t line_bytes_;
};

}  // namespace deburr::rtl
