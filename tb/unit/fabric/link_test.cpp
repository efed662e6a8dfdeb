// SPDX-License-Identifier: MIT
// The link protocol: latency 1, refill after 1, initiation interval, independence of evaluation
// order, misuse.
#include "rtl_model/fabric/link.h"

#include <gtest/gtest.h>

#include <array>

#include "tb/unit/fabric/support.h"

namespace deburr::tb::link_test {
namespace {

using rtl::Cycle;
using rtl::In;
using rtl::Link;
using rtl::Out;

TEST(Link, BeatArrivesInNextCycle) {
  Link<int> link("link");
  EXPECT_FALSE(link.can_pop(5));
  ASSERT_TRUE(link.can_push(5));
  link.push(5, 42);
  EXPECT_FALSE(link.can_pop(5));
  ASSERT_TRUE(link.can_pop(6));
  EXPECT_EQ(link.front(6), 42);
  EXPECT_EQ(link.take(6), 42);
  EXPECT_FALSE(link.can_pop(7));
}

TEST(Link, FreedSlotIsFreeInNextCycle) {
  Link<int> link("link", 1);
  link.push(0, 1);
  EXPECT_FALSE(link.can_push(1));
  link.pop(1);
  EXPECT_FALSE(link.can_push(1));
  EXPECT_TRUE(link.can_push(2));
}

TEST(Link, AcceptsOnePushAndOnePopPerCycle) {
  Link<int> link("link", 4);
  link.push(0, 1);
  EXPECT_FALSE(link.can_push(0));
  EXPECT_THROW(link.push(0, 2), spec::CheckFailed);
  link.push(1, 2);
  link.pop(2);
  EXPECT_FALSE(link.can_pop(2));
  EXPECT_THROW(link.pop(2), spec::CheckFailed);
}

// A producer and a consumer that always want to act: cycles in which a beat arrives, for each depth
// and evaluation order.
std::vector<Cycle> arrivals(std::uint32_t depth, bool producer_first, Cycle cycles) {
  Link<int> link("link", depth);
  std::vector<Cycle> arrived;
  for (Cycle c = 0; c < cycles; ++c) {
    const auto produce = [&] {
      if (link.can_push(c)) link.push(c, 0);
    };
    const auto consume = [&] {
      if (link.can_pop(c)) {
        link.pop(c);
        arrived.push_back(c);
      }
    };
    producer_first ? (produce(), consume()) : (consume(), produce());
  }
  return arrived;
}

TEST(Link, DepthTwoSustainsOneBeatPerCycle) {
  const std::vector<Cycle> expected{1, 2, 3, 4, 5, 6, 7, 8, 9};
  for (const std::uint32_t depth : {2U, 3U, 8U}) {
    EXPECT_EQ(arrivals(depth, true, 10), expected);
    EXPECT_EQ(arrivals(depth, false, 10), expected);
  }
}

TEST(Link, DefaultDepthIsTwo) {
  EXPECT_EQ(Link<int>("two").depth(), 2U);
  EXPECT_EQ(Link<int>("three", 3).depth(), 3U);
}

TEST(Link, DepthOneAcceptsEverySecondCycle) {
  const std::vector<Cycle> expected{1, 3, 5, 7, 9};
  EXPECT_EQ(arrivals(1, true, 10), expected);
  EXPECT_EQ(arrivals(1, false, 10), expected);
}

// For any stalls, depth and evaluation order: the same beats in the same cycles.
TEST(Link, EvaluationOrderDoesNotMatter) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const std::uint32_t depth = 1 + static_cast<std::uint32_t>(seed % 5);
    std::string reference;
    for (int order = 0; order < 3; ++order) {
      Link<std::uint64_t> link("link", depth);
      Random stalls(seed), coin(seed + static_cast<std::uint64_t>(order) * 1000);
      std::string seen;
      std::uint64_t next = 0;
      for (Cycle c = 0; c < 200; ++c) {
        const bool wants_push = stalls.chance(700), wants_pop = stalls.chance(600);
        const bool producer_first = order == 0 || (order == 2 && coin.chance(500));
        for (int side = 0; side < 2; ++side) {
          if ((side == 0) == producer_first) {
            if (wants_push && link.can_push(c)) link.push(c, next++);
          } else if (wants_pop && link.can_pop(c)) {
            seen += fmt::format("{}@{} ", link.take(c), c);
          }
        }
      }
      seen += fmt::format("{} {} {}", link.occupancy(), link.pushes(), link.pops());
      if (order == 0) reference = seen;
      EXPECT_EQ(seen, reference) << "seed " << seed;
      EXPECT_GT(link.pops(), 50U);
    }
  }
}

