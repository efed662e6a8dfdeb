// SPDX-License-Identifier: MIT
#include "rtl_model/texture/wide_data_stage.h"

#include <algorithm>
#include <bit>
#include <string>

#include "rtl_model/texture/datasheets.h"
#include "rtl_model/texture/width.h"

namespace deburr::rtl::texture {
namespace {

// The most words that a group reads: of blocks as many as decoders, which are those of few
// requests, and of the texels of the others.
std::uint32_t words_read(const spec::texture::Parameters& p) {
  const auto requests = static_cast<std::uint32_t>(p.width);
  if (!has_decoders(p)) return 4 * requests;
  const std::uint32_t blocks = decoders(p), of_blocks = (blocks + 3) / 4;
  return 4 * (requests - of_blocks + blocks);
}

// One of the copies for R reads per bank and cycle.
MemoryShape copy_shape(const spec::texture::Parameters& p) {
  const auto words = static_cast<std::uint32_t>(p.cache_line_bytes / 4);
  const std::uint32_t banks = words * static_cast<std::uint32_t>(p.cache_line_banks);
  return {.words = static_cast<std::uint64_t>(p.cache_bytes / 4),
          .word_bits = 32,
          .kind = MemoryKind::kSram,
          .read_ports = std::min(words_read(p), banks),
          .write_ports = static_cast<std::uint32_t>(p.cache_fill_writes),
          .latency = 1,
          .read_during_write = ReadDuringWrite::kOldWord,
          .banks = banks,
          .span = words,
          .separate_banks = true,
          .content = "lines, one word of each per bank"};
}

}  // namespace

WideDataStage::Copy::Copy(const char* name, const spec::texture::Parameters& p)
    : banks(name, copy_shape(p)) {
  for (std::uint32_t i = 0; i < banks.shape().read_ports; ++i)
    reads.emplace_back(banks, "word_" + std::to_string(i));
  for (std::uint32_t i = 0; i < banks.shape().write_ports; ++i)
    writes.emplace_back(banks, "fill_" + std::to_string(i));
}

WideDataStage::WideDataStage(const sc_core::sc_module_name& name, ClockDomain& clock,
                             const spec::texture::Parameters& p, const FillBuffer::Reader& fills)
    : DataUnit(name, clock, "groups", "groups with more words of one bank than a cycle reads"),
      fills_(fills),
      line_log2_(log2_of(p.cache_line_bytes)),
      words_a_line_(static_cast<std::uint32_t>(p.cache_line_bytes / 4)),
      turn_(turn_bytes(static_cast<std::uint32_t>(p.cache_line_bytes))),
      line_bank_mask_(static_cast<std::uint32_t>(p.cache_line_banks) - 1),
      bank_mask_(static_cast<std::uint32_t>(p.cache_line_banks) * words_a_line_ - 1),
      reads_(static_cast<std::uint32_t>(p.cache_bank_reads)),
      fill_writes_(static_cast<std::uint32_t>(p.cache_fill_writes)),
      bytes_(static_cast<std::size_t>(p.cache_bytes) + kWordPadding),
      banks_(bank_mask_ + 1) {
  if (has_decoders(p))
    blocks_out.emplace("blocks_out");
  else
    texels_out.emplace("texels_out");
  for (std::uint32_t i = 0; i < reads_; ++i)
    copies_.push_back(
        std::make_unique<Copy>(reads_ == 1 ? "banks" : ("banks_" + std::to_string(i)).c_str(), p));
}

Activity WideDataStage::tick(Cycle cycle) {
  const std::uint64_t before = lines_written.value();
  const Activity activity = work(cycle);
  fills_.read_ahead(cycle);
  const auto written = static_cast<std::uint8_t>(lines_written.value() - before);
  if (lines_used_out.driven() != written) lines_used_out.drive(cycle, written);
  if (stall_out.driven() != stall_) stall_out.drive(cycle, stall_);
  stall_ = activity == kBusy                ? SlotStall::kNone
           : activity == wait_fill_         ? SlotStall::kWaitFill
           : activity == write_fill_        ? SlotStall::kWriteFill
           : activity == bank_conflict_     ? SlotStall::kBankPass
           : activity == kStalledDownstream ? SlotStall::kOutput
                                            : SlotStall::kNone;
  return activity;
}

// Last stage first.
inline Activity WideDataStage::work(Cycle cycle) {
  const bool waits = waits_;
  if (!(blocks_out ? push(cycle, *blocks_out, blocks_) : push(cycle, *texels_out, waiting_)))
    return kStalledDownstream;
  if (!requests_in.can_pop(cycle)) return waits ? kBusy : kIdle;
  const CacheGroup& group = requests_in.front(cycle);
  if (!started_ && !read_at_once(cycle, group)) schedule(group);
  if (passes_done_ < passes_) read(cycle, passes_done_++);
  // A line may replace one that is still read: write it no earlier than in the last pass, which
  // still reads the old word.
  if (passes_done_ < passes_) return bank_conflict_;
  const std::uint32_t written = fills_left_ == 0 ? 0 : write_fills(cycle, group);
  if (fills_left_ != 0) return written != 0 ? write_fill_ : wait_fill_;
  finish(cycle, group);
  return kBusy;
}

// Fast path for a group that needs at most one pass, the common case: the words of each line as a
// mask of banks. Returns false without reading if a bank has more than R words, or for blocks.
inline bool WideDataStage::read_at_once(Cycle cycle, const CacheGroup& group) {
  if (bank_mask_ >= 64) return false;
  if (blocks_out) {
    blocks_.blocks = 0;
    for (std::size_t r = 0; r < group.count; ++r)
      if (group.at[r].ticket.valid && group.at[r].control.codec != 0) return false;
  }
  std::array<std::uint32_t, spec::texture::kMostLookups> base{};
  std::array<std::uint64_t, spec::texture::kMostLookups> words{};
  std::uint32_t highest = 0;
  for (std::size_t k = 0; k < group.lines; ++k) {
    base[k] = std::uint32_t{group.slot[k]} << line_log2_ | (group.turned[k] ? turn_ : 0);
    highest = std::max(highest, base[k]);
  }
  if (highest >= bytes_.size() - kWordPadding) return false;  // the port rejects it
  // The content of a line that missed is replaced when its fill is written.
  for (std::uint32_t r = 0; r < group.count; ++r) {
    const GroupRequest& request = group.at[r];
    if (!request.ticket.valid) continue;
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t k = request.index[i], place = base[k] ^ request.offset[i];
      words[k] |= std::uint64_t{1} << (place >> 2 & bank_mask_);
      waiting_.at[r].texel[i] = load_word(&bytes_[place]);
    }
  }
  // Banks that read a word, a second word, and more words than a cycle allows.
  std::uint64_t once = 0, twice = 0, more = 0;
  std::size_t line_once = 0, line_twice = 0;
  std::uint32_t fills = 0;
  for (std::size_t k = 0; k < group.lines; ++k) {
    if (group.missed[k]) {
      ++fills;
      continue;
    }
    const std::uint64_t again = once & words[k];
    more |= twice & words[k];
    if (again != 0) line_twice = k;
    twice |= again;
    once |= words[k];
    line_once = k;
  }
  if (more != 0 || (twice != 0 && reads_ == 1)) return false;
  // The masks have checked the banks, so one word of each copy is enough for the ports.
  const auto first_word = [&](std::size_t k, std::uint64_t banks) {
    return (base[k] >> line_log2_) * words_a_line_ |
           (static_cast<std::uint32_t>(std::countr_zero(banks)) & (words_a_line_ - 1));
  };
  if (twice != 0)
    issue(cycle, copies_[1]->reads[0], first_word(line_twice, words[line_twice] & twice));
  if (once != 0) issue(cycle, copies_[0]->reads[0], first_word(line_once, words[line_once]));
  started_ = true;
  passes_ = passes_done_ = 0;
  next_line_ = 0;
  fills_left_ = fills;
  return true;
}

