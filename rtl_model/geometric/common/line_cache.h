// SPDX-License-Identifier: MIT
// A direct-mapped lookahead cache of memory lines.
//
// Function  The tag half looks up the lines of a token in advance and puts the token into a FIFO;
//           the data half provides the lines when the token leaves the FIFO. Tags change when a
//           line is requested, data when it is used.
// Position  Inside VertexFetch, PairFetch, DepthTest, DepthScreen and WeightCombiner.
// Latency   A tag or a word: 1 in SRAM, 0 in flip-flops. A missed line: memory plus FillStore.
// Interval  1 for a token with one lookup per port; 2 if both miss: one line is requested, one
//           arrives and one is used per cycle.
// Stalls    `no_line` (the line has not arrived), `no_fill` (no fill entry is free), downstream.
// Cost      Tags, data, the FillStore; per port a register and a comparator for the tag.
// Source    docs/reference/geometric/hardware.md, "Caches with lookahead".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "rtl_model/fabric/wire.h"
#include "rtl_model/geometric/common/fill_store.h"
#include "rtl_model/geometric/common/memory_arbiter.h"

namespace deburr::rtl::geometric {

struct LineCacheShape {
  struct Part {
    const char *name, *content;
    std::uint32_t bits;
    MemoryKind kind = MemoryKind::kSram;
    ReadDuringWrite read_during_write = ReadDuringWrite::kForbidden;
  };
  struct Fills {
    const char *name, *content;
    std::int32_t entries;
  };
  std::uint32_t lines, ports;  // lines: a power of two; ports: 1 or 2
  Part tags, data;
  Fills fills;
  Activity no_line, no_fill;
};

template <class Word>
class LineCache {
 public:
  explicit LineCache(const LineCacheShape& s)
      : shape_(s),
        // A lookup sees the line requested by the previous one.
        tags_(s.tags.name, shape_of(s.tags, ReadDuringWrite::kNewWord)),
        data_(s.data.name, shape_of(s.data, s.data.read_during_write)),
        fills_(s.fills.name, s.fills.entries, s.data.bits, s.fills.content) {}

  std::uint32_t lines() const { return shape_.lines; }
  // For a unit that uses the ports while this one does not.
  const ReadPort<std::uint32_t>& tag_port() const { return tag_ports_[0]; }
  const ReadPort<Word>& data_port() const { return data_ports_[0]; }

  // --- Start of a frame: clears the tags, flip-flops at once, SRAM one per cycle ---
  Activity clear(Cycle cycle) {
    if (cleared_ == lines()) return kIdle;
    if (in_flops()) {
      tags_.clear();
      cleared_ = lines();
    } else {
      tag_write_.write(cycle, cleared_++, 0);
    }
    return kBusy;
  }
  // The same, and reports when they are empty.
  Activity clear(Cycle cycle, WireOut<bool>& cleared) {
    const Activity done = clear(cycle);
    if (done == kBusy && cleared_ == lines()) cleared.drive(cycle, true);
    return done;
  }

  // --- Tags ---
  // Reads the tag of a lookup; the lookup of port 0 begins a token.
  void find(Cycle cycle, std::size_t port, std::uint32_t index, std::uint32_t tag) {
    wanted_[port] = {index, tag};
    if (!in_flops()) tag_ports_[port].read(cycle, index);
    two_ = port != 0;
    missed_ = 0;
    found_ = cycle;
    decided_ = kNever;
  }
  // The stored tag; 0 if there is no line.
  std::uint32_t tag(Cycle cycle, std::size_t port) {
    const std::uint32_t index = wanted_[port].index;
    return in_flops() ? tag_ports_[port].now(cycle, index)
                      : tag_ports_[port].at(cycle, index, found_);
  }
  void set_tag(Cycle cycle, std::size_t port) {
    tag_write_.write(cycle, wanted_[port].index, wanted_[port].tag);
  }
  // Returns kIdle, or the stall cause.
  Activity can_request(Cycle cycle, const MemoryClient& memory) const {
    if (!fills_.can_reserve(cycle)) return shape_.no_fill;
    return memory.requests_out.can_push(cycle) ? kIdle : kStalledDownstream;
  }
  void request(Cycle cycle, MemoryClient& memory, std::uint32_t address) {
    memory.read(cycle, address, fills_.reserve());
  }
  // Compares the tags and requests the missed lines, each from `address(port)`. kIdle: done; kBusy:
  // another request follows in the next cycle.
  template <class Address>
  Activity look_up(Cycle cycle, MemoryClient& memory, const Address& address) {
    const auto fetch = [&](std::size_t port) {
      const Activity can = can_request(cycle, memory);
      if (can != kIdle) return can;
      request(cycle, memory, address(port));
      set_tag(cycle, port);
      missed_ |= static_cast<std::uint8_t>(1u << port);
      return kIdle;
    };
    if (decided_ != kNever) return fetch(1);
    const bool first = misses(cycle, 0);
    // The first lookup's line may replace that of the second.
    const bool second =
        two_ && (misses(cycle, 1) || (first && wanted_[0].index == wanted_[1].index));
    if (first)
      if (const Activity done = fetch(0); done != kIdle) return done;
    decided_ = cycle;
    return !second ? kIdle : first ? kBusy : fetch(1);
  }
  // Number of lookups decided in this cycle, for counters.
  std::uint32_t decided(Cycle cycle) const { return decided_ == cycle ? 1 + two_ : 0; }
  // Bit k: the token's lookup through port k missed.
  std::uint8_t missed() const { return missed_; }

