// SPDX-License-Identifier: MIT
// The whole texture golden: its fast path against the blocks strung together plainly, its traffic,
// counters, invalid descriptors, memory errors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "golden/texture/texture_golden.h"
#include "spec/error.h"
#include "spec/texture/parameters.h"
#include "tb/base/random.h"
#include "tb/unit/golden/texture/support.h"

namespace deburr::unit_test {
namespace {

using namespace golden::texture;
using tb::texture::EncodedTexture;
using tb::texture::GroundPlane;
using testing::ElementsAre;

// ---- a plain second stringing-together of the blocks --------------------------------------------

struct PlainResult {
  std::array<std::uint8_t, 4> rgba{};
  std::vector<std::array<std::uint32_t, 4>> requests;  // texel addresses 00, 10, 01, 11
};

PlainResult plain(const spec::texture::Parameters& p, const spec::texture::Descriptor& d,
                  const std::vector<std::uint8_t>& memory, const spec::texture::Quad& quad,
                  int lane) {
  const int row = lane / 2 * 2, column = lane % 2;
  const auto difference = [](std::int32_t to, std::int32_t from) {
    return static_cast<std::int64_t>(to) - from;
  };
  const auto& s = quad.s;
  const auto& t = quad.t;
  const auto at = [](const std::array<std::int32_t, 4>& c, int i) {
    return c[static_cast<std::size_t>(i)];
  };
  const std::int64_t s_x = difference(at(s, row + 1), at(s, row));
  const std::int64_t t_x = difference(at(t, row + 1), at(t, row));
  const std::int64_t s_y = difference(at(s, column + 2), at(s, column));
  const std::int64_t t_y = difference(at(t, column + 2), at(t, column));
  const Footprint f = footprint(
      p.axes, p.footprint,
      {derivative_in_texels(s_x, d.width).texels, derivative_in_texels(t_x, d.height).texels},
      {derivative_in_texels(s_y, d.width).texels, derivative_in_texels(t_y, d.height).texels});
  const Step axis = candidate_in_coordinates(p.axes, f.major, {s_x, t_x}, {s_y, t_y});
  const AxisLogarithms lb = axis_logarithms(p.axes, p.log2, f);
  const LevelOfDetail lod = select_level(p, d, lb.d_max, lb.d_min);
  const std::int32_t spread = spread_of(p.kernel, lod.samples, p.spread);
  PlainResult result;
  std::array<std::uint32_t, 4> accumulator{};
  for (int i = 0; i < lod.samples; ++i) {
    const std::int64_t ps = at(s, lane) + sample_offset(i, lod.samples, spread, axis.s);
    const std::int64_t pt = at(t, lane) + sample_offset(i, lod.samples, spread, axis.t);
    std::array<std::array<std::uint32_t, 4>, 2> filtered{};
    for (int request = 0; request < lod.requests_per_sample(); ++request) {
      const int level = lod.level + request;
      const auto position = lod.linear ? linear_position : nearest_position;
      const TexelPosition x = position(d.wrap_s, ps, level_size(d.width, level));
      const TexelPosition y = position(d.wrap_t, pt, level_size(d.height, level));
      const std::array<std::uint32_t, 4> addresses = {
          texel_address(d, level, x.i0, y.i0), texel_address(d, level, x.i1, y.i0),
          texel_address(d, level, x.i0, y.i1), texel_address(d, level, x.i1, y.i1)};
      result.requests.push_back(addresses);
      std::array<Texel, 4> texel;
      for (std::size_t k = 0; k < 4; ++k) {
        std::uint32_t word = 0;
        for (std::size_t b = 0; b < spec::texture::kFormatBytes[static_cast<std::size_t>(d.format)];
             ++b) {
          word |= std::uint32_t{memory.at(addresses[k] + b)} << (8 * b);
        }
        texel[k] = decode_texel(d.format, word);
      }
      for (std::size_t c = 0; c < 4; ++c) {
        filtered[static_cast<std::size_t>(request)][c] =
            vertical_lerp(horizontal_lerp(texel[0][c], texel[1][c], x.fraction),
                          horizontal_lerp(texel[2][c], texel[3][c], x.fraction), y.fraction);
      }
    }
    for (std::size_t c = 0; c < 4; ++c) {
      accumulator[c] += sample_weight(p.kernel, i, lod.samples) *
                        level_lerp(filtered[0][c], filtered[1][c], lod.fraction);
    }
  }
  for (std::size_t c = 0; c < 4; ++c) {
    const bool encode = c < 3 && d.format == spec::texture::Format::kSrgb8A8 &&
                        p.srgb_output == spec::texture::SrgbOutput::kEncoded;
    result.rgba[c] = encode ? encode_result(accumulator[c]) : round_result(accumulator[c]);
  }
  return result;
}

// A cache in other words: sets as lists in the order of replacement.
class PlainCache {
 public:
  PlainCache(std::uint32_t sets, std::uint32_t ways, bool lru)
      : sets_(sets), ways_(ways), lru_(lru) {}
  bool lookup(std::uint32_t line) {
    std::vector<std::uint32_t>& set = content_[line % sets_];
    const auto found = std::find(set.begin(), set.end(), line);
    if (found != set.end()) {
      if (lru_) std::rotate(found, found + 1, set.end());
      return true;
    }
    if (set.size() == ways_) set.erase(set.begin());
    set.push_back(line);
    return false;
  }

