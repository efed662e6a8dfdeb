// SPDX-License-Identifier: MIT
// SMAA's tables in the hardware: every word by the contract's hashes; vectors and cycles of the
// three layouts.
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "rtl_model/morphological/blend/area_table.h"
#include "rtl_model/morphological/blend/diagonal_table.h"
#include "spec/morphological/tables.h"
#include "tb/stimuli/vector_hash.h"
#include "tb/unit/rtl/morphological/parts.h"
#include "tb/unit/rtl/morphological/vectors.h"

namespace deburr::tb::morphological_rtl::smaa_tables_test {
namespace {

using rtl::morphological::AreaTable;
using spec::morphological::AreaSource;
using spec::morphological::AreaValues;
using spec::morphological::Preset;
using spec::morphological::Quality;
using stimuli::VectorHash;

template <class Word>
rtl::Memory<Word>& rom(const std::string& name) {
  rtl::Memory<Word>* found = nullptr;
  rtl::for_each<rtl::MemoryBase>([&](rtl::MemoryBase& memory) {
    if (memory.basename() == name) found = dynamic_cast<rtl::Memory<Word>*>(&memory);
  });
  if (found == nullptr) throw std::runtime_error("no memory " + name);
  return *found;
}

// Hashes of the engine's ROMs T, U, S, R and D. Those of T and U are taken from the layout that
// stores only these two tables.
struct RomHashes {
  std::array<std::uint64_t, 2> tiles;
  std::uint64_t roots, mix, diagonals;
};
RomHashes rom_hashes(AreaValues values) {
  Parameters p = smaa();
  p.area = AreaSource::kTableMinimal;
  p.area_values = values;
  EngineBench bench(p);
  std::array<VectorHash, 2> tiles;
  for (unsigned tile = 0; tile < 2; ++tile)
    for (unsigned i = 0; i < 16; ++i)
      for (unsigned j = 0; j < 16; ++j)
        tiles[tile].byte(rom<std::uint16_t>("area_rom" + std::to_string(i % 2 * 2 + j % 2))
                             .backdoor(64u * tile + i / 2 * 8 + j / 2));
  VectorHash roots, mix, diagonals;
  for (unsigned d = 0; d < 225; ++d)
    roots.highest_first(rom<std::uint16_t>("sqrt_rom").backdoor(d), 2);
  for (unsigned s = 0; s < 511; ++s)
    mix.highest_first(rom<std::uint32_t>("mix_rom").backdoor(s), 3);
  for (unsigned at = 0; at < 6400; ++at)
    diagonals.lowest_first(rom<std::uint16_t>("diagonal_rom").backdoor(at), 2);
  return {{tiles[0].value(), tiles[1].value()}, roots.value(), mix.value(), diagonals.value()};
}

struct OwnedTable : sc_core::sc_module {
  OwnedTable(const sc_core::sc_module_name& name, AreaSource layout, int lanes = 1)
      : sc_module(name), table(layout, AreaValues::kExact, lanes) {}
  AreaTable table;
};

// The table of docs/reference/morphological/memories.md, for one lane and for two.
TEST(SmaaTables, RomsMatchThePage) {
  struct Row {
    AreaSource layout;
    int lanes;
    std::string area, roots;
  };
  int number = 0;
  for (const Row& row :
       {Row{AreaSource::kTableFull, 1, "1024 x 16 2R 16384", "225 x 12 4R 5400"},
        Row{AreaSource::kTableMerged, 1, "512 x 16 2R 8192", "225 x 12 4R 5400"},
        Row{AreaSource::kTableMinimal, 1, "128 x 8 4R 2048", "225 x 12 4R 5400"},
        Row{AreaSource::kTableFull, 2, "1024 x 16 4R 32768", "225 x 12 8R 10800"},
        Row{AreaSource::kTableMinimal, 2, "128 x 8 8R 4096", "225 x 12 8R 10800"}}) {
    const std::string name = "table" + std::to_string(number++);
    const OwnedTable owner(name.c_str(), row.layout, row.lanes);
    std::vector<std::string> found;
    rtl::for_each<rtl::MemoryBase>([&](rtl::MemoryBase& memory) {
      if (std::string(memory.name()).starts_with(name + "."))
        found.push_back(std::string(memory.basename()) + " " + std::to_string(memory.words()) +
                        " x " + std::to_string(memory.word_bits()) + " " + memory.ports() + " " +
                        std::to_string(memory.physical_bits()));
    });
    EXPECT_THAT(found,
                ::testing::UnorderedElementsAre("sqrt_rom " + row.roots, "area_rom0 " + row.area,
                                                "area_rom1 " + row.area, "area_rom2 " + row.area,
                                                "area_rom3 " + row.area))
        << name;
  }
}

TEST(SmaaTables, WordsMatchTheContractHashes) {
  const RomHashes exact = rom_hashes(AreaValues::kExact),
                  published = rom_hashes(AreaValues::kPublished);
  const spec::morphological::TableHashes got = {
      exact.tiles[0],  exact.tiles[1],     exact.roots,        exact.mix,
      exact.diagonals, published.tiles[0], published.tiles[1], published.diagonals};
  EXPECT_EQ(differences(spec::morphological::kTableHashes, got), "");
  expect_each_value_is_compared(spec::morphological::kTableHashes, got);
  // The roots and the mix table do not depend on the area values.
  EXPECT_EQ(published.roots, exact.roots);
  EXPECT_EQ(published.mix, exact.mix);
}

class TableCycles : public ::testing::TestWithParam<AreaSource> {
 protected:
  // The table's error when `use` runs with a query and another one that has different addresses in
  // every ROM.
  template <class Use>
  static std::string error_of(Use&& use) {
    OwnedTable owner("owner", GetParam());
    AreaTable::Query query{5, 3, 9}, other{100, 60, 9};
    try {
      use(owner.table, query, other);
    } catch (const spec::CheckFailed& failure) {
      return failure.what();
    }
    return "nothing";
  }
  // `text` names the memory, `why` gives the reason of the rejection.
  template <class Use>
  static void expect_stop(const char* text, const char* why, Use&& use) {
    EXPECT_THAT(error_of(use),
                ::testing::AllOf(::testing::HasSubstr(text), ::testing::HasSubstr(why)));
  }
  static AreaTable::Weights read(AreaTable& table, Cycle cycle, AreaTable::Query query) {
    table.address_roots(cycle, 0, query);
    table.address_entries(cycle + 1, 0, query);
    return table.weights(cycle + 2, 0, query);
  }
};

// The vectors of the contract: T and U of an L and a U on the second side.
TEST_P(TableCycles, WeightsMatchTheContractOnTime) {
  OwnedTable owner("owner", GetParam());
  Cycle cycle = 1;
  for (const spec::morphological::TableVector& v : spec::morphological::kTableVectors) {
    const auto l = static_cast<std::uint8_t>(v.l), r = static_cast<std::uint8_t>(v.r);
    const AreaTable::Weights half = read(owner.table, cycle, {l, r, 2}),
                             dip = read(owner.table, cycle + 3, {l, r, 10});
    cycle += 6;
    const spec::morphological::TableResult got = {static_cast<std::uint64_t>(half.second),
                                                  static_cast<std::uint64_t>(dip.second)};
    EXPECT_EQ(differences(v.result, got), "") << v.l << ' ' << v.r;
    expect_each_value_is_compared(v.result, got);
    EXPECT_EQ(half.first + dip.first, 0);
  }
}
// One query per cycle with all three stages busy: no word is taken from another query.
TEST_P(TableCycles, TablesTakeOneQueryPerCycle) {
  OwnedTable pipelined("pipelined", GetParam()), alone("alone", GetParam());
  std::vector<AreaTable::Query> queries;
  for (unsigned i = 0; i < 400; ++i)
    queries.push_back({static_cast<std::uint8_t>(i * 37 % 225),
                       static_cast<std::uint8_t>(i * 101 % 225),
                       static_cast<std::uint8_t>(i * 7 % 16)});
  const std::vector<AreaTable::Query> one_by_one = queries;
  for (std::size_t c = 0; c < queries.size() + 2; ++c) {
    if (c >= 2) {
      const AreaTable::Weights got = pipelined.table.weights(c, 0, queries[c - 2]),
                               want = read(alone.table, 4 * c, one_by_one[c - 2]);
      ASSERT_EQ(got.first, want.first) << c;
      ASSERT_EQ(got.second, want.second) << c;
    }
    if (c >= 1 && c <= queries.size()) pipelined.table.address_entries(c, 0, queries[c - 1]);
    if (c < queries.size()) pipelined.table.address_roots(c, 0, queries[c]);
  }
}
TEST_P(TableCycles, RejectsUseOneCycleEarlyOrLate) {
  expect_stop("sqrt_rom", "is used", [](AreaTable& table, auto& query, auto&) {
    table.address_roots(1, 0, query);
    table.address_entries(1, 0, query);
  });
  expect_stop("sqrt_rom", "was available from cycle 2 on",
              [](AreaTable& table, auto& query, auto& other) {
                table.address_roots(1, 0, query);
                table.address_roots(2, 0, other);
                table.address_entries(3, 0, query);
              });
  expect_stop("area_rom", "is used", [](AreaTable& table, auto& query, auto&) {
    table.address_roots(1, 0, query);
    table.address_entries(2, 0, query);
    table.weights(2, 0, query);
  });
  expect_stop("area_rom", "was available from cycle 3 on",
              [](AreaTable& table, auto& query, auto& other) {
                table.address_roots(1, 0, query);
                table.address_roots(2, 0, other);
                table.address_entries(2, 0, query);
                table.address_entries(3, 0, other);
                table.weights(4, 0, query);
              });
}
// A port returns one word per cycle, so a second query of the same reader in a cycle is rejected.
TEST_P(TableCycles, ReaderAsksOncePerCycle) {
  EXPECT_THAT(error_of([](AreaTable& table, auto& query, auto& other) {
                table.address_roots(1, 0, query);
                table.address_roots(1, 0, other);
              }),
              ::testing::HasSubstr("second access"));
  EXPECT_THAT(error_of([](AreaTable& table, auto& query, auto&) {
                table.address_roots(1, 1, query);
                table.address_roots(1, 0, query);
              }),
              "nothing")
      << "another reader has ports of its own";
}
INSTANTIATE_TEST_SUITE_P(Each, TableCycles,
                         ::testing::Values(AreaSource::kTableFull, AreaSource::kTableMerged,
                                           AreaSource::kTableMinimal));

}  // namespace
}  // namespace deburr::tb::morphological_rtl::smaa_tables_test
