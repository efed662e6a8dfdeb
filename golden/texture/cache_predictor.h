// SPDX-License-Identifier: MIT
// Predicts which cache lines a sequence of bilinear requests fetches, and in which order; with
// decode = before, also which lines of memory.
//
// Stores tags only: memory traffic depends on the cache, colours do not.
// docs/reference/texture/formats.md, "Cache and traffic"; compressed.md, "Before the cache".
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "spec/texture/descriptor.h"
#include "spec/texture/parameters.h"

namespace deburr::golden::texture {

class CachePredictor {
 public:
  // Throws ConfigError if the cache cannot be built (spec/texture/check_build.h).
  explicit CachePredictor(const spec::texture::Parameters& parameters);

  // Looks up a line and allocates it on a miss. Returns true on a hit; false: one fill of the line.
  bool lookup(std::uint32_t line) {
    // The previous line is present and the most recent one of its set: nothing would change.
    if (any_ && line == last_) return true;
    any_ = true;
    last_ = line;
    return lookup_in_set(line);
  }

  // Looks up the lines of a bilinear request, given in the order of its texels 00, 10, 01, 11: each
  // distinct line once, in the order of first use. Calls fill(line) for each miss.
  template <class Fill>
  void request(const std::array<std::uint32_t, 4>& lines, Fill&& fill) {
    if (lines[1] == lines[0] && lines[2] == lines[0] && lines[3] == lines[0]) {  // the common case
      if (!lookup(lines[0])) fill(lines[0]);
      return;
    }
    for (int i = 0; i < 4; ++i) {
      bool repeated = false;
      for (int j = 0; j < i; ++j) repeated = repeated || lines[j] == lines[i];
      if (!repeated && !lookup(lines[i])) fill(lines[i]);
    }
  }

  // The access to memory of a fill.
  struct Fetch {
    std::uint32_t memory_line = 0;
    bool requested = true;   // false: the memory line is among the compressed lines
    bool decoded = false;    // the line is a decoded block, which needs:
    std::uint32_t slot = 0;  // entry of its memory line among the compressed lines
  };
  // To be called for each fill, in order.
  Fetch fetch(std::uint32_t line);

  bool present(std::uint32_t line) const;
  void invalidate();  // clears all lines, but not the random sequence
  void reset();       // as after construction
  // Line of the texel at `address`, or of the block.
  std::uint32_t line_of(spec::texture::Format format, std::uint32_t address) const {
    if (compressed_.empty() || !spec::texture::is_compressed(format)) return memory_line(address);
    return codec_of(format) << kCodecShift |
           address / spec::texture::kFormatBlockBytes[static_cast<std::size_t>(format)];
  }
  bool decodes_before() const { return !compressed_.empty(); }
  std::uint32_t memory_line(std::uint32_t address) const { return address >> line_shift_; }
  std::uint32_t line_bytes() const { return 1u << line_shift_; }
  std::uint32_t sets() const { return set_mask_ + 1; }
  std::uint32_t ways() const { return ways_; }

 private:
  struct Way {
    std::uint32_t line = 0;
    bool valid = false;
    std::uint64_t time = 0;  // last use (lru) or fill (fifo, random)
  };
  // Line numbers of decoded blocks: codec << 29 | number of the block. Codec 0: not decoded.
  static constexpr int kCodecShift = 29;
  static std::uint32_t codec_of(spec::texture::Format format) {
    return static_cast<std::uint32_t>(format) -
           static_cast<std::uint32_t>(spec::texture::Format::kBc1) + 1;
  }
  bool lookup_in_set(std::uint32_t line);
  std::uint32_t victim(std::span<const Way> set);

  spec::texture::Replacement replacement_;
  std::uint32_t ways_;
  int line_shift_ = 0;
  std::uint32_t set_mask_ = 0;
  std::vector<Way> tags_;  // set by set
  std::uint64_t time_ = 0;
  std::uint32_t shift_register_ = 0;  // 16 bits
  bool any_ = false;
  std::uint32_t last_ = 0;
  // Lines of memory in front of the decoder; empty unless decode = before.
  std::vector<std::optional<std::uint32_t>> compressed_;
  std::size_t next_compressed_ = 0;  // the one allocated first
};

}  // namespace deburr::golden::texture
