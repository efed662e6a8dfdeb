// SPDX-License-Identifier: MIT
#include "rtl_model/texture/block_fetcher.h"

#include <algorithm>
#include <bit>
#include <string>

#include "rtl_model/texture/cache_units.h"
#include "rtl_model/texture/datasheets.h"
#include "rtl_model/texture/miss_queue.h"
#include "spec/texture/registers.h"

namespace deburr::rtl::texture {
namespace {

constexpr std::uint32_t kLineNumberBits = 26;  // of memory

std::uint32_t bits_of(std::uint32_t count) {
  return static_cast<std::uint32_t>(std::bit_width(count - 1));
}
std::uint32_t entries(const spec::texture::Parameters& p) {
  return static_cast<std::uint32_t>(p.cache_outstanding);
}
std::uint32_t waiting_bits(const spec::texture::Parameters& p) {
  return bits_of(entries(p)) + bits_of(compressed_lines(p)) + 3 + 3;
}

// Flip-flops with one word per memory line.
MemoryShape flops_by_line(const spec::texture::Parameters& p, std::uint32_t bits,
                          const char* content) {
  return {.words = compressed_lines(p),
          .word_bits = bits,
          .kind = MemoryKind::kFlops,
          .latency = 0,
          .content = content};
}
// All tags are compared at once.
MemoryShape tag_shape(const spec::texture::Parameters& p) {
  MemoryShape shape = flops_by_line(p, kLineNumberBits + 1,
                                    "memory lines that are present, each with a comparator");
  shape.banks = shape.span = compressed_lines(p);
  return shape;
}
MemoryShape arrived_shape(const spec::texture::Parameters& p) {
  MemoryShape shape = flops_by_line(p, 1, "per memory line: has it arrived?");
  shape.write_ports = 2;
  return shape;
}
MemoryShape uses_shape(const spec::texture::Parameters& p) {
  MemoryShape shape = flops_by_line(p, static_cast<std::uint32_t>(std::bit_width(entries(p))),
                                    "per memory line: blocks that wait for it or for their turn");
  shape.read_ports = shape.write_ports = 2;
  return shape;
}

}  // namespace

std::uint32_t BlockFetcher::tag_bits(const spec::texture::Parameters& p) {
  return std::max(bits_of(entries(p)), bits_of(compressed_lines(p))) + 1;
}

BlockFetcher::BlockFetcher(const sc_core::sc_module_name& name, ClockDomain& clock,
                           const spec::texture::Parameters& p, ControlRegisters& registers)
    : Unit(name, clock),
      registers_(registers),
      rule_(p.bc),
      lines_tag_(1U << (tag_bits(p) - 1)),
      lines_("lines",
             {.words = compressed_lines(p),
              .word_bits = kLineBytes * 8,
              .kind = MemoryBase::kind_for(std::uint64_t{compressed_lines(p)} * kLineBytes * 8),
              .latency = 1,
              .content = "lines of memory, of which blocks are decoded"}),
      tags_("tags", tag_shape(p)),
      arrived_("arrived", arrived_shape(p)),
      uses_("uses", uses_shape(p)),
      queue_("queue", {.words = entries(p),
                       .word_bits = waiting_bits(p),
                       .kind = MemoryKind::kFlops,
                       .latency = 0,
                       .content = "blocks to decode, in the order of the misses"}),
      line_in_use_(declare_stall("line_in_use",
                                 "a waiting block needs the memory line that would be replaced")),
      wait_memory_(
          declare_stall("wait_memory", "waits for lines from memory, nothing else to do")) {
  tags_.clear(kAbsent);
}

// In the order of the page; a response is looked at first, since it may have priority.
Activity BlockFetcher::tick(Cycle cycle) {
  const bool responds = responses_in.can_pop(cycle);
  if (waiting_ == 0 && pipe_.empty() && !responds && !lines_in.can_pop(cycle)) return kIdle;
  const bool passes = responds && is_other(responses_in.front(cycle)) && fills_out.can_push(cycle);
  left_ = kAbsent;
  const bool held = pipe_.leaves() && (passes || !fills_out.can_push(cycle));
  const bool decodes = !held && decode(cycle);
  const bool receives = responds && receive(cycle, passes);
  const Activity line = take_line(cycle, replaces_used_lines && !receives);
  if (decodes || receives || line == kBusy) return kBusy;
  if (line != kIdle) return line;
  if (held || responds) return kStalledDownstream;
  return waiting_ != 0 ? wait_memory_ : kIdle;
}

// The whole decoder advances by one stage. Returns false if it is empty and stays so.
inline bool BlockFetcher::decode(Cycle cycle) {
  const bool worked = !pipe_.empty();
  pipe_.move();
  if (const Decoding* done = pipe_.at(kStages)) {
    MemoryResponse& fill = fills_out.emplace(cycle);
    fill = {};
    fill.tag = done->block.entry;
    for (std::size_t i = 0; i < fill.data.size(); ++i)
      fill.data[i] = static_cast<std::uint8_t>(done->texel[i / 4] >> 8 * (i % 4));
  }
  if (Decoding* beat = pipe_.at(2)) read_texels(cycle, *beat);
  if (waiting_ == 0) return worked;
  const Waiting& oldest = oldest_.now(cycle, head_);
  if (has_arrived_.now(cycle, oldest.line) == 0) return worked;
  Decoding& beat = pipe_.enter();
  beat.block = oldest;
  beat.read_at = cycle;
  left_ = oldest.line;
  line_read_.read(cycle, left_);
  head_ = head_ + 1 == queue_.words() ? 0 : head_ + 1;
  --waiting_;
  return true;
}

// Computes the remaining stages at once.
void BlockFetcher::read_texels(Cycle cycle, Decoding& beat) {
  const Line& line = line_read_.at(cycle, beat.block.line, beat.read_at);
  const spec::texture::Format format = format_of(beat.block.codec);
  const Block block = load_block(&line[8 * std::size_t{beat.block.part}], beat.block.codec);
  const block_colours::Palette palette =
      block_colours::counted_palette(block, format, rule_, fault, kinds);
  for (std::uint32_t i = 0; i < beat.texel.size(); ++i) {
    const std::uint32_t x = i % 4, y = i / 4;
    beat.texel[i] = block_colours::select(
        palette, block_colours::selectors(block, format, x, y, fault), format, x, y);
  }
  ++blocks;
}

inline bool BlockFetcher::receive(Cycle cycle, bool passes) {
  const MemoryResponse& response = responses_in.front(cycle);
  if (is_other(response)) {
    if (!passes) return false;
    MemoryResponse& fill = fills_out.emplace(cycle);
    fill = response;
    fill.address = 0;
    fill.status = MemoryStatus::kOk;
  } else {
    const std::uint32_t line = response.tag - lines_tag_;
    line_written_.write(cycle, line, response.data);
    arrives_.write(cycle, line, 1);
  }
  // After an error, the port delivers zeros.
  if (response.status != MemoryStatus::kOk) {
    ++memory_errors;
    registers_.set_sticky(spec::texture::reg::kStatusMemoryError);
  }
  responses_in.pop(cycle);
  return true;
}

// Number of the present line, or kAbsent.
inline std::uint32_t BlockFetcher::find(Cycle cycle, std::uint32_t memory_line) {
  const auto words = static_cast<std::uint32_t>(tags_.words());
  tags_read_.read(cycle, 0, words);
  for (std::uint32_t i = 0; i < words; ++i)
    if (tags_read_.at(cycle, i) == memory_line) return i;
  return kAbsent;
}

// Pops a line of the cache, and counts the blocks of memory lines: one that leaves still counts in
// its cycle.
inline Activity BlockFetcher::take_line(Cycle cycle, bool may_replace) {
  entered_ = kAbsent;
  if (!lines_in.can_pop(cycle)) {
    if (left_ != kAbsent) unused_.write(cycle, left_, uses_left_.now(cycle, left_) - 1);
    return kIdle;
  }
  const Activity activity = accept(cycle, lines_in.front(cycle), may_replace);
  if (activity == kBusy) lines_in.pop(cycle);
  if (entered_ == left_) return activity;
  if (left_ != kAbsent) unused_.write(cycle, left_, uses_left_.now(cycle, left_) - 1);
  if (entered_ != kAbsent) used_.write(cycle, entered_, uses_of_entered_ + 1);
  return activity;
}

// A block, or a line of another texture.
inline Activity BlockFetcher::accept(Cycle cycle, const MemoryRequest& asked, bool may_replace) {
  const auto number = static_cast<std::uint32_t>(asked.address);
  const auto codec = static_cast<std::uint8_t>(number >> kBlockLineBits);
  if (codec == 0) {
    if (!requests_out.can_push(cycle)) return kStalledDownstream;
    request(cycle, number, asked.tag);
    return kBusy;
  }
  const std::uint32_t address = number << block_log2(codec), memory_line = address / kLineBytes;
  std::uint32_t line = find(cycle, memory_line);
  if (line != kAbsent) {
    uses_of_entered_ = uses_before_.now(cycle, line);
  } else {
    if (!requests_out.can_push(cycle)) return kStalledDownstream;
    uses_of_entered_ = uses_before_.now(cycle, next_);
    if (uses_of_entered_ != 0 && !(may_replace && arrived_.backdoor(next_) != 0))
      return line_in_use_;
    line = next_;
    next_ = next_ + 1 == tags_.words() ? 0 : next_ + 1;
    tag_written_.write(cycle, line, memory_line);
    replaced_.write(cycle, line, 0);
    request(cycle, memory_line, lines_tag_ + line);
    ++memory_lines;
  }
  const auto entries = static_cast<std::uint32_t>(queue_.words());
  const std::uint32_t place = head_ + waiting_++;
  newest_.write(cycle, place < entries ? place : place - entries,
                {asked.tag, static_cast<std::uint8_t>(line),
                 static_cast<std::uint8_t>(address / 8 % 8), codec});
  entered_ = line;
  return kBusy;
}

inline void BlockFetcher::request(Cycle cycle, std::uint32_t memory_line, std::uint32_t tag) {
  MemoryRequest& request = requests_out.emplace(cycle);
  request.address = std::uint64_t{memory_line} * kLineBytes;
  request.tag = tag;
  request.lines = 1;
  request.write = false;
}

void BlockFetcher::invalidate() {
  if (!keeps_lines) tags_.clear(kAbsent);
}

void BlockFetcher::reset() {
  tags_.clear(kAbsent);
  arrived_.clear();
  uses_.clear();
  pipe_.reset();
  head_ = waiting_ = next_ = 0;
}

Datasheet BlockFetcher::datasheet(const spec::texture::Parameters& parameters) {
  spec::texture::Parameters p = parameters;
  p.cache_outstanding = MissQueue::entries(p, {});
  const std::uint32_t lines = compressed_lines(p), entry = bits_of(entries(p)),
                      line = bits_of(lines), tag = tag_bits(p),
                      uses = static_cast<std::uint32_t>(std::bit_width(entries(p)));
  const std::uint32_t request = 32 + 7 + tag;
  constexpr std::uint32_t n = 16;  // texels
  // What the stages pass on besides the block: its entry, its format, and valid.
  const std::uint32_t kept = entry + 3 + 1;
  auto [ends, colours] = block_colours::stages(p.bc, "3", "4", op::mux(128, 8));
  ends.registers += kept;
  colours.registers += kept;
  return {.unit = "BlockFetcher",
          .variant = chosen("cache.compressed_lines", lines) + ", " + std::to_string(entries(p)) +
                     " entries, " + chosen("bc", spec::texture::kBlockRuleNames, p.bc),
          .does = "Fetches lines of memory and decodes the cache's lines from them.",
          .latency = {5, "5, of a block whose memory line is present"},
          .interval = {1, "one line, one response and one decoded line per cycle"},
          .stages = {{.clock = "1",
                      .work = "memory line of a block: present or replaced; requests, responses, "
                              "queue of blocks",
                      .operators = {lines * op::equal(kLineNumberBits + 1), 4 * op::add(entry),
                                    op::add(line), 2 * op::add(uses), op::mux(request, 2),
                                    op::mux(kLineBytes * 8, 2), op::logic(2 * lines + 60)},
                      .longest = {op::equal(kLineNumberBits + 1), op::priority(lines),
                                  op::mux(uses, lines), op::mux(request, 2)},
                      .registers = 2 * entry + 1 + line},
                     {.clock = "2",
                      .work = "oldest block, read of its memory line",
                      .longest = {op::mux(waiting_bits(p), entries(p)), op::mux(1, lines),
                                  op::mux(kLineBytes * 8, lines)},
                      .registers = kept + 3},
                     ends,
                     colours,
                     {.clock = "5",
                      .work = "sixteen texels",
                      .operators = block_colours::of_texels(n),
                      .longest = {op::mux(9, 4), 2 * op::add(11), op::logic(block_colours::kClamp),
                                  op::mux(32, 3)}}},
          .formats = "blocks of 8 or 16 bytes, texels of four channels U8.0."};
}

}  // namespace deburr::rtl::texture
