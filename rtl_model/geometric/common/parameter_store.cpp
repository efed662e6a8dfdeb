// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/common/parameter_store.h"

#include <algorithm>

namespace deburr::rtl::geometric {
namespace {

namespace reg = spec::geometric::reg;
using spec::geometric::Refusal;

}  // namespace

ControlLayout control_layout() {
  return rtl::control_layout(spec::geometric::kRegisters, spec::geometric::kBusyIgnoresWrites);
}

FrameRules decode(const ControlRegisters& registers) {
  const std::uint32_t size = registers.value(reg::kSize), rules = registers.value(reg::kRules);
  FrameRules f;
  const std::uint32_t width = reg::size::kWidth.of(size), height = reg::size::kHeight.of(size);
  f.width = width;
  f.height = height;
  namespace field = reg::rules;
  f.select = choice_of<spec::geometric::Select>(field::kSelect, rules);
  f.crease = choice_of<spec::geometric::Crease>(field::kCrease, rules);
  f.cull = choice_of<spec::geometric::Cull>(field::kCull, rules);
  f.depth_test = choice_of<spec::geometric::DepthTest>(field::kDepthTest, rules);
  f.combine = choice_of<spec::geometric::Combine>(field::kCombine, rules);
  f.linear_light = field::kLinearLight.of(rules) != 0;
  f.depth_bias =
      std::clamp(field::kDepthBias.of(rules), 1U, std::uint32_t{spec::geometric::kDepthBits});
  f.crease_depth =
      std::min(field::kCreaseDepth.of(rules), std::uint32_t{spec::geometric::kDepthBits});
  f.area = choice_of<spec::geometric::CoverageRule>(field::kCoverage, rules) ==
           spec::geometric::CoverageRule::kArea;
  f.mark = field::kMark.of(rules) != 0;
  f.tiled = field::kLayout.of(rules) != 0;
  f.frame_copy = field::kFrameCopy.of(rules) != 0;
  f.edge_count = registers.value(reg::kEdgeCount);
  f.vertex_count = registers.value(reg::kVertexCount);
  f.face_count = registers.value(reg::kFaceCount);
  f.boundary_count = registers.value(reg::kBoundaryCount);
  f.edge_base = registers.value(reg::kEdgeBase);
  f.vertex_base = registers.value(reg::kVertexBase);
  f.face_base = registers.value(reg::kFaceBase);
  f.depth_base = registers.value(reg::kDepthBase);
  f.colour_base = registers.value(reg::kColourBase);
  f.weight_base = registers.value(reg::kWeightBase);
  f.copy_base = registers.value(reg::kCopyBase);
  f.pair_base = registers.value(reg::kPairBase);
  f.other_pair_base = registers.value(reg::kOtherPairBase);
  f.coarse_base = registers.value(reg::kCoarseBase);
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
  if (f.width < 1 || f.height < 1 || over(f.width, spec::geometric::kMaxFrameSize) ||
      over(f.height, spec::geometric::kMaxFrameSize))
    return Refusal::kSize;
  if (over(f.width, p.line_pixels)) return Refusal::kWidth;
  if (over(f.touched_words, p.touched_words)) return Refusal::kTouchedWords;
  if (f.edge_count > spec::geometric::kMaxEdges) return Refusal::kEdgeCount;
  if (f.vertex_count > spec::geometric::kMaxVertices) return Refusal::kVertexCount;
  if (f.select == spec::geometric::Select::kEdges && over(f.face_count, p.face_limit))
    return Refusal::kFaceCount;
  if (p.records == spec::geometric::RecordsLayout::kSplit && f.boundary_count > f.edge_count)
    return Refusal::kBoundaryCount;
  return Refusal::kNone;
}

ParameterStore::ParameterStore(const sc_core::sc_module_name& name, ClockDomain& clock,
                               ControlRegisters& registers, const spec::geometric::Parameters& p)
    : sc_module(name),
      frame_done_in("frame_done_in",
                    [this](Cycle /*cycle*/) { registers_.set_sticky(reg::kStatusFrameDone); }),
      invalid_edge_in("invalid_edge_in",
                      [this](Cycle /*cycle*/) { registers_.set_sticky(reg::kStatusInvalidEdge); }),
      memory_error_in("memory_error_in",
                      [this](Cycle /*cycle*/) { registers_.set_sticky(reg::kStatusMemoryError); }),
      clock_(clock),
      registers_(registers),
      parameters_(p) {
  if (p.records == spec::geometric::RecordsLayout::kSplit)
    invalid_pair_in.emplace("invalid_pair_in", [this](Cycle /*cycle*/) {
      registers_.set_sticky(reg::kStatusInvalidEdge);
    });
  registers.set_resets(spec::geometric::loaded_registers(p));
  registers.on_command(reg::kControlStart, [this] { start(); });
  registers.on_read(reg::kRefusal, [this] { return static_cast<std::uint32_t>(refusal_); });
  clock.on_reset([this] {
    starting_ = start_enabled_ = false;
    refusal_ = Refusal::kNone;
  });
}

// A bus write, between edges. Enable has its new value by now.
void ParameterStore::start() {
  starting_ = true;
  start_enabled_ = registers_.enabled();
  start_out.raise(clock_.cycle());
}

void ParameterStore::latch(Cycle cycle) {
  starting_ = false;
  registers_.mask_values();
  const FrameRules rules = decode(registers_);
  refusal_ = refusal(rules, start_enabled_, parameters_);
  refusal_out.drive(cycle, refusal_);
  if (refusal_ == Refusal::kNone)
    rules_out.drive(cycle, rules);
  else
    registers_.set_sticky(reg::kStatusRefused);
}

}  // namespace deburr::rtl::geometric
