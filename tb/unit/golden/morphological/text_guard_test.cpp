// SPDX-License-Identifier: MIT
// The text guard bypasses exactly the pixels that the contract says: drawings, a direct
// implementation of the definition, and frames compared with the golden model without the guard.
#include "golden/morphological/text_guard.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "spec/morphological/vectors.h"
#include "tb/base/random.h"
#include "tb/unit/golden/morphological/support.h"
#include "tb/unit/spec/morphological/vector_images.h"

namespace deburr::text_guard_test {
namespace {

using golden::morphological::colour_hash;
using golden::morphological::CoverageBin;
using golden::morphological::MorphologicalGolden;
using golden::morphological::preset_parameters;
using golden::morphological::TextGuard;
using spec::morphological::BlendProbe;
using spec::morphological::Bypass;
using spec::morphological::Parameters;
using spec::morphological::Preset;
using spec::morphological::Rgba8;
using tb::Random;
using tb::morphological::Frame;
using tb::morphological::grey;
using tb::morphological::Hits;

// ---- the hash -----------------------------------------------------------------------------------

TEST(ColourHash, MatchesContract) {
  EXPECT_EQ(colour_hash({0, 0, 0, 255}), 0);
  EXPECT_EQ(colour_hash({255, 0, 0, 255}), 60);
  EXPECT_EQ(colour_hash({0, 255, 0, 255}), 57);
  EXPECT_EQ(colour_hash({0, 0, 255, 255}), 39);
  EXPECT_EQ(colour_hash({255, 255, 255, 255}), 34);
  EXPECT_EQ(colour_hash({1, 1, 1, 255}), 11);
  EXPECT_EQ(colour_hash({64, 64, 64, 255}), 11);
  for (int alpha = 0; alpha < 256; ++alpha)
    EXPECT_EQ(colour_hash({7, 90, 201, static_cast<std::uint8_t>(alpha)}),
              colour_hash({7, 90, 201, 0}));
}

// Bit i of R flips hash bit i, of G bit i + 1, of B bit i + 3 (mod 6); code bits 6 and 7 act as
// bits 0 and 1.
TEST(ColourHash, EachCodeBitFlipsOneHashBit) {
  Random random(3);
  constexpr int kTurns[3] = {0, 1, 3};
  for (std::size_t channel = 0; channel < 3; ++channel)
    for (int bit = 0; bit < 8; ++bit)
      for (int i = 0; i < 20; ++i) {
        Rgba8 pixel = {static_cast<std::uint8_t>(random.below(256)),
                       static_cast<std::uint8_t>(random.below(256)),
                       static_cast<std::uint8_t>(random.below(256)), 255};
        const int before = colour_hash(pixel);
        pixel[channel] = static_cast<std::uint8_t>(pixel[channel] ^ 1 << bit);
        EXPECT_EQ(before ^ colour_hash(pixel), 1 << (bit % 6 + kTurns[channel]) % 6);
      }
}

// ---- drawings -----------------------------------------------------------------------------------

// Rows of the frame: g for a guarded pixel, - for others.
std::string guarded_rows(const Frame& frame) {
  const TextGuard guard(frame.view());
  std::string text;
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) text += guard.at(x, y).guarded() ? 'g' : '-';
    if (y + 1 < frame.height) text += ' ';
  }
  return text;
}

std::string transposed_rows(const std::string& rows, int width, int height) {
  std::string text;
  for (int x = 0; x < width; ++x) {
    for (int y = 0; y < height; ++y) text += rows[static_cast<std::size_t>(y * (width + 1) + x)];
    if (x + 1 < width) text += ' ';
  }
  return text;
}

TEST(TextGuard, GuardedPixelsMatchDrawings) {
  std::set<char> seen;
  for (const spec::morphological::GuardVector& v : spec::morphological::kGuardVectors) {
    const Frame frame = tb::morphological::vector_image(v);
    const std::string expected(v.guarded);
    EXPECT_EQ(guarded_rows(frame), expected) << v.name;
    EXPECT_EQ(guarded_rows(tb::morphological::transposed(frame)),
              transposed_rows(expected, frame.width, frame.height))
        << v.name;
    EXPECT_EQ(guarded_rows(tb::morphological::inverted(frame)), expected) << v.name;
    seen.insert(expected.begin(), expected.end());
  }
  EXPECT_EQ(seen, (std::set{'g', '-', ' '}));
}

std::int64_t guarded_pixels(const Frame& frame) {
  const std::string rows = guarded_rows(frame);
  EXPECT_EQ(std::ranges::count(guarded_rows(tb::morphological::transposed(frame)), 'g'),
            std::ranges::count(rows, 'g'));
  return std::ranges::count(rows, 'g');
}

