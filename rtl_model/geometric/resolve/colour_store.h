// SPDX-License-Identifier: MIT
// Function  Colour lines in flight from memory to the resolve, and the most recently read lines.
//           Without kept lines (colour_lines = 0) timing and cost are those of the FillStore.
// Position  Between BlockFetch, which requests lines, and Resolver, which takes them in that order.
//           Each holds one side.
// Latency   A hit can be taken from the second cycle after its lookup on. A missed line is read
//           from memory.
// Cost      N lines, N tags, and an entry of colour_order per requested line. Longest path: N
//           comparators of 23 bits.
//
// With N kept lines BlockFetch looks up one line per cycle. A hit is in the store or in flight; a
// miss replaces the oldest kept line in the same cycle. Data follow in order: a missed line is
// written into kept_colours when it is taken, and a hit reads its word in the cycle before it is
// taken. So all earlier hits precede the overwriting of a line.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "rtl_model/fabric/fifo.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/geometric/common/fill_store.h"
#include "spec/geometric/parameters.h"
#include "spec/geometric/records.h"

namespace deburr::rtl::geometric {

class ColourStore final {
 public:
  // BlockFetch's side. Lines are identified by tags, valid for one frame and layout.
  class Filler {
   public:
    static std::uint32_t tag_of(bool tiled, std::uint32_t u, std::uint32_t v) {
      return kValid | v << (tiled ? 11 : 9) | u;
    }
    // The entry of a kept line, which needs no read; nullopt on a miss.
    std::optional<std::uint8_t> find(std::uint32_t tag) const { return store_->find(tag); }
    bool can_order_kept(Cycle cycle) const { return store_->kept_->order.can_push(cycle); }
    void order_kept(Cycle cycle, std::uint8_t place) {
      store_->kept_->order.push(cycle, {true, place});
    }
    bool can_order_read(Cycle cycle) const { return store_->can_order_read(cycle); }
    // The entry for the memory's response, and whether it replaces a kept line.
    struct Ordered {
      std::uint32_t place;
      bool replaces;
    };
    Ordered order_read(Cycle cycle, std::uint32_t tag) { return store_->order_read(cycle, tag); }
    void fill(Cycle cycle, std::uint32_t place, const Line& line) {
      store_->fills_.fill(cycle, place, line);
    }
    // Called at the start of a frame: discards all kept lines.
    void clear() { store_->clear(); }
    void reset() { store_->reset(); }

   private:
    friend ColourStore;
    explicit Filler(ColourStore& store) : store_(&store) {}
    ColourStore* store_;
  };
  // Resolver's side: the oldest requested line.
  class Reader {
   public:
    bool ready(Cycle cycle) const { return store_->ready(cycle); }
    const Line& line(Cycle cycle) const { return store_->line(cycle); }
    void release(Cycle cycle) { store_->release(cycle); }
    // Call in every cycle, after all other functions.
    void read_ahead(Cycle cycle) { store_->read_ahead(cycle); }

   private:
    friend ColourStore;
    explicit Reader(ColourStore& store) : store_(&store) {}
    ColourStore* store_;
  };

  explicit ColourStore(const spec::geometric::Parameters& p)
      : fills_("resolve_colours", p.resolve_lines / 2, 8 * spec::geometric::kLineBytes,
               "colours in flight to the resolve") {
    if (p.colour_lines > 0) kept_ = std::make_unique<Kept>(p);
  }

  Filler filler() { return Filler(*this); }
  Reader reader() { return Reader(*this); }

 private:
  static constexpr std::uint32_t kTagBits = 23, kValid = 1u << (kTagBits - 1);

