// SPDX-License-Identifier: MIT
// TextGuard: small pictures by hand, any picture against the contract's sentences, its cycles; and
// in the engine: what is left, and that nothing waits for it.
#include <algorithm>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "spec/morphological/vectors.h"
#include "tb/base/forked.h"
#include "tb/base/random.h"
#include "tb/base/sanitized.h"
#include "tb/harness/monitor.h"
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/morphological/parts.h"
#include "tb/unit/rtl/morphological/vectors.h"

namespace deburr::tb::morphological_rtl::text_guard_test {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these
using spec::morphological::Preset;
using Rows = std::vector<std::string>;

Parameters guarded(int lanes_code = 0, int search_rows = kReach) {
  Parameters p = preset(Preset::kMlaa, search_rows, 8);
  p.lanes = static_cast<spec::morphological::Lanes>(lanes_code);
  p.text_guard = true;
  p.line_pixels = 64;
  return p;
}

// ---- the contract, sentence by sentence ---------------------------------------------------------

int hash_of(const Rgba8& c) {
  const auto f = [](int v) { return (v % 64) ^ (v / 64); };
  const auto rot = [](int a, int n) { return ((a << n) | (a >> (6 - n))) % 64; };
  return f(c[0]) ^ rot(f(c[1]), 1) ^ rot(f(c[2]), 3);
}

TEST(TextGuardContract, HashesAreThoseOfItsTable) {
  EXPECT_EQ(hash_of({0, 0, 0, 9}), 0);
  EXPECT_EQ(hash_of({255, 0, 0, 9}), 60);
  EXPECT_EQ(hash_of({0, 255, 0, 9}), 57);
  EXPECT_EQ(hash_of({0, 0, 255, 9}), 39);
  EXPECT_EQ(hash_of({255, 255, 255, 9}), 34);
  EXPECT_EQ(hash_of({1, 1, 1, 9}), 11);
  EXPECT_EQ(hash_of({64, 64, 64, 9}), 11);
}

// '#' for each guarded pixel, '.' for the others, a line a row.
Rows by_contract(const Frame& frame) {
  const auto inside = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < frame.width && y < frame.height;
  };
  const auto is_stroke = [&](int x, int y, int dx, int dy) {
    int run = 1;
    for (const int way : {-1, 1})
      for (int i = 1;
           inside(x + way * i * dx, y + way * i * dy) &&
           hash_of(frame.at(x + way * i * dx, y + way * i * dy)) == hash_of(frame.at(x, y));
           ++i)
        ++run;
    return run <= 3;
  };
  Rows h, v, rows;
  for (int y = 0; y < frame.height; ++y) {
    h.emplace_back();
    v.emplace_back();
    for (int x = 0; x < frame.width; ++x) {
      h.back() += is_stroke(x, y, 1, 0) ? '1' : '0';
      v.back() += is_stroke(x, y, 0, 1) ? '1' : '0';
    }
  }
  for (int y = 0; y < frame.height; ++y) {
    rows.emplace_back();
    for (int x = 0; x < frame.width; ++x) {
      std::vector<bool> hashes(64);
      int with_h = 0, with_v = 0;
      for (int wy = y - 5; wy <= y + 5; ++wy)
        for (int wx = x - 5; wx <= x + 5; ++wx)
          if (inside(wx, wy)) {
            const auto row = static_cast<std::size_t>(wy), column = static_cast<std::size_t>(wx);
            hashes[static_cast<std::size_t>(hash_of(frame.at(wx, wy)))] = true;
            with_h += h[row][column] == '1';
            with_v += v[row][column] == '1';
          }
      rows.back() += std::count(hashes.begin(), hashes.end(), true) == 2 && with_h >= 3 &&
                             with_v >= 3 && with_h + with_v >= 24
                         ? '#'
                         : '.';
    }
  }
  return rows;
}

// ---- the unit -----------------------------------------------------------------------------------

