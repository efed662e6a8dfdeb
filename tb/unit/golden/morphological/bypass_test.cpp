// SPDX-License-Identifier: MIT
// Are marked pixels, and with `beside` those next to one, left as they are, everything else
// smoothed as ever, and the marks gone? One by one, and against a reference that knows nothing of
// the golden but its frame without the rule.
#include <gmock/gmock.h>

#include <cstdlib>
#include <set>
#include <string>

#include "tb/base/random.h"
#include "tb/unit/golden/morphological/support.h"

namespace deburr::bypass_test {
namespace {

using golden::morphological::CoverageBin;
using golden::morphological::MorphologicalGolden;
using golden::morphological::preset_parameters;
using spec::morphological::BlendProbe;
using spec::morphological::Bypass;
using spec::morphological::Parameters;
using spec::morphological::Preset;
using spec::morphological::Rgba8;
using tb::Random;
using tb::morphological::Frame;
using tb::morphological::grey;

constexpr Preset kAll[] = {Preset::kMlaa, Preset::kMlaaSlope, Preset::kSmaa, Preset::kSmaaDynamic,
                           Preset::kDeburrLine};

// Marks one pixel in `rare`; other bits of alpha are random.
Frame marked(Frame frame, Random& random, unsigned rare) {
  for (Rgba8& pixel : frame.pixels) {
    const bool mark = random.below(rare) == 0;
    pixel[3] = static_cast<std::uint8_t>((random.below(128) << 1) | (mark ? 0 : 1));
  }
  return frame;
}

bool has_mark(const Frame& frame, int x, int y) {
  return x >= 0 && y >= 0 && x < frame.width && y < frame.height && frame.at(x, y)[3] % 2 == 0;
}

bool asked_to_leave(const Frame& frame, Bypass bypass, int x, int y) {
  if (bypass == Bypass::kNone) return false;
  const bool beside = has_mark(frame, x - 1, y) || has_mark(frame, x + 1, y) ||
                      has_mark(frame, x, y - 1) || has_mark(frame, x, y + 1);
  return has_mark(frame, x, y) || (bypass == Bypass::kBeside && beside);
}

Rgba8 mix(const Parameters& p, const Frame& frame, int x, int y, const BlendProbe& probe) {
  const int dx = probe.horizontal ? 1 : 0, dy = probe.horizontal ? 0 : 1;
  const Rgba8& own = frame.at(x, y);
  const bool strongest = p.blend == spec::morphological::BlendRule::kStrongest;
  return golden::morphological::blend(p.linear_light, own,
                                      probe.first != 0 ? frame.at(x - dx, y - dy) : own,
                                      probe.second != 0 ? frame.at(x + dx, y + dy) : own,
                                      strongest ? golden::morphological::mixed_by_squares(probe)
                                                : golden::morphological::unmixed(probe));
}

// The frame that the engine without the rule makes, with the pixels that are left put back, and
// those with half a weight mixed again.
void expect_as_put_back(Parameters p, const Frame& frame) {
  p.bypass = Bypass::kNone;
  MorphologicalGolden plain(p);
  plain.process(frame.view());
  for (const Bypass bypass : {Bypass::kMarked, Bypass::kBeside, Bypass::kHalf}) {
    p.bypass = bypass;
    MorphologicalGolden golden(p);
    golden.process(frame.view());
    spec::morphological::Work work = plain.work();
    for (int y = 0; y < frame.height; ++y) {
      for (int x = 0; x < frame.width; ++x) {
        const auto i = static_cast<std::size_t>(y * frame.width + x);
        BlendProbe probe = plain.probes()[i];
        const bool had = (probe.first | probe.second) != 0;
        const int dx = probe.horizontal ? 1 : 0, dy = probe.horizontal ? 0 : 1;
        if (bypass == Bypass::kHalf) {
          if (has_mark(frame, x - dx, y - dy)) probe.first /= 2;
          if (has_mark(frame, x + dx, y + dy)) probe.second /= 2;
        }
        const bool takes =
            (probe.first | probe.second) != 0 && !asked_to_leave(frame, bypass, x, y);
        if (had && !takes) {
          --work.blended_pixels;
          ++work.bypassed_pixels;
        }
        if (!takes) probe = {false, 0, 0, probe.edges};
        Rgba8 pixel = takes ? mix(p, frame, x, y, probe) : frame.pixels[i];
        pixel[3] = static_cast<std::uint8_t>(frame.pixels[i][3] | 1);
        ASSERT_EQ(golden.pixels()[i], pixel) << x << ' ' << y;
        ASSERT_EQ(golden.probes()[i], probe) << x << ' ' << y;
      }
    }
    EXPECT_EQ(golden.work(), work);
    EXPECT_EQ(golden.decisions(), plain.decisions());
  }
}

TEST(Bypass, PutsBackWhatIsMarked) {
  Random random(5);
  for (const Preset preset : kAll) {
    for (const unsigned rare : {1u, 2u, 6u, 40u, 1000000u}) {
      expect_as_put_back(preset_parameters(preset),
                         marked(tb::morphological::rendered_like(131, 70, 60), random, rare));
    }
    expect_as_put_back(preset_parameters(preset),
                       marked(tb::morphological::noise_image(), random, 9));
  }
}

TEST(Bypass, PutsBackInNarrowFrames) {
  Random random(6);
  for (const auto& [w, h] : {std::pair(1, 50), {50, 1}, {2, 40}, {40, 2}, {64, 5}, {65, 5}}) {
    const Frame blocks(w, h, [&](int, int) { return grey(random.below(2) == 0 ? 10 : 220); });
    for (const Preset preset : kAll)
      expect_as_put_back(preset_parameters(preset), marked(blocks, random, 8));
  }
}

// A step of 40 columns: every pixel of rows 3 and 4 but those in the middle has a weight.
Frame step() {
  return {40, 8, [](int x, int y) { return grey(y < (x < 20 ? 4 : 5) ? 230 : 20); }};
}

// One mark at a place leaves that pixel, and with `beside` its four neighbours.
TEST(Bypass, LooksAtFivePlaces) {
  Parameters p = preset_parameters(Preset::kMlaa);
  const Frame plain = step();
  const Frame smoothed = smooth(p, plain);
  ASSERT_NE(smoothed.at(12, 4), plain.at(12, 4));
  struct Case {
    int dx, dy;
    bool left_by_mark, left_beside;
  };
  for (const Case& c :
       {Case{0, 0, true, true}, Case{-1, 0, false, true}, Case{1, 0, false, true},
        Case{0, -1, false, true}, Case{0, 1, false, true}, Case{-1, -1, false, false},
        Case{1, 1, false, false}, Case{2, 0, false, false}, Case{0, -2, false, false}}) {
    Frame frame = plain;
    frame.at(12 + c.dx, 4 + c.dy)[3] = 254;
    for (const Bypass bypass : {Bypass::kNone, Bypass::kMarked, Bypass::kBeside}) {
      p.bypass = bypass;
      const bool left = bypass == Bypass::kMarked   ? c.left_by_mark
                        : bypass == Bypass::kBeside ? c.left_beside
                                                    : false;
      const Frame output = smooth(p, frame);
      EXPECT_EQ(output.at(12, 4)[0], (left ? plain : smoothed).at(12, 4)[0]) << c.dx << ' ' << c.dy;
      // The mark stays with `none` and ends with the others.
      EXPECT_EQ(output.at(12 + c.dx, 4 + c.dy)[3], bypass == Bypass::kNone ? 254 : 255);
    }
  }
}

// The last pixel of a row and the first of the next are no neighbours, nor are the first and the
// last row.
TEST(Bypass, HasRulesAtTheBorders) {
  Parameters p = preset_parameters(Preset::kMlaa);
  p.bypass = Bypass::kBeside;
  constexpr int kLast = 29;
  const Frame diamond(kLast + 1, kLast + 1, [](int x, int y) {
    return grey(std::abs(2 * x - kLast) + std::abs(2 * y - kLast) < 40 ? 230 : 20);
  });
  const Frame expected = smooth(p, diamond);
  int tried = 0;
  const auto stays_blended = [&](int x, int y, int marked_x, int marked_y) {
    if (expected.at(x, y) == diamond.at(x, y)) return;
    Frame frame = diamond;
    frame.at(marked_x, marked_y)[3] = 0;
    EXPECT_EQ(smooth(p, frame).at(x, y), expected.at(x, y)) << x << ' ' << y;
    ++tried;
  };
  for (int i = 0; i <= kLast; ++i) {
    if (i > 0) stays_blended(0, i, kLast, i - 1);
    if (i < kLast) stays_blended(kLast, i, 0, i + 1);
    stays_blended(0, i, kLast, i);
    stays_blended(kLast, i, 0, i);
    stays_blended(i, 0, i, kLast);
    stays_blended(i, kLast, i, 0);
  }
  EXPECT_GE(tried, 12);
}

// Weights are halved before they are mixed by their squares: of 60 and 100 with the first neighbour
// marked, 30 and 100 remain, which become 900 / 130 and 10000 / 130.
TEST(Bypass, HalvesBeforeSquares) {
  using golden::morphological::mixed_by_squares;
  using golden::morphological::remaining;
  constexpr golden::morphological::Marks kUp = 2, kLeft = 4, kRight = 8, kDown = 16;
  const BlendProbe vertical{false, 60, 100, 0}, horizontal{true, 60, 100, 0};
  EXPECT_EQ(remaining(Bypass::kHalf, kUp, vertical), (BlendProbe{false, 30, 100, 0}));
  EXPECT_EQ(remaining(Bypass::kHalf, kDown, vertical), (BlendProbe{false, 60, 50, 0}));
  EXPECT_EQ(remaining(Bypass::kHalf, kLeft | kRight, vertical), vertical);
  EXPECT_EQ(remaining(Bypass::kHalf, kLeft, horizontal), (BlendProbe{true, 30, 100, 0}));
  EXPECT_EQ(remaining(Bypass::kHalf, kUp | kRight, horizontal), (BlendProbe{true, 60, 50, 0}));
  EXPECT_EQ(mixed_by_squares(remaining(Bypass::kHalf, kUp, vertical)),
            (golden::morphological::Weights{111, 1231}));
  EXPECT_EQ(remaining(Bypass::kHalf, kRight, BlendProbe{true, 0, 1, 0}), BlendProbe{});
  EXPECT_EQ(remaining(Bypass::kMarked, kUp, vertical), vertical);

  // In a frame: SMAA's diagonals give pixels two weights.
  Parameters p = preset_parameters(Preset::kSmaa);
  Random random(8);
  const Frame frame = marked(tb::morphological::noise_image(), random, 3);
  MorphologicalGolden plain(p);
  plain.process(frame.view());
  p.bypass = Bypass::kHalf;
  MorphologicalGolden golden(p);
  golden.process(frame.view());
  int two = 0;
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const auto i = static_cast<std::size_t>(y * frame.width + x);
      const BlendProbe before = plain.probes()[i], probe = golden.probes()[i];
      const int dx = before.horizontal ? 1 : 0, dy = before.horizontal ? 0 : 1;
      const bool first = has_mark(frame, x - dx, y - dy), second = has_mark(frame, x + dx, y + dy);
      if (has_mark(frame, x, y)) {
        EXPECT_EQ(probe.first | probe.second, 0);
      } else if (before.first != 0 && before.second != 0 && first && !second) {
        EXPECT_EQ(probe.first, before.first / 2);
        EXPECT_EQ(probe.second, before.second);
        ++two;
      }
    }
  }
  EXPECT_GT(two, 10);
}

