// SPDX-License-Identifier: MIT
// Are marked pixels, and with `beside` those next to one, left as they are, everything else
// smoothed as ever, and the marks gone? One by one, and against a reference that knows nothing of
// the golden but its frame without the rule.
#include <gmock/gmock.h>

#include <cstdlib>
#include <set>
#include <string>

#include "tb/stimuli/random.h"
#include "tb/unit/golden/morphological/support.h"

namespace deburr {
namespace {

using golden::morphological::CoverageBin;
using golden::morphological::MorphologicalGolden;
using golden::morphological::preset_parameters;
using spec::morphological::BlendTap;
using spec::morphological::Leave;
using spec::morphological::Parameters;
using spec::morphological::Preset;
using spec::morphological::Rgba8;
using tb::Random;
using tb::morphological::Frame;
using tb::morphological::grey;

constexpr Preset kAll[] = {Preset::kMlaa, Preset::kMlaaSlope, Preset::kSmaa, Preset::kSmaaDynamic,
                           Preset::kDeburr};

// Marks one pixel in `rare`; other bits of alpha are random.
Frame marked(Frame frame, Random& random, unsigned rare) {
  for (Rgba8& pixel : frame.pixels) {
    const bool mark = random.below(rare) == 0;
    pixel[3] = static_cast<std::uint8_t>((random.below(128) << 1) | (mark ? 0 : 1));
  }
  return frame;
}

bool asked_to_leave(const Frame& frame, Leave leave, int x, int y) {
  const auto mark = [&](int at_x, int at_y) {
    return at_x >= 0 && at_y >= 0 && at_x < frame.width && at_y < frame.height &&
           frame.at(at_x, at_y)[3] % 2 == 0;
  };
  if (leave == Leave::kNone) return false;
  const bool beside = mark(x - 1, y) || mark(x + 1, y) || mark(x, y - 1) || mark(x, y + 1);
  return mark(x, y) || (leave == Leave::kBeside && beside);
}

// The frame that the engine without the rule makes, with the pixels that are left put back.
void expect_as_put_back(Parameters p, const Frame& frame) {
  p.leave = Leave::kNone;
  MorphologicalGolden plain(p);
  plain.process(frame.view());
  for (const Leave leave : {Leave::kMarked, Leave::kBeside}) {
    p.leave = leave;
    MorphologicalGolden golden(p);
    golden.process(frame.view());
    spec::morphological::Work work = plain.work();
    for (int y = 0; y < frame.height; ++y) {
      for (int x = 0; x < frame.width; ++x) {
        const auto i = static_cast<std::size_t>(y * frame.width + x);
        Rgba8 pixel = plain.pixels()[i];
        BlendTap tap = plain.taps()[i];
        if (asked_to_leave(frame, leave, x, y)) {
          pixel = frame.pixels[i];
          if ((tap.first | tap.second) != 0) {
            --work.blended_pixels;
            ++work.left_pixels;
          }
          tap = {false, 0, 0, tap.edges};
        }
        pixel[3] = static_cast<std::uint8_t>(frame.pixels[i][3] | 1);
        ASSERT_EQ(golden.pixels()[i], pixel) << x << ' ' << y;
        ASSERT_EQ(golden.taps()[i], tap) << x << ' ' << y;
      }
    }
    EXPECT_EQ(golden.work(), work);
    EXPECT_EQ(golden.decisions(), plain.decisions());
  }
}

TEST(Leave, PutsBackWhatIsMarked) {
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

TEST(Leave, PutsBackInNarrowFrames) {
  Random random(6);
  for (const auto& [w, h] : {std::pair(1, 50), {50, 1}, {2, 40}, {40, 2}, {64, 5}, {65, 5}}) {
    const Frame blocks(w, h, [&](int, int) { return grey(random.below(2) == 0 ? 10 : 220); });
    for (const Preset preset : kAll)
      expect_as_put_back(preset_parameters(preset), marked(blocks, random, 8));
  }
}

// A step of 40 columns: every pixel of rows 3 and 4 but those in the middle has a share.
Frame step() {
  return {40, 8, [](int x, int y) { return grey(y < (x < 20 ? 4 : 5) ? 230 : 20); }};
}

// One mark at a place leaves that pixel, and with `beside` its four neighbours.
TEST(Leave, LooksAtFivePlaces) {
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
    for (const Leave leave : {Leave::kNone, Leave::kMarked, Leave::kBeside}) {
      p.leave = leave;
      const bool left = leave == Leave::kMarked   ? c.left_by_mark
                        : leave == Leave::kBeside ? c.left_beside
                                                  : false;
      const Frame output = smooth(p, frame);
      EXPECT_EQ(output.at(12, 4)[0], (left ? plain : smoothed).at(12, 4)[0]) << c.dx << ' ' << c.dy;
      // The mark stays with `none` and ends with the others.
      EXPECT_EQ(output.at(12 + c.dx, 4 + c.dy)[3], leave == Leave::kNone ? 254 : 255);
    }
  }
}

// The last pixel of a row and the first of the next are no neighbours, nor are the first and the
// last row.
TEST(Leave, KnowsTheBorders) {
  Parameters p = preset_parameters(Preset::kMlaa);
  p.leave = Leave::kBeside;
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

// A marked pixel is as good a neighbour as any: what lies across from it takes its share of it.
TEST(Leave, MarkedPixelsAreNeighbours) {
  Parameters p = preset_parameters(Preset::kMlaa);
  p.leave = Leave::kMarked;
  Frame frame = step();
  for (int x = 0; x < 40; ++x) frame.at(x, 3)[3] = 0;
  const Frame without = smooth(p, step()), with = smooth(p, frame);
  for (int x = 0; x < 40; ++x) {
    EXPECT_EQ(with.at(x, 4), without.at(x, 4));
    EXPECT_EQ(with.at(x, 3)[0], frame.at(x, 3)[0]);
  }
}

// A line that memory does not give back is zeros, alpha too, so its pixels are marked.
TEST(Leave, LinesThatCannotBeReadAreMarked) {
  Parameters p = preset_parameters(Preset::kMlaa);
  p.storage = spec::morphological::Storage::kMemory;
  p.leave = Leave::kBeside;
  const Frame frame = step();  // rows of 192 bytes, lines of 16 pixels
  MorphologicalGolden golden(p);
  golden.set_read_errors([](std::uint32_t address) { return address == 4 * 192; });
  golden.process(frame.view());
  for (int x = 0; x < 16; ++x) {
    EXPECT_EQ(golden.pixels()[static_cast<std::size_t>(4 * 40 + x)], (Rgba8{0, 0, 0, 1}));
    EXPECT_EQ(golden.pixels()[static_cast<std::size_t>(3 * 40 + x)], frame.at(x, 3));
  }
  EXPECT_GT(golden.work().left_pixels, 5u);
  EXPECT_GT(golden.work().blended_pixels, 0u);
}

TEST(LeaveCoverage, EveryBinCanBeReached) {
  Random random(9);
  const auto with = [](Leave leave) {
    Parameters p = preset_parameters(Preset::kDeburr);
    p.leave = leave;
    return MorphologicalGolden(p);
  };
  MorphologicalGolden by_mark = with(Leave::kMarked), beside = with(Leave::kBeside);
  for (int i = 0; i < 4; ++i) {
    const Frame frame = marked(tb::morphological::rendered_like(120, 90, 80), random, 20);
    by_mark.process(frame.view());
    beside.process(frame.view());
  }
  const auto missed = [](const MorphologicalGolden& golden) {
    std::set<std::string> names;
    for (const CoverageBin& bin : golden.leave_coverage().bins())
      if (bin.hits == 0) names.insert(bin.name);
    return names;
  };
  const std::size_t bins = 1 + 6 + 4 * 2;
  EXPECT_EQ(beside.leave_coverage().bins().size(), bins);
  EXPECT_EQ(missed(by_mark).size(), bins - 1);
  EXPECT_FALSE(missed(by_mark).contains("left/marked/own"));
  EXPECT_THAT(missed(beside), testing::ElementsAre("left/marked/own"));
  beside.clear_coverage();
  EXPECT_EQ(missed(beside).size(), bins);
}

}  // namespace
}  // namespace deburr