// Pass and port of each texel that hits.
void WideDataStage::schedule(const CacheGroup& group) {
  started_ = true;
  ++group_;
  hits_ = passes_ = passes_done_ = 0;
  next_line_ = fills_left_ = 0;
  blocks_.blocks = 0;
  std::array<std::uint32_t, spec::texture::kMostLookups> base{};
  for (std::size_t k = 0; k < group.lines; ++k) {
    base[k] = std::uint32_t{group.slot[k]} << line_log2_ | (group.turned[k] ? turn_ : 0);
    fills_left_ += group.missed[k];
  }
  for (std::uint32_t r = 0; r < group.count; ++r) {
    const GroupRequest& request = group.at[r];
    if (!request.ticket.valid) continue;
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t k = request.index[i], place = base[k] ^ request.offset[i];
      if (request.control.codec != 0)
        add_block(group, blocks_.at[r], i,
                  {request.index[i], request.offset[i], request.control.codec}, place);
      else if (!group.missed[k])
        add_read(place, 4 * r + i);
    }
  }
  if (passes_ > 1) ++conflicts;
}

void WideDataStage::add_read(std::uint32_t place, std::size_t to) {
  Read& read = schedule_[hits_++];
  read.place = place;
  read.to = static_cast<std::uint8_t>(to);
  const std::uint32_t word = place >> 2;
  Bank& bank = banks_[word & bank_mask_];
  if (bank.group != group_) {
    bank.group = group_;
    bank.words = 0;
  }
  std::uint32_t n = 0;
  while (n < bank.words && bank.word[n] != word) ++n;
  read.first = n == bank.words;
  if (read.first) bank.word[bank.words++] = word;
  const std::uint32_t pass = n / reads_;
  read.pass = static_cast<std::uint8_t>(pass);
  read.copy = static_cast<std::uint8_t>(n % reads_);
  passes_ = std::max(passes_, pass + 1);
}