struct GuardBench {
  explicit GuardBench(const Parameters& p, Cycle opens = 0)
      : lanes(lanes_of(p)), registers(p), guard("guard", clock, p), gate("gate", clock, opens) {
    guard.configuration_in(registers.configuration);
    source.out(slots);
    guard.slots_in(slots);
    gate.in(guard.guards());
  }
  // The slots of a frame, from a clock on: rows beyond it, too, and noise wherever nothing is read.
  void send(const Frame& frame, Cycle from = 0) {
    registers.frame(frame.width, frame.height, clock.cycle());
    width = frame.width;
    height = frame.height;
    const int beats = (width + lanes - 1) / lanes;
    for (int y = 0; y < height + 8; ++y)
      for (int beat = 0; beat < beats; ++beat) {
        GuardSlotToken token{};
        token.row = static_cast<std::uint16_t>(y);
        token.beat = static_cast<std::uint16_t>(beat);
        for (int lane = 0; lane < lanes; ++lane) {
          const int x = beat * lanes + lane;
          auto& pixel = token.pixel[static_cast<std::size_t>(lane)];
          for (std::size_t c = 0; c < 3; ++c)
            pixel[c] = x < width && y < height ? frame.at(x, y)[c]
                                               : static_cast<std::uint8_t>(random.word());
        }
        source.add(from, token);
      }
    sent += static_cast<std::size_t>(beats * (height + 8));
    wanted += static_cast<std::size_t>(beats * height);
  }
  Rows finish(Cycle limit = 200'000) {
    EXPECT_TRUE(clock.run_until(
        [&] { return gate.taken.size() == wanted && source.sent() == sent; }, limit));
    clock.run(40);
    EXPECT_EQ(gate.taken.size(), wanted) << "a beat too many";
    const int beats = (width + lanes - 1) / lanes;
    const std::size_t from = wanted - static_cast<std::size_t>(beats * height);
    Rows rows;
    for (int y = 0; y < height; ++y) {
      rows.emplace_back();
      for (int x = 0; x < width; ++x)
        rows.back() +=
            gate.taken[from + static_cast<std::size_t>(y * beats + x / lanes)].token.guarded >>
                        (x % lanes) &
                    1
                ? '#'
                : '.';
    }
    return rows;
  }
  void reset() {
    clock.set_reset_n(false);
    clock.run(1);
    clock.set_reset_n(true);
    sent = wanted = 0;
  }
  Rows run(const Frame& frame) {
    send(frame);
    return finish();
  }

  int lanes, width = 0, height = 0;
  ClockDomain clock{"clock", period()};
  Registers registers;
  Link<GuardSlotToken> slots{"slots"};
  unit_bench::Source<GuardSlotToken> source{"source", clock};
  TextGuard guard;
  unit_bench::Sink<GuardToken> gate;
  Random random{1, "noise"};
  std::size_t sent = 0, wanted = 0;
};

// Letters are colours.
Frame picture(const Rows& rows) {
  return draw(static_cast<int>(rows[0].size()), static_cast<int>(rows.size()), [&](int x, int y) {
    const char letter = rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
    return letter == 'a' ? grey(0) : letter == 'b' ? grey(255) : Rgba8{255, 0, 0, 255};
  });
}
Rows repeated(std::string_view row, std::size_t times) { return Rows(times, std::string(row)); }

class ByHand : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Lanes, ByHand, ::testing::Range(0, 3));

TEST_P(ByHand, TwentyFourStrokesAreEnough) {
  GuardBench bench(guarded(GetParam()));
  // A checkerboard is all strokes both ways.
  EXPECT_EQ(bench.run(picture({"abab", "baba", "abab"})), repeated("####", 3));
  EXPECT_EQ(bench.run(picture({"aba", "bab", "aba"})), repeated("...", 3));
  // A row of any length has eleven each way in a window, two of six have twelve.
  EXPECT_EQ(bench.run(picture({"abababababababab"})), repeated("................", 1));
  EXPECT_EQ(bench.run(picture({"ababa", "babab"})), repeated(".....", 2));
  EXPECT_EQ(bench.run(picture({"ababab", "bababa"})), repeated("######", 2));
  EXPECT_EQ(bench.run(picture({"ab", "ba", "ab", "ba", "ab", "ba"})), repeated("##", 6));
  EXPECT_EQ(bench.guard.guarded_pixels.value(), 12u + 12u + 12u);
}

