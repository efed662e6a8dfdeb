// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/diagonal_unit.h"

#include <algorithm>
#include <bit>
#include <string>

#include "rtl_model/morphological/blend/diagonal_table.h"

namespace deburr::rtl::morphological {
namespace {

constexpr std::uint8_t kRowMask = 0x3F;
constexpr std::uint32_t kTagBits = 7;

}  // namespace

DiagonalUnit::DiagonalUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
                           const spec::morphological::Parameters& p)
    : Unit(name, clock),
      lanes_(static_cast<std::size_t>(built_lanes(p))),
      lag_(search_range_rows_of(p) + spec::morphological::kRowLag - 2),
      steps_(p.diagonal_steps),
      delay_(static_cast<std::size_t>(diagonal_delay(p.diagonal_steps, built_lanes(p)))),
      clamp_(p.border == spec::morphological::Border::kClamp),
      window_memory_("diagonal_window",
                     {.words = (delay_ + 1) * lanes_ + static_cast<std::size_t>(steps_) + 1,
                      .word_bits = static_cast<std::uint32_t>(4 * steps_ + 2) + kTagBits,
                      .kind = MemoryKind::kFlops,
                      .latency = 0,
                      .span = static_cast<std::uint32_t>((delay_ + 1) * lanes_) +
                              static_cast<std::uint32_t>(steps_) + 1,
                      .content = "columns around the current pixels, both planes, slot row"}),
      rom_("diagonal_rom",
           {.words = kDiagonalWords,
            .word_bits = 16,
            .kind = MemoryKind::kRom,
            .read_ports = static_cast<std::uint32_t>(2 * lanes_),
            .write_ports = 0,
            .content = "areas of diagonals by crossing codes and distances of both ends"},
           diagonal_words(p.area_values)),
      weights_("diagonal_weights",
               static_cast<std::uint32_t>(
                   (static_cast<std::size_t>(p.line_pixels) + lanes_ - 1) / lanes_ + 16),
               PayloadShape{.lanes = static_cast<std::uint32_t>(lanes_)}) {
  for (std::size_t lane = 0; lane < lanes_; ++lane) {
    read_.emplace_back(rom_, std::to_string(lane) + " rising");
    read_.emplace_back(rom_, std::to_string(lane) + " falling");
  }
}

// Sets the rows outside the frame to the first or last row, for a column of that slot row.
std::uint64_t DiagonalUnit::repeat_rows(std::uint64_t rows, std::int32_t row) const {
  const std::int32_t y = row - lag_, first = steps_ - y, last = first + configuration_->height - 1;
  if (first > 0 && (rows >> first & 1) != 0) rows |= (std::uint64_t{1} << first) - 1;
  if (last < 2 * steps_ && (rows >> last & 1) != 0) rows |= ~std::uint64_t{0} << last;
  return rows;
}

// Stage 1. Without a token it shifts in invalid columns.
void DiagonalUnit::shift(Cycle cycle, const DiagonalColumnsToken* token) {
  columns_.write(cycle, 0, lanes_);
  const std::size_t first = token ? token->slot.beat * lanes_ : 0;
  for (std::size_t lane = 0; lane < lanes_; ++lane) {
    Column& column = window_[newest_++ % kPlaces];
    column.valid = token && first + lane < static_cast<std::size_t>(configuration_->width);
    if (!column.valid) continue;
    column.left = token->left[lane];
    column.top = token->top[lane];
    column.row = static_cast<std::uint8_t>(token->slot.row & kRowMask);
    if (!clamp_ || !configuration_->clamp) continue;
    column.left = repeat_rows(column.left, token->slot.row);
    column.top = repeat_rows(column.top, token->slot.row);
    if (first + lane == 0) first_[column.row & 1] = column;
    if (first + lane + 1 == static_cast<std::size_t>(configuration_->width))
      last_[column.row & 1] = column;
  }
}

// Stages 2 and 3, on the window as stage 1 left it.
void DiagonalUnit::search(Cycle cycle, Beat& beat) {
  fixed_bits_.read(cycle, 0, window_memory_.words());
  const std::size_t first = newest_ + kPlaces - (delay_ + 1) * lanes_;
  beat.valid = window_[first % kPlaces].valid;
  beat.searched = 0;
  if (!beat.valid) return;
  for (std::size_t lane = 0; lane < lanes_; ++lane) {
    const Around at{*this, first + lane + kPlaces};
    if (!window_[(first + lane) % kPlaces].valid || !at.top(0, 0)) continue;
    beat.pixel[lane] = {rising(at), falling(at)};
    if (beat.pixel[lane].rising.counts || beat.pixel[lane].falling.counts)
      beat.searched = static_cast<std::uint8_t>(beat.searched | 1u << lane);
  }
}

