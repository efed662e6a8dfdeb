// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/common/parameter_store.h"

#include <algorithm>

namespace deburr::rtl::morphological {
namespace {

namespace reg = spec::morphological::reg;

}  // namespace

ControlLayout control_layout() {
  return rtl::control_layout(spec::morphological::kRegisters,
                             spec::morphological::kBusyIgnoresWrites);
}

Decoded decode(const ControlRegisters& registers, const spec::morphological::Parameters& p) {
  const std::uint32_t size = registers.value(reg::kSize),
                      configuration = registers.value(reg::kConfiguration);
  const std::int32_t lanes = built_lanes(p), search_rows = search_range_rows_of(p);
  const auto u16 = [](std::int32_t value) { return static_cast<std::uint16_t>(value); };
  Decoded decoded;
  FrameConfiguration& f = decoded.configuration;
  f.width = static_cast<std::uint16_t>(reg::size::kWidth.of(size));
  f.height = static_cast<std::uint16_t>(reg::size::kHeight.of(size));
  decoded.valid = f.width >= 1 && f.height >= 1 && f.width <= spec::morphological::kMaxFrameSize &&
                  f.height <= spec::morphological::kMaxFrameSize && f.width <= p.line_pixels;
  f.beats = static_cast<std::uint32_t>((f.width + lanes - 1) / lanes);
  f.rows = static_cast<std::uint32_t>(f.height + search_rows + spec::morphological::kRowLag);
  f.last_count = u16(f.width - (static_cast<std::int32_t>(f.beats) - 1) * lanes);

  namespace field = reg::configuration;
  const auto is_set = [&](const spec::Field& flag) { return flag.of(configuration) != 0; };
  f.source = choice_of<spec::morphological::EdgeSource>(field::kSource, configuration);
  f.dynamic = is_set(field::kThresholdMode) && f.source == spec::morphological::EdgeSource::kLuma;
  f.dynamic_luma = choice_of<spec::morphological::DynamicLuma>(field::kDynamicLuma, configuration);
  f.local_contrast =
      choice_of<spec::morphological::LocalContrast>(field::kLocalContrast, configuration);
  if (f.source == spec::morphological::EdgeSource::kDepth)
    f.local_contrast = spec::morphological::LocalContrast::kOff;
  f.predictor = choice_of<spec::morphological::Predictor>(field::kPredictor, configuration);
  f.steps = u16(std::min({static_cast<std::int32_t>(field::kSteps.of(configuration)),
                          spec::morphological::kMaxSteps, search_rows - 1}));
  if (f.predictor == spec::morphological::Predictor::kNone) f.steps = 0;
  f.contiguous = is_set(field::kContiguous) && p.contiguous;
  f.safe = is_set(field::kSafe);
  f.linear_light = is_set(field::kLinearLight);
  f.trim = is_set(field::kTrim);

  const std::uint32_t smaa = registers.value(reg::kSmaa);
  const auto number = [&](const spec::Field& steps) {
    return static_cast<std::int32_t>(steps.of(smaa));
  };
  f.crossings = is_set(field::kCrossings) && p.ends == spec::morphological::Ends::kCrossings;
  f.table = is_set(field::kTable) && has_table(p);
  f.clamp = is_set(field::kBorder) && p.border == spec::morphological::Border::kClamp &&
            f.crossings && f.table;
  f.learned = is_set(field::kLearned) && p.area == spec::morphological::AreaSource::kLearned;
  f.search_steps =
      u16(std::clamp(number(reg::smaa::kSearchSteps), 1, spec::morphological::kMaxSearchSteps));
  if (is_set(field::kDiagonals) && p.diagonals)
    f.diagonal_steps =
        u16(std::min({number(reg::smaa::kDiagonalSteps), p.diagonal_steps, search_rows}));
  f.corners = is_set(field::kRoundCorners) && p.round_corners;
  f.corner_loss = u16(
      std::max(spec::morphological::kMaxCornerRounding - number(reg::smaa::kCornerRounding), 0));
  f.strongest = is_set(field::kStrongest);
  f.bypass = choice_of<spec::morphological::Bypass>(field::kBypass, configuration);
  f.text_guard = is_set(field::kTextGuard) && p.text_guard;

  f.threshold = registers.value(reg::kThreshold);
  f.threshold_on = registers.value(reg::kThresholdOn);
  f.threshold_off = registers.value(reg::kThresholdOff);
  f.floor = registers.value(reg::kFloor);
  f.alpha = registers.value(reg::kAlpha);
  f.depth_threshold = registers.value(reg::kDepthThreshold);
  f.pixel_base = registers.value(reg::kPixelBase);
  return decoded;
}

ParameterStore::ParameterStore(const sc_core::sc_module_name& name, ControlRegisters& registers,
                               const spec::morphological::Parameters& p)
    : sc_module(name),
      first_beat_in("first_beat_in",
                    [this](Cycle cycle) { enabled_out.drive(cycle, registers_.enabled()); }),
      frame_done_in("frame_done_in",
                    [this](Cycle /*cycle*/) { registers_.set_sticky(reg::kStatusFrameDone); }),
      framing_in("framing_in",
                 [this](Cycle /*cycle*/) { registers_.set_sticky(reg::kStatusFraming); }),
      registers_(registers),
      parameters_(p) {
  if (p.storage == spec::morphological::Storage::kMemory)
    memory_error_in.emplace("memory_error_in", [this](Cycle /*cycle*/) {
      registers_.set_sticky(reg::kStatusMemoryError);
    });
  if (p.area != spec::morphological::AreaSource::kLearned)
    for (const std::uint32_t offset : {reg::kWeightsAddress, reg::kWeightsData})
      registers.set_mask(offset, 0);
  registers.set_resets(spec::morphological::loaded_registers(p));
  for (const std::uint32_t offset : {reg::kWeightsAddress, reg::kWeightsData, reg::kWeightsSum})
    registers.on_read(offset, [] { return 0u; });
}

void ParameterStore::latch(Cycle cycle) {
  registers_.mask_values();
  const Decoded decoded = decode(registers_, parameters_);
  latched_out.drive(cycle, decoded);
  if (decoded.valid)
    configuration_out.drive(cycle, decoded.configuration);
  else
    registers_.set_sticky(reg::kStatusFraming);
}

}  // namespace deburr::rtl::morphological
