// SPDX-License-Identifier: MIT
// The SampleWalker against the functions of the golden model.
#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "golden/texture/sampling.h"
#include "rtl_model/texture/sample_walker.h"
#include "tb/unit/rtl/texture/equivalence.h"

namespace deburr::tb::equivalence_sample_walker_test {
namespace {

namespace gold = golden::texture;

constexpr std::array<std::int64_t, 7> kAxisCorners = {
    0, 1, -1, (std::int64_t{1} << 32) - 1, 1 - (std::int64_t{1} << 32), 1 << 20, -(1 << 23)};

Verdict compare_walker(spec::texture::CountRule count, spec::texture::Kernel kernel,
                       std::int32_t spread, bool fault) {
  Pair<hw::LevelToken, hw::SampleToken> bench;
  hw::SampleWalker unit("unit", bench.clock, count, kernel, spread);
  const bool any = count == spec::texture::CountRule::kAny;
  unit.levels_in(bench.in);
  unit.samples_out(bench.out);

  std::vector<hw::LevelToken> tokens;
  struct Request {
    std::size_t token;
    int sample;
    bool second;
  };
  std::vector<Request> requests;
  Random random(6);
  for (std::size_t i = 0; i < 30'000; ++i) {
    const auto axis = [&] {
      if (random.chance(300)) return stimuli::any_of(random, kAxisCorners);
      return static_cast<std::int64_t>(random.next()) >> (31 + random.below(30));
    };
    const std::int64_t axis_s = axis(), axis_t = axis();
    hw::LevelToken t = {
        kTicket,
        stimuli::any_of(random, stimuli::kCoordinateCorners),
        static_cast<std::int32_t>(random.next()),
        axis_s,
        axis_t,
        static_cast<std::uint8_t>(any ? random.below(16) : (1u << random.below(5)) - 1),
        static_cast<std::uint8_t>(random.below(12)),
        static_cast<std::uint8_t>(random.chance(300) ? 0 : random.below(256)),
        random.chance(500)};
    t.ticket.tag = static_cast<std::uint32_t>(i);
    for (int sample = 0; sample <= t.last_index; ++sample) {
      requests.push_back({i, sample, false});
      if (t.fraction != 0) requests.push_back({i, sample, true});
    }
    tokens.push_back(t);
  }
  bench.run(
      tokens.size(),
      [&](std::uint64_t i) {
        hw::LevelToken token = tokens[i];
        if (fault && i == kFaultyToken) token.s ^= 1 << 10;
        return token;
      },
      requests.size(),
      [&](std::uint64_t i, const hw::SampleToken& got) {
        const Request& r = requests[i];
        const hw::LevelToken& t = tokens[r.token];
        const int n = t.last_index + 1;
        const std::int32_t length = gold::spread_of(kernel, n, spread);
        const bool last_of_sample = r.second || t.fraction == 0;
        return got.s == t.s + gold::sample_offset(r.sample, n, length, t.axis_s) &&
               got.t == t.t + gold::sample_offset(r.sample, n, length, t.axis_t) &&
               got.index == r.sample && got.last_index == n - 1 &&
               got.level_weight == (r.second ? t.fraction : 256 - t.fraction) &&
               got.level == t.level + (r.second ? 1 : 0) && got.linear == t.linear &&
               got.last_of_sample == last_of_sample &&
               got.last_of_fragment == (last_of_sample && r.sample == n - 1) &&
               got.ticket.tag == t.ticket.tag;
      });
  return bench.verdict;
}

class WalkerEquivalence : public testing::TestWithParam<std::tuple<int, int, int>> {};

TEST_P(WalkerEquivalence, UnitIsTheFunction) {
  const auto [count, kernel, spread] = GetParam();
  expect_equal(compare_walker(static_cast<spec::texture::CountRule>(count),
                              static_cast<spec::texture::Kernel>(kernel), spread, false),
               200'000);
}

INSTANTIATE_TEST_SUITE_P(Texture, WalkerEquivalence,
                         testing::Combine(testing::Values(0, 2), testing::Range(0, 2),
                                          testing::Values(0, 1, 64, 102, 128)),
                         [](const auto& p) {
                           const auto i = [](int v) { return static_cast<std::size_t>(v); };
                           return fmt::format("{}_{}_{}",
                                              spec::texture::kCountNames[i(std::get<0>(p.param))],
                                              spec::texture::kKernelNames[i(std::get<1>(p.param))],
                                              std::get<2>(p.param));
                         });

TEST(WalkerEquivalence, NoticesAWrongBit) {
  expect_noticed(
      compare_walker(spec::texture::CountRule::kFloor, spec::texture::Kernel::kBox, 64, true), 32);
}

}  // namespace
}  // namespace deburr::tb::equivalence_sample_walker_test
