// SPDX-License-Identifier: MIT
// The datasheets of the texture unit: every block has one that matches the contract.
#include "rtl_model/texture/datasheets.h"

#include <cstdint>
#include <string>

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::datasheets_test {
namespace {

TEST(TextureRtlDatasheets, MatchTheContract) {
  const std::string decode = "`decode = after`", before = "`decode = before`",
                    blocks = decode + " or `before`",
                    wide_data =
                        "WideDataStage, `width = 4`, 64 banks, `cache.bank_reads = 2`, "
                        "`cache.fill_writes = 4`";
  const std::string four = "`axes = four` or `eight`",
                    sets = "128 sets of 2 ways, `cache.replacement = lru`";
  expect_contract(
      rtl::texture::datasheets(),
      {{"TextureUnit, `preset = paper`", 30, 1},
       {"TextureUnit, `preset = deburr`", 53, 1},
       {"AddressUnit, `preset = paper`", 17, 1},
       {"AddressUnit, `preset = deburr`", 40, 1},
       {"TextureCache, `width = 1`", 5, 1},
       {"TextureCache, `width` above 1", 7, 1},
       {"TextureCache, `width = 1`, " + decode, 8, 1},
       {"TextureCache, `width` above 1, " + decode, 10, 1},
       {"DerivativeUnit", 3, 1},
       {"FootprintUnit, `footprint = half`", 2, 1},
       {"FootprintUnit, `footprint = exact`", 19, 1},
       {"AxisUnit, `axes = four`, `footprint = exact`", 22, 1},
       {"AxisUnit, `axes = eight`, `footprint = half`", 8, 1},
       {"Log2Unit, `log2 = mitchell`, `axes = two`", 1, 1},
       {"Log2Unit, `log2 = exact`, `axes = two`", 3, 1},
       {"Log2Unit, `log2 = segments`, " + four, 3, 1},
       {"LevelUnit, `count = floor`, `axes = two`", 3, 1},
       {"LevelUnit, `count = any`, " + four, 3, 1},
       {"SampleWalker, `count = floor`, `axes = two`", 3, 1},
       {"SampleWalker, `count = any`, " + four, 4, 1},
       {"SampleWalker, `count = any`, " + four + ", `width = 4`", 4, 1},
       {"SampleWalker, `count = any`, " + four + ", `kernel = axis`", 4, 1},
       {"TexelAddresser, `width = 1`", 5, 1},
       {"TexelAddresser, `width` above 1", 5, 1},
       {"TexelAddresser, `width = 1`, " + blocks, 5, 1},
       {"TexelAddresser, `width` above 1, " + blocks, 5, 1},
       {"GroupFormer, `width = 4`, `cache.lookups = 8`", 2, 1},
       {"GroupFormer, `width = 4`, `cache.lookups = 8`, " + decode, 2, 1},
       {"GroupFormer, `width = 4`, `cache.lookups = 8`, " + before, 2, 1},
       {"TagStage, " + sets + ", " + before, 2, 1},
       {"WideTagStage, " + sets + ", `cache.lookups = 8`, `cache.allocations = 4`, " + before, 2,
        1},
       {"MissQueue, 64 entries, `cache.lookups = 4`, " + before, 0, 1},
       {"MissQueue, 128 entries, `cache.lookups = 8`, " + before, 0, 1},
       {"BlockFetcher, `cache.compressed_lines = 16`, 64 entries, `bc = truncated`", 5, 1},
       {"BlockFetcher, `cache.compressed_lines = 16`, 128 entries, `bc = truncated`", 5, 1},
       {"TagStage, " + sets, 2, 1},
       {"TagStage, " + sets + ", " + decode, 2, 1},
       {"WideTagStage, " + sets + ", `cache.lookups = 8`, `cache.allocations = 4`", 2, 1},
       {"WideTagStage, " + sets + ", `cache.lookups = 8`, `cache.allocations = 4`, " + decode, 2,
        1},
       {"MissQueue, 64 entries, `cache.lookups = 4`", 0, 1},
       {"MissQueue, 128 entries, `cache.lookups = 8`", 0, 1},
       {"FillBuffer, 64 entries, `cache.fill_writes = 1`", 2, 1},
       {"FillBuffer, 128 entries, `cache.fill_writes = 4`", 2, 1},
       {"LatencyFifo", 1, 1},
       {"WideLatencyFifo", 1, 1},
       {"DataStage, 16 banks of 256 words", 2, 1},
       {"DataStage, 16 banks of 256 words, " + decode, 2, 1},
       {wide_data, 2, 1},
       {wide_data + ", " + decode, 2, 1},
       {"BlockDecoder, `width = 1`, `cache.decoders = 4`, `bc = truncated`", 3, 1},
       {"BlockDecoder, `width = 4`, `cache.decoders = 6`, `bc = truncated`", 3, 1},
       {"FilterPipeline, `srgb_output = linear`, no ROM `weights`", 8, 1},
       {"FilterPipeline, `srgb_output = linear`, ROM `weights`", 8, 1},
       {"FilterPipeline, `srgb_output = linear`, ROM `weights`, `width = 4`", 8, 1},
       {"FilterPipeline, `srgb_output = encoded`, ROM `weights`", 9, 1},
       {"Descriptors", 0, 1},
       {"Descriptors, " + blocks, 0, 1}});
}

TEST(TextureRtlDatasheets, CoverEveryUnitOfPresetPaper) {
  const UnitBench b;
  expect_datasheets(b.unit, rtl::texture::datasheets(stimuli::paper_configuration()));
}
TEST(TextureRtlDatasheets, CoverEveryUnitWithDecoders) {
  spec::texture::Parameters p;
  p.decode = spec::texture::Decode::kAfter;
  const UnitBench b(p);
  expect_datasheets(b.unit, rtl::texture::datasheets(p));
}
TEST(TextureRtlDatasheets, CoverEveryUnitWithFetcher) {
  spec::texture::Parameters p;
  p.decode = spec::texture::Decode::kBefore;
  const UnitBench b(p);
  expect_datasheets(b.unit, rtl::texture::datasheets(p));
}
TEST(TextureRtlDatasheets, CoverEveryUnitOfPresetDeburr) {
  const UnitBench b(spec::texture::Parameters{});
  expect_datasheets(b.unit, rtl::texture::datasheets({}));
}

// Operators of a build, with all their copies.
std::uint32_t operators(const spec::texture::Parameters& p, const std::string& unit,
                        rtl::OperatorKind kind) {
  std::uint32_t count = 0;
  for (const rtl::Datasheet& sheet : rtl::texture::datasheets(p))
    for (const rtl::Operator& one : operators_of(sheet))
      if (sheet.unit == unit && one.kind == kind) count += one.count;
  return count;
}

TEST(TextureRtlDatasheets, OperatorsFollowTheBuild) {
  using Kind = rtl::OperatorKind;
  spec::texture::Parameters p, twice;
  p.width = p.fragments = 2;
  twice.width = twice.fragments = 4;
  for (const char* unit :
       {"DerivativeUnit", "AxisUnit", "SampleWalker", "TexelAddresser", "FilterPipeline"}) {
    EXPECT_NE(operators(p, unit, Kind::kMultiply), 0u) << unit;
    EXPECT_EQ(operators(twice, unit, Kind::kMultiply), 2 * operators(p, unit, Kind::kMultiply))
        << unit;
  }
  EXPECT_EQ(operators({}, "AxisUnit", Kind::kRootStage), 16u);
  EXPECT_EQ(operators(stimuli::paper_configuration(), "AxisUnit", Kind::kRootStage), 0u);
  EXPECT_EQ(operators(stimuli::paper_configuration(), "FootprintUnit", Kind::kSquare), 0u);
  // A constant is additions, a power of two wires.
  EXPECT_EQ(operators({}, "SampleWalker", Kind::kMultiplyConstant), 0u);
  p.spread = 96;
  EXPECT_EQ(operators(p, "SampleWalker", Kind::kMultiplyConstant), 2 * 2u);
  // With `kernel = axis` a tent's spread is 91 = 128 - 32 - 4 - 1.
  p = {};
  p.kernel = spec::texture::Kernel::kAxis;
  EXPECT_EQ(operators(p, "SampleWalker", Kind::kMultiplyConstant), 2u);
  p = {};
  p.axis_cycles = 2;
  EXPECT_EQ(operators(p, "AxisUnit", Kind::kSquare), operators({}, "AxisUnit", Kind::kSquare) / 2);
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::datasheets_test
