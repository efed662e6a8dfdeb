// SPDX-License-Identifier: MIT
// What links carry, by number format and by the tables of the page.
#include "rtl_model/texture/tokens.h"

#include "tb/unit/rtl/formats.h"
#include "tb/unit/rtl/texture/support.h"
#include "tb/unit/rtl/wires.h"

namespace deburr::rtl::texture {
namespace {

TEST(TextureRtlTokens, FieldsHaveTheBitsOfTheirFormat) {
  const int checked = tb::expect_widths_of_formats<DerivativeToken, FootprintToken, Log2Token,
                                                   LevelToken, SampleToken, TexelToken, MissToken,
                                                   CacheToken, TexelQuadToken>();
  EXPECT_GE(checked, 33);
}

TEST(TextureRtlTokens, LinksAreThoseOfThePage) {
  const tb::WireTable table("texture_unit.md");
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

}  // namespace
}  // namespace deburr::rtl::texture
