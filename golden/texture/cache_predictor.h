// SPDX-License-Identifier: MIT
// Predicts which cache lines a sequence of bilinear requests fetches, and in which order.
//
// Stores tags only: memory traffic depends on the cache, colours do not.
// docs/reference/texture/formats.md, "Cache and traffic".
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

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

  bool present(std::uint32_t line) const;
  void invalidate();  // clears all lines, but not the random sequence
  void reset();       // as after construction
  std::uint32_t line_of(std::uint32_t address) const { return address >> line_shift_; }
  std::uint32_t line_bytes() const { return 1u << line_shift_; }
  std::uint32_t sets() const { return set_mask_ + 1; }
  std::uint32_t ways() const { return ways_; }

 private:
  struct Way {
    std::uint32_t line = 0;
    bool valid = false;
    std::uint64_t time = 0;  // last use (lru) or fill (fifo, random)
  };
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
};

}  // namespace deburr::golden::texture