  // --- Data, in the order of requests ---
  // Returns kIdle, or the stall cause.
  Activity can_take(Cycle cycle) const { return fills_.ready(cycle) ? kIdle : shape_.no_line; }
  const Word& take(Cycle cycle) {
    const Word& line = fills_.line(cycle);
    fills_.release(cycle);
    return line;
  }
  // Installs the lines that a token missed, one per cycle, each used by `take_line(port, line)`;
  // then reads its other words. `missed` and `others` hold one bit per port. kIdle: done.
  template <class Index, class Take>
  Activity collect(Cycle cycle, const Index* index, std::uint32_t missed, std::uint32_t others,
                   const Take& take_line) {
    if (const std::uint32_t left = missed & ~installed_; left != 0) {
      if (const Activity can = can_take(cycle); can != kIdle) return can;
      const std::size_t port = left & 1 ? 0 : 1;
      const Word& line = take(cycle);
      write(cycle, index[port], line);
      take_line(port, line);
      installed_ |= 1u << port;
      if (left == 3) return kBusy;
    }
    installed_ = 0;
    for (std::size_t port = 0; port < 2; ++port)
      if (others >> port & 1) read(cycle, port, index[port]);
    return kIdle;
  }
  void write(Cycle cycle, std::uint32_t index, const Word& word) {
    data_write_.write(cycle, index, word);
  }
  void read(Cycle cycle, std::size_t port, std::uint32_t index) {
    data_ports_[port].read(cycle, index);
  }
  const Word& word(Cycle cycle, std::size_t port, std::uint32_t index) const {
    return data_ports_[port].at(cycle, index);
  }

  // --- Call last in each cycle ---
  // Stores the arriving lines, decoded by `decode(word, line)`, and returns the unit's activity
  // from that of its data and tag halves.
  template <class Decode>
  Activity finish(Cycle cycle, MemoryClient& memory, Activity data, Activity tags,
                  const Decode& decode) {
    bool did = data == kBusy || tags == kBusy;
    if (memory.responses_in.can_pop(cycle)) {
      const MemoryResponse& response = memory.responses_in.take(cycle);
      Word word;
      decode(word, response.data);
      fills_.fill(cycle, response.tag, word);
      did = true;
    }
    fills_.read_ahead(cycle);
    cleared_ = 0;
    return did ? kBusy : data != kIdle ? data : tags;
  }
  void reset() {
    fills_.reset();
    cleared_ = installed_ = 0;
  }

 private:
  struct Wanted {
    std::uint32_t index, tag;
  };
  template <class T>
  using ReadPorts = std::array<ReadPort<T>, 2>;

  MemoryShape shape_of(const LineCacheShape::Part& part, ReadDuringWrite in_sram) const {
    const bool sram = part.kind == MemoryKind::kSram;
    return {.words = shape_.lines,
            .word_bits = part.bits,
            .kind = part.kind,
            .read_ports = shape_.ports,
            .latency = sram,
            .read_during_write = sram ? in_sram : ReadDuringWrite::kForbidden,
            .content = part.content};
  }
  template <class T>
  ReadPorts<T> ports_of(Memory<T>& memory) const {
    const ReadPort<T> first{memory, "first"};
    return {first, shape_.ports == 2 ? ReadPort<T>{memory, "second"} : first};
  }
  bool in_flops() const { return shape_.tags.kind == MemoryKind::kFlops; }
  bool misses(Cycle cycle, std::size_t port) { return tag(cycle, port) != wanted_[port].tag; }

  const LineCacheShape shape_;
  Memory<std::uint32_t> tags_;
  ReadPorts<std::uint32_t> tag_ports_ = ports_of(tags_);
  WritePort<std::uint32_t> tag_write_{tags_, "requests"};
  Memory<Word> data_;
  ReadPorts<Word> data_ports_ = ports_of(data_);
  WritePort<Word> data_write_{data_, "install"};
  FillStore<Word> fills_;
  std::uint32_t cleared_ = 0;  // U11, number of cleared tags

  // Of the token being looked up.
  std::array<Wanted, 2> wanted_{};
  bool two_ = false;
  std::uint8_t missed_ = 0;
  Cycle found_ = 0, decided_ = kNever;  // cycles: tags addressed, first lookup decided
  // Of the token being collected, bit k: port k is installed.
  std::uint32_t installed_ = 0;
};

}  // namespace deburr::rtl::geometric
