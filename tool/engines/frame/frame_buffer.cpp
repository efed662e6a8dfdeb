// SPDX-License-Identifier: MIT
#include "tool/engines/frame/frame_buffer.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "tb/scene/rasteriser.h"

namespace deburr::tool {

FrameBuffer::FrameBuffer(const sc_core::sc_module_name& name, rtl::ClockDomain& clock,
                         const tb::DrawnScene& scene, const BufferEnds& ends)
    : Unit(name, clock),
      scene_(scene),
      colours_in_(ends.colours("colours_in")),
      pixels_out_(ends.rows ? ends.rows("pixels_out") : nullptr),
      when_released_(pixels_out_ && !ends.mesh.empty()),
      waiting_(declare_stall(std::string(ends.drawer).c_str(), "the next row is incomplete")),
      sky_(tb::FrameAssembler(scene.stream(), scene.scene()).frame()) {
  if (when_released_)
    held_ = declare_stall(std::string(ends.mesh).c_str(),
                          fmt::format("the {} engine is processing the frame", ends.mesh).c_str());
  reset();
}

void FrameBuffer::reset() {
  const tb::FragmentStream& stream = scene_.stream();
  image_ = sky_;
  released_ = false;
  all_missing_ = 0;
  missing_.assign(static_cast<std::size_t>(stream.height), 0);
  for (const auto& quad : stream.quads)
    for (int lane = 0; lane < 4; ++lane)
      if (quad.coverage >> lane & 1) {
        ++missing_[static_cast<std::size_t>(stream.pixel(quad.tag, lane).y)];
        ++all_missing_;
      }
  x_ = y_ = 0;
  last_colour_ = first_beat_ = 0;
}

// Fragments of one pixel arrive in the order of their triangles; only the nearest one is visible.
void FrameBuffer::store(rtl::Cycle cycle, const DrawnColour& drawn) {
  last_colour_ = cycle;
  bytes_written += kPixelBytes;
  if (!drawn.inside) return;  // counted by the scoreboard
  if (drawn.visible) {
    image_.at(drawn.x, drawn.y) = drawn.colour;
    if (on_pixel) on_pixel(drawn.x, drawn.y, drawn.colour);
  }
  std::uint32_t& missing = missing_[static_cast<std::size_t>(drawn.y)];
  if (missing == 0) return;
  --missing;
  --all_missing_;
}

void FrameBuffer::release(tb::Image frame) {
  before_ = std::exchange(image_, std::move(frame));
  released_ = true;
}

bool FrameBuffer::may_send() const {
  return when_released_ ? released_ : missing_[static_cast<std::size_t>(y_)] == 0;
}

rtl::Activity FrameBuffer::tick(rtl::Cycle cycle) {
  bool worked = false;
  rtl::Activity activity = rtl::kIdle;
  if (pixels_out_ && !done()) {
    if (!may_send()) {
      activity = when_released_ && complete() ? held_ : waiting_;
    } else if (!pixels_out_->can_push(cycle)) {
      activity = rtl::kStalledDownstream;
    } else {
      if (x_ == 0 && y_ == 0) first_beat_ = cycle;
      const int pixels = pixels_out_->push(cycle, image_, x_, y_);
      bytes_read += static_cast<std::uint64_t>(kPixelBytes) * static_cast<std::uint64_t>(pixels);
      x_ += pixels;
      if (x_ >= image_.width) x_ = 0, ++y_;
      worked = true;
    }
  }
  if (colours_in_->can_pop(cycle)) {
    colours_in_->take(cycle, [&](const DrawnColour& drawn) { store(cycle, drawn); });
    worked = true;
  }
  return worked ? rtl::kBusy : activity;
}

}  // namespace deburr::tool