 private:
  std::uint32_t sets_, ways_;
  bool lru_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> content_;
};

// ---- random work --------------------------------------------------------------------------------

class RandomWork {
 public:
  explicit RandomWork(unsigned seed) : random_(seed) {}
  int pick(int low, int high) { return random_.between(low, high); }

  spec::texture::Parameters parameters() {
    spec::texture::Parameters p;
    p.footprint = static_cast<spec::texture::FootprintRule>(pick(0, 4));
    p.log2 = static_cast<spec::texture::Log2Rule>(pick(0, 3));
    p.axes = static_cast<spec::texture::Axes>(pick(0, 2));
    p.count = static_cast<spec::texture::CountRule>(pick(0, 2));
    p.srgb_output = static_cast<spec::texture::SrgbOutput>(pick(0, 1));
    p.count_cap = static_cast<spec::texture::CountCap>(pick(0, 1));
    p.kernel = static_cast<spec::texture::Kernel>(pick(0, 1));
    p.spread = pick(0, 2) == 0 ? pick(0, 128) : 64;
    p.cache_bytes = 1 << pick(10, 14);
    p.cache_line_bytes = 1 << pick(5, 7);
    p.cache_ways = 1 << pick(0, 3);
    p.cache_replacement = static_cast<spec::texture::Replacement>(pick(0, 1));
    return p;
  }

  spec::texture::Descriptor sampler() {
    spec::texture::Descriptor d;
    d.format = static_cast<spec::texture::Format>(pick(0, 4));
    d.layout = static_cast<spec::texture::Layout>(pick(0, 1));
    d.wrap_s = static_cast<spec::texture::Wrap>(pick(0, 2));
    d.wrap_t = static_cast<spec::texture::Wrap>(pick(0, 2));
    d.min_filter = static_cast<spec::texture::MinFilter>(pick(0, 5));
    d.mag_filter = static_cast<spec::texture::MagFilter>(pick(0, 1));
    d.max_anisotropy_log2 = static_cast<std::uint8_t>(pick(0, 4));
    d.lod_bias = static_cast<std::int16_t>(pick(0, 3) == 0 ? pick(-512, 512) : 0);
    return d;
  }

