// SPDX-License-Identifier: MIT
// What links carry, by number format and by the tables of the page; and the figures of the engine.
#include "rtl_model/texture/tokens.h"

#include "tb/unit/rtl/figure.h"
#include "tb/unit/rtl/formats.h"
#include "tb/unit/rtl/page_table.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::rtl::texture::tokens_test {
namespace {

TEST(TextureRtlTokens, FieldsHaveTheBitsOfTheirFormat) {
  const int checked = tb::expect_widths_of_formats<DerivativeToken, FootprintToken, Log2Token,
                                                   LevelToken, SampleToken, TexelToken, MissToken,
                                                   CacheToken, TexelQuadToken>();
  EXPECT_GE(checked, 33);
}

TEST(TextureRtlTokens, LinksAreThoseOfThePage) {
  const tb::EnginePage table("reference/texture/hardware.md", "link");
  ClockDomain clock("clock", tb::texture_rtl::period());
  spec::texture::Parameters paper = tb::paper_rules(), deburr, largest;
  paper.cache_fifo_depth = deburr.cache_fifo_depth = largest.cache_fifo_depth = 107;
  largest.cache_line_bytes = 128;
  largest.cache_bytes = TagStore::kMostLines * largest.cache_line_bytes;
  largest.cache_outstanding = 256;
  table.expect_links("paper", TextureUnit("paper", clock, paper));
  table.expect_links("deburr", TextureUnit("deburr", clock, deburr));
  table.expect_links("largest cache", TextureUnit("largest", clock, largest));
}

TEST(TextureRtlTokens, WiresAreThoseOfThePage) {
  ClockDomain clock("clock", tb::texture_rtl::period());
  TextureUnit unit("unit", clock, {});
  tb::EnginePage("reference/texture/hardware.md", "wire").expect_wires(unit);
}

TEST(TextureRtlTokens, MemoriesAreThoseOfThePage) {
  ClockDomain clock("clock", tb::texture_rtl::period());
  spec::texture::Parameters p;
  p.cache_fifo_depth = 107;
  p.log2 = spec::texture::Log2Rule::kExact;
  p.srgb_output = spec::texture::SrgbOutput::kEncoded;
  tb::EnginePage("reference/texture/hardware.md", "memory")
      .expect_memories(TextureUnit("unit", clock, p));
}

// In both builds: an AxisUnit stands in the place of the FootprintUnit.
TEST(TextureFigures, AreTheModuleTree) {
  ClockDomain clock("clock", tb::texture_rtl::period());
  const std::string header = "rtl_model/texture/texture_unit.h",
                    address = "rtl_model/texture/address_unit.h",
                    cache = "rtl_model/texture/texture_cache.h";
  for (const auto& [name, axes] : {std::pair{"two", spec::texture::Axes::kTwo},
                                   std::pair{"eight", spec::texture::Axes::kEight}}) {
    spec::texture::Parameters p;
    p.cache_fifo_depth = 107;
    p.axes = axes;
    const TextureUnit unit(name, clock, p);
    tb::expect_figure(tb::Figure::of_header(header), unit, header, "TextureCache");
    tb::expect_figure(tb::Figure::of_page("reference/texture/index.md"), unit, header,
                      "FilterPipeline", {address, cache});
    tb::expect_figure(tb::Figure::of_header(address), unit.address, address, "AxisUnit");
    tb::expect_figure(tb::Figure::of_header(cache), unit.cache, cache, "MissQueue");
  }
}

// Without an order of the ways a set is its tags and two bits a way.
TEST(TextureRtlTokens, RandomReplacementKeepsNoOrder) {
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

// By half a tile of 64 bytes, or half of a line that is shorter.
TEST(TextureRtlTokens, LinesTurnByHalfATile) {
  EXPECT_EQ(turn_bytes(32), 16U);
  EXPECT_EQ(turn_bytes(64), 32U);
  EXPECT_EQ(turn_bytes(128), 32U);
}

// As many bits of a tag as the entries of the fill buffer need, and no more.
TEST(TextureRtlTokens, TagsNumberTheEntries) {
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

// What the largest caches need is what the tokens list.
TEST(TextureRtlTokens, ListNoMoreThanTheLargestCacheNeeds) {
  spec::texture::Build large, many;
  large.cache_line_bytes = 128;
  large.cache_bytes = 512 * 128;
  many.cache_line_bytes = 32;
  EXPECT_EQ(Payload::of<CacheToken>(cache_shape(large)).bits(), Payload::of<CacheToken>().bits());
  EXPECT_EQ(Payload::of<MissToken>(miss_shape(many)).bits(), Payload::of<MissToken>().bits());
}

}  // namespace
}  // namespace deburr::rtl::texture::tokens_test
