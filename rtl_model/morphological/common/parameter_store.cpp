// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/common/parameter_store.h"

#include <algorithm>

namespace deburr::rtl::morphological {
namespace {

namespace reg = spec::morphological::reg;

int lanes_of(const spec::morphological::Parameters& p) {
  return spec::morphological::kLaneCount[static_cast<std::size_t>(p.lanes)];
}
bool is_learned(const spec::morphological::Parameters& p) {
  return p.area == spec::morphological::AreaSource::kLearned;
}
bool is_table(const spec::morphological::Parameters& p) {
  return p.area != spec::morphological::AreaSource::kAnalytic && !is_learned(p);
}
int reach_rows_of(const spec::morphological::Parameters& p) { return p.window_rows / 2 - 1; }

}  // namespace

ControlLayout control_layout() {
  return rtl::control_layout(spec::morphological::kRegisters,
                             spec::morphological::kBusyIgnoresWrites);
}

Decoded decode(const ControlRegisters& registers, const spec::morphological::Parameters& p) {
  const std::uint32_t size = registers.value(reg::kSize), rules = registers.value(reg::kRules);
  const std::int32_t lanes = lanes_of(p), reach_rows = reach_rows_of(p);
  Decoded decoded;
  FrameRules& f = decoded.rules;
  f.width = static_cast<std::int32_t>(reg::size::kWidth.of(size));
  f.height = static_cast<std::int32_t>(reg::size::kHeight.of(size));
  decoded.valid = f.width >= 1 && f.height >= 1 && f.width <= spec::morphological::kMaxFrameSize &&
                  f.height <= spec::morphological::kMaxFrameSize && f.width <= p.line_pixels;
  f.beats = static_cast<std::uint32_t>((f.width + lanes - 1) / lanes);
  f.rows = static_cast<std::uint32_t>(f.height + reach_rows + spec::morphological::kRowLag);
  f.last_count = f.width - (static_cast<std::int32_t>(f.beats) - 1) * lanes;

  namespace field = reg::rules;
  const auto is_set = [&](const spec::Field& flag) { return flag.of(rules) != 0; };
  f.source = choice_of<spec::morphological::EdgeSource>(field::kSource, rules);
  f.dynamic = is_set(field::kThresholdMode) && f.source == spec::morphological::EdgeSource::kLuma;
  f.dynamic_luma = choice_of<spec::morphological::DynamicLuma>(field::kDynamicLuma, rules);
  f.local_contrast = choice_of<spec::morphological::LocalContrast>(field::kLocalContrast, rules);
  if (f.source == spec::morphological::EdgeSource::kDepth)
    f.local_contrast = spec::morphological::LocalContrast::kOff;
  f.predictor = choice_of<spec::morphological::Predictor>(field::kPredictor, rules);
  f.steps = std::min({static_cast<std::int32_t>(field::kSteps.of(rules)),
                      spec::morphological::kMaxSteps, reach_rows - 1});
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
  f.table = is_set(field::kTable) && is_table(p);
  f.clamp = is_set(field::kBorder) && p.border == spec::morphological::Border::kClamp &&
            f.crossings && f.table;
  f.learned = is_set(field::kLearned) && is_learned(p);
  f.search_steps =
      std::clamp(number(reg::smaa::kSearchSteps), 1, spec::morphological::kMaxSearchSteps);
  if (is_set(field::kDiagonals) && p.diagonals)
    f.diagonal_steps = std::min({number(reg::smaa::kDiagonalSteps), p.diagonal_steps, reach_rows});
  f.corners = is_set(field::kRoundCorners) && p.round_corners;
  f.corner_loss =
      std::max(spec::morphological::kMaxCornerRounding - number(reg::smaa::kCornerRounding), 0);
  f.strongest = is_set(field::kStrongest);
  f.leave = choice_of<spec::morphological::Leave>(field::kLeave, rules);
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

ParameterStore::ParameterStore(ControlRegisters& registers,
                               const spec::morphological::Parameters& p)
    : registers_(registers), parameters_(p), lanes_(lanes_of(p)), reach_rows_(reach_rows_of(p)) {
  if (!is_learned(p))
    for (const std::uint32_t offset : {reg::kSharesAddress, reg::kSharesData})
      registers.set_mask(offset, 0);
  registers.set_resets(spec::morphological::loaded_registers(p));
  registers.on_busy([this] { return inside_; });
  for (const std::uint32_t offset : {reg::kSharesAddress, reg::kSharesData, reg::kSharesSum})
    registers.on_read(offset, [] { return 0u; });
}

bool ParameterStore::latch() {
  registers_.mask_values();
  const Decoded decoded = decode(registers_, parameters_);
  if (!decoded.valid) {
    set_sticky(reg::kStatusFraming);
    return false;
  }
  rules_ = decoded.rules;
  inside_ = true;
  return true;
}

void ParameterStore::leave() {
  inside_ = false;
  set_sticky(reg::kStatusFrameDone);
}

}  // namespace deburr::rtl::morphological
