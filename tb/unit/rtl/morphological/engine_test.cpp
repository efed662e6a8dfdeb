// SPDX-License-Identifier: MIT
// The whole morphological engine: slot numbers, cycle classes of its units, memories of its builds.
#include <map>
#include <string>
#include <vector>

#include "tb/unit/rtl/morphological/support.h"

namespace deburr::tb::morphological_rtl::engine_test {
namespace {

using spec::morphological::Preset;

// Descriptors carry fifteen bits of the slot number: exactly two rows of 8192 beats.
TEST(SlotNumbers, SlotNumbersWrapInTheWidestRows) {
  constexpr int kWidth = spec::morphological::kMaxFrameSize, kPart = 90, kHeight = 12;
  Parameters p = preset(Preset::kDeburrLine, 9);
  p.steps = 7;
  p.line_pixels = kWidth;
  EngineBench bench(p);
  const Frame pattern = noise(kPart, kHeight);
  // The same pixels at both ends of a row, so that descriptors are found in its first and last
  // slots.
  const Frame in = draw(kWidth, kHeight, [&](int x, int y) {
    return x < kPart             ? pattern.at(x, y)
           : x >= kWidth - kPart ? pattern.at(x - (kWidth - kPart), y)
                                 : grey(0);
  });
  const Frame out = bench.run(in);
  EXPECT_EQ(bench.engine.area.descriptors.value(), bench.engine.extractor.descriptors_sent.value());
  EXPECT_GT(bench.engine.area.descriptors.value(), 400u);
  EXPECT_EQ(bench.engine.extractor.descriptor_stalls.value(), 0u);
  int blended = 0;
  // Extensions cover at most seven steps of a few pixels, so the middle of a part does not see its
  // border.
  for (int y = 0; y < kHeight; ++y)
    for (int x = 40; x < 50; ++x) {
      ASSERT_EQ(out.at(x, y), out.at(x + kWidth - kPart, y)) << x << ' ' << y;
      blended += out.at(x, y) != in.at(x, y);
    }
  EXPECT_GT(blended, 20);
}

TEST(CycleClasses, EveryCycleIsBusyStalledOrIdle) {
  EngineBench bench(deburr_line());
  bench.run(blocks());
  for (const rtl::Unit* unit : bench.engine.units())
    EXPECT_EQ(unit->busy_cycles() + unit->stalled_cycles() + unit->idle_cycles(),
              bench.clock.cycle());
  // Every slot is one busy cycle of the pipeline.
  EXPECT_EQ(bench.engine.sequencer.busy_cycles(), (80u + 37u) * 90u);
  EXPECT_EQ(bench.engine.blender.busy_cycles(), 80u * 90u + 5u);
  EXPECT_EQ(bench.engine.beat_latency.count(), 80u * 90u);
}

// ---- memories, for rows of 1920 pixels; the page lists those of another build -------------------

struct Sized {
  const char* memory;
  std::uint64_t bits;
  const char* ports = "";  // empty: any
};
void expect_memories(Parameters p, const std::vector<Sized>& rows) {
  p.line_pixels = 1920;
  const EngineBench bench(p);
  std::map<std::string, const rtl::MemoryBase*> all;
  for (const rtl::MemoryBase* memory : bench.engine.memories()) {
    all[memory->basename()] = memory;
    EXPECT_EQ(memory->not_implementable(), "") << memory->name();
  }
  for (const Sized& row : rows) {
    ASSERT_TRUE(all.contains(row.memory)) << row.memory;
    EXPECT_EQ(all[row.memory]->logical_bits(), row.bits) << row.memory;
    if (*row.ports != 0) {
      EXPECT_EQ(all[row.memory]->ports(), row.ports) << row.memory;
    }
  }
}

TEST(Memories, LineBuildHasTheseMemories) {
  Parameters p = deburr_line();
  p.edge_source = spec::morphological::EdgeSource::kPredicated;
  expect_memories(p, {{"luma_lines", 144'000, "1R1W of 2 words"},  // one column and the next one
                      {"depth_lines", 92'160, "1R1W"},
                      {"pixel_lines3", 614'400},
                      {"weight_lines", 92'160},
                      {"row_marks", 1920 * 26},
                      {"row_descriptors", 1920 * 95},
                      {"column_marks", 1920 * 21},
                      {"column_descriptors", 1920 * 95},
                      {"linear_rom", 256 * 12},
                      {"encode_rom", 4096 * 8},
                      {"inverse_rom", 68 * 27},
                      {"edge_window", 257'280},
                      {"edge_rows_even", 69'120},
                      {"edge_rows_odd", 69'120},
                      {"descriptor_fifo_h0", 256 * 60}});
}

TEST(Memories, LearnedWeightsAddTablesAndOneDescriptorBit) {
  Parameters p = deburr();
  p.lanes = spec::morphological::Lanes::kTwo;
  expect_memories(p, {{"row_descriptors", 1920 * 96},
                      {"column_descriptors", 1920 * 96},
                      {"weights_a", 8 * 1024, "8R"},
                      {"weights_b", 8 * 640, "8R"},
                      {"weights_c", 8 * 640, "8R"},
                      {"weight_rom", 8 * 256, "8R"}});
}

TEST(Memories, TextGuardAddsLinesOfHashes) {
  Parameters p = deburr();
  p.text_guard = true;
  expect_memories(p, {{"guard_row", 1920 * 6, "1R1W"},
                      {"guard_columns", 1920 * (10 * 6 + 13 + 10), "1R1W"},
                      {"guard_colours", 1920 * 3, "1R1W"},
                      {"guards", 29 * 1920 + 32}});
}

// One entry per line in flight, read or written: 512 bits and two status bits.
TEST(Memories, MemoryBuildHoldsLinesInFlight) {
  Parameters p = in_memory();
  p.memory_outstanding = 32;
  expect_memories(p, {{"pixel_lines3", 61'440},
                      {"gather_line", 512},
                      {"writes_in_flight", 32},
                      {"reads_in_flight", 32},
                      {"response_buffer", 2 * 32 * 514}});
}

// Even a row of one pixel has a column next to it.
TEST(Memories, NarrowestRowsKeepTheirBanks) {
  Parameters p;
  p.line_pixels = 1;
  EngineBench bench(p);
  for (const rtl::MemoryBase* memory : bench.engine.memories())
    if (std::string(memory->basename()) == "luma_lines") {
      EXPECT_EQ(memory->words(), 2u);
    }
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::engine_test