TEST(TextGuard, GuardsBendsOfThinLines) {
  EXPECT_EQ(guarded_pixels(Frame(60, 60,
                                 [](int x, int y) {
                                   const bool v = y >= 15 && y < 40 && std::abs(x - 30) == y - 15;
                                   return grey(v ? 20 : 200);
                                 })),
            53);
  EXPECT_EQ(guarded_pixels(Frame(60, 60,
                                 [](int x, int y) {
                                   const double r = std::hypot(x - 30, y - 30);
                                   return grey(std::lround(r) == 12 ? 20 : 200);
                                 })),
            4);
}

// A third colour with the hash of one of the two does not count, however different it looks.
TEST(TextGuard, ComparesColoursByHash) {
  const auto grid = [](const Rgba8& spot) {
    return Frame(9, 9, [&](int x, int y) {
      if (x == 2 && y == 2) return spot;
      return grey(x % 4 == 0 || y % 4 == 0 ? 1 : 255);
    });
  };
  EXPECT_EQ(std::ranges::count(guarded_rows(grid(grey(255))), 'g'), 81);
  EXPECT_EQ(std::ranges::count(guarded_rows(grid(grey(64))), 'g'), 81);   // same hash as 1
  EXPECT_EQ(std::ranges::count(guarded_rows(grid(grey(190))), 'g'), 81);  // same hash as 255
  EXPECT_EQ(colour_hash(grey(190)), colour_hash(grey(255)));
  EXPECT_EQ(std::ranges::count(guarded_rows(grid(grey(254))), 'g'),
            17);  // pixels whose window excludes the spot
}

// ---- the definition -----------------------------------------------------------------------------

// Length of the run of equal hashes through (x, y) along (dx, dy).
int run_through(const Frame& frame, int x, int y, int dx, int dy) {
  int length = 1;
  for (const int way : {-1, 1})
    for (int k = 1;; ++k) {
      const int at_x = x + way * k * dx, at_y = y + way * k * dy;
      if (at_x < 0 || at_y < 0 || at_x >= frame.width || at_y >= frame.height) break;
      if (colour_hash(frame.at(at_x, at_y)) != colour_hash(frame.at(x, y))) break;
      ++length;
    }
  return length;
}

class Definition {
 public:
  explicit Definition(const Frame& frame) : frame_(frame) {
    for (int y = 0; y < frame.height; ++y)
      for (int x = 0; x < frame.width; ++x) {
        in_rows_.push_back(run_through(frame, x, y, 1, 0) <= 3);
        in_columns_.push_back(run_through(frame, x, y, 0, 1) <= 3);
      }
  }
  struct Numbers {
    std::set<int> colours;
    int rows = 0, columns = 0;
    bool guarded() const {
      return colours.size() == 2 && rows >= 3 && columns >= 3 && rows + columns >= 24;
    }
  };
  Numbers at(int x, int y) const {
    Numbers n;
    for (int j = y - 5; j <= y + 5; ++j)
      for (int i = x - 5; i <= x + 5; ++i) {
        if (i < 0 || j < 0 || i >= frame_.width || j >= frame_.height) continue;
        n.colours.insert(colour_hash(frame_.at(i, j)));
        n.rows += in_rows_[frame_.index(i, j)];
        n.columns += in_columns_[frame_.index(i, j)];
      }
    return n;
  }

 private:
  const Frame& frame_;
  std::vector<bool> in_rows_, in_columns_;
};

// Random rectangles of two colours, rarely also of a third one.
Frame patches(int width, int height, Random& random, bool third_colour = true) {
  Frame frame(width, height, [](int, int) { return grey(200); });
  for (int i = 0; i < 6 + width * height / 30; ++i) {
    const int w = 1 + static_cast<int>(random.below(5)), h = 1 + static_cast<int>(random.below(5)),
              x0 = static_cast<int>(random.below(static_cast<std::uint32_t>(width))),
              y0 = static_cast<int>(random.below(static_cast<std::uint32_t>(height)));
    const int code = third_colour && random.below(200) == 0 ? 90 : random.below(3) == 0 ? 200 : 20;
    for (int y = y0; y < std::min(height, y0 + h); ++y)
      for (int x = x0; x < std::min(width, x0 + w); ++x) frame.at(x, y) = grey(code);
  }
  return frame;
}

