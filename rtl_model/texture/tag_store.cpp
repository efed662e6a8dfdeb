// SPDX-License-Identifier: MIT
#include "rtl_model/texture/tag_store.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "rtl_model/texture/tokens.h"

namespace deburr::rtl::texture {
namespace {

std::uint32_t sets_log2(const spec::texture::Parameters& p) {
  return log2_of(p.cache_bytes) - log2_of(p.cache_line_bytes) - log2_of(p.cache_ways);
}
// Tag, valid bit and rotation bit per way; one bit per pair of ways.
std::uint32_t set_bits(const spec::texture::Parameters& p) {
  const auto ways = static_cast<std::uint32_t>(p.cache_ways);
  const std::uint32_t tag = line_bits(p) - sets_log2(p);
  const bool ordered = p.cache_replacement != spec::texture::Replacement::kRandom;
  return ways * (tag + 2) + (ordered ? ways * (ways - 1) / 2 : 0);
}

// Claims `built` ports.
template <class Port, std::size_t... i>
std::array<Port, sizeof...(i)> ports_of(Memory<void>& memory, std::int32_t built,
                                        std::index_sequence<i...> /*all*/) {
  std::vector<Port> claimed;
  claimed.reserve(static_cast<std::size_t>(built));
  for (std::int32_t port = 0; port < built; ++port)
    claimed.emplace_back(memory, "line_" + std::to_string(port));
  return {claimed[std::min(i, claimed.size() - 1)]...};
}

}  // namespace

TagStore::TagStore(const char* name, const spec::texture::Parameters& p)
    : replacement_(p.cache_replacement),
      set_mask_((1u << sets_log2(p)) - 1),
      way_mask_(static_cast<std::uint32_t>(p.cache_ways) - 1),
      ways_log2_(log2_of(p.cache_ways)),
      memory_(name, {.words = std::uint64_t{1} << sets_log2(p),
                     .word_bits = set_bits(p),
                     .kind = MemoryKind::kFlops,
                     .read_ports = static_cast<std::uint32_t>(p.cache_lookups),
                     .write_ports = static_cast<std::uint32_t>(p.cache_lookups),
                     .latency = 1,
                     // A request sees its sets as the previous request leaves them.
                     .read_during_write = ReadDuringWrite::kNewWord,
                     .content = "tags, and the order of use of each set's ways"}),
      reads_(ports_of<ReadPort<void>>(memory_, p.cache_lookups,
                                      std::make_index_sequence<kMostPorts>())),
      writes_(ports_of<WritePort<void>>(memory_, p.cache_lookups,
                                        std::make_index_sequence<kMostPorts>())),
      tags_(std::size_t{1} << (sets_log2(p) + ways_log2_)),
      turned_(tags_.size()),
      age_(tags_.size()) {
  reset();
}

// A set is written once, whatever its lookups changed.
void TagStore::change(std::uint32_t set) {
  for (std::size_t i = 0; i < changes_; ++i)
    if (changed_[i] == set) return;
  changed_[changes_++] = set;
}

void TagStore::make_youngest(std::uint32_t slot) {
  std::uint8_t* const ages = &age_[slot & ~way_mask_];
  const std::uint8_t limit = age_[slot];
  for (std::uint32_t way = 0; way <= way_mask_; ++way)
    if (ages[way] < limit) ++ages[way];
  age_[slot] = 0;
  change(slot >> ways_log2_);
}

// Called only when all ways are valid.
std::uint32_t TagStore::victim(std::uint32_t first) {
  if (replacement_ == spec::texture::Replacement::kRandom) {
    const std::uint32_t r = random_;
    random_ = static_cast<std::uint16_t>(r >> 1 | (r ^ r >> 2 ^ r >> 3 ^ r >> 5) << 15);
    return first + (random_ & way_mask_);
  }
  std::uint32_t slot = first;
  while (age_[slot] != way_mask_) ++slot;
  return slot;
}

TagStore::Place TagStore::allocate(std::uint32_t line, bool turned) {
  const std::uint32_t first = (line & set_mask_) << ways_log2_;
  std::uint32_t slot = first;
  while (slot <= first + way_mask_ && tags_[slot] != kInvalid) ++slot;
  const bool evicted = slot > first + way_mask_;
  if (evicted) slot = victim(first);
  tags_[slot] = line;
  turned_[slot] = turned ? 1 : 0;
  make_youngest(slot);  // for `fifo`, hits do not change the age, so it counts from the fill
  return {slot, evicted};
}

void TagStore::invalidate() { std::fill(tags_.begin(), tags_.end(), kInvalid); }

void TagStore::reset() {
  invalidate();
  changes_ = 0;
  random_ = kRandomStart;
  for (std::uint32_t slot = 0; slot < age_.size(); ++slot)
    age_[slot] = static_cast<std::uint8_t>(slot & way_mask_);
}

}  // namespace deburr::rtl::texture
