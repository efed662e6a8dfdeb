// SPDX-License-Identifier: MIT
// PixelStore, cycle by cycle, with line buffers and with storage in memory: order and addresses of
// lines, and the effect of memory errors.
#include <cstdint>
#include <vector>

#include "tb/base/forked.h"
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/morphological/parts.h"

namespace deburr::tb::morphological_rtl::pixel_store_test {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these
using rtl::MemoryRequest;
using rtl::MemoryResponse;
using spec::morphological::Preset;

namespace reg = spec::morphological::reg;

Frame colours(int width, int height) {
  return draw(width, height, [](int x, int y) -> Rgba8 {
    return {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
            static_cast<std::uint8_t>(x * 7 + y * 13), static_cast<std::uint8_t>(x ^ y)};
  });
}

// beats, fetches -> PixelStore -> pixels; with storage = memory also -> requests and responses ->.
struct Storing {
  Storing(const Parameters& p, const Frame& f, Cycle pixels_open = 0)
      : frame(f),
        outstanding(static_cast<std::uint32_t>(p.memory_outstanding)),
        lanes(lanes_of(p)),
        beats_a_row(morphological_rtl::beats_a_row(f, p)),
        registers(p, f.width, f.height),
        store("pixel_store", clock, p),
        pixel_gate("pixel_gate", clock, pixels_open) {
    store.configuration_in(registers.configuration);
    if (store.memory_error_out) (*store.memory_error_out)(memory_error);
    beat_driver.out(beats);
    store.beats_in(beats);
    fetch_driver.out(fetches);
    store.fetches_in(fetches);
    store.pixels_out(pixels);
    pixel_gate.in(pixels);
    store.connect(requests, responses);
    request_gate.in(requests);
    response_driver.out(responses);
  }
  Slot slot(int row, int beat) const {
    return {static_cast<std::uint32_t>(row * beats_a_row + beat), static_cast<std::uint16_t>(row),
            static_cast<std::uint16_t>(beat)};
  }
  // Sends beat `b` of row y in cycle `at`.
  void store_beat(Cycle at, int y, int b) {
    BeatToken token{};
    token.slot = slot(y, b);
    for (int i = 0; i < lanes && b * lanes + i < frame.width; ++i)
      token.pixel[static_cast<std::size_t>(i)] = frame.at(b * lanes + i, y);
    beat_driver.add(at, token);
  }
  void store_all() {
    for (int y = 0; y < frame.height; ++y)
      for (int b = 0; b < beats_a_row; ++b) store_beat(0, y, b);
  }
  void fetch_beat(Cycle at, int y, int b) { fetch_driver.add(at, {slot(y + kLag, b)}); }
  // Tag of a request: index among the outstanding lines, line in its row, row buffer.
  std::uint32_t tag(std::uint32_t line, bool write) const {
    const auto row_lines = static_cast<std::uint32_t>((frame.width + 15) / 16);
    return line % outstanding | line % row_lines << 8 | (write ? 0 : line / row_lines % 4 << 17);
  }
  void answer(Cycle at, std::uint32_t line, bool write, rtl::Line data = {}) {
    MemoryResponse response;
    response.tag = tag(line, write);
    response.write = write;
    response.data = data;
    response_driver.add(at, response);
  }
  // Line `number` of the frame as memory stores it, for rows that are multiples of a line.
  rtl::Line line(std::uint32_t number) const {
    rtl::Line data{};
    for (std::size_t i = 0; i < 64; ++i)
      data[i] = frame.pixel[16 * std::size_t{number} + i / 4][i % 4];
    return data;
  }
  // Compares every neighbour that lies inside the frame.
  void expect_around(const PixelToken& token, int y, int b) const {
    SCOPED_TRACE("row " + std::to_string(y) + ", beat " + std::to_string(b));
    const int first = b * lanes, end = std::min(first + lanes, frame.width);
    for (int x = first; x < end; ++x) {
      const auto i = static_cast<std::size_t>(x - first);
      EXPECT_EQ(token.centre[i], frame.at(x, y));
      EXPECT_EQ(token.above[i], y > 0 ? frame.at(x, y - 1) : token.above[i]);
      EXPECT_EQ(token.below[i], y + 1 < frame.height ? frame.at(x, y + 1) : token.below[i]);
    }
    EXPECT_EQ(token.before, first > 0 ? frame.at(first - 1, y) : token.before);
    EXPECT_EQ(token.after, end < frame.width ? frame.at(end, y) : token.after);
  }