// A marked pixel is as good a neighbour as any: what lies across from it takes its weight of it.
TEST(Bypass, MarkedPixelsAreNeighbours) {
  Parameters p = preset_parameters(Preset::kMlaa);
  p.bypass = Bypass::kMarked;
  Frame frame = step();
  for (int x = 0; x < 40; ++x) frame.at(x, 3)[3] = 0;
  const Frame without = smooth(p, step()), with = smooth(p, frame);
  for (int x = 0; x < 40; ++x) {
    EXPECT_EQ(with.at(x, 4), without.at(x, 4));
    EXPECT_EQ(with.at(x, 3)[0], frame.at(x, 3)[0]);
  }
}

// A line that memory does not give back is zeros, alpha too, so its pixels are marked.
TEST(Bypass, LinesThatCannotBeReadAreMarked) {
  Parameters p = preset_parameters(Preset::kMlaa);
  p.storage = spec::morphological::Storage::kMemory;
  p.bypass = Bypass::kBeside;
  const Frame frame = step();  // rows of 192 bytes, lines of 16 pixels
  MorphologicalGolden golden(p);
  golden.set_read_errors([](std::uint32_t address) { return address == 4 * 192; });
  golden.process(frame.view());
  for (int x = 0; x < 16; ++x) {
    EXPECT_EQ(golden.pixels()[static_cast<std::size_t>(4 * 40 + x)], (Rgba8{0, 0, 0, 1}));
    EXPECT_EQ(golden.pixels()[static_cast<std::size_t>(3 * 40 + x)], frame.at(x, 3));
  }
  EXPECT_GT(golden.work().bypassed_pixels, 5u);
  EXPECT_GT(golden.work().blended_pixels, 0u);
}

