// SPDX-License-Identifier: MIT
// What links carry, by number format.
#include "rtl_model/morphological/tokens.h"

#include "tb/unit/rtl/formats.h"

namespace deburr::rtl::morphological {
namespace {

TEST(Tokens, FieldsHaveTheBitsOfTheirFormat) {
  const int checked =
      tb::expect_widths_of_formats<SlotToken, BeatToken, LumaToken, EdgeToken, AreaSlotToken,
                                   FetchToken, DiagonalColumnsToken, DiagonalSharesToken,
                                   ShareToken, PixelToken, RunToken, SumsToken, LineToken,
                                   FinishToken, FrameDoneToken>();
  EXPECT_GE(checked, 35);
}

}  // namespace
}  // namespace deburr::rtl::morphological