  struct Request {
    bool write;
    std::uint32_t line;
    Cycle taken;
  };
  // `in_all` requests have been made; checks the last ones.
  void expect_requests(std::size_t in_all, const std::vector<Request>& newest) const {
    ASSERT_EQ(request_gate.taken.size(), in_all);
    for (std::size_t i = 0; i < newest.size(); ++i) {
      const auto& [cycle, request] = request_gate.taken[in_all - newest.size() + i];
      EXPECT_EQ(request.write, newest[i].write) << i;
      EXPECT_EQ(request.tag, tag(newest[i].line, newest[i].write)) << i;
      EXPECT_EQ(cycle, newest[i].taken) << i;
    }
  }
  // The first beats of the frame have come out.
  void expect_pixels(std::size_t beats_taken) const {
    ASSERT_GE(pixel_gate.taken.size(), beats_taken);
    for (std::size_t i = 0; i < beats_taken; ++i)
      expect_around(pixel_gate.taken[i].token, static_cast<int>(i) / beats_a_row,
                    static_cast<int>(i) % beats_a_row);
  }

  const Frame frame;
  const std::uint32_t outstanding;
  const int lanes, beats_a_row;
  ClockDomain clock{"clock", period()};
  Registers registers;
  rtl::Pulse memory_error{"memory_error"};
  PixelStore store;
  Link<BeatToken> beats{"beats"};
  Link<FetchToken> fetches{"fetches"};
  Link<PixelToken> pixels{"pixels"};
  Link<MemoryRequest> requests{"requests"};
  Link<MemoryResponse> responses{"responses"};
  unit_bench::Source<BeatToken> beat_driver{"beat_driver", clock};
  unit_bench::Source<FetchToken> fetch_driver{"fetch_driver", clock};
  unit_bench::Source<MemoryResponse> response_driver{"response_driver", clock};
  unit_bench::Sink<PixelToken> pixel_gate;
  unit_bench::Sink<MemoryRequest> request_gate{"request_gate", clock};
};

Parameters built(spec::morphological::Storage storage, int lanes_code) {
  Parameters p = preset(spec::morphological::Preset::kMlaa, kReach, 8);
  p.storage = storage;
  p.lanes = static_cast<spec::morphological::Lanes>(lanes_code);
  p.line_pixels = 64;
  return p;
}

// ---- storage = line_buffers ---------------------------------------------------------------------

class PixelStoreLanes : public ::testing::TestWithParam<int> {};

// One beat per cycle goes in and one comes out, two cycles after it was requested.
TEST_P(PixelStoreLanes, LatencyAndIntervalMatchDatasheet) {
  Storing bench(built(spec::morphological::Storage::kLineBuffers, GetParam()), colours(9, 24));
  Cycle at = 0;
  for (int y = 0; y < 24 + kLag; ++y)
    for (int b = 0; b < bench.beats_a_row; ++b, ++at) {
      if (y < 24) bench.store_beat(at, y, b);
      // Two cycles after the beat of the same slot, like the extractor.
      if (y >= kLag) bench.fetch_beat(at + 2, y - kLag, b);
    }
  bench.clock.run(at + 5);
  const std::size_t before = static_cast<std::size_t>(kLag * bench.beats_a_row);
  ASSERT_EQ(bench.pixel_gate.taken.size(), static_cast<std::size_t>(24 * bench.beats_a_row));
  for (std::size_t i = 0; i < bench.pixel_gate.taken.size(); ++i) {
    // Pushed in i + before + 2, popped and read one cycle later.
    const rtl::Datasheet sheet = PixelStore::datasheet();
    ASSERT_EQ(bench.pixel_gate.taken[i].cycle,
              before + 3 + i * sheet.interval.cycles + sheet.latency.cycles);
    const int row = static_cast<int>(i) / bench.beats_a_row;
    bench.expect_around(bench.pixel_gate.taken[i].token, row,
                        static_cast<int>(i) - row * bench.beats_a_row);
  }
  EXPECT_EQ(bench.store.stalled_cycles(), 0u);
  EXPECT_EQ(bench.store.busy_cycles() + bench.store.idle_cycles(), bench.clock.cycle());
}
INSTANTIATE_TEST_SUITE_P(Each, PixelStoreLanes, ::testing::Values(0, 1, 2));

// In a frame of three rows, each beat reads its own row, the row above except in the first, and the
// row below except in the last.
TEST(PixelStoreBlock, ReadsNoRowBeyondTheFrame) {
  Storing bench(built(spec::morphological::Storage::kLineBuffers, 0), colours(6, 3));
  for (int y = 0; y < 3; ++y)
    for (int b = 0; b < 6; ++b) {
      bench.store_beat(0, y, b);
      bench.fetch_beat(30, y, b);
    }
  bench.clock.run(60);
  ASSERT_EQ(bench.pixel_gate.taken.size(), 3u * 6u);
  std::uint64_t reads = 0;
  rtl::for_each<rtl::PortedMemory>(
      bench.store, [&](const rtl::PortedMemory& memory) { reads += memory.reads(); });
  EXPECT_EQ(reads, 6u * (3 + 2 + 2));
}

// R + 7 rows, rounded up to a multiple of four. The first beat of the next row replaces row 0,
// whose last use is the first beat of row 1, in slot row R + 6.
TEST(PixelStoreBlock, BeatStallsUntilItsRowIsFree) {
  constexpr int kRows = (kReach + 7 + 3) / 4 * 4, kWidth = 5;
  constexpr Cycle kAsked = 100;
  Storing bench(built(spec::morphological::Storage::kLineBuffers, 0), colours(kWidth, kRows + 2));
  bench.store_all();
  Cycle at = kAsked;
  for (int y = 0; y < kRows + 2; ++y)
    for (int b = 0; b < kWidth; ++b) bench.fetch_beat(at++, y, b);
  bench.clock.run(kAsked);
  // Beat k is popped in cycle k + 1; the first beat of row R + 7 waits from then on.
  EXPECT_EQ(bench.beats.pops(), static_cast<std::uint64_t>(kRows * kWidth));
  EXPECT_EQ(bench.store.busy_cycles(), static_cast<std::uint64_t>(kRows * kWidth));
  EXPECT_EQ(stalls(bench.store, "rows"), kAsked - kRows * kWidth - 1);
  // Row 0 is requested in kWidth cycles from kAsked + 1 on, then the first beat of row 1.
  bench.clock.run(kWidth + 1);
  EXPECT_EQ(bench.beats.pops(), static_cast<std::uint64_t>(kRows * kWidth));
  bench.clock.run(1);
  EXPECT_EQ(bench.beats.pops(), static_cast<std::uint64_t>(kRows * kWidth + 1));
  bench.clock.run(100);
  bench.expect_pixels(static_cast<std::size_t>((kRows + 2) * kWidth));
  EXPECT_EQ(stalls(bench.store, "rows"), kAsked - kRows * kWidth);  // then the read side is busy
}

TEST(PixelStoreBlock, WaitsDownstream) {
  Storing bench(built(spec::morphological::Storage::kLineBuffers, 0), colours(6, 2), 50);
  for (int y = 0; y < 2; ++y)
    for (int b = 0; b < 6; ++b) {
      bench.store_beat(0, y, b);
      bench.fetch_beat(14, y, b);
    }
  bench.clock.run(80);
  // The link holds two, sent in 16 and 17; they are taken from 50 on, so the third is sent in 51.
  EXPECT_EQ(stalls(bench.store, "downstream"), 51u - 18u);
  ASSERT_EQ(bench.pixel_gate.taken.size(), 12u);
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(bench.pixel_gate.taken[i].cycle, 50 + i);
    bench.expect_around(bench.pixel_gate.taken[i].token, static_cast<int>(i) / 6,
                        static_cast<int>(i) % 6);
  }
}

