// SPDX-License-Identifier: MIT
// The DataStage in the cache: bank passes, texels anywhere in a line, and hits in lines that are
// replaced by the same request.
#include "tb/unit/rtl/texture/cache_bench.h"

namespace deburr::tb::texture_rtl {
namespace {

using namespace rtl::texture;
using testing::ElementsAre;

TEST(TextureRtlDataStage, OneByteAndTwoByteTexelsAnywhereInALine) {
  CacheBench b;
  for (const auto& [format, mask] : {std::pair{spec::texture::Format::kL8, 0xFFu},
                                     std::pair{spec::texture::Format::kRgb565, 0xFFFFu}}) {
    const std::uint32_t step = format == spec::texture::Format::kL8 ? 1 : 2;
    // Cold and warm: from the fill and from the banks.
    const std::uint32_t base = format == spec::texture::Format::kL8 ? 0x1000 : 0x2000;
    for (int twice = 0; twice < 2; ++twice)
      for (std::uint32_t at = base; at < base + 128; at += 4 * step) {
        TexelToken t = request({at, at + step, at + 2 * step, at + 3 * step});
        t.control.format = static_cast<std::uint8_t>(format);
        b.time_of(t);
        for (std::size_t k = 0; k < 4; ++k) {
          const std::uint32_t byte = t.address[k] & 3;
          EXPECT_EQ(b.ends.sink.taken.back().token.texel[k],
                    CacheBench::word(t.address[k] - byte) >> (8 * byte) & mask);
        }
      }
  }
}

// A hit and a miss that overwrites it, in one request.
TEST(TextureRtlDataStage, HitIsReadBeforeItsLineIsOverwritten) {
  spec::texture::Parameters p = small_cache();
  p.cache_ways = 1;
  CacheBench b(p);
  const std::vector<TexelToken> asked = {in_line(0), request({0, 4, 64 * 4, 64 * 4 + 4}),
                                         in_line(4)};
  for (const auto& t : asked) b.ends.source.add(t);
  b.clock.run(100);
  b.check_data(asked);
  EXPECT_THAT(b.memory.lines_read(), ElementsAre(0, 256));
}

TEST(TextureRtlDataStage, BankPasses) {
  CacheBench b;
  const auto conflicting = [](bool column, bool row, std::array<std::uint8_t, 4> bank) {
    TexelToken t = request({0, 20, 40, 60});
    t.column_conflict = column;
    t.row_conflict = row;
    t.bank = bank;
    return t;
  };
  const TexelToken plain = in_line(0), columns = conflicting(true, false, {0, 0, 2, 2}),
                   rows = conflicting(false, true, {0, 1, 0, 1}),
                   both = conflicting(true, true, {3, 3, 3, 3});
  b.time_of(plain);
  EXPECT_EQ(b.time_of(columns), kHit + 1);
  EXPECT_EQ(b.time_of(rows), kHit + 1);
  EXPECT_EQ(b.time_of(both), kHit + 3);
  // One after the other: 1, 2, 2, 4 clocks each.
  const std::size_t first = b.ends.sink.taken.size();
  const Cycle start = b.clock.cycle() + 1;
  for (const auto& t : {plain, columns, plain, rows, both, plain}) b.ends.source.add(t);
  b.clock.run(40);
  std::vector<Cycle> when;
  for (std::size_t i = first; i < b.ends.sink.taken.size(); ++i)
    when.push_back(b.ends.sink.taken[i].cycle - start - kHit);
  EXPECT_THAT(when, ElementsAre(0, 2, 3, 5, 9, 10));
  EXPECT_EQ(b.cache.data_stage.conflicts.value(), 6u);
  const auto stalls = b.cache.data_stage.stalls();
  ASSERT_EQ(stalls[3].name, "bank_conflict");
  EXPECT_EQ(stalls[3].cycles, 2u * (1 + 1 + 3));
  for (const auto& t : b.ends.sink.taken)
    for (const std::uint32_t texel : t.token.texel) EXPECT_NE(texel, 0u);
}

// Two texels of one bank that hit, in lines which the two misses of the same request replace: the
// second line has to wait for the second pass.
TEST(TextureRtlDataStage, PassesBeforeFills) {
  spec::texture::Parameters p = small_cache();
  p.cache_ways = 1;
  CacheBench b(p);
  TexelToken clash = request({0, 64, 64 * 4, 64 * 5});
  clash.column_conflict = true;
  clash.bank = {0, 0, 2, 2};
  TexelToken one_hit = request({64 * 4, 64 * 4 + 4, 0, 4});
  one_hit.column_conflict = true;
  one_hit.bank = {0, 0, 2, 2};
  const std::vector<TexelToken> asked = {in_line(0), in_line(1), clash, one_hit, in_line(5)};
  for (const auto& t : asked) b.ends.source.add(t);
  b.clock.run(100);
  b.check_data(asked);
  EXPECT_THAT(b.memory.lines_read(), ElementsAre(0, 64, 256, 320, 0));
}

}  // namespace
}  // namespace deburr::tb::texture_rtl
