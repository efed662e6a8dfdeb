// SPDX-License-Identifier: MIT
// Payloads of the links of the texture unit: one struct per link, with fields, widths and formats
// (rtl_model/fabric/payload.h; formats as in docs/reference/texture/formats.md). Texel order: 00,
// 10, 01, 11.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "rtl_model/fabric/payload.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

// Accompanies a fragment through the pipeline.
struct Ticket {
  std::uint32_t tag;     // tag of the quad
  std::uint8_t lane;     // lane in the quad
  bool last;             // last covered lane of its quad
  bool valid;            // the descriptor is valid; otherwise the colour is zero
  std::uint8_t texture;  // descriptor handle
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("tag", self.tag, 32);
    visit("lane", self.lane, 2);
    visit("last", self.last);
    visit("valid", self.valid);
    visit("texture", self.texture, 4);
  }
};

// DerivativeUnit -> FootprintUnit or AxisUnit. The magnitudes have the signs of the differences.
struct DerivativeToken {
  Ticket ticket;
  std::int32_t s, t;
  std::int64_t s_x, t_x, s_y, t_y;  // coordinate differences along row and column
  std::uint32_t size_s_x, size_t_x, size_s_y, size_t_y;  // their magnitudes in texels of level 0
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("ticket", self.ticket);
    visit("s", self.s, 32, "S7.24");
    visit("t", self.t, 32, "S7.24");
    visit("s_x", self.s_x, 33, "S8.24");
    visit("t_x", self.t_x, 33, "S8.24");
    visit("s_y", self.s_y, 33, "S8.24");
    visit("t_y", self.t_y, 33, "S8.24");
    visit("size_s_x", self.size_s_x, 31, "U15.16");
    visit("size_t_x", self.size_t_x, 31, "U15.16");
    visit("size_s_y", self.size_s_y, 31, "U15.16");
    visit("size_t_y", self.size_t_y, 31, "U15.16");
  }
};

// FootprintUnit or AxisUnit -> Log2Unit. From here on only the difference along the major axis is
// kept.
struct FootprintToken {
  Ticket ticket;
  std::int32_t s, t;
  std::int64_t axis_s, axis_t;
  std::uint32_t d_max;
  bool diagonal;        // the major axis is a diagonal of the pixel; only with selects_kernel()
  std::uint64_t minor;  // d_min; from the AxisUnit: area of the footprint
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("ticket", self.ticket);
    visit("s", self.s, 32, "S7.24");
    visit("t", self.t, 32, "S7.24");
    visit("axis_s", self.axis_s, 34, "S9.24");
    visit("axis_t", self.axis_t, 34, "S9.24");
    visit("d_max", self.d_max, 32, "U16.16");
    visit("minor", self.minor, 47, "U31.16");
    visit("diagonal", self.diagonal);
  }
};

// Log2Unit -> LevelUnit.
struct Log2Token {
  Ticket ticket;
  std::int32_t s, t;
  std::int64_t axis_s, axis_t;
  std::int32_t lb_max, lb_minor;
  bool diagonal = false;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("ticket", self.ticket);
    visit("s", self.s, 32, "S7.24");
    visit("t", self.t, 32, "S7.24");
    visit("axis_s", self.axis_s, 34, "S9.24");
    visit("axis_t", self.axis_t, 34, "S9.24");
    visit("lb_max", self.lb_max, 18, "S5.12");
    visit("lb_minor", self.lb_minor, 18, "S5.12");
    visit("diagonal", self.diagonal);
  }
};

// LevelUnit -> SampleWalker.
struct LevelToken {
  Ticket ticket;
  std::int32_t s, t;
  std::int64_t axis_s, axis_t;
  std::uint8_t last_index;  // N - 1
  std::uint8_t level;       // the finer level used
  std::uint8_t fraction;    // not 0: level + 1 is used as well
  bool linear;              // filter within a level: linear or nearest
  bool diagonal = false;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("ticket", self.ticket);
    visit("s", self.s, 32, "S7.24");
    visit("t", self.t, 32, "S7.24");
    visit("axis_s", self.axis_s, 34, "S9.24");
    visit("axis_t", self.axis_t, 34, "S9.24");
    visit("last_index", self.last_index, 4);
    visit("level", self.level, 4);
    visit("fraction", self.fraction, 8, "U0.8");
    visit("linear", self.linear);
    visit("diagonal", self.diagonal);
  }
};

// In `last_index` of a request: its fragment has the weights of a tent.
inline constexpr std::uint8_t kTent = 16;

