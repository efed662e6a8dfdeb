// SPDX-License-Identifier: MIT
#include "rtl_model/posteriser/posteriser.h"

#include <algorithm>

#include "spec/posteriser/check_build.h"
#include "spec/posteriser/registers.h"

namespace deburr::rtl::posteriser {
namespace {

namespace reg = spec::posteriser::reg;

// 255 level / steps, rounded, halves up.
std::uint32_t code(std::uint32_t level, std::uint32_t steps) {
  return (510 * level + steps) / (2 * steps);
}

// The nearer of two levels: the one at or below the exact value, and the next one.
std::uint32_t nearest(std::uint32_t value, std::uint32_t steps) {
  const std::uint32_t below = value * steps / 255;
  if (below == steps) return 255;
  const std::uint32_t low = code(below, steps), high = code(below + 1, steps);
  return high - value <= value - low ? high : low;
}

}  // namespace

Activity LevelUnit::tick(Cycle cycle) {
  if (!tones_in.can_pop(cycle)) return kIdle;
  if (!tones_out.can_push(cycle)) return kStalledDownstream;
  const std::uint32_t configuration = control_.value(reg::kConfiguration),
                      bits = std::clamp(reg::configuration::kBits.of(configuration), 1u, 8u);
  const std::uint32_t steps = (1u << bits) - 1;
  spec::posteriser::Tone tone = tones_in.take(cycle);
  const spec::posteriser::Tone before = tone;
  for (std::uint8_t& colour : tone.colour)
    colour = static_cast<std::uint8_t>(reg::configuration::kRounding.of(configuration) != 0
                                           ? nearest(colour, steps)
                                           : code(std::uint32_t{colour} >> (8 - bits), steps));
  ++pixels;
  if (!(tone == before)) ++changed;
  tones_out.push(cycle, tone);
  return kBusy;
}

Datasheet LevelUnit::datasheet() {
  return {.unit = "LevelUnit",
          .does = "Gives each colour of a pixel the code of its level.",
          .latency = {1},
          .stages = {{"1", "level of three colours, its code", "8 x 8 multiply + divide by 255"}},
          .formats = "U0.8 codes in and out.",
          .cost = "three multipliers of 8 x 8, two divisions by a constant."};
}

Posteriser::Posteriser(const sc_core::sc_module_name& name, ClockDomain& clock,
                       const spec::posteriser::Parameters& parameters)
    : Engine(name, clock, spec::posteriser::kRegisters,
             control_layout(spec::posteriser::kRegisters, spec::posteriser::kBusyIgnoresWrites)),
      clock_(clock),
      levels("levels", clock, control) {
  const spec::posteriser::Parameters p = check_build(parameters);
  levels.tones_in(tones_in);
  levels.tones_out(tones_out);
  control.set_resets(spec::posteriser::loaded_registers(p));
  control.show(reg::kPixels, levels.pixels);
  control.show(reg::kChanged, levels.changed);
  control.reset();
}

}  // namespace deburr::rtl::posteriser
