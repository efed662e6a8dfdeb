// SPDX-License-Identifier: MIT
// A direct-mapped cache of lines of memory that looks ahead: fetches the lines that tokens need, in
// the order of the tokens.
//
// Function  The unit looks a token up, keeps it in a FIFO, and uses the lines when the token leaves
//           the FIFO. Tags change when a line is requested, data when it is used. So a line that is
//           replaced has been used by all tokens before, and many misses are under way at a time.
// Position  Inside VertexFetch, PairFetch, DepthTest, DepthScreen and WeightCombiner.
// Latency   Tags and data: 1 in SRAM, 0 in flip-flops. A missed line: that of the FillStore.
// Interval  One token per cycle, of a lookup per port; 2 if both miss, since one line is requested
//           per cycle. One line arrives and one is used per cycle.
// Stalls    The unit's cause `fills` (no entry for a line is free), downstream (memory takes no
//           request). The unit waits while its line is not ready().
// Cost      Tags, data, a FillStore, and per port a tag and its compare.
// Source    docs/reference/geometric/hardware.md, "Caches with a look ahead".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "rtl_model/fabric/clocked.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/geometric/common/fill_store.h"
#include "rtl_model/geometric/common/memory_arbiter.h"

namespace deburr::rtl::geometric {

struct LineCacheShape {
  struct Part {
    const char* name;
    std::uint32_t bits;
    const char* content;
    MemoryKind kind = MemoryKind::kSram;
    ReadDuringWrite read_during_write = ReadDuringWrite::kForbidden;
  };
  std::uint32_t lines;  // a power of two
  Part tags, data;
  const char *fills, *fills_content;
  std::int32_t fill_entries;
};

template <class Word, std::size_t kPorts>
class LineCache {
  static_assert(kPorts == 1 || kPorts == 2);

 public:
  // `no_fill`: the stall of a lookup that finds no entry free.
  LineCache(const LineCacheShape& s, Activity no_fill)
      : lines_(s.lines),
        // A lookup sees the line that the one before it has requested.
        tags_(s.tags.name, shape_of(s.lines, s.tags, ReadDuringWrite::kNewWord)),
        data_(s.data.name, shape_of(s.lines, s.data, s.data.read_during_write)),
        fills_(s.fills, s.fill_entries, s.data.bits, s.fills_content),
        no_fill_(no_fill) {}

  std::uint32_t lines() const { return lines_; }
  // Handles for a unit that uses the ports while this one does not.
  const ReadPort<std::uint32_t>& tag_port() const { return tag_ports_[0]; }
  const ReadPort<Word>& data_port() const { return data_ports_[0]; }

  // --- Before a frame's first lookup ---
  // Empties the tags: flip-flops at once, SRAM one per cycle. kIdle: they are empty.
  Activity clear(Cycle cycle) {
    if (cleared()) return kIdle;
    if (in_flops_) {
      tags_.clear();
      cleared_ = lines_;
    } else {
      tag_write_.write(cycle, cleared_++, 0);
    }
    return kBusy;
  }
  bool cleared() const { return cleared_ == lines_; }

  // --- Tags ---
  // Addresses the tag at `index` for a line of this tag, which is not 0. Port 0 begins a token.
  void find(Cycle cycle, std::size_t port, std::uint32_t index, std::uint32_t tag) {
    wanted_[port] = {index, tag};
    if (!in_flops_) tag_ports_[port].read(cycle, index);
    if (port != 0) {
      two_ = true;
      return;
    }
    found_ = cycle;
    two_ = false;
    missed_ = 0;
    decided_ = kNever;
  }
  // The tag that find() addressed; 0: no line.
  std::uint32_t tag(Cycle cycle, std::size_t port) {
    const std::uint32_t index = wanted_[port].index;
    return in_flops_ ? tag_ports_[port].now(cycle, index)
                     : tag_ports_[port].at(cycle, index, found_);
  }
  void set_tag(Cycle cycle, std::size_t port) {
    tag_write_.write(cycle, wanted_[port].index, wanted_[port].tag);
  }
  // kIdle, or why no line can be requested.
  Activity can_request(Cycle cycle, const MemoryClient& memory) const {
    if (!fills_.can_reserve(cycle)) return no_fill_;
    return memory.requests_out.can_push(cycle) ? kIdle : kStalledDownstream;
  }
  void request(Cycle cycle, MemoryClient& memory, std::uint32_t address) {
    memory.read(cycle, address, fills_.reserve());
  }
  // Compares the token's lookups and requests the lines that miss, one per cycle. `address(port)`
  // is called for each request. kIdle: done; kBusy: one more request in the next cycle.
  template <class Address>
  Activity look_up(Cycle cycle, MemoryClient& memory, Address&& address) {
    if (decided_ == kNever) {
      const bool first = misses(cycle, 0);
      // The line of the first lookup may replace that of the second.
      const bool second = kPorts == 2 && two_ &&
                          (misses(cycle, 1) || (first && wanted_[0].index == wanted_.back().index));
      if (first)
        if (const Activity done = fetch(cycle, memory, 0, address); done != kIdle) return done;
      decided_ = cycle;
      if (!second) return kIdle;
      if (first) return kBusy;
    }
    return fetch(cycle, memory, 1, address);
  }
  // Lookups that were decided in this cycle, for counters.
  std::uint32_t decided(Cycle cycle) const { return decided_ == cycle ? 1 + two_ : 0; }
  // Bit k: the token's lookup of port k has missed.
  std::uint8_t missed() const { return missed_; }