TEST(TextGuard, MatchesDefinition) {
  Random random(11);
  int guarded = 0, all = 0;
  for (const auto& [w, h] :
       {std::pair(40, 30), {1, 40}, {40, 1}, {2, 30}, {30, 3}, {7, 7}, {11, 4}})
    for (int i = 0; i < 8; ++i) {
      const Frame frame = patches(w, h, random, i % 2 == 0);
      const TextGuard guard(frame.view());
      const Definition definition(frame);
      for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
          const auto expected = definition.at(x, y);
          ASSERT_EQ(guard.at(x, y).guarded(), expected.guarded())
              << w << ' ' << h << ' ' << i << ' ' << x << ' ' << y;
          ASSERT_EQ(guard.at(x, y).colours, expected.colours.size());
          ASSERT_EQ(guard.at(x, y).row_strokes, expected.rows);
          ASSERT_EQ(guard.at(x, y).column_strokes, expected.columns);
          guarded += guard.at(x, y).guarded();
          ++all;
        }
    }
  EXPECT_GT(guarded, all / 20);
  EXPECT_LT(guarded, all * 19 / 20);
}

// ---- frames -------------------------------------------------------------------------------------

// Expects the frame of the model without the guard, with guarded pixels restored.
void expect_guarded_pixels_restored(Parameters p, const Frame& frame) {
  MorphologicalGolden plain(p);
  plain.process(frame.view());
  p.text_guard = true;
  MorphologicalGolden golden(p);
  golden.process(frame.view());
  spec::morphological::Work work = plain.work();
  const TextGuard guard(frame.view());
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const auto i = static_cast<std::size_t>(y * frame.width + x);
      const BlendProbe before = plain.probes()[i];
      BlendProbe probe = before;
      Rgba8 pixel = plain.pixels()[i];
      if (guard.at(x, y).guarded()) {
        probe = {false, 0, 0, before.edges};
        pixel = frame.pixels[i];
        if (p.bypass != Bypass::kNone) pixel[3] |= 1;
        if ((before.first | before.second) != 0) {
          --work.blended_pixels;
          ++work.bypassed_pixels;
        }
      }
      ASSERT_EQ(golden.pixels()[i], pixel) << x << ' ' << y;
      ASSERT_EQ(golden.probes()[i], probe) << x << ' ' << y;
    }
  EXPECT_EQ(golden.work(), work);
  EXPECT_EQ(golden.decisions(), plain.decisions());
  EXPECT_TRUE(golden.edges() == plain.edges());
}

TEST(TextGuard, RestoresGuardedPixels) {
  Random random(21);
  for (const Preset preset : {Preset::kMlaa, Preset::kMlaaSlope, Preset::kSmaa,
                              Preset::kSmaaDynamic, Preset::kDeburrLine, Preset::kDeburr}) {
    const Parameters p = preset_parameters(preset);
    expect_guarded_pixels_restored(p, tb::morphological::text_image());
    expect_guarded_pixels_restored(p, tb::morphological::noise_image());
    expect_guarded_pixels_restored(p, patches(70, 40, random));
    expect_guarded_pixels_restored(p, patches(3, 40, random));
    expect_guarded_pixels_restored(p, patches(40, 2, random));
  }
  // A pixel that is both marked and guarded counts once. With bypass = none alpha passes.
  for (const Bypass bypass :
       {Bypass::kNone, Bypass::kMarked, Bypass::kBeside, Bypass::kHalf, Bypass::kMasked}) {
    Parameters p = preset_parameters(Preset::kDeburrLine);
    p.bypass = bypass;
    Frame frame = tb::morphological::text_image();
    for (Rgba8& pixel : frame.pixels)
      pixel[3] = static_cast<std::uint8_t>(random.below(128) << 1 | (random.below(6) == 0 ? 0 : 1));
    expect_guarded_pixels_restored(p, frame);
  }
}

// The guard reads the arriving colours: a line that memory fails to return is blended as zeros, but
// guarded as it arrived.
TEST(TextGuard, UsesColoursOfArrivingBeat) {
  Parameters p = preset_parameters(Preset::kDeburr);
  p.storage = spec::morphological::Storage::kMemory;
  p.text_guard = true;
  const Frame frame = tb::morphological::text_image();  // rows of 512 bytes
  MorphologicalGolden golden(p), whole(p);
  golden.set_read_errors([](std::uint32_t address) { return address == 8 * 512; });
  golden.process(frame.view());
  whole.process(frame.view());
  EXPECT_EQ(golden.work(), whole.work());
  EXPECT_EQ(golden.probes(), whole.probes());
  EXPECT_NE(golden.pixels(), whole.pixels());
}

TEST(TextGuard, KeepsNoStateBetweenFrames) {
  Parameters p = preset_parameters(Preset::kDeburr);
  p.text_guard = true;
  MorphologicalGolden golden(p);
  const Frame text = tb::morphological::text_image(), noise = tb::morphological::noise_image(20, 9);
  for (const Frame* frame : {&text, &noise, &text})
    EXPECT_EQ(golden.process(frame->view()), smooth(p, *frame).pixels);
}