  // A quad somewhere in S7.24 with derivatives of any size and direction.
  spec::texture::Quad quad(std::uint32_t tag) {
    spec::texture::Quad q;
    q.tag = tag;
    q.coverage = static_cast<std::uint8_t>(pick(0, 15));
    const double s = random_.uniform(-3, 3), t = random_.uniform(-3, 3);
    const double dx = std::exp2(random_.uniform(-14, 1)), dy = std::exp2(random_.uniform(-14, 1));
    const double ax = random_.uniform(0, 6.2832), ay = random_.uniform(0, 6.2832);
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const double i = static_cast<double>(lane & 1), j = static_cast<double>(lane >> 1);
      q.s[lane] = static_cast<std::int32_t>((s + i * dx * std::cos(ax) + j * dy * std::cos(ay)) *
                                            spec::texture::kCoordinateOne);
      q.t[lane] = static_cast<std::int32_t>((t + i * dx * std::sin(ax) + j * dy * std::sin(ay)) *
                                            spec::texture::kCoordinateOne);
    }
    if (pick(0, 50) == 0) q.s[static_cast<std::size_t>(pick(0, 3))] = INT32_MAX;
    if (pick(0, 50) == 0) q.t[static_cast<std::size_t>(pick(0, 3))] = INT32_MIN;
    return q;
  }

