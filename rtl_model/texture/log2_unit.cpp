// SPDX-License-Identifier: MIT
#include "rtl_model/texture/log2_unit.h"

#include <bit>

#include "spec/texture_tables.h"

namespace deburr::rtl::texture {
namespace {

// The line that is added to n + y in each quarter of an octave, U0.12: constants and shifted copies
// of r, the position inside the quarter.
std::uint32_t segment_correction(std::uint32_t y) {
  const std::uint32_t r = y & 1023;
  switch (y >> 10) {
    case 0:
      return 20 + (r >> 2) + (r >> 5);
    case 1:
      return 305 + (r >> 4) - (r >> 7);
    case 2:
      return 356 - (r >> 3) + (r >> 6);
    default:
      return 243 - (r >> 2) + (r >> 6);
  }
}

// Fraction of the logarithm by table and linear interpolation, U1.12.
std::uint32_t interpolated(std::uint32_t y) {
  const std::uint32_t low = spec::kLog2Table[y >> 6], high = spec::kLog2Table[(y >> 6) + 1];
  return low + (((high - low) * (y & 63) + 32) >> 6);
}

}  // namespace

Log2Unit::Log2Unit(const sc_core::sc_module_name& name, ClockDomain& clock, spec::Log2Rule rule)
    : Unit(name, clock), rule_(rule) {}

std::int32_t Log2Unit::log2(spec::Log2Rule rule, std::uint32_t d) {
  const int zeros = std::countl_zero(d | (d == 0 ? 1u : 0u));      // leading-one detector
  const std::uint32_t normal = (d | (d == 0 ? 1u : 0u)) << zeros;  // the leading one in bit 31
  const std::uint32_t y = (normal >> 19) & 0xFFF;                  // U0.12
  std::uint32_t fraction = y;                                      // U1.12
  switch (rule) {
    case spec::Log2Rule::kMitchell:
      break;
    case spec::Log2Rule::kCorrected:
      fraction = y + spec::kLog2Correction[y >> 9];
      break;
    case spec::Log2Rule::kSegments:
      fraction = y + segment_correction(y);
      break;
    case spec::Log2Rule::kExact:
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