TEST_P(ByHand, ARunOfFourIsNoStroke) {
  GuardBench bench(guarded(GetParam()));
  // Columns three high are strokes down.
  EXPECT_EQ(bench.run(picture(repeated("aaabbbaaabbb", 3))), repeated("############", 3));
  // Four of a: only b has H, and V is all pixels'.
  EXPECT_EQ(bench.run(picture(repeated("aaaabbbaaaabbb", 2))), repeated("...#########..", 2));
  // Columns four high have V nowhere.
  EXPECT_EQ(bench.run(picture(repeated("aaabbbaaabbb", 4))), repeated("............", 4));
}

TEST_P(ByHand, AThirdColourCountsInItsWindowAlone) {
  GuardBench bench(guarded(GetParam()));
  // Five pixels away it is inside, six it is not.
  EXPECT_EQ(bench.run(picture({"ababababababababc", "babababababababab"})),
            repeated("###########......", 2));
  EXPECT_EQ(bench.run(picture({"cbabababababababa", "babababababababab"})),
            repeated("......###########", 2));
  Rows tall;
  for (int y = 0; y < 17; ++y) tall.emplace_back(y % 2 == 0 ? "ab" : "ba");
  tall[16] = "ca";
  Rows guarded_rows = repeated("##", 11);
  guarded_rows.insert(guarded_rows.end(), 6, "..");
  EXPECT_EQ(bench.run(picture(tall)), guarded_rows);
  tall[16] = "ab";
  tall[0] = "ac";
  guarded_rows = repeated("..", 6);
  guarded_rows.insert(guarded_rows.end(), 11, "##");
  EXPECT_EQ(bench.run(picture(tall)), guarded_rows);
}

TEST_P(ByHand, OneColourIsNotAndFlatPixelsBesideStrokesAre) {
  GuardBench bench(guarded(GetParam()));
  EXPECT_EQ(bench.run(picture(repeated("aaa", 3))), repeated("...", 3));
  EXPECT_EQ(bench.run(picture({"a"})), repeated(".", 1));
  // Strokes both ways in the first row, and of the second one b down; none below them.
  Rows rows = {"abababab", "babababa"}, expected = repeated(".######.", 6);
  rows.insert(rows.end(), 6, "aaaaaaaa");
  expected.insert(expected.end(), 2, "........");
  EXPECT_EQ(bench.run(picture(rows)), expected);
}

// Rows of the contract's drawings.
Rows split(std::string_view text) {
  Rows rows(1);
  for (const char c : text) {
    if (c == ' ')
      rows.emplace_back();
    else
      rows.back() += c;
  }
  return rows;
}
Rows transposed(const Rows& rows) {
  Rows other(rows[0].size());
  for (const std::string& row : rows)
    for (std::size_t x = 0; x < row.size(); ++x) other[x] += row[x];
  return other;
}
Frame drawing(const Rows& rows) {
  return draw(static_cast<int>(rows[0].size()), static_cast<int>(rows.size()), [&](int x, int y) {
    const char letter = rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
    return letter == '.'   ? Rgba8{250, 240, 230, 255}
           : letter == '#' ? Rgba8{30, 50, 70, 255}
                           : grey(128);
  });
}
TEST_P(ByHand, DrawingsOfTheContract) {
  GuardBench bench(guarded(GetParam()));
  for (const spec::morphological::GuardVector& v : spec::morphological::kGuardVectors) {
    Rows expected = split(v.guarded);
    for (std::string& row : expected)
      for (char& c : row) c = c == 'g' ? '#' : '.';
    EXPECT_EQ(bench.run(drawing(split(v.rows))), expected) << v.name;
    EXPECT_EQ(by_contract(drawing(split(v.rows))), expected) << v.name;
    EXPECT_EQ(bench.run(drawing(transposed(split(v.rows)))), transposed(expected)) << v.name;
  }
}

// Stretches of two colours; at times a third one, or one that passes for the first.
Frame text(int width, int height, std::uint64_t seed) {
  Random random(seed);
  const std::uint32_t weight = random.between(100, 900), other = random.below(3);
  const auto any = [&] {
    const std::uint32_t word = random.word();
    return Rgba8{static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8),
                 static_cast<std::uint8_t>(word >> 16), 255};
  };
  const Rgba8 ink = any(), paper = any();
  Rgba8 third = any();
  while (other == 1 && hash_of(third) != hash_of(ink)) third = any();
  std::uint32_t word = 0;
  return draw(width, height, [&](int x, int) {
    if (x == 0 || random.chance(weight)) word = random.word();
    if (other != 2 && random.below(400) == 0) return third;
    return (word & 1) != 0 ? ink : paper;
  });
}

