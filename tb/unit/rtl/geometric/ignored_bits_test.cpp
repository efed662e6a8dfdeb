// SPDX-License-Identifier: MIT
// What lies in memory beside what docs/reference/geometric/memory.md gives a meaning to: bits of
// its records that are ignored, records behind the last one, what lies between rows and tiles, room
// for weights and for the copy before a frame. Whatever is there, a frame is the same, in pixels,
// accesses and clocks; and each of the other bits counts, or the noise would prove nothing.
#include <bit>
#include <functional>

#include "tb/base/random.h"
#include "tb/unit/rtl/geometric/trail.h"

namespace deburr::tb::geometric_rtl::ignored_bits_test {
namespace {

using spec::geometric::Region;

// Of each word of a region the bits that have a meaning.
using Meaning = std::vector<std::uint32_t>;

class IgnoredBits : public ::testing::TestWithParam<char> {
 protected:
  // Neither table ends with a line of memory, nor do the rows and tiles of the frame; a fifth of
  // the vertices is not usable.
  static Scene scene_of_the_frame() {
    Scene scene = contract_scene();
    scene.edges.resize(47);
    scene.vertices.resize(199);
    for (std::size_t i = 0; i < scene.vertices.size(); i += 5) scene.vertices[i].usable = false;
    return scene;
  }
  bool selects_all() const { return b.p.select == spec::geometric::Select::kAll; }

  Meaning meaning_of(Region region) const {
    const platform::GeometricSizes sizes = {
        scene.width,           scene.height,        scene.edges.size(),
        scene.vertices.size(), scene.facing.size(), platform::boundaries_of(scene.edges)};
    Meaning words(platform::GeometricRegions::needed(sizes, b.p)[static_cast<std::size_t>(region)] /
                  4);
    const auto put = [&](const std::vector<std::uint8_t>& bytes) {
      for (std::size_t i = 0; i < bytes.size(); ++i)
        words[i / 4] |= std::uint32_t{bytes[i]} << 8 * (i % 4);
    };
    const platform::PixelLayout layout(b.p.layout, scene.width, scene.height);
    const std::size_t pixels = scene.colours.size();
    switch (region) {
      case Region::kEdges:
        for (std::size_t i = 0; i < scene.edges.size(); ++i) {
          const bool one_face = scene.edges[i].flags & spec::geometric::flag::kBoundary;
          words[4 * i] = words[4 * i + 1] = 0xFFFFFF;
          words[4 * i + 2] = selects_all() ? 0x0F000000 : 0x0FFFFFFF;
          words[4 * i + 3] = selects_all() || one_face ? 0 : 0xFFFFFF;
        }
        break;
      case Region::kVertices:
        for (std::size_t i = 0; i < scene.vertices.size(); ++i) {
          words[4 * i] = words[4 * i + 1] = ~0u;
          words[4 * i + 2] = 0xFFFFFF;
          words[4 * i + 3] = 1;
        }
        break;
      case Region::kFaces:
        if (!selects_all())
          put(platform::facing_bits(std::vector<bool>(scene.facing.size(), true)));
        break;
      case Region::kDepth:
        if (b.p.depth_test != spec::geometric::DepthTest::kOff)
          put(platform::depth_buffer(layout, std::vector<std::uint32_t>(pixels, 0xFFFFFF)));
        break;
      case Region::kColour:
        put(platform::colour_buffer(
            layout, std::vector<spec::geometric::Rgba8>(pixels, {255, 255, 255, 255})));
        break;
      default:  // weights, copy: room
        break;
    }
    return words;
  }

  // A frame in which these bits of a region are inverted beforehand.
  Trail run(Region region, const std::function<std::uint32_t(std::uint32_t meaning)>& inverted) {
    b.reset(40);
    b.load(scene);
    const Meaning meaning = meaning_of(region);
    const std::uint32_t base = b.driver.regions().base(region);
    std::vector<std::uint8_t> bytes = b.memory.dump(base, 4 * meaning.size());
    for (std::size_t i = 0; i < bytes.size(); ++i)
      bytes[i] = static_cast<std::uint8_t>(bytes[i] ^ inverted(meaning[i / 4]) >> 8 * (i % 4));
    b.memory.preload(base, bytes);
    b.run();
    return trail_of(b);
  }

  EngineBench b{configuration(GetParam()).p};
  const Scene scene = scene_of_the_frame();
};

TEST_P(IgnoredBits, ChangeNothing) {
  b.reset(40);
  b.load(scene);
  b.run();
  const Trail fresh = trail_of(b);
  ASSERT_GT(fresh.blocks.size(), 20u);
  std::uint64_t ignored = 0;
  for (std::size_t i = 0; i < spec::geometric::kRegionNames.size(); ++i) {
    const auto region = static_cast<Region>(i);
    SCOPED_TRACE(spec::geometric::kRegionNames[i]);
    for (const std::uint32_t word : meaning_of(region))
      ignored += static_cast<std::uint64_t>(std::popcount(~word));
    EXPECT_EQ(trail_difference(fresh, run(region, [](std::uint32_t m) { return ~m; })), "");
    Random random(i, "noise");
    for (int round = 0; round < 2; ++round)
      EXPECT_EQ(
          trail_difference(fresh, run(region, [&](std::uint32_t m) { return random.word() & ~m; })),
          "");
  }
  EXPECT_GT(ignored, 10'000u);
}

// The highest bit of each word that has a meaning; of faces any of them, since with cull = none
// only those count that differ from their neighbours.
TEST_P(IgnoredBits, AreNoOthers) {
  b.reset(40);
  b.load(scene);
  b.run();
  const Trail fresh = trail_of(b);
  for (std::size_t i = 0; i < spec::geometric::kRegionNames.size(); ++i) {
    const auto region = static_cast<Region>(i);
    const Meaning words = meaning_of(region);
    const bool counts =
        std::any_of(words.begin(), words.end(), [](std::uint32_t word) { return word != 0; });
    Random random(i, "meaning");
    const Trail got = run(region, [&](std::uint32_t m) {
      return region == Region::kFaces ? m & random.word() : std::bit_floor(m);
    });
    EXPECT_EQ(!frame_difference(fresh, got).empty(), counts) << spec::geometric::kRegionNames[i];
  }
}

// In tiles and in rows; of chosen edges and of all of them; blended in place and from a copy;
// without a depth test.
INSTANTIATE_TEST_SUITE_P(Configurations, IgnoredBits, ::testing::Values('a', 'd', 'f', 'h', 'l'));

// With select = all FACE_COUNT is of no account.
class IgnoredFaceCount : public IgnoredBits {};
TEST_P(IgnoredFaceCount, ChangesNothing) {
  ASSERT_TRUE(selects_all());
  b.load(scene);
  b.run();
  const Trail fresh = trail_of(b);
  for (const std::uint32_t faces : {0u, 1u, ~0u}) {
    b.reset(40);
    b.load(scene);
    b.bus.write(reg::kFaceCount, faces);
    b.run();
    EXPECT_EQ(b.driver.refusal(), spec::geometric::Refusal::kNone);
    EXPECT_EQ(frame_difference(fresh, trail_of(b)), "") << faces;
  }
}
INSTANTIATE_TEST_SUITE_P(Configurations, IgnoredFaceCount, ::testing::Values('f', 'h'));

}  // namespace
}  // namespace deburr::tb::geometric_rtl::ignored_bits_test
