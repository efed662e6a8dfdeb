// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/front/text_guard.h"

#include <algorithm>
#include <bit>
#include <span>
#include <string>

namespace deburr::rtl::morphological {
namespace {

constexpr std::int32_t kHashWidth = 6;
constexpr std::int32_t kHashRows = 10;   // above the newest row
constexpr std::int32_t kStroke = 3;      // maximum length of a run, pixels
constexpr std::int32_t kWindow = 5;      // pixels to each side
constexpr int kLeast = 3;                // minimum number of pixels with H, and with V
constexpr int kEnough = 24;              // minimum of their sum
constexpr std::int32_t kCountRows = 11;  // rows per column in which strokes are counted
// Rows from the newest row up to the row whose column runs it completes.
constexpr std::int32_t kRunRows = kStroke;
constexpr std::uint32_t kHBits = kCountRows + kRunRows - 1, kVBits = kCountRows - 1;
// Rows by which the two colours are known before the counts.
constexpr std::int32_t kColourRows = kGuardRows - kWindow;
// More than the 27 slots that can be between SlotSequencer and Blender: two in each of five links
// (slots, lumas, edge_bits, area_slots, weights) and one per stage of the four units between them.
constexpr std::int32_t kUnderWay = 32;
static_assert(kUnderWay >
              5 * 2 + spec::morphological::kLumaLatency + spec::morphological::kEdgeLatency +
                  spec::morphological::kExtractorLatency + spec::morphological::kAreaLatency);

// The hash of the contract, written as one xor equation per bit (folds and rotations are wires).
constexpr std::uint8_t hash_of(const std::array<std::uint8_t, 3>& rgb) {
  const auto r = [&](int bit) { return rgb[0] >> bit & 1; };
  const auto g = [&](int bit) { return rgb[1] >> bit & 1; };
  const auto b = [&](int bit) { return rgb[2] >> bit & 1; };
  const int h0 = r(0) ^ r(6) ^ g(5) ^ b(3);
  const int h1 = r(1) ^ r(7) ^ g(0) ^ g(6) ^ b(4);
  const int h2 = r(2) ^ g(1) ^ g(7) ^ b(5);
  const int h3 = r(3) ^ g(2) ^ b(0) ^ b(6);
  const int h4 = r(4) ^ g(3) ^ b(1) ^ b(7);
  const int h5 = r(5) ^ g(4) ^ b(2);
  return static_cast<std::uint8_t>(h5 << 5 | h4 << 4 | h3 << 3 | h2 << 2 | h1 << 1 | h0);
}
// From a column's word: hash of the row `above` (1..10) rows above the newest one.
constexpr std::uint8_t kept_hash(std::uint64_t hashes, std::int32_t above) {
  return static_cast<std::uint8_t>(hashes >> ((above - 1) * kHashWidth)) % (1u << kHashWidth);
}

std::int32_t beats_for(std::int32_t pixels, std::int32_t lanes) {
  return (pixels + lanes - 1) / lanes;
}
std::int32_t row_stage_of(std::int32_t lanes) { return 2 + beats_for(kStroke, lanes); }
std::int32_t column_stage_of(std::int32_t lanes) {
  return row_stage_of(lanes) + 4 + beats_for(kWindow, lanes);
}
std::int32_t last_stage_of(std::int32_t lanes) { return column_stage_of(lanes) + 2; }

std::uint32_t fifo_words(const spec::morphological::Parameters& p) {
  const std::int32_t rows = search_range_rows_of(p) + spec::morphological::kRowLag - kGuardRows;
  return static_cast<std::uint32_t>(rows * beats_for(p.line_pixels, built_lanes(p)) + kUnderWay);
}
MemoryShape row_shape(const spec::morphological::Parameters& p, std::int32_t lanes) {
  return {.words = static_cast<std::uint64_t>(beats_for(p.line_pixels, lanes)),
          .word_bits = static_cast<std::uint32_t>(kHashWidth * lanes),
          // The next row overwrites this one, at the earliest in the cycle of the read.
          .read_during_write = ReadDuringWrite::kOldWord,
          .content = "hashes of the newest row",
          .columns = static_cast<std::uint64_t>(p.line_pixels)};
}
MemoryShape column_shape(const spec::morphological::Parameters& p, std::int32_t lanes,
                         std::uint32_t bits, std::string content) {
  return {.words = static_cast<std::uint64_t>(beats_for(p.line_pixels, lanes) * lanes),
          .word_bits = bits,
          // In a row of one beat, the read and the write are in the same cycle.
          .read_during_write = ReadDuringWrite::kNewWord,
          .banks = static_cast<std::uint32_t>(lanes),
          .span = static_cast<std::uint32_t>(lanes),
          .content = std::move(content),
          .columns = static_cast<std::uint64_t>(p.line_pixels)};
}

}  // namespace

TextGuard::TextGuard(const sc_core::sc_module_name& name, ClockDomain& clock,
                     const spec::morphological::Parameters& p)
    : Unit(name, clock),
      lanes_(static_cast<std::uint32_t>(built_lanes(p))),
      row_stage_(row_stage_of(built_lanes(p))),
      column_stage_(column_stage_of(built_lanes(p))),
      last_stage_(last_stage_of(built_lanes(p))),
      row_("guard_row", row_shape(p, built_lanes(p))),
      columns_("guard_columns",
               column_shape(p, built_lanes(p), kHashRows * kHashWidth + kHBits + kVBits,
                            "per column, the last rows: hashes, row and column strokes")),
      colours_("guard_colours", column_shape(p, built_lanes(p), kColourRows,
                                             "per column, the last rows: are there two colours?")),
      guards_("guards", fifo_words(p), PayloadShape{.lanes = lanes_}) {}

// Input side. Flush rows have no pixels.
void TextGuard::store(Cycle cycle) {
  const GuardSlotToken& token = slots_in.take(cycle);
  const FrameConfiguration& configuration = *configuration_;
  if (token.row == 0 && token.beat == 0) complete_ = next_row_ = next_beat_ = 0;
  if (token.row < configuration.height) {
    Hashes word{};
    for (std::size_t lane = 0; lane < lanes_; ++lane) word[lane] = hash_of(token.pixel[lane]);
    row_in_.write(cycle, token.beat, word);
  }
  if (token.beat + 1u == configuration.beats) complete_ = token.row + 1;
}

// Stage 1.
void TextGuard::enter(Cycle cycle) {
  Beat& beat = at(1);
  beat.valid = next_row_ < complete_;
  if (!beat.valid) return;
  ++inside_;
  beat.row = next_row_;
  beat.beat = next_beat_;
  if (is_row(beat.row)) row_out_.read(cycle, static_cast<std::uint64_t>(beat.beat));
  if (static_cast<std::uint32_t>(++next_beat_) != configuration_->beats) return;
  next_beat_ = 0;
  ++next_row_;
}

// Value of a column near the current beat, in its row.
inline std::uint8_t TextGuard::hash_at(std::int32_t x) {
  const std::int32_t lanes = static_cast<std::int32_t>(lanes_), beat = x / lanes;
  return at(row_stage_ + at(row_stage_).beat - beat).hash[static_cast<std::size_t>(x % lanes)];
}
inline const TextGuard::Column& TextGuard::column_at(std::int32_t x) {
  const std::int32_t lanes = static_cast<std::int32_t>(lanes_), beat = x / lanes;
  return at(column_stage_ + at(column_stage_).beat - beat)
      .column[static_cast<std::size_t>(x % lanes)];
}

// Runs in the first stage in which the columns to the right are available.
void TextGuard::find_h(Beat& beat) {
  beat.h = 0;
  if (!is_row(beat.row)) return;
  const auto first = static_cast<std::int32_t>(first_of(beat));
  for (std::int32_t lane = 0; lane < static_cast<std::int32_t>(lanes_); ++lane) {
    const std::int32_t x = first + lane;
    if (!is_column(x)) break;
    const std::uint8_t colour = hash_at(x);
    std::int32_t run = 1;
    for (std::int32_t dx = 1; dx <= kStroke && is_column(x - dx) && hash_at(x - dx) == colour; ++dx)
      ++run;
    for (std::int32_t dx = 1; dx <= kStroke && is_column(x + dx) && hash_at(x + dx) == colour; ++dx)
      ++run;
    if (run <= kStroke) beat.h = static_cast<std::uint8_t>(beat.h | 1u << lane);
  }
}

// Is the vertical run of the pixel in the middle of seven rows short?
bool TextGuard::find_v(const Word& word, std::uint8_t newest, std::int32_t row) const {
  const std::int32_t y = row - kRunRows;
  if (!is_row(y)) return false;
  const auto hash = [&](std::int32_t above) {  // 0: the newest row
    return above == 0 ? newest : kept_hash(word.hashes, above);
  };
  const auto same = [&](std::int32_t above) {
    return is_row(row - above) && hash(above) == hash(kRunRows);
  };
  std::int32_t run = 1;
  for (std::int32_t dy = 1; dy <= kStroke && same(kRunRows + dy); ++dy) ++run;
  for (std::int32_t dy = 1; dy <= kStroke && same(kRunRows - dy); ++dy) ++run;
  return run <= kStroke;
}

TextGuard::Colours TextGuard::merged(const Colours& a, const Colours& b) {
  if (!a.any) return b;
  if (!b.any) return a;
  Colours both{.least = std::min(a.least, b.least),
               .greatest = std::max(a.greatest, b.greatest),
               .others = a.others || b.others,
               .any = true};
  for (const std::uint8_t hash : {a.least, a.greatest, b.least, b.greatest})
    both.others |= hash != both.least && hash != both.greatest;
  return both;
}

// `word`: value before the new row is shifted in.
TextGuard::Column TextGuard::column_of(const Word& word, const Beat& beat, std::size_t lane) const {
  Column column{};
  const auto add = [&](std::uint8_t hash) {
    column.colours = merged(column.colours, {hash, hash, false, true});
  };
  if (is_row(beat.row)) add(beat.hash[lane]);
  for (std::int32_t above = 1; above <= kHashRows; ++above)
    if (is_row(beat.row - above)) add(kept_hash(word.hashes, above));
  return column;
}

// Column words. The counts cover rows s - 13 .. s - 3, so each includes the newest bit.
void TextGuard::read_columns(Cycle cycle, Beat& beat) {
  const std::uint64_t first = first_of(beat);
  std::array<Word, kLanes> words;
  for (std::size_t lane = 0; lane < lanes_; ++lane) {
    const Word& read = above_.at(cycle, first + lane);
    const Word above = beat.row == 0 ? Word{} : read;
    Column& column = beat.column[lane] = column_of(above, beat, lane);
    const auto h = static_cast<std::uint32_t>(above.h << 1 | (beat.h >> lane & 1)),
               v = static_cast<std::uint32_t>(above.v << 1 |
                                              int{find_v(above, beat.hash[lane], beat.row)});
    column.h = static_cast<std::uint8_t>(std::popcount(h >> kRunRows));
    column.v = static_cast<std::uint8_t>(std::popcount(v));
    Word& word = words[lane];
    word.hashes = (above.hashes << kHashWidth | beat.hash[lane]) &
                  ((std::uint64_t{1} << kHashRows * kHashWidth) - 1);
    word.h = static_cast<std::uint16_t>(h & ((1u << kHBits) - 1));
    word.v = static_cast<std::uint16_t>(v & ((1u << kVBits) - 1));
  }
  shift_.write(cycle, first, std::span<const Word>(words.data(), lanes_));
}

// Runs in the first stage in which the columns to the right are available.
void TextGuard::look_around(Beat& beat) {
  beat.two = beat.enough = 0;
  const auto first = static_cast<std::int32_t>(first_of(beat));
  for (std::int32_t lane = 0; lane < static_cast<std::int32_t>(lanes_) && is_column(first + lane);
       ++lane) {
    const std::int32_t x = first + lane;
    Colours colours{};
    int h = 0, v = 0;
    for (std::int32_t column = x - kWindow; column <= x + kWindow; ++column) {
      if (!is_column(column)) continue;
      const Column& of = column_at(column);
      colours = merged(colours, of.colours);
      h += of.h;
      v += of.v;
    }
    const bool two = colours.any && !colours.others && colours.least != colours.greatest;
    const bool enough = h >= kLeast && v >= kLeast && h + v >= kEnough;
    beat.two = static_cast<std::uint8_t>(beat.two | int{two} << lane);
    beat.enough = static_cast<std::uint8_t>(beat.enough | int{enough} << lane);
  }
}

// Last stage.
void TextGuard::deliver(Cycle cycle, Beat& beat) {
  --inside_;
  const std::uint64_t first = first_of(beat);
  std::array<std::uint8_t, kLanes> words{};
  GuardToken token{};
  for (std::size_t lane = 0; lane < kLanes && lane < lanes_; ++lane) {
    const std::uint8_t above = two_above_.at(cycle, first + lane);
    const std::uint32_t two = above >> (kColourRows - 1) & 1;
    token.guarded = static_cast<std::uint8_t>(token.guarded | (two & beat.enough >> lane) << lane);
    words[lane] =
        static_cast<std::uint8_t>((above << 1 | (beat.two >> lane & 1)) & ((1 << kColourRows) - 1));
  }
  two_shift_.write(cycle, first, std::span<const std::uint8_t>(words.data(), lanes_));
  if (beat.row < kGuardRows) return;
  guarded_pixels += static_cast<std::uint64_t>(std::popcount(token.guarded));
  guards_.push(cycle, token);
}

Activity TextGuard::tick(Cycle cycle) {
  const bool arrives = slots_in.can_pop(cycle);
  if (!arrives && inside_ == 0 && next_row_ == complete_) return kIdle;
  configuration_ = &configuration_in.read(cycle);
  const Beat& leaves = at(last_stage_ - 1);
  if (leaves.valid && leaves.row >= kGuardRows && !guards_.can_push(cycle))
    return kStalledDownstream;
  ++newest_;
  if (Beat& beat = at(last_stage_); beat.valid) deliver(cycle, beat);
  if (Beat& beat = at(column_stage_ + 1); beat.valid)
    two_above_.read(cycle, first_of(beat), lanes_);
  if (Beat& beat = at(column_stage_); beat.valid) look_around(beat);
  if (Beat& beat = at(row_stage_ + 1); beat.valid) read_columns(cycle, beat);
  if (Beat& beat = at(2); beat.valid && is_row(beat.row))
    beat.hash = row_out_.at(cycle, static_cast<std::uint64_t>(beat.beat));
  if (Beat& beat = at(row_stage_); beat.valid) {
    find_h(beat);
    above_.read(cycle, first_of(beat), lanes_);
  }
  enter(cycle);
  if (arrives) store(cycle);
  return kBusy;
}

void TextGuard::reset() {
  for (Beat& beat : beats_) beat.valid = false;
  inside_ = 0;
  complete_ = next_row_ = next_beat_ = 0;
}

Datasheet TextGuard::datasheet(const spec::morphological::Parameters& p) {
  const std::int32_t lanes = built_lanes(p), row = row_stage_of(lanes),
                     column = column_stage_of(lanes), last = last_stage_of(lanes);
  const auto clock = [](std::int32_t stage) { return std::to_string(stage + 1); };
  const auto clocks = [&](std::int32_t first, std::int32_t end) {
    return first == end ? clock(first) : clock(first) + "-" + clock(end);
  };
  constexpr std::uint32_t kHash = kHashWidth, kRows = kCountRows, kColumns = 2 * kWindow + 1;
  // Of a column: least and greatest hash, others, any, both counts.
  constexpr std::uint32_t kColumn = 2 * kHash + 2 + 2 * 4, kPlace = 14 + 13 + 1;
  const auto extremes = 2 * (kRows - 1) * op::maximum(kHash);
  return {.unit = "TextGuard",
          .does = "Marks the pixels of aliased two-colour text.",
          .latency = {static_cast<std::uint64_t>(last) + 1,
                      "17 with one lane, 14 with two, 12 with four: from the last beat of a row "
                      "to the first beat of the row eight above"},
          .stages = {{.clock = "1",
                      .work = "hash, stored in guard_row",
                      .operators = {op::logic(72)},
                      .longest = {op::logic(12)}},
                     {.clock = clock(1), .work = "address of guard_row"},
                     {.clock = clocks(2, row - 1),
                      .work = "hashes of a row, one beat per cycle",
                      .path = "SRAM read",
                      .registers = kHash},
                     {.clock = clock(row),
                      .work = "H, address of guard_columns",
                      .operators = {2 * kStroke * op::equal(kHash), op::logic(50)},
                      .longest = {op::equal(kHash), op::logic(12)},
                      .registers = kHash + 1},
                     {.clock = clock(row + 1),
                      .work = "column words; V; write-back",
                      .path = "SRAM read with bypass, SRAM write",
                      .operators = {2 * kStroke * op::equal(kHash), op::logic(50)},
                      .longest = {op::equal(kHash), op::logic(12)},
                      .registers = kRows * kHash + 2 * kRows},
                     {.clock = clock(row + 2),
                      .work = "minimum and maximum of 11 hashes, counts of 11 bits",
                      .operators = {extremes, 2 * op::count_ones(kRows)},
                      .longest = {4 * op::maximum(kHash)},
                      .registers = kRows * kHash + 2 * kHash + 2 * 4},
                     {.clock = clock(row + 3),
                      .work = "other hashes?",
                      .operators = {2 * kRows * op::equal(kHash), op::logic(3 * kRows)},
                      .longest = {op::equal(kHash), op::logic(12)},
                      .registers = kColumn},
                     {.clock = clocks(row + 4, column - 1),
                      .work = "columns, one beat per cycle",
                      .registers = kColumn},
                     {.clock = clock(column),
                      .work = "minimum and maximum of 11 columns, sums",
                      .operators = {extremes, 2 * (kColumns - 1) * op::add(6)},
                      .longest = {4 * op::maximum(kHash)},
                      .registers = kColumn + 2 * kHash + 2 * 7 + 1},
                     {.clock = clock(column + 1),
                      .work = "other hashes? enough? address of guard_colours",
                      .operators = {4 * kColumns * op::equal(kHash), op::logic(7 * kColumns),
                                    op::add(8), 3 * op::compare(8)},
                      .longest = {op::add(8), op::compare(8), op::logic(12)},
                      .registers = 2},
                     {.clock = clock(last),
                      .work = "two colours three rows ago, write-back, decision",
                      .path = "SRAM read with bypass, SRAM write",
                      .operators = {op::logic(4)}}},
          .formats = "hashes U6; counts per column U4, per window U7.",
          .copies = lane_copies(p),
          .per = "lane",
          // Rows and beats of both sides; columns left of the beat.
          .shared = {op::add(14), op::add(13), 2 * op::equal(14), op::compare(14), op::logic(40)},
          .shared_registers =
              14 + static_cast<std::uint32_t>(last) * kPlace + kStroke * kHash + kWindow * kColumn};
}

}  // namespace deburr::rtl::morphological
