// SPDX-License-Identifier: MIT
// Bypassed pixels keep their colour, all others are smoothed as without `bypass`, and delivered
// pixels have no mark. Checked by examples and by frames derived from the golden model's frame
// without `bypass`.
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
using tb::morphological::names_of;

constexpr Preset kAll[] = {Preset::kMlaa, Preset::kMlaaSlope, Preset::kSmaa, Preset::kSmaaDynamic,
                           Preset::kDeburrLine};

// Marks one pixel in `rare` on average; the other bits of alpha are random.
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

bool is_bypassed(const Frame& frame, Bypass bypass, int x, int y) {
  if (bypass == Bypass::kNone) return false;
  const bool neighbour = has_mark(frame, x - 1, y) || has_mark(frame, x + 1, y) ||
                         has_mark(frame, x, y - 1) || has_mark(frame, x, y + 1);
  return has_mark(frame, x, y) || (bypass == Bypass::kBeside && neighbour);
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

// Expects the frame of the model without `bypass`, with bypassed pixels restored and pixels with
// halved weights blended again.
void expect_bypassed_pixels_restored(Parameters p, const Frame& frame) {
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
        const bool had_weight = (probe.first | probe.second) != 0;
        const int dx = probe.horizontal ? 1 : 0, dy = probe.horizontal ? 0 : 1;
        if (bypass == Bypass::kHalf) {
          if (has_mark(frame, x - dx, y - dy)) probe.first /= 2;
          if (has_mark(frame, x + dx, y + dy)) probe.second /= 2;
        }
        const bool blended = (probe.first | probe.second) != 0 && !is_bypassed(frame, bypass, x, y);
        if (had_weight && !blended) {
          --work.blended_pixels;
          ++work.bypassed_pixels;
        }
        if (!blended) probe = {false, 0, 0, probe.edges};
        Rgba8 pixel = blended ? mix(p, frame, x, y, probe) : frame.pixels[i];
        pixel[3] = static_cast<std::uint8_t>(frame.pixels[i][3] | 1);
        ASSERT_EQ(golden.pixels()[i], pixel) << x << ' ' << y;
        ASSERT_EQ(golden.probes()[i], probe) << x << ' ' << y;
      }
    }
    EXPECT_EQ(golden.work(), work);
    EXPECT_EQ(golden.decisions(), plain.decisions());
  }
}

TEST(Bypass, RestoresMarkedPixels) {
  Random random(5);
  for (const Preset preset : kAll) {
    for (const unsigned rare : {1u, 2u, 6u, 40u, 1000000u}) {
      expect_bypassed_pixels_restored(
          preset_parameters(preset),
          marked(tb::morphological::rendered_like(131, 70, 60), random, rare));
    }
    expect_bypassed_pixels_restored(preset_parameters(preset),
                                    marked(tb::morphological::noise_image(), random, 9));
  }
}

TEST(Bypass, RestoresMarkedPixelsInNarrowFrames) {
  Random random(6);
  for (const auto& [w, h] : {std::pair(1, 50), {50, 1}, {2, 40}, {40, 2}, {64, 5}, {65, 5}}) {
    const Frame blocks(w, h, [&](int, int) { return grey(random.below(2) == 0 ? 10 : 220); });
    for (const Preset preset : kAll)
      expect_bypassed_pixels_restored(preset_parameters(preset), marked(blocks, random, 8));
  }
}

// A step edge of 40 columns: all pixels of rows 3 and 4 except the middle ones have a weight.
Frame step() {
  return {40, 8, [](int x, int y) { return grey(y < (x < 20 ? 4 : 5) ? 230 : 20); }};
}

// With the first neighbour marked, weights of 60 and 100 become 30 and 100, which are mixed to
// 900 / 130 and 10000 / 130: 111 and 1231 in U0.12.
TEST(Bypass, HalvesWeightsBeforeSquaring) {
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
}

