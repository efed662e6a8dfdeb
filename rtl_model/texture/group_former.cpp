// SPDX-License-Identifier: MIT
#include "rtl_model/texture/group_former.h"

#include <algorithm>

namespace deburr::rtl::texture {

GroupFormer::GroupFormer(const sc_core::sc_module_name& name, ClockDomain& clock,
                         const spec::texture::Parameters& p)
    : Unit(name, clock),
      width_(static_cast<std::uint32_t>(p.width)),
      lookups_(static_cast<std::uint32_t>(p.cache_lookups)),
      reads_(static_cast<std::uint32_t>(p.cache_bank_reads)),
      ways_(static_cast<std::uint32_t>(p.cache_ways)),
      line_log2_(log2_of(p.cache_line_bytes)),
      turn_(turn_bytes(static_cast<std::uint32_t>(p.cache_line_bytes))),
      set_mask_(static_cast<std::uint32_t>(p.cache_bytes / p.cache_line_bytes / p.cache_ways) - 1),
      bank_mask_(static_cast<std::uint32_t>(p.cache_line_banks * p.cache_line_bytes / 4) - 1),
      memory_("requests_waiting", {.words = 2 * static_cast<std::uint64_t>(p.width),
                                   .word_bits = kPayloadBits<TexelToken> + 1,
                                   .kind = MemoryKind::kFlops,
                                   .read_ports = width_,
                                   .write_ports = width_,
                                   .latency = 0,
                                   .content = "requests that wait for a group"}),
      buffer_(2 * width_),
      banks_(bank_mask_ + 1) {
  for (std::uint32_t i = 0; i < width_; ++i) {
    oldest_.emplace_back(memory_, "oldest_" + std::to_string(i));
    new_.emplace_back(memory_, "new_" + std::to_string(i));
  }
}

Activity GroupFormer::tick(Cycle cycle) {
  const std::uint32_t buffered = buffered_;
  const std::uint32_t emitted = buffered != 0 && groups_out.can_push(cycle) ? emit(cycle) : 0;
  count(emitted, buffered, cycle);
  const bool takes =
      texels_in.can_pop(cycle) && buffered_ + texels_in.front(cycle).count <= 2 * width_;
  if (takes) take(cycle);
  if (buffered != 0 && emitted == 0) return kStalledDownstream;
  return emitted != 0 || takes ? kBusy : kIdle;
}

// Adds the lines and words of a request to those of the group.
inline void GroupFormer::add(const Waiting& request, Lines& lines,
                             std::array<std::uint8_t, 4>& index, Exceeded& exceeded) {
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t line = request.line[i];
    std::uint32_t at = 0;
    while (at < lines.count && lines.line[at] != line) ++at;
    index[i] = static_cast<std::uint8_t>(at);
    if (at == lines.count) {
      std::uint32_t in_set = 0;
      for (std::uint32_t k = 0; k < at; ++k) in_set += ((lines.line[k] ^ line) & set_mask_) == 0;
      exceeded.set |= in_set == ways_;
      lines.line[at] = line;
      lines.turned[at] = request.turned[i >> 1];
      exceeded.lookups |= ++lines.count > lookups_;
    }
    const std::uint32_t word = request.word[i];
    Bank& bank = banks_[request.bank[i]];
    if (bank.group != group_) {
      bank.group = group_;
      bank.words = 0;
    }
    const auto end = bank.word.begin() + bank.words;
    if (std::find(bank.word.begin(), end, word) != end) continue;
    if (bank.words == reads_)
      exceeded.banks = true;
    else
      bank.word[bank.words++] = word;
  }
}

