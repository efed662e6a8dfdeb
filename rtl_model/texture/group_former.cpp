// SPDX-License-Identifier: MIT
#include "rtl_model/texture/group_former.h"

#include <algorithm>

#include "rtl_model/texture/datasheets.h"

namespace deburr::rtl::texture {

GroupFormer::GroupFormer(const sc_core::sc_module_name& name, ClockDomain& clock,
                         const spec::texture::Parameters& p)
    : Unit(name, clock),
      decoders(has_decoders(p)
                   ? std::make_unique<Counter>("decoders", "slots",
                                               "empty: the next request needs more blocks decoded")
                   : nullptr),
      width_(static_cast<std::uint32_t>(p.width)),
      lookups_(static_cast<std::uint32_t>(p.cache_lookups)),
      reads_(static_cast<std::uint32_t>(p.cache_bank_reads)),
      ways_(static_cast<std::uint32_t>(p.cache_ways)),
      decoders_(rtl::texture::decoders(p)),
      blocks_(has_fetcher(p)),
      line_log2_(log2_of(p.cache_line_bytes)),
      turn_(turn_bytes(static_cast<std::uint32_t>(p.cache_line_bytes))),
      set_mask_(static_cast<std::uint32_t>(p.cache_bytes / p.cache_line_bytes / p.cache_ways) - 1),
      bank_mask_(static_cast<std::uint32_t>(p.cache_line_banks * p.cache_line_bytes / 4) - 1),
      apart_mask_(std::min(static_cast<std::uint32_t>(p.cache_line_banks) - 1, set_mask_)),
      alike_(std::min(reads_, ways_)),
      memory_("requests_waiting", {.words = 2 * static_cast<std::uint64_t>(p.width),
                                   .word_bits = texel_bits(p) + 1,
                                   .kind = MemoryKind::kFlops,
                                   .read_ports = width_,
                                   .write_ports = width_,
                                   .latency = 0,
                                   .content = "requests that wait for a group"}),
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

// A word, and the number that selects its bank.
inline void GroupFormer::add_word(std::uint32_t place, std::uint64_t word, Exceeded& exceeded) {
  Bank& bank = banks_[place & bank_mask_];
  if (bank.group != group_) {
    bank.group = group_;
    bank.words = 0;
  }
  const auto end = bank.word.begin() + bank.words;
  if (std::find(bank.word.begin(), end, word) != end) return;
  if (bank.words == reads_)
    exceeded.banks = true;
  else
    bank.word[bank.words++] = word;
}

// Adds the lines and words of a request to those of the group.
inline void GroupFormer::add(const Waiting& request, Lines& lines,
                             std::array<std::uint8_t, 4>& index, Exceeded& exceeded) {
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t line = request.line[request.request.index[i]],
                        offset = request.request.offset[i];
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
    // Of words, with the line turned as the row asks.
    const std::uint64_t address = std::uint64_t{line} << line_log2_ | offset;
    const std::uint32_t place =
        static_cast<std::uint32_t>(address) ^ (request.turned[i >> 1] ? turn_ : 0);
    add_word(place >> 2, address >> 2, exceeded);
  }
}

// Adds the blocks of a request, and their words after the first ones.
void GroupFormer::add_blocks(const Waiting& request, Blocks& blocks, Exceeded& exceeded) {
  const std::uint8_t codec = request.request.control.codec;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t address = request.address[i],
                        turned = address ^ (request.turned[i >> 1] ? turn_ : 0);
    for (std::uint32_t n = 1; n < word_count(codec); ++n)
      add_word((turned >> 2) + n, (address >> 2) + n, exceeded);
    std::uint32_t k = 0;
    while (k < blocks.count && (blocks.address[k] != address || blocks.codec[k] != codec)) ++k;
    if (k < blocks.count) continue;
    if (k == decoders_) {
      exceeded.decoders = true;
      continue;
    }
    blocks.address[k] = address;
    blocks.codec[k] = codec;
    ++blocks.count;
  }
}

