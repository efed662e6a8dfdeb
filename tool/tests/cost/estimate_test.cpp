// SPDX-License-Identifier: MIT
// The estimate of a unit is the sum of its operators, registers, memories and links; a row of
// mapped RTL replaces it for its very parameters only.
#include "tool/cost/estimate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "spec/error.h"

namespace deburr::tool::estimate_test {
namespace {

using Json = nlohmann::ordered_json;
namespace op = rtl::op;

// Every kind: `a` gates and 1 ns, except those named.
Json primitives_json() {
  Json json = {{"technology", "made_up"}, {"kinds", Json::object()}};
  const auto kind = [&](const std::string& name, const std::string& form,
                        const std::vector<double>& coefficients, double ns) {
    json["kinds"][name] = {{"gates", {{"form", form}, {"coefficients", coefficients}}},
                           {"ns", {{"form", "1"}, {"coefficients", {ns}}}}};
  };
  for (int i = 0; i <= static_cast<int>(rtl::OperatorKind::kLogic); ++i)
    kind(name_of(static_cast<rtl::OperatorKind>(i)), "a", {1}, 1);
  kind("multiply", "a*b + a*b*min(a,b)", {6, 0.5}, 5);
  kind("register", "a", {4}, 0);
  kind("register_enable", "a", {7}, 0);
  kind("memory", "a*b", {4}, 0);
  kind("memory_write", "a*b", {3}, 0);
  kind("memory_read", "a*b", {2}, 0);
  kind("link", "a*b", {8}, 0);
  kind("fifo", "1 + a + log2(b)", {100, 10, 1}, 0);
  return json;
}

Primitives made_up(const Json& json = primitives_json()) { return Primitives(json.dump()); }

tb::MemoryFigures memory(const std::string& name, const std::string& owner, const std::string& kind,
                         std::uint64_t words, std::uint64_t bits) {
  tb::MemoryFigures m;
  m.name = name;
  m.owner = owner;
  m.kind = kind;
  m.words = words;
  m.word_bits = bits;
  m.read_ports = m.write_ports = 1;
  m.logical_bits = m.physical_bits = words * bits;
  return m;
}

tb::Result adder() {
  tb::Result result;
  rtl::Datasheet sheet = {.unit = "Adder"};
  sheet.stages.push_back({.clock = "1",
                          .work = "sums",
                          .operators = {2 * op::add(8)},
                          .longest = {op::add(8), op::add(8)},
                          .registers = 10});
  sheet.stages.push_back({.clock = "2",
                          .work = "product",
                          .operators = {op::multiply(4, 6)},
                          .longest = {op::multiply(4, 6)},
                          .registers = 20});
  result.sheets = {{"adder", sheet}};
  return result;
}

TEST(Fit, AddsItsTerms) {
  EXPECT_DOUBLE_EQ(Fit("1 + a*b + a*min(a,b) + log2(b)", {1, 2, 3, 4}).at(5, 8),
                   1 + 2 * 40 + 3 * 25 + 4 * 3);
  EXPECT_DOUBLE_EQ(Fit("1 + a", {-10, 1}).at(3, 0), 0) << "never negative";
  EXPECT_DOUBLE_EQ(Fit("a*b", {2}).at(3, 0), 6) << "a width that a kind does not have";
}

TEST(Fit, RejectsUnknownFactorsAndMissingCoefficients) {
  EXPECT_THROW(Fit("a*c", {1}), spec::FileError);
  EXPECT_THROW(Fit("1 + a", {1}), spec::FileError);
}

TEST(Primitives, RejectsMissingKind) {
  Json json = primitives_json();
  json["kinds"].erase("shift");
  try {
    made_up(json);
    FAIL();
  } catch (const spec::FileError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("osu018.json: no kind 'shift'"));
  }
}

TEST(Primitives, EmbeddedFileHasEveryKind) {
  const Primitives& p = Primitives::embedded();
  EXPECT_EQ(p.technology(), "osu018");
  EXPECT_GT(p.multiply_ns(), 4);
  EXPECT_LT(p.multiply_ns(), 10);
  EXPECT_GT(p.gates(op::add(32)), p.gates(op::add(16)));
}

TEST(Estimate, AddsOperatorsAndRegistersOfUnit) {
  const tb::Cost cost = estimate(adder(), made_up());
  ASSERT_EQ(cost.units.size(), 2u) << "the unit, and the links";
  const tb::UnitCost& unit = cost.units[0];
  EXPECT_EQ(unit.basis, "estimate");
  EXPECT_DOUBLE_EQ(unit.gates.value, 2 * 8 + (6 * 24 + 0.5 * 24 * 4) + 7 * 30);
  EXPECT_EQ(unit.flip_flops, 30u);
  EXPECT_DOUBLE_EQ(unit.ns.value, 5);
  EXPECT_EQ(unit.stage, "2");
  EXPECT_DOUBLE_EQ(unit.gates.low, unit.gates.value * (1 - kUnitRange));
  EXPECT_DOUBLE_EQ(cost.gates.high, cost.gates.value * (1 + kSumRange));
  EXPECT_EQ(cost.limited_by, "adder stage 2");
  EXPECT_DOUBLE_EQ(cost.clock_mhz.value, 200);
  EXPECT_DOUBLE_EQ(cost.yardstick_ratio, 1);
  EXPECT_EQ(cost.technology, "made_up");
}

TEST(Estimate, ArithmeticInSeriesOverlaps) {
  tb::Result result = adder();
  const auto ns = [&](std::vector<rtl::Operator> longest) {
    result.sheets[0].sheet.stages = {{.clock = "1", .work = "", .longest = std::move(longest)}};
    return estimate(result, made_up()).units[0].ns.value;
  };
  const double add = ns({op::add(24)}), mux = ns({op::mux(24, 2)});
  EXPECT_DOUBLE_EQ(ns({2 * op::add(24)}), add * (1 + kOverlap));
  EXPECT_DOUBLE_EQ(ns({op::add(24), op::mux(24, 2), op::compare(24)}),
                   add + mux + kOverlap * ns({op::compare(24)}));
  EXPECT_DOUBLE_EQ(ns({2 * op::mux(24, 2)}), 2 * mux);
}

TEST(Estimate, CountsCopiesOnceEachAndSharedOnce) {
  tb::Result result = adder();
  const double one = estimate(result, made_up()).gates.value;
  result.sheets[0].sheet.copies = 3;
  result.sheets[0].sheet.shared = {op::add(5)};
  EXPECT_DOUBLE_EQ(estimate(result, made_up()).gates.value, 3 * one + 5);
}

TEST(Estimate, MemoriesBelongToTheUnitThatHoldsThem) {
  tb::Result result = adder();
  const double alone = estimate(result, made_up()).units[0].gates.value;
  result.memories = {memory("adder_sums", "adder", "flops", 16, 10),
                     memory("adder_rows", "adder", "sram", 64, 8),
                     memory("other_rows", "other", "rom", 4, 8)};
  result.memories[0].read_ports = 3;
  result.memories[0].write_ports = 2;
  const tb::Cost cost = estimate(result, made_up());
  ASSERT_EQ(cost.units.size(), 3u);
  EXPECT_DOUBLE_EQ(cost.units[0].gates.value, alone + 160 * (4 + 3 + 3 * 2));
  EXPECT_EQ(cost.units[0].flip_flops, 30u + 160u);
  EXPECT_EQ(cost.units[0].memory_bits, 512u);
  EXPECT_EQ(cost.units[1].name, "other");
  EXPECT_EQ(cost.units[1].memory_bits, 32u);
  EXPECT_EQ(cost.memory_bits, 544u);
  // All words are seen at once: no choice.
  result.memories[0].read_ports = 16;
  EXPECT_DOUBLE_EQ(estimate(result, made_up()).units[0].gates.value, alone + 160 * (4 + 3));
}

// "fill_buffer" of the MissQueue is a part of its own.
TEST(Estimate, MemoryNamedAfterAnotherUnitIsOfThatUnit) {
  tb::Result result;
  result.sheets = {{"miss_queue", {.unit = "MissQueue"}}, {"fill_buffer", {.unit = "FillBuffer"}}};
  result.memories = {memory("miss_queue_fill_buffer", "miss_queue", "sram", 4, 8),
                     memory("miss_queue_lines", "miss_queue", "sram", 2, 8)};
  const tb::Cost cost = estimate(result, made_up());
  ASSERT_EQ(cost.units.size(), 3u);
  EXPECT_EQ(cost.units[0].memory_bits, 16u);
  EXPECT_EQ(cost.units[1].memory_bits, 32u);
}

TEST(Estimate, CountsControlOfFifosAndSlotsOfLinks) {
  tb::Result result = adder();
  const double alone = estimate(result, made_up()).units[0].gates.value;
  result.memories = {memory("adder_queue", "adder", "sram", 32, 9)};
  result.memories[0].high_water = 0;
  result.memories[0].register_bits = 18;
  result.link_shapes = {{"in", "adder", 12, 2}};
  const tb::Cost cost = estimate(result, made_up());
  EXPECT_DOUBLE_EQ(cost.units[0].gates.value, alone + 100 + 90 + 5);
  EXPECT_EQ(cost.units[0].flip_flops, 30u + 18u);
  EXPECT_DOUBLE_EQ(cost.units[1].gates.value, 8 * 24);
  EXPECT_EQ(cost.units[1].flip_flops, 24u);
}

// A unit of the texture unit with a row in cost.json.
TEST(Estimate, MappedRowCountsForItsParametersOnly) {
  tb::Result result;
  result.sheets = {{"texture_miss_queue", {.unit = "MissQueue"}}};
  std::map<std::string, Json, std::less<>> given = {{"texture.width", 1},
                                                    {"texture.blend", "sample"},
                                                    {"texture.derivatives", "fine"},
                                                    {"texture.decode", "none"},
                                                    {"texture.cache.line_bytes", 64},
                                                    {"texture.cache.outstanding", 64}};
  const auto basis = [&] {
    const tb::Cost cost = estimate(result, [&](std::string_view name) {
      const auto found = given.find(name);
      return found == given.end() ? Json() : found->second;
    });
    return cost.units.front().basis;
  };
  result.sheets[0].sheet.shared = {op::add(5)};
  EXPECT_EQ(basis(), "mapped");
  given["texture.cache.outstanding"] = 63;
  EXPECT_EQ(basis(), "estimate");
  given["texture.cache.outstanding"] = 64;
  given["texture.width"] = 4;
  EXPECT_EQ(basis(), "estimate") << "no RTL of this width";
}

TEST(Estimate, TwiceTheWidthOfAnOperatorShows) {
  tb::Result result = adder();
  const double before = estimate(result).gates.value;
  result.sheets[0].sheet.stages[1].operators = {op::multiply(8, 6)};
  EXPECT_GT(estimate(result).gates.value, 1.2 * before);
}

}  // namespace
}  // namespace deburr::tool::estimate_test
