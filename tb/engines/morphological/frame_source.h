// SPDX-License-Identifier: MIT
// Sends frames to the morphological engine in raster order, `lanes` pixels per beat and one beat
// per cycle; a row starts a new beat. Handles one frame at a time; a reset discards it.
#pragma once

#include <systemc>

#include "rtl_model/fabric/unit.h"
#include "rtl_model/platform/morphological_records.h"
#include "spec/morphological/packets.h"
#include "tb/engines/morphological/morphological_input.h"

namespace deburr::tb {

class FrameSource final : public rtl::Unit {
 public:
  rtl::Out<spec::morphological::PixelBeat> pixels_out{"pixels_out"};

  FrameSource(const sc_core::sc_module_name& name, rtl::ClockDomain& clock, int lanes)
      : Unit(name, clock), lanes_(lanes) {}

  // Starts the next frame, which must outlive its transfer.
  void start(const MorphologicalInput& frame) {
    reset();
    frame_ = &frame;
  }
  bool done() const { return frame_ == nullptr || y_ == frame_->image.height; }
  rtl::Cycle first_cycle() const { return first_; }  // cycles of this frame's first and last beat
  rtl::Cycle last_cycle() const { return last_; }

  rtl::Activity tick(rtl::Cycle cycle) override {
    if (done()) return rtl::kIdle;
    if (!pixels_out.can_push(cycle)) return rtl::kStalledDownstream;
    if (x_ == 0 && y_ == 0) first_ = cycle;
    last_ = cycle;
    pixels_out.push(cycle, platform::pixel_beat(frame_->view(), x_, y_, lanes_));
    x_ += lanes_;
    if (x_ >= frame_->image.width) x_ = 0, ++y_;
    return rtl::kBusy;
  }
  void reset() override {
    frame_ = nullptr;
    x_ = y_ = 0;
    first_ = last_ = 0;
  }

 private:
  int lanes_;
  const MorphologicalInput* frame_ = nullptr;
  int x_ = 0, y_ = 0;
  rtl::Cycle first_ = 0, last_ = 0;
};

}  // namespace deburr::tb
