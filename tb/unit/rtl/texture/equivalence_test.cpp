// SPDX-License-Identifier: MIT
// Compares each unit of the texture pipeline with the golden model's function of the same name: one
// suite, one row per unit.
#include "tb/unit/rtl/texture/equivalence.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "golden/texture/footprint.h"
#include "golden/texture/level_of_detail.h"
#include "golden/texture/sampling.h"
#include "rtl_model/texture/axis_unit.h"
#include "rtl_model/texture/derivative_unit.h"
#include "rtl_model/texture/filter_pipeline.h"
#include "rtl_model/texture/footprint_unit.h"
#include "rtl_model/texture/level_unit.h"
#include "rtl_model/texture/log2_unit.h"
#include "rtl_model/texture/sample_walker.h"
#include "rtl_model/texture/texel_addresser.h"
#include "tb/base/apply_settings.h"
#include "tb/unit/rtl/texture/filter_work.h"

namespace deburr::tb::equivalence_test {
namespace {

using stimuli::any_of;
using stimuli::kCoordinateCorners;
using stimuli::random_quad;
using stimuli::random_texture;

namespace gold = golden::texture;
using spec::texture::Parameters;

// As in the tokens: a magnitude with the sign of the difference it came from.
std::int64_t signed_size(std::uint32_t magnitude, std::int64_t difference) {
  return difference < 0 ? -std::int64_t{magnitude} : std::int64_t{magnitude};
}

// ---- DerivativeUnit ----------------------------------------------------------------------------

Verdict compare_derivative(const Parameters&, bool fault) {
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
    for (auto& one : d) one = random_texture(random, kMemoryBytes);
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
      quads.push_back(random_quad(random, tag, static_cast<std::uint8_t>(random.below(16))));
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
          if (fault && batch == 0 && i == kFaultyToken) q.tag ^= 1;
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
          return got.ticket.tag == q.tag && got.ticket.lane == at.lane &&
                 got.ticket.last == at.last && got.ticket.valid &&
                 got.ticket.texture == q.texture && got.s == q.s[at.lane] &&
                 got.t == q.t[at.lane] && got.s_x == s_x && got.t_x == t_x && got.s_y == s_y &&
                 got.t_y == t_y && signed_size(got.size_s_x, s_x) == size_s_x.texels &&
                 signed_size(got.size_t_x, t_x) == size_t_x.texels &&
                 signed_size(got.size_s_y, s_y) == size_s_y.texels &&
                 signed_size(got.size_t_y, t_y) == size_t_y.texels;
        });
    EXPECT_EQ(unit.saturated.value(), saturated);
    EXPECT_EQ(unit.clamped.value(), clamped);
    EXPECT_GT(saturated, 0u);
  }
  return bench.verdict;
}

// ---- FootprintUnit -----------------------------------------------------------------------------

constexpr std::uint32_t kLargestSide = 0x7FFFFFFF;  // U15.16

std::vector<std::uint32_t> side_corners() {
  std::vector<std::uint32_t> all = {0, kLargestSide, kLargestSide - 1};
  for (int bit = 0; bit < 31; ++bit)
    for (const int offset : {-1, 0, 1})
      all.push_back(((1u << bit) + static_cast<std::uint32_t>(offset)) & kLargestSide);
  return all;
}

// Exhaustive for short sides. The root has no combinational part and is compared through the
// pipeline below.
Verdict compare_side(const Parameters& p, bool fault) {
  Verdict v;
  const auto compare = [&](std::uint32_t s, std::uint32_t t) {
    const std::uint32_t faulty = fault && v.compared == kFaultyToken ? s ^ 1u << 20 : s;
    ++v.compared;
    if (hw::FootprintUnit::side(p.footprint, faulty, t) != gold::footprint_side(p.footprint, s, t))
      ++v.mismatches;
  };
  for (std::uint32_t s = 0; s < 1024; ++s)
    for (std::uint32_t t = 0; t < 1024; ++t) compare(s, t);
  const std::vector<std::uint32_t> corners = side_corners();
  for (const std::uint32_t s : corners)
    for (const std::uint32_t t : corners) compare(s, t);
  Random random(2);
  for (int i = 0; i < 500'000; ++i) {
    const std::uint64_t bits = random.next();
    compare(static_cast<std::uint32_t>(bits) & kLargestSide,
            static_cast<std::uint32_t>(bits >> 32) & kLargestSide >> random.below(31));
  }
  return v;
}

