// SPDX-License-Identifier: MIT
#include "golden/geometric/traffic.h"

#include <algorithm>
#include <utility>

namespace deburr::golden::geometric {

using spec::geometric::Layout;

FrameLayout::FrameLayout(Layout layout, int width, int height)
    : tiled_(layout == Layout::kTiled),
      block_columns_((width + 3) / 4),
      block_rows_((height + 3) / 4) {
  const auto w = static_cast<std::uint32_t>(width), h = static_cast<std::uint32_t>(height);
  pitch_ = tiled_ ? (w + 7) / 8 : (w + 15) / 16;
  bytes_ = tiled_ ? 256 * pitch_ * ((h + 7) / 8) : 64 * pitch_ * h;
}

std::uint32_t FrameLayout::offset_of(const LineOfPixels& line) const {
  if (!tiled_) return 64 * (line.v * pitch_ + line.u);
  return 256 * ((line.v >> 1) * pitch_ + (line.u >> 1)) + 64 * (2 * (line.v & 1) + (line.u & 1));
}

std::uint32_t FrameLayout::offset_of(int x, int y) const {
  const auto px = static_cast<std::uint32_t>(x), py = static_cast<std::uint32_t>(y);
  return offset_of(line_of(x, y)) + 4 * (tiled_ ? 4 * (py & 3) + (px & 3) : px & 15);
}

void DirectMapped::reset(int bits, int column_bits) {
  tags_.assign(std::size_t{1} << bits, kNothing);
  column_bits_ = column_bits;
  column_mask_ = (1u << column_bits) - 1;
  row_mask_ = (1u << (bits - column_bits)) - 1;
}

int block_column_bits(int bits) { return (bits + 1) / 2; }
int depth_column_bits(Layout layout, int bits) {
  return layout == Layout::kTiled ? block_column_bits(bits)
                                  : std::max(1, block_column_bits(bits) - 2);
}

bool WriteBuffer::exchange(std::uint64_t wanted, std::uint64_t replaced) {
  const auto place = std::find(blocks_.begin(), blocks_.end(), wanted);
  if (place == blocks_.end()) return false;
  *place = replaced;
  return true;
}

std::uint64_t WriteBuffer::push(std::uint64_t replaced) {
  if (blocks_.empty()) return replaced;
  std::swap(blocks_[next_], replaced);
  next_ = (next_ + 1) % blocks_.size();
  return replaced;
}

std::vector<std::uint64_t> WriteBuffer::remaining() const {
  std::vector<std::uint64_t> left;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const std::uint64_t block = blocks_[(next_ + i) % blocks_.size()];
    if (block != kNothing) left.push_back(block);
  }
  return left;
}

void Traffic::clear() {
  for (List& list : reads) list.clear();
  for (List& list : writes) list.clear();
}

void Traffic::append_lines(List& list, std::uint32_t base, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) {
    list.push_back(base + i * spec::geometric::kLineBytes);
  }
}

}  // namespace deburr::golden::geometric
