// SPDX-License-Identifier: MIT
// WeightsRom: addresses of the contract by hand, cycles of the words, and loading.
#include "rtl_model/morphological/blend/weights_rom.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "spec/morphological/learned_weights.h"
#include "tb/unit/rtl/morphological/parts.h"

namespace deburr::tb::morphological_rtl::weights_rom_test {
namespace {

using rtl::morphological::WeightsRom;
using spec::morphological::RunPart;

struct Row {
  const char* name;
  int start_code, end_code, start_class, end_class, before, after;
  RunPart part;
  std::array<int, 3> first, second;  // a, b, c
};

// docs/reference/morphological/vectors.md, "Learned weights", and ends that were not found.
const Row kRows[] = {
    {"upper left of a box", 2, 2, 2, 2, 0, 7, RunPart::kWhole, {645, 419, 439}, {325, 131, 151}},
    {"fourth of eight", 2, 2, 2, 2, 3, 4, RunPart::kWhole, {668, 431, 435}, {348, 143, 147}},
    {"middle of three", 2, 2, 2, 2, 1, 1, RunPart::kWhole, {649, 421, 421}, {329, 133, 133}},
    {"crossing, then border", 2, 0, 6, 0, 0, 3, RunPart::kWhole, {515, 546, 14}, {259, 258, 14}},
    {"Z", 2, 1, 6, 6, 0, 3, RunPart::kWhole, {579, 546, 270}, {387, 258, 558}},
    {"middle of five", 2, 1, 5, 6, 2, 2, RunPart::kWhole, {594, 522, 266}, {594, 554, 234}},
    {"single pixel", 2, 2, 1, 1, 0, 0, RunPart::kWhole, {640, 384, 384}, {320, 96, 96}},
    {"T at the other end", 3, 1, 0, 2, 4, 0, RunPart::kWhole, {452, 130, 50}, {708, 418, 50}},
    // The end of a head counts as farther away than any other, whatever the pixel's distance from
    // the start.
    {"head", 1, 0, 2, 0, 5, 0, RunPart::kHead, {295, 147, 31}, {551, 435, 31}},
    {"head, far out", 1, 0, 2, 0, 100, 27, RunPart::kHead, {319, 159, 31}, {575, 447, 31}},
    {"tail", 0, 2, 0, 1, 40, 9, RunPart::kTail, {567, 411, 31}, {311, 123, 31}},
};

TEST(WeightsRomAddresses, AddressesMatchTheContract) {
  for (const Row& row : kRows) {
    const WeightsRom::Query query =
        WeightsRom::ask({static_cast<std::uint8_t>(row.start_code + 4 * row.end_code),
                         static_cast<std::uint8_t>(row.start_class),
                         static_cast<std::uint8_t>(row.end_class), row.part},
                        row.before, row.after);
    for (const std::size_t side : {0u, 1u}) {
      const std::array<int, 3>& expected = side == 0 ? row.first : row.second;
      EXPECT_EQ(query.a[side], expected[0]) << row.name << ' ' << side;
      EXPECT_EQ(query.b[side], expected[1]) << row.name << ' ' << side;
      EXPECT_EQ(query.c[side], expected[2]) << row.name << ' ' << side;
    }
  }
}

TEST(WeightsRomAddresses, GapUsesTheLastEntriesWithoutCrossing) {
  const WeightsRom::Query query = WeightsRom::ask_gap();
  for (const std::size_t side : {0u, 1u}) {
    EXPECT_EQ(query.a[side], 63);
    EXPECT_EQ(query.b[side], 31);
    EXPECT_EQ(query.c[side], 31);
  }
}

// All three tables at their limits: the sum saturates.
TEST(WeightsRomWords, SumSaturatesAtEightBits) {
  WeightsRom rom(1);
  for (const int entry : {127, -128}) {
    for (std::size_t i = 0; i < WeightsRom::kEntries; ++i)
      rom.load(i, static_cast<std::uint8_t>(entry));
    WeightsRom::Query query = WeightsRom::ask_gap();
    const rtl::Cycle at = entry > 0 ? 10 : 20;
    rom.address(at, 0, query);
    rom.add(at + 1, 0, query);
    rom.address_weights(at + 2, 0, query);
    EXPECT_EQ(rom.weights(at + 3, 0, query).second, entry > 0 ? 128 : 0);
  }
}

// The order in which the three words are requested is the compiler's choice.
TEST(WeightsRomCycles, WordNeedsOneCycleAfterItsAddress) {
  using ::testing::HasSubstr;
  using ::testing::ThrowsMessage;
  WeightsRom rom(1);
  WeightsRom::Query query = WeightsRom::ask_gap();
  rom.address(10, 0, query);
  WeightsRom::Query early = query;
  EXPECT_THAT([&] { rom.add(10, 0, early); },
              ThrowsMessage<spec::CheckFailed>(HasSubstr("weights_")));
  rom.add(11, 0, query);
  rom.address_weights(12, 0, query);
  EXPECT_THAT([&] { rom.weights(12, 0, query); },
              ThrowsMessage<spec::CheckFailed>(HasSubstr("weight_rom")));
  rom.weights(13, 0, query);
  // A word that another one has replaced.
  rom.address(14, 0, WeightsRom::ask({1, 2, 0, RunPart::kWhole}, 0, 0));
  EXPECT_THAT([&] { rom.add(15, 0, query); },
              ThrowsMessage<spec::CheckFailed>(HasSubstr("weights_")));
}

TEST(WeightsRomLoad, LoadUpdatesEntriesAndSum) {
  WeightsRom rom(1);
  EXPECT_EQ(rom.sum(), spec::morphological::kWeightsSum);
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < WeightsRom::kEntries; ++i)
    sum += static_cast<std::uint32_t>(i + 1) * rom.entry(i);
  EXPECT_EQ(rom.sum(), sum);
  struct Place {
    std::size_t index;
    std::uint8_t entry;
  };
  for (const Place& place : {Place{0, 0x80}, Place{1023, 0x7F}, Place{1024, 3}, Place{1663, 0xFF},
                             Place{1664, 0}, Place{2303, 0x81}}) {
    sum += static_cast<std::uint32_t>(place.index + 1) *
           (std::uint32_t{place.entry} - rom.entry(place.index));
    rom.load(place.index, place.entry);
    EXPECT_EQ(rom.entry(place.index), place.entry);
    EXPECT_EQ(rom.sum(), sum) << place.index;
  }
  rom.load(2304, 17);
  EXPECT_EQ(rom.entry(2304), 0);
  EXPECT_EQ(rom.sum(), sum);
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::weights_rom_test
