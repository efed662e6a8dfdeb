// SPDX-License-Identifier: MIT
#include "rtl_model/texture/tag_stage.h"

#include <algorithm>
#include <span>

#include "rtl_model/texture/datasheets.h"

namespace deburr::rtl::texture {

TagStage::TagStage(const sc_core::sc_module_name& name, ClockDomain& clock,
                   const spec::texture::Parameters& p)
    : TagUnit(name, clock, p),
      blocks_(has_fetcher(p)),
      line_log2_(log2_of(p.cache_line_bytes)),
      turn_(turn_bytes(static_cast<std::uint32_t>(p.cache_line_bytes))) {}

Activity TagStage::tick(Cycle cycle) {
  used_ += line_used_in.read(cycle) ? 1 : 0;
  const bool arrives = texels_in.can_pop(cycle);
  if (occupied_) {
    if (!requests_out.can_push(cycle)) return fifo_full_;
    const bool valid = request_.token.ticket.valid;
    if (valid && !misses_out.can_push(cycle) && would_miss()) return miss_queue_full_;
    CacheToken& out = requests_out.emplace(cycle);
    out.ticket = request_.token.ticket;
    out.control = request_.token.control;
    out.fills = 0;
    if (valid) look_up(cycle, out);
    occupied_ = false;
  } else if (!arrives) {
    return kIdle;
  }
  if (arrives) read_sets(cycle);
  return kBusy;
}

// Stage 1: one port per distinct line.
inline void TagStage::read_sets(Cycle cycle) {
  Request& r = request_;
  r.token = texels_in.take(cycle);
  occupied_ = true;
  if (!r.token.ticket.valid) return;
  r.read_at = cycle;
  if (blocks_ && r.token.control.codec != 0) [[unlikely]]
    return read_sets_of_blocks(cycle);
  const auto& address = r.token.address;
  r.line[0] = address[0] >> line_log2_;
  tags_.read(cycle, 0, r.line[0]);
  r.one_line =
      ((address[0] ^ address[1]) | (address[0] ^ address[2]) | (address[0] ^ address[3])) >>
          line_log2_ ==
      0;
  if (r.one_line) return;
  const std::uint32_t line1 = address[1] >> line_log2_, line2 = address[2] >> line_log2_,
                      line3 = address[3] >> line_log2_;
  const std::uint32_t line0 = r.line[0];
  const unsigned first1 = line1 == line0 ? 0 : 1;
  const unsigned first2 = line2 == line0 ? 0 : line2 == line1 ? 1 : 2;
  const unsigned first3 = line3 == line0 ? 0 : line3 == line1 ? 1 : line3 == line2 ? 2 : 3;
  r.line = {line0, line1, line2, line3};
  r.first = {0, static_cast<std::uint8_t>(first1), static_cast<std::uint8_t>(first2),
             static_cast<std::uint8_t>(first3)};
  if (first1 == 1) tags_.read(cycle, 1, line1);
  if (first2 == 2) tags_.read(cycle, 2, line2);
  if (first3 == 3) tags_.read(cycle, 3, line3);
}

// The same for lines of decoded blocks, which are not turned. From here on it is a request of
// texels.
void TagStage::read_sets_of_blocks(Cycle cycle) {
  Request& r = request_;
  FilterControl& control = r.token.control;
  r.one_line = false;
  for (std::size_t i = 0; i < 4; ++i) {
    r.line[i] = block_line(control, r.token.address[i]);
    r.token.address[i] = byte_in_block_line(control, i);
    std::uint8_t first = 0;
    while (r.line[first] != r.line[i]) ++first;
    r.first[i] = first;
    if (first == i) tags_.read(cycle, i, r.line[i]);
  }
  r.token.turned = {};
  control.codec = control.within = 0;
}

// Looks up one line of the request in stage 2.
inline TagStage::Line TagStage::look_up_line(Cycle cycle, std::size_t texel, CacheToken& out,
                                             MissToken& missed) {
  const std::uint32_t line = request_.line[texel];
  tags_.check(cycle, texel, line, request_.read_at);
  if (const std::uint32_t slot = tags_.find(line); slot != TagStore::kAbsent) {
    tags_.use(slot);
    const bool under_way = fill_number_[slot] > used_;
    under_way ? ++merged : ++hits;
    if (observer) [[unlikely]]
      observer(cycle, line, under_way ? LookUp::kMerged : LookUp::kHit);
    return {slot << line_log2_ | (tags_.turned(slot) ? turn_ : 0), 0};
  }
  if (observer) [[unlikely]]
    observer(cycle, line, LookUp::kMiss);
  return order(line, texel, out, missed);
}

// Requests a line that missed.
TagStage::Line TagStage::order(std::uint32_t line, std::size_t texel, CacheToken& out,
                               MissToken& missed) {
  const bool turned = request_.token.turned[texel >> 1];
  const TagStore::Place place = tags_.allocate(line, turned);
  ++misses;
  if (place.evicted) ++evictions;
  fill_number_[place.slot] = ++ordered_;
  missed.line[out.fills] = line;
  out.victim[out.fills] = static_cast<std::uint16_t>(place.slot);
  out.turned[out.fills] = turned;
  return {0, ++out.fills};
}

// Stage 2: up to four distinct lines, each looked up once, in order of first use.
inline void TagStage::look_up(Cycle cycle, CacheToken& out) {
  ++requests;
  const Request& r = request_;
  const std::uint32_t offset_mask = (1u << line_log2_) - 1;
  MissToken missed{};
  // Initialised, since a compiler cannot know that first[i] <= i.
  std::array<std::uint32_t, 4> place{};
  std::array<std::uint8_t, 4> source{};
  if (r.one_line) {
    const Line line = look_up_line(cycle, 0, out, missed);
    place.fill(line.place);
    source.fill(line.source);
  } else {
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t first = r.first[i];
      const Line line =
          first == i ? look_up_line(cycle, i, out, missed) : Line{place[first], source[first]};
      place[i] = line.place;
      source[i] = line.source;
    }
  }
  for (std::size_t i = 0; i < 4; ++i) place[i] ^= r.token.address[i] & offset_mask;
  out.place = place;
  out.source = source;
  tags_.commit(cycle);
  if (out.fills == 0) return;
  missed.count = out.fills;
  misses_out.push(cycle, missed);
}

