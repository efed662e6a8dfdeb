// SPDX-License-Identifier: MIT
// The TexelAddresser against the functions of the golden model.
#include <cstdint>
#include <string>
#include <vector>

#include "golden/texture/sampling.h"
#include "rtl_model/texture/texel_addresser.h"
#include "tb/unit/rtl/texture/equivalence.h"

namespace deburr::tb::equivalence_texel_addresser_test {
namespace {

namespace gold = golden::texture;

Verdict compare_addresser(bool fault) {
  Pair<hw::SampleToken, hw::TexelToken> bench;
  Store store(bench.clock);
  hw::TexelAddresser unit("unit", bench.clock, store.descriptors.for_texels);
  unit.samples_in(bench.in);
  unit.texels_out(bench.out);
  Random random(7);
  constexpr std::int64_t kOne = spec::texture::kCoordinateOne;
  constexpr std::int64_t kFurthest = (std::int64_t{1} << 33) - 1;  // S9.24
  for (int batch = 0; batch < 40; ++batch) {
    Descriptors d;
    for (auto& one : d) one = stimuli::random_texture(random, kMemoryBytes);
    bench.reset();
    write(store, d);
    std::vector<hw::SampleToken> tokens;
    for (std::size_t h = 0; h < d.size(); ++h) {
      for (int i = 0; i < 1500; ++i) {
        const auto level = static_cast<std::uint8_t>(random.below(d[h].levels));
        const auto position = [&](std::uint16_t size) -> std::int64_t {
          switch (random.below(4)) {
            case 0:  // by a border of a texel, where the fraction and the pair of texels change
              return stimuli::any_of(
                         random, std::array<std::int64_t, 5>{-2 * kOne, -kOne, 0, kOne, 3 * kOne}) +
                     kOne * random.below(2u * size + 1) / (2 * gold::level_size(size, level)) +
                     stimuli::any_of(random, std::array<std::int64_t, 5>{-32768, -1, 0, 1, 32767});
            case 1:
              return stimuli::any_of(random,
                                     std::array<std::int64_t, 4>{kFurthest, -kFurthest - 1, -1, 0});
            case 2:
              return static_cast<std::int64_t>(random.next()) >> 30;
            default:
              return static_cast<std::int64_t>(random.below(1u << 25)) - kOne / 2;
          }
        };
        const std::int64_t s = position(d[h].width), t = position(d[h].height);
        hw::Ticket ticket = kTicket;
        ticket.texture = static_cast<std::uint8_t>(h);
        tokens.push_back({ticket, s, t, static_cast<std::uint16_t>(random.below(257)),
                          static_cast<std::uint8_t>(random.below(32)),
                          static_cast<std::uint8_t>(random.below(8)), level, random.chance(700),
                          random.chance(500), random.chance(200)});
      }
    }
    bench.run(
        tokens.size(),
        [&](std::uint64_t i) {
          hw::SampleToken token = tokens[i];
          if (fault && batch == 0 && i == kFaultyToken) token.index ^= 1;
          return token;
        },
        tokens.size(),
        [&](std::uint64_t i, const hw::TexelToken& got) {
          const hw::SampleToken& in = tokens[i];
          const spec::texture::Descriptor& t = d[in.ticket.texture];
          const auto place = in.linear ? gold::linear_position : gold::nearest_position;
          const gold::TexelPosition x = place(t.wrap_s, in.s, gold::level_size(t.width, in.level)),
                                    y = place(t.wrap_t, in.t, gold::level_size(t.height, in.level));
          const auto address = [&](std::int32_t column, std::int32_t row) {
            return gold::texel_address(t, in.level, column, row);
          };
          const hw::FilterControl& c = got.control;
          return got.address == std::array{address(x.i0, y.i0), address(x.i1, y.i0),
                                           address(x.i0, y.i1), address(x.i1, y.i1)} &&
                 c.fraction_u == x.fraction && c.fraction_v == y.fraction &&
                 c.level_weight == in.level_weight && c.index == in.index &&
                 c.last_index == in.last_index && c.format == static_cast<std::uint8_t>(t.format) &&
                 c.last_of_sample == in.last_of_sample && c.last_of_fragment == in.last_of_fragment;
        });
  }
  return bench.verdict;
}

TEST(AddresserEquivalence, UnitIsTheFunction) { expect_equal(compare_addresser(false), 900'000); }
TEST(AddresserEquivalence, NoticesAWrongBit) { expect_noticed(compare_addresser(true)); }

}  // namespace
}  // namespace deburr::tb::equivalence_texel_addresser_test