// ---- storage = memory ---------------------------------------------------------------------------

// 20 pixels per row: one line of 16 pixels and one of 4 with padding.
TEST(PixelStoreMemory, LineIsSentWithItsLastPixel) {
  const Frame frame = colours(20, 3);
  Storing bench(built(spec::morphological::Storage::kMemory, 0), frame);
  bench.store_all();
  bench.clock.run(80);
  ASSERT_EQ(bench.request_gate.taken.size(), 6u);
  for (std::size_t line = 0; line < 6; ++line) {
    const MemoryRequest& request = bench.request_gate.taken[line].token;
    const int y = static_cast<int>(line) / 2, x0 = line % 2 ? 16 : 0;
    EXPECT_TRUE(request.write);
    EXPECT_EQ(request.address, 64 * line);
    EXPECT_EQ(request.byte_mask, ~std::uint64_t{0});
    for (int i = 0; i < 64; ++i) {
      const int x = x0 + i / 4;
      EXPECT_EQ(request.data[static_cast<std::size_t>(i)],
                x < 20 ? frame.at(x, y)[static_cast<std::size_t>(i % 4)] : 0);
    }
    // Pixel k is sent in k and popped in k + 1, and its line is sent in the same cycle; taken in k
    // + 2.
    const int last = y * 20 + (line % 2 ? 19 : 15);
    EXPECT_EQ(bench.request_gate.taken[line].cycle, static_cast<Cycle>(last + 2));
  }
}

