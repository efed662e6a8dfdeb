// SPDX-License-Identifier: MIT
// What links carry, by number format.
#include "rtl_model/texture/tokens.h"

#include "tb/unit/rtl/formats.h"

namespace deburr::rtl::texture {
namespace {

TEST(TextureRtlTokens, FieldsHaveTheBitsOfTheirFormat) {
  const int checked = tb::expect_widths_of_formats<DerivativeToken, FootprintToken, Log2Token,
                                                   LevelToken, SampleToken, TexelToken, MissToken,
                                                   CacheToken, TexelQuadToken>();
  EXPECT_GE(checked, 33);
}

}  // namespace
}  // namespace deburr::rtl::texture