struct Size {
  int width, height;
};
void PrintTo(const Size& size, std::ostream* out) { *out << size.width << 'x' << size.height; }
class AnyPicture : public ::testing::TestWithParam<std::tuple<Size, int>> {};

TEST_P(AnyPicture, IsAsTheContractSays) {
  const auto& [size, lanes_code] = GetParam();
  Parameters p = guarded(lanes_code);
  p.line_pixels = std::max(size.width, 1);
  GuardBench bench(p);
  std::size_t found = 0, pixels = 0;
  const int frames = size.width * size.height > 5000 ? 2 : 12;
  for (int seed = 1; seed <= frames; ++seed) {
    const Frame frame = text(size.width, size.height, static_cast<std::uint64_t>(seed));
    const Rows expected = by_contract(frame);
    ASSERT_EQ(bench.run(frame), expected) << "picture " << seed;
    for (const std::string& row : expected)
      found += static_cast<std::size_t>(std::count(row.begin(), row.end(), '#'));
    pixels += frame.pixel.size();
  }
  EXPECT_EQ(bench.guard.guarded_pixels.value(), found);
  if (size.width > 6 && size.height > 6) {
    EXPECT_GT(found, pixels / 10);
    EXPECT_LT(found, pixels);
  }
  EXPECT_EQ(stalls(bench.guard, "downstream"), 0u);
}
INSTANTIATE_TEST_SUITE_P(
    Sizes, AnyPicture,
    ::testing::Combine(::testing::Values(Size{1, 1}, Size{2, 1}, Size{1, 2}, Size{3, 200},
                                         Size{200, 3}, Size{5, 30}, Size{9, 17}, Size{23, 23},
                                         Size{64, 20}, Size{kSanitized ? 320 : 1920, 14}),
                       ::testing::Range(0, 3)));

// On black every colour of one bit is another one, and those of two bits but where both bits are
// the same one of the hash.
TEST(TextGuardBlock, EachBitOfAColourIsInItsHash) {
  GuardBench bench(guarded(2));
  const Rows board = {"abab", "baba", "abab"};
  int guarded_boards = 0;
  for (unsigned first = 0; first < 24; ++first)
    for (unsigned second = first; second < 24; ++second) {
      const std::uint32_t bits = 1u << first | 1u << second;
      const Rgba8 ink = {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8),
                         static_cast<std::uint8_t>(bits >> 16), 255};
      const Frame frame = draw(4, 3, [&](int x, int y) {
        return board[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] == 'a' ? grey(0)
                                                                                      : ink;
      });
      const bool differs = hash_of(ink) != hash_of(grey(0));
      guarded_boards += differs;
      EXPECT_EQ(bench.run(frame), repeated(differs ? "####" : "....", 3)) << first << ' ' << second;
    }
  // In the bits of a hash are 4, 5, 4, 4, 4 and 3 of the colour's: so many pairs cancel.
  EXPECT_EQ(guarded_boards, 24 + 276 - (6 + 10 + 6 + 6 + 6 + 3));
}

// Frames of other sizes and pictures behind each other; nothing is left of the one before.
TEST(TextGuardBlock, KeepsNothingFromFrameToFrame) {
  GuardBench bench(guarded(1));
  for (const Size size : {Size{40, 30}, Size{7, 9}, Size{64, 12}, Size{3, 3}, Size{12, 40}}) {
    const Frame frame = text(size.width, size.height, static_cast<std::uint64_t>(size.width));
    EXPECT_EQ(bench.run(frame), by_contract(frame));
    EXPECT_EQ(bench.run(picture({"abab", "baba", "abab"})), repeated("####", 3));
  }
}

