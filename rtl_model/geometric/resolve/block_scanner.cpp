// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/resolve/block_scanner.h"

#include <bit>

namespace deburr::rtl::geometric {

using spec::geometric::kBlocksInWord;

BlockScanner::BlockScanner(const sc_core::sc_module_name& name, ClockDomain& clock,
                           const spec::geometric::Parameters& p,
                           const ReadPort<TouchedWord>& touched)
    : Unit(name, clock),
      touched_port_(touched),
      above_("touched_above", {.words = static_cast<std::uint64_t>((p.line_pixels + 511) / 512),
                               .word_bits = kBlocksInWord,
                               .kind = MemoryKind::kFlops,
                               .latency = 0,
                               .content = "touched bits of the block row above"}) {}

// Stage 2.
void BlockScanner::load(Cycle cycle) {
  const FrameConfiguration& configuration = configuration_in.read(cycle);
  left_ = touched_port_.at(cycle, taken_);
  above_word_ = row_ == 0 ? TouchedWord{} : above_read_.now(cycle, column_);
  above_write_.write(cycle, column_, left_);
  block_x_ = column_ * kBlocksInWord;
  block_y_ = row_;
  ++taken_;
  if (++column_ == configuration.words_across) {
    column_ = 0;
    ++row_;
  }
}

Activity BlockScanner::tick(Cycle cycle) {
  if (phase_in.read(cycle) != Phase::kResolve) {
    if (ended_) reset();
    return kIdle;
  }
  if (ended_) return kIdle;
  const std::uint32_t words = configuration_in.read(cycle).touched_words;
  const bool any = left_.bits[0] | left_.bits[1];
  const bool finished = !any && taken_ == words;
  if ((any || finished) && !blocks_out.can_push(cycle)) return kStalledDownstream;
  if (finished) {
    blocks_out.emplace(cycle).end = ended_ = true;
    return kBusy;
  }
  if (any) {
    const std::size_t half = left_.bits[0] ? 0 : 1;
    const std::uint32_t bit = static_cast<std::uint32_t>(64 * half) +
                              static_cast<std::uint32_t>(std::countr_zero(left_.bits[half]));
    left_.bits[half] &= left_.bits[half] - 1;
    TouchedBlock& block = blocks_out.emplace(cycle);
    block.x = static_cast<std::uint16_t>(block_x_ + bit);
    block.y = static_cast<std::uint16_t>(block_y_);
    block.above = above_word_.get(bit);
    block.end = false;
  }
  if ((left_.bits[0] | left_.bits[1]) == 0 && taken_ != asked_) load(cycle);
  if (asked_ != words && asked_ == taken_) touched_port_.read(cycle, asked_++);
  return kBusy;
}

void BlockScanner::reset() {
  asked_ = taken_ = column_ = row_ = 0;
  left_ = above_word_ = {};
  ended_ = false;
}

Datasheet BlockScanner::datasheet() {
  constexpr std::uint32_t kWord = spec::geometric::kBlocksInWord;
  return {
      .unit = "BlockScanner",
      .does = "Finds the touched blocks of a frame, in raster order of blocks.",
      .latency = {3, "3 from the start to the first block"},
      .interval = {1, "one cycle per touched block, at least 1 per word of 128 blocks"},
      .stages = {{.clock = "1",
                  .work = "address of the word",
                  .operators = {op::add(17), op::equal(17), op::mux(16, 2)},
                  .registers = 17},
                 {.clock = "2",
                  .work = "word",
                  .path = "SRAM read",
                  .operators = {op::add(17), op::equal(17), op::add(5), op::equal(5), op::add(12),
                                op::mux(kWord, 2), op::logic(20)},
                  .longest = {op::mux(kWord, 2)},
                  .registers = 2 * kWord + 17 + 5 + 12 + 4 + 11 + 1},
                 {.clock = "3",
                  .work = "first set bit of 128, in groups of 16",
                  .operators = {op::logic(kWord), op::priority(8), op::mux(16, 8), op::priority(16),
                                op::mux(1, kWord), op::logic(2 * kWord)},
                  .longest = {op::logic(16), op::priority(8), op::mux(16, 8), op::priority(16)}}}};
}

}  // namespace deburr::rtl::geometric