// Filter settings of a bilinear request.
struct FilterControl {
  std::uint8_t fraction_u, fraction_v;
  std::uint16_t level_weight;  // 1..256
  std::uint8_t index;          // index of the sample
  std::uint8_t last_index;     // N - 1 of the fragment; with selects_kernel() and a tent + kTent
  std::uint8_t format;         // spec::texture::Format
  bool last_of_sample;         // completes a sample (second level, or the only one); with
                               // `blend = level`: completes a level (last sample)
  bool last_of_fragment;       // completes a fragment
  // Of texels in blocks, from the TexelAddresser to the BlockDecoder, or with `decode = before` to
  // the TagStage (GroupFormer), which makes lines of decoded texels from them.
  std::uint8_t codec = 0;   // codec_of() their format; 0: not in blocks
  std::uint8_t within = 0;  // columns x0, x1 and rows y0, y1 modulo 4, of 2 bits each
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("fraction_u", self.fraction_u, 8, "U0.8");
    visit("fraction_v", self.fraction_v, 8, "U0.8");
    visit("level_weight", self.level_weight, 9, "U1.8");
    visit("index", self.index, 4);
    visit("last_index", self.last_index, 5);
    visit("format", self.format, 3);
    visit("last_of_sample", self.last_of_sample);
    visit("last_of_fragment", self.last_of_fragment);
    visit("codec", self.codec, 3);
    visit("within", self.within, 8);
  }
};

// Codes of the formats of blocks, from 1 on.
constexpr std::uint8_t codec_of(spec::texture::Format format) {
  using spec::texture::Format;
  return spec::texture::is_compressed(format)
             ? static_cast<std::uint8_t>(static_cast<int>(format) - static_cast<int>(Format::kBc1) +
                                         1)
             : std::uint8_t{0};
}
constexpr spec::texture::Format format_of(std::uint8_t codec) {
  return static_cast<spec::texture::Format>(static_cast<int>(spec::texture::Format::kBc1) + codec -
                                            1);
}
// Bytes of a block, lb.
constexpr std::uint32_t block_log2(std::uint8_t codec) {
  return spec::texture::kFormatBlockBytes[static_cast<std::size_t>(format_of(codec))] == 16 ? 4 : 3;
}
// Words of a block, or of a texel that is not in one.
constexpr std::uint32_t word_count(std::uint8_t codec) {
  return codec == 0 ? 1 : 1U << (block_log2(codec) - 2);
}

// With `decode = before` a line of the cache is a decoded block: its number, and texel i in it.
inline constexpr std::uint32_t kBlockLineBits = 29;  // of a number, below the codec
constexpr std::uint32_t block_line(const FilterControl& control, std::uint32_t address) {
  return std::uint32_t{control.codec} << kBlockLineBits | address >> block_log2(control.codec);
}
constexpr std::uint8_t byte_in_block_line(const FilterControl& control, std::size_t i) {
  const std::uint32_t x = control.within >> 2 * (i % 2) & 3,
                      y = control.within >> (4 + 2 * (i / 2)) & 3;
  return static_cast<std::uint8_t>(4 * (4 * y + x));
}

// SampleWalker -> TexelAddresser: one bilinear request.
struct SampleToken {
  Ticket ticket;
  std::int64_t s, t;
  std::uint16_t level_weight;
  std::uint8_t index, last_index;  // of N samples: i, and as in FilterControl
  std::uint8_t level;
  bool linear;
  bool last_of_sample, last_of_fragment;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("ticket", self.ticket);
    visit("s", self.s, 35, "S10.24");
    visit("t", self.t, 35, "S10.24");
    visit("level_weight", self.level_weight, 9, "U1.8");
    visit("index", self.index, 4);
    visit("last_index", self.last_index, 5);
    visit("level", self.level, 4);
    visit("linear", self.linear);
    visit("last_of_sample", self.last_of_sample);
    visit("last_of_fragment", self.last_of_fragment);
  }
};

// TexelAddresser -> TagStage.
struct TexelToken {
  Ticket ticket;
  FilterControl control;
  std::array<std::uint32_t, 4> address;  // bytes; of a texel in a block, the block
  std::array<bool, 2>
      turned;  // upper and lower row: lines stored with rotated banks (layout linear, odd rows)
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("ticket", self.ticket);
    visit("control", self.control);
    visit("address", self.address, 32);
    visit("turned", self.turned, 1);
  }
};

