// SPDX-License-Identifier: MIT
// Memory layout, and the lines that a frame reads and writes.
//
// Pixels do not depend on it, except where memory responds with errors.
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
  // Pairs of edges that are not boundaries. Without a value: after the pairs of the boundaries,
  // where the driver puts them.
  std::optional<std::uint32_t> other_pairs = {};
};

// Number of lines that hold this number of records.
constexpr std::uint32_t lines_of(std::uint32_t records, std::uint32_t in_line) {
  return records / in_line + (records % in_line != 0 ? 1 : 0);
}

// A memory line with sixteen pixels of a buffer, by column and row of lines.
struct LineOfPixels {
  std::uint32_t u = 0, v = 0;
  friend bool operator==(const LineOfPixels&, const LineOfPixels&) = default;
};

// Offsets of pixels and blocks from their base addresses.
class FrameLayout {
 public:
  FrameLayout() = default;
  FrameLayout(spec::geometric::Layout layout, int width, int height);

  LineOfPixels line_of(int x, int y) const {
    const auto px = static_cast<std::uint32_t>(x), py = static_cast<std::uint32_t>(y);
    return tiled_ ? LineOfPixels{px >> 2, py >> 2} : LineOfPixels{px >> 4, py};
  }
  // Offset in bytes from the base of the buffer.
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
  std::uint32_t pitch_ = 0;  // raster: lines per row; tiled: tiles per row
  std::uint32_t bytes_ = 0;
  int block_columns_ = 0, block_rows_ = 0;
};

// Tags of a direct-mapped cache whose lines have two coordinates: 2^bits lines, of whose index
// 2^column_bits values come from u.
class DirectMapped {
 public:
  static constexpr std::uint64_t kNothing = ~std::uint64_t{0};
  void reset(int bits, int column_bits);
  // Returns true on a hit. A miss allocates (u, v); `replaced` is the previous tag.
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
// Index bits that come from the column, for a cache of 2^bits lines.
int depth_column_bits(spec::geometric::Layout layout, int bits);
int block_column_bits(int bits);

// FIFO of the lines that were read last.
class KeptLines {
 public:
  void reset(std::size_t lines, int kept) {
    read_.assign(lines, 0);
    reads_ = 0;
    kept_ = static_cast<std::uint32_t>(kept);
  }
  // Returns true if the line is held; otherwise it is read.
  bool look_up(std::size_t line) {
    std::uint32_t& read = read_[line];
    if (read != 0 && reads_ - read < kept_) return true;
    read = ++reads_;
    return false;
  }
  // Whether the next read replaces a line.
  bool is_full() const { return reads_ >= kept_; }

 private:
  std::vector<std::uint32_t> read_;  // by line: count of reads at its last read; 0: never read
  std::uint32_t reads_ = 0, kept_ = 0;
};

// Evicted blocks that are not yet written to memory, by the tags of DirectMapped.
class WriteBuffer {
 public:
  static constexpr std::uint64_t kNothing = DirectMapped::kNothing;
  void reset(int places) {
    blocks_.assign(static_cast<std::size_t>(places), kNothing);
    next_ = 0;
  }
  bool empty() const { return blocks_.empty(); }
  // Removes `wanted` and stores `replaced` in its entry. Returns false if `wanted` is not present.
  bool exchange(std::uint64_t wanted, std::uint64_t replaced);
  // Stores `replaced`; returns the block that is evicted for it, or kNothing. Without entries:
  // `replaced`.
  std::uint64_t push(std::uint64_t replaced);
  // The remaining blocks in the order of their eviction.
  std::vector<std::uint64_t> remaining() const;

 private:
  std::vector<std::uint64_t> blocks_;
  std::size_t next_ = 0;
};

// Line addresses by region, reads and writes separately, each in order.
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
  // Appends lines 0..count-1 from `base`.
  static void append_lines(List& list, std::uint32_t base, std::uint32_t count);
};

}  // namespace deburr::golden::geometric