// Fast path: a group of the `most` oldest requests, if they are within all limits for sure. Lines
// that are not turned have one word per bank of their line bank; so few lines per line bank have
// few words per bank. Blocks that requests share count for each. Returns false if limits must be
// checked.
inline bool GroupFormer::emit_all(std::uint32_t most, LineGroup& group) {
  std::uint32_t lines = 0, blocks = 0, alike = 0;  // alike: 4 bits per line bank
  std::array<std::uint32_t, spec::texture::kMostLookups> numbers{};
  std::array<std::uint8_t, 64> newest{};  // 1 + index of the last line with these low bits
  std::uint32_t at = head_;
  for (std::uint32_t n = 0; n < most; ++n) {
    const Waiting& waiting = buffer_[at];
    at = at + 1 == 2 * width_ ? 0 : at + 1;
    GroupRequest& request = group.at[n];
    request = waiting.request;
    if (waiting.lines == 0) continue;
    if (waiting.turned[0] || waiting.turned[1]) return false;
    blocks += waiting.blocks;
    std::array<std::uint8_t, 4> of_group;
    for (std::uint32_t i = 0; i < waiting.lines; ++i) {
      const std::uint32_t line = waiting.line[i];
      std::uint32_t k = newest[line % newest.size()];
      while (k != 0 && numbers[k - 1] != line) --k;
      if (k == 0) {
        const std::uint32_t place = 4 * (line & apart_mask_);
        if (lines == lookups_ || (alike >> place & 15) == alike_) return false;
        alike += 1u << place;
        numbers[lines] = line;
        k = ++lines;
        newest[line % newest.size()] = static_cast<std::uint8_t>(k);
      }
      of_group[i] = static_cast<std::uint8_t>(k - 1);
    }
    if (waiting.lines == 1)
      request.index.fill(of_group[0]);
    else
      for (std::uint8_t& index : request.index) index = of_group[index];
  }
  if (blocks > decoders_) return false;
  group.count = static_cast<std::uint8_t>(most);
  group.lines = static_cast<std::uint8_t>(lines);
  group.line = numbers;
  group.turned.fill(false);
  return true;
}

// The longest sequence of at most `most` requests within all limits. Returns its length.
std::uint32_t GroupFormer::emit_within(std::uint32_t most, LineGroup& group) {
  ++group_;
  Lines lines;
  Blocks blocks;
  Exceeded exceeded;
  std::uint32_t n = 0, built = 0;
  for (std::uint32_t at = head_; n < most; ++n) {
    const Waiting& waiting = buffer_[at];
    std::array<std::uint8_t, 4> index{};
    if (waiting.lines != 0) {
      add(waiting, lines, index, exceeded);
      if (waiting.blocks != 0) [[unlikely]]
        add_blocks(waiting, blocks, exceeded);
    }
    // If the oldest request exceeds a limit by itself, `exceeded` stays set, and the group has only
    // this request.
    if (n != 0 && exceeded.any()) break;
    group.at[n] = waiting.request;
    group.at[n].index = index;
    built = lines.count;
    at = at + 1 == 2 * width_ ? 0 : at + 1;
  }
  group.count = static_cast<std::uint8_t>(n);
  group.lines = static_cast<std::uint8_t>(built);
  std::copy_n(lines.line.begin(), built, group.line.begin());
  std::copy_n(lines.turned.begin(), built, group.turned.begin());
  if (n < most)
    cause_ = exceeded.lookups ? &lookups
             : exceeded.banks ? &banks
             : exceeded.set   ? &set
                              : decoders.get();
  return n;
}

// Returns the number of requests.
std::uint32_t GroupFormer::emit(Cycle cycle) {
  LineGroup& group = groups_out.emplace(cycle);
  const std::uint32_t most = std::min(buffered_, width_);
  const std::uint32_t n = emit_all(most, group) ? most : emit_within(most, group);
  // Consecutive entries on consecutive ports: the access of the first one is checked.
  oldest_[0].read(cycle, head_);
  std::uint32_t newest = head_ + n - 1;
  if (newest >= 2 * width_) newest -= 2 * width_;
  if (n == most) cause_ = buffer_[newest].partial ? &partial_quad : &starved;
  head_ = newest + 1 == 2 * width_ ? 0 : newest + 1;
  buffered_ -= n;
  return n;
}

inline void GroupFormer::take(Cycle cycle) {
  const TexelGroup& group = texels_in.take(cycle);
  std::uint32_t at = head_ + buffered_;
  if (at >= 2 * width_) at -= 2 * width_;
  new_[0].write(cycle, at);  // as in emit()
  for (std::uint32_t n = 0; n < group.count; ++n) {
    enter(group.at[n], buffer_[at]);
    buffer_[at].partial = (group.partial >> n & 1) != 0;
    at = at + 1 == 2 * width_ ? 0 : at + 1;
  }
  buffered_ += group.count;
}

