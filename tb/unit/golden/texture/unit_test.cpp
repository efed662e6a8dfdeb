// SPDX-License-Identifier: MIT
// The whole texture golden model: its fast path against a plain composition of its blocks, its
// traffic and counters, invalid descriptors and memory errors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "golden/texture/block_decoder.h"
#include "golden/texture/texture_golden.h"
#include "spec/error.h"
#include "spec/texture/parameters.h"
#include "tb/base/random.h"
#include "tb/unit/golden/texture/support.h"

namespace deburr::unit_test {
namespace {

using namespace golden::texture;
using tb::texture::EncodedTexture;

// ---- plain composition of the blocks ------------------------------------------------------------

struct PlainResult {
  std::array<std::uint8_t, 4> rgba{};
  std::vector<BilinearRequest> requests;  // without their misses
};

PlainResult plain(const spec::texture::Parameters& p, const spec::texture::Descriptor& d,
                  const std::vector<std::uint8_t>& memory, const spec::texture::Quad& quad,
                  int lane) {
  const bool coarse = p.derivatives == spec::texture::Derivatives::kCoarse;
  const int row = coarse ? 0 : lane / 2 * 2, column = coarse ? 0 : lane % 2;
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
  const spec::texture::Kernel kernel = fragment_kernel(p, f.major, lod.samples);
  const std::int32_t spread = spread_of(kernel, lod.samples, p.spread);
  PlainResult result;
  // Filters sample i at one level; U8.12.
  const auto filtered = [&](int i, int level) {
    const std::int64_t ps = at(s, lane) + sample_offset(i, lod.samples, spread, axis.s);
    const std::int64_t pt = at(t, lane) + sample_offset(i, lod.samples, spread, axis.t);
    const auto position = lod.linear ? linear_position : nearest_position;
    const TexelPosition x = position(d.wrap_s, ps, level_size(d.width, level));
    const TexelPosition y = position(d.wrap_t, pt, level_size(d.height, level));
    const std::array<std::uint32_t, 4> addresses = {
        texel_address(d, level, x.i0, y.i0), texel_address(d, level, x.i1, y.i0),
        texel_address(d, level, x.i0, y.i1), texel_address(d, level, x.i1, y.i1)};
    result.requests.push_back({i, level, ps, pt, addresses, {}});
    std::array<Texel, 4> texel;
    for (std::size_t k = 0; k < 4; ++k) {
      if (spec::texture::is_compressed(d.format)) {
        const auto all = decode_block(d.format, p.bc, &memory.at(addresses[k]));
        const int inside = (k < 2 ? y.i0 : y.i1) % 4 * 4 + (k % 2 == 0 ? x.i0 : x.i1) % 4;
        texel[k] =
            decode_texel(d.srgb ? spec::texture::Format::kSrgb8A8 : spec::texture::Format::kRgba8,
                         all[static_cast<std::size_t>(inside)]);
        continue;
      }
      std::uint32_t word = 0;
      for (std::size_t b = 0; b < spec::texture::kFormatBytes[static_cast<std::size_t>(d.format)];
           ++b) {
        word |= std::uint32_t{memory.at(addresses[k] + b)} << (8 * b);
      }
      texel[k] = decode_texel(d.format, word);
    }
    Texel colour{};
    for (std::size_t c = 0; c < 4; ++c) {
      colour[c] = vertical_lerp(horizontal_lerp(texel[0][c], texel[1][c], x.fraction),
                                horizontal_lerp(texel[2][c], texel[3][c], x.fraction), y.fraction);
    }
    return colour;
  };
  const auto weight = [&](int i) { return sample_weight(kernel, i, lod.samples); };
  const bool encoded = (d.srgb || d.format == spec::texture::Format::kSrgb8A8) &&
                       p.srgb_output == spec::texture::SrgbOutput::kEncoded;
  if (p.blend == spec::texture::Blend::kLevel) {
    // Products and sums in plain integers, halves added before the only division.
    std::array<std::uint64_t, 4> sum{};
    for (int k = 0; k < lod.requests_per_sample(); ++k) {
      const std::uint64_t factor = k == 1 ? lod.fraction : 256 - lod.fraction;
      for (int i = 0; i < lod.samples; ++i) {
        const Texel colour = filtered(i, lod.level + k);
        for (std::size_t c = 0; c < 4; ++c) sum[c] += factor * weight(i) * colour[c];
      }
    }
    for (std::size_t c = 0; c < 4; ++c) {
      constexpr std::uint64_t kOneStep = 16777216, kOneCode = 268435456;  // 2^24, 2^28
      result.rgba[c] = encoded && c < 3
                           ? spec::texture::kLinearToSrgb[(sum[c] + kOneStep / 2) / kOneStep]
                           : static_cast<std::uint8_t>((sum[c] + kOneCode / 2) / kOneCode);
    }
    return result;
  }
  std::array<std::uint32_t, 4> accumulator{};
  for (int i = 0; i < lod.samples; ++i) {
    const Texel level = filtered(i, lod.level);
    const Texel next = lod.fraction == 0 ? Texel{} : filtered(i, lod.level + 1);
    for (std::size_t c = 0; c < 4; ++c)
      accumulator[c] += weight(i) * level_lerp(level[c], next[c], lod.fraction);
  }
  for (std::size_t c = 0; c < 4; ++c)
    result.rgba[c] =
        encoded && c < 3 ? encode_result(accumulator[c]) : round_result(accumulator[c]);
  return result;
}

// A second model of the cache: each set is a list in the order of replacement.
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
    p.kernel = static_cast<spec::texture::Kernel>(pick(0, 2));
    p.spread = pick(0, 2) == 0 ? pick(0, 128) : 64;
    p.blend = static_cast<spec::texture::Blend>(pick(0, 1));
    p.derivatives = static_cast<spec::texture::Derivatives>(pick(0, 1));
    p.bc = static_cast<spec::texture::BlockRule>(pick(0, 1));
    p.decode = pick(0, 1) == 0 ? spec::texture::Decode::kAfter : spec::texture::Decode::kBefore;
    p.cache_bytes = 1 << pick(10, 14);
    p.cache_line_bytes = 1 << pick(5, 7);
    if (p.decode == spec::texture::Decode::kBefore) {
      p.cache_line_bytes = 64;
      p.cache_compressed_lines = 1 << pick(2, 6);
    }
    p.cache_ways = 1 << pick(0, 3);
    p.cache_replacement = static_cast<spec::texture::Replacement>(pick(0, 1));
    return p;
  }

