// SPDX-License-Identifier: MIT
// Units of the resolve, and those that feed the edge pipeline: latency and initiation interval by
// docs/reference/geometric/hardware.md. Memory responds 20 cycles after a request.
#include <map>

#include "rtl_model/geometric/common/sizing.h"
#include "rtl_model/geometric/edges/edge_reader.h"
#include "rtl_model/geometric/edges/facing_store.h"
#include "rtl_model/geometric/resolve/frame_copier.h"
#include "tb/unit/rtl/geometric/parts.h"
#include "tb/unit/rtl/geometric/resolve_bench.h"

namespace deburr::tb::geometric_rtl::resolve_test {
namespace {

using namespace rtl::geometric;  // NOLINT: names of units and tokens
using spec::geometric::CacheLines;
using spec::geometric::Layout;

TEST(Resolve, BlockLatenciesMatchDatasheets) {
  ResolveBench b;
  b.touch(0, 0, 1u << 5);
  b.run();
  // The scanner's latency counts from the first cycle of the phase.
  expect_latency(BlockScanner::datasheet(), b.at["touched"][0] + 1 - b.resolve_from);
  expect_latency(BlockFetch::datasheet(), b.at["blocks"][0] + 1 - b.at["fetched"][0]);
  // Its line arrives M + 6 cycles after its request, like that of a cache: arbiter, port, M, port,
  // arbiter, entry, register.
  EXPECT_EQ(b.at["reads"][0], b.at["blocks"][0]);
  expect_latency(Resolver::datasheet(), b.at["writes"][0] - b.at["reads"][0] - 27 + 1);
  EXPECT_EQ(b.resolved.size(), 1u);
}
TEST(Resolve, WordTakesOneCyclePerBlock) {
  ResolveBench b({}, 2048, 64);  // four words per row, 64 in total
  b.touch(0, 0, 1);
  b.touch(3, 0, 1);
  b.touch(127, 0, 1);
  b.touch(128, 0, 1);
  b.touch(511, 15, 1);
  b.run();
  std::vector<Cycle> cycles;
  for (const Cycle c : b.at["touched"]) cycles.push_back(c - b.at["touched"][0]);
  // The end follows the last block of the last word.
  EXPECT_THAT(cycles, testing::ElementsAre(0, 1, 2, 3, 65, 66));
  EXPECT_THAT(b.resolved, testing::SizeIs(5));
  EXPECT_EQ(b.resolved[4].x, 511);
  EXPECT_EQ(b.resolved[4].y, 15);
}

// Another initiator overwrites blocks in memory during a frame. A pixel must still take at most one
// half from each neighbour, only from within the frame, and no address outside the regions is
// accessed.
TEST(Resolve, CorruptedWeightsStayWithinLimits) {
  for (const Layout layout : {Layout::kTiled, Layout::kRaster})
    for (const auto& [width, height, last_first] : {std::tuple{66, 6, false},
                                                    {66, 6, true},
                                                    {67, 9, true},
                                                    {128, 8, false},
                                                    {128, 8, true},
                                                    {65, 5, true}}) {
      const std::string got = in_child([layout, width = width, height = height,
                                        last_first = last_first] {
        constexpr std::uint32_t kColours = 0x40000, kWeights = 0x80000;
        Parameters p;
        p.layout = layout;
        p.weight_blocks = CacheLines::k16;
        ResolveBench b(p, width, height);
        const int across = (width + 3) / 4, down = (height + 3) / 4;
        // The first blocks go to memory; the last ones stay in the cache.
        for (int y = 0; y < down; ++y)
          for (int x = 0; x < across; ++x) b.touch(last_first ? across - 1 - x : x, y, 1u << 5);
        const std::vector<std::uint8_t> noise(static_cast<std::size_t>(64 * across * down), 0xFF);
        b.before_resolve = [&] {
          b.memory.clear_statistics();
          b.memory.preload(kWeights, noise);
        };
        b.run();
        const std::uint32_t bytes =
            layout == Layout::kTiled
                ? static_cast<std::uint32_t>(256 * ((width + 7) / 8) * ((height + 7) / 8))
                : static_cast<std::uint32_t>(64 * ((width + 15) / 16) * height);
        std::string wrong;
        for (const auto* lines : {&b.memory.lines_read(), &b.memory.lines_written()})
          for (const std::uint64_t address : *lines) {
            const bool colours = address >= kColours && address < kColours + bytes,
                       weights = address >= kWeights && address < kWeights + noise.size();
            if (!colours && !(weights && lines == &b.memory.lines_read())) wrong += "address ";
          }
        std::size_t from_memory = 0;
        for (const auto& block : b.resolved) {
          // Skips blocks that were in the cache; the pixel itself may lie outside the frame.
          if ((block.blended & ~(1u << 5)) == 0) continue;
          ++from_memory;
          for (int i = 0; i < 16; ++i) {
            const int x = 4 * block.x + i % 4, y = 4 * block.y + i / 4;
            const bool inside = x < width && y < height;
            const auto most = [&](bool neighbour) {
              return static_cast<std::uint8_t>(inside && neighbour ? 128 : 0);
            };
            const spec::geometric::Weights wanted = {most(y > 0), most(y + 1 < height), most(x > 0),
                                                     most(x + 1 < width)};
            if (block.weights[static_cast<std::size_t>(i)] != wanted) wrong += "weights ";
            if ((block.blended >> i & 1) != inside) wrong += "blended ";
          }
        }
        if (from_memory < 8) wrong += "all of them were in the cache";
        return wrong;
      });
      EXPECT_EQ(got, "") << width << " " << last_first;
    }
}

TEST(Resolve, WeightsFromMemoryAddItsLatency) {
  Parameters p;
  p.weight_blocks = CacheLines::k16;
  ResolveBench b(p);
  b.touch(0, 0, 1u << 5);
  b.touch(4, 0, 1u << 5);  // replaces it
  b.run();
  EXPECT_EQ(b.fetch.weights_read.value(), 1u);
  // Stage 2 requests, then arbiter, port, M + 1, port, arbiter, entry; then stages 3 to 5.
  expect_latency(BlockFetch::datasheet(), b.at["blocks"][0] + 1 - b.at["fetched"][0] - (20 + 6));
}

// Average cycles per block: max(lines, beats, lines to write) in the Resolver, and lines + lines to
// write at the port. The first reads come before the first write.
Cycle per_block(const Parameters& p, std::uint16_t pixels, bool vertical) {
  constexpr int kBlocks = 160;
  ResolveBench b(p, 256, 128);
  for (int i = 0; i < kBlocks; ++i) b.touch(1 + i % 16 * 2, 1 + i / 16 * 2, pixels, vertical);
  b.run();
  EXPECT_EQ(b.fetch.weights_read.value(), 0u);
  const auto& writes = b.at["writes"];
  return (writes.back() - writes.front() + kBlocks / 2) / kBlocks;
}
TEST(Resolve, BlockIntervalMatchesThePage) {
  using spec::geometric::Lanes;
  const auto interval_of = [](Layout layout, std::uint16_t pixels, bool vertical,
                              Lanes lanes = Lanes::kTwo) {
    return in_child([&] {
      Parameters p;
      p.layout = layout;
      p.resolve_lanes = lanes;
      p.weight_blocks = CacheLines::k1024;
      return std::to_string(per_block(p, pixels, vertical));
    });
  };
  // Two pixels inside: one line, one write, one beat; the port takes two cycles.
  EXPECT_EQ(interval_of(Layout::kTiled, 0x0060, false), "2");
  // The upper row takes from the block above: two lines, two beats, one write.
  EXPECT_EQ(interval_of(Layout::kTiled, 0x000F, false), "3");
  // All pixels: eight beats.
  EXPECT_EQ(interval_of(Layout::kTiled, 0xFFFF, false), "8");
  EXPECT_EQ(interval_of(Layout::kTiled, 0xFFFF, false, Lanes::kOne), "16");
  EXPECT_EQ(interval_of(Layout::kTiled, 0xFFFF, false, Lanes::kFour), "4");
  EXPECT_EQ(interval_of(Layout::kTiled, 0x1FFF, false, Lanes::kFour), "4");
  EXPECT_EQ(interval_of(Layout::kTiled, 0x0FFF, false, Lanes::kFour), "3");
  // Raster: four rows and the one above, four writes.
  EXPECT_EQ(interval_of(Layout::kRaster, 0x1111, false), "9");
  EXPECT_EQ(interval_of(Layout::kRaster, 0x2222, true), "8");
}

// The Resolver's busy cycles per block do not depend on the memory latency. All other cycles wait
// for lines.
TEST(Resolve, WaitingIsNotBusy) {
  using spec::geometric::Lanes;
  struct Blocks {
    std::uint16_t pixels;
    Lanes lanes;
    std::uint64_t each;  // max(lines, beats)
  };
  for (const Blocks& block : {Blocks{0x0060, Lanes::kTwo, 1},
                              {0x000F, Lanes::kFour, 2},
                              {0x000F, Lanes::kTwo, 2},
                              {0xFFFF, Lanes::kTwo, 8}})
    for (const std::uint32_t latency : {5u, 20u, 200u}) {
      const std::string got = in_child([&] {
        constexpr int kBlocks = 40;
        Parameters p;
        p.resolve_lanes = block.lanes;
        p.resolve_lines = 16;
        p.weight_blocks = CacheLines::k1024;
        ResolveBench b(p, 256, 128, latency);
        for (int i = 0; i < kBlocks; ++i) b.touch(1 + i % 16 * 2, 1 + i / 16 * 2, block.pixels);
        b.run();
        // The end of the frame is loaded as well.
        const std::uint64_t busy = b.resolver.busy_cycles(), all = kBlocks * block.each + 1;
        const std::uint64_t waits = stalls(b.resolver, "colours");
        std::string wrong;
        if (busy > all + all / 10 || busy + all / 10 < all)
          wrong = "busy " + std::to_string(busy) + " of " + std::to_string(all);
        // Eight lines in M + 8 cycles, at `each` lines per block.
        const std::uint64_t lines = b.fetch.lines_read.value();
        const std::uint64_t least = lines * (latency + 6) / 8;
        if (latency == 200 && waits + busy + 300 < least)
          wrong += " waits " + std::to_string(waits) + " of " + std::to_string(least);
        return wrong;
      });
      EXPECT_EQ(got, "") << block.pixels << ", latency " << latency;
    }
}

// ---- FacingStore and EdgeReader, at the start of a frame

struct ReaderBench : Frame {
  explicit ReaderBench(const Parameters& p, std::uint32_t edges, std::uint32_t faces)
      : Frame(p),
        facing("facing", clock, p),
        reader("reader", clock, p, edge_latency),
        beats("beats"),
        taker("taker", clock) {
    arbiter.connect(Client::kFacing, facing.memory);
    arbiter.connect(Client::kEdges, reader.memory);
    for (std::uint32_t lane = 0;
         lane < 2u * spec::geometric::kLaneCount[static_cast<std::size_t>(p.edge_lanes)]; ++lane)
      ports.emplace_back(facing.words, "test");
    reader.edges_out(beats);
    taker.in(beats);
    facing.configuration_in(configuration);
    reader.configuration_in(configuration);
    facing.phase_in(phase);
    reader.phase_in(phase);
    wire(facing.loaded_out, &sequencer.facing_loaded_in);
    bus.write(reg::kEdgeCount, edges);
    bus.write(reg::kFaceCount, faces);
    bus.write(reg::kFaceBase, 0x40000);
    from = clock.cycle();
    begin(64, 64);
  }
  std::vector<rtl::ReadPort<std::uint32_t>> ports;
  FacingStore facing;
  EdgeReader reader;
  rtl::Link<EdgeBeat> beats;
  unit_bench::Sink<EdgeBeat> taker;
  Cycle from;
};
TEST(EdgeReader, OneBeatOfEdgesPerCycle) {
  for (int code = 0; code < 3; ++code) {
    const std::string got = in_child([code] {
      Parameters p;
      p.edge_lanes = static_cast<spec::geometric::Lanes>(code);
      const std::uint32_t lanes = spec::geometric::kLaneCount[static_cast<std::size_t>(code)];
      ReaderBench b(p, 403, 1);
      b.clock.run(1000);
      std::uint32_t edges = 0;
      for (const auto& taken : b.taker.taken) edges += taken.token.count;
      const Cycle cycles = b.taker.taken.back().cycle - b.taker.taken.front().cycle;
      return std::to_string(edges) + " " + std::to_string(cycles - (403 + lanes - 1) / lanes);
    });
    EXPECT_EQ(got, "403 0") << code;
  }
}
// Ten records per line, and no beat crosses the end of a line: the last line holds 3 of 403.
TEST(EdgeReader, SplitRecordBeatsEndWithTheirLine) {
  const std::vector<std::pair<int, std::string>> rows = {
      {0, "1111111111 111 41 +403"}, {1, "22222 21 41 +202"}, {2, "442 3 41 +121"}};
  for (const auto& [code, wanted] : rows) {
    const std::string got = in_child([code = code] {
      Parameters p;
      p.records = spec::geometric::RecordsLayout::kSplit;
      p.edge_lanes = static_cast<spec::geometric::Lanes>(code);
      ReaderBench b(p, 403, 1);
      b.clock.run(1000);
      std::string first, last;
      std::uint32_t edges = 0;
      for (const auto& taken : b.taker.taken) {
        if (edges < 10) first += std::to_string(taken.token.count);
        if (edges >= 400 && !taken.token.end) last += std::to_string(taken.token.count);
        edges += taken.token.count;
      }
      std::vector<std::uint64_t> lines;
      for (std::uint64_t line = 0; line < 41; ++line) lines.push_back(64 * line);
      std::vector<std::uint64_t> read = b.memory.lines_read();
      std::erase_if(read, [](std::uint64_t line) { return line >= 0x40000; });
      EXPECT_EQ(read, lines);
      return first + " " + last + " " + std::to_string(b.reader.lines_read.value()) + " +" +
             std::to_string(b.taker.taken.back().cycle - b.taker.taken.front().cycle);
    });
    EXPECT_EQ(got, wanted) << code;
  }
}
// Every bit: f0 in 20..0, f1 in 41..21, flags in 45..42; bits 47 and 46 and bytes 60 to 63 are
// ignored.
TEST(EdgeReader, SplitRecordsAreReadBitByBit) {
  Parameters p;
  p.records = spec::geometric::RecordsLayout::kSplit;
  p.edge_lanes = spec::geometric::Lanes::kOne;
  Frame b(p);
  EdgeReader reader("reader", b.clock, p, b.edge_latency);
  rtl::Link<EdgeBeat> beats("beats");
  unit_bench::Sink<EdgeBeat> taker("taker", b.clock);
  b.arbiter.connect(Client::kEdges, reader.memory);
  reader.edges_out(beats);
  taker.in(beats);
  reader.configuration_in(b.configuration);
  reader.phase_in(b.phase);
  std::vector<std::uint8_t> bytes(320, 0xFF);
  for (std::size_t n = 0; n < 50; ++n) {
    const std::uint64_t record = n < 48 ? std::uint64_t{1} << n : n == 48 ? 0 : ~std::uint64_t{0};
    for (std::size_t i = 0; i < 6; ++i)
      bytes[n / 10 * 64 + n % 10 * 6 + i] = static_cast<std::uint8_t>(record >> 8 * i);
  }
  b.memory.preload(0, bytes);
  b.bus.write(reg::kEdgeCount, 50);
  b.begin(64, 64);
  b.clock.run(300);
  ASSERT_EQ(taker.taken.size(), 51u);
  for (std::size_t n = 0; n < 50; ++n) {
    const EdgeFields& edge = taker.taken[n].token.edge[0];
    const bool all = n == 49;
    EXPECT_EQ(edge.f0, all ? 0x1FFFFFu : n < 21 ? 1u << n : 0u) << n;
    EXPECT_EQ(edge.f1, all ? 0x1FFFFFu : n >= 21 && n < 42 ? 1u << (n - 21) : 0u) << n;
    EXPECT_EQ(edge.flags, all ? 15u : n >= 42 && n < 46 ? 1u << (n - 42) : 0u) << n;
  }
  EXPECT_TRUE(taker.taken[50].token.end);
}
// The first line arrives long after the begin phase: its response is taken, written and read.
TEST(EdgeReader, LatencyFromResponseMatchesDatasheet) {
  ReaderBench b({}, 4, 0);
  Cycle answered = 0;
  while (b.taker.taken.empty()) {
    b.clock.run(1);
    rtl::for_each<rtl::LinkBase>(b.arbiter, [&](rtl::LinkBase& link) {
      if (std::string(link.basename()) == "edges_responses" && link.pops() == 1 && answered == 0)
        answered = b.clock.cycle() - 1;
    });
  }
  expect_latency(EdgeReader::datasheet(), b.taker.taken[0].cycle - answered - 1);
}

// ---- FrameCopier
Cycle copy_cycles(std::int32_t copy_lines, std::uint32_t latency, int width, int height) {
  Parameters p;
  p.frame_copy = true;
  p.copy_lines = copy_lines;
  const rtl::MemoryCycles memory{static_cast<std::int32_t>(latency), 1};
  Frame b(p, latency);
  FrameCopier copier("copier", b.clock, rtl::geometric::sized(p, memory));
  b.arbiter.connect(Client::kCopy, copier.memory);
  copier.configuration_in(b.configuration);
  copier.phase_in(b.phase);
  const rtl::Wire<bool>& copied = b.wire(copier.copied_out);
  b.bus.write(reg::kCopyBase, 0x40000);
  b.begin(width, height);
  const Cycle from = b.clock.cycle();
  b.clock.run_until([&] { return copied.read(b.clock.cycle()); }, 100'000);
  return b.clock.cycle() - from;
}
// Cycles for 512 more lines of a copy that is already running.
Cycle copy_cycles_of_512(std::int32_t copy_lines, std::uint32_t latency) {
  const Cycle few = forked<Cycle>([&] { return copy_cycles(copy_lines, latency, 64, 64); }),
              many = forked<Cycle>([&] { return copy_cycles(copy_lines, latency, 64, 192); });
  return many - few;
}
TEST(FrameCopier, TwoCyclesPerLineUnlessBufferIsTooSmall) {
  const Cycle at_best = 512 * FrameCopier::datasheet().interval.cycles;
  EXPECT_EQ(copy_cycles_of_512(16, 4), at_best);
  EXPECT_EQ(copy_cycles_of_512(16, 24), at_best);
  // Sixteen lines in M + 8 cycles.
  EXPECT_EQ(copy_cycles_of_512(16, 25), 512u * 33 / 16);
  EXPECT_EQ(copy_cycles_of_512(16, 40), 512u * 48 / 16);
}
// The default is the smallest size at full speed: one line fewer costs cycles.
TEST(FrameCopier, DefaultCoversTheLatency) {
  for (const std::uint32_t latency : {4u, 20u, 60u, 100u}) {
    const std::int32_t lines =
        rtl::geometric::sized({}, {static_cast<std::int32_t>(latency), 1}).copy_lines;
    EXPECT_EQ(lines, (static_cast<std::int32_t>(latency) + 9) / 2);
    EXPECT_EQ(copy_cycles_of_512(0, latency), 1024u) << latency;
    EXPECT_GT(copy_cycles_of_512(lines - 1, latency), 1024u) << latency;
  }
}

TEST(FacingStore, OneLinePerCycle) {
  for (const std::uint32_t faces : {512u, 512u * 33}) {
    const std::string got = in_child([faces] {
      ReaderBench b({}, 0, faces);
      EXPECT_EQ(b.facing.lines_read.value(), faces / 512);
      std::vector<std::uint64_t> wanted;
      for (std::uint32_t i = 0; i < faces / 512; ++i) wanted.push_back(0x40000 + 64 * i);
      EXPECT_EQ(b.memory.lines_read(), wanted);
      return std::to_string(b.facing.busy_cycles() + b.facing.stalled_cycles() - faces / 512);
    });
    EXPECT_EQ(got, "25") << faces;
  }
}

}  // namespace
}  // namespace deburr::tb::geometric_rtl::resolve_test
