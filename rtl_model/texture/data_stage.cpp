// SPDX-License-Identifier: MIT
#include "rtl_model/texture/data_stage.h"

#include <algorithm>
#include <string>

#include "rtl_model/texture/datasheets.h"

namespace deburr::rtl::texture {
namespace {

// Of four blocks.
constexpr std::uint32_t kMostWords = 16;

MemoryShape bank_shape(const spec::texture::Parameters& p) {
  const auto banks = static_cast<std::uint32_t>(p.cache_line_bytes / 4);
  return {.words = static_cast<std::uint64_t>(p.cache_bytes / 4),
          .word_bits = 32,
          .kind = MemoryKind::kSram,
          .read_ports = has_decoders(p) ? std::min(kMostWords, banks) : 4,
          .write_ports = 1,
          .latency = 1,
          // A fill may replace a line in the cycle in which an older request reads it.
          .read_during_write = ReadDuringWrite::kOldWord,
          .banks = banks,
          .span = banks,
          .separate_banks = true,
          .content = "lines, one word of each per bank"};
}

}  // namespace

DataStage::DataStage(const sc_core::sc_module_name& name, ClockDomain& clock,
                     const spec::texture::Parameters& p, const FillBuffer::Reader& fills)
    : DataUnit(name, clock, "requests", "requests with two words in one bank"),
      fills_(fills),
      line_log2_(log2_of(p.cache_line_bytes)),
      words_a_line_(static_cast<std::uint32_t>(p.cache_line_bytes / 4)),
      turn_(turn_bytes(static_cast<std::uint32_t>(p.cache_line_bytes))),
      banks_("banks", bank_shape(p)),
      bytes_(static_cast<std::size_t>(p.cache_bytes) + kWordPadding) {
  if (!has_decoders(p)) {
    texels_out.emplace("texels_out");
    return;
  }
  blocks_out.emplace("blocks_out");
  blocks_.count = 1;
  for (std::uint32_t i = 4; i < banks_.shape().read_ports; ++i)
    more_reads_.emplace_back(banks_, "word_" + std::to_string(i));
}

// Last stage first.
Activity DataStage::work(Cycle cycle) {
  const bool waits = waits_;
  if (!(blocks_out ? push(cycle, *blocks_out, blocks_) : push(cycle, *texels_out, waiting_)))
    return kStalledDownstream;
  if (!requests_in.can_pop(cycle)) return waits ? kBusy : kIdle;
  const CacheToken& request = requests_in.front(cycle);
  if (request.ticket.valid && (request.fills != 0 || started_ || !read_at_once(cycle, request)))
    return advance(cycle, request);
  finish(cycle, request);
  return kBusy;
}

// Stage 1 of a request that may take several cycles.
Activity DataStage::advance(Cycle cycle, const CacheToken& request) {
  if (!started_) {
    started_ = true;
    schedule_ = schedule(request);
    if (request.control.codec != 0) find_blocks(request);
    passes_done_ = fills_done_ = 0;
    if (schedule_.passes > 1) ++conflicts;
  }
  if (passes_done_ < schedule_.passes) {
    if (request.control.codec == 0)
      read(cycle, request, passes_done_++);
    else
      read_blocks(cycle, request, passes_done_++);
  }
  // A line may replace one that is still read: write it no earlier than in the last pass, which
  // still reads the old word.
  const bool may_write = fills_done_ < request.fills && passes_done_ == schedule_.passes;
  const bool writes = may_write && fills_.ready(cycle);
  if (writes) write_fill(cycle, request);
  if (passes_done_ == schedule_.passes && fills_done_ == request.fills) {
    finish(cycle, request);
    return kBusy;
  }
  if (may_write && !writes) return wait_fill_;
  return writes ? write_fill_ : bank_conflict_;
}

// One word per bank and pass, in texel order. A block is in the banks of its words, which two
// blocks of a request share or do not.
DataStage::Schedule DataStage::schedule(const CacheToken& request) const {
  Schedule s{0, {-1, -1, -1, -1}, {}};
  const std::uint8_t codec = request.control.codec;
  const std::uint32_t unit_log2 = codec == 0 ? 2 : block_log2(codec),
                      units_a_line = words_a_line_ >> (unit_log2 - 2);
  for (std::size_t i = 0; i < 4; ++i) {
    if (request.source[i] != 0) continue;
    s.pass[i] = 0;
    for (std::size_t j = 0; j < i; ++j) {
      const std::uint32_t apart = (request.place[i] ^ request.place[j]) >> unit_log2;
      if (s.pass[j] < 0 || (apart & (units_a_line - 1)) != 0) continue;  // another bank
      s.again[i] = apart == 0;
      s.pass[i] = s.again[i] ? s.pass[j] : std::max(s.pass[i], s.pass[j] + 1);
      if (s.again[i]) break;
    }
    s.passes = std::max(s.passes, s.pass[i] + 1);
  }
  return s;
}

// The distinct blocks in the order of first use: of one fill, or of the banks.
void DataStage::find_blocks(const CacheToken& request) {
  std::array<std::uint8_t, 4>& index = blocks_.at[0].index;
  blocks_.blocks = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    std::size_t j = 0;
    while (request.source[j] != request.source[i] || request.place[j] != request.place[i]) ++j;
    index[i] = j == i ? blocks_.blocks++ : index[j];
  }
}