// Changes nothing. A request that hits everywhere allocates nothing, so each line can be tested
// independently.
bool TagStage::would_miss() const {
  const auto lines = std::span(request_.line).first(request_.one_line ? 1 : 4);
  return std::any_of(lines.begin(), lines.end(),
                     [&](std::uint32_t line) { return tags_.find(line) == TagStore::kAbsent; });
}

void TagStage::reset() {
  tags_.reset();
  std::fill(fill_number_.begin(), fill_number_.end(), 0);
  ordered_ = used_ = 0;
  occupied_ = false;
}

Datasheet TagStage::datasheet(const spec::texture::Parameters& p) {
  const Sizes z(p);
  constexpr std::uint32_t kLookups = 4;
  const bool random = p.cache_replacement == spec::texture::Replacement::kRandom;
  const Operator way = op::mux(z.tag + 2, std::max(z.ways, 2U));
  // A single set is read once, and each lookup passes it to the next one.
  const std::uint32_t sets_read = std::min(kLookups, z.sets), choices = z.sets > 1 ? 1 : 0;
  return {.unit = "TagStage",
          .variant = sets_text(p) + with_decode(p),
          .does = "Looks up the lines of a request, allocates those that miss and requests them.",
          .latency = {2},
          .stages = {{.clock = "1",
                      .work = "distinct lines, read their sets",
                      .operators = {6 * op::equal(z.line), op::logic(30),
                                    (has_fetcher(p) ? 4 : 0) * op::mux(z.line, 3)},
                      .longest = {op::mux(z.set_word, z.sets)},
                      // The sets; the first texel in each one's line, and valid.
                      .registers = texel_bits(p) + sets_read * z.set_word + 1 + 2 + 2 + 1},
                     // A set as the lookups before it left it, of this request; hit, way and order
                     // of use; then the place of each texel and the lines that missed, in order. A
                     // set that is read in this cycle is one of those, or of the tags.
                     {.clock = "2",
                      .work = "up to four lookups, allocation, misses to the queue",
                      .operators =
                          {choices * 6 * op::equal(z.set), choices * op::mux(z.set_word, 2),
                           choices * op::mux(z.set_word, 3), choices * op::mux(z.set_word, 4),
                           kLookups * z.ways * op::equal(z.tag + 1),
                           kLookups * z.ways * op::mux(z.tag + 2, 2),
                           op::logic(kLookups * z.ways * (2 * z.ways + 2) + (random ? 200 : 0)),
                           op::mux(z.slot + 4, 2), op::mux(z.slot + 4, 3), op::mux(z.slot + 4, 4),
                           op::mux(z.line + z.slot + 1, 2), op::mux(z.line + z.slot + 1, 3),
                           op::mux(z.line + z.slot + 1, 4), op::count_ones(kLookups),
                           choices * kLookups * kLookups * op::equal(z.set),
                           choices * kLookups * op::mux(z.set_word, kLookups + 1)},
                      .longest = {op::equal(z.tag + 1), kLookups * way,
                                  choices * op::mux(z.set_word, kLookups + 1)}}},
          .shared_registers = random ? 16U : 0U};
}

}  // namespace deburr::rtl::texture
