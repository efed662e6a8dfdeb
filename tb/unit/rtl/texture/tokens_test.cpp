// SPDX-License-Identifier: MIT
// Tokens and tags of some builds; and the figures of composite units.
#include "rtl_model/texture/tokens.h"

#include "tb/unit/rtl/figure.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::rtl::texture::tokens_test {
namespace {

// Composite units in both builds: an AxisUnit replaces the FootprintUnit.
TEST(TextureFigures, MatchTheModuleTree) {
  ClockDomain clock("clock", tb::texture_rtl::period());
  const std::string address = "rtl_model/texture/address_unit.h",
                    cache = "rtl_model/texture/texture_cache.h";
  for (const auto& [name, axes] : {std::pair{"two", spec::texture::Axes::kTwo},
                                   std::pair{"eight", spec::texture::Axes::kEight}}) {
    spec::texture::Parameters p;
    p.cache_fifo_depth = 107;
    p.axes = axes;
    const TextureUnit unit(name, clock, p);
    tb::expect_figure(tb::Figure::of_header(address), *unit.narrow_address, address, "AxisUnit");
    tb::expect_figure(tb::Figure::of_header(cache), unit.cache, cache, "MissQueue");
  }
}

// Without an order of the ways, a set is its tags and two bits per way.
TEST(TextureRtlTokens, RandomReplacementStoresNoOrder) {
  ClockDomain clock("clock", tb::texture_rtl::period());
  spec::texture::Parameters p;
  p.cache_fifo_depth = 16;
  p.cache_replacement = spec::texture::Replacement::kRandom;
  const TextureUnit unit("unit", clock, p);
  int stores = 0;
  for (const MemoryBase* memory : unit.memories()) {
    if (std::string(memory->basename()) != "tags") continue;
    ++stores;
    EXPECT_EQ(memory->word_bits(), 2U * (19 + 2));
  }
  EXPECT_GT(stores, 0);
}

// A turned line is rotated by half a tile of 64 bytes, or by half a line if that is shorter.
TEST(TextureRtlTokens, LinesTurnByHalfTile) {
  EXPECT_EQ(turn_bytes(32), 16U);
  EXPECT_EQ(turn_bytes(64), 32U);
  EXPECT_EQ(turn_bytes(128), 32U);
}

// A tag has just the bits that the entries of the fill buffer need.
TEST(TextureRtlTokens, TagWidthFollowsFillBufferEntries) {
  ClockDomain clock("clock", tb::texture_rtl::period());
  for (const auto& [outstanding, bits] :
       {std::array<std::uint32_t, 2>{4, 2}, {5, 3}, {8, 3}, {9, 4}, {64, 6}, {65, 7}, {256, 8}}) {
    spec::texture::Parameters p;
    p.cache_fifo_depth = 16;
    p.cache_outstanding = static_cast<std::int32_t>(outstanding);
    const TextureUnit unit(("unit_" + std::to_string(outstanding)).c_str(), clock, p);
    int found = 0;
    for (const LinkBase* link : unit.links())
      if (const Field* tag = link->payload().find("tag")) {
        EXPECT_EQ(tag->bits, bits) << link->name();
        ++found;
      }
    EXPECT_EQ(found, 2);
  }
}

// With width 1, colours_out has the fields and bits of one colour; above, a count and W colours.
TEST(TextureRtlTokens, ColourLinkFollowsWidth) {
  const auto names = [](const Payload& payload) {
    std::vector<std::string> all;
    for (const Field& field : payload.fields())
      all.push_back(field.name + " " + std::to_string(field.first_bit));
    return all;
  };
  const Payload colour = Payload::of<spec::texture::Colour>();
  spec::texture::Build p;
  EXPECT_EQ(names(Payload::of<spec::texture::ColourGroup>(colours_shape(p))), names(colour));
  for (const auto& [width, count_bits] : {std::pair{2, 2}, {4, 3}}) {
    p.width = width;
    const Payload wide = Payload::of<spec::texture::ColourGroup>(colours_shape(p));
    EXPECT_EQ(wide.bits(), static_cast<std::uint32_t>(count_bits) +
                               static_cast<std::uint32_t>(width) * colour.bits());
    EXPECT_EQ(wide.fields()[1].name, "colour.0.tag");
  }
}

// With `kernel = axis` one bit accompanies each fragment, and each of its requests.
TEST(TextureRtlTokens, SelectedKernelTakesOneBit) {
  const auto bits = [](const spec::texture::Parameters& p) {
    return std::array{Payload::of<FootprintToken>(footprint_shape(p)).bits(),
                      Payload::of<Log2Token>(axis_shape(p)).bits(),
                      Payload::of<LevelToken>(axis_shape(p)).bits(),
                      Payload::of<SampleToken>(sample_shape(p)).bits(),
                      Payload::of<TexelToken>(texel_shape(p)).bits(),
                      Payload::of<CacheToken>(cache_shape(p)).bits(),
                      Payload::of<TexelQuadToken>(texel_quad_shape(p)).bits()};
  };
  spec::texture::Parameters box, axis, two, wide;
  axis.kernel = two.kernel = spec::texture::Kernel::kAxis;
  auto expected = bits(box);
  for (std::uint32_t& one : expected) ++one;
  EXPECT_EQ(bits(axis), expected);
  // Positions of the longest tents need a bit more.
  axis.spread = 102;
  EXPECT_EQ(bits(axis), expected);
  axis.spread = 103;
  expected[3] += 2;
  EXPECT_EQ(bits(axis), expected);
  two.axes = spec::texture::Axes::kTwo;
  box.axes = two.axes;
  EXPECT_EQ(bits(two), bits(box));
  // Of a group, once per request.
  wide = preset_parameters(spec::texture::Preset::kDeburr, spec::texture::NamedBuild::kWide);
  const auto group = [&] { return Payload::of<CacheGroup>(cache_group_shape(wide)).bits(); };
  const std::uint32_t of_boxes = group();
  wide.kernel = spec::texture::Kernel::kAxis;
  EXPECT_EQ(group(), of_boxes + 4);
}

// By default, tokens have the widths that the largest caches need.
TEST(TextureRtlTokens, DefaultWidthsFitTheLargestCaches) {
  spec::texture::Parameters large, many;
  large.kernel = spec::texture::Kernel::kAxis;
  large.cache_line_bytes = 128;
  large.cache_bytes = 512 * 128;
  many.cache_line_bytes = 32;
  many.width = 4;
  many.decode = spec::texture::Decode::kBefore;
  many.cache_lookups = spec::texture::kMostLookups;
  large.decode = spec::texture::Decode::kAfter;
  EXPECT_EQ(Payload::of<CacheToken>(cache_shape(large)).bits(), Payload::of<CacheToken>().bits());
  EXPECT_EQ(Payload::of<MissToken>(miss_shape(many)).bits(), Payload::of<MissToken>().bits());
}

}  // namespace
}  // namespace deburr::rtl::texture::tokens_test