// Fast path for four hits in one pass, the common case. Returns false without reading if two words
// are in one bank, or for blocks.
inline bool DataStage::read_at_once(Cycle cycle, const CacheToken& request) {
  if (request.control.codec != 0) return false;
  std::array<std::uint32_t, 4> word;
  for (std::size_t i = 0; i < 4; ++i) word[i] = request.place[i] >> 2;
  const auto apart = [&](std::size_t i, std::size_t j) { return word[i] ^ word[j]; };
  const auto meet = [&](std::uint32_t difference) {
    return (difference & (words_a_line_ - 1)) == 0 && difference != 0;
  };
  const std::uint32_t a = apart(0, 1), b = apart(0, 2), c = apart(0, 3), d = apart(1, 2),
                      e = apart(1, 3), f = apart(2, 3);
  if ((a | b | c) >= words_a_line_ &&
      (meet(a) || meet(b) || meet(c) || meet(d) || meet(e) || meet(f)))
    return false;
  // Texels in the same word need one read.
  issue(cycle, reads_[0], word[0]);
  if (a != 0) reads_[1].read(cycle, word[1]);
  if (b != 0 && d != 0) reads_[2].read(cycle, word[2]);
  if (c != 0 && e != 0 && f != 0) reads_[3].read(cycle, word[3]);
  // The ports check the words, so read them first.
  for (std::size_t i = 0; i < 4; ++i) waiting_.texel[i] = load_word(&bytes_[request.place[i]]);
  return true;
}

void DataStage::read(Cycle cycle, const CacheToken& request, int pass) {
  for (std::size_t i = 0; i < 4; ++i) {
    if (schedule_.pass[i] != pass) continue;
    if (!schedule_.again[i]) issue(cycle, reads_[i], request.place[i] >> 2);
    waiting_.texel[i] = load_word(&bytes_[request.place[i]]);
  }
}

void DataStage::read_blocks(Cycle cycle, const CacheToken& request, int pass) {
  const std::uint8_t codec = request.control.codec;
  std::size_t port = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (schedule_.pass[i] != pass || schedule_.again[i]) continue;
    const std::uint32_t place = request.place[i];
    for (std::uint32_t n = 0; n < word_count(codec); ++n, ++port)
      issue(cycle, port < reads_.size() ? reads_[port] : more_reads_[port - reads_.size()],
            (place >> 2) + n);
    blocks_.block[blocks_.at[0].index[i]] = load_block(&bytes_[place], codec);
  }
}

