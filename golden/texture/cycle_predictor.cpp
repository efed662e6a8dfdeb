// SPDX-License-Identifier: MIT
#include "golden/texture/cycle_predictor.h"

#include <algorithm>

#include "spec/error.h"

namespace deburr::golden::texture {
namespace {

using spec::texture::Parameters;

constexpr std::int32_t kWordBytes = 4, kBeatBytes = 64;

// Latencies of the datasheets.
constexpr int kDerivativeLatency = 3, kLevelLatency = 3, kAddresserLatency = 5;
constexpr std::uint64_t kDecoderLatency = 3;
int axis_latency(const Parameters& p) {
  const bool exact = p.footprint == spec::texture::FootprintRule::kExact;
  if (p.axes == spec::texture::Axes::kTwo) return exact ? 19 : 2;
  return exact ? 22 : 8;
}
int axis_interval(const Parameters& p) {
  return p.axes == spec::texture::Axes::kTwo ? 1 : p.axis_cycles;
}
int log2_latency(const Parameters& p) {
  return p.log2 == spec::texture::Log2Rule::kMitchell ? 1 : 3;
}
std::size_t stages_before_walking(const Parameters& p) {
  return p.count == spec::texture::CountRule::kAny ? 2 : 1;
}
std::uint64_t filter_latency(const Parameters& p) {
  return p.srgb_output == spec::texture::SrgbOutput::kEncoded ? 9 : 8;
}

// Cycles in which a line occupies the data bus; 0: no limit.
std::int32_t transfer_of(const Parameters& p, const MemoryTiming& memory) {
  if (memory.bytes_per_cycle == 0) return 0;
  return (p.cache_line_bytes + memory.bytes_per_cycle - 1) / memory.bytes_per_cycle;
}

// The same, rounded down, as the depth of the FIFO counts it.
std::int32_t whole_transfer(const Parameters& p, const MemoryTiming& memory) {
  return memory.bytes_per_cycle == 0 ? 1 : std::max(1, p.cache_line_bytes / memory.bytes_per_cycle);
}

Parameters resolved(Parameters p, const MemoryTiming& memory) {
  if (p.cache_fifo_depth == 0) {
    p.cache_fifo_depth = memory.latency + 4 * whole_transfer(p, memory) + 3;
    if (p.width > 1) p.cache_fifo_depth += 16;
    if (p.decode == spec::texture::Decode::kBefore)
      p.cache_fifo_depth += 6;  // its fills come later
  }
  if (p.cache_outstanding == 0) {
    const std::int64_t lines = (std::int64_t{32} * p.width * (memory.latency + 12) + 111) / 112;
    p.cache_outstanding = static_cast<std::int32_t>(
        std::clamp<std::int64_t>((lines + 3) / 4 * 4, 8, spec::texture::kMostOutstanding));
  }
  if (p.cache_decoders == 0) p.cache_decoders = p.width == 1 ? 4 : 6;
  if (p.cache_compressed_lines == 0) p.cache_compressed_lines = 16;
  return p;
}

template <class T, std::size_t N>
struct Distinct {
  std::array<T, N> items;  // not cleared: only the first `count` are read
  std::size_t count = 0;
  bool add(const T& item) {  // false: known
    if (std::find(items.begin(), items.begin() + count, item) != items.begin() + count)
      return false;
    items[count++] = item;
    return true;
  }
};
// A group of 4 requests has up to 16 texels; a block has up to 4 words.
using Lines = Distinct<std::uint32_t, 16>;
using Blocks = Distinct<std::uint64_t, 16>;  // address and format
using Words = Distinct<std::uint64_t, 64>;   // line and word
using BankCounts = std::array<std::uint8_t, spec::texture::kMostLineBanks *
                                                spec::texture::kMostCacheLineBytes / kWordBytes>;

std::uint64_t word_number(std::uint32_t line, std::uint32_t word) {
  constexpr std::uint32_t kMostWords = spec::texture::kMostCacheLineBytes / kWordBytes;
  return std::uint64_t{line} * kMostWords + word;
}

void add_block(Blocks& blocks, const CacheRequest& request, std::size_t texel) {
  if (!spec::texture::is_compressed(request.format)) return;
  blocks.add(std::uint64_t{request.addresses[texel]} << 8 |
             static_cast<std::uint64_t>(request.format));
}

}  // namespace

CyclePredictor::CyclePredictor(const Parameters& parameters, const MemoryTiming& memory)
    : parameters_(resolved(parameters, memory)),
      memory_(memory),
      width_(static_cast<Count>(parameters.width)),
      cache_(parameters),
      derivative_(kDerivativeLatency),
      axis_(axis_latency(parameters), axis_interval(parameters)),
      log2_(log2_latency(parameters)),
      level_(kLevelLatency),
      addresser_(kAddresserLatency),
      before_walking_(stages_before_walking(parameters)),
      transfer_(static_cast<Cycle>(transfer_of(parameters, memory))),
      beats_(static_cast<Cycle>(std::max(1, parameters.cache_line_bytes / kBeatBytes))) {
  fifo_.depth = static_cast<std::size_t>(parameters_.cache_fifo_depth);
  if (cache_.decodes_before())
    compressed_lines_.resize(static_cast<std::size_t>(parameters_.cache_compressed_lines));
}

void CyclePredictor::add(std::span<const CacheRequest> quad) {
  const auto most = static_cast<std::uint32_t>(parameters_.fragments);
  std::uint32_t fragments = 0;
  Count count = 0;
  for (std::size_t i = 0; i < quad.size(); ++i) {
    ++count;
    if (quad[i].last) ++fragments;
    const bool ends = fragments == most || i + 1 == quad.size();
    waiting_.push({quad[i], ends && fragments < most});
    if (!ends) continue;
    source_.push(count);
    fragments = count = 0;
  }
  if (quad.empty()) source_.push(0);
  requests_ += quad.size();
  constexpr std::size_t kEnoughTokens = 64;
  while (source_.size() > kEnoughTokens) step();
}

CyclePrediction CyclePredictor::finish() {
  while (!idle()) step();
  // The DataStage pushes in the next cycle, and the FilterPipeline pops in the one after it.
  return {last_left_ + 2 + filter_latency(parameters_),
          requests_,
          groups_,
          lines_,
          memory_lines_,
          slots_};
}

bool CyclePredictor::idle() const {
  return source_.empty() && waiting_.empty() && !looking_up_ && !latency_link_.can_pop() &&
         !fifo_.can_pop() && read_ == 0 && !blocks_.can_pop();
}

// Consumers first.
void CyclePredictor::step() {
  block_decoder();
  data_stalls_[cycle_ % 4] = data_stage();
  latency_fifo();
  memory_port();
  if (cache_.decodes_before()) block_fetcher();
  miss_queue();
  tag_stalls_[cycle_ % 2] = tag_stage();
  if (width_ > 1) group_former();
  advance(addresser_, samples_, texels_);
  sample_walker();
  advance(level_, logs_, levels_);
  advance(log2_, footprints_, logs_);
  advance(axis_, derivatives_, footprints_);
  derivative_unit();
  ++cycle_;
}

// ---- address unit -------------------------------------------------------------------------------

void CyclePredictor::derivative_unit() {
  Count& stage = derivative_.stage[derivative_.next];
  if (stage != 0) {
    if (!derivatives_.can_push(cycle_)) return;
    derivatives_.push(stage);
  }
  stage = 0;
  if (!source_.empty()) {
    stage = source_.front();
    source_.pop();
  }
  derivative_.next = (derivative_.next + 1) % derivative_.stage.size();
}

void CyclePredictor::advance(Registers& unit, Link<Count>& in, Link<Count>& out) {
  if (unit.stage.empty()) {
    if (in.can_pop() && out.can_push(cycle_)) out.push(in.pop(cycle_));
    return;
  }
  Count& stage = unit.stage[unit.next];
  if (stage != 0) {
    if (!out.can_push(cycle_)) return;
    out.push(stage);
    stage = 0;
  }
  if (unit.busy > 0) --unit.busy;
  if (unit.busy == 0 && in.can_pop()) {
    stage = in.pop(cycle_);
    unit.busy = unit.interval;
  }
  if (++unit.next == unit.stage.size()) unit.next = 0;
}

void CyclePredictor::sample_walker() {
  if (!walking_.empty() && samples_.can_push(cycle_)) {
    Count emitted = 0;
    while (!walking_.empty() && emitted < width_) {
      const Count next = std::min(width_ - emitted, walking_.front());
      emitted += next;
      walking_.front() -= next;
      if (walking_.front() == 0) walking_.pop();
    }
    samples_.push(emitted);
  }
  const std::size_t walking_registers = width_ == 1 ? 1 : 2;
  if (walking_.size() < walking_registers && before_walking_.back() != 0) {
    walking_.push(before_walking_.back());
    before_walking_.back() = 0;
  }
  for (std::size_t i = before_walking_.size(); i-- > 0;) {
    if (before_walking_[i] != 0) continue;
    if (i > 0) {
      std::swap(before_walking_[i], before_walking_[i - 1]);
    } else if (levels_.can_pop()) {
      before_walking_[0] = levels_.pop(cycle_);
    }
  }
}

// ---- groups -------------------------------------------------------------------------------------

CyclePredictor::Place CyclePredictor::place(const CacheRequest& request, std::size_t texel) const {
  const std::uint32_t address = request.addresses[texel];
  const std::uint32_t line = cache_.line_of(request.format, address);
  const bool blocks = spec::texture::is_compressed(request.format);
  if (blocks && cache_.decodes_before()) return {.line = line, .word = request.inside[texel]};
  const auto format = static_cast<std::size_t>(request.format);
  return {.line = line,
          .word = address % cache_.line_bytes() / kWordBytes,
          .words = blocks ? spec::texture::kFormatBlockBytes[format] / kWordBytes : 1u,
          .turned = request.turned[texel / 2]};
}

std::size_t CyclePredictor::bank_of(std::uint32_t line, std::uint32_t word, bool turned) const {
  const auto words = static_cast<std::uint32_t>(parameters_.cache_line_bytes / kWordBytes);
  const std::uint32_t half_tile = parameters_.cache_line_bytes == 32 ? 4 : 8;
  const std::uint32_t line_bank = line % static_cast<std::uint32_t>(parameters_.cache_line_banks);
  return line_bank * words + (word ^ (turned ? half_tile : 0));
}

// Number of requests of the next group; `limit`: what ends it, or null.
CyclePredictor::Count CyclePredictor::longest_group(Cause& limit) {
  limit = nullptr;
  Lines lines;
  Words words;
  Blocks blocks;
  BankCounts reads{};
  const bool decodes_after = parameters_.decode == spec::texture::Decode::kAfter;
  bool too_many_reads = false, too_many_in_a_set = false;
  const Count most = std::min(width_, buffered_);
  for (Count n = 0; n < most; ++n) {
    const Waiting& request = waiting_[grouped_ + n];
    for (std::size_t i = 0; i < 4 && request.valid; ++i) {
      const Place at = place(request, i);
      if (decodes_after) add_block(blocks, request, i);
      for (std::uint32_t word = at.word; word < at.word + at.words; ++word) {
        if (!words.add(word_number(at.line, word))) continue;
        std::uint8_t& count = reads[bank_of(at.line, word, at.turned)];
        too_many_reads |= ++count > parameters_.cache_bank_reads;
      }
      if (!lines.add(at.line)) continue;
      const auto in_set =
          std::count_if(lines.items.begin(), lines.items.begin() + lines.count,
                        [&](auto one) { return (one ^ at.line) % cache_.sets() == 0; });
      too_many_in_a_set |= in_set > parameters_.cache_ways;
    }
    if (n == 0) continue;  // the oldest request always leaves
    if (lines.count > static_cast<std::size_t>(parameters_.cache_lookups)) {
      limit = &Slots::lookups;
    } else if (too_many_reads) {
      limit = &Slots::banks;
    } else if (too_many_in_a_set) {
      limit = &Slots::set;
    } else if (blocks.count > static_cast<std::size_t>(parameters_.cache_decoders)) {
      limit = &Slots::decoders;
    }
    if (limit) return n;
  }
  return most;
}

// Why no group can leave in this cycle.
CyclePredictor::Cause CyclePredictor::blocked_by() const {
  if (buffered_ == 0) return &Slots::starved;
  switch (tag_stalls_[(cycle_ - 1) % 2]) {
    case TagStall::kAllocate:
      return &Slots::allocate;
    case TagStall::kMissQueue:
      return &Slots::miss_queue;
    default:
      break;
  }
  switch (data_stalls_[(cycle_ - 3) % 4]) {
    case DataStall::kWaitFill:
      return &Slots::wait_fill;
    case DataStall::kWriteFill:
      return &Slots::write_fill;
    case DataStall::kBankPass:
      return &Slots::bank_pass;
    case DataStall::kNone:
    case DataStall::kDownstream:  // a group takes a cycle in the BlockDecoder
      break;
  }
  throw spec::CheckFailed("the link to the TagStage is full, and nothing stalled");
}

void CyclePredictor::group_former() {
  if (buffered_ > 0 && group_link_.can_push(cycle_)) {
    Cause cause = nullptr;
    const Count n = longest_group(cause);
    if (!cause) cause = waiting_[grouped_ + n - 1].partial ? &Slots::partial_quad : &Slots::starved;
    slots_.requests += n;
    slots_.*cause += width_ - n;
    for (const Cause one : {&Slots::starved, &Slots::allocate, &Slots::miss_queue,
                            &Slots::wait_fill, &Slots::write_fill, &Slots::bank_pass}) {
      slots_.*one += since_group_.*one;
    }
    since_group_ = {};
    group_link_.push(n);
    grouped_ += n;
    buffered_ -= n;
    ++groups_;
  } else if (groups_ > 0) {
    since_group_.*blocked_by() += width_;
  }
  if (texels_.can_pop() && buffered_ + texels_.tokens.front() <= 2 * width_)
    buffered_ += texels_.pop(cycle_);
}

// ---- cache --------------------------------------------------------------------------------------

CyclePredictor::Group CyclePredictor::look_up(Count count) {
  Lines missed;
  Words words;
  Blocks blocks;
  BankCounts reads{};
  std::uint32_t most_reads = 0;
  for (; count > 0; --count) {
    const CacheRequest& request = waiting_.front();
    const bool decoded = cache_.decodes_before() && spec::texture::is_compressed(request.format);
    std::array<Place, 4> places;
    Lines used;
    for (std::size_t i = 0; i < 4 && request.valid; ++i) {
      places[i] = place(request, i);
      const std::uint32_t line = places[i].line;
      if (!used.add(line) || cache_.lookup(line)) continue;
      missed.add(line);
      fills_.push(
          {line % static_cast<std::uint32_t>(parameters_.cache_line_banks), cache_.fetch(line)});
      if (decoded) continue;
      if (line >= turned_.size()) turned_.resize(2 * std::size_t{line} + 1);
      turned_[line] = places[i].turned;
    }
    for (std::size_t i = 0; i < 4 && request.valid; ++i) {
      const Place& at = places[i];
      add_block(blocks, request, i);
      const auto end = missed.items.begin() + missed.count;
      if (std::find(missed.items.begin(), end, at.line) != end) continue;
      const bool turned = !decoded && turned_[at.line];
      for (std::uint32_t word = at.word; word < at.word + at.words; ++word) {
        if (!words.add(word_number(at.line, word))) continue;
        most_reads = std::max<std::uint32_t>(most_reads, ++reads[bank_of(at.line, word, turned)]);
      }
    }
    waiting_.pop();
  }
  const auto ports = static_cast<std::uint32_t>(parameters_.cache_bank_reads);
  lines_ += missed.count;
  const auto decoders = static_cast<Count>(parameters_.cache_decoders);
  const Count decoding = std::max(1u, (static_cast<Count>(blocks.count) + decoders - 1) / decoders);
  return {(most_reads + ports - 1) / ports, static_cast<std::uint32_t>(missed.count), decoding};
}

CyclePredictor::TagStall CyclePredictor::tag_stage() {
  if (looking_up_) {
    const auto allocations = static_cast<std::uint32_t>(parameters_.cache_allocations);
    if (to_allocate_ > allocations) {
      to_allocate_ -= allocations;
      return TagStall::kAllocate;
    }
    if (!latency_link_.can_push(cycle_)) return TagStall::kFifo;
    if (looked_up_.lines > 0 && !misses_.can_push(cycle_)) return TagStall::kMissQueue;
    latency_link_.push(looked_up_);
    if (looked_up_.lines > 0) misses_.push(looked_up_.lines);
  }
  Link<Count>& in = width_ > 1 ? group_link_ : texels_;
  looking_up_ = in.can_pop();
  if (!looking_up_) return TagStall::kNone;
  const Count count = in.pop(cycle_);
  if (width_ > 1) {
    grouped_ -= count;
  } else {
    ++groups_;
  }
  looked_up_ = look_up(count);
  to_allocate_ = looked_up_.lines;
  return TagStall::kNone;
}

void CyclePredictor::latency_fifo() {
  if (latency_link_.can_pop() && fifo_.can_push(cycle_)) fifo_.push(latency_link_.pop(cycle_));
}

// A FillBuffer entry that is freed in this cycle is reserved in the next one.
void CyclePredictor::miss_queue() {
  const auto entries = static_cast<std::uint64_t>(parameters_.cache_outstanding);
  Link<std::uint64_t>& out = cache_.decodes_before() ? fetches_ : memory_requests_;
  if (sent_ < queued_ && sent_ - used_before_ < entries && out.can_push(cycle_)) out.push(sent_++);
  if (misses_.can_pop() && queued_ - sent_ + misses_.tokens.front() <= entries)
    queued_ += misses_.pop(cycle_);
}

// Beyond its limit of transactions, memory accepts a request at the time of the next response.
void CyclePredictor::memory_port() {
  if (!memory_requests_.can_pop() || cycle_ < port_free_) return;
  const std::uint64_t number = memory_requests_.pop(cycle_);
  ++memory_lines_;
  while (!responses_.empty() && responses_.front() <= cycle_) responses_.pop();
  const bool held = responses_.size() >= static_cast<std::size_t>(memory_.outstanding);
  const Cycle accepted = held ? responses_.front() : cycle_;
  port_free_ = accepted + 1;
  first_byte_ = std::max(accepted + static_cast<Cycle>(memory_.latency), first_byte_ + transfer_);
  const Cycle response = first_byte_ + std::max(transfer_, Cycle{1}) - 1;
  responses_.push(response);
  last_beat_ = std::max(response, last_beat_) + beats_;
  if (cache_.decodes_before()) {
    arriving_.push({number, last_beat_ + 1});
  } else {
    fill(number).arrived = last_beat_ + 1;
  }
}

// The MissQueue pops a response per cycle, so the link to it always has room.
void CyclePredictor::block_fetcher() {
  constexpr std::uint32_t kNone = ~0u;
  const bool popped = !arriving_.empty() && arriving_.front().popped == cycle_;
  const std::uint64_t response = popped ? arriving_.front().fill : 0;
  const bool passed_on = popped && !fill(response).fetch.decoded;
  std::uint32_t leaving = kNone;  // compressed line of the block that leaves the queue
  if (decoding_.back() == 0 || !passed_on) {
    if (decoding_.back() != 0) fill(decoding_.back() - 1).arrived = cycle_ + 1;
    std::shift_right(decoding_.begin(), decoding_.end(), 1);
    decoding_.front() = 0;
    if (!waiting_blocks_.empty()) {
      const std::uint32_t slot = fill(waiting_blocks_.front()).fetch.slot;
      if (compressed_lines_[slot].written < cycle_) {
        decoding_.front() = waiting_blocks_.front() + 1;
        waiting_blocks_.pop();
        --compressed_lines_[slot].blocks;
        leaving = slot;
      }
    }
  }
  if (passed_on) {
    fill(response).arrived = cycle_ + 1;
  } else if (popped) {
    compressed_lines_[fill(response).fetch.slot].written = cycle_;
  }
  if (popped) arriving_.pop();
  if (fetches_.can_pop() && fetch_next(leaving)) fetches_.pop(cycle_);
}

// False: the oldest fill of the link has to wait.
bool CyclePredictor::fetch_next(std::uint32_t leaving) {
  const std::uint64_t number = fetches_.tokens.front();
  const CachePredictor::Fetch& fetch = fill(number).fetch;
  if (fetch.requested) {
    if (!memory_requests_.can_push(cycle_)) return false;
    // A block that waits for this entry needs the line that is in it now.
    if (fetch.decoded && (compressed_lines_[fetch.slot].blocks > 0 || fetch.slot == leaving))
      return false;
    memory_requests_.push(number);
  }
  if (!fetch.decoded) return true;
  CompressedLine& line = compressed_lines_[fetch.slot];
  if (fetch.requested) line.written = ~Cycle{0};
  ++line.blocks;
  waiting_blocks_.push(number);
  return true;
}

CyclePredictor::DataStall CyclePredictor::data_stage() {
  used_before_ = used_;
  if (read_ != 0) {
    if (!blocks_.can_push(cycle_)) return DataStall::kDownstream;
    blocks_.push(read_);
    read_ = 0;
  }
  if (!fifo_.can_pop()) return DataStall::kNone;
  Group& group = fifo_.tokens.front();
  if (group.passes > 1) {
    --group.passes;
    return DataStall::kBankPass;
  }
  group.passes = 0;
  const auto writes = static_cast<std::uint64_t>(parameters_.cache_fill_writes);
  std::uint32_t written = 0;  // line banks
  while (group.lines > 0 && used_ - used_before_ < writes) {
    const Fill& fill = fills_.front();
    Cycle& bank_used = bank_used_[used_ % writes];
    // Read after its arrival and once the output register is free; used in the cycle after that.
    if (fill.arrived >= cycle_ || std::max(fill.arrived + 1, bank_used) >= cycle_) break;
    if ((written >> fill.line_bank & 1) != 0) break;
    written |= 1u << fill.line_bank;
    bank_used = cycle_;
    fills_.pop();
    ++used_;
    --group.lines;
  }
  if (group.lines > 0) return used_ > used_before_ ? DataStall::kWriteFill : DataStall::kWaitFill;
  if (parameters_.decode == spec::texture::Decode::kAfter) read_ = group.decoding;
  fifo_.pop(cycle_);
  last_left_ = cycle_;
  return DataStall::kNone;
}

// The FilterPipeline accepts every token, so this unit never stalls.
void CyclePredictor::block_decoder() {
  if (!blocks_.can_pop() || cycle_ < decoder_free_) return;
  decoder_free_ = cycle_ + blocks_.pop(cycle_);
  // The pipeline pops this token when it would pop one that leaves the DataStage in this cycle.
  last_left_ = decoder_free_ - 1 + kDecoderLatency - 2;
}

}  // namespace deburr::golden::texture
