// SPDX-License-Identifier: MIT
// A FIFO inside a unit: the link's protocol (latency 1, initiation interval 1, one push and one pop
// a cycle), with its storage counted and its fill level recorded.
// Cost: depth x entry_bits of storage (registers or SRAM, one read and one write port).
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/counters.h"
#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/storage.h"

namespace deburr::rtl {

template <class T>
class Fifo final : public Storage {
 public:
  // `entry_bits`: bits of one entry in hardware (a C++ struct has padding).
  Fifo(const char* name, std::uint32_t depth, std::uint32_t entry_bits)
      : Storage(name, depth, entry_bits, "1R1W"), link_(inner_name("entries").c_str(), depth) {}

  bool can_push(Cycle cycle) const { return link_.can_push(cycle); }
  bool can_pop(Cycle cycle) const { return link_.can_pop(cycle); }
  const T& front(Cycle cycle) const { return link_.front(cycle); }
  void pop(Cycle cycle) { link_.pop(cycle); }
  T take(Cycle cycle) { return link_.take(cycle); }
  void push(Cycle cycle, const T& value) {
    link_.push(cycle, value);
    if (link_.occupancy() > high_water_) high_water_ = link_.occupancy();
  }

  std::uint32_t occupancy() const { return link_.occupancy(); }
  bool empty() const { return link_.empty(); }
  // Largest number of entries since reset.
  std::uint32_t high_water() const { return high_water_; }
  // For a consumer in another unit: bind its port to this.
  Link<T>& link() { return link_; }
  void reset() override {
    link_.reset();
    high_water_ = 0;
  }

 private:
  Link<T> link_;
  std::uint32_t high_water_ = 0;
};

}  // namespace deburr::rtl