// Pixels of a line that could not be read are zero including alpha, so they are marked.
TEST(Bypass, UnreadableLinesCountAsMarked) {
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

// Bypassed pixels count with the decision made for them, pixels without weights as `none`.
TEST(BypassCoverage, CountsOneDecisionPerPixel) {
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
  EXPECT_THAT(hit(by_mark), testing::ElementsAre("bypass/marked/own"));
  EXPECT_THAT(hit(half), testing::UnorderedElementsAre("bypass/half/own", "half/up", "half/left",
                                                       "half/right", "half/down", "half/nothing"));
  std::set<std::string> all = hit(beside);
  EXPECT_EQ(all.size(), 6u + 4 * 2);
  all.merge(hit(by_mark));
  all.merge(hit(half));
  EXPECT_EQ(all.size(), beside.bypass_coverage().bins().size());
  beside.clear_coverage();
  EXPECT_THAT(hit(beside), testing::IsEmpty());
}

// Each row counts one pixel of a 5 x 4 frame; (2, 1) is not on a border.
TEST(BypassCoverage, CountsMarkPositionHalvingAndBorder) {
  constexpr unsigned kOwn = 1, kUp = 2, kLeft = 4, kRight = 8, kDown = 16, kEvery = 31;
  constexpr BlendProbe kVertical{false, 60, 100}, kHorizontal{true, 60, 100};
  struct Row {
    Bypass bypass;
    unsigned marks;
    BlendProbe probe;
    const char* bins;
    int x = 2, y = 1;
  };
  for (const Row& row : {
           // kNone and kMasked are not counted.
           Row{Bypass::kNone, kEvery, kVertical, ""},
           Row{Bypass::kMasked, kEvery, kVertical, ""},
           Row{Bypass::kMarked, kOwn, kVertical, "bypass/marked/own"},
           Row{Bypass::kMarked, 0, kVertical, ""},
           Row{Bypass::kHalf, kOwn, kVertical, "bypass/half/own"},
           Row{Bypass::kHalf, kOwn | kUp, kVertical, "bypass/half/own"},
           // Only neighbours along the chosen axis are halved.
           Row{Bypass::kHalf, 0, kVertical, ""},
           Row{Bypass::kHalf, kUp, kVertical, "half/up"},
           Row{Bypass::kHalf, kDown, kVertical, "half/down"},
           Row{Bypass::kHalf, kUp | kDown, kVertical, "half/down half/up"},
           Row{Bypass::kHalf, kLeft | kRight, kVertical, ""},
           Row{Bypass::kHalf, kLeft, kHorizontal, "half/left"},
           Row{Bypass::kHalf, kRight, kHorizontal, "half/right"},
           Row{Bypass::kHalf, kUp | kDown, kHorizontal, ""},
           // A neighbour without a weight is not counted.
           Row{Bypass::kHalf, kUp, {false, 0, 100}, ""},
           Row{Bypass::kHalf, kDown, {false, 60, 0}, ""},
           // A weight of 1 is halved to 0, a weight of 2 to 1.
           Row{Bypass::kHalf, kUp, {false, 1, 0}, "half/nothing half/up"},
           Row{Bypass::kHalf, kDown, {false, 0, 1}, "half/down half/nothing"},
           Row{Bypass::kHalf, kUp, {false, 2, 0}, "half/up"},
           Row{Bypass::kHalf, kUp, {false, 1, 1}, "half/up"},
           // Several marks count as `several`.
           Row{Bypass::kBeside, 0, kVertical, ""},
           Row{Bypass::kBeside, kOwn, kVertical, "bypass/beside/own"},
           Row{Bypass::kBeside, kUp, kVertical, "bypass/beside/up"},
           Row{Bypass::kBeside, kLeft, kVertical, "bypass/beside/left"},
           Row{Bypass::kBeside, kRight, kVertical, "bypass/beside/right"},
           Row{Bypass::kBeside, kDown, kVertical, "bypass/beside/down"},
           Row{Bypass::kBeside, kOwn | kUp, kVertical, "bypass/beside/several"},
           Row{Bypass::kBeside, kEvery, kVertical, "bypass/beside/several"},
           Row{Bypass::kBeside, 0, kVertical, "", 3, 2},
           Row{Bypass::kBeside, 0, kVertical, "border/top/blended", 2, 0},
           Row{Bypass::kBeside, 0, kVertical, "border/left/blended", 0, 2},
           Row{Bypass::kBeside, 0, kVertical, "border/right/blended", 4, 2},
           Row{Bypass::kBeside, 0, kVertical, "border/bottom/blended", 2, 3},
           Row{Bypass::kBeside, 0, kVertical, "border/bottom/blended border/right/blended", 4, 3},
           Row{Bypass::kBeside, kOwn, kVertical, "border/top/bypassed bypass/beside/own", 2, 0},
           Row{Bypass::kBeside, kOwn, kVertical, "border/left/bypassed bypass/beside/own", 0, 2},
           Row{Bypass::kBeside, kOwn, kVertical, "border/right/bypassed bypass/beside/own", 4, 2},
           Row{Bypass::kBeside, kOwn, kVertical, "border/bottom/bypassed bypass/beside/own", 2, 3},
       }) {
    const Frame frame(5, 4, [](int, int) { return grey(1); });
    golden::morphological::BypassCoverage coverage;
    coverage.count_pixel(row.bypass, static_cast<golden::morphological::Marks>(row.marks),
                         row.probe, frame.view(), row.x, row.y);
    EXPECT_EQ(names_of(coverage.bins()), row.bins)
        << static_cast<int>(row.bypass) << ' ' << row.marks << " at " << row.x << ' ' << row.y;
  }
}

}  // namespace
}  // namespace deburr::bypass_test
