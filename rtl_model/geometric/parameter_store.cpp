// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/parameter_store.h"

#include <algorithm>

#include "spec/geometric/records.h"

namespace deburr::rtl::geometric {
namespace {

namespace reg = spec::geometric::reg;
using spec::geometric::Refusal;

constexpr std::uint32_t kCoordinateMask = 0x3FFF;
constexpr std::uint32_t kRulesMask = 0xFFFD;

constexpr std::uint32_t bits(std::uint32_t value, int high, int low) {
  return (value >> low) & ((1u << (high - low + 1)) - 1);
}

// The bits of each register that exist.
constexpr std::uint32_t writable(std::uint32_t offset) {
  switch (offset) {
    case reg::kSize:
      return kCoordinateMask << 16 | kCoordinateMask;
    case reg::kRules:
      return kRulesMask;
    case reg::kEdgeCount:
    case reg::kVertexCount:
    case reg::kFaceCount:
      return ~std::uint32_t{0};
    default:
      return ~(std::uint32_t{spec::geometric::kLineBytes} - 1);
  }
}

std::uint32_t encode_rules(const spec::geometric::Parameters& p) {
  return static_cast<std::uint32_t>(p.select) | static_cast<std::uint32_t>(p.crease) << 2 |
         static_cast<std::uint32_t>(p.depth_test) << 4 |
         static_cast<std::uint32_t>(p.combine) << 6 |
         static_cast<std::uint32_t>(p.linear_light) << 7 |
         static_cast<std::uint32_t>(p.depth_bias) << 8 | static_cast<std::uint32_t>(p.mark) << 13 |
         static_cast<std::uint32_t>(p.layout) << 14 |
         static_cast<std::uint32_t>(p.frame_copy) << 15;
}

template <class Choice, std::size_t N>
Choice choice(std::uint32_t code, const std::array<std::string_view, N>&) {
  return static_cast<Choice>(code < N ? code : 0);
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

FrameRules decode(const ControlRegisters& registers) {
  const std::uint32_t size = registers.value(reg::kSize), rules = registers.value(reg::kRules);
  FrameRules f;
  const std::uint32_t width = bits(size, 13, 0), height = bits(size, 29, 16);
  f.width = static_cast<std::int32_t>(width);
  f.height = static_cast<std::int32_t>(height);
  f.select = static_cast<spec::geometric::Select>(bits(rules, 0, 0));
  f.crease = choice<spec::geometric::Crease>(bits(rules, 3, 2), spec::geometric::kCreaseNames);
  f.depth_test =
      choice<spec::geometric::DepthTest>(bits(rules, 5, 4), spec::geometric::kDepthTestNames);
  f.combine = static_cast<spec::geometric::Combine>(bits(rules, 6, 6));
  f.linear_light = bits(rules, 7, 7) != 0;
  f.depth_bias = std::clamp(bits(rules, 12, 8), 1U, std::uint32_t{spec::geometric::kDepthBits});
  f.mark = bits(rules, 13, 13) != 0;
  f.tiled = bits(rules, 14, 14) != 0;
  f.frame_copy = bits(rules, 15, 15) != 0;
  f.edge_count = registers.value(reg::kEdgeCount);
  f.vertex_count = registers.value(reg::kVertexCount);
  f.face_count = registers.value(reg::kFaceCount);
  f.edge_base = registers.value(reg::kEdgeBase);
  f.vertex_base = registers.value(reg::kVertexBase);
  f.face_base = registers.value(reg::kFaceBase);
  f.depth_base = registers.value(reg::kDepthBase);
  f.colour_base = registers.value(reg::kColourBase);
  f.weight_base = registers.value(reg::kWeightBase);
  f.copy_base = registers.value(reg::kCopyBase);
  f.blocks_across = (width + 3) >> 2;
  f.blocks_down = (height + 3) >> 2;
  f.words_across = (f.blocks_across + 127) >> 7;
  f.touched_words = f.words_across * f.blocks_down;
  f.lines_across = f.tiled ? (width + 7) >> 3 : (width + 15) >> 4;
  return f;
}

Refusal refusal(const FrameRules& f, bool enabled, const spec::geometric::Parameters& p) {
  const auto over = [](std::uint32_t value, std::int32_t limit) {
    return value > static_cast<std::uint32_t>(limit);
  };
  if (!enabled) return Refusal::kDisabled;
  if (f.width < 1 || f.height < 1 || f.width > spec::geometric::kMaxFrameSize ||
      f.height > spec::geometric::kMaxFrameSize)
    return Refusal::kSize;
  if (f.width > p.line_pixels) return Refusal::kWidth;
  if (over(f.touched_words, p.touched_words)) return Refusal::kTouchedWords;
  if (f.edge_count > spec::geometric::kMaxEdges) return Refusal::kEdgeCount;
  if (f.vertex_count > spec::geometric::kMaxVertices) return Refusal::kVertexCount;
  if (f.select == spec::geometric::Select::kEdges && over(f.face_count, p.face_limit))
    return Refusal::kFaceCount;
  return Refusal::kNone;
}

ParameterStore::ParameterStore(ControlRegisters& registers, const spec::geometric::Parameters& p)
    : registers_(registers), parameters_(p) {
  for (const spec::RegisterInfo& info : spec::geometric::kRegisters)
    if (info.access == spec::Access::kReadWrite && info.offset != reg::kControl)
      registers.set_mask(info.offset, writable(info.offset));
  registers.set_reset(reg::kRules, encode_rules(p));
}

Refusal ParameterStore::latch(bool enabled) {
  registers_.mask_values();
  const FrameRules rules = decode(registers_);
  const Refusal why = refusal(rules, enabled, parameters_);
  if (why == Refusal::kNone) rules_ = rules;
  return why;
}

}  // namespace deburr::rtl::geometric