// Line 1 is answered before line 0: neither is read until line 0 is answered, then one per cycle.
TEST(PixelStoreMemory, LineIsReadAfterAllEarlierWrites) {
  Storing bench(built(spec::morphological::Storage::kMemory, 0), colours(48, 1));
  bench.store_all();
  bench.answer(60, 1, true);
  bench.answer(70, 0, true);
  bench.answer(80, 2, true);
  bench.clock.run(120);
  // A response sent in c is popped in c + 1, when the read is sent; it is taken in c + 2.
  bench.expect_requests(6, {{false, 0, 72}, {false, 1, 73}, {false, 2, 82}});
}

// Four lanes, 16 pixels: one line every four cycles. When a response arrives, the write of that
// cycle goes first and the read follows.
TEST(PixelStoreMemory, WritesGoBeforeReads) {
  Storing bench(built(spec::morphological::Storage::kMemory, 2), colours(16, 6));
  bench.store_all();
  // Line y is sent in cycle 4 y + 4. The response to line 0 is popped in 12, when line 2 is sent;
  // the response to line 1 in 17, one cycle after line 3.
  bench.answer(11, 0, true);
  bench.answer(16, 1, true);
  bench.clock.run(60);
  bench.expect_requests(8, {{true, 0, 5},
                            {true, 1, 9},
                            {true, 2, 13},
                            {false, 0, 14},
                            {true, 3, 17},
                            {false, 1, 18},
                            {true, 4, 21},
                            {true, 5, 25}});
  EXPECT_EQ(bench.store.lines_written.value(), 6u);
  EXPECT_EQ(bench.store.lines_read.value(), 2u);
}

// Rows of one beat write one line per cycle, so reads wait until the writes end.
TEST(PixelStoreMemory, WritesInEveryCycleBlockReads) {
  Storing bench(built(spec::morphological::Storage::kMemory, 2), colours(4, 9));
  bench.store_all();
  bench.answer(3, 0, true);
  bench.answer(4, 1, true);
  bench.clock.run(60);
  std::vector<Storing::Request> wanted;
  for (std::uint32_t i = 0; i < 11; ++i) wanted.push_back({i < 9, i < 9 ? i : i - 9, i + 2});
  bench.expect_requests(11, wanted);
}