 private:
  tb::Random random_;
};

// Runs random work on both; returns the number of lanes, fills and counters that differ. `spoil`
// may change a colour of the golden.
int differences(unsigned seed, const std::function<void(spec::texture::Colour&)>& spoil) {
  RandomWork work(seed);
  const spec::texture::Parameters p = work.parameters();
  const auto sampler = work.sampler();
  const auto height = work.pick(1, 90), width = work.pick(1, 90);
  const EncodedTexture texture(tb::texture::noise(width, height, seed), sampler);
  TextureGolden golden(p, texture.memory);
  golden.set_texture(5, texture.descriptor);
  golden.record_fills(true);
  PlainCache cache(golden.cache().sets(), golden.cache().ways(),
                   p.cache_replacement == spec::texture::Replacement::kLru);
  std::vector<std::uint32_t> fills;
  std::uint64_t fragments = 0, bilinears = 0;
  int count = 0;
  for (std::uint32_t tag = 0; tag < 150; ++tag) {
    spec::texture::Quad quad = work.quad(tag);
    quad.texture = 5;
    const QuadColours colours = golden.process(quad);
    const spec::texture::Colour* next = colours.begin();
    for (int lane = 0; lane < 4; ++lane) {
      if ((quad.coverage >> lane & 1) == 0) continue;
      const PlainResult expected = plain(p, texture.descriptor, texture.memory, quad, lane);
      ++fragments;
      bilinears += expected.requests.size();
      for (const auto& addresses : expected.requests) {
        std::vector<std::uint32_t> seen;
        for (const std::uint32_t address : addresses) {
          const auto line = address / static_cast<std::uint32_t>(p.cache_line_bytes);
          if (std::find(seen.begin(), seen.end(), line) != seen.end()) continue;
          seen.push_back(line);
          if (!cache.lookup(line)) fills.push_back(line);
        }
      }
      if (next == colours.end()) return count + 1;
      spec::texture::Colour colour = *next++;
      spoil(colour);
      const bool last = (quad.coverage >> (lane + 1)) == 0;
      if (!(colour ==
            spec::texture::Colour{tag, static_cast<std::uint8_t>(lane), last, expected.rgba})) {
        ++count;
      }
    }
    if (next != colours.end()) ++count;
  }
  if (golden.fills() != fills) ++count;
  if (golden.work().line_fills != fills.size()) ++count;
  if (golden.work().fragments != fragments) ++count;
  if (golden.work().bilinears != bilinears) ++count;
  return count;
}

TEST(TextureGolden, IsItsBlocksStrungTogether) {
  for (unsigned seed = 1; seed <= 400; ++seed) {
    ASSERT_EQ(differences(seed, [](spec::texture::Colour&) {}), 0) << "seed " << seed;
  }
}

TEST(TextureGolden, ComparisonFindsOneFlippedBit) {
  int colours = 0;
  EXPECT_EQ(differences(1,
                        [&](spec::texture::Colour& c) {
                          if (colours++ == 37) c.rgba[2] ^= 1;
                        }),
            1);
  colours = 0;
  EXPECT_EQ(differences(1,
                        [&](spec::texture::Colour& c) {
                          if (colours++ == 3) c.last = !c.last;
                        }),
            1);
}

// ---- properties ---------------------------------------------------------------------------------

spec::texture::Quad flat_quad(double s, double t, double step_s, double step_t) {
  spec::texture::Quad q;
  for (std::size_t lane = 0; lane < 4; ++lane) {
    q.s[lane] = static_cast<std::int32_t>((s + static_cast<double>(lane & 1) * step_s) *
                                          spec::texture::kCoordinateOne);
    q.t[lane] = static_cast<std::int32_t>((t + static_cast<double>(lane >> 1) * step_t) *
                                          spec::texture::kCoordinateOne);
  }
  return q;
}

TEST(TextureGolden, AConstantTextureComesThroughEveryVariantUnchanged) {
  const tb::texture::Rgba colour = {7, 130, 255, 64};
  const tb::texture::Pyramid picture(37, 21, [&](int, int) { return colour; });
  RandomWork work(11);
  for (int trial = 0; trial < 100; ++trial) {
    spec::texture::Descriptor sampler = work.sampler();
    sampler.format = spec::texture::Format::kRgba8;
    const EncodedTexture texture(picture, sampler);
    TextureGolden golden(work.parameters(), texture.memory);
    golden.set_texture(0, texture.descriptor);
    for (std::uint32_t tag = 0; tag < 100; ++tag) {
      for (const spec::texture::Colour& c : golden.process(work.quad(tag)))
        ASSERT_EQ(c.rgba, colour);
    }
  }
}

TEST(TextureGolden, TrafficDoesNotChangeColours) {
  const EncodedTexture texture(tb::texture::noise(128, 128, 1), RandomWork(4).sampler());
  const auto quads = GroundPlane{.size = 64}.quads();
  TextureGolden with({}, texture.memory),
      without({}, texture.memory, TextureGolden::Traffic::kIgnore);
  with.set_texture(0, texture.descriptor);
  without.set_texture(0, texture.descriptor);
  for (const spec::texture::Quad& quad : quads) {
    const QuadColours a = with.process(quad), b = without.process(quad);
    ASSERT_EQ(a.colours, b.colours);
  }
  EXPECT_GT(with.work().line_fills, 0u);
  EXPECT_EQ(without.work().line_fills, 0u);
}

TEST(TextureGolden, FillsOfATrilinearSampleAreLevelThenNextLevel) {
  spec::texture::Descriptor sampler;  // repeat, trilinear, RGBA8, tiles of 4 x 4
  const EncodedTexture texture(tb::texture::noise(64, 64, 1), sampler);
  TextureGolden golden(preset_parameters(spec::texture::Preset::kPaper), texture.memory);
  golden.set_texture(0, texture.descriptor);
  std::vector<std::uint32_t> sunk;
  golden.set_fill_sink([&](std::uint32_t line) { sunk.push_back(line); });
  golden.record_fills(true);
  // 1.5 texels a pixel: l = lb 1.5 by n + y = 0.5. Lane 0 at the corner (0, 0): four tiles meet.
  spec::texture::Quad quad = flat_quad(0, 0, 1.5 / 64, 1.5 / 64);
  quad.coverage = 1;
  golden.process(quad);
  const auto line = [&](int level, int x, int y) {
    return texel_address(texture.descriptor, level, x, y) / 64;
  };
  EXPECT_THAT(golden.fills(),
              ElementsAre(line(0, 63, 63), line(0, 0, 63), line(0, 63, 0), line(0, 0, 0),
                          line(1, 31, 31), line(1, 0, 31), line(1, 31, 0), line(1, 0, 0)));
  EXPECT_EQ(golden.fills(), sunk);
  const FragmentAnalysis fragment = golden.analyse(quad, 0);
  EXPECT_EQ(fragment.lod.level, 0);
  EXPECT_EQ(fragment.lod.fraction, 128u);
  EXPECT_EQ(golden.work().by_level[0], 1u);
  EXPECT_EQ(golden.work().by_level[1], 1u);

  golden.process(quad);
  EXPECT_EQ(golden.work().line_fills, 8u);  // all present
  golden.invalidate_cache();
  golden.process(quad);
  EXPECT_EQ(golden.work().line_fills, 16u);
  golden.reset();
  EXPECT_EQ(golden.work(), TextureWork{});
  EXPECT_TRUE(golden.fills().empty());
  golden.process(quad);
  EXPECT_EQ(golden.work().line_fills, 8u);  // the texture stayed
}

// A sample of two levels: which texels of which, where it lies, and the lines that each misses.
TEST(TextureGolden, TellsWhatALaneAsksFor) {
  const EncodedTexture texture(tb::texture::noise(64, 64, 1), {});
  TextureGolden golden(preset_parameters(spec::texture::Preset::kPaper), texture.memory);
  golden.set_texture(0, texture.descriptor);
  golden.record_fills(true);
  spec::texture::Quad quad = flat_quad(0.3, 0.6, 1.5 / 64, 1.5 / 64);
  quad.coverage = 0b1001;
  std::vector<BilinearRequest> requests;
  golden.process(quad, 3, requests);
  const PlainResult expected =
      plain(golden.parameters(), texture.descriptor, texture.memory, quad, 3);
  ASSERT_EQ(expected.requests.size(), 2u);
  ASSERT_EQ(requests.size(), 2u);
  std::vector<std::uint32_t> misses;
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(requests[i].sample, 0);
    EXPECT_EQ(requests[i].level, static_cast<int>(i));
    EXPECT_EQ(requests[i].s, quad.s[3]);
    EXPECT_EQ(requests[i].t, quad.t[3]);
    EXPECT_EQ(requests[i].addresses, expected.requests[i]);
    misses.insert(misses.end(), requests[i].misses.begin(), requests[i].misses.end());
  }
  // Of lane 0 are those before.
  ASSERT_FALSE(misses.empty());
  ASSERT_GE(golden.fills().size(), misses.size());
  EXPECT_TRUE(std::equal(misses.rbegin(), misses.rend(), golden.fills().rbegin()));
}