  struct Order {
    bool hit;
    std::uint8_t place;  // U8, in kept_colours
    template <class Self, class Visit>
    static constexpr void fields(Self& self, Visit&& visit) {
      visit("hit", self.hit);
      visit("place", self.place, 8, "U8");
    }
  };
  struct Kept {
    explicit Kept(const spec::geometric::Parameters& p)
        : lines("kept_colours", {.words = static_cast<std::uint64_t>(p.colour_lines),
                                 .word_bits = 8 * spec::geometric::kLineBytes,
                                 // A line may be used in the cycle that stores it.
                                 .read_during_write = ReadDuringWrite::kNewWord,
                                 .content = "most recently read lines of colours"}),
          tags("kept_tags", {.words = static_cast<std::uint64_t>(p.colour_lines),
                             .word_bits = kTagBits,
                             .kind = MemoryKind::kFlops,
                             .read_ports = static_cast<std::uint32_t>(p.colour_lines),
                             .latency = 0,
                             .content = "u, v of each, valid, compared at once"}),
          order("colour_order", static_cast<std::uint32_t>(p.resolve_lines / 2)),
          tag(static_cast<std::size_t>(p.colour_lines), 0) {}
    Memory<Line> lines;
    ReadPort<Line> read{lines, "hit"};
    WritePort<Line> write{lines, "line read"};
    MemoryBase tags;  // by entry: stored in `tag`
    Fifo<Order> order;
    std::vector<std::uint32_t> tag;  // 0: no line
    std::uint32_t next = 0;          // U8, entry of the oldest kept line
    // The oldest requested line, and the cycle since which it is known.
    Order oldest{};
    bool has_oldest = false;
    Cycle since = kNever;
  };

  std::optional<std::uint8_t> find(std::uint32_t tag) const {
    if (!kept_) return std::nullopt;
    const auto there = std::find(kept_->tag.begin(), kept_->tag.end(), tag);
    if (there == kept_->tag.end()) return std::nullopt;
    return static_cast<std::uint8_t>(there - kept_->tag.begin());
  }
  bool can_order_read(Cycle cycle) const {
    return fills_.can_reserve(cycle) && (!kept_ || kept_->order.can_push(cycle));
  }
  Filler::Ordered order_read(Cycle cycle, std::uint32_t tag) {
    bool replaces = false;
    if (kept_) {
      std::uint32_t& there = kept_->tag[kept_->next];
      replaces = there != 0;
      there = tag;
      kept_->order.push(cycle, {false, static_cast<std::uint8_t>(kept_->next)});
      kept_->next = kept_->next + 1 == kept_->tag.size() ? 0 : kept_->next + 1;
    }
    return {fills_.reserve(), replaces};
  }
  void clear() {
    if (!kept_ || kept_->tag.front() == 0) return;
    std::fill(kept_->tag.begin(), kept_->tag.end(), 0);
    kept_->next = 0;
  }

  bool hit() const { return kept_ && kept_->oldest.hit; }
  bool ready(Cycle cycle) const {
    if (kept_ && (!kept_->has_oldest || kept_->since == cycle)) return false;
    return hit() || fills_.ready(cycle);
  }
  const Line& line(Cycle cycle) const {
    return hit() ? kept_->read.at(cycle, kept_->oldest.place, kept_->since) : fills_.line(cycle);
  }
  void release(Cycle cycle) {
    if (kept_) {
      kept_->has_oldest = false;
      if (hit()) return;
      kept_->write.write(cycle, kept_->oldest.place, fills_.line(cycle));
    }
    fills_.release(cycle);
  }
  void read_ahead(Cycle cycle) {
    fills_.read_ahead(cycle);
    if (!kept_ || kept_->has_oldest || !kept_->order.can_pop(cycle)) return;
    kept_->oldest = kept_->order.take(cycle);
    kept_->has_oldest = true;
    kept_->since = cycle;
    if (kept_->oldest.hit) kept_->read.read(cycle, kept_->oldest.place);
  }
  void reset() {
    fills_.reset();
    if (!kept_) return;
    clear();
    kept_->order.reset();
    kept_->oldest = {};
    kept_->has_oldest = false;
  }

  FillStore<Line> fills_;
  std::unique_ptr<Kept> kept_;  // with colour_lines > 0
};

}  // namespace deburr::rtl::geometric