TEST(Link, FullLinkKeepsOrderAcrossBufferWrap) {
  Link<int> link("link", 3);  // the buffer has four slots
  Cycle c = 0;
  int in = 0, out = 0;
  for (; in < 3; ++in) link.push(c++, in);
  EXPECT_FALSE(link.can_push(c));
  for (; in < 20; ++in) {
    EXPECT_EQ(link.take(c++), out++);
    link.push(c++, in);
    EXPECT_EQ(link.occupancy(), 3U);
  }
}

TEST(Link, MisuseErrorNamesLinkAndCaller) {
  Link<int> link("quads", 1);
  try {
    link.pop(17);
    FAIL();
  } catch (const spec::CheckFailed& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("quads"));
    EXPECT_THAT(error.what(), testing::HasSubstr("cycle 17"));
  }
  EXPECT_THROW(link.front(17), spec::CheckFailed);
  link.push(17, 1);
  EXPECT_THROW(link.push(18, 2), spec::CheckFailed);
  EXPECT_THROW(Link<int>("none", 0), spec::CheckFailed);
  EXPECT_THROW(Link<int>("endless", (1U << 24) + 1), spec::CheckFailed);
}

TEST(Link, ResetEmptiesIt) {
  Link<int> link("link");
  link.push(0, 1);
  link.push(1, 2);
  link.reset();
  EXPECT_TRUE(link.empty());
  EXPECT_FALSE(link.can_pop(2));
  EXPECT_TRUE(link.can_push(2));
  EXPECT_EQ(link.last_push(), rtl::kNever);
}

TEST(Link, EmplaceEqualsPush) {
  Link<Token> link("link");
  Token& token = link.emplace(3);
  token.number = 9;
  EXPECT_FALSE(link.can_pop(3));
  EXPECT_EQ(link.front(4).number, 9U);
}

// A hold that a testbench places on a link lasts for the named cycle only.
TEST(Link, HeldSidesWaitForOneCycle) {
  Link<int> link("link", 4);
  link.push(3, 1);
  link.hold_push(5);
  link.hold_pop(5);
  EXPECT_FALSE(link.can_push(5));
  EXPECT_FALSE(link.can_pop(5));
  EXPECT_TRUE(link.can_push(6));
  EXPECT_TRUE(link.can_pop(6));
  // A side that has to wait longer anyway still does.
  link.push(6, 2);
  link.hold_push(4);
  EXPECT_FALSE(link.can_push(6));
  EXPECT_TRUE(link.can_push(7));
}

TEST(Link, DroppedBeatFreesItsSlotInNextCycle) {
  Link<int> link("link", 2);
  EXPECT_FALSE(link.drop_newest());
  link.push(4, 1);
  link.push(5, 2);
  ASSERT_TRUE(link.drop_newest());
  EXPECT_EQ(link.occupancy(), 1U);
  EXPECT_FALSE(link.can_push(5));
  ASSERT_TRUE(link.can_push(6));
  EXPECT_EQ(link.take(6), 1);
  EXPECT_FALSE(link.can_pop(7));  // the dropped one never arrives
  link.push(7, 3);
  EXPECT_EQ(link.take(8), 3);
  EXPECT_TRUE(link.empty());
}

TEST(Link, DuplicateRepeatsNewestBeat) {
  Link<int> link("link", 4);
  EXPECT_FALSE(link.duplicate_newest(0));
  for (int i = 1; i <= 3; ++i) link.push(static_cast<Cycle>(i), i);
  ASSERT_TRUE(link.duplicate_newest(5));
  EXPECT_EQ(link.occupancy(), 4U);
  EXPECT_EQ(link.pushes(), 4U);
  EXPECT_FALSE(link.duplicate_newest(6));  // the link is full
  EXPECT_FALSE(link.can_push(6));
  std::vector<int> beats;
  for (Cycle c = 6; c < 10; ++c) beats.push_back(link.take(c));
  EXPECT_EQ(beats, (std::vector<int>{1, 2, 3, 3}));
  // Its slot is free only after it has left.
  Link<int> both("both", 2);
  both.push(0, 1);
  ASSERT_TRUE(both.duplicate_newest(1));
  both.pop(2);
  both.push(3, 2);
  EXPECT_FALSE(both.can_push(4));
  // A single beat arrives in its cycle.
  link.push(10, 9);
  link.pop(11);
  link.push(12, 7);
  ASSERT_TRUE(link.duplicate_newest(13));
  EXPECT_EQ(link.take(13), 7);
  EXPECT_EQ(link.take(14), 7);
}

