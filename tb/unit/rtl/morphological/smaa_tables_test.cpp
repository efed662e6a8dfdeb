// SPDX-License-Identifier: MIT
// SMAA's tables in the hardware: every word by the contract's hashes, every read of the three
// layouts equal, and faults in each ROM and on each link of its blocks caught.
#include <array>
#include <deque>
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

// Of an engine's ROMs: T and U, of the layout that has them alone; S; R; D.
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

// By the table of docs/reference/morphological/memories.md, of one lane and of two.
TEST(SmaaTables, RomsAreThoseOfThePage) {
  struct Owner : sc_core::sc_module {
    Owner(const sc_core::sc_module_name& name, AreaSource layout, int lanes)
        : sc_module(name), table(layout, AreaValues::kExact, lanes) {}
    AreaTable table;
  };
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
    const Owner owner(name.c_str(), row.layout, row.lanes);
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

TEST(SmaaTables, WordsHaveTheContractsHashes) {
  const RomHashes exact = rom_hashes(AreaValues::kExact),
                  published = rom_hashes(AreaValues::kPublished);
  const spec::morphological::TableHashes got = {
      exact.tiles[0],  exact.tiles[1],     exact.roots,        exact.mix,
      exact.diagonals, published.tiles[0], published.tiles[1], published.diagonals};
  EXPECT_EQ(differences(spec::morphological::kTableHashes, got), "");
  expect_each_value_is_compared(spec::morphological::kTableHashes, got);
  // Not of the areas.
  EXPECT_EQ(published.roots, exact.roots);
  EXPECT_EQ(published.mix, exact.mix);
}

class TableLayouts : public ::testing::TestWithParam<AreaValues> {};

TEST_P(TableLayouts, GiveTheSameShares) {
  struct Owner : sc_core::sc_module {
    Owner(const sc_core::sc_module_name& name, AreaSource layout)
        : sc_module(name), table(layout, GetParam(), 1) {}
    AreaTable table;
  };
  Owner full("full", AreaSource::kTableFull), merged("merged", AreaSource::kTableMerged),
      minimal("minimal", AreaSource::kTableMinimal);
  Cycle cycle = 1;
  const auto read = [&](AreaTable& table, int l, int r, int shape) {
    AreaTable::Query query{static_cast<std::uint8_t>(l), static_cast<std::uint8_t>(r),
                           static_cast<std::uint8_t>(shape)};
    table.address_roots(cycle, 0, query);
    table.address_entries(cycle + 1, 0, query);
    const AreaTable::Weights weights = table.weights(cycle + 2, 0, query);
    cycle += 3;
    return std::pair<int, int>{weights.first, weights.second};
  };
  // Step of the first distance: every pair with a small one, and the last.
  for (int shape = 0; shape < 16; ++shape)
    for (int l = 0; l < 225; l += l < 30 || l > 220 ? 1 : 7)
      for (int r = 0; r < 225; ++r) {
        const auto expected = read(full.table, l, r, shape);
        ASSERT_EQ(read(merged.table, l, r, shape), expected) << shape << " " << l << " " << r;
        ASSERT_EQ(read(minimal.table, l, r, shape), expected) << shape << " " << l << " " << r;
      }
  if (GetParam() == AreaValues::kPublished) return;
  // The contract's: T and U of an L and a U on the second side.
  for (const spec::morphological::TableVector& v : spec::morphological::kTableVectors) {
    for (AreaTable* table : {&full.table, &merged.table, &minimal.table}) {
      const auto half = read(*table, v.l, v.r, 2), dip = read(*table, v.l, v.r, 10);
      const spec::morphological::TableResult got = {static_cast<std::uint64_t>(half.second),
                                                    static_cast<std::uint64_t>(dip.second)};
      EXPECT_EQ(differences(v.result, got), "") << v.l << ' ' << v.r;
      expect_each_value_is_compared(v.result, got);
      EXPECT_EQ(half.first, 0);
      EXPECT_EQ(dip.first, 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Each, TableLayouts,
                         ::testing::Values(AreaValues::kExact, AreaValues::kPublished));

// ---- cycles -------------------------------------------------------------------------------------

class TableCycles : public ::testing::TestWithParam<AreaSource> {
 protected:
  struct Owner : sc_core::sc_module {
    Owner(const sc_core::sc_module_name& name, AreaSource layout)
        : sc_module(name), table(layout, AreaValues::kExact, 1) {}
    AreaTable table;
  };
  // Of a query and of one with other addresses in every ROM, what the table says to this.
  template <class Use>
  static std::string said(Use&& use) {
    Owner owner("owner", GetParam());
    AreaTable::Query query{5, 3, 9}, other{100, 60, 9};
    try {
      use(owner.table, query, other);
    } catch (const spec::CheckFailed& failure) {
      return failure.what();
    }
    return "nothing";
  }
};

// Roots come a clock after their addresses, entries a clock after theirs.
TEST_P(TableCycles, WordsComeInTheirClock) {
  EXPECT_EQ(said([](AreaTable& table, auto& query, auto&) {
              table.address_roots(1, 0, query);
              table.address_entries(2, 0, query);
              const AreaTable::Weights weights = table.weights(3, 0, query);
              EXPECT_NE(weights.first + weights.second, 0);
            }),
            "nothing");
}
// A query a clock, each of three stages at work: no word of one is another's.
TEST_P(TableCycles, TakeAQueryAClock) {
  Owner pipelined("pipelined", GetParam()), alone("alone", GetParam());
  std::vector<AreaTable::Query> queries;
  for (unsigned i = 0; i < 400; ++i)
    queries.push_back({static_cast<std::uint8_t>(i * 37 % 225),
                       static_cast<std::uint8_t>(i * 101 % 225),
                       static_cast<std::uint8_t>(i * 7 % 16)});
  std::vector<AreaTable::Query> one_by_one = queries;
  for (std::size_t c = 0; c < queries.size() + 2; ++c) {
    if (c >= 2) {
      const AreaTable::Weights got = pipelined.table.weights(c, 0, queries[c - 2]);
      AreaTable::Query& query = one_by_one[c - 2];
      alone.table.address_roots(4 * c, 0, query);
      alone.table.address_entries(4 * c + 1, 0, query);
      const AreaTable::Weights want = alone.table.weights(4 * c + 2, 0, query);
      ASSERT_EQ(got.first, want.first) << c;
      ASSERT_EQ(got.second, want.second) << c;
    }
    if (c >= 1 && c <= queries.size()) pipelined.table.address_entries(c, 0, queries[c - 1]);
    if (c < queries.size()) pipelined.table.address_roots(c, 0, queries[c]);
  }
}
TEST_P(TableCycles, ARootIsNotUsedAClockEarly) {
  EXPECT_THAT(said([](AreaTable& table, auto& query, auto&) {
                table.address_roots(1, 0, query);
                table.address_entries(1, 0, query);
              }),
              ::testing::AllOf(::testing::HasSubstr("sqrt_rom"), ::testing::HasSubstr("is used")));
}
TEST_P(TableCycles, ARootIsNotUsedAClockLate) {
  EXPECT_THAT(said([](AreaTable& table, auto& query, auto& other) {
                table.address_roots(1, 0, query);
                table.address_roots(2, 0, other);
                table.address_entries(3, 0, query);
              }),
              ::testing::AllOf(::testing::HasSubstr("sqrt_rom"),
                               ::testing::HasSubstr("was available from cycle 2 on")));
}
TEST_P(TableCycles, AnEntryIsNotUsedAClockEarly) {
  EXPECT_THAT(said([](AreaTable& table, auto& query, auto&) {
                table.address_roots(1, 0, query);
                table.address_entries(2, 0, query);
                table.weights(2, 0, query);
              }),
              ::testing::AllOf(::testing::HasSubstr("area_rom"), ::testing::HasSubstr("is used")));
}
TEST_P(TableCycles, AnEntryIsNotUsedAClockLate) {
  EXPECT_THAT(said([](AreaTable& table, auto& query, auto& other) {
                table.address_roots(1, 0, query);
                table.address_roots(2, 0, other);
                table.address_entries(2, 0, query);
                table.address_entries(3, 0, other);
                table.weights(4, 0, query);
              }),
              ::testing::AllOf(::testing::HasSubstr("area_rom"),
                               ::testing::HasSubstr("was available from cycle 3 on")));
}
// A port gives a word a clock: a second query of a reader in the same clock is rejected.
TEST_P(TableCycles, AReaderAsksOnceAClock) {
  EXPECT_THAT(said([](AreaTable& table, auto& query, auto& other) {
                table.address_roots(1, 0, query);
                table.address_roots(1, 0, other);
              }),
              ::testing::HasSubstr("second access"));
  EXPECT_THAT(said([](AreaTable& table, auto& query, auto&) {
                table.address_roots(1, 1, query);
                table.address_roots(1, 0, query);
              }),
              "nothing")
      << "another reader has ports of its own";
}
INSTANTIATE_TEST_SUITE_P(Each, TableCycles,
                         ::testing::Values(AreaSource::kTableFull, AreaSource::kTableMerged,
                                           AreaSource::kTableMinimal));

// ---- injected faults
// -----------------------------------------------------------------------------

// A falling stair of one pixel.
const spec::morphological::PatternVector& stair() {
  for (const spec::morphological::PatternVector& v : spec::morphological::kPatternVectors)
    if (v.name == "/") return v;
  throw std::out_of_range("no pattern /");
}

TEST(SmaaRomFaults, AWordOfDiagonalRomIsMissed) {
  EngineBench bench(smaa());
  rom<std::uint16_t>("diagonal_rom").backdoor(rtl::morphological::diagonal_address(2, 2, 4, 3)) ^=
      1u << 4;
  EXPECT_NE(hash(bench.run(morphological::vector_image(stair()))), stair().result.hash);
}

struct RomFault {
  const char* name;
  std::uint64_t address;
};
void PrintTo(const RomFault& f, std::ostream* out) { *out << f.name; }
class SmaaRomFault : public ::testing::TestWithParam<RomFault> {};

// One entry one step off.
TEST_P(SmaaRomFault, IsCaught) {
  EngineBench bench(smaa(Quality::kMedium));
  if (std::string(GetParam().name) == "mix_rom")
    rom<std::uint32_t>("mix_rom").backdoor(GetParam().address) += 1u << 9;
  else
    rom<std::uint16_t>(GetParam().name).backdoor(GetParam().address) ^=
        static_cast<std::uint16_t>(std::string(GetParam().name) == "sqrt_rom" ? 64 : 1);
  EXPECT_NE(hash(bench.run(noise())), vector_hash("smaa_noise_low"));
}
// Entries (0, 0) to (1, 0) of pattern 6, (1, 1) of 2; of the others what short runs ask for.
INSTANTIATE_TEST_SUITE_P(Injected, SmaaRomFault,
                         ::testing::Values(RomFault{"area_rom0", 6 * 64},
                                           RomFault{"area_rom1", 6 * 64},
                                           RomFault{"area_rom2", 6 * 64},
                                           RomFault{"area_rom3", 2 * 64}, RomFault{"sqrt_rom", 2},
                                           RomFault{"mix_rom", 64}));

class SmaaLinkFaults : public ::testing::TestWithParam<const char*> {};

TEST_P(SmaaLinkFaults, AreCaught) {
  EngineBench::Options options;
  options.bench.faults = {GetParam()};
  options.bench.check_links = false;
  options.bench.patience = 5'000;
  EngineBench bench(smaa(), options);
  bool caught = false;
  try {
    caught = hash(bench.run(noise(), 100'000)) != vector_hash("smaa_noise_high") ||
             bench.engine.work().diagonal_pixels != 258;
  } catch (const spec::SimulationError& error) {
    // A injected fault that was never reached is no catch.
    caught = std::string(error.what()).find("never") == std::string::npos;
    if (!caught) ADD_FAILURE() << error.what();
  } catch (const spec::ConfigError& error) {
    FAIL() << error.what();
  } catch (const std::exception&) {
    caught = true;
  }
  EXPECT_TRUE(caught);
}
INSTANTIATE_TEST_SUITE_P(
    Injected, SmaaLinkFaults,
    ::testing::Values("flip:engine.diagonal_columns:2000:top.0.8",
                      "drop:engine.diagonal_columns:2000", "duplicate:engine.diagonal_columns:2000",
                      "drop:engine.diagonal_unit.diagonal_weights_entries:2000",
                      "duplicate:engine.diagonal_unit.diagonal_weights_entries:2000",
                      "flip:engine.lines_h0:200:line.run.far.0",
                      "flip:engine.lines_v0:300:line.run.far.2",
                      "flip:engine.lines_h0:200:line.run.shape.0"));

}  // namespace
}  // namespace deburr::tb::morphological_rtl::smaa_tables_test