// ---- coverage -----------------------------------------------------------------------------------

Hits hits_of(const Frame& frame) {
  golden::morphological::GuardCoverage coverage;
  coverage.count_frame(TextGuard(frame.view()), frame.width, frame.height);
  return tb::morphological::hits_of(coverage.bins());
}

// Expected bins are worked out by hand.
TEST(GuardCoverage, CountsReasonAndMargin) {
  const auto drawing = [](std::string_view name) {
    for (const spec::morphological::GuardVector& v : spec::morphological::kGuardVectors)
      if (v.name == name) return Frame(tb::morphological::vector_image(v));
    throw std::out_of_range(std::string(name));
  };
  const auto drawing_hits = [&](std::string_view name) { return hits_of(drawing(name)); };
  EXPECT_EQ(hits_of(Frame(5, 5, [](int, int) { return grey(9); })),
            (Hits{{"text/one-colour", 25}}));
  EXPECT_EQ(drawing_hits("small"), (Hits{{"text/guarded", 12},
                                         {"text/just/24", 12},
                                         {"text-border/top", 3},
                                         {"text-border/bottom", 3},
                                         {"text-border/left", 4},
                                         {"text-border/right", 4}}));
  EXPECT_EQ(drawing_hits("too small"), (Hits{{"text/few", 9}}));  // 18 strokes
  EXPECT_EQ(drawing_hits("bars"), (Hits{{"text/few-in-columns", 81}}));
  EXPECT_EQ(drawing_hits("grid and another colour"), (Hits{{"text/guarded", 45},
                                                           {"text/more-colours", 36},
                                                           {"text-border/top", 9},
                                                           {"text-border/left", 9},
                                                           {"text-border/right", 3},
                                                           {"text-border/bottom", 3}}));
  // Windows of rows 0, 7 and 8 hold two of the dots, upside down those of rows 0, 1 and 8.
  const Frame dots = drawing("three dots"), upside_down = tb::morphological::mirrored_y(dots);
  const Hits in_rows = {{"text/guarded", 54},     {"text/just/3-in-rows", 54},
                        {"text/few-in-rows", 27}, {"text/just/2-in-rows", 27},
                        {"text-border/left", 6},  {"text-border/right", 6}},
             in_columns = {{"text/guarded", 54},        {"text/just/3-in-columns", 54},
                           {"text/few-in-columns", 27}, {"text/just/2-in-columns", 27},
                           {"text-border/top", 6},      {"text-border/bottom", 6}};
  for (const Frame& frame : {dots, upside_down}) {
    EXPECT_EQ(hits_of(frame), in_rows);
    EXPECT_EQ(hits_of(tb::morphological::transposed(frame)), in_columns);
  }
  const Hits enough = drawing_hits("twenty-four"), fewer = drawing_hits("twenty-three");
  EXPECT_EQ(enough.at("text/guarded"), 25u);
  EXPECT_EQ(enough.at("text/just/24"), 25u);
  EXPECT_EQ(fewer.count("text/guarded"), 0u);
  EXPECT_EQ(fewer.at("text/just/23"), 25u);
}

TEST(GuardCoverage, EveryBinCanBeReached) {
  Random random(31);
  Parameters p = preset_parameters(Preset::kDeburr);
  p.text_guard = true;
  p.bypass = Bypass::kMarked;
  MorphologicalGolden golden(p);
  std::vector<Frame> frames = {tb::morphological::text_image()};
  for (int i = 0; i < 40; ++i) frames.push_back(patches(60, 50, random));
  for (Frame& frame : frames) {
    for (Rgba8& pixel : frame.pixels) pixel[3] = random.below(9) == 0 ? 254 : 255;
    golden.process(frame.view());
  }
  std::vector<std::string> holes;
  for (const CoverageBin& bin : golden.guard_coverage().bins())
    if (bin.hits == 0) holes.push_back(bin.name);
  EXPECT_THAT(holes, testing::IsEmpty());
  EXPECT_EQ(golden.guard_coverage().bins().size(), 6u + 6 + 2 + 4);
  golden.clear_coverage();
  for (const CoverageBin& bin : golden.guard_coverage().bins()) EXPECT_EQ(bin.hits, 0u);
  p.text_guard = false;
  MorphologicalGolden off(p);
  off.process(frames.front().view());
  for (const CoverageBin& bin : off.guard_coverage().bins()) EXPECT_EQ(bin.hits, 0u);
}

}  // namespace
}  // namespace deburr::text_guard_test