  // --- Data, in the order of requests ---
  bool ready(Cycle cycle) const { return fills_.ready(cycle); }
  const Word& take(Cycle cycle) {
    const Word& line = fills_.line(cycle);
    fills_.release(cycle);
    return line;
  }
  const Word& install(Cycle cycle, std::uint32_t index) {
    const Word& line = take(cycle);
    write(cycle, index, line);
    return line;
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

  // Last in every cycle: takes what memory gives, and says what the unit did by both its halves.
  template <class Decode>
  Activity finish(Cycle cycle, MemoryClient& memory, Activity data, Activity tags,
                  Decode&& decode) {
    bool did = data == kBusy || tags == kBusy;
    if (memory.responses_in.can_pop(cycle)) {
      const MemoryResponse& response = memory.responses_in.take(cycle);
      fills_.fill(cycle, response.tag, decode(response.data));
      did = true;
    }
    fills_.read_ahead(cycle);
    cleared_ = 0;
    return did ? kBusy : data != kIdle ? data : tags;
  }
  void reset() {
    fills_.reset();
    cleared_ = 0;
  }

 private:
  struct Wanted {
    std::uint32_t index, tag;
  };
  template <class T>
  using ReadPorts = std::array<ReadPort<T>, kPorts>;

  static MemoryShape shape_of(std::uint32_t lines, const LineCacheShape::Part& part,
                              ReadDuringWrite read_during_write) {
    const bool flops = part.kind == MemoryKind::kFlops;
    return {.words = lines,
            .word_bits = part.bits,
            .kind = part.kind,
            .read_ports = kPorts,
            .latency = flops ? 0U : 1U,
            .read_during_write = flops ? ReadDuringWrite::kForbidden : read_during_write,
            .content = part.content};
  }
  template <class T>
  static ReadPorts<T> ports_of(Memory<T>& memory) {
    if constexpr (kPorts == 1)
      return {ReadPort<T>{memory, "look-up"}};
    else
      return {ReadPort<T>{memory, "first"}, ReadPort<T>{memory, "second"}};
  }
  bool misses(Cycle cycle, std::size_t port) { return tag(cycle, port) != wanted_[port].tag; }
  template <class Address>
  Activity fetch(Cycle cycle, MemoryClient& memory, std::size_t port, Address&& address) {
    if (const Activity done = can_request(cycle, memory); done != kIdle) return done;
    request(cycle, memory, address(port));
    set_tag(cycle, port);
    missed_ |= static_cast<std::uint8_t>(1u << port);
    return kIdle;
  }

  const std::uint32_t lines_;
  Memory<std::uint32_t> tags_;
  ReadPorts<std::uint32_t> tag_ports_ = ports_of(tags_);
  WritePort<std::uint32_t> tag_write_{tags_, "requests"};
  Memory<Word> data_;
  ReadPorts<Word> data_ports_ = ports_of(data_);
  WritePort<Word> data_write_{data_, "install"};
  FillStore<Word> fills_;
  const Activity no_fill_;
  const bool in_flops_ = tags_.memory_kind() == MemoryKind::kFlops;
  std::uint32_t cleared_ = 0;  // U11, tags that are empty

  // The token that is looked up.
  std::array<Wanted, kPorts> wanted_{};
  bool two_ = false;
  std::uint8_t missed_ = 0;
  Cycle found_ = 0;         // when its tags were addressed
  Cycle decided_ = kNever;  // since when its first lookup is decided
};

}  // namespace deburr::rtl::geometric
