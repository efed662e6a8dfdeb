// SPDX-License-Identifier: MIT
// The DerivativeUnit against the functions of the golden model.
#include <cstdint>
#include <string>
#include <vector>

#include "golden/texture/footprint.h"
#include "rtl_model/texture/derivative_unit.h"
#include "tb/unit/rtl/texture/equivalence.h"

namespace deburr::tb::equivalence_derivative_unit_test {
namespace {

namespace gold = golden::texture;

Verdict compare_derivative(bool fault) {
  Pair<spec::texture::Quad, hw::DerivativeToken> bench;
  Store store(bench.clock);
  rtl::LatencyProbe probe;
  hw::DerivativeUnit unit("unit", bench.clock, store.control, store.descriptors.for_derivatives,
                          probe);
  unit.quads_in(bench.in);
  unit.derivatives_out(bench.out);
  Random random(4);
  for (int batch = 0; batch < 8; ++batch) {
    Descriptors d;
    for (auto& one : d) one = stimuli::random_texture(random, kMemoryBytes);
    bench.reset();
    write(store, d);
    struct Lane {
      std::size_t quad, lane;
      bool last;
    };
    std::vector<spec::texture::Quad> quads;
    std::vector<Lane> lanes;
    std::uint64_t saturated = 0, clamped = 0;
    for (std::uint32_t tag = 0; tag < 4000; ++tag) {
      quads.push_back(
          stimuli::random_quad(random, tag, static_cast<std::uint8_t>(random.below(16))));
      for (std::size_t lane = 0; lane < 4; ++lane)
        if (quads.back().coverage >> lane & 1) {
          lanes.push_back({tag, lane, quads.back().coverage >> (lane + 1) == 0});
          clamped += quads.back().clamped >> lane & 1;
        }
    }
    bench.run(
        quads.size(),
        [&](std::uint64_t i) {
          spec::texture::Quad q = quads[i];
          if (fault && batch == 0 && i == kFaultyToken) {
            q.coverage = quads[i].coverage;
            q.tag ^= 1;
          }
          return q;
        },
        lanes.size(),
        [&](std::uint64_t i, const hw::DerivativeToken& got) {
          probe.leaves(bench.clock.cycle());
          const Lane& at = lanes[i];
          const spec::texture::Quad& q = quads[at.quad];
          const spec::texture::Descriptor& t = d[q.texture];
          const std::size_t row = at.lane & 2, column = at.lane & 1;
          const auto minus = [](std::int32_t a, std::int32_t b) { return std::int64_t{a} - b; };
          const std::int64_t s_x = minus(q.s[row + 1], q.s[row]),
                             t_x = minus(q.t[row + 1], q.t[row]),
                             s_y = minus(q.s[column + 2], q.s[column]),
                             t_y = minus(q.t[column + 2], q.t[column]);
          const gold::Derivative size_s_x = gold::derivative_in_texels(s_x, t.width),
                                 size_t_x = gold::derivative_in_texels(t_x, t.height),
                                 size_s_y = gold::derivative_in_texels(s_y, t.width),
                                 size_t_y = gold::derivative_in_texels(t_y, t.height);
          saturated +=
              size_s_x.saturated || size_t_x.saturated || size_s_y.saturated || size_t_y.saturated;
          const auto size = [](std::uint32_t magnitude, std::int64_t difference) {
            return difference < 0 ? -std::int64_t{magnitude} : std::int64_t{magnitude};
          };
          return got.ticket.tag == q.tag && got.ticket.lane == at.lane &&
                 got.ticket.last == at.last && got.ticket.valid &&
                 got.ticket.texture == q.texture && got.s == q.s[at.lane] &&
                 got.t == q.t[at.lane] && got.s_x == s_x && got.t_x == t_x && got.s_y == s_y &&
                 got.t_y == t_y && size(got.size_s_x, s_x) == size_s_x.texels &&
                 size(got.size_t_x, t_x) == size_t_x.texels &&
                 size(got.size_s_y, s_y) == size_s_y.texels &&
                 size(got.size_t_y, t_y) == size_t_y.texels;
        });
    EXPECT_EQ(unit.saturated.value(), saturated);
    EXPECT_EQ(unit.clamped.value(), clamped);
    EXPECT_GT(saturated, 0u);
  }
  return bench.verdict;
}

TEST(DerivativeEquivalence, UnitIsTheFunction) { expect_equal(compare_derivative(false), 80'000); }
TEST(DerivativeEquivalence, NoticesAWrongBit) { expect_noticed(compare_derivative(true), 4); }

}  // namespace
}  // namespace deburr::tb::equivalence_derivative_unit_test