Verdict compare_footprint(const Parameters& p, bool fault) {
  Pair<hw::DerivativeToken, hw::FootprintToken> bench;
  hw::FootprintUnit unit("unit", bench.clock, p.footprint);
  unit.derivatives_in(bench.in);
  unit.footprints_out(bench.out);

  std::vector<hw::DerivativeToken> tokens;
  Random random(3);
  const auto add = [&](std::uint32_t s_x, std::uint32_t t_x, std::uint32_t s_y, std::uint32_t t_y) {
    const auto i = static_cast<std::int64_t>(tokens.size());
    tokens.push_back({kTicket, 1, 2, i, i + 1, -i, -i - 1, s_x, t_x, s_y, t_y});
  };
  const std::vector<std::uint32_t> corners = side_corners();
  for (const std::uint32_t s : corners)
    for (const std::uint32_t t : corners) {
      add(s, t, t, s);  // equal sides: the row is the major axis
      add(s, t, corners[random.below(static_cast<std::uint32_t>(corners.size()))], s);
    }
  for (std::uint32_t s = 0; s < 128; ++s)
    for (std::uint32_t t = 0; t < 128; ++t) add(s, t, t / 2, 2 * s);
  for (std::uint32_t n = 2; n < 40'000; n += 3) {
    // sqrt(s^2 + 0) = s: near perfect squares, by the sum of both components.
    const std::uint32_t s = n * (kLargestSide / 40'000);
    add(s, 0, s, 1);
  }
  for (int i = 0; i < 60'000; ++i) {
    const auto any = [&] {
      return static_cast<std::uint32_t>(random.next()) & kLargestSide >> random.below(31);
    };
    const std::uint32_t s_x = any(), t_x = any(), s_y = any();
    add(s_x, t_x, s_y, any());
  }

  bench.run(
      tokens.size(),
      [&](std::uint64_t i) {
        hw::DerivativeToken token = tokens[i];
        if (fault && i == kFaultyToken) token.size_s_x ^= 1u << 20;
        return token;
      },
      tokens.size(),
      [&](std::uint64_t i, const hw::FootprintToken& got) {
        const hw::DerivativeToken& in = tokens[i];
        const gold::Footprint f =
            gold::footprint(spec::texture::Axes::kTwo, p.footprint, {in.size_s_x, in.size_t_x},
                            {in.size_s_y, in.size_t_y});
        return got.d_max == f.d_max && got.minor == f.d_min &&
               got.axis_s == (f.major == 0 ? in.s_x : in.s_y) &&
               got.axis_t == (f.major == 0 ? in.t_x : in.t_y) && got.s == in.s && got.t == in.t &&
               got.ticket.tag == in.ticket.tag;
      });
  return bench.verdict;
}

// ---- AxisUnit ----------------------------------------------------------------------------------

Verdict compare_axis(const Parameters& p, bool fault) {
  Pair<hw::DerivativeToken, hw::FootprintToken> bench;
  hw::AxisUnit unit("unit", bench.clock, p.axes, p.footprint, p.axis_cycles);
  unit.derivatives_in(bench.in);
  unit.footprints_out(bench.out);
  std::vector<hw::DerivativeToken> tokens;
  Random random(3);
  const auto magnitude = [](std::int64_t difference, unsigned width) {
    const std::int64_t texels = gold::derivative_in_texels(difference, width).texels;
    return static_cast<std::uint32_t>(texels < 0 ? -texels : texels);
  };
  for (int i = 0; i < 120'000; ++i) {
    const auto any = [&] {
      if (random.chance(100)) {
        const std::int64_t a = any_of(random, kCoordinateCorners);
        return a - any_of(random, kCoordinateCorners);
      }
      const auto v = static_cast<std::int64_t>(random.next() >> (32 + random.below(32)));
      return random.chance(500) ? -v : v;
    };
    const unsigned width = 1 + random.below(4096),
                   height = random.chance(500) ? width : 1 + random.below(4096);
    hw::DerivativeToken t{kTicket, 1, 2, any(), any(), any(), any(), 0, 0, 0, 0};
    if (random.chance(200)) t.s_y = t.s_x;  // ties
    if (random.chance(200)) t.t_y = random.chance(500) ? t.t_x : -t.t_x;
    if (random.chance(100)) {  // long at 45 degrees: candidates on both sides are equal
      t.s_y = t.t_x;
      t.t_y = t.s_x;
    }
    t.size_s_x = magnitude(t.s_x, width);
    t.size_t_x = magnitude(t.t_x, height);
    t.size_s_y = magnitude(t.s_y, width);
    t.size_t_y = magnitude(t.t_y, height);
    tokens.push_back(t);
  }
  bench.run(
      tokens.size(),
      [&](std::uint64_t i) {
        hw::DerivativeToken token = tokens[i];
        token.ticket.tag = static_cast<std::uint32_t>(i);
        if (fault && i == kFaultyToken) token.s ^= 1 << 20;
        return token;
      },
      tokens.size(),
      [&](std::uint64_t i, const hw::FootprintToken& got) {
        const hw::DerivativeToken& in = tokens[i];
        const gold::Footprint f =
            gold::footprint(p.axes, p.footprint,
                            {signed_size(in.size_s_x, in.s_x), signed_size(in.size_t_x, in.t_x)},
                            {signed_size(in.size_s_y, in.s_y), signed_size(in.size_t_y, in.t_y)});
        const gold::Step axis =
            gold::candidate_in_coordinates(p.axes, f.major, {in.s_x, in.t_x}, {in.s_y, in.t_y});
        const int directions = p.axes == spec::texture::Axes::kFour ? 4 : 8;
        const bool diagonal = f.major == directions / 4 || f.major == directions - directions / 4;
        return got.d_max == f.d_max && got.minor == f.area && got.axis_s == axis.s &&
               got.axis_t == axis.t && got.diagonal == diagonal && got.s == in.s && got.t == in.t &&
               got.ticket.tag == i;
      });
  return bench.verdict;
}

// ---- Log2Unit ----------------------------------------------------------------------------------

// Every leading one and every mantissa by the function; some of them through the unit.
Verdict compare_log2(const Parameters& p, bool fault) {
  Pair<hw::FootprintToken, hw::Log2Token> bench;
  hw::Log2Unit unit("unit", bench.clock, p.log2);
  unit.footprints_in(bench.in);
  unit.logs_out(bench.out);
  Verdict& v = bench.verdict;
  Random random(1);
  std::vector<hw::FootprintToken> tokens;
  const auto compare = [&](std::uint64_t d) {
    ++v.compared;
    if (hw::Log2Unit::log2(p.log2, d) != gold::log2_fixed(p.log2, d) && v.mismatches++ == 0)
      v.first = d;
    if (v.compared % 64 == 0)
      tokens.push_back(
          {kTicket, 1, 2, 3, 4, static_cast<std::uint32_t>(random.next()), (d & 1) != 0, d});
  };
  for (std::uint32_t d = 0; d < 1u << 21; ++d) compare(d);             // every smaller value
  for (int bit = 12; bit < 47; ++bit) {                                // an area has 47 bits
    const std::uint64_t below = (std::uint64_t{1} << (bit - 12)) - 1;  // bits that are dropped
    for (std::uint32_t y = 0; y < 4096; ++y) {
      const std::uint64_t d = std::uint64_t{4096u | y} << (bit - 12);
      for (const std::uint64_t low : {std::uint64_t{0}, 1u & below, below, below >> 1,
                                      below ^ (below >> 1), random.next() & below}) {
        compare(d | low);
      }
    }
  }
  bench.run(
      tokens.size(),
      [&](std::uint64_t i) {
        hw::FootprintToken token = tokens[i];
        token.ticket.tag = static_cast<std::uint32_t>(i);
        if (fault && i == kFaultyToken) token.axis_s ^= 1;
        return token;
      },
      tokens.size(),
      [&](std::uint64_t i, const hw::Log2Token& got) {
        const hw::FootprintToken& in = tokens[i];
        return got.lb_max == gold::log2_fixed(p.log2, in.d_max) &&
               got.lb_minor == gold::log2_fixed(p.log2, in.minor) && got.s == in.s &&
               got.t == in.t && got.axis_s == in.axis_s && got.axis_t == in.axis_t &&
               got.diagonal == in.diagonal && got.ticket.tag == i;
      });
  return v;
}

// ---- LevelUnit ---------------------------------------------------------------------------------

// Logarithms next to every threshold of a level: integers, halves, rounding of the fraction.
std::vector<std::int32_t> log_corners() {
  std::vector<std::int32_t> all;
  for (std::int32_t whole = -16; whole <= 16; ++whole)
    for (const std::int32_t offset : {-2049, -2048, -2047, -9, -8, -7, -1, 0, 1, 7, 8, 9})
      all.push_back(whole * 4096 + offset);
  return all;
}

// By batches: all modes, magnification filters, numbers of levels and N_max in turn, then random
// descriptors with any bias and clamps.
spec::texture::Descriptor level_texture(Random& random, int number) {
  constexpr std::array<std::uint8_t, 4> kLevels = {1, 2, 7, 13};
  constexpr int kSystematic = 6 * 2 * 4 * 5;
  spec::texture::Descriptor d = random_texture(random, kMemoryBytes);
  if (number < kSystematic) {
    d = {};
    d.width = d.height = 4096;
    d.min_filter = static_cast<spec::texture::MinFilter>(number % 6);
    d.mag_filter = static_cast<spec::texture::MagFilter>(number / 6 % 2);
    d.levels = kLevels[static_cast<std::size_t>(number / 12 % 4)];
    d.max_anisotropy_log2 = static_cast<std::uint8_t>(number / 48);
  } else if (random.chance(300)) {
    d.lod_bias = any_of(random, std::array<std::int16_t, 6>{-32768, 32767, -1, 1, -256, 4096});
    d.min_lod = any_of(random, std::array<std::uint16_t, 5>{0, 1, 4096, 32768, 65535});
    d.max_lod = any_of(random, std::array<std::uint16_t, 5>{0, 1, 3072, 32768, 65535});
  }
  return d;
}

Verdict compare_level(const Parameters& p, bool fault) {
  Pair<hw::Log2Token, hw::LevelToken> bench;
  Store store(bench.clock);
  hw::LevelUnit unit("unit", bench.clock, store.descriptors.for_levels, p.axes, p.count,
                     p.count_cap);
  unit.logs_in(bench.in);
  unit.levels_out(bench.out);

  const bool with_area = p.axes != spec::texture::Axes::kTwo;  // lb A is the sum of both
  const std::vector<std::int32_t> corners = log_corners();
  Random random(5);
  int number = 0;
  constexpr int kBatches = 35;
  for (int batch = 0; batch < kBatches; ++batch) {
    Descriptors d;
    for (auto& one : d) one = level_texture(random, number++);
    bench.reset();
    write(store, d);
    std::vector<hw::Log2Token> tokens;
    for (std::size_t h = 0; h < d.size(); ++h) {
      hw::Ticket ticket = kTicket;
      ticket.texture = static_cast<std::uint8_t>(h);
      for (const std::int32_t lb_max : corners) {
        const std::int32_t near = lb_max - static_cast<std::int32_t>(random.below(5 * 4096));
        for (const std::int32_t lb_min :
             {lb_max, near, any_of(random, std::array{-65536, 0, 4096}),
              lb_max - 4096 * static_cast<std::int32_t>(random.below(6))})
          tokens.push_back(
              {ticket, 1, 2, 3, 4, lb_max, with_area ? lb_max + lb_min : lb_min, (near & 1) != 0});
      }
    }
    std::uint64_t magnified = 0, two_levels = 0;
    bench.run(
        tokens.size(),
        [&](std::uint64_t i) {
          hw::Log2Token token = tokens[i];
          if (fault && batch == 0 && i == kFaultyToken) token.ticket.tag ^= 1u << 31;
          return token;
        },
        tokens.size(),
        [&](std::uint64_t i, const hw::LevelToken& got) {
          const hw::Log2Token& in = tokens[i];
          const gold::LevelOfDetail want =
              gold::select_level(p, d[in.ticket.texture], in.lb_max,
                                 with_area ? in.lb_minor - in.lb_max : in.lb_minor);
          magnified += want.magnified;
          two_levels += want.fraction != 0;
          return got.last_index + 1 == want.samples && got.level == want.level &&
                 got.fraction == want.fraction && got.linear == want.linear && got.s == in.s &&
                 got.t == in.t && got.axis_s == in.axis_s && got.axis_t == in.axis_t &&
                 got.diagonal == in.diagonal && got.ticket.tag == in.ticket.tag &&
                 got.ticket.texture == in.ticket.texture;
        });
    EXPECT_EQ(unit.magnified.value(), magnified);
    EXPECT_EQ(unit.two_levels.value(), two_levels);
  }
  return bench.verdict;
}

// ---- SampleWalker ------------------------------------------------------------------------------

constexpr std::array<std::int64_t, 7> kAxisCorners = {
    0, 1, -1, (std::int64_t{1} << 32) - 1, 1 - (std::int64_t{1} << 32), 1 << 20, -(1 << 23)};

Verdict compare_walker(const Parameters& p, bool fault) {
  Pair<hw::LevelToken, hw::SampleToken> bench;
  hw::SampleWalker unit("unit", bench.clock, p.count, p.kernel, p.spread);
  const bool any = p.count == spec::texture::CountRule::kAny;
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
      if (random.chance(300)) return any_of(random, kAxisCorners);
      return static_cast<std::int64_t>(random.next()) >> (31 + random.below(30));
    };
    const std::int64_t axis_s = axis(), axis_t = axis();
    hw::LevelToken t = {
        kTicket,
        any_of(random, kCoordinateCorners),
        static_cast<std::int32_t>(random.next()),
        axis_s,
        axis_t,
        static_cast<std::uint8_t>(any ? random.below(16) : (1u << random.below(5)) - 1),
        static_cast<std::uint8_t>(random.below(12)),
        static_cast<std::uint8_t>(random.chance(300) ? 0 : random.below(256)),
        random.chance(500),
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
        const bool by_axis = p.kernel == spec::texture::Kernel::kAxis,
                   tent = by_axis && t.diagonal && n >= 5;
        const std::int32_t length = tent      ? (181 * p.spread + 64) >> 7
                                    : by_axis ? p.spread
                                              : gold::spread_of(p.kernel, n, p.spread);
        const bool last_of_sample = r.second || t.fraction == 0;
        return got.s == t.s + gold::sample_offset(r.sample, n, length, t.axis_s) &&
               got.t == t.t + gold::sample_offset(r.sample, n, length, t.axis_t) &&
               got.index == r.sample && got.last_index == n - 1 + (tent ? 16 : 0) &&
               got.level_weight == (r.second ? t.fraction : 256 - t.fraction) &&
               got.level == t.level + (r.second ? 1 : 0) && got.linear == t.linear &&
               got.last_of_sample == last_of_sample &&
               got.last_of_fragment == (last_of_sample && r.sample == n - 1) &&
               got.ticket.tag == t.ticket.tag;
      });
  return bench.verdict;
}

