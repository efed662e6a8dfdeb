// SPDX-License-Identifier: MIT
#include "golden/texture/cache_predictor.h"

#include <algorithm>
#include <bit>

#include "spec/texture/check_build.h"

namespace deburr::golden::texture {
namespace {

constexpr std::uint32_t kShiftRegisterStart = 0xACE1;
constexpr std::size_t kDefaultCompressedLines = 16;

}  // namespace

CachePredictor::CachePredictor(const spec::texture::Parameters& parameters)
    : replacement_(spec::texture::check_build(parameters).cache_replacement),
      ways_(static_cast<std::uint32_t>(parameters.cache_ways)) {
  const auto bytes = static_cast<std::uint32_t>(parameters.cache_bytes);
  const auto line = static_cast<std::uint32_t>(parameters.cache_line_bytes);
  line_shift_ = std::countr_zero(line);
  set_mask_ = bytes / (line * ways_) - 1;
  tags_.resize(bytes / line);
  if (parameters.decode == spec::texture::Decode::kBefore) {
    const auto lines = static_cast<std::size_t>(parameters.cache_compressed_lines);
    compressed_.resize(lines == 0 ? kDefaultCompressedLines : lines);
  }
  reset();
}

void CachePredictor::invalidate() {
  std::fill(tags_.begin(), tags_.end(), Way{});
  any_ = false;
  std::fill(compressed_.begin(), compressed_.end(), std::nullopt);
  next_compressed_ = 0;
}

void CachePredictor::reset() {
  invalidate();
  time_ = 0;
  shift_register_ = kShiftRegisterStart;
}

CachePredictor::Fetch CachePredictor::fetch(std::uint32_t line) {
  const std::uint32_t codec = line >> kCodecShift;
  if (codec == 0) return {.memory_line = line};
  const auto format = static_cast<std::size_t>(spec::texture::Format::kBc1) + codec - 1;
  const std::uint32_t bytes = spec::texture::kFormatBlockBytes[format];
  Fetch fetch{.memory_line = memory_line(line * bytes), .decoded = true};  // drops the codec
  const auto found = std::find(compressed_.begin(), compressed_.end(), fetch.memory_line);
  fetch.requested = found == compressed_.end();
  if (fetch.requested) {
    fetch.slot = static_cast<std::uint32_t>(next_compressed_);
    compressed_[next_compressed_] = fetch.memory_line;
    next_compressed_ = (next_compressed_ + 1) % compressed_.size();
  } else {
    fetch.slot = static_cast<std::uint32_t>(found - compressed_.begin());
  }
  return fetch;
}

bool CachePredictor::present(std::uint32_t line) const {
  const auto set = std::span(tags_).subspan(std::size_t{line & set_mask_} * ways_, ways_);
  return std::any_of(set.begin(), set.end(),
                     [&](const Way& way) { return way.valid && way.line == line; });
}

bool CachePredictor::lookup_in_set(std::uint32_t line) {
  const auto set = std::span(tags_).subspan(std::size_t{line & set_mask_} * ways_, ways_);
  ++time_;
  for (Way& way : set) {
    if (way.valid && way.line == line) {
      if (replacement_ == spec::texture::Replacement::kLru) way.time = time_;
      return true;
    }
  }
  set[victim(set)] = {line, true, time_};
  return false;
}

std::uint32_t CachePredictor::victim(std::span<const Way> set) {
  for (std::uint32_t way = 0; way < ways_; ++way) {
    if (!set[way].valid) return way;
  }
  if (replacement_ == spec::texture::Replacement::kRandom) {
    const std::uint32_t r = shift_register_;
    const std::uint32_t in = (r ^ (r >> 2) ^ (r >> 3) ^ (r >> 5)) & 1;
    shift_register_ = r >> 1 | in << 15;
    return shift_register_ % ways_;
  }
  const auto oldest = std::min_element(set.begin(), set.end(),
                                       [](const Way& a, const Way& b) { return a.time < b.time; });
  return static_cast<std::uint32_t>(oldest - set.begin());
}

}  // namespace deburr::golden::texture
