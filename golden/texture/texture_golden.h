// SPDX-License-Identifier: MIT
// Bit-exact reference of the texture unit: quads in, colours and predicted memory traffic out.
//
// No time, no SystemC, integers only (docs/reference/texture/index.md,
// docs/reference/texture/formats.md; paper 004). Its blocks are pure functions in footprint.h,
// level_of_detail.h, sampling.h and filter.h; TextureGolden runs them over quads, with address
// tables for speed.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "golden/texture/cache_predictor.h"
#include "golden/texture/filter.h"
#include "golden/texture/footprint.h"
#include "golden/texture/level_of_detail.h"
#include "golden/texture/sampling.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/packets.h"
#include "spec/texture/parameters.h"

namespace deburr::golden::texture {

// All decisions about a fragment before its first texel is read.
struct FragmentAnalysis {
  bool valid = false;      // the descriptor is valid; otherwise the members below are unused
  bool saturated = false;  // a derivative is beyond U15.16 texels
  Step d_x, d_y;           // row and column difference of the coordinates, S8.24
  Step p_x, p_y;           // the same in texels of level 0, S15.16
  Footprint footprint;
  Step axis;  // major axis in coordinates, S9.24
  LevelOfDetail lod;
};

// Work so far, named like the status registers. line_fills, memory_lines and memory_errors stay 0
// with Traffic::kIgnore.
struct TextureWork {
  std::uint64_t fragments = 0;          // colours delivered
  std::uint64_t invalid_fragments = 0;  // those with an invalid descriptor, colour zero
  std::uint64_t clamped = 0;            // fragments with Quad::clamped set
  std::uint64_t saturated = 0;          // fragments with a saturated derivative
  std::uint64_t magnified = 0;          // fragments with l <= 0
  std::uint64_t samples = 0;            // sum of N
  std::uint64_t bilinears = 0;          // requests to the cache: samples x (1 or 2)
  std::uint64_t line_fills = 0;
  std::uint64_t memory_lines = 0;   // requested from memory; line_fills unless decode = before
  std::uint64_t memory_errors = 0;  // those with an error response
  std::array<std::uint64_t, 17> by_samples{};                       // valid fragments with N = i
  std::array<std::uint64_t, spec::texture::kMaxLevels> by_level{};  // bilinear requests to level i
  friend bool operator==(const TextureWork&, const TextureWork&) = default;
};

// The colours of a quad, covered lanes in ascending order.
struct QuadColours {
  std::array<spec::texture::Colour, 4> colours{};
  int count = 0;
  const spec::texture::Colour* begin() const { return colours.data(); }
  const spec::texture::Colour* end() const { return colours.data() + count; }
};

// A request of a sample to the cache, for inspection of a pixel.
struct BilinearRequest {
  int sample = 0, level = 0;
  std::int64_t s = 0, t = 0;  // of the sample, before wrapping, S9.24
  // Byte addresses of texels 00, 10, 01, 11, or of their blocks.
  std::array<std::uint32_t, 4> addresses{};
  std::vector<std::uint32_t> misses;  // line numbers that it fills, in order
};

// A request to the cache, for the CyclePredictor.
struct CacheRequest {
  // Byte addresses of texels 00, 10, 01, 11, or of their blocks.
  std::array<std::uint32_t, 4> addresses{};
  // Texels 00, 10 and 01, 11: odd row, of texels or of blocks, of the layout `linear`.
  std::array<bool, 2> turned{};
  std::array<std::uint8_t, 4> inside{};  // positions of the texels in their blocks, 4 y + x
  bool valid = true;                     // false: the descriptor is invalid, and no texel is read
  bool last = false;                     // of its fragment
  spec::texture::Format format = spec::texture::Format::kRgba8;
};

class TextureGolden {
 public:
  enum class Traffic { kPredict, kIgnore };  // kIgnore: no fills and no memory errors; faster

  // `memory` is not copied: it must outlive this object, and may only change between quads where no
  // predicted line is present. Throws ConfigError if the unit cannot be built.
  TextureGolden(const spec::texture::Parameters& parameters, std::span<const std::uint8_t> memory,
                Traffic traffic = Traffic::kPredict);

  // handle: 0..15, otherwise ConfigError. An invalid descriptor is accepted; its fragments become
  // zero.
  void set_texture(int handle, const spec::texture::Descriptor& descriptor);
  const spec::texture::Descriptor& texture(int handle) const;

  // Filters the covered lanes of a quad.
  QuadColours process(const spec::texture::Quad& quad);
  template <class Sink>
  void process(const spec::texture::Quad& quad, Sink&& sink) {
    for (const spec::texture::Colour& colour : process(quad)) sink(colour);
  }

