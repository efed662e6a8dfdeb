// SPDX-License-Identifier: MIT
// Function  Buffer for lines in flight from memory: entries are reserved and released in order and
//           filled in any order.
// Position  In each unit that reads memory. If the ends are in different units, each holds its
//           side: a Filler or a Reader.
// Latency   A line filled in cycle t is on the output register from t + 2 on. An entry released in
//           t can be reserved from t + 1 on.
// Interval  1: one reservation, one line in and one line out per cycle.
// Cost      Entries x word bits as 1R1W memory, and an arrived bit per entry. Longest path:
//           selection of one of 256 arrived bits, then the read enable.
//
// The oldest line is prefetched into the output register as soon as it has arrived.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "rtl_model/fabric/memory.h"

namespace deburr::rtl::geometric {

template <class Word>
class FillStore {
 public:
  // Handles of a side, like a memory's port. A copy is another handle of the same side.
  class Filler {
   public:
    bool can_reserve(Cycle cycle) const { return lines_->can_reserve(cycle); }
    std::uint32_t reserve() { return lines_->reserve(); }
    void fill(Cycle cycle, std::uint32_t place, const Word& word) {
      lines_->fill(cycle, place, word);
    }
    void reset() { lines_->reset(); }

   private:
    friend FillStore;
    explicit Filler(FillStore& lines) : lines_(&lines) {}
    FillStore* lines_;
  };
  class Reader {
   public:
    bool ready(Cycle cycle) const { return lines_->ready(cycle); }
    const Word& line(Cycle cycle) const { return lines_->line(cycle); }
    void release(Cycle cycle) { lines_->release(cycle); }
    void read_ahead(Cycle cycle) { lines_->read_ahead(cycle); }

   private:
    friend FillStore;
    explicit Reader(FillStore& lines) : lines_(&lines) {}
    FillStore* lines_;
  };

  FillStore(const char* name, std::int32_t places, std::uint32_t bits, std::string content,
            MemoryKind kind = MemoryKind::kSram)
      : places_(static_cast<std::uint32_t>(places)),
        memory_(name, {.words = places_,
                       .word_bits = bits,
                       .kind = kind,
                       .content = std::move(content),
                       .register_bits = places_}),
        arrived_(places_, kNever) {}

  Filler filler() { return Filler(*this); }
  Reader reader() { return Reader(*this); }

  // --- Requesting side ---
  bool can_reserve(Cycle cycle) const {
    return reserved_ - (released_ - (released_at_ == cycle)) < places_;
  }
  std::uint32_t reserve() {
    ++reserved_;
    return std::exchange(next_, after(next_));
  }
  void fill(Cycle cycle, std::uint32_t place, const Word& word) {
    DEBURR_CHECK(
        place < places_ && arrived_[place] == kNever,
        std::string(memory_.name()) + ": entry " + std::to_string(place) + " is filled twice");
    write_.write(cycle, place, word);
    arrived_[place] = cycle;
  }

  // --- Consuming side: the oldest line only ---
  bool ready(Cycle cycle) const { return read_ != released_ && read_at_ < cycle; }
  const Word& line(Cycle cycle) const { return read_port_.at(cycle, oldest_, read_at_); }
  void release(Cycle cycle) {
    arrived_[oldest_] = kNever;
    oldest_ = after(oldest_);
    ++released_;
    released_at_ = cycle;
  }
  // Call in every cycle, after all other functions.
  void read_ahead(Cycle cycle) {
    if (read_ != released_ || arrived_[oldest_] >= cycle) return;
    read_port_.read(cycle, oldest_);
    ++read_;
    read_at_ = cycle;
  }

  bool empty() const { return reserved_ == released_; }
  void reset() {
    next_ = oldest_ = 0;
    reserved_ = released_ = read_ = 0;
    released_at_ = read_at_ = kNever;
    std::fill(arrived_.begin(), arrived_.end(), kNever);
  }

 private:
  std::uint32_t after(std::uint32_t place) const { return place + 1 == places_ ? 0 : place + 1; }

  const std::uint32_t places_;
  Memory<Word> memory_;
  ReadPort<Word> read_port_{memory_, "oldest"};
  WritePort<Word> write_{memory_, "responses"};
  std::vector<Cycle> arrived_;           // cycle in which the bit was set; kNever: clear
  std::uint32_t next_ = 0, oldest_ = 0;  // entries of the next reservation and of the oldest line
  std::uint64_t reserved_ = 0, released_ = 0, read_ = 0;
  Cycle released_at_ = kNever, read_at_ = kNever;
};

}  // namespace deburr::rtl::geometric