// Evaluates all built steps in parallel (bit i - 1 for step i), then finds the first gap.
template <class Good>
DiagonalUnit::End DiagonalUnit::first_gap(Good&& good) const {
  std::uint32_t steps = 0;
  for (int i = 1; i <= steps_; ++i) steps |= std::uint32_t{good(i)} << (i - 1);
  const int most = configuration_->diagonal_steps;
  const int found = std::min(std::countr_one(steps), most);
  return {std::min(found, most - 1), found == most};
}

DiagonalUnit::Diagonal DiagonalUnit::rising(const Around& at) const {
  End down;
  if (at.left(0, 0)) {
    down = first_gap([&](int i) { return at.left(-i, i) && at.top(-i, i); });
    const int next = down.distance + 1;
    down.distance += at.top(-next, next);
  }
  const End up = first_gap([&](int i) { return at.left(i, -i) && at.top(i, -i); });
  const int d1 = down.distance, d2 = up.distance;
  Diagonal diagonal{d1 + d2 > 2, d1, d2, 0, 0};
  if (!diagonal.counts) return diagonal;
  if (!down.open) diagonal.e1 = 2 * at.top(-d1 - 1, d1) + at.left(-d1, d1);
  if (!up.open) diagonal.e2 = 2 * at.top(d2 + 1, -d2) + at.left(d2 + 1, -d2 - 1);
  return diagonal;
}

DiagonalUnit::Diagonal DiagonalUnit::falling(const Around& at) const {
  const End up = first_gap([&](int i) { return at.top(-i, -i) && at.left(1 - i, -i); });
  End down;
  if (at.left(1, 0)) {
    down = first_gap([&](int i) { return at.top(i, i) && at.left(i + 1, i); });
    const int next = down.distance + 1;
    down.distance += at.top(next, next);
  }
  const int d1 = up.distance, d2 = down.distance;
  Diagonal diagonal{d1 + d2 > 2, d1, d2, 0, 0};
  if (!diagonal.counts) return diagonal;
  if (!up.open) diagonal.e1 = 2 * at.top(-d1 - 1, -d1) + at.left(-d1, -d1 - 1);
  if (!down.open) diagonal.e2 = 2 * at.top(d2 + 1, d2) + at.left(d2 + 1, d2);
  return diagonal;
}

// Stage 4.
void DiagonalUnit::address(Cycle cycle, const Beat& beat) {
  for (std::size_t lane = 0; lane < lanes_; ++lane) {
    if (!(beat.searched >> lane & 1)) continue;
    const Pixel& pixel = beat.pixel[lane];
    std::size_t port = 2 * lane;
    for (const Diagonal* d : {&pixel.rising, &pixel.falling}) {
      if (d->counts) read_[port].read(cycle, diagonal_address(d->e1, d->e2, d->d1, d->d2));
      ++port;
    }
  }
}

// Stage 5.
void DiagonalUnit::deliver(Cycle cycle, const Beat& beat) {
  const std::uint32_t most = configuration_->strongest ? spec::morphological::kMaxDiagonalWeight
                                                       : spec::morphological::kMaxWeight;
  DiagonalWeightsToken token{};
  for (std::size_t lane = 0; lane < lanes_; ++lane) {
    if (!(beat.searched >> lane & 1)) continue;
    std::uint32_t first = 0, second = 0;
    int span = 0;
    const Pixel& pixel = beat.pixel[lane];
    std::size_t port = 2 * lane;
    for (const Diagonal* d : {&pixel.rising, &pixel.falling}) {
      if (d->counts) {
        const std::uint32_t word =
            read_[port].at(cycle, diagonal_address(d->e1, d->e2, d->d1, d->d2));
        const std::uint32_t a = word & 0xFF, b = word >> 8;
        first += d == &pixel.rising ? b : a;
        second += d == &pixel.rising ? a : b;
        span = std::max(span, d->d1 + d->d2 + 1);
      }
      ++port;
    }
    if (first + second == 0) continue;
    token.taken = static_cast<std::uint8_t>(token.taken | 1u << lane);
    token.first[lane] = static_cast<std::uint8_t>(std::min(first, most));
    token.second[lane] = static_cast<std::uint8_t>(std::min(second, most));
    token.span[lane] = static_cast<std::uint8_t>(span);
    ++diagonal_pixels;
  }
  weights_.push(cycle, token);
}

