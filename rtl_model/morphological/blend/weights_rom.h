// SPDX-License-Identifier: MIT
// Learned weights: those of an edge whose line no staircase tells, by what both ends of its run
// look like, from three tables whose words add up.
//
// Where: in the LearnedWeights, a stage of which each call is one (its datasheet has formats and
// cost). A reader is a lane and axis; each has two sides, the pixels across its edge.
// The three tables can be loaded through the registers while no frame is inside, when nobody reads:
// so the ports that read are written. They keep their words in a reset. The sum that the registers
// show is kept up with each word: the old word is on the output register when the new one comes.
// Source: ours (docs/reference/morphological/learned_weights.md).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "rtl_model/fabric/memory.h"
#include "spec/morphological/packets.h"

namespace deburr::rtl::morphological {

class WeightsRom {
 public:
  // The side of the bus that loads the tables, which knows no cycles: a handle, as of a memory's
  // port. Entries of A, B, C, one behind the other; beyond them 0, and nothing is kept.
  class LoadPort {
   public:
    std::uint8_t entry(std::size_t index) const { return rom_->entry(index); }
    void load(std::size_t index, std::uint8_t entry) { rom_->load(index, entry); }
    std::uint32_t sum() const { return rom_->sum(); }

   private:
    friend WeightsRom;
    explicit LoadPort(WeightsRom& rom) : rom_(&rom) {}
    WeightsRom* rom_;
  };

  // What a record says of its ends.
  struct Descriptor {
    std::uint8_t shape = 0;  // index of kRunShapes
    std::uint8_t start_class = 0, end_class = 0;
    spec::morphological::RunPart part{};
  };
  // An edge on its way.
  struct Query {
    std::array<std::uint16_t, 2> a{}, b{}, c{};  // addresses, by side
    std::array<std::int16_t, 2> z{};
  };
  struct Weights {
    std::uint8_t first = 0, second = 0;
  };
  static constexpr std::size_t kEntries = 1024 + 640 + 640;  // A, B, C

  explicit WeightsRom(int lanes);

  LoadPort load_port() { return LoadPort(*this); }

  // --- The LearnedWeights' stages: the first two calls are in stage 1, the others in 2 to 4 ---
  // The pixel `before` pixels behind the record's start, `after` before its end.
  static Query ask(const Descriptor& descriptor, std::int32_t before, std::int32_t after);
  // An edge of no record.
  static Query ask_gap();
  void address(Cycle cycle, std::size_t reader, const Query& query);
  void add(Cycle cycle, std::size_t reader, Query& query);
  void address_weights(Cycle cycle, std::size_t reader, Query& query);
  Weights weights(Cycle cycle, std::size_t reader, const Query& query);

  // --- The LoadPort's ---
  std::uint8_t entry(std::size_t index) const;
  void load(std::size_t index, std::uint8_t entry);
  std::uint32_t sum() const { return sum_; }

  // For checks: the addresses of every edge.
  std::function<void(const Query&)> observer;

 private:
  static constexpr std::size_t kTables = 3, kSides = 2;
  const Memory<std::int8_t>* find(std::size_t& index) const;

  std::array<Memory<std::int8_t>, kTables> tables_;
  std::array<std::vector<ReadPort<std::int8_t>>, kTables> words_;  // by reader and side
  Memory<std::uint8_t> weight_rom_;
  std::vector<ReadPort<std::uint8_t>> weights_;
  std::uint32_t sum_ = 0;
};

}  // namespace deburr::rtl::morphological
