// SPDX-License-Identifier: MIT
// Lines on their way from memory: places are reserved and released in one order, and filled in any.
//
// Where: in each unit that reads memory. 1R1W, read a clock before the word is there; the oldest
// line is read ahead as soon as it has come, so that it waits on the output register: what is
// filled in clock t is there from t + 2 on, then a line a clock. A place that is released in t can
// be reserved from t + 1 on. One reservation, one line in and one out a clock. Where the ends are
// different units each holds its side: a Filler, a Reader. Made for 250 MHz; longest path: a choice
// of 1 in 256 arrived bits, then the read enable. Cost: places x word bits, an arrived bit each.
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
  // Handles of a side, as of a memory's port. A copy is one more handle of the same side.
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

  // --- Who asks ---
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
        std::string(memory_.name()) + ": place " + std::to_string(place) + " is filled twice");
    write_.write(cycle, place, word);
    arrived_[place] = cycle;
  }

  // --- Who uses them: the oldest only ---
  bool ready(Cycle cycle) const { return read_ != released_ && read_at_ < cycle; }
  const Word& line(Cycle cycle) const { return read_port_.at(cycle, oldest_, read_at_); }
  void release(Cycle cycle) {
    arrived_[oldest_] = kNever;
    oldest_ = after(oldest_);
    ++released_;
    released_at_ = cycle;
  }
  // In every clock, after anything else.
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
  std::vector<Cycle> arrived_;           // since when the bit is set; kNever: it is not
  std::uint32_t next_ = 0, oldest_ = 0;  // places: of the next reservation, of the oldest line
  std::uint64_t reserved_ = 0, released_ = 0, read_ = 0;
  Cycle released_at_ = kNever, read_at_ = kNever;
};

}  // namespace deburr::rtl::geometric
