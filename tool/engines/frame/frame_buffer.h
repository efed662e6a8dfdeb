// SPDX-License-Identifier: MIT
// The frame buffer of a composition. It accepts the colours of a drawing engine and outputs
// complete rows to an engine that smooths a finished picture. It outputs a row when the row is
// complete or, if there is a mesh engine in between, when that engine is done.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/unit.h"
#include "tb/scene/drawn_scene.h"
#include "tb/scene/image.h"
#include "tool/run/composition.h"

namespace deburr::tool {

// The engines connected to a frame buffer: the drawing engine, and the smoothing engines present.
struct BufferEnds {
  std::string_view drawer, mesh;  // names
  std::function<std::unique_ptr<ColoursPort>(const char*)> colours;
  std::function<std::unique_ptr<RowsPort>(const char*)> rows;  // null: rows are never output
};

// Interval  One beat of colours in (its pixels are written in the same cycle, with a wide texture
// unit
//           up to four) and one beat of a complete row out per cycle; its memory is not timed.
// Stalls    DRAWER      The next row lacks fragments; if rows wait for release(), any row does.
//           MESH        The frame is complete and not yet released.
//           downstream
class FrameBuffer final : public rtl::Unit {
 public:
  FrameBuffer(const sc_core::sc_module_name& name, rtl::ClockDomain& clock,
              const tb::DrawnScene& scene, const BufferEnds& ends);
  rtl::Activity tick(rtl::Cycle cycle) override;
  void reset() override;

  // Null if rows are never output.
  RowsPort* rows() const { return pixels_out_.get(); }
  bool done() const { return pixels_out_ ? y_ == image_.height : complete(); }
  // Every fragment has arrived.
  bool complete() const { return all_missing_ == 0; }
  // Outputs the rows of this frame from the next cycle on, instead of those of the received frame.
  void release(tb::Image frame);
  // The received colours over the sky.
  const tb::Image& frame() const { return released_ ? before_ : image_; }
  std::function<void(int x, int y, const tb::Rgba8&)> on_pixel;  // visible
  rtl::Cycle last_colour() const { return last_colour_; }
  rtl::Cycle first_beat() const { return first_beat_; }
  static constexpr std::uint32_t kPixelBytes = sizeof(tb::Rgba8);
  rtl::Counter bytes_written{"bytes_written", "byte", "bytes of colours written"};
  rtl::Counter bytes_read{"bytes_read", "byte", "bytes of pixels read"};

 private:
  void store(rtl::Cycle cycle, const DrawnColour& drawn);
  bool may_send() const;

  const tb::DrawnScene& scene_;
  std::unique_ptr<ColoursPort> colours_in_;
  std::unique_ptr<RowsPort> pixels_out_;
  bool when_released_;  // rows wait for release()
  rtl::Activity waiting_, held_{};
  tb::Image image_;  // the output frame
  tb::Image sky_, before_;
  std::vector<std::uint32_t> missing_;  // missing fragments per row
  std::uint64_t all_missing_ = 0;
  bool released_ = false;
  int x_ = 0, y_ = 0;
  rtl::Cycle last_colour_ = 0, first_beat_ = 0;
};

}  // namespace deburr::tool