// The block of a texel, which is read if it is a new one that hits.
void WideDataStage::add_block(const CacheGroup& group, BlockRequest& request, std::size_t texel,
                              const BlockPlace& at, std::uint32_t place) {
  std::size_t k = 0;
  while (k < blocks_.blocks && block_places_[k] != at) ++k;
  request.index[texel] = static_cast<std::uint8_t>(k);
  if (k < blocks_.blocks || k == block_places_.size()) return;  // the GroupFormer forms no more
  block_places_[k] = at;
  blocks_.block[k] = {};
  ++blocks_.blocks;
  if (group.missed[at.line]) return;
  for (std::uint32_t n = 0; n < word_count(at.codec); ++n)
    add_read(place + 4 * n, kMostTexels + 4 * k + n);
}

void WideDataStage::read(Cycle cycle, std::uint32_t pass) {
  std::array<std::uint32_t, spec::texture::kMostBankReads> ports{};
  for (std::uint32_t i = 0; i < hits_; ++i) {
    const Read& read = schedule_[i];
    if (read.pass != pass) continue;
    if (read.first) issue(cycle, copies_[read.copy]->reads[ports[read.copy]++], read.place >> 2);
    const std::uint32_t word = load_word(&bytes_[read.place]);
    if (read.to < kMostTexels)
      texel(read.to) = word;
    else
      blocks_.block[(read.to - kMostTexels) / 4][read.to % 4] = word;
  }
}

// The number of lines written.
std::uint32_t WideDataStage::write_fills(Cycle cycle, const CacheGroup& group) {
  std::uint32_t written = 0, line_banks = 0;
  while (written < fill_writes_ && fills_left_ != 0 && fills_.ready(cycle)) {
    while (!group.missed[next_line_]) ++next_line_;
    const std::uint32_t bank = 1u << (group.slot[next_line_] & line_bank_mask_);
    if ((line_banks & bank) != 0) break;
    line_banks |= bank;
    write_fill(cycle, group, next_line_++, written++);
    --fills_left_;
  }
  return written;
}

void WideDataStage::write_fill(Cycle cycle, const CacheGroup& group, std::size_t k,
                               std::uint32_t port) {
  const std::uint8_t* const line = fills_.line(cycle);
  for (std::uint32_t r = 0; r < group.count; ++r) {
    if (!group.at[r].ticket.valid) continue;
    for (std::uint32_t i = 0; i < 4; ++i)
      if (group.at[r].index[i] == k) texel(4 * r + i) = load_word(line + group.at[r].offset[i]);
  }
  for (std::size_t b = 0; b < blocks_.blocks; ++b)
    if (block_places_[b].line == k)
      blocks_.block[b] = load_block(line + block_places_[b].offset, block_places_[b].codec);
  const std::size_t slot = group.slot[k], line_bytes = std::size_t{1} << line_log2_;
  // All copies are written alike, so the ports of one check the access.
  copies_.front()->writes[port].write(cycle, slot * words_a_line_, words_a_line_);
  const std::size_t turn = group.turned[k] ? turn_ : 0;
  for (std::size_t at = 0; at < line_bytes; at += turn_)
    std::copy_n(line + at, turn_, &bytes_[slot * line_bytes + (at ^ turn)]);
  fills_.release(cycle);
  ++lines_written;
}

