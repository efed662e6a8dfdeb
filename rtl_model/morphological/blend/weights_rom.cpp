// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/weights_rom.h"

#include <algorithm>
#include <span>
#include <string>

#include "spec/morphological/learned_weights.h"
#include "spec/morphological/tables.h"

namespace deburr::rtl::morphological {
namespace {

using spec::morphological::RunPart;

constexpr std::int32_t kUnseen = 0xFFF;  // larger than any distance
constexpr int kLeastSum = -128, kMostSum = 127;

// Maps a distance to one of eight classes.
unsigned class_of_distance(std::int32_t d) {
  if (d < 4) return static_cast<unsigned>(d);
  return d < 6 ? 4 : d < 9 ? 5 : d < 16 ? 6 : 7;
}

// An end of the run, seen from one side of the edge.
struct End {
  std::int32_t distance = kUnseen;
  unsigned code = 0, e = 0;
};

End seen(unsigned code, unsigned crossing_class, std::int32_t distance, bool second) {
  if (second) code = (code >> 1 | code << 1) & 3;
  constexpr std::array<unsigned, 4> kBase = {0, 2, 11, 1};
  return {distance, code, kBase[code] + crossing_class};
}

// Addresses for one side.
void ask_side(WeightsRom::Query& query, std::size_t side, const End& start, const End& end,
              unsigned length_class) {
  const bool start_is_near =
      start.distance < end.distance || (start.distance == end.distance && start.e >= end.e);
  const End &near = start_is_near ? start : end, &far = start_is_near ? end : start;
  const unsigned near_d = class_of_distance(near.distance), far_d = class_of_distance(far.distance);
  query.a[side] = static_cast<std::uint16_t>(near.code << 8 | far.code << 6 | near_d << 3 | far_d);
  query.b[side] = static_cast<std::uint16_t>(near.e << 5 | near_d << 2 | length_class);
  query.c[side] = static_cast<std::uint16_t>(far.e << 5 | far_d << 2 | length_class);
}

constexpr unsigned kLongest = 3;  // length class

MemoryShape table_shape(std::size_t words, int lanes, const char* content) {
  return {.words = words,
          .word_bits = 8,
          .read_ports = static_cast<std::uint32_t>(4 * lanes),
          .write_ports = 0,
          .content = content,
          .loaded = true};
}

}  // namespace

WeightsRom::WeightsRom(int lanes)
    : tables_{{{"weights_a",
                table_shape(spec::morphological::kWeightsOfCodes.size(), lanes,
                            "learned weights by codes and distances of both ends"),
                std::span<const std::int8_t>(spec::morphological::kWeightsOfCodes)},
               {"weights_b",
                table_shape(spec::morphological::kWeightsOfNear.size(), lanes,
                            "learned weights by class and distance of the nearer end"),
                std::span<const std::int8_t>(spec::morphological::kWeightsOfNear)},
               {"weights_c",
                table_shape(spec::morphological::kWeightsOfFar.size(), lanes,
                            "learned weights by class and distance of the farther end"),
                std::span<const std::int8_t>(spec::morphological::kWeightsOfFar)}}},
      weight_rom_("weight_rom",
                  {.words = spec::morphological::kWeightOfSum.size(),
                   .word_bits = 8,
                   .kind = MemoryKind::kRom,
                   .read_ports = static_cast<std::uint32_t>(4 * lanes),
                   .write_ports = 0,
                   .content = "weight by the sum of three learned words"},
                  spec::morphological::kWeightOfSum) {
  for (int port = 0; port < 4 * lanes; ++port) {
    const std::string user = "lane " + std::to_string(port / 4) +
                             (port & 2 ? " vertical" : " horizontal") +
                             (port & 1 ? " second" : " first");
    for (std::size_t table = 0; table < kTables; ++table)
      words_[table].emplace_back(tables_[table], user);
    weights_.emplace_back(weight_rom_, user);
  }
  for (std::size_t i = 0; i < kEntries; ++i) sum_ += static_cast<std::uint32_t>(i + 1) * entry(i);
}

WeightsRom::Query WeightsRom::ask(const Descriptor& descriptor, std::int32_t before,
                                  std::int32_t after) {
  const bool whole = descriptor.part == RunPart::kWhole;
  const std::int32_t length = before + after + 1;
  const unsigned length_class = !whole || length >= 8 ? kLongest
                                : length >= 4         ? 2
                                : length >= 2         ? 1
                                                      : 0;
  Query query;
  for (std::size_t side = 0; side < kSides; ++side) {
    End start, end;
    if (descriptor.part != RunPart::kTail)
      start = seen(descriptor.shape & 3, descriptor.start_class, before, side != 0);
    if (descriptor.part != RunPart::kHead)
      end = seen(descriptor.shape >> 2, descriptor.end_class, after, side != 0);
    ask_side(query, side, start, end, length_class);
  }
  return query;
}

WeightsRom::Query WeightsRom::ask_gap() {
  Query query;
  for (std::size_t side = 0; side < kSides; ++side) ask_side(query, side, {}, {}, kLongest);
  return query;
}

void WeightsRom::address(Cycle cycle, std::size_t reader, const Query& query) {
  if (observer) observer(query);
  for (std::size_t side = 0; side < kSides; ++side) {
    const std::size_t port = kSides * reader + side;
    words_[0][port].read(cycle, query.a[side]);
    words_[1][port].read(cycle, query.b[side]);
    words_[2][port].read(cycle, query.c[side]);
  }
}

void WeightsRom::add(Cycle cycle, std::size_t reader, Query& query) {
  for (std::size_t side = 0; side < kSides; ++side) {
    const std::size_t port = kSides * reader + side;
    const int z = words_[0][port].at(cycle, query.a[side]) +
                  words_[1][port].at(cycle, query.b[side]) +
                  words_[2][port].at(cycle, query.c[side]);
    query.z[side] = static_cast<std::int16_t>(z);
  }
}

void WeightsRom::address_weights(Cycle cycle, std::size_t reader, Query& query) {
  for (std::size_t side = 0; side < kSides; ++side) {
    const int z = std::clamp<int>(query.z[side], kLeastSum, kMostSum) - kLeastSum;
    query.z[side] = static_cast<std::int16_t>(z);
    weights_[kSides * reader + side].read(cycle, static_cast<std::uint64_t>(z));
  }
}

WeightsRom::Weights WeightsRom::weights(Cycle cycle, std::size_t reader, const Query& query) {
  const auto weight = [&](std::size_t side) {
    return weights_[kSides * reader + side].at(cycle, static_cast<std::uint64_t>(query.z[side]));
  };
  return {weight(0), weight(1)};
}

// Table of an entry; `index` becomes the address in that table.
const Memory<std::int8_t>* WeightsRom::find(std::size_t& index) const {
  for (const Memory<std::int8_t>& table : tables_) {
    if (index < table.words()) return &table;
    index -= table.words();
  }
  return nullptr;
}

std::uint8_t WeightsRom::entry(std::size_t index) const {
  const Memory<std::int8_t>* const table = find(index);
  return table ? static_cast<std::uint8_t>(table->backdoor(index)) : std::uint8_t{0};
}

void WeightsRom::load(std::size_t index, std::uint8_t entry) {
  std::size_t address = index;
  const Memory<std::int8_t>* const table = find(address);
  if (table == nullptr) return;
  sum_ += static_cast<std::uint32_t>(index + 1) * (entry - std::uint32_t{this->entry(index)});
  tables_[static_cast<std::size_t>(table - tables_.data())].backdoor(address) =
      static_cast<std::int8_t>(entry);
}

}  // namespace deburr::rtl::morphological