TEST(TextGuardBlock, AResetForgetsTheFrameInside) {
  const Frame before = text(20, 20, 5), after = text(21, 15, 6);
  const Rows expected = by_contract(after);
  // Strokes that are too few, unless some of before count.
  const Frame few = picture({"aba", "bab", "aba"});
  GuardBench bench(guarded());
  for (Cycle at = 3; at < 600; at += 7) {
    for (const Frame* const next : {&after, &few}) {
      bench.send(before, bench.clock.cycle());
      bench.clock.run(at);
      bench.reset();
      ASSERT_EQ(bench.run(*next), next == &after ? expected : repeated("...", 3)) << "after " << at;
      bench.reset();
    }
  }
}

// ---- cycles -------------------------------------------------------------------------------------

class TextGuardCycles : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Lanes, TextGuardCycles, ::testing::Range(0, 3));

// From the last beat of row 8 to the first beat of row 0, then a beat a clock.
TEST_P(TextGuardCycles, ARowComesEightRowsLater) {
  const Parameters p = guarded(GetParam());
  GuardBench bench(p);
  const Frame frame = text(40, 12, 1);
  bench.run(frame);
  const auto beats = static_cast<Cycle>(beats_a_row(frame, p));
  // Pushed from 0 on, popped from 1 on.
  const auto check = [&](const rtl::Datasheet& sheet) {
    expect_cycles(sheet, cycles_of(bench.gate), 9 * beats);
  };
  expect_notices_a_clock(TextGuard::datasheet(p), &rtl::Datasheet::latency, check);
  expect_notices_a_clock(TextGuard::datasheet(p), &rtl::Datasheet::interval, check);
  expect_stages_in_order(TextGuard::datasheet(p));
}

// A row whose last beat comes later is later by as much, and one that has begun is not: its last
// beats need no beat of the next row.
TEST_P(TextGuardCycles, ARowWaitsForItsLastBeatAndForNoneAfter) {
  const Parameters p = guarded(GetParam());
  const Frame frame = text(40, 12, 1);
  const auto beats = static_cast<std::size_t>(beats_a_row(frame, p));
  const auto latency = TextGuard::datasheet(p).latency.cycles;
  GuardBench bench(p);
  for (const std::size_t held : {9 * beats - 1, 9 * beats, 9 * beats + 1}) {
    bench.reset();
    const Cycle begin = bench.clock.cycle();
    bench.send(frame, begin);
    bench.source.delay(held, begin + 2000);  // pushed; popped a clock later
    ASSERT_EQ(bench.finish(), by_contract(frame));
    const Cycle first = begin + (held < 9 * beats ? 2001 : 9 * beats) + latency,
                second = begin + 2000 + 10 * beats - held + latency;
    for (std::size_t beat = 0; beat < beats; ++beat) {
      ASSERT_EQ(bench.gate.taken[beat].cycle, first + beat) << held;
      // Of the row after it, whose last beat is late in any case.
      ASSERT_EQ(bench.gate.taken[beats + beat].cycle, second + beat) << held;
    }
  }
}

// Nobody takes the bits: the unit stops when the FIFO is full, and nothing is lost.
TEST_P(TextGuardCycles, WaitsDownstream) {
  const Parameters p = guarded(GetParam());
  const Frame frame = text(60, 40, 2);
  GuardBench bench(p, 3000);
  bench.send(frame);
  EXPECT_EQ(bench.finish(), by_contract(frame));
  EXPECT_GT(stalls(bench.guard, "downstream"), 100u);
  for (std::size_t i = 0; i < bench.gate.taken.size(); ++i)
    ASSERT_EQ(bench.gate.taken[i].cycle, 3000 + i) << "a beat a clock";
}

// ---- in the engine ------------------------------------------------------------------------------

struct Build {
  Preset preset;
  int search_rows;
  const char* settings;
};
void PrintTo(const Build& b, std::ostream* out) {
  *out << spec::morphological::kPresetNames[static_cast<std::size_t>(b.preset)] << " R "
       << b.search_rows << ' ' << b.settings;
}
Parameters of(const Build& b) {
  Parameters p = preset(b.preset, b.search_rows, 20);
  p.steps = std::min(p.steps, 2);
  p.diagonal_steps = std::min(p.diagonal_steps, 4);
  p.line_pixels = 128;
  apply_settings(p, b.settings);
  p.text_guard = true;
  return p;
}