// Checks the limit only, without allocating the slots.
TEST(Link, AllowsUpTo2To24Entries) {
  struct Bare : rtl::LinkBase {
    explicit Bare(std::uint32_t depth) : LinkBase("bare", depth, 4, rtl::Payload::of<int>()) {}
  };
  EXPECT_NO_THROW(Bare(1));
  EXPECT_NO_THROW(Bare(1U << 24));
  EXPECT_THROW(Bare((1U << 24) + 1), spec::CheckFailed);
}

TEST(Link, PackageListsBeatsOfAllLinksBelow) {
  struct Top : sc_core::sc_module {
    Link<Token> first{"first"}, second{"second"};
    explicit Top(const sc_core::sc_module_name& name) : sc_module(name) {}
  } top("top");
  Link<int> link("link");
  const rtl::LinkBase& elsewhere = link;
  const std::string package = rtl::link_package("top_pkg", top);
  EXPECT_THAT(package, testing::HasSubstr("package top_pkg;"));
  EXPECT_THAT(package, testing::HasSubstr("} token_t;"));
  EXPECT_THAT(package, testing::Not(testing::HasSubstr("s32_t")));
  EXPECT_THAT(rtl::payload_package("all_pkg", std::array{&elsewhere.payload()}),
              testing::HasSubstr("s32_t"));
}

TEST(Ports, BindInAnyOrderThroughHierarchy) {
  Link<int> link("link");
  Out<int> outer("outer"), inner("inner"), innermost("innermost");
  innermost(inner);
  EXPECT_FALSE(innermost.bound());
  outer(link);
  inner(outer);
  ASSERT_TRUE(innermost.bound());
  innermost.push(0, 5);
  EXPECT_EQ(link.front(1), 5);
  EXPECT_EQ(link.producer(), "innermost");
}

TEST(Ports, RejectTwoProducersOrTwoBindings) {
  Link<int> link("link"), other("other");
  Out<int> a("a"), b("b");
  a(link);
  EXPECT_THROW(b(link), spec::CheckFailed);
  EXPECT_THROW(a(other), spec::CheckFailed);
  In<int> c("c"), d("d");
  c(link);
  EXPECT_THROW(d(link), spec::CheckFailed);
  // A port bound to a port that has no link yet counts as bound.
  Link<int> third("third");
  Out<int> outer("outer"), inner("inner");
  inner(outer);
  EXPECT_THROW(inner(third), spec::CheckFailed);
  EXPECT_THROW(inner(a), spec::CheckFailed);
  // A port has one inner port, with or without a link.
  Out<int> second("second");
  EXPECT_THROW(second(outer), spec::CheckFailed);
  outer(third);
  EXPECT_THROW(second(outer), spec::CheckFailed);
  EXPECT_EQ(third.producer(), "inner");
}

TEST(Ports, SecondOwnerErrorNamesItsKind) {
  Link<int> link("link");
  const auto rejected = [&](auto& first, auto& second) -> std::string {
    first(link);
    try {
      second(link);
    } catch (const spec::CheckFailed& error) {
      return error.what();
    }
    return "";
  };
  Out<int> a("a"), b("b");
  In<int> c("c"), d("d");
  EXPECT_THAT(rejected(a, b), testing::HasSubstr("link has two producers: a and b"));
  EXPECT_THAT(rejected(c, d), testing::HasSubstr("link has two consumers: c and d"));
}

TEST(Ports, RejectUnboundPortAtElaboration) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(1, sc_core::SC_NS));
  Driver<int> driver("driver", clock);
  try {
    clock.run(1);
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("driver.beats_out is not bound"));
  }
}

TEST(Ports, RejectLinkBetweenTwoClockDomains) {
  rtl::ClockDomain fast("fast", sc_core::sc_time(1, sc_core::SC_NS));
  rtl::ClockDomain slow("slow", sc_core::sc_time(2, sc_core::SC_NS));
  Driver<int> driver("driver", fast);
  Sink<int> sink("sink", slow);
  Link<int> link("link");
  driver.beats_out(link);
  sink.beats_in(link);
  try {
    fast.run(1);
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("joins two clock domains"));
  }
}

}  // namespace
}  // namespace deburr::tb::link_test
