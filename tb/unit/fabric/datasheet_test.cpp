// SPDX-License-Identifier: MIT
// Datasheets: how builds are merged into a list, and the text of the generated pages.
#include "rtl_model/fabric/datasheet.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "rtl_model/fabric/memory_port.h"
#include "spec/error.h"

namespace deburr::tb::datasheet_test {
namespace {

using rtl::Datasheet;

Datasheet halver(const std::string& variant, std::uint64_t latency) {
  return {.unit = "Halver",
          .variant = variant,
          .does = "Halves each token.",
          .latency = {latency},
          .stages = {{"1", "table", "SRAM read"}, {"2", "shift"}},
          .cost = "a shifter."};
}

TEST(Datasheets, VariantsOfOneUnitAreAdjacent) {
  const Datasheet doubler = {.unit = "Doubler", .does = "Doubles."};
  const std::vector<std::vector<Datasheet>> builds = {{halver("slow", 3), doubler},
                                                      {halver("fast", 2), doubler}};
  std::vector<std::string> titles;
  for (const Datasheet& sheet : rtl::merged(builds)) titles.push_back(title(sheet));
  EXPECT_EQ(titles, (std::vector<std::string>{"Halver, slow", "Halver, fast", "Doubler"}));
}

// A unit that only one build contains keeps its position in that build.
TEST(Datasheets, UnitsKeepTheirOrder) {
  const Datasheet first = {.unit = "First"}, last = {.unit = "Last"};
  const std::vector<std::vector<Datasheet>> builds = {{first, halver("slow", 3), last},
                                                      {first, {.unit = "Other"}, last}};
  std::string units;
  for (const Datasheet& sheet : rtl::merged(builds)) units += sheet.unit + " ";
  EXPECT_EQ(units, "First Other Halver Last ");
}

TEST(Datasheets, RejectsOneTitleForDifferentUnits) {
  const std::vector<std::vector<Datasheet>> builds = {{halver("slow", 3)}, {halver("slow", 2)}};
  EXPECT_THROW(rtl::merged(builds), spec::CheckFailed);
}

// Cycles may differ between builds if a text says what they depend on.
TEST(Datasheets, CyclesExplainedByTextMayDiffer) {
  Datasheet one = halver("", 3), other = halver("", 4);
  one.latency.text = other.latency.text = "2, and `more`";
  const std::vector<std::vector<Datasheet>> builds = {{one}, {other}};
  EXPECT_EQ(rtl::merged(builds).size(), 1u);
}

TEST(Datasheets, PageHasSummaryTableThenUnitStages) {
  Datasheet fast = halver("fast", 2);
  fast.megahertz = 300;
  fast.interval = {1, "one token per cycle"};
  EXPECT_EQ(rtl::datasheets_markdown(std::vector{halver("slow", 3), fast}), R"(
| unit | latency | initiation interval |
|---|---|---|
| Halver, slow | 3 | 1 |
| Halver, fast | 2 | one token per cycle |

### Halver

Halves each token.

**slow**

Latency: 3; initiation interval: 1.

| stage | work | longest path |
|---|---|---|
| 1 | table | SRAM read |
| 2 | shift |  |

**fast**

Latency: 2; initiation interval: one token per cycle. For 300 MHz.

| stage | work | longest path |
|---|---|---|
| 1 | table | SRAM read |
| 2 | shift |  |

Cost: a shifter.
)");
}

// Only displayed variants of one unit share a heading and their common entries.
TEST(Datasheets, EachUnitShowsItsOwnEntries) {
  const Datasheet halves = {.unit = "Halver", .variant = "a", .cost = "a shifter."},
                  too = {.unit = "Halver", .variant = "b", .cost = "a shifter."},
                  doubles = {.unit = "Doubler", .cost = "a shifter."};
  const auto counted = [](std::span<const Datasheet> sheets) {
    const std::string page = rtl::datasheets_markdown(sheets);
    const auto count = [&](const std::string& of) {
      int found = 0;
      for (std::size_t at = page.find(of); at != std::string::npos; at = page.find(of, at + 1))
        ++found;
      return found;
    };
    return std::pair{count("\n### "), count("\nCost: ")};
  };
  const std::vector<Datasheet> sheets = {doubles, halves, too};
  EXPECT_EQ(counted(sheets), (std::pair{2, 2}));
  EXPECT_EQ(counted(std::span(sheets).first(2)), (std::pair{2, 2}));
}

TEST(Datasheets, MemoryPortMatchesContract) {
  EXPECT_EQ(rtl::MemoryPort::datasheet().latency.cycles, 2u);
  EXPECT_EQ(rtl::MemoryPort::datasheet().interval.cycles, 1u);
}

// Stages of several clocks and copies multiply; equal operators are one entry, none of count 0.
TEST(Datasheets, CostSentenceCountsOperatorsOfClocksAndCopies) {
  const Datasheet adder = {
      .unit = "Adder",
      .stages = {{.clock = "1",
                  .work = "sum",
                  .operators = {2 * rtl::op::add(8), 0 * rtl::op::square(8)},
                  .registers = 9},
                 {.clock = "2-4",
                  .work = "sum and choice",
                  .operators = {rtl::op::add(8), rtl::op::mux(8, 4)},
                  .longest = {rtl::op::add(8), rtl::op::mux(8, 4), rtl::op::mux(8, 1)},
                  .registers = 8},
                 {.clock = "5, 6",
                  .work = "product",
                  .operators = {rtl::op::multiply(8, 9), rtl::op::logic(6)}}},
      .copies = 2,
      .per = "lane",
      .shared = {rtl::op::compare(5)},
      .shared_registers = 3,
      .cost = "a FIFO."};
  EXPECT_THAT(rtl::datasheets_markdown(std::vector{adder}),
              testing::HasSubstr("| 2-4 | sum and choice | add 8, mux 4 : 1 x 8 |"));
  EXPECT_THAT(rtl::datasheets_markdown(std::vector{adder}),
              testing::HasSubstr("Cost: per lane: add 8 (5); mux 4 : 1 x 8 (3); multiply 8 x 9 "
                                 "(2); logic 12 gates; 33 flip-flops. Once: comparator 5; 3 "
                                 "flip-flops. a FIFO.\n"));
  EXPECT_EQ(operators_of(adder),
            (std::vector{10 * rtl::op::add(8), 6 * rtl::op::mux(8, 4), 4 * rtl::op::multiply(8, 9),
                         4 * rtl::op::logic(6), rtl::op::compare(5)}));
  EXPECT_EQ(registers_of(adder), 69u);
}

}  // namespace
}  // namespace deburr::tb::datasheet_test