// Returns the number of requests.
std::uint32_t GroupFormer::emit(Cycle cycle) {
  LineGroup& group = groups_out.emplace(cycle);
  ++group_;
  Lines lines;
  Exceeded exceeded;
  const std::uint32_t most = std::min(buffered_, width_);
  std::uint32_t n = 0, built = 0;
  bool partial = false;
  for (std::uint32_t at = head_; n < most; ++n) {
    const Waiting& request = buffer_[at];
    oldest_[n].read(cycle, at);
    std::array<std::uint8_t, 4> index{};
    if (request.ticket.valid) add(request, lines, index, exceeded);
    // What the oldest request exceeds by itself stays exceeded, so it leaves alone.
    if (n != 0 && exceeded.any()) break;
    group.at[n] = {request.ticket, request.control, index, request.offset};
    partial = request.partial;
    built = lines.count;
    at = at + 1 == buffer_.size() ? 0 : at + 1;
  }
  group.count = static_cast<std::uint8_t>(n);
  group.lines = static_cast<std::uint8_t>(built);
  std::copy_n(lines.line.begin(), built, group.line.begin());
  std::copy_n(lines.turned.begin(), built, group.turned.begin());
  if (n < most)
    cause_ = exceeded.lookups ? &lookups : exceeded.banks ? &banks : &set;
  else
    cause_ = partial ? &partial_quad : &starved;
  head_ += n;
  if (head_ >= buffer_.size()) head_ -= static_cast<std::uint32_t>(buffer_.size());
  buffered_ -= n;
  return n;
}

inline void GroupFormer::take(Cycle cycle) {
  const TexelGroup& group = texels_in.take(cycle);
  for (std::uint32_t n = 0; n < group.count; ++n) {
    std::uint32_t at = head_ + buffered_++;
    if (at >= buffer_.size()) at -= static_cast<std::uint32_t>(buffer_.size());
    new_[n].write(cycle, at);
    const TexelToken& token = group.at[n];
    Waiting& request = buffer_[at];
    request.ticket = token.ticket;
    request.control = token.control;
    request.partial = (group.partial >> n & 1) != 0;
    request.turned = token.turned;
    const std::uint32_t mask = (1u << line_log2_) - 1;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t address = token.address[i];
      request.line[i] = address >> line_log2_;
      request.word[i] = address >> 2;
      request.bank[i] = static_cast<std::uint16_t>(
          (address ^ (token.turned[i >> 1] ? turn_ : 0)) >> 2 & bank_mask_);
      request.offset[i] = static_cast<std::uint8_t>(address & mask);
    }
  }
}

// Counts the slots of a cycle that began with `buffered` requests. Empty cycles are counted when
// the next group leaves.
inline void GroupFormer::count(std::uint32_t emitted, std::uint32_t buffered, Cycle cycle) {
  if (emitted == 0) {
    if (!started_) return;
    pending_ = true;
    ++(buffered == 0 ? starved_since_
                     : stopped_since_[static_cast<std::size_t>(stall_in.read(cycle))]);
    return;
  }
  started_ = true;
  std::uint64_t cycles = 1;
  if (pending_) {
    const auto empty = [&](Counter& counter, std::uint64_t& since) {
      counter += width_ * since;
      cycles += since;
      since = 0;
    };
    empty(starved, starved_since_);
    Counter* const by_stall[] = {&output,     &allocate,  &miss_queue, &wait_fill,
                                 &write_fill, &bank_pass, &output};
    for (std::size_t i = 0; i < stopped_since_.size(); ++i) empty(*by_stall[i], stopped_since_[i]);
    pending_ = false;
  }
  slots += width_ * cycles;
  requests += emitted;
  if (emitted < width_) *cause_ += width_ - emitted;
}

void GroupFormer::reset() {
  head_ = buffered_ = 0;
  started_ = pending_ = false;
  starved_since_ = 0;
  stopped_since_.fill(0);
}

Datasheet GroupFormer::datasheet() {
  return {.unit = "GroupFormer",
          .does = "Forms groups of requests that the ports of the cache serve in one pass.",
          .latency = {2, "2, from a request in the buffer that leaves at once"},
          .stages = {{"1", "requests into the buffer", "W : 1 mux per entry"},
                     {"2",
                      "distinct lines, words per bank and lines per set of the oldest W requests; "
                      "those within the limits leave",
                      "line comparison, number of the line (16 inputs), prefix of the requests "
                      "within the limits, mux of lines: about 1.3 x the 24 x 24 multiply by "
                      "estimate, two stages if that is too long"}},
          .cost =
              "2 W requests of flip-flops, W read and W write ports; by estimate for W = 4: 120 "
              "comparators of line numbers (27 bits) and 120 of words (30 bits) between 16 texels, "
              "a counter of distinct words per bank."};
}

}  // namespace deburr::rtl::texture
