// SPDX-License-Identifier: MIT
// Where things lie in memory, and which lines of it a frame reads and writes.
//
// Beside the arithmetic: pixels do not depend on it, but for lines that memory cannot read.
// docs/reference/geometric/memory.md, "What is in memory" and "Traffic".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "spec/geometric/packets.h"
#include "spec/geometric/parameters.h"
#include "spec/geometric/records.h"

namespace deburr::golden::geometric {

// Byte addresses of the regions, multiples of 64.
struct Bases {
  std::uint32_t edges = 0, vertices = 0, facing = 0, depth = 0, colour = 0, weights = 0, copy = 0;
  std::uint32_t pairs = 0, coarse = 0;
  // Pairs of edges that are no boundary; where the driver puts them, after those of boundaries, if
  // nothing else is said.
  std::optional<std::uint32_t> other_pairs = {};
};

// Lines that so many records fill.
constexpr std::uint32_t lines_of(std::uint32_t records, std::uint32_t in_line) {
  return records / in_line + (records % in_line != 0 ? 1 : 0);
}

// A line of memory that holds sixteen pixels of one buffer: column and row of lines.
struct LineOfPixels {
  std::uint32_t u = 0, v = 0;
  friend bool operator==(const LineOfPixels&, const LineOfPixels&) = default;
};

// Where pixels and blocks lie relative to their bases.
class FrameLayout {
 public:
  FrameLayout() = default;
  FrameLayout(spec::geometric::Layout layout, int width, int height);

  LineOfPixels line_of(int x, int y) const {
    const auto px = static_cast<std::uint32_t>(x), py = static_cast<std::uint32_t>(y);
    return tiled_ ? LineOfPixels{px >> 2, py >> 2} : LineOfPixels{px >> 4, py};
  }
  // Bytes from the buffer's base.
  std::uint32_t offset_of(const LineOfPixels& line) const;
  std::uint32_t offset_of(int x, int y) const;
  std::uint32_t bytes() const { return bytes_; }
  std::uint32_t block_offset(std::uint32_t block) const {
    return block * spec::geometric::kLineBytes;
  }

  int block_columns() const { return block_columns_; }
  int block_rows() const { return block_rows_; }

 private:
  bool tiled_ = false;
  std::uint32_t pitch_ = 0;  // raster: lines from row to row; tiled: tiles
  std::uint32_t bytes_ = 0;
  int block_columns_ = 0, block_rows_ = 0;
};

// Tags of a direct-mapped cache of lines with two coordinates. Of 2^bits lines, 2^column_bits are
// told apart by u.
class DirectMapped {
 public:
  static constexpr std::uint64_t kNothing = ~std::uint64_t{0};
  void reset(int bits, int column_bits);
  // True if (u, v) is there. Else it takes its place, and `replaced` is what was there before.
  bool look_up(std::uint32_t u, std::uint32_t v, std::uint64_t& replaced) {
    std::uint64_t& tag = tags_[index(u, v)];
    const std::uint64_t wanted = tag_of(u, v);
    if (tag == wanted) return true;
    replaced = tag;
    tag = wanted;
    return false;
  }
  bool holds(std::uint32_t u, std::uint32_t v) const { return tags_[index(u, v)] == tag_of(u, v); }
  static constexpr std::uint64_t tag_of(std::uint32_t u, std::uint32_t v) {
    return std::uint64_t{v} << 32 | u;
  }
  static constexpr std::uint32_t u_of(std::uint64_t tag) { return static_cast<std::uint32_t>(tag); }
  static constexpr std::uint32_t v_of(std::uint64_t tag) {
    return static_cast<std::uint32_t>(tag >> 32);
  }

 private:
  std::size_t index(std::uint32_t u, std::uint32_t v) const {
    return (u & column_mask_) + (std::size_t{v & row_mask_} << column_bits_);
  }
  std::vector<std::uint64_t> tags_;
  std::uint32_t column_mask_ = 0, row_mask_ = 0;
  int column_bits_ = 0;
};
// Bits of the line's column in the index of a cache of 2^bits lines.
int depth_column_bits(spec::geometric::Layout layout, int bits);
int block_column_bits(int bits);

// Lines of a buffer of which those that were read last are kept.
class KeptLines {
 public:
  void reset(std::size_t lines, int kept) {
    read_.assign(lines, 0);
    reads_ = 0;
    kept_ = static_cast<std::uint32_t>(kept);
  }
  // True if a line is kept, else it is read.
  bool look_up(std::size_t line) {
    std::uint32_t& read = read_[line];
    if (read != 0 && reads_ - read < kept_) return true;
    read = ++reads_;
    return false;
  }
  // The next line that is read takes the place of another.
  bool is_full() const { return reads_ >= kept_; }

 private:
  std::vector<std::uint32_t> read_;  // by line: how many lines were read with it; 0: none
  std::uint32_t reads_ = 0, kept_ = 0;
};

// Blocks that were replaced in their cache and are not yet in memory, by DirectMapped's tags.
class WriteBuffer {
 public:
  static constexpr std::uint64_t kNothing = DirectMapped::kNothing;
  void reset(int places) {
    blocks_.assign(static_cast<std::size_t>(places), kNothing);
    next_ = 0;
  }
  bool empty() const { return blocks_.empty(); }
  // Takes `wanted` out and puts `replaced` in its place. False if `wanted` is not there.
  bool exchange(std::uint64_t wanted, std::uint64_t replaced);
  // Puts `replaced` in; what leaves for it, if anything. Without places that is `replaced`.
  std::uint64_t push(std::uint64_t replaced);
  // What is left, in the order in which it leaves.
  std::vector<std::uint64_t> remaining() const;

 private:
  std::vector<std::uint64_t> blocks_;
  std::size_t next_ = 0;
};

// Addresses by region, reads and writes apart, each in order.
struct Traffic {
  using List = std::vector<std::uint32_t>;
  std::array<List, spec::geometric::kRegionNames.size()> reads, writes;
  List& read(spec::geometric::Region region) { return reads[static_cast<std::size_t>(region)]; }
  List& write(spec::geometric::Region region) { return writes[static_cast<std::size_t>(region)]; }
  const List& read(spec::geometric::Region region) const {
    return reads[static_cast<std::size_t>(region)];
  }
  const List& write(spec::geometric::Region region) const {
    return writes[static_cast<std::size_t>(region)];
  }
  void clear();
  // Lines 0..count-1 from `base`.
  static void append_lines(List& list, std::uint32_t base, std::uint32_t count);
};

}  // namespace deburr::golden::geometric
