// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/descriptor_store.h"

#include <algorithm>

#include "rtl_model/morphological/blend/table_weights.h"

namespace deburr::rtl::morphological {
namespace {

constexpr std::uint32_t kSpanBits = 12, kCoordinateBits = 13, kLengthBits = 12;
// t S4.24, growth U2.24, inverse, span, two sides.
constexpr std::uint32_t kDescriptorBits = 29 + 26 + 24 + kSpanBits + 4;
constexpr std::uint32_t kCornerBits = 4 + 2;  // far bits, part
constexpr std::uint32_t kLearnedBits = 1;     // no line; part, shape and classes share its bits
// Row, odd column, length.
constexpr std::uint32_t kRowMarkBits = kCoordinateBits + 1 + kLengthBits;
// Start, length (up to R).
constexpr std::uint32_t kColumnMarkBits = kCoordinateBits + 8;

// Is slot a before slot b? Low bits, at most 2^14 apart.
bool before(std::uint32_t a, std::uint32_t b) { return (a - b) & ((kSlotMask + 1) / 2); }

bool has_crossings(const spec::morphological::Parameters& p) {
  return p.ends == spec::morphological::Ends::kCrossings;
}

MemoryShape axis_shape(std::size_t words, std::size_t columns, std::size_t banks,
                       const char* content) {
  return {.words = words,
          .write_ports = static_cast<std::uint32_t>(banks),
          // A descriptor may be stored in the cycle in which the walk reads it: too late for that
          // beat.
          .read_during_write = ReadDuringWrite::kOldWord,
          .banks = static_cast<std::uint32_t>(banks),
          .separate_banks = banks > 1,
          .content = content,
          .columns = columns};
}

// One read port for a beat of marks.
MemoryShape marks_shape(MemoryShape shape, std::uint32_t bits) {
  shape.word_bits = bits;
  shape.span = shape.banks;
  return shape;
}

// One read port per bank.
MemoryShape descriptors_shape(MemoryShape shape, std::uint32_t bits) {
  shape.word_bits = bits;
  shape.read_ports = shape.banks;
  return shape;
}

}  // namespace

AxisDescriptors::AxisDescriptors(const std::string& axis, const MemoryShape& shape,
                                 std::uint32_t mark_bits, std::uint32_t descriptor_bits)
    : banks_(shape.banks),
      marks_((axis + "_marks").c_str(), marks_shape(shape, mark_bits)),
      descriptors_((axis + "_descriptors").c_str(), descriptors_shape(shape, descriptor_bits)),
      mark_(shape.words + std::size_t{2} * spec::morphological::kMaxLanes) {
  for (std::size_t bank = 0; bank < banks_; ++bank) {
    const std::string user = "bank " + std::to_string(bank);
    read_.emplace_back(descriptors_, user);
    write_marks_.emplace_back(marks_, user);
    write_.emplace_back(descriptors_, user);
  }
}

void AxisDescriptors::write(Cycle cycle, std::size_t place, const Mark& mark,
                            const StoredDescriptor& descriptor) {
  const std::size_t bank = bank_of(place);
  write_marks_[bank].write(cycle, place);
  mark_[place] = mark;
  write_[bank].write(cycle, place, descriptor);
}

void AxisDescriptors::clear_marks(Cycle cycle, std::size_t place) {
  for (std::size_t bank = 0; bank < banks_; ++bank) {
    write_marks_[bank].write(cycle, place + bank);
    mark_[place + bank] = {};
  }
}

DescriptorStore::DescriptorStore(const sc_core::sc_module_name& name,
                                 const spec::morphological::Parameters& p, std::size_t columns,
                                 Counters counters)
    : sc_module(name),
      lanes_(static_cast<std::size_t>(built_lanes(p))),
      ends_(has_table(p)),
      shapes_(ends_ || p.round_corners),
      pair_bits_(has_crossings(p) ? 0 : 1),
      entry_bits_(has_crossings(p) ? 1 : 0),
      pairs_(columns >> pair_bits_),
      row_("row",
           axis_shape(2 * pairs_, static_cast<std::size_t>(p.line_pixels),
                      std::max<std::size_t>(1, lanes_ >> pair_bits_),
                      has_crossings(p) ? "one horizontal descriptor per column, two rows"
                                       : "one horizontal descriptor per pair of columns, two rows"),
           kRowMarkBits, word_bits(p)),
      column_("column",
              axis_shape(columns << entry_bits_, static_cast<std::size_t>(p.line_pixels),
                         lanes_ << entry_bits_,
                         has_crossings(p) ? "two vertical descriptors per column"
                                          : "one vertical descriptor per column"),
              kColumnMarkBits, word_bits(p)),
      counters_(counters) {}

std::size_t DescriptorStore::place(const AxisDescriptors& axis, const LineToken& token) const {
  const spec::morphological::RunDescriptor& run = token.line.run;
  if (&axis == &row_) return row_place<false>(run.line, run.start);
  return (std::size_t{run.line} << entry_bits_) + token.entry;
}

// First stage: takes lines whose slot has passed, one per bank.
bool DescriptorStore::enter(Cycle cycle, LanePorts<In<LineToken>>& lines, AxisDescriptors& axis,
                            Lines& under_way) {
  std::uint32_t taken = 0;  // bit mask of banks
  for (std::size_t lane = 0; lane < lanes_; ++lane) {
    In<LineToken>& in = lines[lane];
    if (!in.can_pop(cycle)) continue;
    const LineToken& token = in.front(cycle);
    // The slot may still have to read the entry that this line overwrites.
    if (!before(token.slot, passed_)) continue;
    const std::uint32_t bank = 1u << axis.bank_of(place(axis, token));
    if (taken & bank) {
      ++counters_.bank_conflicts;
      continue;
    }
    taken |= bank;
    under_way.entered[under_way.entered_count++] = token;
    in.pop(cycle);
  }
  return taken != 0;
}

// With a table: t(0) is known, the ends are computed next.
void DescriptorStore::measure_lines() {
  for (Lines* lines : {&row_lines_, &column_lines_}) {
    std::copy_n(lines->entered.begin(), lines->entered_count, lines->measured.begin());
    lines->measured_count = lines->entered_count;
    lines->entered_count = 0;
  }
}

// Last stage for lines.
bool DescriptorStore::store_lines(Cycle cycle, const FrameConfiguration& configuration,
                                  Out<FinishToken>& finished) {
  if (!finished.can_push(cycle)) return false;
  FinishToken token{};
  const auto store_all = [&](AxisDescriptors& axis, Lines& under_way) {
    const auto& lines = ends_ ? under_way.measured : under_way.entered;
    std::size_t& count = ends_ ? under_way.measured_count : under_way.entered_count;
    for (std::size_t i = 0; i < count; ++i) {
      store(cycle, configuration, axis, lines[i]);
      // Its slot row is the current one or the one before.
      ++token.count[odd_row_ != before(lines[i].slot, row_begin_)];
    }
    count = 0;
  };
  store_all(row_, row_lines_);
  store_all(column_, column_lines_);
  finished.push(cycle, token);
  return true;
}

void DescriptorStore::store(Cycle cycle, const FrameConfiguration& configuration,
                            AxisDescriptors& axis, const LineToken& token) {
  const spec::morphological::LineDescriptor& line = token.line;
  if (observer) observer(line);
  ++counters_.descriptors;
  StoredDescriptor descriptor;
  descriptor.t = (std::int64_t{line.shift} << (spec::morphological::kRecipFractionBits - 1)) -
                 std::int64_t{line.offset} * line.slope;
  descriptor.growth = static_cast<std::uint32_t>(line.scale) * line.slope;
  descriptor.inverse = line.inverse;
  if (configuration.table) TableWeights::set_ends(descriptor, line.run.endless);
  if (shapes_ || line.learned) {
    descriptor.shape = line.run.shape;
    descriptor.far = line.run.far;
    descriptor.part = line.run.part;
  }
  descriptor.learned = line.learned;
  descriptor.start_class = line.start_class;
  descriptor.end_class = line.end_class;
  descriptor.span = line.span;
  descriptor.before = line.before;
  descriptor.after = line.after;
  axis.write(cycle, place(axis, token), {line.run.start, line.run.length, line.run.line},
             descriptor);
}

void DescriptorStore::clear_marks(Cycle cycle, const Slot& slot) {
  const std::size_t x = slot.beat * lanes_;
  row_.clear_marks(cycle, row_place<false>(slot.row, x));
  if (slot.row == 0) column_.clear_marks(cycle, x << entry_bits_);
}

void DescriptorStore::reset() {
  for (Lines* lines : {&row_lines_, &column_lines_})
    lines->entered_count = lines->measured_count = 0;
  passed_ = row_begin_ = 0;
  odd_row_ = false;
}

std::uint32_t DescriptorStore::word_bits(const spec::morphological::Parameters& p) {
  return kDescriptorBits + (p.round_corners ? kCornerBits : 0) +
         (p.area == spec::morphological::AreaSource::kLearned ? kLearnedBits : 0);
}

Datasheet DescriptorStore::datasheet(const spec::morphological::Parameters& p) {
  const std::uint32_t lanes = lane_copies(p), crossings = has_crossings(p) ? 1 : 0;
  const bool table = has_table(p);
  // A line in flight: what is stored, without t and growth, and its place, slot and parity.
  constexpr std::uint32_t kT = 29, kGrowth = 26, kInverse = 24, kPlace = 13 + 1 + 2;
  const std::uint32_t mark = kRowMarkBits + kPlace,
                      word = word_bits(p) - kT - kGrowth + (table ? 4 : 0);
  const std::uint32_t banks = std::max(1u, lanes >> (1 - crossings)) + (lanes << crossings);
  const std::uint32_t stored = word_bits(p) + kRowMarkBits;
  Datasheet sheet = {
      .unit = "DescriptorStore",
      .does = "Stores the descriptors of both axes, addressed by raster position.",
      .latency = {2},
      .interval = {1, "1 per bank"},
      .stages = {{.clock = "1",
                  .work = "select one line per bank, two products",
                  .operators = {op::compare(15), (lanes - 1) * op::equal(3), op::logic(20),
                                op::multiply(24, 24), op::multiply(7, 24)},
                  .longest = {op::multiply(24, 24)},
                  .registers = 48 + kGrowth + 6 + mark + word,
                  .on = "descriptors"},
                 {.clock = "2",
                  .work = "t at the first edge, store",
                  .operators = {op::subtract(kT), op::compare(15)},
                  .longest = {op::subtract(kT)},
                  .on = "descriptors"}},
      .formats = "t S4.24, growth U2.24, inverse U12.12; with a table a, b S13 instead of both.",
      .copies = 2 * lanes,
      .per = "axis and lane",
      // Choice of a line per bank, finished descriptors, clearing of marks.
      .shared = {(lanes > 1 ? banks : 0) * op::mux(stored, lanes), 2 * op::count_ones(2 * lanes),
                 banks * op::logic(kRowMarkBits)},
      .shared_registers = 15 + 15 + 1};
  if (!table) return sheet;
  sheet.variant = "with a table";
  sheet.latency = {3};
  const std::vector<Operator> measured = {op::subtract(kT), op::add(kT), op::subtract(18)};
  sheet.stages = {
      sheet.stages[0],
      {.clock = "2",
       .work = "t at the first edge",
       .operators = measured,
       .longest = measured,
       .registers = kT + 2 * 18 + kGrowth + mark + word,
       .on = "descriptors"},
      {.clock = "3",
       .work = "a and b, store",
       .operators = {op::compare(15), 2 * op::multiply(18, kInverse), 2 * op::add(42),
                     2 * op::logic(40), op::mux(26, 2)},
       .longest = {op::multiply(18, kInverse), op::add(42), op::logic(12), op::mux(13, 2)},
       .on = "descriptors"}};
  return sheet;
}

}  // namespace deburr::rtl::morphological
