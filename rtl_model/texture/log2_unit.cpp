// SPDX-License-Identifier: MIT
#include "rtl_model/texture/log2_unit.h"

#include <array>
#include <bit>
#include <cstdint>

#include "rtl_model/texture/datasheets.h"
#include "spec/texture/parameters.h"
#include "spec/texture/tables.h"

namespace deburr::rtl::texture {
namespace {

// Line added to n + y in each quarter of an octave: a constant (U0.12) and two shifted copies of
// the position inside the quarter, each added or subtracted. The top bits of y select the row.
// Shifts are wires; signs drive the adders' invert and carry inputs.
struct ShiftAddLine {
  std::uint32_t constant;
  int coarse_shift;
  bool subtract_coarse;
  int fine_shift;
  bool subtract_fine;
};
constexpr std::array<ShiftAddLine, 4> kLines = {{{20, 2, false, 5, false},
                                                 {305, 4, false, 7, true},
                                                 {356, 3, true, 6, false},
                                                 {243, 2, true, 6, false}}};

// Two's complement on a 32-bit adder: inverted operand and carry in.
std::uint32_t add_or_subtract(std::uint32_t sum, std::uint32_t operand, bool subtract) {
  return subtract ? sum + ~operand + 1 : sum + operand;
}

std::uint32_t segment_correction(std::uint32_t y) {
  const ShiftAddLine& line = kLines[y >> 10];
  const std::uint32_t position = y & 0x3FF;
  const std::uint32_t sum =
      add_or_subtract(line.constant, position >> line.coarse_shift, line.subtract_coarse);
  return add_or_subtract(sum, position >> line.fine_shift, line.subtract_fine);
}

}  // namespace

template <class Width>
Log2UnitOf<Width>::Log2UnitOf(const sc_core::sc_module_name& name, ClockDomain& clock,
                              spec::texture::Log2Rule rule, std::int32_t fragments)
    : Unit(name, clock), rule_(rule), fragments_(static_cast<std::size_t>(fragments)) {
  if (rule_ != spec::texture::Log2Rule::kExact) return;
  table_ = std::make_unique<Memory<std::uint16_t>>(
      "table",
      MemoryShape{.words = spec::texture::kLog2Table.size(),
                  .word_bits = 13,
                  .kind = MemoryKind::kRom,
                  .read_ports = static_cast<std::uint32_t>(kReads * fragments_),
                  .write_ports = 0,
                  .latency = 1,
                  .content = "lb x for x from 1 to 2 in steps of 1/64"},
      spec::texture::kLog2Table);
  for (std::size_t i = 0; i < fragments_; ++i)
    for (const char* user : {"longer_low", "longer_high", "shorter_low", "shorter_high"})
      reads_.emplace_back(*table_, numbered(user, i));
}

// Stage 1.
template <class Width>
typename Log2UnitOf<Width>::Normal Log2UnitOf<Width>::normalise(std::uint64_t d) {
  const std::uint64_t at_least_one = d | (d == 0 ? 1u : 0u);
  const int zeros = std::countl_zero(at_least_one);  // leading-one detector
  const std::uint64_t normal = at_least_one << zeros;
  return {47 - zeros, static_cast<std::uint32_t>(normal >> 51) & 0xFFF};
}

// Stage 3.
template <class Width>
std::int32_t Log2UnitOf<Width>::correct(spec::texture::Log2Rule rule, Normal d, Chord chord) {
  std::uint32_t fraction = d.y;  // U1.12
  switch (rule) {
    case spec::texture::Log2Rule::kMitchell:
      break;
    case spec::texture::Log2Rule::kCorrected:
      fraction = d.y + spec::texture::kLog2Correction[d.y >> 9];
      break;
    case spec::texture::Log2Rule::kSegments:
      fraction = d.y + segment_correction(d.y);
      break;
    case spec::texture::Log2Rule::kExact:
      fraction = chord.low + (((chord.high - chord.low) * (d.y & 63) + 32) >> 6);
      break;
  }
  return d.n * 4096 + static_cast<std::int32_t>(fraction);
}

template <class Width>
std::int32_t Log2UnitOf<Width>::log2(spec::texture::Log2Rule rule, std::uint64_t d) {
  const Normal normal = normalise(d);
  const std::size_t i = normal.y >> 6;
  return correct(rule, normal, {spec::texture::kLog2Table[i], spec::texture::kLog2Table[i + 1]});
}

template <class Width>
Activity Log2UnitOf<Width>::tick(Cycle cycle) {
  if (rule_ == spec::texture::Log2Rule::kMitchell) return tick_mitchell(cycle);
  const bool arrives = footprints_in.can_pop(cycle);
  if (pipe_.empty() && !arrives) return kIdle;
  if (pipe_.leaves() && !logs_out.can_push(cycle)) return kStalledDownstream;
  pipe_.move();
  if (const auto* done = pipe_.at(3))
    each(*done, logs_out.emplace(cycle),
         [&](const Entry& entry, Log2Token& out) { out = correct_both(entry); });
  if (auto* group = pipe_.at(2); group && table_)
    for (std::size_t i = 0; i < count_of(*group); ++i) fetch(cycle, nth(*group, i), kReads * i);
  if (arrives) {
    auto& group = pipe_.enter();
    each(footprints_in.take(cycle), group, [](const FootprintToken& in, Entry& entry) {
      entry.token = in;
      entry.longer = normalise(in.d_max);
      entry.shorter = normalise(in.minor);
    });
    if (table_)
      for (std::size_t i = 0; i < count_of(group); ++i) look_up(cycle, nth(group, i), kReads * i);
  }
  return kBusy;
}

template <class Width>
inline Activity Log2UnitOf<Width>::tick_mitchell(Cycle cycle) {
  if (!footprints_in.can_pop(cycle)) return kIdle;
  if (!logs_out.can_push(cycle)) return kStalledDownstream;
  each(footprints_in.take(cycle), logs_out.emplace(cycle),
       [this](const FootprintToken& in, Log2Token& out) {
         out = {in.ticket,
                in.s,
                in.t,
                in.axis_s,
                in.axis_t,
                log2(rule_, in.d_max),
                log2(rule_, in.minor),
                in.diagonal};
       });
  return kBusy;
}

// The ROM takes the address at the end of stage 1.
template <class Width>
void Log2UnitOf<Width>::look_up(Cycle cycle, const Entry& entry, std::size_t port) {
  for (const Normal& d : {entry.longer, entry.shorter})
    for (const std::uint32_t successor : {0U, 1U})
      reads_[port++].read(cycle, (d.y >> 6) + successor);
}

// Stage 2.
template <class Width>
void Log2UnitOf<Width>::fetch(Cycle cycle, Entry& entry, std::size_t port) {
  const auto chord = [&](const Normal& d, std::size_t at) -> Chord {
    const std::uint32_t i = d.y >> 6;
    return {reads_[at].at(cycle, i), reads_[at + 1].at(cycle, i + 1)};
  };
  entry.longer_chord = chord(entry.longer, port);
  entry.shorter_chord = chord(entry.shorter, port + 2);
}

template <class Width>
Log2Token Log2UnitOf<Width>::correct_both(const Entry& entry) const {
  const FootprintToken& token = entry.token;
  return {token.ticket,
          token.s,
          token.t,
          token.axis_s,
          token.axis_t,
          correct(rule_, entry.longer, entry.longer_chord),
          correct(rule_, entry.shorter, entry.shorter_chord),
          token.diagonal};
}

template <class Width>
Datasheet Log2UnitOf<Width>::datasheet(const spec::texture::Parameters& p) {
  using spec::texture::Log2Rule;
  const Sizes z(p);
  // Mean width of a shifter of which 12 bits are kept.
  const std::uint32_t shifted = z.minor > 32 ? 22 : 18;
  Datasheet sheet = {
      .unit = "Log2Unit",
      .variant = chosen("log2", spec::texture::kLog2Names, p.log2) + ", " + chosen_axes(p),
      .does =
          "Binary logarithms of both sides of the footprint, or of the longer side and the area.",
      .latency = {p.log2 == Log2Rule::kMitchell ? 1U : 3U},
      .stages = {{.clock = "1",
                  .work = "leading one, shift",
                  .operators = {op::leading_one(32), op::shift(18, 32), op::leading_one(z.minor),
                                op::shift(shifted, z.minor)},
                  .longest = {op::leading_one(z.minor), op::shift(shifted, z.minor)}}},
      .formats = "U16.16 and U31.16 in, S5.12 out.",
      .copies = z.fragments,
      .per = "fragment"};
  if (p.log2 == Log2Rule::kMitchell) return sheet;
  // Ticket, position, axis and valid; of both sides n and y.
  const std::uint32_t kept = Payload::of<Log2Token>(axis_shape(p)).bits() - 2 * 18 + 1;
  sheet.stages[0].registers = kept + 2 * (6 + 12);
  Stage table = {.clock = "2", .work = "table", .registers = kept + 2 * (6 + 12)};
  Stage correction = {.clock = "3", .work = "correction"};
  switch (p.log2) {
    case Log2Rule::kMitchell:
      break;
    case Log2Rule::kCorrected:
      correction.operators = {2 * op::rom_read(9, 8), 2 * op::add(18)};
      correction.longest = {op::rom_read(9, 8), op::add(18)};
      break;
    case Log2Rule::kSegments:
      correction.operators = {2 * op::rom_read(9, 4), 2 * op::mux(8, 4), 2 * op::mux(5, 4),
                              4 * op::add(11), 2 * op::add(18)};
      correction.longest = {op::mux(8, 4), 2 * op::add(11), op::add(18)};
      break;
    case Log2Rule::kExact:
      table.longest = {op::rom_read(13, 65)};
      table.registers = kept + 2 * (6 + 6 + 2 * 13);  // the low half of y; two words
      correction.operators = {2 * op::subtract(7), 2 * op::multiply(7, 6), 2 * op::add(13),
                              2 * op::add(18)};
      correction.longest = {op::subtract(7), op::multiply(7, 6), op::add(13), op::add(18)};
      break;
  }
  sheet.stages.push_back(table);
  sheet.stages.push_back(correction);
  return sheet;
}

template class Log2UnitOf<Narrow>;
template class Log2UnitOf<Wide>;

}  // namespace deburr::rtl::texture