TEST(TextureGolden, TellsSamplesInTheirOrder) {
  spec::texture::Descriptor sampler;
  sampler.max_anisotropy_log2 = 4;
  const EncodedTexture texture(tb::texture::checkerboard(1024, 8), sampler);
  TextureGolden golden(preset_parameters(spec::texture::Preset::kPaper), texture.memory);
  golden.set_texture(0, texture.descriptor);
  std::vector<BilinearRequest> requests;
  golden.process(flat_quad(0, 0, 8.0 / 1024, 1.0 / 1024), 0, requests);  // N = 8, one level
  ASSERT_EQ(requests.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(requests[i].sample, static_cast<int>(i));
}

TEST(TextureGolden, CoverageTagsAndLast) {
  const EncodedTexture texture(tb::texture::noise(8, 8, 1), {});
  TextureGolden golden({}, texture.memory);
  golden.set_texture(0, texture.descriptor);
  for (int coverage = 0; coverage < 16; ++coverage) {
    spec::texture::Quad quad = flat_quad(0.1, 0.2, 0.01, 0.01);
    quad.tag = 1000u + static_cast<std::uint32_t>(coverage);
    quad.coverage = static_cast<std::uint8_t>(coverage);
    std::vector<int> lanes;
    int lasts = 0;
    golden.process(quad, [&](const spec::texture::Colour& colour) {
      EXPECT_EQ(colour.tag, quad.tag);
      lanes.push_back(colour.lane);
      if (colour.last) ++lasts;
      EXPECT_EQ(colour.last, coverage >> (colour.lane + 1) == 0);
    });
    std::vector<int> expected;
    for (int lane = 0; lane < 4; ++lane) {
      if ((coverage >> lane & 1) != 0) expected.push_back(lane);
    }
    EXPECT_EQ(lanes, expected);
    EXPECT_EQ(lasts, coverage == 0 ? 0 : 1);
  }
}

TEST(TextureGolden, CountsClampedSaturatedMagnifiedAndN) {
  spec::texture::Descriptor sampler;
  sampler.max_anisotropy_log2 = 4;
  const EncodedTexture texture(tb::texture::checkerboard(1024, 8), sampler);
  TextureGolden golden(preset_parameters(spec::texture::Preset::kPaper), texture.memory);
  golden.set_texture(0, texture.descriptor);

  spec::texture::Quad quad = flat_quad(0, 0, 8.0 / 1024, 1.0 / 1024);  // 8 x 1 texels: N = 8, l = 0
  quad.clamped = 0b0101;
  quad.coverage = 0b0111;
  golden.process(quad);
  EXPECT_EQ(golden.work().fragments, 3u);
  EXPECT_EQ(golden.work().clamped, 2u);
  EXPECT_EQ(golden.work().by_samples[8], 3u);
  EXPECT_EQ(golden.work().samples, 24u);
  EXPECT_EQ(golden.work().bilinears, 24u);
  EXPECT_EQ(golden.work().magnified, 3u);
  EXPECT_EQ(golden.work().saturated, 0u);

  golden.clear_work();
  quad = flat_quad(-64, 0, 33, 0.001);  // 33 x 1024 texels: beyond 2^15
  golden.process(quad);
  EXPECT_EQ(golden.work().saturated, 4u);
  const FragmentAnalysis fragment = golden.analyse(quad, 0);
  EXPECT_EQ(fragment.p_x.s, 0x7FFFFFFF);
  EXPECT_EQ(fragment.p_y.s, 0);
  EXPECT_EQ(fragment.footprint.major, 0);
  EXPECT_EQ(fragment.axis, fragment.d_x);
  EXPECT_EQ(fragment.lod.samples, 16);
}

TEST(TextureGolden, DerivativesAreThoseOfTheOwnRowAndColumn) {
  const EncodedTexture texture(tb::texture::checkerboard(64, 8), {});
  TextureGolden golden({}, texture.memory);
  golden.set_texture(0, texture.descriptor);
  spec::texture::Quad quad;
  quad.s = {0, 10, 100, 130};
  quad.t = {0, 1000, 7000, 9000};
  const auto row_and_column = [&](int lane) {
    const FragmentAnalysis f = golden.analyse(quad, lane);
    return std::array<std::int64_t, 4>{f.d_x.s, f.d_x.t, f.d_y.s, f.d_y.t};
  };
  EXPECT_THAT(row_and_column(0), ElementsAre(10, 1000, 100, 7000));
  EXPECT_THAT(row_and_column(1), ElementsAre(10, 1000, 120, 8000));
  EXPECT_THAT(row_and_column(2), ElementsAre(30, 2000, 100, 7000));
  EXPECT_THAT(row_and_column(3), ElementsAre(30, 2000, 120, 8000));
}

// ---- bad input ----------------------------------------------------------------------------------

TEST(TextureGolden, FragmentsOfAnInvalidDescriptorAreZeroAndCounted) {
  const EncodedTexture texture(tb::texture::noise(8, 8, 1), {});
  TextureGolden golden({}, texture.memory);
  golden.set_texture(0, texture.descriptor);
  spec::texture::Descriptor bad = texture.descriptor;
  bad.levels = 9;
  golden.set_texture(1, bad);
  for (const int handle : {1, 2, 16, 255}) {  // bad, never set, no such handle
    golden.clear_work();
    spec::texture::Quad quad = flat_quad(0, 0, 100, 0.1);
    quad.texture = static_cast<std::uint8_t>(handle);
    quad.clamped = 0b1000;
    int colours = 0;
    golden.process(quad, [&](const spec::texture::Colour& colour) {
      ++colours;
      EXPECT_EQ(colour.rgba, (std::array<std::uint8_t, 4>{0, 0, 0, 0}));
    });
    EXPECT_EQ(colours, 4);
    TextureWork expected;
    expected.fragments = expected.invalid_fragments = 4;
    expected.clamped = 1;
    EXPECT_EQ(golden.work(), expected) << handle;
    EXPECT_FALSE(golden.analyse(quad, 0).valid) << handle;
  }
  EXPECT_THROW(golden.set_texture(16, texture.descriptor), spec::ConfigError);
  EXPECT_THROW(golden.set_texture(-1, texture.descriptor), spec::ConfigError);
}

TEST(TextureGolden, AValidDescriptorMayReplaceAnInvalidOneAndBack) {
  const EncodedTexture texture(tb::texture::noise(8, 8, 1), {});
  TextureGolden golden({}, texture.memory);
  const spec::texture::Quad quad = flat_quad(0, 0, 0.1, 0.1);
  golden.set_texture(0, texture.descriptor);
  golden.process(quad);
  golden.set_texture(0, {});
  golden.process(quad);
  golden.set_texture(0, texture.descriptor);
  golden.process(quad);
  EXPECT_EQ(golden.work().invalid_fragments, 4u);
}

TEST(TextureGolden, ErrorLinesReadAsZeroBytesAndEachFillCounts) {
  for (const auto format : {spec::texture::Format::kRgba8, spec::texture::Format::kL8,
                            spec::texture::Format::kRgb565}) {
    spec::texture::Descriptor sampler;
    sampler.format = format;
    sampler.min_filter = spec::texture::MinFilter::kNearest;
    sampler.mag_filter = spec::texture::MagFilter::kNearest;
    const tb::texture::Pyramid white(32, 32, [](int, int) {
      return tb::texture::Rgba{255, 255, 255, 255};
    });
    const EncodedTexture texture(white, sampler);
    TextureGolden golden({}, texture.memory);
    golden.set_texture(0, texture.descriptor);
    const std::uint32_t bad = texel_address(texture.descriptor, 0, 0, 0);
    golden.set_error_ranges({{bad + 5, bad + 6}});  // one byte spoils its line
    spec::texture::Quad quad = flat_quad(0.5 / 32, 0.5 / 32, 16.0 / 32, 16.0 / 32);
    std::vector<std::array<std::uint8_t, 4>> colours;
    golden.process(quad, [&](const spec::texture::Colour& c) { colours.push_back(c.rgba); });
    const std::array<std::uint8_t, 4> all = {255, 255, 255, 255};
    const std::uint8_t alpha = format == spec::texture::Format::kRgba8 ? 0 : 255;
    EXPECT_EQ(colours[0], (std::array<std::uint8_t, 4>{0, 0, 0, alpha}));
    EXPECT_EQ(colours[3], all);
    EXPECT_EQ(golden.work().memory_errors, 1u);
    golden.invalidate_cache();
    golden.process(quad);
    EXPECT_EQ(golden.work().memory_errors, 2u);
    golden.set_error_lines({});
    golden.invalidate_cache();
    EXPECT_EQ(golden.process(quad).colours[0].rgba, all);
  }
}

// A range ends before its second address: of a line from `first` on, its bytes are first to
// first + 63.
TEST(TextureGolden, ErrorRangesSpoilTheLinesThatTheyMeet) {
  spec::texture::Descriptor sampler;
  sampler.min_filter = spec::texture::MinFilter::kNearest;
  sampler.mag_filter = spec::texture::MagFilter::kNearest;
  const tb::texture::Pyramid white(32, 32, [](int, int) {
    return tb::texture::Rgba{255, 255, 255, 255};
  });
  const EncodedTexture texture(white, sampler);
  const auto errors = [&](std::uint32_t low, std::uint32_t high) {
    TextureGolden golden({}, texture.memory);
    golden.set_texture(0, texture.descriptor);
    golden.set_error_ranges({{low, high}});
    // All lanes read texel (16, 16).
    golden.process(flat_quad(16.5 / 32, 16.5 / 32, 0, 0));
    return golden.work().memory_errors;
  };
  const std::uint32_t first = texel_address(texture.descriptor, 0, 16, 16) / 64 * 64;
  ASSERT_GT(first, 64u);
  EXPECT_EQ(errors(first - 64, first), 0u);
  EXPECT_EQ(errors(first - 64, first + 1), 1u);
  EXPECT_EQ(errors(first, first + 1), 1u);
  EXPECT_EQ(errors(first + 63, first + 64), 1u);
  EXPECT_EQ(errors(first + 63, first + 200), 1u);
  EXPECT_EQ(errors(first + 64, first + 128), 0u);
}

// 16 x 4 texels of 9, row by row: each row is a line of memory.
EncodedTexture four_lines() {
  spec::texture::Descriptor sampler;
  sampler.layout = spec::texture::Layout::kLinear;
  sampler.min_filter = spec::texture::MinFilter::kNearest;
  sampler.mag_filter = spec::texture::MagFilter::kNearest;
  EncodedTexture texture(tb::texture::Pyramid(16, 4,
                                              [](int, int) {
                                                return tb::texture::Rgba{9, 9, 9, 9};
                                              }),
                         sampler);
  texture.descriptor.levels = 1;
  return texture;
}

// The last line of memory is no error, whoever asks for it, and the one behind it is.
TEST(TextureGolden, MemoryEndsWithItsLastLine) {
  EncodedTexture texture = four_lines();
  for (const std::uint32_t base : {0u, 4096u}) {
    for (const std::size_t bytes : {3 * 64 + 63, 4 * 64}) {
      for (const bool ask : {false, true}) {
        std::vector<std::uint8_t> memory(base + bytes, 9);
        texture.descriptor.base[0] = base;
        TextureGolden golden({}, memory);
        golden.set_texture(0, texture.descriptor);
        if (ask) golden.set_error_ranges({{0, 1}});  // each line is asked for
        const QuadColours colours = golden.process(flat_quad(0.1, 0.6, 0.001, 0.25));  // rows 2, 3
        EXPECT_EQ(colours.colours[0].rgba[0], 9);
        EXPECT_EQ(colours.colours[2].rgba[0], bytes == 4 * 64 ? 9 : 0);
        EXPECT_EQ(golden.work().memory_errors, bytes == 4 * 64 ? 0u : 1u);
      }
    }
  }
}

TEST(TextureGolden, LinesPastTheEndOfMemoryAreErrors) {
  EncodedTexture texture = four_lines();
  texture.memory.resize(3 * 64 + 63);  // the last row's line is a byte short
  TextureGolden golden({}, texture.memory);
  golden.set_texture(0, texture.descriptor);
  spec::texture::Quad quad = flat_quad(0.1, 0.6, 0.001, 0.25);  // rows 2 and 3
  const QuadColours colours = golden.process(quad);
  EXPECT_EQ(colours.colours[0].rgba[0], 9);
  EXPECT_EQ(colours.colours[2].rgba[0], 0);
  EXPECT_EQ(golden.work().memory_errors, 1u);
  // No memory at all, and addresses that wrap.
  TextureGolden empty({}, {});
  texture.descriptor.base[0] = 0xFFFFFFC0;
  empty.set_texture(0, texture.descriptor);
  EXPECT_EQ(empty.process(quad).colours[3].rgba, (std::array<std::uint8_t, 4>{}));
}

TEST(TextureGolden, PresetsAreTheirRows) {
  const spec::texture::Parameters paper = preset_parameters(spec::texture::Preset::kPaper);
  EXPECT_EQ(paper.axes, spec::texture::Axes::kTwo);
  EXPECT_EQ(paper.footprint, spec::texture::FootprintRule::kHalf);
  EXPECT_EQ(paper.log2, spec::texture::Log2Rule::kMitchell);
  EXPECT_EQ(paper.count, spec::texture::CountRule::kFloor);
  // The defaults are the project's own preset.
  const spec::texture::Parameters defaults, own = preset_parameters(defaults.preset);
  EXPECT_EQ(defaults.preset, spec::texture::Preset::kDeburr);
  EXPECT_EQ(own.axes, defaults.axes);
  EXPECT_EQ(own.footprint, defaults.footprint);
  EXPECT_EQ(own.log2, defaults.log2);
  EXPECT_EQ(own.count, defaults.count);
  EXPECT_THROW(preset_parameters(static_cast<spec::texture::Preset>(9)), spec::ConfigError);
}

TEST(TextureGolden, AGeometryThatCannotBeIsAConfigError) {
  spec::texture::Parameters p;
  p.cache_ways = 3;
  EXPECT_THROW(TextureGolden(p, {}), spec::ConfigError);
}

}  // namespace
}  // namespace deburr::unit_test