Activity DiagonalUnit::tick(Cycle cycle) {
  const bool arrives = columns_in.can_pop(cycle);
  if (!arrives && drains_ == 0 && pipe_.empty()) return kIdle;
  configuration_ = &configuration_in.read(cycle);
  if (!weights_.can_push(cycle) && pipe_.leaves() && pipe_.at(kStages - 1)->valid)
    return kStalledDownstream;
  pipe_.move();
  if (const Beat* beat = pipe_.at(5); beat && beat->valid) deliver(cycle, *beat);
  if (const Beat* beat = pipe_.at(4); beat && beat->valid && beat->searched != 0)
    address(cycle, *beat);
  if (!arrives && drains_ == 0) return kBusy;
  const DiagonalColumnsToken* const token = arrives ? &columns_in.take(cycle) : nullptr;
  if (token) {
    if (token->slot.row == lag_ && token->slot.beat == 0)
      for (Column& column : window_) column.valid = false;
    drains_ = token->slot.beat + 1u == configuration_->beats ? delay_ : 0;
  } else {
    --drains_;
  }
  shift(cycle, token);
  search(cycle, pipe_.enter());
  return kBusy;
}

void DiagonalUnit::reset() {
  pipe_.reset();
  weights_.reset();
  drains_ = 0;
  for (Column& column : window_) column.valid = false;
}

Datasheet DiagonalUnit::datasheet(const spec::morphological::Parameters& p) {
  const std::uint32_t lanes = lane_copies(p), steps = static_cast<std::uint32_t>(p.diagonal_steps),
                      behind = (steps + lanes) / lanes;
  const std::uint32_t clamp = p.border == spec::morphological::Border::kClamp ? 1 : 0;
  constexpr std::uint32_t kSearches = 4, kPlanes = 2, kDistance = 5, kDiagonals = 2;
  const std::uint32_t rows = 2 * steps + 1, columns = (behind + 1) * lanes + steps + 1;
  return {
      .unit = "DiagonalUnit",
      .does = "Weights of pixels on a diagonal (`diagonals`).",
      .latency = {behind + 5, "D + 5, D = ceil((diagonal_steps + 1) / lanes)"},
      .stages =
          {{.clock = "1",
            .work = "shift (D beats until the pixels are evaluated); with border = clamp, rows "
                    "outside the frame repeat the nearest one",
            .operators = {2 * kPlanes * clamp * op::mux(1, rows),
                          2 * kPlanes * clamp * op::logic(rows)},
            .longest =
                clamp != 0 ? std::vector{op::mux(1, rows), op::logic(2)} : std::vector<Operator>{}},
           // A search reads two bits per step, one more per step for the extra bit of its end,
           // and two for the crossing code of each distance.
           {.clock = "2",
            .work = "tags, valid steps, first gap, four searches",
            .operators = {kSearches * op::logic(2 * steps), kSearches * op::leading_one(steps),
                          kSearches * op::maximum(kDistance),
                          clamp * op::mux(kSearches * (5 * steps + 2), 2), op::logic(20)},
            .longest = {op::equal(6), op::logic(clamp != 0 ? 6 : 2), op::leading_one(steps),
                        op::maximum(kDistance)},
            .registers = kSearches * (kDistance + 2 + 3 * (steps + 1)) + 1},
           // The crossing codes at both distances, with and without the extra pixel.
           {.clock = "3",
            .work = "the ends' extra bits and crossing bits, d1 + d2 > 2",
            .operators = {kSearches * op::mux(5, steps + 1), kSearches * op::mux(2, 2),
                          kSearches * op::add(kDistance), kDiagonals * op::add(6), op::logic(20)},
            .longest = {op::mux(5, steps + 1), op::add(kDistance), op::add(6), op::logic(4)},
            .registers = kDiagonals * (2 * kDistance + 2 * 2 + 1) + 1},
           {.clock = "4",
            .work = "`diagonal_rom` addresses",
            .operators = {kDiagonals * op::multiply_constant(4, 2),
                          kDiagonals * op::multiply_constant(kDistance, 1),
                          2 * kDiagonals * op::add(13), kDiagonals * op::add(6), op::maximum(6)},
            .longest = {op::multiply_constant(4, 2), 2 * op::add(13)},
            .registers = 6 + kDiagonals + 1},
           {.clock = "5",
            .work = "words, sum, limit, push",
            .operators = {op::logic(32), 2 * op::add(9), 2 * op::logic(24)},
            .longest = {op::rom_read(16, kDiagonalWords), op::add(9), op::logic(4)}}},
      .formats = "weights U0.8, span U6.",
      .copies = lanes,
      .per = "lane",
      // Tags of the window; with clamp, first and last column of two rows.
      .shared = {columns * op::equal(6), clamp * 2 * op::add(14), op::logic(40)},
      .shared_registers = 6 + 4 + clamp * 4 * kPlanes * rows};
}

}  // namespace deburr::rtl::morphological
