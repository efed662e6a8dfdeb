// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/parameter_store.h"

#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "spec/error.h"

namespace deburr::rtl::morphological {
namespace {

namespace reg = spec::morphological::reg;

constexpr std::size_t kCount = spec::morphological::kRegisters.size();
constexpr std::uint32_t kCoordinateMask = 0x3FFF;

constexpr Access fabric_access(spec::Access access) {
  switch (access) {
    case spec::Access::kReadOnly:
      return Access::kReadOnly;
    case spec::Access::kReadWrite:
      return Access::kReadWrite;
    case spec::Access::kWriteOneToClear:
      return Access::kWriteOneToClear;
    case spec::Access::kCommand:
      break;
  }
  return Access::kWriteOnly;
}

constexpr std::array<RegisterDescription, kCount> kTable = [] {
  std::array<RegisterDescription, kCount> table{};
  for (std::size_t i = 0; i < kCount; ++i) {
    const spec::RegisterInfo& info = spec::morphological::kRegisters[i];
    table[i] = {info.offset, info.name.data(), fabric_access(info.access), info.reset,
                info.meaning.data()};
  }
  return table;
}();

constexpr std::size_t index_at(std::uint32_t offset) {
  std::size_t i = 0;
  while (spec::morphological::kRegisters[i].offset != offset) ++i;
  return i;
}

// Bits [high:low] of a register.
constexpr std::uint32_t bits(std::uint32_t value, int high, int low) {
  return (value >> low) & ((1u << (high - low + 1)) - 1);
}

// The bits of each register that exist.
constexpr std::uint32_t writable(std::uint32_t offset) {
  switch (offset) {
    case reg::kSize:
      return 0x3FFF3FFF;
    case reg::kRules:
      return 0x1FFFF;
    case reg::kPixelBase:
      return ~(static_cast<std::uint32_t>(spec::morphological::kFrameLineBytes) - 1);
    default:
      return 0xFFFF;  // thresholds
  }
}

std::uint32_t encode_rules(const spec::morphological::Parameters& p) {
  return static_cast<std::uint32_t>(p.edge_source) |
         static_cast<std::uint32_t>(p.threshold_mode) << 2 |
         static_cast<std::uint32_t>(p.dynamic_luma) << 3 |
         static_cast<std::uint32_t>(p.local_contrast) << 4 |
         static_cast<std::uint32_t>(p.predictor) << 6 | static_cast<std::uint32_t>(p.steps) << 8 |
         static_cast<std::uint32_t>(p.contiguous) << 13 | static_cast<std::uint32_t>(p.safe) << 14 |
         static_cast<std::uint32_t>(p.linear_light) << 15 |
         static_cast<std::uint32_t>(p.trim) << 16;
}

template <class Choice>
Choice choice(std::uint32_t code, std::size_t choices) {
  return static_cast<Choice>(code < choices ? code : 0);
}

}  // namespace

std::span<const RegisterDescription> register_table() { return kTable; }

ParameterStore::ParameterStore(const sc_core::sc_module_name& name,
                               const spec::morphological::Parameters& parameters)
    : sc_module(name),
      registers("registers", kTable),
      parameters_(parameters),
      lanes_(spec::morphological::kLaneCount[static_cast<std::size_t>(parameters.lanes)]),
      reach_rows_(parameters.window_rows / 2 - 1) {
  for (std::size_t i = 0; i < kCount; ++i)
    if (kTable[i].access == Access::kReadWrite)
      registers.on_write(i, [this, i](std::uint32_t value) { written(i, value); });
  registers.on_write(index_at(reg::kStatus), [this](std::uint32_t value) { sticky_ &= ~value; });
  registers.on_read(index_at(reg::kStatus),
                    [this] { return sticky_ | (inside_ ? 0 : reg::kStatusIdle); });
  load();
}

// Reset values that the parameters give.
void ParameterStore::load() {
  const spec::morphological::Parameters& p = parameters_;
  const std::pair<std::uint32_t, std::uint32_t> values[] = {
      {reg::kRules, encode_rules(p)},
      {reg::kThreshold, static_cast<std::uint32_t>(p.threshold)},
      {reg::kThresholdOn, static_cast<std::uint32_t>(p.threshold_on_depth_edge)},
      {reg::kThresholdOff, static_cast<std::uint32_t>(p.threshold_off_depth_edge)},
      {reg::kAlpha, static_cast<std::uint32_t>(p.alpha)},
      {reg::kFloor, static_cast<std::uint32_t>(p.floor)},
      {reg::kDepthThreshold, static_cast<std::uint32_t>(p.depth_threshold)}};
  for (const auto& [offset, value] : values) registers.set(index_at(offset), value);
  for (std::size_t i = 0; i < kCount; ++i) kept_[i] = registers.get(i);
  decode();
}

void ParameterStore::reset() {
  registers.reset();
  enabled_ = true;
  inside_ = false;
  sticky_ = 0;
  load();
}

void ParameterStore::written(std::size_t index, std::uint32_t value) {
  const std::uint32_t offset = kTable[index].offset;
  if (offset == reg::kControl) {
    enabled_ = value & reg::kControlEnable;
    if (value & reg::kControlClearCounters) clear_counters_();
    registers.set(index, value & reg::kControlEnable);
    return;
  }
  if (inside_) {
    sticky_ |= reg::kStatusWrittenWhileBusy;
    registers.set(index, kept_[index]);
    return;
  }
  kept_[index] = value & writable(offset);
  registers.set(index, kept_[index]);
  decode();
}

void ParameterStore::write_size(int width, int height) {
  const std::size_t index = index_at(reg::kSize);
  written(index, static_cast<std::uint32_t>(width) | static_cast<std::uint32_t>(height) << 16);
}

std::uint32_t ParameterStore::value_at(std::uint32_t offset) const {
  return registers.get(index_at(offset));
}

void ParameterStore::decode() {
  const std::uint32_t size = value_at(reg::kSize), rules = value_at(reg::kRules);
  FrameRules& f = next_;
  f.width = static_cast<std::int32_t>(size & kCoordinateMask);
  f.height = static_cast<std::int32_t>(size >> 16 & kCoordinateMask);
  size_valid_ = f.width >= 1 && f.height >= 1 && f.width <= spec::morphological::kMaxFrameSize &&
                f.height <= spec::morphological::kMaxFrameSize &&
                f.width <= parameters_.line_pixels;
  f.beats = static_cast<std::uint32_t>((f.width + lanes_ - 1) / lanes_);
  f.rows = static_cast<std::uint32_t>(f.height + reach_rows_ + spec::morphological::kRowLag);
  f.last_count = f.width - (static_cast<std::int32_t>(f.beats) - 1) * lanes_;

  f.source = choice<spec::morphological::EdgeSource>(bits(rules, 1, 0),
                                                     spec::morphological::kEdgeSourceNames.size());
  f.dynamic = bits(rules, 2, 2) != 0 && f.source == spec::morphological::EdgeSource::kLuma;
  f.dynamic_max = bits(rules, 3, 3) != 0;
  f.local_contrast = choice<spec::morphological::LocalContrast>(
      bits(rules, 5, 4), spec::morphological::kLocalContrastNames.size());
  if (f.source == spec::morphological::EdgeSource::kDepth)
    f.local_contrast = spec::morphological::LocalContrast::kOff;
  f.predictor = choice<spec::morphological::Predictor>(bits(rules, 7, 6),
                                                       spec::morphological::kPredictorNames.size());
  f.steps = std::min({static_cast<std::int32_t>(bits(rules, 12, 8)), spec::morphological::kMaxSteps,
                      reach_rows_ - 1});
  if (f.predictor == spec::morphological::Predictor::kNone) f.steps = 0;
  f.contiguous = bits(rules, 13, 13) != 0 && parameters_.contiguous;
  f.safe = bits(rules, 14, 14) != 0;
  f.linear_light = bits(rules, 15, 15) != 0;
  f.trim = bits(rules, 16, 16) != 0;

  f.threshold = 255 * value_at(reg::kThreshold);
  f.threshold_on = 255 * value_at(reg::kThresholdOn);
  f.threshold_off = 255 * value_at(reg::kThresholdOff);
  f.floor = 255 * value_at(reg::kFloor);
  f.alpha = value_at(reg::kAlpha);
  f.depth_threshold = value_at(reg::kDepthThreshold);
  f.pixel_base = value_at(reg::kPixelBase);
}

bool ParameterStore::latch() {
  // Debug writes go past written(), so their bits are masked here.
  for (std::size_t i = 0; i < kCount; ++i) {
    const std::uint32_t offset = kTable[i].offset;
    if (kTable[i].access != Access::kReadWrite || offset == reg::kControl) continue;
    kept_[i] = registers.get(i) & writable(offset);
    registers.set(i, kept_[i]);
  }
  decode();
  if (!size_valid_) {
    sticky_ |= reg::kStatusFraming;
    return false;
  }
  rules_ = next_;
  inside_ = true;
  return true;
}

void ParameterStore::leave() {
  inside_ = false;
  sticky_ |= reg::kStatusFrameDone;
}

void ParameterStore::show(std::uint32_t offset, const Counter& counter) {
  registers.show(index_at(offset), counter);
}

void ParameterStore::show_sum(std::uint32_t offset, const Counter& a, const Counter& b) {
  registers.on_read(index_at(offset),
                    [&a, &b] { return static_cast<std::uint32_t>(a.value() + b.value()); });
}

void ParameterStore::connect(std::function<void()> clear_counters) {
  clear_counters_ = std::move(clear_counters);
}

}  // namespace deburr::rtl::morphological
