// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/parameter_store.h"

#include <algorithm>

#include "rtl_model/morphological/blend/shares_rom.h"

namespace deburr::rtl::morphological {
namespace {

namespace reg = spec::morphological::reg;

constexpr std::uint32_t kCoordinateMask = 0x3FFF;
constexpr std::uint32_t kSharesAddressMask = 0xFFF;

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

// Bits [high:low] of a register.
constexpr std::uint32_t bits(std::uint32_t value, int high, int low) {
  return (value >> low) & ((1u << (high - low + 1)) - 1);
}

// The bits of each register that exist.
std::uint32_t writable(std::uint32_t offset, const spec::morphological::Parameters& p) {
  switch (offset) {
    case reg::kSize:
      return 0x3FFF3FFF;
    case reg::kRules:
      return 0x7FFFFFF;
    case reg::kSmaa:
      return 0x01FF1F7F;
    case reg::kSharesAddress:
      return is_learned(p) ? kSharesAddressMask : 0;
    case reg::kSharesData:
      return is_learned(p) ? 0xFF : 0;
    case reg::kPixelBase:
      return ~(static_cast<std::uint32_t>(spec::morphological::kFrameLineBytes) - 1);
    default:
      return 0xFFFF;  // thresholds
  }
}

std::uint32_t encode_rules(const spec::morphological::Parameters& p) {
  return static_cast<std::uint32_t>(p.edge_source) |
         static_cast<std::uint32_t>(p.threshold_mode) << 2 |
         (static_cast<std::uint32_t>(p.dynamic_luma) & 1) << 3 |
         static_cast<std::uint32_t>(p.local_contrast) << 4 |
         static_cast<std::uint32_t>(p.predictor) << 6 | static_cast<std::uint32_t>(p.steps) << 8 |
         static_cast<std::uint32_t>(p.contiguous) << 13 | static_cast<std::uint32_t>(p.safe) << 14 |
         static_cast<std::uint32_t>(p.linear_light) << 15 |
         static_cast<std::uint32_t>(p.trim) << 16 |
         static_cast<std::uint32_t>(p.dynamic_luma) >> 1 << 17 |
         static_cast<std::uint32_t>(p.ends) << 18 | static_cast<std::uint32_t>(is_table(p)) << 19 |
         static_cast<std::uint32_t>(p.diagonals) << 20 |
         static_cast<std::uint32_t>(p.round_corners) << 21 |
         static_cast<std::uint32_t>(p.blend) << 22 |
         (static_cast<std::uint32_t>(p.leave) & 3) << 23 |
         static_cast<std::uint32_t>(is_learned(p)) << 25 |
         static_cast<std::uint32_t>(p.leave) >> 2 << 26;
}

std::uint32_t encode_smaa(const spec::morphological::Parameters& p) {
  return static_cast<std::uint32_t>(p.search_steps) |
         static_cast<std::uint32_t>(p.diagonal_steps) << 8 |
         static_cast<std::uint32_t>(p.corner_rounding) << 16;
}

template <class Choice>
Choice choice(std::uint32_t code, std::size_t choices) {
  return static_cast<Choice>(code < choices ? code : 0);
}

}  // namespace

ControlLayout control_layout() {
  return {.control = reg::kControl,
          .status = reg::kStatus,
          .enable = reg::kControlEnable,
          .clear_counters = reg::kControlClearCounters,
          .idle = reg::kStatusIdle,
          .written_while_busy = reg::kStatusWrittenWhileBusy,
          .busy_ignores_writes = true};
}

Decoded decode(const ControlRegisters& registers, const spec::morphological::Parameters& p) {
  const std::uint32_t size = registers.value(reg::kSize), rules = registers.value(reg::kRules);
  const std::int32_t lanes = lanes_of(p), reach_rows = reach_rows_of(p);
  Decoded decoded;
  FrameRules& f = decoded.rules;
  f.width = static_cast<std::int32_t>(size & kCoordinateMask);
  f.height = static_cast<std::int32_t>(size >> 16 & kCoordinateMask);
  decoded.valid = f.width >= 1 && f.height >= 1 && f.width <= spec::morphological::kMaxFrameSize &&
                  f.height <= spec::morphological::kMaxFrameSize && f.width <= p.line_pixels;
  f.beats = static_cast<std::uint32_t>((f.width + lanes - 1) / lanes);
  f.rows = static_cast<std::uint32_t>(f.height + reach_rows + spec::morphological::kRowLag);
  f.last_count = f.width - (static_cast<std::int32_t>(f.beats) - 1) * lanes;

  f.source = choice<spec::morphological::EdgeSource>(bits(rules, 1, 0),
                                                     spec::morphological::kEdgeSourceNames.size());
  f.dynamic = bits(rules, 2, 2) != 0 && f.source == spec::morphological::EdgeSource::kLuma;
  f.dynamic_luma =
      static_cast<spec::morphological::DynamicLuma>(bits(rules, 3, 3) | bits(rules, 17, 17) << 1);
  f.local_contrast = choice<spec::morphological::LocalContrast>(
      bits(rules, 5, 4), spec::morphological::kLocalContrastNames.size());
  if (f.source == spec::morphological::EdgeSource::kDepth)
    f.local_contrast = spec::morphological::LocalContrast::kOff;
  f.predictor = choice<spec::morphological::Predictor>(bits(rules, 7, 6),
                                                       spec::morphological::kPredictorNames.size());
  f.steps = std::min({static_cast<std::int32_t>(bits(rules, 12, 8)), spec::morphological::kMaxSteps,
                      reach_rows - 1});
  if (f.predictor == spec::morphological::Predictor::kNone) f.steps = 0;
  f.contiguous = bits(rules, 13, 13) != 0 && p.contiguous;
  f.safe = bits(rules, 14, 14) != 0;
  f.linear_light = bits(rules, 15, 15) != 0;
  f.trim = bits(rules, 16, 16) != 0;

  const std::uint32_t smaa = registers.value(reg::kSmaa);
  const auto field = [&](int high, int low) {
    return static_cast<std::int32_t>(bits(smaa, high, low));
  };
  f.crossings = bits(rules, 18, 18) != 0 && p.ends == spec::morphological::Ends::kCrossings;
  f.table = bits(rules, 19, 19) != 0 && is_table(p);
  f.learned = bits(rules, 25, 25) != 0 && is_learned(p);
  f.search_steps = std::clamp(field(6, 0), 1, spec::morphological::kMaxSearchSteps);
  if (bits(rules, 20, 20) != 0 && p.diagonals)
    f.diagonal_steps = std::min({field(12, 8), p.diagonal_steps, reach_rows});
  f.corners = bits(rules, 21, 21) != 0 && p.round_corners;
  f.corner_loss = std::max(spec::morphological::kMaxCornerRounding - field(24, 16), 0);
  f.strongest = bits(rules, 22, 22) != 0;
  f.leave = choice<spec::morphological::Leave>(bits(rules, 24, 23) | bits(rules, 26, 26) << 2,
                                               spec::morphological::kLeaveNames.size());

  f.threshold = 255 * registers.value(reg::kThreshold);
  f.threshold_on = 255 * registers.value(reg::kThresholdOn);
  f.threshold_off = 255 * registers.value(reg::kThresholdOff);
  f.floor = 255 * registers.value(reg::kFloor);
  f.alpha = registers.value(reg::kAlpha);
  f.depth_threshold = registers.value(reg::kDepthThreshold);
  f.pixel_base = registers.value(reg::kPixelBase);
  return decoded;
}

ParameterStore::ParameterStore(ControlRegisters& registers,
                               const spec::morphological::Parameters& p)
    : registers_(registers), parameters_(p), lanes_(lanes_of(p)), reach_rows_(reach_rows_of(p)) {
  for (const spec::RegisterInfo& info : spec::morphological::kRegisters)
    if (info.access == spec::Access::kReadWrite && info.offset != reg::kControl)
      registers.set_mask(info.offset, writable(info.offset, p));
  registers.set_reset(reg::kRules, encode_rules(p));
  registers.set_reset(reg::kThreshold, static_cast<std::uint32_t>(p.threshold));
  registers.set_reset(reg::kThresholdOn, static_cast<std::uint32_t>(p.threshold_on_depth_edge));
  registers.set_reset(reg::kThresholdOff, static_cast<std::uint32_t>(p.threshold_off_depth_edge));
  registers.set_reset(reg::kAlpha, static_cast<std::uint32_t>(p.alpha));
  registers.set_reset(reg::kFloor, static_cast<std::uint32_t>(p.floor));
  registers.set_reset(reg::kDepthThreshold, static_cast<std::uint32_t>(p.depth_threshold));
  registers.set_reset(reg::kSmaa, encode_smaa(p));
  registers.on_busy([this] { return inside_; });
  for (const std::uint32_t offset : {reg::kSharesAddress, reg::kSharesData, reg::kSharesSum})
    registers.on_read(offset, [] { return 0u; });
}

void ParameterStore::connect(SharesRom& rom) {
  shares_ = &rom;
  registers_.on_read(reg::kSharesAddress, [this] { return shares_address(); });
  registers_.on_read(reg::kSharesData, [this] { return shares_->entry(shares_address()); });
  registers_.on_read(reg::kSharesSum, [this] { return shares_->sum(); });
  registers_.on_taken(reg::kSharesData, [this](std::uint32_t value) { load_share(value); });
}

std::uint32_t ParameterStore::shares_address() const {
  return registers_.value(reg::kSharesAddress) & kSharesAddressMask;
}

void ParameterStore::load_share(std::uint32_t value) {
  const std::uint32_t address = shares_address();
  shares_->load(address, static_cast<std::uint8_t>(value));
  registers_.set(reg::kSharesAddress, (address + 1) & kSharesAddressMask);
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
