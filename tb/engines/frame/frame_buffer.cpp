// SPDX-License-Identifier: MIT
#include "tb/engines/frame/frame_buffer.h"

#include <algorithm>
#include <utility>

#include "spec/morphological/parameters.h"
#include "tb/scene/depth_codes.h"

namespace deburr::tb {

FrameBuffer::FrameBuffer(const sc_core::sc_module_name& name, rtl::ClockDomain& clock,
                         const TextureScene& scene, int lanes, Rows rows)
    : Unit(name, clock),
      pixels_out(rows == Rows::kNever
                     ? nullptr
                     : std::make_unique<rtl::Out<spec::morphological::PixelBeat>>("pixels_out")),
      scene_(scene),
      lanes_(lanes),
      rows_(rows),
      waiting_(declare_stall("texture", "the next row still lacks fragments")),
      sky_(FrameAssembler(scene.stream(), scene.scene()).frame()) {
  if (rows == Rows::kWhenReleased)
    held_ = declare_stall("geometric", "the geometric engine is at the frame");
  input_.depth = depth_codes(scene.stream().depth);
  reset();
}

void FrameBuffer::reset() {
  const FragmentStream& stream = scene_.stream();
  input_.image = sky_;
  released_ = false;
  all_missing_ = 0;
  missing_.assign(static_cast<std::size_t>(stream.height), 0);
  for (const spec::texture::Quad& quad : stream.quads)
    for (int lane = 0; lane < 4; ++lane)
      if (quad.coverage >> lane & 1) {
        ++missing_[static_cast<std::size_t>(stream.pixel(quad.tag, lane).y)];
        ++all_missing_;
      }
  x_ = y_ = 0;
  last_colour_ = first_beat_ = 0;
}

// Fragments of one pixel come in the order of their triangles; only the nearest one is shown.
void FrameBuffer::store(rtl::Cycle cycle, const spec::texture::Colour& colour) {
  const FragmentStream& stream = scene_.stream();
  last_colour_ = cycle;
  bytes_written += spec::morphological::kFramePixelBytes;
  if (colour.tag >= stream.quads.size() || colour.lane >= 4) return;  // counted by the scoreboard
  const FragmentStream::Pixel p = stream.pixel(colour.tag, colour.lane);
  if (p.x >= stream.width || p.y >= stream.height) return;
  if (stream.visible[colour.tag] >> colour.lane & 1) {
    input_.image.at(p.x, p.y) = colour.rgba;
    if (on_pixel) on_pixel(p.x, p.y, colour.rgba);
  }
  std::uint32_t& missing = missing_[static_cast<std::size_t>(p.y)];
  if (missing == 0) return;
  --missing;
  --all_missing_;
}

void FrameBuffer::release(Image frame) {
  before_ = std::exchange(input_.image, std::move(frame));
  released_ = true;
}

bool FrameBuffer::may_send() const {
  return rows_ == Rows::kWhenReleased ? released_ : missing_[static_cast<std::size_t>(y_)] == 0;
}

rtl::Activity FrameBuffer::tick(rtl::Cycle cycle) {
  bool worked = false;
  rtl::Activity activity = rtl::kIdle;
  if (pixels_out && !done()) {
    if (!may_send()) {
      activity = rows_ == Rows::kWhenReleased && complete() ? held_ : waiting_;
    } else if (!pixels_out->can_push(cycle)) {
      activity = rtl::kStalledDownstream;
    } else {
      if (x_ == 0 && y_ == 0) first_beat_ = cycle;
      const spec::morphological::PixelBeat beat =
          platform::pixel_beat(input_.view(), x_, y_, lanes_);
      bytes_read += static_cast<std::uint64_t>(spec::morphological::kFramePixelBytes) * beat.count;
      pixels_out->push(cycle, beat);
      x_ += lanes_;
      if (x_ >= input_.image.width) x_ = 0, ++y_;
      worked = true;
    }
  }
  if (colours_in.can_pop(cycle)) {
    const spec::texture::Colour colour = colours_in.take(cycle);
    store(cycle, colour);
    if (on_colour) on_colour(cycle, colour);
    worked = true;
  }
  return worked ? rtl::kBusy : activity;
}

}  // namespace deburr::tb
