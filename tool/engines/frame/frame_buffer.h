// SPDX-License-Identifier: MIT
// The frame buffer of a composition: takes the colours of an engine that draws, gives complete rows
// to one that smooths a finished picture, as they come or once the engine between is done.
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

// The engines around a frame buffer: who draws, and of those who smooth the ones that there are.
struct BufferEnds {
  std::string_view drawer, mesh;  // names
  std::function<std::unique_ptr<ColoursPort>(const char*)> colours;
  std::function<std::unique_ptr<RowsPort>(const char*)> rows;  // none: rows never go out
};

// Takes a colour a clock, gives a beat of a complete row a clock. Its memory is not modelled in
// time. Stalls: by the name of who draws (the next row, or any, still lacks fragments), of who
// smooths along edges (the frame is complete and not yet released), `downstream`.
class FrameBuffer final : public rtl::Unit {
 public:
  FrameBuffer(const sc_core::sc_module_name& name, rtl::ClockDomain& clock,
              const tb::DrawnScene& scene, const BufferEnds& ends);
  rtl::Activity tick(rtl::Cycle cycle) override;
  void reset() override;

  // Null if rows never go out.
  RowsPort* rows() const { return pixels_out_.get(); }
  bool done() const { return pixels_out_ ? y_ == image_.height : complete(); }
  // Every fragment has come.
  bool complete() const { return all_missing_ == 0; }
  // Rows of this frame go out from the next clock on, instead of what has come.
  void release(tb::Image frame);
  // What has come, over the sky.
  const tb::Image& frame() const { return released_ ? before_ : image_; }
  std::function<void(int x, int y, const tb::Rgba8&)> on_pixel;  // that is seen
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
  tb::Image image_;  // what goes out
  tb::Image sky_, before_;
  std::vector<std::uint32_t> missing_;  // fragments that each row still lacks
  std::uint64_t all_missing_ = 0;
  bool released_ = false;
  int x_ = 0, y_ = 0;
  rtl::Cycle last_colour_ = 0, first_beat_ = 0;
};

}  // namespace deburr::tool
