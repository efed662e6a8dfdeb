// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/common/parameter_store.h"

#include <algorithm>

namespace deburr::rtl::geometric {
namespace {

namespace reg = spec::geometric::reg;
using spec::geometric::Rejection;

}  // namespace

ControlLayout control_layout() {
  return rtl::control_layout(spec::geometric::kRegisters, spec::geometric::kBusyIgnoresWrites);
}

FrameConfiguration decode(const ControlRegisters& registers) {
  const std::uint32_t size = registers.value(reg::kSize),
                      configuration = registers.value(reg::kConfiguration);
  FrameConfiguration f;
  const std::uint32_t width = reg::size::kWidth.of(size), height = reg::size::kHeight.of(size);
  f.width = width;
  f.height = height;
  namespace field = reg::configuration;
  f.select = choice_of<spec::geometric::Select>(field::kSelect, configuration);
  f.crease = choice_of<spec::geometric::Crease>(field::kCrease, configuration);
  f.cull = choice_of<spec::geometric::Cull>(field::kCull, configuration);
  f.depth_test = choice_of<spec::geometric::DepthTest>(field::kDepthTest, configuration);
  f.combine = choice_of<spec::geometric::Combine>(field::kCombine, configuration);
  f.linear_light = field::kLinearLight.of(configuration) != 0;
  f.depth_bias = std::clamp(field::kDepthBias.of(configuration), 1U,
                            std::uint32_t{spec::geometric::kDepthBits});
  f.crease_depth =
      std::min(field::kCreaseDepth.of(configuration), std::uint32_t{spec::geometric::kDepthBits});
  f.area = choice_of<spec::geometric::CoverageRule>(field::kCoverage, configuration) ==
           spec::geometric::CoverageRule::kArea;
  f.mark = field::kMark.of(configuration) != 0;
  f.tiled = field::kLayout.of(configuration) != 0;
  f.frame_copy = field::kFrameCopy.of(configuration) != 0;
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

Rejection rejection(const FrameConfiguration& f, bool enabled,
                    const spec::geometric::Parameters& p) {
  const auto over = [](std::uint32_t value, std::int32_t limit) {
    return value > static_cast<std::uint32_t>(limit);
  };
  if (!enabled) return Rejection::kDisabled;
  if (f.width < 1 || f.height < 1 || over(f.width, spec::geometric::kMaxFrameSize) ||
      over(f.height, spec::geometric::kMaxFrameSize))
    return Rejection::kSize;
  if (over(f.width, p.line_pixels)) return Rejection::kWidth;
  if (over(f.touched_words, p.touched_words)) return Rejection::kTouchedWords;
  if (f.edge_count > spec::geometric::kMaxEdges) return Rejection::kEdgeCount;
  if (f.vertex_count > spec::geometric::kMaxVertices) return Rejection::kVertexCount;
  if (f.select == spec::geometric::Select::kEdges && over(f.face_count, p.face_limit))
    return Rejection::kFaceCount;
  if (p.records == spec::geometric::RecordsLayout::kSplit && f.boundary_count > f.edge_count)
    return Rejection::kBoundaryCount;
  return Rejection::kNone;
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
  registers.on_read(reg::kRejection, [this] { return static_cast<std::uint32_t>(rejection_); });
  clock.on_reset([this] {
    starting_ = start_enabled_ = false;
    rejection_ = Rejection::kNone;
  });
}

// Called by a bus write, between edges. `enable` already has its new value.
void ParameterStore::start() {
  starting_ = true;
  start_enabled_ = registers_.enabled();
  start_out.raise(clock_.cycle());
}

void ParameterStore::latch(Cycle cycle) {
  starting_ = false;
  registers_.mask_values();
  const FrameConfiguration configuration = decode(registers_);
  rejection_ = rejection(configuration, start_enabled_, parameters_);
  rejection_out.drive(cycle, rejection_);
  if (rejection_ == Rejection::kNone)
    configuration_out.drive(cycle, configuration);
  else
    registers_.set_sticky(reg::kStatusRejected);
}

}  // namespace deburr::rtl::geometric