// Four row buffers: row 4 replaces row 0, which is last requested with row 1. In a row of two
// lines, each is read as soon as its own words are free.
TEST(PixelStoreMemory, LineIsReadOnceItsBufferIsFree) {
  Storing bench(built(spec::morphological::Storage::kMemory, 0), colours(32, 6));
  constexpr Cycle kAsked = 230;
  bench.store_all();
  for (std::uint32_t line = 0; line < 12; ++line) bench.answer(196 + line, line, true);
  for (std::uint32_t line = 0; line < 8; ++line) bench.answer(210, line, false, bench.line(line));
  for (int y = 0; y < 2; ++y)
    for (int b = 0; b < 32; ++b) bench.fetch_beat(kAsked, y, b);
  bench.clock.run(330);
  // Beat 15 of row 1 is sent in kAsked + 47 and popped one cycle later, when the read is sent.
  bench.expect_requests(12 + 10, {{false, 8, kAsked + 49}, {false, 9, kAsked + 65}});
  bench.expect_pixels(64);
}

// Each beat waits only for the line of the pixel below it.
TEST(PixelStoreMemory, BeatWaitsForTheLineBelow) {
  Storing bench(built(spec::morphological::Storage::kMemory, 0), colours(32, 3));
  bench.store_all();
  for (std::uint32_t line = 0; line < 6; ++line) bench.answer(110, line, true);
  for (std::uint32_t line = 0; line < 3; ++line) bench.answer(130, line, false, bench.line(line));
  bench.answer(200, 3, false, bench.line(3));
  for (int b = 0; b < 32; ++b) bench.fetch_beat(150, 0, b);
  bench.clock.run(240);
  ASSERT_EQ(bench.pixel_gate.taken.size(), 32u);
  for (std::size_t b = 0; b < 32; ++b) {
    // Sent in 150 + b, popped one cycle later, then sent, then taken. Eight beats each of the
    // response are stored in 201 and in 202.
    EXPECT_EQ(bench.pixel_gate.taken[b].cycle, b < 16 ? 153 + b : 205 + b - 16);
    bench.expect_around(bench.pixel_gate.taken[b].token, 0, static_cast<int>(b));
  }
}

// Loaded lines are available one cycle after their response was popped. Until then the slot waits
// with the stall `memory`.
TEST(PixelStoreMemory, SlotWaitsForItsLine) {
  Storing bench(built(spec::morphological::Storage::kMemory, 2), colours(16, 1));
  for (int b = 0; b < 4; ++b) {
    bench.store_beat(0, 0, b);
    bench.fetch_beat(10, 0, b);
  }
  bench.answer(20, 0, true);
  bench.answer(40, 0, false, bench.line(0));
  bench.clock.run(60);
  ASSERT_EQ(bench.pixel_gate.taken.size(), 4u);
  for (std::size_t b = 0; b < 4; ++b) {
    // Stored in 41, read in 42, sent in 43, taken in 44.
    EXPECT_EQ(bench.pixel_gate.taken[b].cycle, 44 + b);
    bench.expect_around(bench.pixel_gate.taken[b].token, 0, static_cast<int>(b));
  }
  // From 11 to 41, except in the cycles of the two responses.
  EXPECT_EQ(stalls(bench.store, "memory"), 31u - 2u);
}

// At most `memory_outstanding` lines are written without a response; then a beat waits.
TEST(PixelStoreMemory, WriteWaitsForAnOutstandingEntry) {
  Parameters p = built(spec::morphological::Storage::kMemory, 2);
  p.memory_outstanding = 3;
  Storing bench(p, colours(16, 6));
  bench.store_all();
  bench.answer(50, 0, true);
  bench.clock.run(80);
  // Lines 0, 1, 2 in 4, 8, 12; three beats of line 3 until 15, the fourth waits. The response is
  // popped in 51, after the store side has run: line 0 is read in that cycle, line 3 is written in
  // 52; the last beat of line 4 waits from 56 on.
  bench.expect_requests(5, {{true, 2, 13}, {false, 0, 52}, {true, 3, 53}});
  EXPECT_EQ(stalls(bench.store, "memory"), (50u - 15u) + (79u - 55u));
}