void DataStage::write_fill(Cycle cycle, const CacheToken& request) {
  const std::uint8_t* const line = fills_.line(cycle);
  const auto fill = static_cast<std::size_t>(fills_done_);
  for (std::size_t i = 0; i < 4; ++i)
    if (request.source[i] == fill + 1) {
      if (request.control.codec == 0)
        waiting_.texel[i] = load_word(line + request.place[i]);
      else
        blocks_.block[blocks_.at[0].index[i]] =
            load_block(line + request.place[i], request.control.codec);
    }
  const std::size_t slot = request.victim[fill], line_bytes = std::size_t{1} << line_log2_;
  write_.write(cycle, slot * words_a_line_, words_a_line_);
  const std::size_t turn = request.turned[fill] ? turn_ : 0;
  for (std::size_t at = 0; at < line_bytes; at += turn_)
    std::copy_n(line + at, turn_, &bytes_[slot * line_bytes + (at ^ turn)]);
  fills_.release(cycle);
  line_used_ = cycle;
  if (!line_used_out.driven()) line_used_out.drive(cycle, true);
  ++lines_written;
  ++fills_done_;
}

// Passes the request to stage 2; the texels of an invalid texture are 0.
inline void DataStage::finish(Cycle cycle, const CacheToken& request) {
  const std::uint32_t mask = request.ticket.valid ? texel_mask(request.control) : 0;
  waiting_.ticket = request.ticket;
  waiting_.control = request.control;
  if (mask != ~0U)
    for (std::uint32_t& texel : waiting_.texel) texel &= mask;
  if (blocks_out) {
    if (!request.ticket.valid || request.control.codec == 0) blocks_.blocks = 0;
    pass(waiting_, blocks_.at[0]);
  }
  waits_ = true;
  requests_in.pop(cycle);
  started_ = false;
}

Datasheet DataStage::datasheet(const spec::texture::Parameters& p) {
  const Sizes z(p);
  const std::uint32_t n = z.words, place = z.slot + z.offset;
  // Words of a texel, or of its block.
  const std::uint32_t words = has_decoders(p) ? 4 : 1;
  return {.unit = "DataStage",
          .variant = std::to_string(n) + " banks of " + std::to_string(1U << z.slot) + " words" +
                     with_decoders(p),
          .does = "Reads the texels of a request from the banks and writes its fills.",
          .latency = {2, "2, from the last cycle of a request"},
          .interval = {1, "max(1, bank passes) + max(1, lines to write) - 1 cycles per request"},
          .stages =
              // Bank and word of each pair; the address of each bank; the fill's words of texels
              // that missed, its turned halves, and its place.
          {{.clock = "1",
            .work = "waits for the request's fills and takes each in order; addresses the texels "
                    "that hit before it writes its fills",
            .operators = {6 * op::equal(place - 2), 6 * op::maximum(2), n * op::mux(z.slot, 4),
                          op::logic(12 * n + 60), 4 * words * op::mux(32, n), op::mux(32 * n, 2),
                          op::mux(z.slot + 1, 4)},
            .longest = {op::equal(place - 2), 3 * op::maximum(2), op::mux(z.slot, 4)},
            // Ticket and control; texels that missed, and of the others bank and byte; passes and
            // fills done.
            .registers = (words == 1 ? Payload::of<TexelQuadToken>(texel_quad_shape(p))
                                     : Payload::of<BlockGroup>(block_shape(p)))
                             .bits() +
                         4 * (z.offset + 1) + 2 * 3 + 2},
           {.clock = "2",
            .work = "words, texels; missed texels from the fill buffer",
            .path = "SRAM read",
            .operators = {4 * words * op::mux(32, n), 4 * words * op::mux(32, 2), 4 * op::mux(8, 4),
                          4 * op::mux(8, 2), op::logic(4 * 32)},
            .longest = {op::mux(32, n), op::mux(32, 2), op::mux(8, 4)}}}};
}

}  // namespace deburr::rtl::texture