// Pixels that are left have had their decision; those without one are the rest of the frame.
TEST(BypassCoverage, DecisionsAreOfEveryPixelOnce) {
  Random random(3);
  Parameters p = preset_parameters(Preset::kDeburrLine);
  p.bypass = Bypass::kBeside;
  MorphologicalGolden golden(p);
  golden.process(marked(tb::morphological::rendered_like(120, 90, 80), random, 20).view());
  EXPECT_GT(golden.work().bypassed_pixels, 10u);
  std::uint64_t sum = 0;
  for (const CoverageBin& bin : golden.coverage().bins())
    if (bin.name.starts_with("decision/")) sum += bin.hits;
  EXPECT_EQ(sum, golden.work().pixels);
}

TEST(BypassCoverage, EveryBinCanBeReached) {
  Random random(9);
  const auto with = [](Bypass bypass) {
    Parameters p = preset_parameters(Preset::kDeburrLine);
    p.bypass = bypass;
    return MorphologicalGolden(p);
  };
  MorphologicalGolden by_mark = with(Bypass::kMarked), beside = with(Bypass::kBeside),
                      half = with(Bypass::kHalf);
  for (int i = 0; i < 4; ++i) {
    const Frame frame = marked(tb::morphological::rendered_like(120, 90, 80), random, 20);
    for (MorphologicalGolden* golden : {&by_mark, &beside, &half}) golden->process(frame.view());
  }
  const auto hit = [](const MorphologicalGolden& golden) {
    std::set<std::string> names;
    for (const CoverageBin& bin : golden.bypass_coverage().bins())
      if (bin.hits != 0) names.insert(bin.name);
    return names;
  };
  EXPECT_THAT(hit(by_mark), testing::ElementsAre("left/marked/own"));
  EXPECT_THAT(hit(half), testing::UnorderedElementsAre("left/half/own", "half/up", "half/left",
                                                       "half/right", "half/down", "half/nothing"));
  std::set<std::string> all = hit(beside);
  EXPECT_EQ(all.size(), 6u + 4 * 2);
  all.merge(hit(by_mark));
  all.merge(hit(half));
  EXPECT_EQ(all.size(), beside.bypass_coverage().bins().size());
  beside.clear_coverage();
  EXPECT_THAT(hit(beside), testing::IsEmpty());
}