class TextGuardEngine : public ::testing::TestWithParam<Build> {};
INSTANTIATE_TEST_SUITE_P(
    Builds, TextGuardEngine,
    ::testing::Values(Build{Preset::kMlaa, 4, ""}, Build{Preset::kMlaa, 4, "lanes=2"},
                      Build{Preset::kMlaa, 4, "lanes=4"}, Build{Preset::kDeburr, 5, ""},
                      Build{Preset::kDeburr, 8, "lanes=4"},
                      Build{Preset::kDeburrLine, 32, "lanes=2"},
                      Build{Preset::kSmaa, 16, "lanes=4"}, Build{Preset::kSmaa, 8, ""},
                      Build{Preset::kMlaa, 4, "storage=memory"},
                      Build{Preset::kDeburr, 8, "storage=memory lanes=4"}));

// What a frame gives, and when.
struct Result {
  std::vector<spec::morphological::BlendedBeat> beats;
  std::vector<Cycle> taken, delivered;
  spec::morphological::Work work;
};
Result result_of(EngineBench& bench, const Frame& frame, bool on) {
  const std::uint32_t configuration =
      spec::morphological::configuration_word(bench.engine.parameters());
  bench.bus.write(spec::morphological::reg::kConfiguration,
                  on ? configuration : configuration & ~(1u << 28));
  Result result;
  const Cycle begin = bench.clock.cycle();
  const Monitor<spec::morphological::PixelBeat> in(
      bench.clock, bench.in, {},
      [&](Cycle c, const spec::morphological::PixelBeat&) { result.taken.push_back(c - begin); });
  const std::size_t from = bench.sink.beats().size();
  bench.run(frame);
  result.beats.assign(bench.sink.beats().begin() + static_cast<std::ptrdiff_t>(from),
                      bench.sink.beats().end());
  for (std::size_t i = from; i < bench.sink.cycles().size(); ++i)
    result.delivered.push_back(bench.sink.cycles()[i] - begin);
  result.work = bench.engine.work();
  return result;
}

// Text on the left, a scene on the right.
Frame page(int width, int height) {
  Frame frame = text(width, height, 3);
  const Frame scene = line(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = width * 2 / 3; x < width; ++x) frame.at(x, y) = scene.at(x, y);
  return frame;
}

TEST_P(TextGuardEngine, LeavesWhatIsGuardedAndNothingElse) {
  const Parameters p = of(GetParam());
  const std::size_t lanes = static_cast<std::size_t>(lanes_of(p));
  EngineBench on_bench(p);
  for (const auto& [width, height] : {std::pair{97, 40}, {1, 1}, {3, 60}, {110, 3}, {4, 30}}) {
    const Frame frame = page(width, height);
    const std::uint64_t left_before = on_bench.engine.work().bypassed_pixels,
                        blended_before = on_bench.engine.work().blended_pixels;
    const Result off = result_of(on_bench, frame, false);
    EXPECT_EQ(off.work.bypassed_pixels, left_before) << "off by its bit";
    const Result on = result_of(on_bench, frame, true);
    const Rows guarded_pixels = by_contract(frame);
    const auto beats = static_cast<std::size_t>(beats_a_row(frame, p));
    ASSERT_EQ(on.beats.size(), beats * static_cast<std::size_t>(height));
    std::uint64_t left = 0, blended = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const std::size_t at = static_cast<std::size_t>(y) * beats +
                               static_cast<std::size_t>(x) / lanes,
                          lane = static_cast<std::size_t>(x) % lanes;
        auto probe = off.beats[at].probe[lane];
        Rgba8 pixel = off.beats[at].pixel[lane];
        const bool had_one = probe.first + probe.second != 0;
        if (guarded_pixels[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] == '#') {
          left += had_one;
          pixel = frame.at(x, y);
          probe.first = probe.second = 0;
          probe.horizontal = false;
        } else {
          blended += had_one;
        }
        const auto& got = on.beats[at].probe[lane];
        ASSERT_EQ(on.beats[at].pixel[lane], pixel) << x << ", " << y;
        ASSERT_EQ(got.first, probe.first) << x << ", " << y;
        ASSERT_EQ(got.second, probe.second) << x << ", " << y;
        ASSERT_EQ(got.horizontal, probe.horizontal) << x << ", " << y;
        ASSERT_EQ(got.edges, probe.edges) << x << ", " << y;
      }
    EXPECT_EQ(on.work.bypassed_pixels, left_before + left);
    EXPECT_EQ(on.work.blended_pixels - off.work.blended_pixels, blended);
    EXPECT_EQ(off.work.blended_pixels - blended_before, left + blended);
    if (width == 97) {
      EXPECT_GT(left, 50u);
      EXPECT_GT(blended, 5u);
    }
  }
}