inline void GroupFormer::enter(const TexelToken& token, Waiting& waiting) const {
  GroupRequest& request = waiting.request;
  request.ticket = token.ticket;
  request.control = token.control;
  request.index = {};
  if (!token.ticket.valid) {
    request.offset = {};
    waiting.lines = 0;
    return;
  }
  if (blocks_ && token.control.codec != 0) [[unlikely]]
    return enter_blocks(token, waiting);
  waiting.turned = token.turned;
  waiting.address = token.address;
  const auto& address = token.address;
  waiting.blocks = 0;
  if (token.control.codec != 0) [[unlikely]] {
    for (auto at = address.begin(); at != address.end(); ++at)
      waiting.blocks += std::find(address.begin(), at, *at) == at;
  }
  const std::uint32_t mask = (1u << line_log2_) - 1, first = address[0] >> line_log2_;
  for (std::size_t i = 0; i < 4; ++i)
    request.offset[i] = static_cast<std::uint8_t>(address[i] & mask);
  waiting.line[0] = first;
  waiting.lines = 1;
  if (((address[0] ^ address[1]) | (address[0] ^ address[2]) | (address[0] ^ address[3])) <= mask)
    return;
  const std::uint32_t line1 = address[1] >> line_log2_, line2 = address[2] >> line_log2_,
                      line3 = address[3] >> line_log2_;
  std::uint32_t n = 1;
  const auto number = [&](std::uint32_t line, std::uint32_t k) {
    if (k == n) waiting.line[n++] = line;
    return k;
  };
  const std::uint32_t k1 = number(line1, line1 == first ? 0 : 1),
                      k2 = number(line2, line2 == first   ? 0
                                         : line2 == line1 ? k1
                                                          : n),
                      k3 = number(line3, line3 == first   ? 0
                                         : line3 == line1 ? k1
                                         : line3 == line2 ? k2
                                                          : n);
  request.index = {0, static_cast<std::uint8_t>(k1), static_cast<std::uint8_t>(k2),
                   static_cast<std::uint8_t>(k3)};
  waiting.lines = n;
}

// The same for lines of decoded blocks, which are not turned. From here on it is a request of
// texels.
void GroupFormer::enter_blocks(const TexelToken& token, Waiting& waiting) {
  GroupRequest& request = waiting.request;
  waiting.turned = {};
  waiting.lines = waiting.blocks = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t line = block_line(token.control, token.address[i]);
    std::uint8_t k = 0;
    while (k < waiting.lines && waiting.line[k] != line) ++k;
    if (k == waiting.lines) waiting.line[waiting.lines++] = line;
    request.index[i] = k;
    request.offset[i] = byte_in_block_line(token.control, i);
  }
  request.control.codec = request.control.within = 0;
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

Datasheet GroupFormer::datasheet(const spec::texture::Parameters& p) {
  const Sizes z(p);
  const std::uint32_t n = z.texels, pairs = n * (n - 1) / 2, mean = n / 2;
  // A word of a bank: of two texels of one line, the word in the line; the bank by both.
  const std::uint32_t word = z.offset - 2,
                      bank = word + static_cast<std::uint32_t>(std::bit_width(z.line_banks - 1));
  Datasheet sheet = {
      .unit = "GroupFormer",
      .variant =
          chosen("width", z.width) + ", " + chosen("cache.lookups", z.lookups) + with_decode(p),
      .does = "Forms groups of requests that the ports of the cache serve in one pass.",
      .latency = {2, "2, from a request in the buffer that leaves at once"},
      .stages = {{.clock = "1",
                  .work = "requests into the buffer",
                  .operators = {2 * op::add(4), op::compare(4),
                                (has_fetcher(p) ? n : 0) * op::mux(z.line, 3)},
                  .longest = {op::add(4), op::mux(texel_bits(p) + 1, z.width)},
                  .registers = 2 * 4},
                 // Of each texel: is its line (its word) the first, how many of its kind come
                 // before it (lines, lines of its set, words of its bank), is that in limits?
                 {.clock = "2",
                  .work = "distinct lines, words per bank and lines per set of the oldest W "
                          "requests; those within the limits leave",
                  .operators = {pairs * op::equal(z.line), pairs * op::equal(word),
                                pairs * op::equal(bank), 3 * n * op::count_ones(mean),
                                3 * n * op::compare(4), n * op::mux(3, mean),
                                z.lookups * op::mux(z.line + 1, n), op::add(4),
                                op::logic(4 * pairs + 8 * z.width)},
                  .longest = {op::equal(z.line), op::count_ones(n - 1), op::compare(4),
                              op::priority(z.width), op::mux(z.line + 1, n)}}}};
  // Distinct blocks: of two texels in one line the place and the codec; each of four words counts.
  if (has_decoders(p))
    for (const Operator& one : {pairs * op::equal(z.offset), 4 * n * op::count_ones(mean),
                                4 * n * op::compare(4), op::logic(8 * pairs)})
      sheet.stages[1].operators.push_back(one);
  return sheet;
}

}  // namespace deburr::rtl::texture
