// SPDX-License-Identifier: MIT
// The tables in docs/measurements/morphological_harm.md, and those of FLIP and SSIM in
// morphological_quality.md, are up to date; the frames have the properties that the page states.
#include "studies/quality/harm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <utility>

#include "golden/morphological/configuration.h"
#include "golden/morphological/morphological_golden.h"
#include "golden/morphological/text_guard.h"
#include "studies/quality/harm_frames.h"
#include "tb/harness/test_paths.h"
#include "tb/scene/quality.h"
#include "tb/scene/textures.h"
#include "tb/unit/spec/generated_table.h"

namespace deburr::studies::harm_test {

using tb::data_folder;
using tb::expect_generated;
using tb::Image;

namespace {

using harm::Text;

constexpr const char *kPage = "measurements/morphological_harm.md",
                     *kQualityPage = "measurements/morphological_quality.md",
                     *kFormula = "MorphologicalHarm.ProceduralFramesMatchPage",
                     *kGuard = "MorphologicalHarm.TextGuardMatchesPage",
                     *kData = "MorphologicalHarm.ThirdPartyFramesMatchPage";

TEST(MorphologicalHarm, ProceduralFramesMatchPage) {
  expect_generated(kPage, kFormula, harm::formula_tables());
}

TEST(MorphologicalHarm, ThirdPartyFramesMatchPage) {
  if (const std::string missing = harm::missing_data(data_folder()); !missing.empty())
    GTEST_SKIP() << "no " << missing
                 << ": set DEBURR_DATA to the folder that holds frames/, kenney/ and textures/";
  expect_generated(kPage, kData, harm::data_tables(data_folder()));
}

TEST(MorphologicalHarm, ProceduralReferencesMatchPage) {
  expect_generated(kQualityPage, "MorphologicalHarm.ProceduralReferencesMatchPage",
                   harm::formula_frames_with_reference());
}

TEST(MorphologicalHarm, ThirdPartyReferencesMatchPage) {
  if (const std::string missing = harm::missing_data(data_folder()); !missing.empty())
    GTEST_SKIP() << "no " << missing
                 << ": set DEBURR_DATA to the folder that holds frames/, kenney/ and textures/";
  expect_generated(kQualityPage, "MorphologicalHarm.ThirdPartyReferencesMatchPage",
                   harm::data_frames_with_reference(data_folder()));
}

TEST(MorphologicalHarm, TextGuardMatchesPage) {
  expect_generated(kPage, kGuard, harm::guard_tables());
}

TEST(MorphologicalHarm, TextGuardOnWiresMatchesPage) {
  expect_generated(kPage, "MorphologicalHarm.TextGuardOnWiresMatchesPage", harm::wires_table());
}

TEST(MorphologicalHarm, ThirdPartyTextGuardMatchesPage) {
  if (const std::string missing = harm::missing_data(data_folder()); !missing.empty())
    GTEST_SKIP() << "no " << missing
                 << ": set DEBURR_DATA to the folder that holds frames/, kenney/ and textures/";
  expect_generated(kPage, "MorphologicalHarm.ThirdPartyTextGuardMatchesPage",
                   harm::data_guard_table(data_folder()));
}

// Purpose of the guard: at most a fifth as many pixels of aliased text change, also on pages
// smaller than those of the tables. The guard does not find smoothed text.
TEST(MorphologicalHarm, GuardCutsChangedTextToAFifth) {
  for (const harm::GuardedText& page : harm::guarded_text(240, 180)) {
    const int kind = static_cast<int>(page.kind);
    EXPECT_GT(page.without, 20) << kind;
    if (page.kind == Text::kSmoothed)
      EXPECT_GT(page.with, page.without * 0.9) << kind;
    else
      EXPECT_LE(page.with, page.without / 5) << kind;
  }
}

Image smoothed(const Image& frame, spec::morphological::Preset preset) {
  golden::morphological::MorphologicalGolden golden(
      golden::morphological::preset_parameters(preset));
  Image out = frame;
  out.pixels = golden.process({frame.pixels, frame.width, frame.height});
  return out;
}

// Contrast that a white line on black keeps in its middle, in %; one pixel thick.
long kept_contrast(int length, spec::morphological::Preset preset) {
  Image frame(640, 24, {0, 0, 0, 255});
  const int first = (640 - length) / 2;
  for (int x = first; x < first + length; ++x) frame.at(x, 12) = {255, 255, 255, 255};
  const Image out = smoothed(frame, preset);
  const int beside = std::max(out.at(320, 11)[0], out.at(320, 13)[0]);
  return std::lround(100.0 * (out.at(320, 12)[0] - beside) / 255);
}

TEST(MorphologicalHarm, ThinLineContrastMatchesPage) {
  using spec::morphological::Preset;
  EXPECT_EQ(kept_contrast(640, Preset::kDeburr), 65);
  EXPECT_EQ(kept_contrast(200, Preset::kDeburr), 36);
  for (const Preset preset : {Preset::kSmaa, Preset::kDeburrLine})
    for (const int length : {640, 200}) EXPECT_EQ(kept_contrast(length, preset), 100) << length;
}

// The fraction of changed pixels that the guard misses, within five columns of an end of a line of
// text and elsewhere.
TEST(MorphologicalHarm, GuardMissesAtLineEndsMatchPage) {
  const Image page = harm::text_page(Text::kAliased, 480, 360),
              out = smoothed(page, spec::morphological::Preset::kDeburr);
  const golden::morphological::TextGuard guard({page.pixels, page.width, page.height});
  int changed[2] = {}, missed[2] = {};
  for (int top = 0, bottom = 0; top < page.height; top = bottom + 1) {  // rows without ink between
    int first = page.width, last = -1;
    for (bottom = top; bottom < page.height; ++bottom) {
      bool ink = false;
      for (int x = 0; x < page.width; ++x)
        if (page.at(x, bottom)[0] != 255) {
          ink = true;
          first = std::min(first, x);
          last = std::max(last, x);
        }
      if (!ink) break;
    }
    for (int y = top; y < bottom; ++y)
      for (int x = 0; x < page.width; ++x) {
        if (std::abs(out.at(x, y)[0] - page.at(x, y)[0]) <= 2) continue;
        const int at_end = x <= first + 5 || x >= last - 5;
        ++changed[at_end];
        missed[at_end] += !guard.at(x, y).guarded();
      }
  }
  EXPECT_EQ(std::lround(100.0 * missed[1] / changed[1]), 31);
  EXPECT_EQ(std::lround(100.0 * missed[0] / changed[0]), 13);
}

// The last line of a table, and the header line above its rows.
std::pair<std::string, std::string> head_and_last_row(const std::string& table) {
  const std::size_t head = table.find("\n| |"), last = table.rfind("\n| ");
  return {table.substr(head + 1, table.find('\n', head + 1) - head),
          table.substr(last + 1, table.find('\n', last + 1) - last)};
}

// Checks one row of a large table in seconds.
void expect_row(const char* generated, std::string (*table)(Text)) {
  std::ifstream file(tb::source_folder() / "docs" / kPage, std::ios::binary);
  const std::string part =
      tb::GeneratedPart({std::istreambuf_iterator<char>(file), {}}, generated).part();
  const auto [head, row] = head_and_last_row(table(Text::kAliased));
  EXPECT_NE(part.find(head), std::string::npos) << head;
  EXPECT_NE(part.find(row), std::string::npos) << row;
  // The injected fault: another page gives another row, even under the same name.
  const auto [other_head, other_row] = head_and_last_row(table(Text::kBitmapFont));
  EXPECT_EQ(other_head, head);
  EXPECT_EQ(part.find(other_row), std::string::npos) << other_row;
}

TEST(MorphologicalHarm, AliasedTextRowMatchesPage) { expect_row(kFormula, harm::text_table); }

TEST(MorphologicalHarm, GuardedAliasedTextRowMatchesPage) {
  expect_row(kGuard, harm::guarded_text_table);
}

std::set<tb::Rgba8> colours(const Image& image) {
  return {image.pixels.begin(), image.pixels.end()};
}

TEST(HarmFrames, UnsmoothedTextHasTwoColours) {
  for (const Text kind : {Text::kAliased, Text::kLightOnDark, Text::kBitmapFont})
    EXPECT_EQ(colours(text_page(kind, 160, 120)).size(), 2u) << static_cast<int>(kind);
  const Image smoothed = text_page(Text::kSmoothed, 160, 120);
  EXPECT_GT(colours(smoothed).size(), 20u);
  // A pixel is ink if at least half of it is ink: the aliased page is the thresholded smoothed one.
  const Image aliased = text_page(Text::kAliased, 160, 120);
  for (std::size_t i = 0; i < aliased.pixels.size(); ++i)
    ASSERT_EQ(aliased.pixels[i][0] == 255, smoothed.pixels[i][0] > 138) << i;
}

TEST(HarmFrames, TextOverSceneHasLettersAndScene) {
  const Image frame = harm::text_over_scene(160, 120), scene = harm::landscape_photo(160, 120),
              page = text_page(Text::kAliased, 160, 120);
  int letters = 0;
  for (std::size_t i = 0; i < frame.pixels.size(); ++i) {
    const bool ink = page.pixels[i][0] != 255;
    ASSERT_EQ(frame.pixels[i], (ink ? page : scene).pixels[i]) << i;
    letters += ink;
  }
  EXPECT_GT(letters, 1000);
}

// Both pictures have two colours, and the reference blends them by the wire's coverage: its mean
// equals that of the wires' area.
TEST(HarmFrames, WireReferenceBlendsByCoverage) {
  const Image upright = harm::wires(2, 90, 80, 40).frame;
  // Wires at multiples of 40 pixels cover the pixel on either side.
  for (int x = 0; x < 80; ++x)
    EXPECT_EQ(upright.at(x, 7)[0] == 40, x == 0 || x == 39 || x == 40 || x == 79) << x;
  for (const double thickness : {1.0, 1.5, 3.0}) {
    const harm::Textured t = harm::wires(thickness, 30, 256, 256);
    EXPECT_EQ(colours(t.frame).size(), 2u);
    EXPECT_GT(colours(t.reference).size(), 30u);
    double covered = 0, sampled = 0;
    for (std::size_t i = 0; i < t.reference.pixels.size(); ++i) {
      const auto light = [](const Image& image, std::size_t at) {
        return tb::srgb_to_linear(image.pixels[at][0] / 255.0);
      };
      const double sky = tb::srgb_to_linear(150 / 255.0), wire = tb::srgb_to_linear(40 / 255.0);
      covered += (sky - light(t.reference, i)) / (sky - wire);
      sampled += (sky - light(t.frame, i)) / (sky - wire);
    }
    const double pixels = 256 * 256;
    EXPECT_NEAR(covered / pixels, thickness / 40, 0.002) << thickness;
    EXPECT_NEAR(sampled / pixels, thickness / 40, 0.002) << thickness;
  }
}

TEST(HarmFrames, PixelArtHasSixteenColoursInBlocks) {
  const Image art = harm::pixel_art(1, 240, 160), large = harm::pixel_art(4, 240, 160);
  EXPECT_LE(colours(art).size(), 16u);
  EXPECT_GT(colours(art).size(), 10u);
  for (int y = 0; y < large.height; ++y)
    for (int x = 0; x < large.width; ++x)
      ASSERT_EQ(large.at(x, y), large.at(x / 4 * 4, y / 4 * 4)) << x << ", " << y;
}

TEST(HarmFrames, TexturedFramesMatchReferenceExceptAtEdges) {
  for (int view = 0; view < 3; ++view) {
    const harm::Textured t = harm::textured_frame(view, 240, 180);
    const double edges =
        static_cast<double>(count(tb::edge_mask(t.reference, t.frame))) / (240 * 180);
    EXPECT_GT(edges, 0.01) << view;
    EXPECT_LT(edges, 0.2) << view;
  }
}

TEST(HarmFrames, JpegQualityDeterminesTheError) {
  const Image photo = harm::landscape_photo(160, 120), good = harm::compressed(photo, 90),
              poor = harm::compressed(photo, 50);
  EXPECT_GT(psnr(good, photo), 34);
  EXPECT_LT(psnr(poor, photo), psnr(good, photo) - 2);
  EXPECT_GT(psnr(poor, photo), 25);
}

}  // namespace
}  // namespace deburr::studies::harm_test
