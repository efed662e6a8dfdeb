// SPDX-License-Identifier: MIT
// Traces of fragments: what is written is read back to the bit, single fragments become the quads
// that their derivatives say, and files that were spoiled anywhere are rejected or read, never
// more.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "spec/error.h"
#include "tb/stimuli/texture_quads.h"
#include "tb/traces/fragment_reader.h"
#include "tb/traces/fragment_writer.h"

namespace deburr::tb::fragment_trace_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr std::size_t kTextures = 16;

class FragmentTrace : public testing::TestWithParam<TraceFormat> {
 protected:
  FragmentTrace()
      : file_(fs::temp_directory_path() / ("deburr_fragments_" + std::to_string(::getpid()))) {}
  ~FragmentTrace() override { fs::remove(file_); }

  std::vector<TracedQuad> read() const {
    FragmentReader reader(file_, kTextures);
    std::vector<TracedQuad> quads;
    for (TracedQuad quad; reader.next(quad);) quads.push_back(quad);
    return quads;
  }
  std::string bytes() const {
    std::ifstream in(file_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void put(const std::string& bytes) const { std::ofstream(file_, std::ios::binary) << bytes; }

  std::vector<TracedQuad> write_random(std::uint64_t seed, std::uint32_t count) const {
    constexpr int kSide = 64;
    Random random(seed);
    FragmentWriter writer(file_, GetParam(), kSide, kSide);
    std::vector<TracedQuad> quads;
    for (std::uint32_t i = 0; i < count; ++i) {
      TracedQuad quad;
      quad.quad = random_quad(random, i, static_cast<std::uint8_t>(random.below(kTextures)));
      quad.visible = static_cast<std::uint8_t>(random.below(16));
      quad.placed = random.chance(800);
      if (quad.placed) {
        quad.quad.x = static_cast<std::uint16_t>(2 * random.below(kSide / 2));
        quad.quad.y = static_cast<std::uint16_t>(2 * random.below(kSide / 2));
      }
      writer.put(quad);
      quads.push_back(quad);
    }
    writer.finish();
    return quads;
  }

  fs::path file_;
};

void expect_same(const std::vector<TracedQuad>& a, const std::vector<TracedQuad>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].quad, b[i].quad) << i;
    EXPECT_EQ(a[i].visible, b[i].visible) << i;
    EXPECT_EQ(a[i].placed, b[i].placed) << i;
  }
}

TEST_P(FragmentTrace, IsReadBackToTheBit) {
  const std::vector<TracedQuad> written = write_random(1, 5000);
  expect_same(written, read());
  const FragmentReader reader(file_, kTextures);
  EXPECT_EQ(reader.format(), GetParam());
  EXPECT_EQ(reader.width(), 64);
  const FragmentSummary summary = examine_fragments(file_, kTextures);
  EXPECT_EQ(summary.quads, 5000u);
  EXPECT_GT(summary.fragments, 5000u);
}

TEST_P(FragmentTrace, WithoutASizeIsReadBackToo) {
  FragmentWriter writer(file_, GetParam(), 0, 0);
  TracedQuad quad;
  quad.quad.s = {0, spec::texture::kCoordinateOne, -1, 1};
  writer.put(quad);
  writer.finish();
  expect_same({quad}, read());
  EXPECT_EQ(FragmentReader(file_, 1).width(), 0);
}

// Any byte changed, or any number of bytes cut off: it is read or rejected with a FileError.
TEST_P(FragmentTrace, SpoiledIsReadOrRejected) {
  write_random(2, 8);
  const std::string good = bytes();
  Random random(3);
  int rejected = 0;
  for (std::size_t i = 0; i < 3000; ++i) {
    std::string bad = good;
    if (i < good.size())
      bad.resize(i);
    else
      for (std::uint32_t n = 1 + random.below(3); n > 0; --n)
        bad[random.below(static_cast<std::uint32_t>(bad.size()))] =
            static_cast<char>(random.below(256));
    put(bad);
    try {
      read();
      EXPECT_GE(i, good.size()) << "cut off at " << i;
    } catch (const spec::FileError& error) {
      ++rejected;
      EXPECT_THAT(error.what(), HasSubstr(file_.string()));
    }
  }
  EXPECT_GT(rejected, 1000);
}

TEST_P(FragmentTrace, EndsAtTheLastQuad) {
  write_random(4, 1);
  FragmentReader reader(file_, kTextures);
  TracedQuad quad;
  EXPECT_TRUE(reader.next(quad));
  EXPECT_FALSE(reader.next(quad));
  EXPECT_FALSE(reader.next(quad));
}

TEST_P(FragmentTrace, ThatIsNotFinishedIsGone) {
  { FragmentWriter writer(file_, GetParam(), 0, 0); }
  EXPECT_FALSE(fs::exists(file_));
}

INSTANTIATE_TEST_SUITE_P(Format, FragmentTrace,
                         testing::Values(TraceFormat::kText, TraceFormat::kBinary),
                         [](const auto& format) {
                           return format.param == TraceFormat::kText ? "Text" : "Binary";
                         });

// One fragment at each place of a quad: neighbours by the derivatives, one lane covered.
TEST_F(FragmentTrace, ASingleFragmentGetsTheQuadAroundIt) {
  put("deburr-fragments 1\nsize 8 8\n"
      "fragment 0 2 4 0.5 0.25 0.125 0.0625 -0.25 -0.5\n"
      "fragment 1 3 5 0.5 0.25 0.125 0.0625 -0.25 -0.5\n"
      "fragment 1 - - 0.5 0.25 0.125 0.0625 -0.25 -0.5\nend 3\n");
  const std::vector<TracedQuad> quads = read();
  ASSERT_EQ(quads.size(), 3u);
  constexpr int kOne = spec::texture::kCoordinateOne;
  EXPECT_EQ(quads[0].quad.coverage, 1);
  EXPECT_THAT(quads[0].quad.s,
              testing::ElementsAre(kOne / 2, 5 * kOne / 8, kOne / 4, 3 * kOne / 8));
  EXPECT_THAT(quads[0].quad.t,
              testing::ElementsAre(kOne / 4, 5 * kOne / 16, -kOne / 4, -3 * kOne / 16));
  EXPECT_EQ(quads[1].quad.coverage, 8);
  EXPECT_EQ(quads[1].quad.texture, 1);
  EXPECT_EQ(quads[1].x(3), 3);
  EXPECT_EQ(quads[1].y(3), 5);
  EXPECT_TRUE(quads[1].shows(3));
  EXPECT_THAT(quads[1].quad.s,
              testing::ElementsAre(5 * kOne / 8, 3 * kOne / 4, 3 * kOne / 8, kOne / 2));
  EXPECT_EQ(quads[2].quad.coverage, 1);
  EXPECT_FALSE(quads[2].shows(0));
  EXPECT_EQ(quads[2].quad.s, quads[0].quad.s);
}

}  // namespace
}  // namespace deburr::tb::fragment_trace_test
