// SPDX-License-Identifier: MIT
#include "golden/texture/texture_golden.h"

#include <string>

#include "golden/texture/block_decoder.h"
#include "spec/error.h"

namespace deburr::golden::texture {
namespace {

std::uint32_t word_of_four(const std::uint8_t* bytes) {
  return bytes[0] | std::uint32_t{bytes[1]} << 8 | std::uint32_t{bytes[2]} << 16 |
         std::uint32_t{bytes[3]} << 24;
}

// The bytes of a texel as one little-endian word.
std::uint32_t word_of(spec::texture::Format format, const std::uint8_t* bytes) {
  switch (spec::texture::kFormatBytes[static_cast<std::size_t>(format)]) {
    case 1:
      return bytes[0];
    case 2:
      return static_cast<std::uint32_t>(bytes[0] | bytes[1] << 8);
    default:
      return word_of_four(bytes);
  }
}

// Reads the most common format from memory without errors; no branches.
std::array<Channels, 4> read_rgba8(const std::uint8_t* bytes,
                                   const std::array<std::uint32_t, 4>& addresses) {
  const auto texel = [bytes](std::uint32_t address) {
    return decode_channels(spec::texture::Format::kRgba8, word_of_four(bytes + address));
  };
  return {texel(addresses[0]), texel(addresses[1]), texel(addresses[2]), texel(addresses[3])};
}

}  // namespace

TextureGolden::TextureGolden(const spec::texture::Parameters& parameters,
                             std::span<const std::uint8_t> memory, Traffic traffic)
    : parameters_(parameters),
      memory_(memory),
      predict_(traffic == Traffic::kPredict),
      cache_(parameters) {}

void TextureGolden::set_texture(int handle, const spec::texture::Descriptor& descriptor) {
  if (handle < 0 || handle >= spec::texture::kMaxTextures) {
    throw spec::ConfigError("texture handle " + std::to_string(handle) + " is outside 0..15");
  }
  Texture& texture = textures_[static_cast<std::size_t>(handle)];
  texture.descriptor = descriptor;
  texture.valid = valid(descriptor, parameters_.decode);
  texture.blocks = texture.valid && spec::texture::is_compressed(descriptor.format);
  texture.levels.clear();
  if (!texture.valid) return;
  texture.levels.resize(descriptor.levels);
  for (int k = 0; k < descriptor.levels; ++k) {
    texture.levels[static_cast<std::size_t>(k)] = {level_addresses(descriptor, k),
                                                   level_size(descriptor.width, k),
                                                   level_size(descriptor.height, k)};
  }
  find_plain_levels(texture);
}

const spec::texture::Descriptor& TextureGolden::texture(int handle) const {
  return textures_.at(static_cast<std::size_t>(handle)).descriptor;
}

void TextureGolden::set_error_lines(LinePredicate error) {
  error_ = std::move(error);
  for (Texture& texture : textures_) find_plain_levels(texture);
}

void TextureGolden::set_error_ranges(std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges) {
  set_error_lines([ranges = std::move(ranges), bytes = cache_.line_bytes()](std::uint32_t line) {
    const std::uint64_t first = std::uint64_t{line} * bytes;
    for (const auto& [low, high] : ranges) {
      if (low < first + bytes && first < high) return true;
    }
    return false;
  });
}

void TextureGolden::find_plain_levels(Texture& texture) const {
  for (std::size_t k = 0; k < texture.levels.size(); ++k) {
    const std::uint64_t end = std::uint64_t{texture.descriptor.base[k]} +
                              level_bytes(texture.descriptor, static_cast<int>(k));
    const std::uint64_t line_bytes = cache_.line_bytes();
    const std::uint64_t end_of_last_line = (end + line_bytes - 1) / line_bytes * line_bytes;
    texture.levels[k].plain = !error_ && end_of_last_line <= memory_.size();
  }
}

bool TextureGolden::fails(std::uint32_t memory_line) const {
  return (std::uint64_t{memory_line} + 1) * cache_.line_bytes() > memory_.size() ||
         (error_ && error_(memory_line));
}

void TextureGolden::reset() {
  cache_.reset();
  clear_work();
  clear_fills();
}

TextureGolden::Differences TextureGolden::differences(const Texture& texture,
                                                      const spec::texture::Quad& quad) {
  const auto between = [&](std::size_t to, std::size_t from) {
    Difference result;
    result.d = {std::int64_t{quad.s[to]} - quad.s[from], std::int64_t{quad.t[to]} - quad.t[from]};
    const Derivative s = derivative_in_texels(result.d.s, texture.descriptor.width);
    const Derivative t = derivative_in_texels(result.d.t, texture.descriptor.height);
    result.p = {s.texels, t.texels};
    result.saturated = s.saturated || t.saturated;
    return result;
  };
  return {{between(1, 0), between(3, 2)}, {between(2, 0), between(3, 1)}};
}

FragmentAnalysis TextureGolden::analyse(const Texture& texture, const Differences& differences,
                                        int lane) const {
  if (parameters_.derivatives == spec::texture::Derivatives::kCoarse) lane = 0;
  const Difference& row = differences.rows[static_cast<std::size_t>(lane >> 1)];
  const Difference& column = differences.columns[static_cast<std::size_t>(lane & 1)];
  const auto level = [&](const Footprint& of) {
    const AxisLogarithms lb = axis_logarithms(parameters_.axes, parameters_.log2, of);
    return select_level(parameters_, texture.descriptor, lb.d_max, lb.d_min);
  };
  // Built in place: clearing and copying took a sixth of the time of a trilinear sample.
  const FragmentAnalysis result = {
      .valid = true,
      .saturated = row.saturated || column.saturated,
      .d_x = row.d,
      .d_y = column.d,
      .p_x = row.p,
      .p_y = column.p,
      .footprint = footprint(parameters_.axes, parameters_.footprint, row.p, column.p),
      .axis = candidate_in_coordinates(parameters_.axes, result.footprint.major, row.d, column.d),
      .lod = level(result.footprint)};
  return result;
}

FragmentAnalysis TextureGolden::analyse(const spec::texture::Quad& quad, int lane) const {
  if (quad.texture >= spec::texture::kMaxTextures) return {};
  const Texture& texture = textures_[quad.texture];
  if (!texture.valid) return {};
  return analyse(texture, differences(texture, quad), lane);
}

struct TextureGolden::NoTap {
  static constexpr bool kBlocks = false;
  void lane(int) {}
  void sample(int, std::int64_t, std::int64_t) {}
  void fill(std::uint32_t) {}
  void invalid() {}
  void end() {}
};

// Serves both lists, and blocks without a list: a third copy of the inner loop would not be
// inlined.
struct TextureGolden::RequestTap {
  static constexpr bool kBlocks = true;
  int wanted;
  std::vector<BilinearRequest>* requests;  // of the wanted lane
  std::vector<CacheRequest>* all = nullptr;
  BilinearRequest next{};
  bool on = false;
  void lane(int lane) { on = requests && lane == wanted; }
  void sample(int i, std::int64_t s, std::int64_t t) {
    next.sample = i;
    next.s = s;
    next.t = t;
  }
  void request(int level, const std::array<std::uint32_t, 4>& addresses, std::array<bool, 2> turned,
               const std::array<std::uint8_t, 4>& inside, spec::texture::Format format) {
    next.level = level;
    next.addresses = addresses;
    if (on) requests->push_back(next);
    if (all)
      all->push_back(
          {.addresses = addresses, .turned = turned, .inside = inside, .format = format});
  }
  void fill(std::uint32_t line) {
    if (on) requests->back().misses.push_back(line);
  }
  void invalid() {
    if (all) all->push_back({.valid = false, .last = true});
  }
  void end() {
    if (all) all->back().last = true;
  }
};

QuadColours TextureGolden::process(const spec::texture::Quad& quad) {
  if (quad.texture < spec::texture::kMaxTextures && textures_[quad.texture].blocks) {
    RequestTap unseen{-1, nullptr};
    return process_seen(quad, unseen);
  }
  NoTap none;
  return process_seen(quad, none);
}

QuadColours TextureGolden::process(const spec::texture::Quad& quad, int lane,
                                   std::vector<BilinearRequest>& requests) {
  RequestTap tap{lane, &requests};
  return process_seen(quad, tap);
}

QuadColours TextureGolden::process(const spec::texture::Quad& quad,
                                   std::vector<CacheRequest>& requests) {
  RequestTap tap{-1, nullptr, &requests};
  return process_seen(quad, tap);
}

template <class Tap>
QuadColours TextureGolden::process_seen(const spec::texture::Quad& quad, Tap& tap) {
  QuadColours result;
  const Texture* texture =
      quad.texture < spec::texture::kMaxTextures ? &textures_[quad.texture] : nullptr;
  if (texture && !texture->valid) texture = nullptr;
  const Differences shared = texture ? differences(*texture, quad) : Differences{};
  for (int lane = 0; lane < 4; ++lane) {
    if ((quad.coverage >> lane & 1) == 0) continue;
    spec::texture::Colour& colour = result.colours[static_cast<std::size_t>(result.count++)];
    colour.tag = quad.tag;
    colour.lane = static_cast<std::uint8_t>(lane);
    colour.last = (quad.coverage & 0xF) >> (lane + 1) == 0;

    ++work_.fragments;
    if ((quad.clamped >> lane & 1) != 0) ++work_.clamped;
    if (!texture) {
      ++work_.invalid_fragments;
      tap.invalid();
      continue;
    }
    tap.lane(lane);
    const FragmentAnalysis fragment = analyse(*texture, shared, lane);
    if (fragment.saturated) ++work_.saturated;
    if (fragment.lod.magnified) ++work_.magnified;
    ++work_.by_samples[static_cast<std::size_t>(fragment.lod.samples)];
    work_.samples += static_cast<std::uint64_t>(fragment.lod.samples);
    const auto i = static_cast<std::size_t>(lane);
    colour.rgba = filter_fragment(*texture, fragment, quad.s[i], quad.t[i], tap);
    tap.end();
  }
  return result;
}

template <class Tap>
std::array<std::uint8_t, 4> TextureGolden::filter_fragment(const Texture& texture,
                                                           const FragmentAnalysis& fragment,
                                                           std::int32_t s, std::int32_t t,
                                                           Tap& tap) {
  const LevelOfDetail& lod = fragment.lod;
  const int n = lod.samples;
  const spec::texture::Kernel kernel = fragment_kernel(parameters_, fragment.footprint.major, n);
  const std::int32_t spread = spread_of(kernel, n, parameters_.spread);
  const std::int64_t distance_s = half_distance(n, spread, fragment.axis.s);
  const std::int64_t distance_t = half_distance(n, spread, fragment.axis.t);
  const bool srgb =
      texture.descriptor.srgb || texture.descriptor.format == spec::texture::Format::kSrgb8A8;
  const bool encode = srgb && parameters_.srgb_output == spec::texture::SrgbOutput::kEncoded;
  std::array<std::uint8_t, 4> rgba{};
  if (parameters_.blend == spec::texture::Blend::kLevel) {
    std::array<Channels, 2> sums;  // U8.20
    for (int request = 0; request < n * lod.requests_per_sample(); ++request) {
      const int next = request >= n ? 1 : 0, i = request - next * n;
      const std::int64_t at_s = s + offset_at(i, n, distance_s);
      const std::int64_t at_t = t + offset_at(i, n, distance_t);
      tap.sample(i, at_s, at_t);
      const Channels value = bilinear(texture, lod.level + next, lod.linear,
                                      wrap_coordinate(texture.descriptor.wrap_s, at_s),
                                      wrap_coordinate(texture.descriptor.wrap_t, at_t), tap);
      const Lanes weight = sample_weight(kernel, i, n);
      Channels& sum = sums[static_cast<std::size_t>(next)];
      sum.rb += weight * value.rb;
      sum.ga += weight * value.ga;
    }
    const Texel level = to_texel(sums[0]), next_level = to_texel(sums[1]);
    for (std::size_t c = 0; c < 4; ++c) {
      const std::uint64_t sum = level_sum_lerp(level[c], next_level[c], lod.fraction);
      rgba[c] =
          encode && c < 3 ? encode_result(sum, kLevelSumBits) : round_result(sum, kLevelSumBits);
    }
    return rgba;
  }
  Channels accumulator;  // U8.20
  for (int i = 0; i < n; ++i) {
    const std::int64_t at_s = s + offset_at(i, n, distance_s);
    const std::int64_t at_t = t + offset_at(i, n, distance_t);
    const std::int64_t sample_s = wrap_coordinate(texture.descriptor.wrap_s, at_s);
    const std::int64_t sample_t = wrap_coordinate(texture.descriptor.wrap_t, at_t);
    tap.sample(i, at_s, at_t);
    Channels value = bilinear(texture, lod.level, lod.linear, sample_s, sample_t, tap);
    if (lod.fraction != 0) {
      const Channels next = bilinear(texture, lod.level + 1, lod.linear, sample_s, sample_t, tap);
      value.rb = level_lerp(value.rb, next.rb, lod.fraction);
      value.ga = level_lerp(value.ga, next.ga, lod.fraction);
    }
    const Lanes weight = sample_weight(kernel, i, n);
    accumulator.rb += weight * value.rb;
    accumulator.ga += weight * value.ga;
  }
  const Texel sums = to_texel(accumulator);
  for (std::size_t c = 0; c < 4; ++c)
    rgba[c] = encode && c < 3 ? encode_result(sums[c]) : round_result(sums[c]);
  return rgba;
}

template <class Tap>
Channels TextureGolden::bilinear(const Texture& texture, int level, bool linear, std::int64_t s,
                                 std::int64_t t, Tap& tap) {
  const spec::texture::Descriptor& descriptor = texture.descriptor;
  const LevelTable& table = texture.levels[static_cast<std::size_t>(level)];
  const auto position = [linear](spec::texture::Wrap wrap, std::int64_t p, std::int32_t size) {
    return linear ? linear_texels(wrap, p, size) : nearest_texel(wrap, p, size);
  };
  const TexelPosition x = position(descriptor.wrap_s, s, table.width);
  const TexelPosition y = position(descriptor.wrap_t, t, table.height);
  const std::uint32_t x0 = table.column[static_cast<std::size_t>(x.i0)];
  const std::uint32_t x1 = table.column[static_cast<std::size_t>(x.i1)];
  const std::uint32_t y0 = table.row[static_cast<std::size_t>(y.i0)];
  const std::uint32_t y1 = table.row[static_cast<std::size_t>(y.i1)];
  const auto addresses = [&] {
    return std::array<std::uint32_t, 4>{x0 + y0, x1 + y0, x0 + y1, x1 + y1};
  };
  ++work_.bilinears;
  ++work_.by_level[static_cast<std::size_t>(level)];
  const auto turned = [&descriptor](std::int32_t row) {
    if (spec::texture::is_compressed(descriptor.format)) row /= 4;
    return descriptor.layout == spec::texture::Layout::kLinear && row % 2 != 0;
  };
  const auto inside = [&] {
    const auto at = [](std::int32_t column, std::int32_t row) {
      return static_cast<std::uint8_t>(row % 4 * 4 + column % 4);
    };
    return std::array<std::uint8_t, 4>{at(x.i0, y.i0), at(x.i1, y.i0), at(x.i0, y.i1),
                                       at(x.i1, y.i1)};
  };
  if constexpr (Tap::kBlocks) {
    tap.request(level, addresses(), {turned(y.i0), turned(y.i1)},
                texture.blocks ? inside() : std::array<std::uint8_t, 4>{}, descriptor.format);
  }
  if (predict_) predict(descriptor.format, addresses(), tap);

  const auto texels = [&] {
    if constexpr (Tap::kBlocks) {
      if (texture.blocks) return read_blocks(table, descriptor, addresses(), inside());
    }
    const bool common = table.plain && descriptor.format == spec::texture::Format::kRgba8;
    return common ? read_rgba8(memory_.data(), addresses())
                  : read(table, descriptor.format, addresses());
  };
  const std::array<Channels, 4> texel = texels();
  const auto filter = [&](Lanes a, Lanes b, Lanes c, Lanes d) {
    return vertical_lerp(horizontal_lerp(a, b, x.fraction), horizontal_lerp(c, d, x.fraction),
                         y.fraction);
  };
  return {filter(texel[0].rb, texel[1].rb, texel[2].rb, texel[3].rb),
          filter(texel[0].ga, texel[1].ga, texel[2].ga, texel[3].ga)};
}

std::array<Channels, 4> TextureGolden::read(const LevelTable& table, spec::texture::Format format,
                                            const std::array<std::uint32_t, 4>& addresses) const {
  std::array<Channels, 4> texels;
  for (std::size_t i = 0; i < 4; ++i) {
    const bool readable = table.plain || !fails(cache_.memory_line(addresses[i]));
    const std::uint32_t word = readable ? word_of(format, memory_.data() + addresses[i]) : 0;
    texels[i] = decode_channels(format, word);
  }
  return texels;
}

std::array<Channels, 4> TextureGolden::read_blocks(
    const LevelTable& table, const spec::texture::Descriptor& descriptor,
    const std::array<std::uint32_t, 4>& addresses,
    const std::array<std::uint8_t, 4>& inside) const {
  constexpr std::array<std::uint8_t, 16> kZeroBlock{};
  const auto decoded =
      descriptor.srgb ? spec::texture::Format::kSrgb8A8 : spec::texture::Format::kRgba8;
  std::array<Channels, 4> texels;
  for (std::size_t i = 0; i < 4; ++i) {
    const bool readable = table.plain || !fails(cache_.memory_line(addresses[i]));
    const std::uint8_t* block = readable ? memory_.data() + addresses[i] : kZeroBlock.data();
    texels[i] = decode_channels(decoded, block_texel(descriptor.format, parameters_.bc, block,
                                                     inside[i] % 4u, inside[i] / 4u));
  }
  return texels;
}

template <class Tap>
void TextureGolden::predict(spec::texture::Format format,
                            const std::array<std::uint32_t, 4>& addresses, Tap& tap) {
  const auto line_of = [&](std::size_t texel) {
    return Tap::kBlocks ? cache_.line_of(format, addresses[texel])
                        : cache_.memory_line(addresses[texel]);
  };
  cache_.request({line_of(0), line_of(1), line_of(2), line_of(3)},
                 [this, &tap](std::uint32_t line) {
                   tap.fill(line);
                   fill(line);
                 });
}

void TextureGolden::fill(std::uint32_t line) {
  ++work_.line_fills;
  if (record_fills_) fills_.push_back(line);
  if (fill_sink_) fill_sink_(line);
  const CachePredictor::Fetch fetch = cache_.fetch(line);
  if (!fetch.requested) return;
  ++work_.memory_lines;
  if (fails(fetch.memory_line)) ++work_.memory_errors;
  if (record_fills_ && cache_.decodes_before()) memory_lines_.push_back(fetch.memory_line);
  if (memory_line_sink_) memory_line_sink_(fetch.memory_line);
}

}  // namespace deburr::golden::texture