std::string text_of(const std::vector<Cycle>& cycles) {
  std::string text;
  for (const Cycle cycle : cycles) text += std::to_string(cycle) + ' ';
  return text;
}

// As it was without: each beat is taken and delivered in its clock, whatever waits.
TEST_P(TextGuardEngine, NothingWaitsForItAnyClock) {
  const Parameters p = of(GetParam());
  Parameters without = p;
  without.text_guard = false;
  for (const std::uint32_t source : {0u, 300u, 900u})
    for (const std::uint32_t sink : {0u, 300u, 900u}) {
      if (kSanitized && source != sink) continue;
      EngineBench::Options options;
      options.driver.stall_permille = source;
      options.sink.stall_permille = sink;
      for (const auto& [width, height] : {std::pair{61, 20}, {1, 25}, {3, 30}, {7, 1}, {16, 12}}) {
        const Frame frame = page(width, height);
        const int line_pixels = width,
                  fewest = p.storage == spec::morphological::Storage::kMemory ? 17 : 1;
        const auto cycles = [&](const Parameters& q) {
          return forked_text([&] {
            Parameters as_wide = q;  // so that the FIFO has no word more
            as_wide.line_pixels = std::max(line_pixels, fewest);
            EngineBench bench(as_wide, options);
            const Result result = result_of(bench, frame, q.text_guard);
            if (q.text_guard) {
              EXPECT_EQ(stalls(*bench.engine.text_guard, "downstream"), 0u);
            }
            return text_of(result.taken) + "| " + text_of(result.delivered);
          });
        };
        ASSERT_EQ(cycles(p), cycles(without)) << width << "x" << height << " stalls of the source "
                                              << source << ", of the sink " << sink;
      }
    }
}

// A source that stops in the middle of a row: what has come suffices for each beat as before.
TEST_P(TextGuardEngine, ASourceThatStopsHoldsNoOtherBeatAnyClock) {
  const Parameters p = of(GetParam());
  Parameters without = p;
  without.text_guard = false;
  const Frame frame = page(32, 60);
  const auto row = static_cast<std::size_t>(beats_a_row(frame, p));
  // Slots before the first one that delivers.
  const std::size_t before = static_cast<std::size_t>(GetParam().search_rows + 5) * row;
  for (const std::size_t more :
       {std::size_t{1}, row / 2, row - 1, row, row + 1, 3 * row + row / 2, 4 * row - 1}) {
    const std::size_t stop = before + more;
    const auto delivered = [&](const Parameters& q) {
      return forked_text([&] {
        EngineBench bench(q);
        const auto beats = beats_of(frame, lanes_of(q));
        bench.software.set_size(frame.width, frame.height);
        bench.driver.send({beats.begin(), beats.begin() + static_cast<std::ptrdiff_t>(stop)});
        bench.clock.run(3000);
        return text_of(bench.sink.cycles());
      });
    };
    const std::string expected = delivered(without);
    ASSERT_EQ(std::count(expected.begin(), expected.end(), ' '), static_cast<std::ptrdiff_t>(more));
    ASSERT_EQ(delivered(p), expected) << more;
  }
}

// Stalls at each link, and what nobody wrote is noise.
TEST_P(TextGuardEngine, StallsAndPoisonChangeNoPixel) {
  const Parameters p = of(GetParam());
  const Frame frame = page(61, 30);
  const auto hash_with = [&](const EngineBench::Options& options) {
    return forked<std::uint64_t>([&] {
      EngineBench bench(p, options);
      return hash(bench.run(frame));
    });
  };
  const std::uint64_t expected = hash_with({});
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    EngineBench::Options options;
    options.bench.stall_permille = 200;
    options.bench.seed = seed;
    options.bench.poison = true;
    options.bench.check_widths = true;
    options.bench.shuffle = seed;
    EXPECT_EQ(hash_with(options), expected) << seed;
  }
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::text_guard_test