// TagStage -> MissQueue: lines that one request (or group) misses, in the order of their fills.
struct MissToken {
  std::array<std::uint32_t, spec::texture::kMostLookups> line;  // line numbers
  std::uint8_t count;                                           // 1..4, in a wide build 1..L
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("line", self.line, 32);
    visit("count", self.count, 4);
  }
};

// TagStage -> LatencyFifo -> DataStage.
struct CacheToken {
  Ticket ticket;
  FilterControl control;
  std::array<std::uint32_t, 4> place;   // byte in the data banks (hit) or in the line (miss)
  std::array<std::uint8_t, 4> source;   // 0: data banks; 1 + k: fill k of this request
  std::array<std::uint16_t, 4> victim;  // line slot that fill k is written to
  std::array<bool, 4> turned;           // fill k is written with rotated banks
  std::uint8_t fills;                   // number of fills, 0..4
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("ticket", self.ticket);
    visit("control", self.control);
    visit("place", self.place, 16);
    visit("source", self.source, 3);
    visit("victim", self.victim, 9);
    visit("turned", self.turned, 1);
    visit("fills", self.fills, 3);
  }
};

// DataStage -> FilterPipeline.
struct TexelQuadToken {
  Ticket ticket;
  FilterControl control;
  std::array<std::uint32_t, 4> texel;  // as stored, in the low bits
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("ticket", self.ticket);
    visit("control", self.control);
    visit("texel", self.texel, 32);
  }
};

// ---- Widths above 1: up to four tokens in one cycle (docs/reference/texture/width.md). A link is
// built for W (or F) of them: counts {"at", W}.
inline constexpr std::size_t kMostInGroup = 4;

// DerivativeUnit ... SampleWalker: the fragments of one quad that are accepted together.
template <class Token>
struct FragmentGroup {
  std::uint8_t count;  // 1..F
  std::array<Token, kMostInGroup> at;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("count", self.count, 3);
    visit("at", self.at);
  }
};

// SampleWalker -> TexelAddresser -> GroupFormer: requests of one cycle.
template <class Token>
struct RequestGroup {
  std::uint8_t count;    // 1..W
  std::uint8_t partial;  // bit i: request i ends a fragment group of fewer than F fragments
  std::array<Token, kMostInGroup> at;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("count", self.count, 3);
    visit("partial", self.partial, 4);
    visit("at", self.at);
  }
};
using SampleGroup = RequestGroup<SampleToken>;
using TexelGroup = RequestGroup<TexelToken>;

// A request of a group: the addresses of its texels are a line of the group and a byte in it.
struct GroupRequest {
  Ticket ticket;
  FilterControl control;
  std::array<std::uint8_t, 4> index;   // line of the group
  std::array<std::uint8_t, 4> offset;  // bytes
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("ticket", self.ticket);
    visit("control", self.control);
    visit("index", self.index, 3);
    visit("offset", self.offset, 7);
  }
};

// GroupFormer -> WideTagStage: a group with its distinct lines in the order of first use.
struct LineGroup {
  std::uint8_t count;  // of requests, 1..W
  std::uint8_t lines;  // 0..L
  std::array<GroupRequest, kMostInGroup> at;
  std::array<std::uint32_t, spec::texture::kMostLookups> line;  // line numbers
  std::array<bool, spec::texture::kMostLookups> turned;  // if it misses: as its first texel asks
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("count", self.count, 3);
    visit("lines", self.lines, 4);
    visit("at", self.at);
    visit("line", self.line, 32);
    visit("turned", self.turned, 1);
  }
};

// WideTagStage -> WideLatencyFifo -> WideDataStage. The lines that missed are filled in this order.
struct CacheGroup {
  std::uint8_t count;
  std::uint8_t lines;
  std::array<GroupRequest, kMostInGroup> at;
  std::array<std::uint16_t, spec::texture::kMostLookups> slot;  // of the data banks; its low bits
                                                                // are those of the line number
  std::array<bool, spec::texture::kMostLookups> missed;         // the line comes from memory
  std::array<bool, spec::texture::kMostLookups> turned;         // is (or will be) stored turned
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("count", self.count, 3);
    visit("lines", self.lines, 4);
    visit("at", self.at);
    visit("slot", self.slot, 9);
    visit("missed", self.missed, 1);
    visit("turned", self.turned, 1);
  }
};

