// SPDX-License-Identifier: MIT
// Learned weights of an edge whose line cannot be found from a staircase. They depend on both ends
// of its run and are the sum of words from three tables.
//
// Position  In LearnedWeights; each call is one stage (formats and cost: its datasheet). A reader
//           is a lane and axis and has two sides, the pixels across its edge.
// Loading   Through the registers, only while no frame is inside and no port reads: the read ports
//           also write. Reset keeps the words. The checksum register is updated with each word,
//           using the old word from the port's output register.
// Source    Ours (docs/reference/morphological/learned_weights.md).
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
  // Backdoor of the bus for loading the tables; not clocked. Entries of A, B, C are concatenated;
  // beyond them reads return 0 and writes are ignored.
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

  // What a descriptor says about its ends.
  struct Descriptor {
    std::uint8_t shape = 0;  // index of kRunShapes
    std::uint8_t start_class = 0, end_class = 0;
    spec::morphological::RunPart part{};
  };
  // An edge in flight.
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

  // --- Stages of LearnedWeights: the first two calls are in stage 1, the others in 2 to 4 ---
  // Pixel with `before` pixels between it and the run's start, `after` between it and its end.
  static Query ask(const Descriptor& descriptor, std::int32_t before, std::int32_t after);
  // An edge without a descriptor.
  static Query ask_gap();
  void address(Cycle cycle, std::size_t reader, const Query& query);
  void add(Cycle cycle, std::size_t reader, Query& query);
  void address_weights(Cycle cycle, std::size_t reader, Query& query);
  Weights weights(Cycle cycle, std::size_t reader, const Query& query);

  // --- For the LoadPort ---
  std::uint8_t entry(std::size_t index) const;
  void load(std::size_t index, std::uint8_t entry);
  std::uint32_t sum() const { return sum_; }

  // For checks: called with the addresses of every edge.
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
