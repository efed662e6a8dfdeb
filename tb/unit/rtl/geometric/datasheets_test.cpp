// SPDX-License-Identifier: MIT
// Datasheets of the geometric engine: every unit has one, and the numbers match the contract.
#include "rtl_model/geometric/datasheets.h"

#include <bit>
#include <set>
#include <string>
#include <utility>

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/geometric/support.h"

namespace deburr::tb::geometric_rtl::datasheets_test {
namespace {

TEST(GeometricDatasheets, DatasheetsMatchTheContract) {
  expect_contract(rtl::geometric::datasheets(), {{"FrameSequencer", 0, 1},
                                                 {"FacingStore", 2, 1},
                                                 {"EdgeReader, `records = joined`", 2, 1},
                                                 {"EdgeReader, `records = split`", 2, 1},
                                                 {"EdgeClassifier, `records = joined`", 3, 1},
                                                 {"EdgeClassifier, `records = split`", 3, 1},
                                                 {"PairFetch", 3, 1},
                                                 {"VertexFetch", 5, 1},
                                                 {"LineSetup, `pipelined`", 22, 1},
                                                 {"LineSetup, not pipelined", 22, 13},
                                                 {"LineWalker", 1, 1},
                                                 {"CoverageUnit", 3, 1},
                                                 {"DepthScreen", 5, 1},
                                                 {"DepthTest, without `coarse_lines`", 7, 1},
                                                 {"DepthTest, with `coarse_lines`", 7, 1},
                                                 {"WeightCombiner, without `write_buffer`", 5, 1},
                                                 {"WeightCombiner, with `write_buffer`", 5, 1},
                                                 {"BlockScanner", 3, 1},
                                                 {"BlockFetch, without `colour_lines`", 5, 1},
                                                 {"BlockFetch, with `colour_lines`", 5, 1},
                                                 {"Resolver", 8, 1},
                                                 {"FrameCopier", 0, 2},
                                                 {"MemoryArbiter, 8 clients", 1, 1},
                                                 {"MemoryArbiter, 10 clients", 1, 1}});
}

TEST(GeometricDatasheets, EveryUnitHasADatasheet) {
  Parameters split;
  split.records = spec::geometric::RecordsLayout::kSplit;
  split.coarse_lines = spec::geometric::CoarseLines::k4;
  for (const Parameters& p : {Parameters{}, split}) {
    const EngineBench b(p);
    expect_datasheets(b.engine, rtl::geometric::datasheets(p));
  }
}

// All of this kind and these widths in a unit; 0 without the unit.
std::uint64_t built(const Parameters& p, const std::string& unit, const rtl::Operator& wanted) {
  std::uint64_t count = 0;
  for (const rtl::Datasheet& sheet : rtl::geometric::datasheets(p))
    if (sheet.unit == unit)
      for (rtl::Operator one : operators_of(sheet))
        if (const std::uint32_t there = std::exchange(one.count, 1); one == wanted) count += there;
  return count;
}

TEST(GeometricDatasheets, OperatorsFollowTheBuild) {
  namespace op = rtl::op;
  for (int lanes : {1, 2, 4}) {
    Parameters p;
    p.edge_lanes = p.walkers = p.resolve_lanes =
        static_cast<spec::geometric::Lanes>(std::countr_zero(static_cast<unsigned>(lanes)));
    const auto n = static_cast<std::uint64_t>(lanes);
    EXPECT_EQ(built(p, "EdgeClassifier", op::mux(1, 32)), 2 * n);
    EXPECT_EQ(built(p, "LineWalker", op::add(40)), n);
    EXPECT_EQ(built(p, "CoverageUnit", op::magnitude(16)), n);
    EXPECT_EQ(built(p, "DepthTest", op::shift(24, 24)), 2 * n);
    EXPECT_EQ(built(p, "WeightCombiner", op::mux(8, 32)), 2 * n);
    EXPECT_EQ(built(p, "Resolver", op::multiply(8, 13)), 6 * n);
  }
  Parameters p;
  EXPECT_EQ(built(p, "LineSetup", op::subtract(26)), 3u * 13);
  p.pipelined = false;
  p.dividers = 2;
  EXPECT_EQ(built(p, "LineSetup", op::subtract(26)), 3u * 2);
  EXPECT_EQ(built(p, "DepthScreen", op::multiply(8, 8)), 0u);
  EXPECT_EQ(built(p, "WeightCombiner", op::equal(23)), 1u + 108);
  p.coarse_lines = spec::geometric::CoarseLines::k8;
  p.write_buffer = 16;
  EXPECT_EQ(built(p, "DepthScreen", op::multiply(8, 8)), 1u);
  EXPECT_EQ(built(p, "WeightCombiner", op::equal(23)), 1u + 108 + 16);
}

TEST(GeometricDatasheets, ListsNameOperatorsOfSomeWidthAndCountersOfTheUnit) {
  Parameters least, most;
  least.edge_lanes = least.walkers = least.resolve_lanes = spec::geometric::Lanes::kOne;
  least.pipelined = most.pipelined = false;
  most.edge_lanes = most.resolve_lanes = spec::geometric::Lanes::kFour;
  most.records = spec::geometric::RecordsLayout::kSplit;
  most.coarse_lines = spec::geometric::CoarseLines::k64;
  most.colour_lines = most.write_buffer = 128;
  most.reciprocal_table = 10;
  for (const Parameters& p : {Parameters{}, least, most}) {
    const EngineBench b(p);
    for (const rtl::Datasheet& sheet : rtl::geometric::datasheets(p)) {
      std::set<std::string> counters = {""};
      for (const rtl::Unit* unit : b.engine.units())
        if (class_of(*unit) == sheet.unit)
          for (const sc_core::sc_object* child : unit->get_child_objects())
            if (dynamic_cast<const rtl::Counter*>(child)) counters.insert(child->basename());
      for (const rtl::Stage& stage : sheet.stages)
        EXPECT_TRUE(counters.contains(stage.on)) << title(sheet) << ": " << stage.on;
      for (const rtl::Operator& one : operators_of(sheet))
        EXPECT_TRUE(one.count > 0 && one.a > 0 &&
                    (one.kind != rtl::OperatorKind::kMux || one.b > 1))
            << title(sheet) << ": " << counted(one);
    }
  }
}

}  // namespace
}  // namespace deburr::tb::geometric_rtl::datasheets_test
