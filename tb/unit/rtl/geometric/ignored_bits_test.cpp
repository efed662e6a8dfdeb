// SPDX-License-Identifier: MIT
// Memory contents and register bits without a meaning by docs/reference/geometric/memory.md:
// ignored bits of records, records after the last one, bytes between rows and tiles, the regions of
// weights and of the copy before a frame, unused register bits, and registers that a build does not
// use. With any values there, a frame has the same pixels, accesses and cycles. As a control,
// changing the other bits must change the frame.
#include <bit>
#include <functional>
#include <ostream>
#include <string_view>

#include "tb/base/random.h"
#include "tb/unit/rtl/geometric/trail.h"

namespace deburr::tb::geometric_rtl::ignored_bits_test {
namespace {

using spec::geometric::Region;

// The bits with a meaning in each word of a region.
using Meaning = std::vector<std::uint32_t>;

// An engine of the contract's vectors, with additional settings.
struct Build {
  char configuration;
  const char* settings = "";
  friend void PrintTo(const Build& build, std::ostream* out) {
    *out << build.configuration << ' ' << build.settings;
  }
};

class IgnoredBits : public ::testing::TestWithParam<Build> {
 protected:
  static Parameters parameters() {
    Parameters p = configuration(GetParam().configuration).p;
    apply_settings(p, GetParam().settings);
    return p;
  }
  // Neither the tables nor the rows and tiles of the frame end with a line of memory; one fifth of
  // the vertices is unusable.
  static Scene scene_of_the_frame() {
    Scene scene = contract_scene();
    scene.edges.resize(47);
    scene.vertices.resize(199);
    for (std::size_t i = 0; i < scene.vertices.size(); i += 5) scene.vertices[i].usable = false;
    return scene;
  }
  bool selects_all() const { return b.p.select == spec::geometric::Select::kAll; }
  bool is_split() const { return b.p.records == spec::geometric::RecordsLayout::kSplit; }
  bool is_screened() const { return b.p.coarse_lines != spec::geometric::CoarseLines::kNone; }

  // Marks bits of a record of six bytes; a line of memory holds ten records.
  static void mean(Meaning& words, std::size_t record, std::size_t low, std::size_t high) {
    const std::size_t first = 8 * (64 * (record / 10) + 6 * (record % 10));
    for (std::size_t bit = first + low; bit <= first + high; ++bit)
      words[bit / 32] |= 1u << bit % 32;
  }
  void mean_faces(Meaning& words) const {
    for (std::size_t i = 0; i < scene.edges.size(); ++i) {
      if (!selects_all()) mean(words, i, 0, 20);
      if (!selects_all() && !(scene.edges[i].flags & spec::geometric::flag::kBoundary))
        mean(words, i, 21, 41);
      mean(words, i, 42, 45);
    }
  }
  void mean_pairs(Meaning& words) const {
    const std::uint64_t boundaries = platform::boundaries_of(scene.edges),
                        others = scene.edges.size() - boundaries;
    for (std::size_t i = 0; i < boundaries; ++i) mean(words, i, 0, 47);
    // The second array starts with a new line.
    for (std::size_t i = 0; i < others; ++i) mean(words, (boundaries + 9) / 10 * 10 + i, 0, 47);
  }
  void mean_tiles(Meaning& words) const {
    const auto across = static_cast<std::size_t>((scene.width + 7) / 8),
               down = static_cast<std::size_t>((scene.height + 7) / 8);
    for (std::size_t ty = 0; ty < down; ++ty)
      for (std::size_t tx = 0; tx < across; ++tx) {
        const std::size_t line = ty / 4 * ((across + 7) / 8) + tx / 8,
                          entry = 32 * line + 8 * (ty % 4) + tx % 8;
        words[entry / 2] |= 0xFFFFu << 16 * (entry % 2);
      }
  }

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
        if (is_split()) {
          mean_faces(words);
          break;
        }
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
      case Region::kPairs:
        if (is_split()) mean_pairs(words);
        break;
      case Region::kCoarse:
        if (is_screened()) mean_tiles(words);
        break;
      default:  // weights, copy: written by the engine only
        break;
    }
    return words;
  }

  // Runs a frame in which these bits of a region are inverted first.
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

  EngineBench b{parameters()};
  const Scene scene = scene_of_the_frame();
};