// Passes the group to stage 2; the texels of an invalid texture are 0.
inline void WideDataStage::finish(Cycle cycle, const CacheGroup& group) {
  waiting_.count = group.count;
  for (std::size_t r = 0; r < group.count; ++r) {
    const GroupRequest& request = group.at[r];
    TexelQuadToken& out = waiting_.at[r];
    out.ticket = request.ticket;
    out.control = request.control;
    const std::uint32_t mask = request.ticket.valid ? texel_mask(request.control) : 0;
    if (mask != ~0U)
      for (std::uint32_t& word : out.texel) word &= mask;
  }
  if (blocks_out) {
    blocks_.count = group.count;
    for (std::size_t r = 0; r < group.count; ++r) pass(waiting_.at[r], blocks_.at[r]);
  }
  waits_ = true;
  requests_in.pop(cycle);
  started_ = false;
}

void WideDataStage::reset() {
  DataUnit::reset();
  stall_ = SlotStall::kNone;
}

Datasheet WideDataStage::datasheet(const spec::texture::Parameters& p) {
  const Sizes z(p);
  const std::uint32_t n = z.texels, pairs = n * (n - 1) / 2, line = 32 * z.words;
  const std::uint32_t banks = z.line_banks * z.words, ports = z.bank_reads * banks;
  const auto log2 = [](std::uint32_t count) {
    return static_cast<std::uint32_t>(std::bit_width(count - 1));
  };
  // Words of the texels, and of the distinct blocks.
  const std::uint32_t words = n + (has_decoders(p) ? 4 * decoders(p) : 0);
  const std::uint32_t place = z.slot + z.offset, row = z.slot - log2(z.line_banks);
  return {.unit = "WideDataStage",
          .variant = chosen("width", z.width) + ", " + std::to_string(banks) + " banks, " +
                     chosen("cache.bank_reads", z.bank_reads) + ", " +
                     chosen("cache.fill_writes", z.fill_writes) + with_decoders(p),
          .does = "Reads the texels of a group from the banks and writes its fills.",
          .latency = {2, "2, from the last cycle of a group"},
          .interval = {1,
                       "max(1, bank passes) cycles per group; the writes of its fills begin in the "
                       "last of them"},
          .stages =
              // The place of each texel by its line; pairs of one word and of one bank; the pass of
              // each texel; the address of each bank. The lines that are written: their number,
              // line bank, turned halves, and their words of texels that missed.
          {{.clock = "1",
            .work = "waits for the group's fills and takes up to `fill_writes` of them; addresses "
                    "the texels that hit before it writes fills",
            .operators = {n * op::mux(z.slot + 2, z.lookups), pairs * op::equal(place - 2),
                          n * op::count_ones(n / 2), n * op::compare(4), ports * op::mux(row, n),
                          op::logic(ports * n + 4 * pairs), z.fill_writes * op::priority(z.lookups),
                          z.fill_writes * op::mux(z.slot + 1, z.lookups),
                          z.fill_writes * op::mux(line, 2),
                          z.line_banks * op::mux(line + row, z.fill_writes),
                          words * op::mux(32, z.words * z.fill_writes)},
            .longest = {op::mux(z.slot + 2, z.lookups), op::equal(place - 2), op::count_ones(n - 1),
                        op::compare(4), op::mux(row, n)},
            // As in the DataStage; lines to write.
            .registers = (has_decoders(p) ? Payload::of<BlockGroup>(block_shape(p))
                                          : Payload::of<TexelQuadGroup>(
                                                links_of_groups(p.width, texel_quad_shape(p))))
                             .bits() +
                         words * (log2(ports) + 2 + 1) + z.lookups + 4 + 2},
           {.clock = "2",
            .work = "words, texels; missed texels from the fill buffer",
            .path = "SRAM read",
            .operators = {words * op::mux(32, ports), words * op::mux(32, 2), n * op::mux(8, 4),
                          n * op::mux(8, 2), op::logic(n * 32)},
            .longest = {op::mux(32, ports), op::mux(32, 2), op::mux(8, 4)}}}};
}

}  // namespace deburr::rtl::texture
