// SPDX-License-Identifier: MIT
// Function  FIFO inside a unit with the link protocol; counts its storage and records its fill
//           level.
// Latency   1.
// Interval  1: one push and one pop per cycle.
// Cost      depth x payload bits of memory; with SRAM, two registers of the payload in addition.
//
// Up to kMostFlopWords entries and MemoryBase::kMostFlopBits it is built of flip-flops; beyond, the
// multiplexer for the oldest entry would be the longest path. Larger FIFOs use 1R1W SRAM with two
// prefetched output registers. A beat bypasses the SRAM while these have room: so the latency stays
// 1, and no word is read in the cycle that writes it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/memory.h"

namespace deburr::rtl {

template <class T>
class Fifo final : public MemoryBase {
 public:
  static constexpr std::uint32_t kMostFlopWords = 32;

  explicit Fifo(const char* name, std::uint32_t depth, const PayloadShape& shape = {})
      : Fifo(name, depth, Payload::of<T>(shape).bits(), shape) {}

  bool can_push(Cycle cycle) const { return link_.can_push(cycle); }
  bool can_pop(Cycle cycle) const { return link_.can_pop(cycle); }
  const T& front(Cycle cycle) const { return link_.front(cycle); }
  void pop(Cycle cycle) { link_.pop(cycle); }
  const T& take(Cycle cycle) { return link_.take(cycle); }
  void push(Cycle cycle, const T& value) {
    link_.push(cycle, value);
    // An entry popped in this cycle becomes free in the next one, whichever side is ticked first.
    const std::uint32_t used = link_.occupancy() + (link_.last_pop() == cycle ? 1 : 0);
    high_water_ = std::max<std::uint64_t>(high_water_, used);
  }

  std::uint32_t occupancy() const { return link_.occupancy(); }
  bool empty() const { return link_.empty(); }
  // Largest number of entries in use in a cycle, including one that is popped in it.
  std::optional<std::uint64_t> high_water() const override { return high_water_; }
  std::uint64_t reads() const override { return link_.pops(); }
  std::uint64_t writes() const override { return link_.pushes(); }
  // For a consumer in another unit, which binds its port to this link.
  Link<T>& link() { return link_; }
  std::vector<const sc_core::sc_object*> port_holders() const override {
    std::vector<const sc_core::sc_object*> holders;
    for (const std::string& port : {link_.producer(), link_.consumer()})
      if (const auto* holder = sc_core::sc_find_object(port.c_str())) holders.push_back(holder);
    return holders;
  }
  void reset() override {
    link_.reset();
    high_water_ = 0;
  }

 private:
  Fifo(const char* name, std::uint32_t depth, std::uint32_t bits, const PayloadShape& shape)
      : MemoryBase(name, memory_shape(depth, bits)),
        link_(inner_name("entries").c_str(), depth, shape) {
    link_.set_memory(*this);
  }
  static MemoryShape memory_shape(std::uint32_t depth, std::uint32_t bits) {
    const MemoryKind kind =
        depth > kMostFlopWords ? MemoryKind::kSram : kind_for(std::uint64_t{depth} * bits);
    const bool flops = kind == MemoryKind::kFlops;
    return {.words = depth,
            .word_bits = bits,
            .kind = kind,
            .latency = flops ? 0U : 1U,
            .content = "entries of a FIFO",
            .register_bits = flops ? 0 : std::uint64_t{2} * bits};
  }

  Link<T> link_;
  std::uint64_t high_water_ = 0;
};

}  // namespace deburr::rtl