// Each kind of work that can be alone in a cycle: a response out of order, a line that is released
// after such a response, a read that has waited for the link.
TEST(PixelStoreMemory, LineCyclesAreBusyOthersIdle) {
  Storing bench(built(spec::morphological::Storage::kMemory, 0), colours(48, 1));
  bench.store_all();  // stored in 1 to 48
  bench.answer(60, 1, true);
  bench.answer(70, 0, true);
  bench.answer(80, 2, true);
  // With one lane, a line is stored in two cycles.
  bench.answer(90, 1, false, bench.line(1));
  bench.answer(100, 0, false, bench.line(0));
  bench.answer(110, 2, false, bench.line(2));
  bench.clock.run(71);
  for (int i = 0; i < 2; ++i) {
    bench.requests.hold_push(bench.clock.cycle());
    bench.clock.run(1);
  }
  bench.clock.run(120 - 73);
  // The writes of lines 1 and 0 are answered in 61 and 71, and line 1 is released in 72; both are
  // read when the link has room, in 73 and 74; line 2 in 81, with its response. The reads of line 1
  // arrive in 91 and 92, of line 0 in 101 and 102, line 1 is released in 103; line 2 arrives in 111
  // and 112.
  bench.expect_requests(6, {{false, 0, 74}, {false, 1, 75}, {false, 2, 82}});
  EXPECT_EQ(bench.store.busy_cycles(), 48u + 6u + 7u);
  EXPECT_EQ(bench.store.idle_cycles(), 120u - 48u - 6u - 7u);
}

// Rows 4 and 5 wait for rows 0 and 1, which have not been requested yet: idle.
TEST(PixelStoreMemory, IdleWhileReadsWaitForABuffer) {
  Storing bench(built(spec::morphological::Storage::kMemory, 2), colours(16, 6));
  bench.store_all();
  for (std::uint32_t line = 0; line < 6; ++line) bench.answer(40, line, true);
  for (std::uint32_t line = 0; line < 4; ++line) bench.answer(60, line, false, bench.line(line));
  bench.clock.run(100);
  EXPECT_EQ(bench.store.lines_read.value(), 4u);
  EXPECT_EQ(bench.store.busy_cycles(), 24u + 6u + 4u);
  EXPECT_EQ(bench.store.idle_cycles(), 100u - 24u - 6u - 4u);
}

// When the reset comes, line 1 has been written and may be read, but one read is outstanding and
// there is no room for another.
TEST(PixelStoreMemory, ResetDropsLinesThatWaitForARead) {
  Parameters p = built(spec::morphological::Storage::kMemory, 2);
  p.memory_outstanding = 1;
  Storing bench(p, colours(16, 3));
  bench.store_all();
  bench.answer(10, 0, true);
  bench.answer(20, 1, true);
  bench.clock.run(30);
  EXPECT_EQ(bench.store.lines_written.value(), 3u);
  EXPECT_EQ(bench.store.lines_read.value(), 1u);
  reset_by(bench.clock);
  bench.clock.run(20);
  EXPECT_EQ(bench.store.lines_read.value(), 0u);
  EXPECT_EQ(bench.store.busy_cycles(), 0u);
}

// ---- memory errors ------------------------------------------------------------------------------

struct Failure {
  const char* name;
  bool write;
  spec::morphological::Lanes lanes;
};
void PrintTo(const Failure& f, std::ostream* out) { *out << f.name; }
class MemoryError : public ::testing::TestWithParam<Failure> {};

// A failing write leaves memory unchanged, and its old content is read: 0x5A here. A failing read
// returns zeros. Either counts as one error and affects no other line.
TEST_P(MemoryError, FailedWriteKeepsMemoryFailedReadGivesZeros) {
  const Failure failure = GetParam();
  Parameters p = built(spec::morphological::Storage::kMemory, static_cast<int>(failure.lanes));
  EngineBench::Options options;
  options.memory_latency = 900;  // all eight lines are written before the first is read
  EngineBench bench(p, options);
  bench.memory->preload(0, std::vector<std::uint8_t>(1024, 0x5A));
  bench.memory->fail_request(failure.write ? 3 : 8 + 3);
  const Frame out = bench.run(draw(64, 2, [](int, int) { return grey(200); }));
  ASSERT_EQ(bench.memory->writes(), 8u);
  ASSERT_EQ(bench.memory->reads(), 8u);
  const Rgba8 other = failure.write ? Rgba8{0x5A, 0x5A, 0x5A, 0x5A} : Rgba8{0, 0, 0, 0};
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 64; ++x)
      ASSERT_EQ(out.at(x, y), y == 0 && x >= 48 ? other : grey(200)) << x << ' ' << y;
  namespace reg = spec::morphological::reg;
  EXPECT_EQ(bench.bus.read(reg::kMemoryErrors), 1u);
  EXPECT_EQ(bench.memory->errors(), 1u);
  EXPECT_EQ(bench.bus.read(reg::kStatus),
            reg::kStatusIdle | reg::kStatusFrameDone | reg::kStatusMemoryError);
}
INSTANTIATE_TEST_SUITE_P(
    Each, MemoryError,
    ::testing::Values(Failure{"write", true, spec::morphological::Lanes::kOne},
                      Failure{"read", false, spec::morphological::Lanes::kOne},
                      Failure{"write4", true, spec::morphological::Lanes::kFour},
                      Failure{"read4", false, spec::morphological::Lanes::kFour}),
    [](const auto& failure) { return failure.param.name; });