// DataStage -> BlockDecoder, of all widths: the requests of a cycle and their distinct blocks, in
// the order of first use.
struct BlockRequest {
  Ticket ticket;
  FilterControl control;
  std::array<std::uint32_t, 4> texel;  // as stored; 0 if it is in a block
  std::array<std::uint8_t, 4> index;   // the block that it is in
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("ticket", self.ticket);
    visit("control", self.control);
    visit("texel", self.texel, 32);
    visit("index", self.index, 3);
  }
};
using Block = std::array<std::uint32_t, 4>;  // little-endian words; of 8 bytes: two, and zeros
struct BlockGroup {
  std::uint8_t count;
  std::array<BlockRequest, kMostInGroup> at;
  std::uint8_t blocks;
  std::array<Block, spec::texture::kMostDecoders> block;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("count", self.count, 3);
    visit("at", self.at);
    visit("blocks", self.blocks, 3);
    visit("block", self.block, 32);
  }
};

// Why a unit behind the GroupFormer stopped it.
enum class SlotStall : std::uint8_t {
  kNone,
  kAllocate,
  kMissQueue,
  kWaitFill,
  kWriteFill,
  kBankPass,
  kOutput
};

// DataStage -> FilterPipeline.
struct TexelQuadGroup {
  std::uint8_t count;  // 1..W
  std::array<TexelQuadToken, kMostInGroup> at;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("count", self.count, 3);
    visit("at", self.at);
  }
};

// Bits of colours_out: with width 1 those of a Colour.
inline PayloadShape colours_shape(const spec::texture::Build& p) {
  if (p.width == 1) return {.widths = {{"count", 0}}, .single = "colour"};
  const auto width = static_cast<std::uint32_t>(p.width);
  return {.widths = {{"count", static_cast<std::uint32_t>(std::bit_width(width))}},
          .counts = {{"colour", width}}};
}

// Half a tile: distance by which the words of a rotated line are moved.
inline std::uint32_t turn_bytes(std::uint32_t line_bytes) {
  return std::min(line_bytes / 2, std::uint32_t{spec::texture::kTileBytes} / 2);
}

// Fragments select their kernel, of a build with `kernel = axis`. Of two axes none is a diagonal.
inline bool selects_kernel(const spec::texture::Configuration& p) {
  return p.kernel == spec::texture::Kernel::kAxis && p.axes != spec::texture::Axes::kTwo;
}
// Of a tent of `kernel = axis`, U2.6.
constexpr std::int32_t tent_spread(std::int32_t spread) { return (181 * spread + 64) >> 7; }

// Field widths from footprint to walker. Without a rotated axis, the axis is a coordinate
// difference S8.24 and the minor side a length U16.16.
inline PayloadShape axis_shape(const spec::texture::Configuration& p) {
  PayloadShape shape;
  if (p.axes == spec::texture::Axes::kTwo) shape.widths = {{"axis_s", 33}, {"axis_t", 33}};
  if (!selects_kernel(p)) shape.widths.emplace_back("diagonal", 0);
  return shape;
}
// Bits of a sample's position. The diagonals of the largest quads reach beyond S9.24 with tents
// that are longer than 144/64.
inline std::uint32_t position_bits(const spec::texture::Configuration& p) {
  return selects_kernel(p) && tent_spread(p.spread) > 144 ? 35 : 34;
}
inline PayloadShape sample_shape(const spec::texture::Configuration& p) {
  PayloadShape shape = {.widths = {{"s", position_bits(p)}, {"t", position_bits(p)}}};
  if (!selects_kernel(p)) shape.widths.emplace_back("last_index", 4);
  return shape;
}
inline PayloadShape footprint_shape(const spec::texture::Configuration& p) {
  PayloadShape shape = axis_shape(p);
  if (p.axes == spec::texture::Axes::kTwo) shape.widths.emplace_back("minor", 32);
  return shape;
}