TEST_P(IgnoredBits, MemoryNoiseChangesNothing) {
  b.reset(40);
  b.load(scene);
  b.run();
  const Trail fresh = trail_of(b);
  ASSERT_GT(b.blocks.size(), 20u);
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

// Inverts the highest meaningful bit of each word. Random bits are used for faces, because with
// cull = none only faces that differ from their neighbours matter, and for split records, whose
// highest flag does not always matter.
TEST_P(IgnoredBits, MeaningfulBitsChangeTheFrame) {
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
      const bool any = region == Region::kFaces || (region == Region::kEdges && is_split());
      return any ? m & random.word() : std::bit_floor(m);
    });
    EXPECT_EQ(!frame_difference(fresh, got).empty(), counts) << spec::geometric::kRegionNames[i];
  }
}

// Writes noise to the unused bits of every register, including the write that starts a frame.
TEST_P(IgnoredBits, RegisterNoiseChangesNothing) {
  b.reset(40);
  b.load(scene);
  b.run();
  const Trail fresh = trail_of(b);
  Random random(1, "registers");
  std::uint64_t ignored = 0;
  for (int round = 0; round < 3; ++round) {
    b.reset(40);
    b.load(scene);
    const auto noisy = [&](const spec::RegisterInfo& info, std::uint32_t value) {
      const std::uint32_t noise = (round == 0 ? ~0u : random.word()) & ~info.mask();
      ignored += static_cast<std::uint64_t>(std::popcount(noise));
      b.bus.write(info.offset, value | noise);
    };
    for (const spec::RegisterInfo& info : spec::geometric::kRegisters)
      if (info.written() != 0 && info.offset != reg::kControl)
        noisy(info, b.bus.read(info.offset));
      else if (info.writable() != 0)
        noisy(info, 0);
    const spec::RegisterInfo& control =
        *spec::register_named(spec::geometric::kRegisters, "CONTROL");
    b.run([&] { noisy(control, reg::kControlEnable | reg::kControlStart); });
    noisy(control, reg::kControlEnable);
    EXPECT_EQ(trail_difference(fresh, trail_of(b)), "");
  }
  EXPECT_GT(ignored, 200u);
}

// Registers that this build or its configuration does not use. Each other register matters when it
// is changed a little.
TEST_P(IgnoredBits, UnusedRegistersAreIgnored) {
  using spec::geometric::DepthTest;
  const auto is_unused = [&](std::uint32_t offset) {
    switch (offset) {
      case reg::kFaceCount:
      case reg::kFaceBase:
        return b.p.select != spec::geometric::Select::kEdges;
      case reg::kDepthBase:
        return b.p.depth_test == DepthTest::kOff;
      case reg::kCopyBase:
        return !b.p.frame_copy;
      case reg::kBoundaryCount:
      case reg::kPairBase:
      case reg::kOtherPairBase:
        return !is_split();
      case reg::kCoarseBase:
        return !is_screened();
      default:
        return false;
    }
  };
  b.reset(40);
  b.load(scene);
  b.run();
  const Trail fresh = trail_of(b);
  const auto run_with = [&](std::uint32_t offset, std::uint32_t value) {
    b.reset(40);
    b.load(scene);
    b.bus.write(offset, value);
    b.run();
    return trail_of(b);
  };
  for (const spec::RegisterInfo& info : spec::geometric::kRegisters) {
    if (info.written() == 0 || info.offset == reg::kControl) continue;
    SCOPED_TRACE(info.name);
    if (is_unused(info.offset)) {
      for (const std::uint32_t value : {0u, 1u, ~0u}) {
        EXPECT_EQ(frame_difference(fresh, run_with(info.offset, value)), "") << value;
        EXPECT_EQ(b.driver.rejection(), spec::geometric::Rejection::kNone);
      }
      continue;
    }
    b.reset(40);
    b.load(scene);
    const std::uint32_t value = b.bus.read(info.offset);
    const bool is_base = std::string_view(info.name).ends_with("_BASE"),
               is_count = std::string_view(info.name).ends_with("_COUNT");
    EXPECT_NE(frame_difference(fresh, run_with(info.offset, is_base    ? value + 64
                                                            : is_count ? value / 2
                                                                       : value ^ 1)),
              "");
  }
}

// Tiles and rows; selected edges and all edges; blending in place and from a copy; no depth test;
// records in two arrays, and coarse depth.
INSTANTIATE_TEST_SUITE_P(
    Configurations, IgnoredBits,
    ::testing::Values(Build{'a'}, Build{'d'}, Build{'f'}, Build{'h'}, Build{'l'},
                      Build{'a', "records=split"}, Build{'m', "records=split coarse_lines=4"},
                      Build{'f', "records=split edge_lanes=4"},
                      Build{'d', "coarse_lines=8 records=split edge_lanes=1"}));

}  // namespace
}  // namespace deburr::tb::geometric_rtl::ignored_bits_test