// One pixel of a frame of 5 x 4 with these marks; (2, 1) lies on no border.
std::set<std::string> counted(Bypass bypass, unsigned marks, const BlendProbe& probe, int x = 2,
                              int y = 1) {
  const Frame frame(5, 4, [](int, int) { return grey(1); });
  golden::morphological::BypassCoverage coverage;
  coverage.count_pixel(bypass, static_cast<golden::morphological::Marks>(marks), probe,
                       frame.view(), x, y);
  std::set<std::string> names;
  for (const CoverageBin& bin : coverage.bins()) {
    EXPECT_LE(bin.hits, 1u);
    if (bin.hits != 0) names.insert(bin.name);
  }
  return names;
}
using Names = std::set<std::string>;
constexpr unsigned kOwn = 1, kUp = 2, kBesideLeft = 4, kBesideRight = 8, kDown = 16;

TEST(BypassCoverage, WithoutARuleNothingCounts) {
  for (const Bypass bypass : {Bypass::kNone, Bypass::kMasked})
    for (const unsigned marks : {0u, kOwn, kUp, 31u})
      EXPECT_EQ(counted(bypass, marks, {false, 60, 100}), Names{});
}

TEST(BypassCoverage, OwnMarksAreOfTheirRule) {
  EXPECT_EQ(counted(Bypass::kMarked, kOwn, {false, 60, 100}), Names{"left/marked/own"});
  EXPECT_EQ(counted(Bypass::kMarked, 0, {false, 60, 100}), Names{});
  EXPECT_EQ(counted(Bypass::kHalf, kOwn, {false, 60, 100}), Names{"left/half/own"});
  EXPECT_EQ(counted(Bypass::kHalf, kOwn | kUp, {false, 60, 100}), Names{"left/half/own"});
}