// ---- the whole engine ---------------------------------------------------------------------------

TEST(Addresses, AddressesWrapAt4GiB) {
  EngineBench bench(in_memory());
  bench.bus.write(reg::kPixelBase, 0xFFFFFFC0);
  const Frame in = draw(16, 3, [](int x, int y) { return grey(10 * x + y); });
  const Frame out = bench.run(in);
  // The memory ends long before the first line; the other lines are at 0 and 0x40.
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

TEST(Memory, OutstandingLimitIsKept) {
  Parameters p = preset(Preset::kMlaa);
  p.storage = spec::morphological::Storage::kMemory;
  p.lanes = spec::morphological::Lanes::kFour;
  p.memory_outstanding = 3;
  EngineBench::Options options;
  options.memory_latency = 200;
  EngineBench bench(p, options);
  bench.run(noise());
  EXPECT_EQ(bench.memory->max_outstanding(), 6u);
}

// ---- sizes ------------------------------------------------------------------------------------

// R + 7 rows, rounded up to a multiple of four, of whole lines of memory.
TEST(PixelStoreLines, LineBuffersMatchThePage) {
  struct Row {
    int search_range, line_pixels, lanes_code;
    std::uint64_t words;  // of each of the four
  };
  for (const Row& row : {Row{4, 64, 0, 3 * 64}, Row{5, 64, 0, 3 * 64}, Row{6, 64, 0, 4 * 64},
                         Row{9, 64, 0, 4 * 64}, Row{10, 64, 0, 5 * 64}, Row{4, 65, 0, 3 * 80},
                         Row{4, 80, 1, 3 * 40}, Row{4, 81, 2, 3 * 24}}) {
    const std::string got = forked_text([&] {
      Parameters p = preset(spec::morphological::Preset::kMlaa, row.search_range, 8);
      p.line_pixels = row.line_pixels;
      p.lanes = static_cast<spec::morphological::Lanes>(row.lanes_code);
      EngineBench bench(p);
      std::string words;
      for (const rtl::MemoryBase* memory : bench.engine.memories())
        if (std::string(memory->basename()).starts_with("pixel_lines"))
          words += std::to_string(memory->words()) + ' ';
      return words;
    });
    const std::string each = std::to_string(row.words) + ' ';
    EXPECT_EQ(got, each + each + each + each) << row.search_range << ' ' << row.line_pixels;
  }
}

// ---- memory access checks -----------------------------------------------------------------------

TEST(PixelStoreLines, WordNeedsOneCycleAfterItsAddress) {
  Storing bench(built(spec::morphological::Storage::kLineBuffers, 0), colours(6, 2));
  bench.store_beat(0, 0, 0);
  bench.fetch_beat(10, 0, 0);
  bench.clock.run(12);
  expect_used_early(bench.store, bench.clock, "pixel_lines0");
}

TEST(PixelStoreLines, RejectsBeatsBeyondTheLongestRow) {
  Storing bench(built(spec::morphological::Storage::kLineBuffers, 0), colours(6, 2));
  bench.fetch_beat(10, 0, 4000);
  EXPECT_THAT([&] { bench.clock.run(20); },
              ::testing::ThrowsMessage<spec::CheckFailed>(::testing::HasSubstr("pixel_lines")));
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::pixel_store_test
