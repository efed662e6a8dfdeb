// SPDX-License-Identifier: MIT
// The datasheets of the texture unit: every block has one that matches the contract.
#include "rtl_model/texture/datasheets.h"

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::datasheets_test {
namespace {

TEST(TextureRtlDatasheets, MatchTheContract) {
  expect_contract(rtl::texture::datasheets(), {{"TextureUnit, `preset = paper`", 30, 1},
                                               {"TextureUnit, `preset = deburr`", 53, 1},
                                               {"AddressUnit, `preset = paper`", 17, 1},
                                               {"AddressUnit, `preset = deburr`", 40, 1},
                                               {"TextureCache, `width = 1`", 5, 1},
                                               {"TextureCache, `width` above 1", 7, 1},
                                               {"DerivativeUnit", 3, 1},
                                               {"FootprintUnit, other `footprint`", 2, 1},
                                               {"FootprintUnit, `footprint = exact`", 19, 1},
                                               {"AxisUnit, `footprint = exact`", 22, 1},
                                               {"AxisUnit, other `footprint`", 8, 1},
                                               {"Log2Unit, `log2 = mitchell`", 1, 1},
                                               {"Log2Unit, other `log2`", 3, 1},
                                               {"LevelUnit", 3, 1},
                                               {"SampleWalker, other `count`", 3, 1},
                                               {"SampleWalker, `count = any`", 4, 1},
                                               {"TexelAddresser", 5, 1},
                                               {"GroupFormer", 2, 1},
                                               {"TagStage", 2, 1},
                                               {"WideTagStage", 2, 1},
                                               {"MissQueue", 0, 1},
                                               {"FillBuffer", 2, 1},
                                               {"LatencyFifo", 1, 1},
                                               {"WideLatencyFifo", 1, 1},
                                               {"DataStage", 2, 1},
                                               {"WideDataStage", 2, 1},
                                               {"FilterPipeline, `srgb_output = linear`", 8, 1},
                                               {"FilterPipeline, `srgb_output = encoded`", 9, 1},
                                               {"Descriptors", 0, 1}});
}

TEST(TextureRtlDatasheets, CoverEveryUnitOfPresetPaper) {
  const UnitBench b;
  expect_datasheets(b.unit, rtl::texture::datasheets(stimuli::paper_configuration()));
}
TEST(TextureRtlDatasheets, CoverEveryUnitOfPresetDeburr) {
  const UnitBench b(spec::texture::Parameters{});
  expect_datasheets(b.unit, rtl::texture::datasheets({}));
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::datasheets_test
