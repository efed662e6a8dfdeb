// SPDX-License-Identifier: MIT
// LineSetup: the lines of spec/geometric/vectors.h, random ones against its formulas with
// every way to a reciprocal, drops, latency and intervals.
#include "rtl_model/geometric/lines/line_setup.h"

#include <numeric>

#include "tb/base/random.h"
#include "tb/unit/rtl/geometric/parts.h"

namespace deburr::tb::geometric_rtl::line_setup_test {
namespace {

using rtl::geometric::EdgeEnds;
using rtl::geometric::LineToken;
using rtl::geometric::VertexFields;
using spec::geometric::Axis;
using spec::geometric::LineRecord;

struct SetupBench : Frame {
  explicit SetupBench(const Parameters& p = {}, int width = 1280, int height = 720)
      : Frame(p), unit("unit", clock, p, edge_latency), ends(clock) {
    unit.configuration_in(configuration);
    unit.ends_in(ends.in);
    unit.lines_out(ends.out);
    begin(width, height);
  }
  std::vector<LineRecord> run(const std::vector<EdgeEnds>& edges) {
    for (const EdgeEnds& e : edges) ends.source.add(e);
    EdgeEnds last{};
    last.end = true;
    ends.source.add(last);
    EXPECT_TRUE(clock.run_until(
        [&] { return !ends.sink.taken.empty() && ends.sink.taken.back().token.end; }, 1'000'000));
    std::vector<LineRecord> lines;
    for (const auto& taken : ends.sink.taken)
      if (!taken.token.end) lines.push_back(taken.token.line);
    return lines;
  }
  rtl::geometric::LineSetup unit;
  Ends<EdgeEnds, LineToken> ends;
};

VertexFields vertex(int x, int y, std::uint32_t depth) { return {x, y, depth, true}; }
// From major, minor and depth of both ends.
EdgeEnds edge(bool horizontal, std::array<int, 3> a, std::array<int, 3> b) {
  const auto make = [&](const std::array<int, 3>& e) {
    return vertex(horizontal ? e[0] : e[1], horizontal ? e[1] : e[0],
                  static_cast<std::uint32_t>(e[2]));
  };
  return {{make(a), make(b)}, false, false};
}

TEST(LineSetup, LinesOfThePage) {
  using spec::geometric::LineEnd;
  using spec::geometric::LineVector;
  SetupBench b({}, spec::geometric::kLineVectorWidth, spec::geometric::kLineVectorHeight);
  std::vector<EdgeEnds> edges;
  for (const LineVector& v : spec::geometric::kLineVectors) {
    const auto ends = [](const LineEnd& end) {
      return std::array{end.major, end.minor, static_cast<std::int32_t>(end.depth)};
    };
    const bool horizontal = v.axis == Axis::kHorizontal;
    edges.push_back(edge(horizontal, ends(v.a), ends(v.b)));
    edges.push_back(edge(horizontal, ends(v.b), ends(v.a)));
  }
  const std::vector<LineRecord> lines = b.run(edges);
  ASSERT_EQ(lines.size(), edges.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    SCOPED_TRACE(i);
    const LineVector& v = spec::geometric::kLineVectors[i / 2];
    const LineRecord& l = lines[i];
    EXPECT_EQ(l.axis, v.axis);
    EXPECT_EQ(l.tie_forward, v.axis == Axis::kHorizontal && v.result.slope > 0);
    const spec::geometric::LineResult got = {l.first, l.count, l.position,
                                             l.slope, l.depth, l.depth_step};
    EXPECT_EQ(differences(v.result, got), "");
    expect_each_value_is_compared(v.result, got);
  }
}

// The page's formulas, with divisions. `kept`: the line has a column of the frame.
LineRecord by_formula(const EdgeEnds& e, int width, int height, bool& kept) {
  using Wide = std::int64_t;
  const VertexFields *a = &e.vertex[0], *b = &e.vertex[1];
  const bool horizontal = std::abs(b->x - a->x) > std::abs(b->y - a->y);
  if (horizontal ? b->x < a->x : b->y < a->y) std::swap(a, b);
  const std::int64_t m0 = horizontal ? a->x : a->y, m1 = horizontal ? b->x : b->y,
                     n0 = horizontal ? a->y : a->x, n1 = horizontal ? b->y : b->x,
                     size = horizontal ? width : height, rows = horizontal ? height : width;
  const auto ceil_centre = [](std::int64_t m) {  // first column with its centre at m or behind
    std::int64_t c = (m - 128) / 256 - 2;
    while (256 * c + 128 < m) ++c;
    return c;
  };
  const std::int64_t first = std::max<std::int64_t>(0, ceil_centre(m0)),
                     last = std::min(size - 1, ceil_centre(m1) - 1);
  kept = first <= last && !(n0 < 0 && n1 < 0) && !(n0 >= 256 * rows && n1 >= 256 * rows);
  LineRecord line;
  line.crease = e.crease;
  if (!kept) return line;
  const std::int64_t length = m1 - m0, dm = std::abs(n1 - n0),
                     dd = std::abs(std::int64_t{b->depth} - std::int64_t{a->depth});
  int exponent = 0;
  while (length >> (exponent + 1)) ++exponent;
  const std::int64_t shift = 22 - exponent;
  const std::int64_t reciprocal = (std::int64_t{1} << 48) / (length << shift);
  const auto slope =
      static_cast<std::int64_t>(((Wide{dm} << shift) * reciprocal + (1 << 23)) >> 24);
  const std::int64_t offset = 256 * first + 128 - m0;
  const auto share = static_cast<std::int64_t>(((Wide{offset} << shift) * (reciprocal >> 2)) >> 22);
  const std::int64_t down = n1 < n0 ? -1 : 1, deep = b->depth < a->depth ? -1 : 1;
  line.axis = horizontal ? Axis::kHorizontal : Axis::kVertical;
  line.tie_forward = horizontal && n1 > n0;
  line.first = static_cast<std::uint16_t>(first);
  line.count = static_cast<std::uint16_t>(last - first + 1);
  line.position = n0 * 65536 + down * ((slope * offset) >> 8) + 128;
  line.slope = static_cast<std::int32_t>(down * slope);
  line.depth =
      (std::int64_t{a->depth} << 12) + deep * static_cast<std::int64_t>((Wide{dd} * share) >> 12);
  line.depth_step =
      exponent >= 8
          ? deep * static_cast<std::int64_t>((Wide{dd} * (reciprocal >> 2)) >> (4 + exponent))
          : 0;
  return line;
}

class Reciprocals : public ::testing::TestWithParam<int> {};

// Ends apart by all powers of two, in a frame with odd sides; a table of n bits.
TEST_P(Reciprocals, RandomLinesByFormula) {
  Parameters p;
  p.pipelined = GetParam() < 0;
  p.reciprocal_table = std::max(0, GetParam());
  p.dividers = 8;
  SetupBench b(p, 1021, 333);
  Random random(static_cast<std::uint64_t>(GetParam() + 100), "lines");
  std::vector<EdgeEnds> edges;
  std::vector<LineRecord> wanted;
  std::uint64_t empty = 0;
  for (int i = 0; i < 20'000; ++i) {
    const auto within = [&](int span) {
      return static_cast<int>(random.below(2u * static_cast<std::uint32_t>(span) + 1)) - span;
    };
    const int span = 1 << random.below(20);
    const VertexFields a = vertex(within(300'000), within(120'000), random.below(1u << 24));
    VertexFields c =
        vertex(std::clamp(a.x + within(span), -(1 << 22), (1 << 22) - 1),
               std::clamp(a.y + within(span), -(1 << 22), (1 << 22) - 1), random.below(1u << 24));
    if (a.x == c.x && a.y == c.y) ++c.x;
    const EdgeEnds e{{a, c}, random.chance(500), false};
    bool kept = false;
    const LineRecord line = by_formula(e, 1021, 333, kept);
    edges.push_back(e);
    if (kept)
      wanted.push_back(line);
    else
      ++empty;
  }
  const std::vector<LineRecord> lines = b.run(edges);
  ASSERT_GT(wanted.size(), 1000u);
  ASSERT_EQ(lines.size(), wanted.size());
  for (std::size_t i = 0; i < lines.size(); ++i)
    ASSERT_EQ(lines[i], wanted[i]) << i << ": " << rtl::payload_difference(wanted[i], lines[i]);
  EXPECT_EQ(b.unit.empty_edges.value(), empty);
  EXPECT_EQ(b.unit.lines.value(), wanted.size());
  if (GetParam() >= 5) {
    EXPECT_GT(b.unit.table_lines.value(), 0u);
  }
}
INSTANTIATE_TEST_SUITE_P(Bits, Reciprocals, ::testing::Values(-1, 0, 1, 5, 10, 11));

TEST(LineSetup, DropsInTheOrderOfThePage) {
  SetupBench b;
  VertexFields gone = vertex(300, 300, 5);
  gone.usable = false;
  const auto lines =
      b.run({{{gone, gone}, false, false},                                         // outside
             {{vertex(300, 300, 5), gone}, false, false},                          // outside
             {{vertex(300, 300, 5), vertex(300, 300, 9)}, false, false},           // degenerate
             {{vertex(300, 300, 5), vertex(301, 300, 9)}, false, false},           // empty
             {{vertex(128, -1, 5), vertex(999, -200, 9)}, false, false},           // before
             {{vertex(128, 720 * 256, 5), vertex(999, 190000, 9)}, false, false},  // behind
             {{vertex(128, 720 * 256 - 1, 5), vertex(999, 184400, 9)}, false, false},
             {{vertex(128, -1, 5), vertex(999, 0, 9)}, false, false},
             {{vertex(-300, -300, 5), vertex(128, 200, 9)}, false, false}});
  EXPECT_EQ(lines.size(), 3u);
  EXPECT_EQ(b.unit.outside_edges.value(), 2u);
  EXPECT_EQ(b.unit.degenerate_edges.value(), 1u);
  EXPECT_EQ(b.unit.empty_edges.value(), 3u);
  EXPECT_EQ(b.unit.lines.value(), 3u);
}

EdgeEnds some_line(int length = 5000) {
  return edge(true, {1000, 1000, 1}, {1000 + length, 2000, 7});
}

TEST(LineSetup, LatencyOfTheDatasheet) {
  Parameters p;
  for (const bool pipelined : {true, false}) {
    p.pipelined = pipelined;
    const std::string got = in_child([&] {
      SetupBench b(p);
      return b.latency(b.ends, some_line());
    });
    expect_latency_of(rtl::geometric::LineSetup::datasheet(p), got);
  }
}

// Cycles between the first and the last of so many lines.
std::string spread(const Parameters& p, const std::vector<EdgeEnds>& edges) {
  return in_child([&] {
    SetupBench b(p);
    b.run(edges);
    const auto& taken = b.ends.sink.taken;
    return std::to_string(taken[taken.size() - 2].cycle - taken.front().cycle);
  });
}

// So many intervals of the datasheet.
std::string after(std::uint64_t lines, const Parameters& p) {
  return std::to_string(lines * rtl::geometric::LineSetup::datasheet(p).interval.cycles);
}

TEST(LineSetup, IntervalIsOneIfPipelined) {
  EXPECT_EQ(spread({}, std::vector<EdgeEnds>(101, some_line())), after(100, {}));
}
TEST(LineSetup, IntervalIsThirteenADivider) {
  Parameters p;
  p.pipelined = false;
  const std::string ten_lines = after(10, p);
  for (const int dividers : {1, 2, 3, 8}) {
    p.dividers = dividers;
    const auto lines = static_cast<std::size_t>(10 * dividers + 1);
    EXPECT_EQ(spread(p, std::vector<EdgeEnds>(lines, some_line())), ten_lines) << dividers;
  }
}
TEST(LineSetup, LinesOfTheTableWaitForNoDivider) {
  Parameters p;
  p.pipelined = false;
  p.reciprocal_table = 10;
  EXPECT_EQ(spread(p, std::vector<EdgeEnds>(101, some_line(1023))), "100");
  EXPECT_EQ(spread(p, std::vector<EdgeEnds>(11, some_line(1024))), "130");
}
// Of every length that a table has, a 256th of a pixel too: none of them takes a divider, which is
// busy with the line before them.
TEST(LineSetup, NoLengthOfATableWaitsForADivider) {
  Parameters p;
  p.pipelined = false;
  for (int bits = 1; bits <= spec::geometric::kMaxReciprocalBits; ++bits) {
    p.reciprocal_table = bits;
    const int lengths = (1 << bits) - 1;
    const std::string got = in_child([&] {
      SetupBench b(p);
      std::vector<EdgeEnds> edges = {some_line()};
      // From the centre of a pixel on, so that each has a column.
      for (int length = 1; length <= lengths; ++length)
        edges.push_back(edge(true, {128, 1000, 1}, {128 + length, 1000, 7}));
      b.run(edges);
      const auto& taken = b.ends.sink.taken;
      return std::to_string(taken[taken.size() - 2].cycle - taken.front().cycle) + " cycles, " +
             std::to_string(b.unit.table_lines.value()) + " by the table, divider " +
             std::to_string(b.unit.divider_cycles.value());
    });
    EXPECT_EQ(got, std::to_string(lengths) + " cycles, " + std::to_string(lengths) +
                       " by the table, divider 13")
        << bits;
  }
}
TEST(LineSetup, ADroppedEdgeTakesAClock) {
  std::vector<EdgeEnds> edges(100, some_line());
  for (std::size_t i = 1; i < 99; i += 2) edges[i].vertex[0].usable = false;
  EXPECT_EQ(spread({}, edges), "99");
}

}  // namespace
}  // namespace deburr::tb::geometric_rtl::line_setup_test