// Blocks decoded per cycle, of a build with decoders.
inline std::uint32_t decoders(const spec::texture::Build& p) {
  if (p.cache_decoders != 0) return static_cast<std::uint32_t>(p.cache_decoders);
  return p.width == 1 ? spec::texture::kBlocksPerRequest : spec::texture::kMostDecoders;
}
inline bool has_decoders(const spec::texture::Build& p) {
  return p.decode == spec::texture::Decode::kAfter;
}
// Lines of memory in front of the decoder, of a build with a BlockFetcher.
inline bool has_fetcher(const spec::texture::Build& p) {
  return p.decode == spec::texture::Decode::kBefore;
}
inline std::uint32_t compressed_lines(const spec::texture::Build& p) {
  return p.cache_compressed_lines != 0 ? static_cast<std::uint32_t>(p.cache_compressed_lines) : 16;
}
// Omits the fields of blocks from the control of the token `path`.
inline PayloadShape without_blocks(PayloadShape shape = {}, const std::string& path = "") {
  shape.widths.emplace_back(path + "control.codec", 0);
  shape.widths.emplace_back(path + "control.within", 0);
  return shape;
}
// Bits of the control of the token `path`.
inline PayloadShape control_shape(const spec::texture::Parameters& p, bool blocks,
                                  PayloadShape shape = {}, const std::string& path = "") {
  if (!blocks) shape = without_blocks(std::move(shape), path);
  if (!selects_kernel(p)) shape.widths.emplace_back(path + "control.last_index", 4);
  return shape;
}
inline PayloadShape texel_shape(const spec::texture::Parameters& p) {
  return control_shape(p, p.decode != spec::texture::Decode::kNone);
}
inline std::uint32_t texel_bits(const spec::texture::Parameters& p) {
  return Payload::of<TexelToken>(texel_shape(p)).bits();
}
inline PayloadShape texel_quad_shape(const spec::texture::Parameters& p = {}) {
  return control_shape(p, false);
}
// The controls of the requests of a group.
inline PayloadShape controls_shape(const spec::texture::Parameters& p, bool blocks,
                                   PayloadShape shape) {
  for (std::int32_t i = 0; i < p.width; ++i)
    shape = control_shape(p, blocks, std::move(shape), "at." + std::to_string(i) + ".");
  return shape;
}
inline PayloadShape block_shape(const spec::texture::Parameters& p) {
  if (p.width == 1)
    return control_shape(p, true,
                         {.widths = {{"count", 0}, {"index", 2}},
                          .counts = {{"block", spec::texture::kBlocksPerRequest}},
                          .single = "at"});
  return controls_shape(
      p, true, {.counts = {{"at", static_cast<std::uint32_t>(p.width)}, {"block", decoders(p)}}});
}

// Field widths of the cache's tokens.
inline std::uint32_t log2_of(std::int32_t power_of_two) {
  return static_cast<std::uint32_t>(std::countr_zero(static_cast<std::uint32_t>(power_of_two)));
}
// Bits of a line number.
inline std::uint32_t line_bits(const spec::texture::Build& p) {
  return has_fetcher(p) ? 32 : 32 - log2_of(p.cache_line_bytes);
}
inline PayloadShape miss_shape(const spec::texture::Build& p) {
  const auto lines = static_cast<std::uint32_t>(p.cache_lookups);
  return {.widths = {{"line", line_bits(p)},
                     {"count", static_cast<std::uint32_t>(std::bit_width(lines))}},
          .counts = {{"line", lines}}};
}
inline PayloadShape cache_shape(const spec::texture::Parameters& p) {
  const std::uint32_t place = log2_of(p.cache_bytes), line = log2_of(p.cache_line_bytes);
  return control_shape(p, has_decoders(p),
                       {.widths = {{"place", place}, {"victim", std::max(place - line, 1U)}}});
}
// Groups of a wide build.
inline PayloadShape requests_shape(const spec::texture::Build& p) {
  return {.counts = {{"at", static_cast<std::uint32_t>(p.width)}}};
}
inline PayloadShape group_shape(const spec::texture::Parameters& p) {
  PayloadShape shape = controls_shape(p, has_decoders(p), requests_shape(p));
  for (std::int32_t i = 0; i < p.width; ++i)
    shape.widths.emplace_back("at." + std::to_string(i) + ".offset", log2_of(p.cache_line_bytes));
  shape.counts.emplace_back("turned", p.cache_lookups);
  return shape;
}
inline PayloadShape line_group_shape(const spec::texture::Parameters& p) {
  PayloadShape shape = group_shape(p);
  shape.widths.emplace_back("line", line_bits(p));
  shape.counts.emplace_back("line", p.cache_lookups);
  return shape;
}
inline PayloadShape cache_group_shape(const spec::texture::Parameters& p) {
  PayloadShape shape = group_shape(p);
  shape.widths.emplace_back("slot",
                            std::max(log2_of(p.cache_bytes) - log2_of(p.cache_line_bytes), 1U));
  for (const char* of_a_line : {"slot", "missed"})
    shape.counts.emplace_back(of_a_line, p.cache_lookups);
  return shape;
}

}  // namespace deburr::rtl::texture
