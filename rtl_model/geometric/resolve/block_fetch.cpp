// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/resolve/block_fetch.h"

#include <algorithm>
#include <array>
#include <bit>
#include <string>

#include "rtl_model/geometric/common/hardware_lists.h"
#include "spec/geometric/records.h"

namespace deburr::rtl::geometric {
namespace {

constexpr std::uint32_t kColourPlace = 1u << (kPlaceBits - 1);

}  // namespace

BlockFetch::BlockFetch(const sc_core::sc_module_name& name, ClockDomain& clock,
                       const spec::geometric::Parameters& p, const ReadPort<std::uint32_t>& tags,
                       const ReadPort<BlockWeights>& weights, const ColourStore::Filler& colours)
    : Unit(name, clock),
      keeps_lines_(p.colour_lines > 0),
      places_(p),
      tag_port_(tags),
      data_port_(weights),
      weights_("resolve_weights", p.resolve_lines / 2, 8 * spec::geometric::kLineBytes,
               "weights in flight to the resolve"),
      colours_(colours),
      fifo_("latency_fifo", static_cast<std::uint32_t>(p.resolve_lines / 2)),
      stalled_weights_(declare_stall("weights", "a block of weights has not arrived")),
      stalled_colours_(declare_stall("colours", "no entry for a line of colours is free")) {}

// Stages 2 and 1.
Activity BlockFetch::look_up(Cycle cycle) {
  if (looking_) {
    if (!fifo_.can_push(cycle)) return kStalledDownstream;
    Lookup lookup{block_, 0, true};
    if (!block_.end) {
      lookup.index = static_cast<std::uint16_t>(places_.index_of(block_.x, block_.y));
      lookup.cached =
          tag_port_.at(cycle, lookup.index, looked_) == WeightPlaces::tag_of(block_.x, block_.y);
      if (!lookup.cached) {
        if (!weights_.can_reserve(cycle)) return stalled_weights_;
        if (!memory.requests_out.can_push(cycle)) return kStalledDownstream;
        const FrameConfiguration& configuration = configuration_in.read(cycle);
        memory.read(
            cycle,
            configuration.weight_base +
                spec::geometric::kLineBytes * (block_.y * configuration.blocks_across + block_.x),
            weights_.reserve());
        ++weights_read;
      }
    }
    fifo_.push(cycle, lookup);
    looking_ = false;
  }
  if (!blocks_in.can_pop(cycle)) return kIdle;
  block_ = blocks_in.take(cycle);
  looking_ = true;
  looked_ = cycle;
  if (!block_.end) tag_port_.read(cycle, places_.index_of(block_.x, block_.y));
  return kBusy;
}

// The lines (bits of `lines`) that a pixel needs with its weights.
std::uint32_t BlockFetch::lines_of_pixel(bool tiled, const BlockToken& block, std::uint32_t pixel,
                                         bool horizontal) {
  const std::uint32_t x = pixel & 3, y = pixel >> 2;
  const spec::geometric::Weights& w = block.weights[pixel];
  const bool first = w[horizontal ? 2 : 0] != 0, second = w[horizontal ? 3 : 1] != 0;
  const std::uint32_t row = tiled ? 1 : y + 1;
  const auto bit = [](std::uint32_t i, std::uint32_t j) { return 1u << (3 * i + j); };
  std::uint32_t lines = bit(row, 1);
  if (horizontal) {
    const std::uint32_t edge = tiled ? 0 : block.x & 3;  // position in its memory line
    if (first && x == 0 && edge == 0) lines |= bit(row, 0);
    if (second && x == 3 && (tiled || edge == 3)) lines |= bit(row, 2);
  } else {
    if (first && (!tiled || y == 0)) lines |= bit(row - 1, 1);
    if (second && (!tiled || y == 3)) lines |= bit(row + 1, 1);
  }
  return lines;
}

// Weights from memory may have any value.
void BlockFetch::limit(const FrameConfiguration& configuration, BlockToken& block) {
  for (spec::geometric::Weights& weights : block.weights)
    for (std::uint8_t& weight : weights)
      weight = std::min<std::uint8_t>(weight, spec::geometric::kMaxWeight);
  // Only blocks at the frame border have pixels without a neighbour.
  const auto last_x = static_cast<std::int32_t>(configuration.width) - 1,
             last_y = static_cast<std::int32_t>(configuration.height) - 1;
  if (block.x != 0 && block.y != 0 && 4 * block.x + 3 < last_x && 4 * block.y + 3 < last_y) return;
  for (std::int32_t pixel = 0; pixel < spec::geometric::kBlockPixels; ++pixel) {
    const std::int32_t x = 4 * block.x + (pixel & 3), y = 4 * block.y + (pixel >> 2);
    const bool inside = x <= last_x && y <= last_y;
    const std::array<bool, 4> may = {inside && y != 0, inside && y != last_y, inside && x != 0,
                                     inside && x != last_x};
    for (std::size_t direction = 0; direction < may.size(); ++direction)
      if (!may[direction]) block.weights[static_cast<std::size_t>(pixel)][direction] = 0;
  }
}

// Stage 4.
void BlockFetch::choose(const FrameConfiguration& configuration, BlockToken& block) {
  limit(configuration, block);
  block.blended = block.horizontal = 0;
  block.lines = 0;
  for (std::uint32_t pixel = 0; pixel < spec::geometric::kBlockPixels; ++pixel) {
    const auto& [up, down, left, right] = block.weights[pixel];
    if ((up | down | left | right) == 0) continue;
    const bool horizontal = left + right > up + down;
    block.blended = static_cast<std::uint16_t>(block.blended | 1u << pixel);
    block.horizontal =
        static_cast<std::uint16_t>(block.horizontal | std::uint32_t{horizontal} << pixel);
    block.lines |= lines_of_pixel(configuration.tiled, block, pixel, horizontal);
  }
}

// Handles the first remaining line: kept, or requested. kIdle: done.
Activity BlockFetch::ask_for_line(Cycle cycle) {
  const FrameConfiguration& configuration = configuration_in.read(cycle);
  const auto line = static_cast<std::uint32_t>(std::countr_zero(to_ask_));
  const std::uint32_t i = line / 3, j = line % 3;
  const std::uint32_t u = (configuration.tiled ? asking_.x : asking_.x >> 2) + j - 1,
                      v = (configuration.tiled ? asking_.y : asking_.y * 4u) + i - 1;
  const std::uint32_t tag = ColourStore::Filler::tag_of(configuration.tiled, u, v);
  if (const auto kept = colours_.find(tag)) {
    if (!colours_.can_order_kept(cycle)) return stalled_colours_;
    colours_.order_kept(cycle, *kept);
    ++lines_kept;
  } else {
    if (!colours_.can_order_read(cycle)) return stalled_colours_;
    if (!memory.requests_out.can_push(cycle)) return kStalledDownstream;
    const ColourStore::Filler::Ordered ordered = colours_.order_read(cycle, tag);
    memory.read(cycle,
                (configuration.frame_copy ? configuration.copy_base : configuration.colour_base) +
                    configuration.line_offset(u, v),
                ordered.place | kColourPlace);
    ++lines_read;
    lines_replaced += ordered.replaces;
  }
  to_ask_ &= to_ask_ - 1;
  return kIdle;
}

// Stage 5; kIdle: nothing is left to do.
Activity BlockFetch::ask(Cycle cycle) {
  if (!is_asking_) return kIdle;
  if (!handed_ && !blocks_out.can_push(cycle)) return kStalledDownstream;
  if (to_ask_ != 0)
    if (const Activity asked = ask_for_line(cycle); asked != kIdle) return asked;
  if (!handed_) blocks_out.push(cycle, asking_);
  handed_ = true;
  if (to_ask_ == 0) is_asking_ = false;
  return kBusy;
}

// Stages 5 to 3.
Activity BlockFetch::deliver(Cycle cycle) {
  const Activity asked = ask(cycle);
  bool did = asked == kBusy;
  if (is_fetched_ && !is_asking_) {
    if (!token_.end) {
      if (fetched_.cached) token_.weights = data_port_.at(cycle, fetched_.index);
      choose(configuration_in.read(cycle), token_);
    }
    asking_ = token_;
    to_ask_ = token_.lines;
    is_fetched_ = handed_ = false;
    is_asking_ = did = true;
  }
  if (is_fetched_ || !fifo_.can_pop(cycle)) return did ? kBusy : asked;
  const Lookup& next = fifo_.front(cycle);
  if (!next.cached) {
    if (!weights_.ready(cycle)) return did ? kBusy : stalled_weights_;
    token_.weights = weights_.line(cycle);
    weights_.release(cycle);
  } else if (!next.block.end) {
    data_port_.read(cycle, next.index);
  }
  token_.x = next.block.x;
  token_.y = next.block.y;
  token_.above = next.block.above;
  token_.end = next.block.end;
  token_.lines = 0;
  fetched_ = next;
  fifo_.pop(cycle);
  is_fetched_ = true;
  return kBusy;
}

Activity BlockFetch::tick(Cycle cycle) {
  if (keeps_lines_ && phase_in.read(cycle) == Phase::kBegin) colours_.clear();
  const Activity data = deliver(cycle);
  const Activity tags = look_up(cycle);
  bool did = data == kBusy || tags == kBusy;
  if (memory.responses_in.can_pop(cycle)) {
    const MemoryResponse& response = memory.responses_in.take(cycle);
    if (response.tag & kColourPlace) {
      colours_.fill(cycle, response.tag & (kColourPlace - 1), response.data);
    } else {
      BlockWeights block;
      for (std::size_t i = 0; i < block.size(); ++i)
        std::copy_n(response.data.begin() + static_cast<std::ptrdiff_t>(4 * i), 4,
                    block[i].begin());
      weights_.fill(cycle, response.tag, block);
    }
    did = true;
  }
  if (!weights_.empty()) weights_.read_ahead(cycle);
  return did ? kBusy : data != kIdle ? data : tags;
}

void BlockFetch::reset() {
  colours_.reset();
  weights_.reset();
  fifo_.reset();
  looking_ = is_fetched_ = is_asking_ = handed_ = false;
  to_ask_ = 0;
}

Datasheet BlockFetch::datasheet(const spec::geometric::Parameters& p) {
  const auto kept = static_cast<std::uint32_t>(p.colour_lines);
  const std::uint32_t
      keeps = kept > 0,
      index =
          bits_below(spec::geometric::kCacheLineCount[static_cast<std::size_t>(p.weight_blocks)]),
      block = Payload::of<TouchedBlock>().bits(), token = Payload::of<BlockToken>().bits();
  constexpr std::uint32_t kBlock = 8 * spec::geometric::kLineBytes, kTag = WeightPlaces::kTagBits;
  const Hardware fills = fill_store(p.resolve_lines / 2);
  return {
      .unit = "BlockFetch",
      .variant = keeps ? "with `colour_lines`" : "without `colour_lines`",
      .does = "Fetches the weights of a touched block and the colour lines that it needs.",
      .latency = {5, "5, plus the wait for weights"},
      .interval = {1, "max(1, needed lines) per block"},
      .stages =
          {{.clock = "1",
            .work = "tag of the block, product of its address",
            .operators = {op::mux(index, 2), op::multiply(11, 12), op::add(23)},
            .longest = {op::multiply(11, 12), op::add(23)},
            .registers = block + 23 + 1},
           {.clock = "2",
            .work = "read request for weights; FIFO",
            .path = "SRAM read",
            .operators = built({op::equal(kTag), op::add(26), op::logic(20)}, fills.operators),
            .longest = {op::equal(kTag), op::logic(8)},
            .registers = fills.registers},
           {.clock = "3",
            .work = "read of cached weights, or the arrived line; product of the lines' addresses",
            .operators = {op::mux(index, 2), op::mux(11, 2), op::mux(10, 2), op::multiply(11, 10)},
            .longest = {op::mux(11, 2), op::multiply(11, 10)},
            .registers = kBlock + block + 1 + 22 + 1},
           {.clock = "4",
            .work = "limits of the weights, axis, needed lines",
            .path = "SRAM read",
            .operators = {op::mux(kBlock, 2), op::logic(64 * 9), 2 * op::equal(11),
                          2 * op::compare(13), op::logic(200), op::logic(kBlock), 32 * op::add(8),
                          16 * op::compare(9), op::logic(16 * 50), op::add(26)},
            .longest = {op::mux(kBlock, 2), op::logic(9), op::add(8), op::compare(9),
                        op::logic(24)},
            .registers = token + 18 + 26 + 2},
           {.clock = "5",
            .work = std::string(keeps ? "kept lines; requests of the others" : "requests") +
                    ", one line per cycle, the block with the first",
            .operators =
                built({op::priority(18), op::logic(40), op::add(13), op::mux(14, 6), op::add(11),
                       op::add(13), op::mux(24, 2), 2 * op::add(26), op::mux(26, 2), op::mux(38, 2),
                       kept * op::equal(kTag), op::logic(4 * kept), keeps * op::add(8),
                       keeps * op::mux(kBlock, 2)},
                      fills.operators),
            .longest = {op::priority(18), op::mux(14, 6), op::add(26), op::add(26)},
            .registers = fills.registers + keeps * (8 + 9 + 2)}},
      .cost = keeps ? "colour_lines = " + std::to_string(kept) + "." : ""};
}

}  // namespace deburr::rtl::geometric
