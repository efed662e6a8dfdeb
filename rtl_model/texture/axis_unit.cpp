// SPDX-License-Identifier: MIT
#include "rtl_model/texture/axis_unit.h"

#include <algorithm>
#include <array>

#include "rtl_model/texture/datasheets.h"
#include "rtl_model/texture/footprint_unit.h"
#include "rtl_model/texture/root_pipeline.h"

namespace deburr::rtl::texture {
namespace {

constexpr unsigned kDirections = 8;  // in half a turn

// Sine and cosine in 1/128: sums of at most four shifted operands in hardware.
constexpr std::array<std::int64_t, kDirections> kSine = {0, 49, 90, 118, 128, 118, 90, 49},
                                                kCosine = {128, 118, 90, 49, 0, -49, -90, -118};

// cos x along the row + sin x along the column, with 7 fraction bits.
std::int64_t rotated(std::int64_t row, std::int64_t column, unsigned direction) {
  return column * kSine[direction] + row * kCosine[direction];
}

// In texels: truncated magnitude, saturated.
std::uint64_t magnitude(std::int64_t v) {
  constexpr std::uint64_t kLargest = (std::uint64_t{1} << 31) - 1;  // U15.16
  return std::min(static_cast<std::uint64_t>(v < 0 ? -v : v) >> 7, kLargest);
}
// In coordinates: rounds the magnitude, so negative halves round down.
std::int64_t coordinate(std::int64_t v) { return (v + (v < 0 ? 63 : 64)) >> 7; }

// Derivative in texels with the sign of the coordinate difference.
std::int64_t with_sign(std::uint32_t size, std::int64_t difference) {
  return difference < 0 ? -std::int64_t{size} : std::int64_t{size};
}

}  // namespace

template <class Width>
AxisUnitOf<Width>::AxisUnitOf(const sc_core::sc_module_name& name, ClockDomain& clock,
                              spec::texture::Axes axes, spec::texture::FootprintRule rule,
                              std::int32_t axis_cycles)
    : Unit(name, clock),
      rule_(rule),
      step_(axes == spec::texture::Axes::kEight ? 1 : 2),
      more_cycles_(axis_cycles - 1) {}

template <class Width>
Activity AxisUnitOf<Width>::tick(Cycle cycle) {
  return rule_ == spec::texture::FootprintRule::kExact ? advance(cycle, root_stages_)
                                                       : advance(cycle, stages_);
}

template <class Width>
template <std::size_t kLength>
Activity AxisUnitOf<Width>::advance(
    Cycle cycle, Pipe<typename Width::template Fragments<FootprintToken>, kLength>& stages) {
  const bool arrives = cycles_left_ == 0 && derivatives_in.can_pop(cycle);
  if (stages.empty() && cycles_left_ == 0 && !arrives) return kIdle;
  if (stages.leaves() && !footprints_out.can_push(cycle)) return kStalledDownstream;
  stages.move();
  if (const auto* done = stages.at(kLength)) footprints_out.push(cycle, *done);
  if (arrives) {
    const auto turn_each = [this](const DerivativeToken& in, FootprintToken& out) {
      turn(in, out);
    };
    const auto& group = derivatives_in.take(cycle);
    if (more_cycles_ == 0) {
      each(group, stages.enter(), turn_each);
    } else {
      each(group, in_hand_, turn_each);
      cycles_left_ = more_cycles_;
    }
  } else if (cycles_left_ != 0 && --cycles_left_ == 0) {
    stages.enter() = in_hand_;
  }
  return kBusy;
}

template <class Width>
void AxisUnitOf<Width>::turn(const DerivativeToken& in, FootprintToken& out) const {
  const Candidate major = longest(in);
  out.ticket = in.ticket;
  out.s = in.s;
  out.t = in.t;
  out.d_max = rule_ == spec::texture::FootprintRule::kExact
                  ? RootPipeline::root(major.measure)
                  : static_cast<std::uint32_t>(major.measure);
  out.minor = area(in);
  // Stages 7 and 8.
  out.axis_s = coordinate(rotated(in.s_x, in.s_y, major.direction));
  out.axis_t = coordinate(rotated(in.t_x, in.t_y, major.direction));
  out.diagonal = major.direction % (kDirections / 2) == kDirections / 4;
}

// Stages 1 to 6. On ties the first candidate wins, within a cycle and across cycles.
template <class Width>
typename AxisUnitOf<Width>::Candidate AxisUnitOf<Width>::longest(const DerivativeToken& in) const {
  const std::int64_t row_s = with_sign(in.size_s_x, in.s_x), row_t = with_sign(in.size_t_x, in.t_x),
                     column_s = with_sign(in.size_s_y, in.s_y),
                     column_t = with_sign(in.size_t_y, in.t_y);
  Candidate best{};
  for (unsigned direction = 0; direction < kDirections; direction += step_) {
    const std::uint64_t length = measure(magnitude(rotated(row_s, column_s, direction)),
                                         magnitude(rotated(row_t, column_t, direction)));
    if (direction == 0 || length > best.measure) best = {length, direction};
  }
  return best;
}

template <class Width>
std::uint64_t AxisUnitOf<Width>::measure(std::uint64_t s, std::uint64_t t) const {
  if (rule_ == spec::texture::FootprintRule::kExact) return s * s + t * t;
  return FootprintUnit::side(rule_, static_cast<std::uint32_t>(s), static_cast<std::uint32_t>(t));
}

template <class Width>
void AxisUnitOf<Width>::reset() {
  cycles_left_ = 0;
  stages_.reset();
  root_stages_.reset();
}

// Stages 1 and 2: factors U15.8, area U31.16.
template <class Width>
std::uint64_t AxisUnitOf<Width>::area(const DerivativeToken& in) {
  const auto product = [](std::uint32_t s, std::uint32_t t) {
    return std::uint64_t{s >> 8} * (t >> 8);
  };
  const std::uint64_t falling = product(in.size_s_x, in.size_t_y),
                      rising = product(in.size_t_x, in.size_s_y);
  const bool falls = (in.s_x < 0) != (in.t_y < 0), rises = (in.t_x < 0) != (in.s_y < 0);
  if (falls != rises) return falling + rising;
  return falling > rising ? falling - rising : rising - falling;
}

template <class Width>
Datasheet AxisUnitOf<Width>::datasheet(const spec::texture::Parameters& p) {
  using spec::texture::Axes, spec::texture::FootprintRule;
  const bool exact = p.footprint == FootprintRule::kExact, eight = p.axes == Axes::kEight;
  const auto cycles = static_cast<std::uint64_t>(p.axis_cycles);
  const Sizes z(p);
  const std::uint32_t n = z.candidates, all = n * z.axis_cycles;
  // Candidates per cycle that are neither the row nor the column.
  const std::uint32_t rotated = (all - 2 + z.axis_cycles - 1) / z.axis_cycles;
  const std::uint32_t multiples = eight ? 3 : 1;  // 90; 49 and 118
  const auto multiplied = [&](std::uint32_t bits) {
    std::vector<Operator> operators = {4 * op::multiply_constant(bits, 3)};
    if (eight) operators.push_back(8 * op::multiply_constant(bits, 2));
    return operators;
  };
  // Without the sizes, and with valid: ticket, position, differences; and the area.
  constexpr std::uint32_t kToken = kPayloadBits<DerivativeToken> - 4 * 31 + 1, kArea = 47;
  constexpr std::uint32_t kDifferences = 4 * 33;
  const std::uint32_t direction = eight ? 3 : 2, group = z.axis_cycles > 1 ? 2 : 0;
  const std::uint32_t length = exact ? 63 : 32, kept = kToken + kArea + group;
  const std::uint32_t winners = n == 8 ? 2 : 1;  // of stage 5
  const bool again = n == 8 || z.axis_cycles > 1;
  Datasheet sheet = {
      .unit = "AxisUnit",
      .variant = chosen("axes", spec::texture::kAxesNames, p.axes) + ", " +
                 chosen("footprint", spec::texture::kFootprintNames, p.footprint),
      .does =
          "Finds the major axis among four or eight directions, and the area of the footprint "
          "(`axes = four`, `eight`; instead of the FootprintUnit).",
      .latency = exact ? Cycles{22 + cycles - 1, "22 + `axis_cycles` - 1"}
                       : Cycles{8 + cycles - 1, "8 + `axis_cycles` - 1"},
      .interval = {cycles, "`axis_cycles`"},
      .formats =
          "in: U15.16 and the signs of the differences; out: U16.16, U31.16 and S9.24; candidates "
          "truncated, axis rounded.",
      .copies = z.fragments,
      .per = "fragment",
      .cost = chosen("axis_cycles", cycles) + "."};
  auto& stages = sheet.stages;
  stages = {{.clock = "1",
             .work = "multiples 118/128, 90/128 and 49/128 of the derivatives in texels; two "
                     "products of the area",
             .operators = multiplied(31),
             .longest = {op::multiply(23, 23)},
             .registers = kToken + group + 4 * 31 + multiples * 4 * 38 + 2 * 46},
            {.clock = "2",
             .work = "magnitudes of the candidates; difference of the area's products",
             .operators = {2 * rotated * op::subtract(40), 2 * rotated * op::magnitude(40),
                           op::logic(2 * rotated * 33), op::subtract(47), op::magnitude(46)},
             .longest = {op::subtract(47), op::magnitude(46)},
             .registers = kept + n * 2 * 31}};
  stages[0].operators.push_back(2 * op::multiply(23, 23));
  if (z.axis_cycles > 1) {
    stages[1].operators.push_back(n * 4 * op::mux(38, z.axis_cycles));
    stages[1].longest.insert(stages[1].longest.begin(), op::mux(38, z.axis_cycles));
  }
  if (exact) {
    stages.push_back({.clock = "3",
                      .work = "squares of each candidate",
                      .operators = {2 * n * op::square(31)},
                      .longest = {op::square(31)},
                      .registers = kept + n * 2 * 62});
    stages.push_back({.clock = "4",
                      .work = "sums",
                      .operators = {n * op::add(62)},
                      .longest = {op::add(62)},
                      .registers = kept + n * length});
  } else {
    const SideHardware side = side_hardware(p.footprint, n);
    const bool two_lines = p.footprint == FootprintRule::kTwoSegment;
    stages.push_back({.clock = "3",
                      .work = "measure of each candidate",
                      .operators = side.operators,
                      .longest = side.longest,
                      .registers = kept + side.bits});
    stages.push_back(
        {.clock = "4", .work = "longer line of `two_segment`", .registers = kept + n * length});
    if (two_lines) stages.back().operators = {n * op::maximum(length)};
    if (two_lines) stages.back().longest = {op::maximum(length)};
  }
  const std::uint32_t compared = n - winners, in_series = n > 2 ? 2 : 1;
  stages.push_back({.clock = "5",
                    .work = n > 2 ? "longest of four" : "longest of two",
                    .operators = {compared * op::maximum(length), compared * op::mux(direction, 2)},
                    .longest = {in_series * op::maximum(length)},
                    .registers = kept + winners * (length + direction)});
  stages.push_back({.clock = "6",
                    .work = "longest of this and the previous cycles",
                    .registers = kept - group + length + direction});
  if (again) stages.back().operators = {op::maximum(length), op::mux(direction, 2)};
  if (again) stages.back().longest = {op::maximum(length)};
  // Stages 7 and 8 compute the axis, with `exact` in parallel with the first bits of the root.
  const Operator digits = op::root_stage(RootPipeline::kMeanRest);
  const std::uint32_t root = exact ? RootPipeline::kMeanRegisters : length;
  const std::uint32_t diagonal = selects_kernel(p) ? 1 : 0;
  const std::uint32_t without_differences = kToken + kArea - kDifferences + diagonal;
  stages.push_back({.clock = "7",
                    .work = "the same multiples of the coordinate differences, for the direction "
                            "found",
                    .operators = multiplied(33),
                    .longest = {op::multiply_constant(33, 3), op::mux(40, multiples + 2)},
                    .registers = without_differences + 4 * 41 + root});
  stages.back().operators.push_back(4 * op::mux(40, multiples + 2));
  stages.back().operators.push_back(op::logic(2 * 41 + 2 * diagonal));
  stages.push_back({.clock = "8",
                    .work = "sum, rounded",
                    .operators = {4 * op::add(41)},
                    .longest = {2 * op::add(41)}});
  if (!exact) return sheet;
  const std::uint32_t registers = without_differences + 2 * 34 + root;
  for (std::size_t i : {stages.size() - 2, stages.size() - 1}) {
    stages[i].work += "; two root bits";
    stages[i].operators.push_back(digits);
  }
  stages.back().registers = registers;
  stages.push_back({.clock = "9-21",
                    .work = "two root bits each",
                    .operators = {digits},
                    .longest = {op::root_stage(RootPipeline::kRest)},
                    .registers = registers});
  stages.push_back({.clock = "22",
                    .work = "two root bits",
                    .operators = {digits},
                    .longest = {op::root_stage(RootPipeline::kRest)}});
  return sheet;
}

template class AxisUnitOf<Narrow>;
template class AxisUnitOf<Wide>;

}  // namespace deburr::rtl::texture
