// SPDX-License-Identifier: MIT
// LineSetup: lines against the golden model with every kind of reciprocal; latency and intervals.
#include "rtl_model/geometric/lines/line_setup.h"

#include "golden/geometric/line.h"
#include "tb/base/random.h"
#include "tb/unit/rtl/geometric/parts.h"

namespace deburr::tb::geometric_rtl::line_setup_test {
namespace {

using rtl::geometric::EdgeEnds;
using rtl::geometric::LineToken;
using rtl::geometric::VertexFields;
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
// Major and minor coordinate and depth of both ends.
EdgeEnds edge(bool horizontal, std::array<int, 3> a, std::array<int, 3> b) {
  const auto make = [&](const std::array<int, 3>& e) {
    return vertex(horizontal ? e[0] : e[1], horizontal ? e[1] : e[0],
                  static_cast<std::uint32_t>(e[2]));
  };
  return {{make(a), make(b)}, false, false};
}

class Reciprocals : public ::testing::TestWithParam<int> {};

// Distances between the ends of all powers of two, in a frame with odd sides, with a table of n
// bits. Also ends on borders of the frame, on pixel centres, at the same position, and outside the
// guard band.
TEST_P(Reciprocals, LinesMatchGolden) {
  using golden::geometric::LineFate;
  constexpr int kWidth = 1021, kHeight = 333;
  Parameters p;
  p.pipelined = GetParam() < 0;
  p.reciprocal_table = std::max(0, GetParam());
  p.dividers = 8;
  SetupBench b(p, kWidth, kHeight);
  Random random(static_cast<std::uint64_t>(GetParam() + 100), "lines");
  std::vector<EdgeEnds> edges;
  std::vector<LineRecord> wanted;
  std::uint64_t outside = 0, degenerate = 0, empty = 0;
  const auto add = [&](const VertexFields& a, const VertexFields& c) {
    const EdgeEnds e{{a, c}, random.chance(500), false};
    const auto end = [](const VertexFields& v) {
      return spec::geometric::Vertex{v.x, v.y, v.depth, v.usable};
    };
    LineRecord line;
    line.crease = e.crease;
    edges.push_back(e);
    switch (golden::geometric::set_up_line(end(a), end(c), kWidth, kHeight, line)) {
      case LineFate::kLine:
        wanted.push_back(line);
        break;
      case LineFate::kOutside:
        ++outside;
        break;
      case LineFate::kDegenerate:
        ++degenerate;
        break;
      default:
        ++empty;
    }
  };
  for (int i = 0; i < 20'000; ++i) {
    const auto within = [&](int span) { return random.between(-span, span); };
    const int span = 1 << random.below(20);
    const VertexFields a = vertex(within(300'000), within(120'000), random.below(1u << 24));
    add(a,
        vertex(std::clamp(a.x + within(span), -(1 << 22), (1 << 22) - 1),
               std::clamp(a.y + within(span), -(1 << 22), (1 << 22) - 1), random.below(1u << 24)));
  }
  const auto place = [&](int size) {
    constexpr std::array kPlaces = {-1, 0, 127, 128, 129, 384};
    const int at = kPlaces[random.below(kPlaces.size())];
    return random.chance(300) ? 256 * size + at - 384 : at;
  };
  for (int i = 0; i < 2'000; ++i) {
    VertexFields a = vertex(place(kWidth), place(kHeight), 5),
                 c = vertex(place(kWidth), place(kHeight), 9);
    a.usable = !random.chance(50);
    c.usable = !random.chance(50);
    add(a, c);
  }
  const std::vector<LineRecord> lines = b.run(edges);
  ASSERT_EQ(lines.size(), wanted.size());
  for (std::size_t i = 0; i < lines.size(); ++i)
    ASSERT_EQ(lines[i], wanted[i]) << i << ": " << rtl::payload_difference(wanted[i], lines[i]);
  EXPECT_EQ(b.unit.outside_edges.value(), outside);
  EXPECT_EQ(b.unit.degenerate_edges.value(), degenerate);
  EXPECT_EQ(b.unit.empty_edges.value(), empty);
  EXPECT_EQ(b.unit.lines.value(), wanted.size());
  for (const std::uint64_t edges_of_a_fate : {outside, degenerate, empty, wanted.size()})
    EXPECT_GT(edges_of_a_fate, 20u);
  if (GetParam() >= 5) {
    EXPECT_GT(b.unit.table_lines.value(), 0u);
  }
}
INSTANTIATE_TEST_SUITE_P(Bits, Reciprocals, ::testing::Values(-1, 0, 1, 5, 10, 11));

EdgeEnds some_line(int length = 5000) {
  return edge(true, {1000, 1000, 1}, {1000 + length, 2000, 7});
}

TEST(LineSetup, LatencyMatchesDatasheet) {
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

// Cycles between the first and the last line.
std::string spread(const Parameters& p, const std::vector<EdgeEnds>& edges) {
  return in_child([&] {
    SetupBench b(p);
    b.run(edges);
    const auto& taken = b.ends.sink.taken;
    return std::to_string(taken[taken.size() - 2].cycle - taken.front().cycle);
  });
}

// Cycles of this number of intervals of the datasheet.
std::string after(std::uint64_t lines, const Parameters& p) {
  return std::to_string(lines * rtl::geometric::LineSetup::datasheet(p).interval.cycles);
}

TEST(LineSetup, IntervalIsOneIfPipelined) {
  EXPECT_EQ(spread({}, std::vector<EdgeEnds>(101, some_line())), after(100, {}));
}
TEST(LineSetup, IntervalIsThirteenPerDivider) {
  Parameters p;
  p.pipelined = false;
  const std::string ten_lines = after(10, p);
  for (const int dividers : {1, 2, 3, 8}) {
    p.dividers = dividers;
    const auto lines = static_cast<std::size_t>(10 * dividers + 1);
    EXPECT_EQ(spread(p, std::vector<EdgeEnds>(lines, some_line())), ten_lines) << dividers;
  }
}
TEST(LineSetup, TableLinesDoNotWaitForADivider) {
  Parameters p;
  p.pipelined = false;
  p.reciprocal_table = 10;
  EXPECT_EQ(spread(p, std::vector<EdgeEnds>(101, some_line(1023))), "100");
  EXPECT_EQ(spread(p, std::vector<EdgeEnds>(11, some_line(1024))), "130");
}
// All lengths of a table, also those of 1/256 pixel: none of them uses a divider, which is busy
// with the line before them.
TEST(LineSetup, EveryTableLengthAvoidsTheDivider) {
  Parameters p;
  p.pipelined = false;
  for (int bits = 1; bits <= spec::geometric::kMaxReciprocalBits; ++bits) {
    p.reciprocal_table = bits;
    const int lengths = (1 << bits) - 1;
    const std::string got = in_child([&] {
      SetupBench b(p);
      std::vector<EdgeEnds> edges = {some_line()};
      // Starting at the centre of a pixel, so that each line has a column.
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
TEST(LineSetup, DroppedEdgeTakesOneCycle) {
  std::vector<EdgeEnds> edges(100, some_line());
  for (std::size_t i = 1; i < 99; i += 2) edges[i].vertex[0].usable = false;
  EXPECT_EQ(spread({}, edges), "99");
}

}  // namespace
}  // namespace deburr::tb::geometric_rtl::line_setup_test
