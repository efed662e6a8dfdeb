// SPDX-License-Identifier: MIT
// Reset of the geometric engine at every clock of a frame: what comes after it is, to the bit and
// to the clock, what comes after a reset of an engine that never had a frame; every register and
// every counter of every unit included.
#include <nlohmann/json.hpp>

#include "tb/harness/statistics.h"
#include "tb/unit/rtl/geometric/support.h"

namespace deburr::tb::geometric_rtl::reset_test {
namespace {

using spec::geometric::CacheLines;

// The contract's scene, cut to a small frame.
Scene small_scene(int width, int height, std::size_t edges) {
  Scene scene = contract_scene();
  scene.edges.resize(edges);
  Scene cut = scene;
  cut.width = width;
  cut.height = height;
  cut.colours.clear();
  cut.depths.clear();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto at = static_cast<std::size_t>(y * scene.width + x);
      cut.colours.push_back(scene.colours[at]);
      cut.depths.push_back(scene.depths[at]);
    }
  return cut;
}

struct Trail {
  std::vector<spec::geometric::LineRecord> lines;
  std::vector<spec::geometric::Candidate> candidates;
  std::vector<spec::geometric::BlockRecord> blocks;
  std::vector<std::uint64_t> reads, writes;
  std::uint64_t pixels = 0;
  std::string statistics, registers;
};

class EveryClock : public ::testing::TestWithParam<char> {
 protected:
  static Parameters parameters() {
    Parameters p = configuration(GetParam()).p;
    p.depth_lines = p.weight_blocks = p.vertex_lines = CacheLines::k16;
    p.fills = 8;
    p.latency_fifo = 12;
    p.line_fifo = 4;
    return p;
  }
};

std::string registers_of(EngineBench& b) {
  std::string text;
  for (const spec::RegisterInfo& info : spec::geometric::kRegisters)
    text += std::string(info.name) + "=" + std::to_string(b.bus.read(info.offset)) + " ";
  return text;
}

TEST_P(EveryClock, OfAFrameMayBeTheLast) {
  EngineBench b(parameters());
  const Scene broken = small_scene(41, 37, 60), whole = small_scene(37, 26, 30);
  b.reset();
  const std::string at_reset = registers_of(b);
  const auto finish = [&] {
    b.load(whole);
    b.run(20'000);
    return Trail{b.lines,
                 b.candidates,
                 b.blocks,
                 b.memory.lines_read(),
                 b.memory.lines_written(),
                 b.pixel_hash(),
                 statistics(b.clock).dump(),
                 registers_of(b)};
  };
  const Trail fresh = finish();
  ASSERT_GT(fresh.blocks.size(), 10u);
  ASSERT_GT(b.writes(b.bases.weights).size(), 5u);
  b.reset();
  b.load(broken);
  const Cycle last = b.run(20'000);
  ASSERT_GT(last, 500u);
  for (Cycle at = 1; at < last; at += 3) {
    SCOPED_TRACE("reset " + std::to_string(at) + " clocks into a frame");
    b.reset();
    b.load(broken);
    b.start();
    b.clock.run(at);
    ASSERT_FALSE(b.engine.idle());
    b.reset(40);  // what memory still owes has come by then
    ASSERT_EQ(registers_of(b), at_reset);
    ASSERT_TRUE(b.engine.idle());
    const Trail after = finish();
    ASSERT_EQ(after.lines, fresh.lines);
    ASSERT_EQ(after.candidates, fresh.candidates);
    ASSERT_EQ(after.blocks, fresh.blocks);
    ASSERT_EQ(after.reads, fresh.reads);
    ASSERT_EQ(after.writes, fresh.writes);
    ASSERT_EQ(after.pixels, fresh.pixels);
    ASSERT_EQ(after.registers, fresh.registers);
    ASSERT_EQ(after.statistics, fresh.statistics);
  }
}
INSTANTIATE_TEST_SUITE_P(Configurations, EveryClock, ::testing::Values('c', 'e', 'h'));

}  // namespace
}  // namespace deburr::tb::geometric_rtl::reset_test
