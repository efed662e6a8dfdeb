// SPDX-License-Identifier: MIT
#include "rtl_model/texture/log2_unit.h"

#include <array>
#include <bit>
#include <cstdint>

#include "spec/texture/parameters.h"
#include "spec/texture/tables.h"

namespace deburr::rtl::texture {
namespace {

// The line that is added to n + y in each quarter of an octave: a constant (U0.12) and two shifted
// copies of the position inside the quarter, each added or subtracted. The top bits of y select the
// row; the shifts are wires, the signs drive the adders' invert and carry inputs.
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

// Fraction of the logarithm by table and linear interpolation, U1.12.
std::uint32_t interpolated(std::uint32_t y) {
  const std::uint32_t low = spec::texture::kLog2Table[y >> 6],
                      high = spec::texture::kLog2Table[(y >> 6) + 1];
  return low + (((high - low) * (y & 63) + 32) >> 6);
}

}  // namespace

Log2Unit::Log2Unit(const sc_core::sc_module_name& name, ClockDomain& clock,
                   spec::texture::Log2Rule rule)
    : Unit(name, clock), rule_(rule) {}

std::int32_t Log2Unit::log2(spec::texture::Log2Rule rule, std::uint32_t d) {
  const int zeros = std::countl_zero(d | (d == 0 ? 1u : 0u));      // leading-one detector
  const std::uint32_t normal = (d | (d == 0 ? 1u : 0u)) << zeros;  // the leading one in bit 31
  const std::uint32_t y = (normal >> 19) & 0xFFF;                  // U0.12
  std::uint32_t fraction = y;                                      // U1.12
  switch (rule) {
    case spec::texture::Log2Rule::kMitchell:
      break;
    case spec::texture::Log2Rule::kCorrected:
      fraction = y + spec::texture::kLog2Correction[y >> 9];
      break;
    case spec::texture::Log2Rule::kSegments:
      fraction = y + segment_correction(y);
      break;
    case spec::texture::Log2Rule::kExact:
      fraction = interpolated(y);
      break;
  }
  return (15 - zeros) * 4096 + static_cast<std::int32_t>(fraction);
}

Activity Log2Unit::tick(Cycle cycle) {
  if (!footprints_in.can_pop(cycle)) return kIdle;
  if (!logs_out.can_push(cycle)) return kStalledDownstream;
  const FootprintToken& in = footprints_in.front(cycle);
  logs_out.emplace(cycle) = {
      in.ticket, in.s, in.t, in.axis_s, in.axis_t, log2(rule_, in.d_max), log2(rule_, in.d_min)};
  footprints_in.pop(cycle);
  return kBusy;
}

}  // namespace deburr::rtl::texture