  // Also appends the requests of `lane` to `requests`.
  QuadColours process(const spec::texture::Quad& quad, int lane,
                      std::vector<BilinearRequest>& requests);

  // Also appends the requests of all covered lanes.
  QuadColours process(const spec::texture::Quad& quad, std::vector<CacheRequest>& requests);

  // The decisions of process() for a lane, covered or not; changes nothing.
  FragmentAnalysis analyse(const spec::texture::Quad& quad, int lane) const;

  const TextureWork& work() const { return work_; }
  void clear_work() { work_ = {}; }  // counters, as by the clear bit of CONTROL

  // Called with the line number of each fill, in order. Without a sink, fills are only counted.
  using LineSink = std::function<void(std::uint32_t line)>;
  void set_fill_sink(LineSink sink) { fill_sink_ = std::move(sink); }
  // Called with each line that is requested from memory (address / line bytes), in order. These are
  // the fills, unless decode = before.
  void set_memory_line_sink(LineSink sink) { memory_line_sink_ = std::move(sink); }
  // Stores both in fills() and memory_lines(): 4 bytes per fill, up to 8 with decode = before.
  void record_fills(bool on) { record_fills_ = on; }
  const std::vector<std::uint32_t>& fills() const { return fills_; }
  const std::vector<std::uint32_t>& memory_lines() const {
    return cache_.decodes_before() ? memory_lines_ : fills_;
  }
  void clear_fills() {
    fills_.clear();
    memory_lines_.clear();
  }

  // Memory lines with an error response: their bytes read as zero, and each response is counted.
  // Lines that extend past the end of `memory` always have one.
  using LinePredicate = std::function<bool(std::uint32_t line)>;
  void set_error_lines(LinePredicate error);
  // As byte ranges [first, last).
  void set_error_ranges(std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges);

  void invalidate_cache() { cache_.invalidate(); }  // the invalidate bit of CONTROL
  void reset();  // clears cache, counters and fills; keeps textures
  const CachePredictor& cache() const { return cache_; }
  const spec::texture::Parameters& parameters() const { return parameters_; }

 private:
  struct LevelTable : LevelAddresses {
    std::int32_t width = 0, height = 0;
    bool plain = false;  // completely in memory; none of its lines has errors
  };
  // Differences that the lanes of a quad have in common: one per row and one per column.
  struct Difference {
    Step d, p;
    bool saturated = false;
  };
  struct Differences {
    std::array<Difference, 2> rows, columns;
  };
  struct Texture {
    spec::texture::Descriptor descriptor;
    bool valid = false;
    bool blocks = false;  // valid, and its format is compressed
    std::vector<LevelTable> levels;
  };
  static Differences differences(const Texture& texture, const spec::texture::Quad& quad);
  FragmentAnalysis analyse(const Texture& texture, const Differences& differences, int lane) const;
  // A Tap observes lanes, samples, requests, fills and invalid fragments. NoTap is empty and costs
  // nothing; it does not decode blocks.
  struct NoTap;
  struct RequestTap;
  template <class Tap>
  QuadColours process_seen(const spec::texture::Quad& quad, Tap& tap);
  template <class Tap>
  std::array<std::uint8_t, 4> filter_fragment(const Texture& texture,
                                              const FragmentAnalysis& fragment, std::int32_t s,
                                              std::int32_t t, Tap& tap);
  // Returns U8.12. s and t are wrapped.
  template <class Tap>
  Channels bilinear(const Texture& texture, int level, bool linear, std::int64_t s, std::int64_t t,
                    Tap& tap);
  std::array<Channels, 4> read(const LevelTable& table, spec::texture::Format format,
                               const std::array<std::uint32_t, 4>& addresses) const;
  // inside: positions of the texels in their blocks, 4 y + x.
  std::array<Channels, 4> read_blocks(const LevelTable& table,
                                      const spec::texture::Descriptor& descriptor,
                                      const std::array<std::uint32_t, 4>& addresses,
                                      const std::array<std::uint8_t, 4>& inside) const;
  // Looks up the lines of a request.
  template <class Tap>
  void predict(spec::texture::Format format, const std::array<std::uint32_t, 4>& addresses,
               Tap& tap);
  void fill(std::uint32_t line);
  bool fails(std::uint32_t memory_line) const;
  void find_plain_levels(Texture& texture) const;

  spec::texture::Parameters parameters_;
  std::span<const std::uint8_t> memory_;
  bool predict_;
  CachePredictor cache_;
  std::array<Texture, spec::texture::kMaxTextures> textures_;
  TextureWork work_;
  LineSink fill_sink_, memory_line_sink_;
  bool record_fills_ = false;
  std::vector<std::uint32_t> fills_;
  std::vector<std::uint32_t> memory_lines_;  // only with decode = before
  LinePredicate error_;
};

}  // namespace deburr::golden::texture