// ---- TexelAddresser ----------------------------------------------------------------------------

Verdict compare_addresser(const Parameters&, bool fault) {
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
    for (auto& one : d) one = random_texture(random, kMemoryBytes);
    bench.reset();
    write(store, d);
    std::vector<hw::SampleToken> tokens;
    for (std::size_t h = 0; h < d.size(); ++h) {
      for (int i = 0; i < 1500; ++i) {
        const auto level = static_cast<std::uint8_t>(random.below(d[h].levels));
        const auto position = [&](std::uint16_t size) -> std::int64_t {
          switch (random.below(4)) {
            case 0:  // by a border of a texel, where the fraction and the pair of texels change
              return any_of(random,
                            std::array<std::int64_t, 5>{-2 * kOne, -kOne, 0, kOne, 3 * kOne}) +
                     kOne * random.below(2u * size + 1) / (2 * gold::level_size(size, level)) +
                     any_of(random, std::array<std::int64_t, 5>{-32768, -1, 0, 1, 32767});
            case 1:
              return any_of(random, std::array<std::int64_t, 4>{kFurthest, -kFurthest - 1, -1, 0});
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
                          static_cast<std::uint8_t>(random.below(32)), level, random.chance(700),
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
          // Odd rows of the linear layout, which the cache banks store turned.
          const auto turned = [&](std::int32_t row) {
            return t.layout == spec::texture::Layout::kLinear && row % 2 != 0;
          };
          const hw::FilterControl& c = got.control;
          return got.address == std::array{address(x.i0, y.i0), address(x.i1, y.i0),
                                           address(x.i0, y.i1), address(x.i1, y.i1)} &&
                 got.turned[0] == turned(y.i0) && got.turned[1] == turned(y.i1) &&
                 c.fraction_u == x.fraction && c.fraction_v == y.fraction &&
                 c.level_weight == in.level_weight && c.index == in.index &&
                 c.last_index == in.last_index && c.format == static_cast<std::uint8_t>(t.format) &&
                 c.last_of_sample == in.last_of_sample && c.last_of_fragment == in.last_of_fragment;
        });
  }
  return bench.verdict;
}

// ---- FilterPipeline ----------------------------------------------------------------------------

Verdict compare_filter(const Parameters& p, bool fault) {
  const FilterWork work = filter_work(p);
  Pair<hw::TexelQuadToken, spec::texture::ColourGroup> bench;
  rtl::LatencyProbe probe;
  hw::FilterPipeline unit("unit", bench.clock, p, probe);
  unit.texels_in(bench.in);
  unit.colours_out(bench.out);
  bench.run(
      work.tokens.size(),
      [&](std::uint64_t i) {
        hw::TexelQuadToken token = work.tokens[i];
        if (token.control.last_of_fragment) probe.enters(bench.clock.cycle());
        if (fault && i == kFaultyToken) token.texel[0] ^= 0x8000;
        return token;
      },
      work.colours.size(),
      [&](std::uint64_t i, const spec::texture::ColourGroup& got) {
        return got.count == 1 && got.colour[0] == work.colours[i];
      });
  return bench.verdict;
}

// ---- Suite -------------------------------------------------------------------------------------

struct Row {
  const char* unit;
  Verdict (*compare)(const Parameters&, bool fault);
  std::uint64_t at_least, answers_a_token;
  std::vector<std::string> settings;  // of the builds
};

// Every combination of these choices.
std::vector<std::string> every(const std::vector<std::vector<std::string>>& choices) {
  std::vector<std::string> all = {""};
  for (const auto& choice : choices) {
    std::vector<std::string> longer;
    for (const std::string& before : all)
      for (const std::string& setting : choice)
        longer.push_back(before + (before.empty() ? "" : " ") + setting);
    all = longer;
  }
  return all;
}

const std::vector<Row>& rows() {
  const std::vector<std::string> footprints = {"footprint=half", "footprint=quarter",
                                               "footprint=two_segment", "footprint=max",
                                               "footprint=exact"},
                                 counts = {"count=floor", "count=ceil", "count=any"},
                                 powers_or_any = {"count=floor", "count=any"},
                                 kernels = {"kernel=box", "kernel=tent", "kernel=axis"};
  static const std::vector<Row> all = [&] {
    std::vector<std::string> axes = every({{"axes=four", "axes=eight"}, footprints});
    for (const char* const slow :
         {"axes=four footprint=max axis_cycles=2", "axes=eight footprint=exact axis_cycles=2",
          "axes=eight footprint=half axis_cycles=4"})
      axes.emplace_back(slow);
    return std::vector<Row>{
        {"Derivative", compare_derivative, 80'000, 4, {""}},
        {"Side", compare_side, 1'500'000, 1, {footprints.begin(), footprints.end() - 1}},
        {"Footprint", compare_footprint, 100'000, 1, footprints},
        {"Axis", compare_axis, 120'000, 1, axes},
        {"Log2",
         compare_log2,
         2'000'000,
         1,
         {"log2=mitchell", "log2=corrected", "log2=segments", "log2=exact"}},
        {"Level", compare_level, 800'000, 1,
         every({{"axes=two", "axes=eight"}, counts, {"count_cap=none", "count_cap=texel"}})},
        {"Walker", compare_walker, 200'000, 32,
         every({powers_or_any,
                kernels,
                {"spread=0", "spread=1", "spread=64", "spread=102", "spread=128"}})},
        {"Addresser", compare_addresser, 900'000, 1, {""}},
        {"Filter", compare_filter, 160'000, 1,
         every({powers_or_any, kernels, {"srgb_output=linear", "srgb_output=encoded"}})}};
  }();
  return all;
}

using Build = std::pair<std::size_t, std::string>;  // row, settings
std::vector<Build> builds() {
  std::vector<Build> all;
  for (std::size_t row = 0; row < rows().size(); ++row)
    for (const std::string& settings : rows()[row].settings) all.emplace_back(row, settings);
  return all;
}
// "Axis_four_max_2"
std::string name_of(const testing::TestParamInfo<Build>& info) {
  std::string name = rows()[info.param.first].unit;
  bool value = false;
  for (const char c : info.param.second) {
    if (c == '=') name += '_';
    value = c != ' ' && (value || c == '=');
    if (value && c != '=') name += c;
  }
  return name;
}

class Equivalence : public testing::TestWithParam<Build> {
 protected:
  const Row& row = rows()[GetParam().first];
  Verdict compare(bool fault) const {
    Parameters p;
    apply_settings(p, GetParam().second);
    return row.compare(p, fault);
  }
};
class EquivalenceFault : public Equivalence {};

TEST_P(Equivalence, UnitEqualsGoldenFunction) { expect_equal(compare(false), row.at_least); }
INSTANTIATE_TEST_SUITE_P(Texture, Equivalence, testing::ValuesIn(builds()), name_of);

// One wrong bit in one token, in the first build of each unit.
TEST_P(EquivalenceFault, DetectsWrongBit) { expect_noticed(compare(true), row.answers_a_token); }
INSTANTIATE_TEST_SUITE_P(Texture, EquivalenceFault, testing::ValuesIn([] {
                           std::vector<Build> first;
                           for (std::size_t i = 0; i < rows().size(); ++i)
                             first.emplace_back(i, rows()[i].settings[0]);
                           return first;
                         }()),
                         name_of);

}  // namespace
}  // namespace deburr::tb::equivalence_test