TEST(BypassCoverage, NeighboursThatGiveHalfAreThoseOfTheTap) {
  const BlendProbe vertical{false, 60, 100}, horizontal{true, 60, 100};
  EXPECT_EQ(counted(Bypass::kHalf, 0, vertical), Names{});
  EXPECT_EQ(counted(Bypass::kHalf, kUp, vertical), Names{"half/up"});
  EXPECT_EQ(counted(Bypass::kHalf, kDown, vertical), Names{"half/down"});
  EXPECT_EQ(counted(Bypass::kHalf, kUp | kDown, vertical), (Names{"half/up", "half/down"}));
  EXPECT_EQ(counted(Bypass::kHalf, kBesideLeft | kBesideRight, vertical), Names{});
  EXPECT_EQ(counted(Bypass::kHalf, kBesideLeft, horizontal), Names{"half/left"});
  EXPECT_EQ(counted(Bypass::kHalf, kBesideRight, horizontal), Names{"half/right"});
  EXPECT_EQ(counted(Bypass::kHalf, kUp | kDown, horizontal), Names{});
  // What takes no weight cannot give half of it.
  EXPECT_EQ(counted(Bypass::kHalf, kUp, {false, 0, 100}), Names{});
  EXPECT_EQ(counted(Bypass::kHalf, kDown, {false, 60, 0}), Names{});
  // Half of one is nothing, half of two is one.
  EXPECT_EQ(counted(Bypass::kHalf, kUp, {false, 1, 0}), (Names{"half/up", "half/nothing"}));
  EXPECT_EQ(counted(Bypass::kHalf, kDown, {false, 0, 1}), (Names{"half/down", "half/nothing"}));
  EXPECT_EQ(counted(Bypass::kHalf, kUp, {false, 2, 0}), Names{"half/up"});
  EXPECT_EQ(counted(Bypass::kHalf, kUp, {false, 1, 1}), Names{"half/up"});
}

TEST(BypassCoverage, BesideNamesTheOnePlaceOrSeveral) {
  const BlendProbe probe{false, 60, 100};
  EXPECT_EQ(counted(Bypass::kBeside, 0, probe), Names{});
  EXPECT_EQ(counted(Bypass::kBeside, kOwn, probe), Names{"left/beside/own"});
  EXPECT_EQ(counted(Bypass::kBeside, kUp, probe), Names{"left/beside/up"});
  EXPECT_EQ(counted(Bypass::kBeside, kBesideLeft, probe), Names{"left/beside/left"});
  EXPECT_EQ(counted(Bypass::kBeside, kBesideRight, probe), Names{"left/beside/right"});
  EXPECT_EQ(counted(Bypass::kBeside, kDown, probe), Names{"left/beside/down"});
  EXPECT_EQ(counted(Bypass::kBeside, kOwn | kUp, probe), Names{"left/beside/several"});
  EXPECT_EQ(counted(Bypass::kBeside, 31, probe), Names{"left/beside/several"});
}

TEST(BypassCoverage, BordersAreThoseThatThePixelLiesOn) {
  const auto borders = [](int x, int y, bool left) {
    Names names = counted(Bypass::kBeside, left ? kOwn : 0, {false, 60, 100}, x, y);
    EXPECT_EQ(names.erase("left/beside/own"), left ? 1u : 0u);
    return names;
  };
  for (const bool left : {false, true}) {
    const std::string what = left ? "/left" : "/blended";
    EXPECT_EQ(borders(1, 1, left), Names{});
    EXPECT_EQ(borders(3, 2, left), Names{});
    EXPECT_EQ(borders(2, 0, left), Names{"border/top" + what});
    EXPECT_EQ(borders(0, 2, left), Names{"border/left" + what});
    EXPECT_EQ(borders(4, 2, left), Names{"border/right" + what});
    EXPECT_EQ(borders(2, 3, left), Names{"border/bottom" + what});
    EXPECT_EQ(borders(4, 3, left), (Names{"border/right" + what, "border/bottom" + what}));
    EXPECT_EQ(borders(0, 0, left), (Names{"border/left" + what, "border/top" + what}));
  }
}

}  // namespace
}  // namespace deburr::bypass_test