  spec::texture::Descriptor sampler() {
    spec::texture::Descriptor d;
    d.format = static_cast<spec::texture::Format>(pick(0, 11));
    d.srgb = spec::texture::may_be_srgb(d.format) && pick(0, 1) == 0;
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

bool same(const BilinearRequest& a, const BilinearRequest& b) {
  return a.sample == b.sample && a.level == b.level && a.s == b.s && a.t == b.t &&
         a.addresses == b.addresses && a.misses == b.misses;
}

// Plain lists of lines: fills of the cache, and lines requested from memory.
struct PlainTraffic {
  PlainCache cache;
  std::size_t most_compressed;  // 0: blocks are not decoded before the cache
  std::uint32_t line_bytes, codec, block_bytes;
  std::vector<std::uint32_t> fills, memory_lines, compressed;

  PlainTraffic(const spec::texture::Parameters& p, spec::texture::Format format)
      : cache(static_cast<std::uint32_t>(p.cache_bytes / p.cache_line_bytes / p.cache_ways),
              static_cast<std::uint32_t>(p.cache_ways),
              p.cache_replacement == spec::texture::Replacement::kLru),
        most_compressed(p.decode == spec::texture::Decode::kBefore &&
                                format >= spec::texture::Format::kBc1
                            ? static_cast<std::size_t>(p.cache_compressed_lines)
                            : 0),
        line_bytes(static_cast<std::uint32_t>(p.cache_line_bytes)),
        codec(static_cast<std::uint32_t>(format) - 4),
        block_bytes(format == spec::texture::Format::kBc3 ||
                            format == spec::texture::Format::kBc5 ||
                            format == spec::texture::Format::kEtc2Rgba8
                        ? 16
                        : 8) {}

  // Returns the line numbers that the request fills.
  std::vector<std::uint32_t> request(const std::array<std::uint32_t, 4>& addresses) {
    std::vector<std::uint32_t> seen, missed;
    for (const std::uint32_t address : addresses) {
      const std::uint32_t memory_line = address / line_bytes;
      const std::uint32_t line =
          most_compressed > 0 ? codec * 0x20000000 + address / block_bytes : memory_line;
      if (std::find(seen.begin(), seen.end(), line) != seen.end()) continue;
      seen.push_back(line);
      if (cache.lookup(line)) continue;
      missed.push_back(line);
      if (std::find(compressed.begin(), compressed.end(), memory_line) != compressed.end())
        continue;
      memory_lines.push_back(memory_line);
      if (most_compressed == 0) continue;
      compressed.push_back(memory_line);
      if (compressed.size() > most_compressed) compressed.erase(compressed.begin());
    }
    fills.insert(fills.end(), missed.begin(), missed.end());
    return missed;
  }
};

// Runs random work on both models. Returns the number of differences in colours, requests, fills
// and counters. `spoil` may change a colour of the golden model.
int differences(unsigned seed, const std::function<void(spec::texture::Colour&)>& spoil) {
  RandomWork work(seed);
  const spec::texture::Parameters p = work.parameters();
  const auto sampler = work.sampler();
  const auto height = work.pick(1, 90), width = work.pick(1, 90);
  const EncodedTexture texture(tb::texture::noise(width, height, seed), sampler);
  TextureGolden golden(p, texture.memory),
      without_traffic(p, texture.memory, TextureGolden::Traffic::kIgnore);
  golden.set_texture(5, texture.descriptor);
  without_traffic.set_texture(5, texture.descriptor);
  golden.record_fills(true);
  PlainTraffic traffic(p, sampler.format);
  std::uint64_t fragments = 0, bilinears = 0;
  int count = 0;
  for (std::uint32_t tag = 0; tag < 150; ++tag) {
    spec::texture::Quad quad = work.quad(tag);
    quad.texture = 5;
    const int seen_lane = static_cast<int>(tag % 4);
    std::vector<BilinearRequest> requests, expected_requests;
    const QuadColours colours = golden.process(quad, seen_lane, requests);
    if (without_traffic.process(quad).colours != colours.colours) ++count;
    const spec::texture::Colour* next = colours.begin();
    for (int lane = 0; lane < 4; ++lane) {
      if ((quad.coverage >> lane & 1) == 0) continue;
      PlainResult expected = plain(p, texture.descriptor, texture.memory, quad, lane);
      ++fragments;
      bilinears += expected.requests.size();
      for (BilinearRequest& request : expected.requests)
        request.misses = traffic.request(request.addresses);
      if (lane == seen_lane) expected_requests = expected.requests;
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
    if (!std::ranges::equal(requests, expected_requests, same)) ++count;
  }
  if (golden.fills() != traffic.fills) ++count;
  if (golden.memory_lines() != traffic.memory_lines) ++count;
  if (golden.work().line_fills != traffic.fills.size()) ++count;
  if (golden.work().memory_lines != traffic.memory_lines.size()) ++count;
  if (without_traffic.work().line_fills != 0 || without_traffic.work().memory_lines != 0) ++count;
  if (golden.work().fragments != fragments) ++count;
  if (golden.work().bilinears != bilinears) ++count;
  return count;
}

TEST(TextureGolden, MatchesPlainCompositionOfBlocks) {
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

TEST(TextureGolden, FillsGoToTheSinkAndRepeatAfterInvalidation) {
  const EncodedTexture texture(tb::texture::noise(64, 64, 1), {});
  TextureGolden golden(preset_parameters(spec::texture::Preset::kPaper), texture.memory);
  golden.set_texture(0, texture.descriptor);
  std::vector<std::uint32_t> sunk;
  golden.set_fill_sink([&](std::uint32_t line) { sunk.push_back(line); });
  golden.record_fills(true);
  // 1.5 texels per pixel, between two levels. On each level the four texels are in four tiles.
  spec::texture::Quad quad = flat_quad(0, 0, 1.5 / 64, 1.5 / 64);
  quad.coverage = 1;
  golden.process(quad);
  EXPECT_EQ(golden.work().line_fills, 8u);
  EXPECT_EQ(golden.fills(), sunk);
  EXPECT_EQ(golden.work().by_level[0], 1u);
  EXPECT_EQ(golden.work().by_level[1], 1u);
  golden.process(quad);
  EXPECT_EQ(golden.work().line_fills, 8u);  // all lines hit
  golden.invalidate_cache();
  golden.process(quad);
  EXPECT_EQ(golden.work().line_fills, 16u);
  golden.reset();
  EXPECT_EQ(golden.work(), TextureWork{});
  EXPECT_TRUE(golden.fills().empty());
  golden.process(quad);
  EXPECT_EQ(golden.work().line_fills, 8u);  // the texture was kept
}

// Two textures at the same addresses, of 2 x 2 lines of blocks and of texels.
TEST(TextureGolden, MemoryLinesAreInTheOrderOfTheFillsThatRequestThem) {
  using spec::texture::Decode;
  for (const Decode decode : {Decode::kAfter, Decode::kBefore}) {
    spec::texture::Parameters p;
    p.decode = decode;
    std::vector<std::uint8_t> memory(4096);
    TextureGolden golden(p, memory);
    spec::texture::Descriptor sampler;
    sampler.levels = 1;
    sampler.base[0] = 1024;
    sampler.mag_filter = spec::texture::MagFilter::kNearest;
    sampler.layout = spec::texture::Layout::kLinear;  // a row of blocks is a line
    sampler.format = spec::texture::Format::kBc1;
    sampler.width = 32;
    sampler.height = 16;
    golden.set_texture(0, sampler);
    sampler.format = spec::texture::Format::kRgba8;
    sampler.width = 16;
    golden.set_texture(1, sampler);
    std::vector<std::uint32_t> filled, requested;
    golden.set_fill_sink([&](std::uint32_t line) { filled.push_back(line); });
    golden.set_memory_line_sink([&](std::uint32_t line) { requested.push_back(line); });
    golden.record_fills(true);
    const auto read = [&](std::uint8_t texture, double x, double y) {
      spec::texture::Quad quad =
          flat_quad((x + 0.5) / (texture == 0 ? 32 : 16), (y + 0.5) / 16, 0, 0);
      quad.texture = texture;
      golden.process(quad);
    };
    const auto read_all = [&] {
      read(0, 5, 0);   // block (1, 0)
      read(0, 4, 3);   // the same
      read(0, 31, 3);  // block (7, 0)
      read(1, 15, 1);  // row 1
      read(0, 0, 4);   // block (0, 1), whose bytes are those of row 1
      read(1, 0, 0);   // row 0
    };
    read_all();
    using Lines = std::vector<std::uint32_t>;
    const Lines memory_lines = decode == Decode::kAfter ? Lines{16, 17} : Lines{16, 17, 17, 16};
    const std::uint32_t bc1 = 1u << 29 | 128;
    EXPECT_EQ(golden.fills(),
              decode == Decode::kAfter ? memory_lines : (Lines{bc1 + 1, bc1 + 7, 17, bc1 + 8, 16}));
    EXPECT_EQ(golden.memory_lines(), memory_lines);
    EXPECT_EQ(filled, golden.fills());
    EXPECT_EQ(requested, memory_lines);
    EXPECT_EQ(golden.work().line_fills, filled.size());
    EXPECT_EQ(golden.work().memory_lines, memory_lines.size());
    read_all();
    EXPECT_EQ(golden.memory_lines(), memory_lines);
    golden.invalidate_cache();
    golden.clear_fills();
    read_all();
    EXPECT_EQ(golden.memory_lines(), memory_lines);
    golden.reset();
    EXPECT_TRUE(golden.memory_lines().empty());
    read_all();
    EXPECT_EQ(golden.memory_lines(), memory_lines);
  }
}

TEST(TextureGolden, CountsClampedSaturatedAndMagnifiedFragments) {
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
  EXPECT_EQ(fragment.lod.samples, 1);  // of the level of 1 x 1 texels
}

// Only a level of 1 x 1 texels is sampled once, in every mode; its colour is that of the texel.
TEST(TextureGolden, LevelOfOneTexelIsSampledOnce) {
  using spec::texture::MinFilter;
  const auto samples = [](int width, int height, MinFilter filter, int level) {
    spec::texture::Descriptor sampler;
    sampler.max_anisotropy_log2 = 4;
    sampler.min_filter = filter;
    sampler.min_lod = sampler.max_lod = static_cast<std::uint16_t>(level << 8);
    const auto picture = tb::texture::noise(width, height, 1);
    const EncodedTexture texture(picture, sampler);
    TextureGolden golden({}, texture.memory);
    golden.set_texture(0, texture.descriptor);
    const spec::texture::Quad quad = flat_quad(0.3, 0.4, 16.0 / width, 2.0 / height);
    std::vector<BilinearRequest> requests;
    const QuadColours colours = golden.process(quad, 0, requests);
    const auto n = static_cast<std::size_t>(golden.analyse(quad, 0).lod.samples);
    EXPECT_EQ(requests.size(), n);
    EXPECT_EQ(golden.work().samples, 4 * n);
    if (n == 1) {
      EXPECT_EQ(colours.begin()->rgba, picture.levels.back().at(0, 0));
    }
    return n;
  };
  for (const MinFilter filter :
       {MinFilter::kLinearMipmapLinear, MinFilter::kNearestMipmapNearest}) {
    EXPECT_EQ(samples(8, 8, filter, 3), 1u);
    EXPECT_EQ(samples(8, 8, filter, 2), 8u);
    EXPECT_EQ(samples(8, 1, filter, 2), 8u);  // 2 x 1 texels
    EXPECT_EQ(samples(8, 1, filter, 3), 1u);
    EXPECT_EQ(samples(1, 8, filter, 2), 8u);
    EXPECT_EQ(samples(1, 1, filter, 0), 1u);  // magnified
  }
  EXPECT_EQ(samples(1, 1, MinFilter::kLinear, 1), 1u);
  EXPECT_EQ(samples(8, 8, MinFilter::kLinear, 3), 8u);
}

// ---- blend and derivatives ----------------------------------------------------------------------

// Four samples between levels 0 and 1.
spec::texture::Quad four_samples() { return flat_quad(0.3, 0.4, 6.2 / 64, 1.4 / 64); }

std::vector<BilinearRequest> requests_of(const EncodedTexture& texture, spec::texture::Blend blend,
                                         std::vector<std::uint32_t>& fills) {
  spec::texture::Parameters p = preset_parameters(spec::texture::Preset::kPaper);
  p.blend = blend;
  TextureGolden golden(p, texture.memory);
  golden.set_texture(0, texture.descriptor);
  golden.record_fills(true);
  std::vector<BilinearRequest> requests;
  golden.process(four_samples(), 0, requests);
  golden.reset();
  golden.process(four_samples());
  fills = golden.fills();
  return requests;
}

TEST(TextureGolden, LevelBlendRequestsAllSamplesOfALevelBeforeTheNextLevel) {
  spec::texture::Descriptor sampler;
  sampler.max_anisotropy_log2 = 2;
  const EncodedTexture texture(tb::texture::noise(64, 64, 1), sampler);
  std::vector<std::uint32_t> fills, fills_by_sample;
  const auto by_level = requests_of(texture, spec::texture::Blend::kLevel, fills);
  const auto by_sample = requests_of(texture, spec::texture::Blend::kSample, fills_by_sample);
  ASSERT_EQ(by_level.size(), 8u);
  ASSERT_EQ(by_sample.size(), 8u);
  for (std::size_t i = 0; i < 4; ++i) {
    for (const std::size_t k : {0u, 1u}) {
      EXPECT_EQ(by_level[4 * k + i].sample, static_cast<int>(i));
      EXPECT_EQ(by_level[4 * k + i].level, static_cast<int>(k));
      EXPECT_EQ(by_level[4 * k + i].s, by_sample[2 * i + k].s);
      EXPECT_EQ(by_level[4 * k + i].addresses, by_sample[2 * i + k].addresses);
    }
  }
  // The first line of level 1 is fetched after those of all samples of level 0.
  const std::uint32_t level_1 = texture.descriptor.base[1] / 64;
  const auto first = [&](const std::vector<std::uint32_t>& all) {
    return std::ranges::find_if(all, [&](auto line) { return line >= level_1; }) - all.begin();
  };
  std::set<std::uint32_t> level_0;
  for (std::size_t i = 0; i < 4; ++i)
    for (const std::uint32_t address : by_level[i].addresses) level_0.insert(address / 64);
  EXPECT_EQ(static_cast<std::size_t>(first(fills)), level_0.size());
  EXPECT_LT(static_cast<std::size_t>(first(fills_by_sample)), level_0.size());
}

TEST(TextureGolden, BlendsDifferOnlyWithALevelFraction) {
  spec::texture::Descriptor sampler;
  sampler.max_anisotropy_log2 = 3;
  const EncodedTexture texture(tb::texture::noise(64, 64, 1), sampler);
  spec::texture::Parameters p;
  TextureGolden by_sample(p, texture.memory);
  p.blend = spec::texture::Blend::kLevel;
  TextureGolden by_level(p, texture.memory);
  by_sample.set_texture(0, texture.descriptor);
  by_level.set_texture(0, texture.descriptor);
  RandomWork work(1);
  int on_a_level = 0, rounded_differently = 0;
  for (std::uint32_t tag = 0; tag < 40000; ++tag) {
    spec::texture::Quad quad = work.quad(tag);
    quad.coverage = 1;
    const bool same_colour = by_sample.process(quad).colours == by_level.process(quad).colours;
    if (by_level.analyse(quad, 0).lod.fraction == 0) {
      ++on_a_level;
      ASSERT_TRUE(same_colour) << "quad " << tag;
    } else if (!same_colour) {
      ++rounded_differently;
    }
  }
  EXPECT_GT(on_a_level, 1000);
  EXPECT_GT(rounded_differently, 0);
}

// Lanes 1 and 2 are shifted by different steps from lane 0, and lane 3 by others from both.
TEST(TextureGolden, CoarseDerivativesAreThoseOfRowAndColumnZeroForAllLanes) {
  spec::texture::Parameters p;
  p.derivatives = spec::texture::Derivatives::kCoarse;
  spec::texture::Descriptor sampler;
  sampler.max_anisotropy_log2 = 4;
  const EncodedTexture texture(tb::texture::noise(64, 64, 1), sampler);
  TextureGolden coarse(p, texture.memory), fine({}, texture.memory);
  coarse.set_texture(0, texture.descriptor);
  fine.set_texture(0, texture.descriptor);
  spec::texture::Quad quad;
  quad.coverage = 0b1000;  // lanes without coverage count too
  quad.s = {8000000, 10400000, 8400000, 12400000};
  quad.t = {16000000, 16080000, 34000000, 20000000};
  const Step row{2400000, 80000}, column{400000, 18000000};
  for (int lane = 0; lane < 4; ++lane) {
    const FragmentAnalysis fragment = coarse.analyse(quad, lane);
    EXPECT_EQ(fragment.d_x, row) << lane;
    EXPECT_EQ(fragment.d_y, column) << lane;
    EXPECT_EQ(fine.analyse(quad, lane).d_x == row, lane < 2) << lane;
    EXPECT_EQ(fine.analyse(quad, lane).d_y == column, lane % 2 == 0) << lane;
  }
  coarse.process(quad);
  fine.process(quad);
  EXPECT_EQ(coarse.work().samples, 8u);  // 68.7 : 9.2 texels
  EXPECT_NE(fine.work().samples, 8u);
}

// ---- bad input ----------------------------------------------------------------------------------

TEST(TextureGolden, FragmentsOfAnInvalidDescriptorAreZeroAndCounted) {
  const EncodedTexture texture(tb::texture::noise(8, 8, 1), {});
  TextureGolden golden({}, texture.memory);
  golden.set_texture(0, texture.descriptor);
  spec::texture::Descriptor bad = texture.descriptor;
  bad.levels = 9;
  golden.set_texture(1, bad);
  for (const int handle : {1, 2, 16, 255}) {  // invalid, never set, out of range
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

TEST(TextureGolden, ValidAndInvalidDescriptorsReplaceEachOther) {
  const EncodedTexture texture(tb::texture::noise(8, 8, 1), {});
  TextureGolden golden({}, texture.memory);
  for (const auto& descriptor : {texture.descriptor, {}, texture.descriptor}) {
    golden.set_texture(0, descriptor);
    golden.process(flat_quad(0, 0, 0.1, 0.1));
  }
  EXPECT_EQ(golden.work().invalid_fragments, 4u);
}

// A texture with every channel at 255, read without filtering.
EncodedTexture white(int width, int height, spec::texture::Descriptor sampler = {}) {
  sampler.min_filter = spec::texture::MinFilter::kNearest;
  sampler.mag_filter = spec::texture::MagFilter::kNearest;
  return {tb::texture::Pyramid(width, height,
                               [](int, int) {
                                 return tb::texture::Rgba{255, 255, 255, 255};
                               }),
          sampler};
}

TEST(TextureGolden, ErrorLinesReadAsZeroBytesAndEachFillCounts) {
  for (const auto format : {spec::texture::Format::kRgba8, spec::texture::Format::kL8,
                            spec::texture::Format::kRgb565}) {
    spec::texture::Descriptor sampler;
    sampler.format = format;
    const EncodedTexture texture = white(32, 32, sampler);
    TextureGolden golden({}, texture.memory);
    golden.set_texture(0, texture.descriptor);
    const std::uint32_t bad = texel_address(texture.descriptor, 0, 0, 0);
    golden.set_error_ranges({{bad + 5, bad + 6}});  // an error of one byte affects its whole line
    const spec::texture::Quad quad = flat_quad(0.5 / 32, 0.5 / 32, 16.0 / 32, 16.0 / 32);
    const tb::texture::Rgba all = {255, 255, 255, 255};
    const std::uint8_t alpha = format == spec::texture::Format::kRgba8 ? 0 : 255;
    for (const std::uint64_t errors : {1u, 2u}) {
      const QuadColours colours = golden.process(quad);
      EXPECT_EQ(colours.colours[0].rgba, (tb::texture::Rgba{0, 0, 0, alpha}));
      EXPECT_EQ(colours.colours[3].rgba, all);
      EXPECT_EQ(golden.work().memory_errors, errors);
      golden.invalidate_cache();
    }
    golden.set_error_lines({});
    EXPECT_EQ(golden.process(quad).colours[0].rgba, all);
  }
}

// The texels of a block of zeros, which docs/reference/texture/compressed.md lists.
void expect_zero_blocks(spec::texture::Decode decode) {
  spec::texture::Parameters p;
  p.decode = decode;
  for (auto format = spec::texture::Format::kBc1; format <= spec::texture::Format::kEtc2Rgba8;
       format = static_cast<spec::texture::Format>(static_cast<int>(format) + 1)) {
    spec::texture::Descriptor sampler;
    sampler.format = format;
    const EncodedTexture texture = white(32, 32, sampler);
    TextureGolden golden(p, texture.memory);
    golden.set_texture(0, texture.descriptor);
    golden.set_error_ranges({{5, 6}});
    const std::array<std::uint8_t, 16> zero{};
    const std::uint32_t texel = block_texel(format, p.bc, zero.data(), 0, 0);
    // Then block (1, 0), of the same line: one response. Then both again.
    const spec::texture::Quad first = flat_quad(0.5 / 32, 0.5 / 32, 0.5, 0.5);
    const spec::texture::Quad second = flat_quad(4.5 / 32, 0.5 / 32, 0.5, 0.5);
    for (const std::uint64_t errors : {1u, 2u}) {
      for (const auto& quad : {first, second}) {
        const QuadColours colours = golden.process(quad);
        for (std::size_t c = 0; c < 4; ++c)
          EXPECT_EQ(colours.colours[0].rgba[c], texel >> 8 * c & 255) << static_cast<int>(format);
        EXPECT_NE(colours.colours[3].rgba, colours.colours[0].rgba) << static_cast<int>(format);
        EXPECT_EQ(golden.work().memory_errors, errors);
      }
      golden.invalidate_cache();
    }
  }
}
TEST(TextureGolden, BlocksOfErrorLinesAreZeroBytes) {
  expect_zero_blocks(spec::texture::Decode::kAfter);
}
TEST(TextureGolden, EveryBlockDecodedFromAnErrorLineIsZeroAndTheResponseCountsOnce) {
  expect_zero_blocks(spec::texture::Decode::kBefore);
}

// Decoded lines outlive their memory line: only a response counts.
TEST(TextureGolden, AReplacedErrorLineCountsAgain) {
  spec::texture::Descriptor sampler;
  sampler.format = spec::texture::Format::kBc1;
  sampler.layout = spec::texture::Layout::kLinear;
  const EncodedTexture texture = white(32, 32, sampler);  // a row of blocks is a line
  spec::texture::Parameters p;
  p.decode = spec::texture::Decode::kBefore;
  p.cache_compressed_lines = 4;
  TextureGolden golden(p, texture.memory);
  golden.set_texture(0, texture.descriptor);
  golden.set_error_lines([](std::uint32_t line) { return line == 0; });
  const auto read = [&](int column, int row) {  // of blocks
    return golden.process(flat_quad((4 * column + 0.5) / 32, (4 * row + 0.5) / 32, 0, 0))
        .colours[0]
        .rgba;
  };
  const tb::texture::Rgba black = {0, 0, 0, 255};
  EXPECT_EQ(read(0, 0), black);
  for (int row = 1; row <= 4; ++row) EXPECT_NE(read(0, row), black);
  EXPECT_EQ(read(0, 0), black);
  EXPECT_EQ(golden.work().memory_errors, 1u);
  EXPECT_EQ(golden.work().memory_lines, 5u);
  EXPECT_EQ(read(1, 0), black);
  EXPECT_EQ(golden.work().memory_errors, 2u);
  EXPECT_EQ(golden.work().memory_lines, 6u);
}

// The second address of a range is exclusive. The line at `first` has the bytes first to first +
// 63.
TEST(TextureGolden, ErrorRangesAffectEveryLineTheyOverlap) {
  const EncodedTexture texture = white(32, 32);
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
  EXPECT_EQ(errors(first + 63, first + 200), 1u);
  EXPECT_EQ(errors(first + 64, first + 128), 0u);
}

// Each of the four rows is one line of memory. A read of the last line is an error only if memory
// ends within it, with or without error ranges.
TEST(TextureGolden, IncompleteLastLineIsAnError) {
  spec::texture::Descriptor sampler;
  sampler.layout = spec::texture::Layout::kLinear;
  EncodedTexture texture = white(16, 4, sampler);
  texture.descriptor.levels = 1;
  const spec::texture::Quad quad = flat_quad(0.1, 0.6, 0.001, 0.25);  // rows 2 and 3
  for (const std::uint32_t base : {0u, 4096u}) {
    for (const bool whole : {false, true}) {
      for (const bool ask : {false, true}) {
        std::vector<std::uint8_t> memory(base + (whole ? 4 * 64 : 4 * 64 - 1), 9);
        texture.descriptor.base[0] = base;
        TextureGolden golden({}, memory);
        golden.set_texture(0, texture.descriptor);
        if (ask) golden.set_error_ranges({{0, 1}});  // every line is checked
        const QuadColours colours = golden.process(quad);
        EXPECT_EQ(colours.colours[0].rgba[0], 9);
        EXPECT_EQ(colours.colours[2].rgba[0], whole ? 9 : 0);
        EXPECT_EQ(golden.work().memory_errors, whole ? 0u : 1u);
      }
    }
  }
  // Empty memory, and addresses that wrap.
  TextureGolden empty({}, {});
  texture.descriptor.base[0] = 0xFFFFFFC0;
  empty.set_texture(0, texture.descriptor);
  EXPECT_EQ(empty.process(quad).colours[3].rgba, tb::texture::Rgba{});
}

TEST(TextureGolden, PresetsSelectTheirParameters) {
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

TEST(TextureGolden, RejectsImpossibleCacheGeometry) {
  spec::texture::Parameters p;
  p.cache_ways = 3;
  EXPECT_THROW(TextureGolden(p, {}), spec::ConfigError);
}

}  // namespace
}  // namespace deburr::unit_test
