// SPDX-License-Identifier: MIT
// Details of the engine that no frame of ordinary size shows: slot numbers that wrap, addresses
// that wrap, debug writes, what counts as waiting, and when a frame is inside.
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "tb/unit/rtl/morphological/support.h"

namespace deburr::tb::morphological_rtl {
namespace {

using spec::morphological::Preset;
namespace reg = spec::morphological::reg;

Parameters in_memory() {
  Parameters p = preset(Preset::kMlaa);
  p.storage = spec::morphological::Storage::kMemory;
  return p;
}

// Records carry fifteen bits of their slot's number: two rows of 8192 beats, exactly.
TEST(SlotNumbers, WrapInTheWidestRows) {
  constexpr int kWidth = spec::morphological::kMaxFrameSize, kPart = 90, kHeight = 12;
  Parameters p = preset(Preset::kDeburr, 9);
  p.steps = 7;
  p.line_pixels = kWidth;
  EngineBench bench(p);
  const Frame pattern = noise(kPart, kHeight);
  // The same pixels at both ends of a row, so that records are found in its first and last slots.
  const Frame in = draw(kWidth, kHeight, [&](int x, int y) {
    return x < kPart             ? pattern.at(x, y)
           : x >= kWidth - kPart ? pattern.at(x - (kWidth - kPart), y)
                                 : grey(0);
  });
  const Frame out = bench.run(in);
  EXPECT_EQ(bench.engine.area.records.value(), bench.engine.extractor.records_sent.value());
  EXPECT_GT(bench.engine.area.records.value(), 400u);
  EXPECT_EQ(bench.engine.extractor.record_stalls.value(), 0u);
  int blended = 0;
  // Extensions reach seven steps of at most a few pixels; the middle of the part sees no border.
  for (int y = 0; y < kHeight; ++y)
    for (int x = 40; x < 50; ++x) {
      ASSERT_EQ(out.at(x, y), out.at(x + kWidth - kPart, y)) << x << ' ' << y;
      blended += out.at(x, y) != in.at(x, y);
    }
  EXPECT_GT(blended, 20);
}

TEST(Addresses, WrapAt4GiB) {
  EngineBench bench(in_memory());
  bench.bus.write(reg::kPixelBase, 0xFFFFFFC0);
  const Frame in = draw(16, 3, [](int x, int y) { return grey(10 * x + y); });
  const Frame out = bench.run(in);
  // The memory ends long before the first line, and holds the others at 0 and 0x40.
  EXPECT_EQ(bench.bus.read(reg::kMemoryErrors), 2u);
  const auto bytes = bench.memory->dump(0, 128);
  for (int x = 0; x < 16; ++x) {
    EXPECT_EQ(out.at(x, 0), Rgba8{});
    for (int y = 1; y < 3; ++y) {
      EXPECT_EQ(out.at(x, y), in.at(x, y));
      EXPECT_EQ(bytes[static_cast<std::size_t>(64 * (y - 1) + 4 * x)], 10 * x + y);
    }
  }
}

void debug_write(EngineBench& bench, std::uint32_t offset, std::uint32_t value) {
  std::array<unsigned char, 4> data{};
  for (unsigned i = 0; i < 4; ++i) data[i] = static_cast<unsigned char>(value >> (8 * i));
  tlm::tlm_generic_payload payload;
  payload.set_command(tlm::TLM_WRITE_COMMAND);
  payload.set_address(offset);
  payload.set_data_ptr(data.data());
  payload.set_data_length(4);
  payload.set_streaming_width(4);
  ASSERT_EQ(bench.bus.socket->transport_dbg(payload), 4u);
}

// Bits that a register does not have stay 0 on this way as well.
TEST(DebugWrites, CountFromTheNextFrameWithTheBitsThatExist) {
  EngineBench bench(in_memory());
  debug_write(bench, reg::kPixelBase, 0x12345);
  debug_write(bench, reg::kSize, 97u | 61u << 16 | 0xC000C000u);
  debug_write(bench, reg::kThreshold, 0xABCD0000u | 6554u);
  debug_write(bench, reg::kRules, 0xFFFE0000u | 1u << 15);
  const Frame in = noise();
  bench.driver.send(beats_of(in, 1));
  bench.bench->run([&] { return bench.sink.received() == 97u * 61u && bench.engine.idle(); },
                   1'000'000);
  EXPECT_EQ(bench.bus.read(reg::kPixelBase), 0x12340u);
  EXPECT_EQ(bench.bus.read(reg::kSize), 97u | 61u << 16);
  EXPECT_EQ(bench.bus.read(reg::kThreshold), 6554u);
  EXPECT_EQ(bench.bus.read(reg::kRules), 1u << 15);
  ASSERT_FALSE(bench.memory->lines_read().empty());
  EXPECT_EQ(bench.memory->lines_read()[0], 0x12340u);
  EXPECT_EQ(bench.bus.read(reg::kMemoryErrors), 0u);
}

// RECORD_STALLS: clocks in which a slot waits, not those in which none has come.
TEST(RecordStalls, CountOnlyWhereASlotWaits) {
  Parameters p = preset(Preset::kDeburr);
  p.lanes = spec::morphological::Lanes::kFour;
  p.record_fifo = 2;
  p.predictor_units = 1;
  p.divider_interval = 16;
  EngineBench::Options options;
  options.driver = {600, 40};
  EngineBench bench(p, options);
  const Frame in = noise();
  bench.engine.set_frame_size(in.width, in.height);
  bench.driver.send(beats_of(in, lanes_of(p)));
  const auto beats = static_cast<std::uint64_t>(beats_a_row(in, p) * in.height);
  const auto& extractor = bench.engine.extractor;
  std::uint64_t before = 0, waiting = 0, wrong = 0, full = 0;
  bool arrives = false;
  rtl::Activity records{};
  for (int code = 0; code < extractor.activities(); ++code)
    if (extractor.activity_name({static_cast<std::uint8_t>(code)}) == "records")
      records = {static_cast<std::uint8_t>(code)};
  std::uint64_t lost = 0;
  bench.bench->run(
      [&] {
        const std::uint64_t now = extractor.record_stalls.value();
        const std::uint64_t lost_now = extractor.cycles_of(records);
        if (now != before) ++(arrives ? waiting : wrong);
        if (lost_now != lost && !arrives) ++full;
        before = now;
        lost = lost_now;
        arrives = extractor.edges_in.can_pop(bench.clock.cycle());
        return bench.sink.received() == beats && bench.engine.idle();
      },
      1'000'000);
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(waiting, 100u);
  EXPECT_EQ(waiting, extractor.record_stalls.value());
  EXPECT_GT(full, 10u) << "records waited for their FIFO while no slot did";
  EXPECT_EQ(bench.bus.read(reg::kRecordStalls), extractor.record_stalls.value());
}

// A frame is inside when its first beat has been taken, and not before.
TEST(FirstBeat, TakesTheFrameInTheClockThatTakesIt) {
  EngineBench bench(preset(Preset::kDeburr));
  bench.engine.set_frame_size(97, 61);
  bench.driver.send(beats_of(noise(), 1));
  for (int i = 0; i < 28; ++i) {
    auto& link = i % 2 != 0 ? static_cast<rtl::LinkBase&>(bench.engine.sequencer.slots_out.link())
                            : bench.engine.sequencer.beats_out.link();
    link.hold_push(bench.clock.cycle());
    bench.clock.run(1);
  }
  EXPECT_EQ(bench.in.pops(), 0u);
  EXPECT_EQ(bench.bus.read(reg::kStatus), reg::kStatusIdle);
  // A rule that is written now counts for this frame.
  const std::uint32_t rules = bench.bus.read(reg::kRules);
  bench.bus.write(reg::kRules, 1u << 15 | 1u << 6 | 4u << 8);
  EXPECT_NE(bench.bus.read(reg::kRules), rules);
  bench.bus.write(reg::kThreshold, 6554);
  bench.bench->run([&] { return bench.sink.received() == 97u * 61u && bench.engine.idle(); },
                   1'000'000);
  EXPECT_EQ(hash(bench.last(97, 61)), 0x6c40266cf03f3513u);
  EXPECT_EQ(bench.bus.read(reg::kStatus), reg::kStatusIdle | reg::kStatusFrameDone);
  EXPECT_EQ(bench.bus.read(reg::kFrameCycles), (61u + 37u) * 97u + 6u);
}

// Every memory that there is, also where the model keeps something else.
TEST(Memories, OfStorageInMemoryAreAllReported) {
  Parameters p = in_memory();
  p.line_pixels = 1920;
  p.memory_outstanding = 32;
  p.record_fifo = 256;
  EngineBench bench(p);
  std::map<std::string, std::uint64_t> bits;
  for (const rtl::Storage* storage : bench.engine.memories())
    bits[storage->basename()] = storage->bits();
  EXPECT_EQ(bits["pixel_lines"], 184'320u);
  EXPECT_EQ(bits["gather_line"], 512u);
  EXPECT_EQ(bits["response_lines"], 32u * 512u);
  EXPECT_EQ(bits["lines_in_flight"], 64u * 24u);
  EXPECT_EQ(bits["record_fifo_h0"], 256u * 59u);
  EXPECT_EQ(bits.count("edge_rows"), 0u);
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl
