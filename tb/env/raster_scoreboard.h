// SPDX-License-Identifier: MIT
// Scoreboard for a frame that is known in advance. It compares in raster order and reads the
// expected values where they are, so a frame of millions of pixels needs neither copies nor a
// queue.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>

#include "tb/harness/scoreboard.h"

namespace deburr::tb {

template <class Value>
class RasterScoreboard final : public ScoreboardBase {
 public:
  using Describe = std::function<std::string(const Value&)>;
  RasterScoreboard(std::string name, Describe describe)
      : ScoreboardBase(std::move(name), 0), describe_(std::move(describe)) {}

  // Sets the next frame, which must outlive its checks. Pixels of the previous frame that have not
  // come count as lost.
  void expect(std::span<const Value> frame, int width) {
    if (blind()) return;
    lost_ += leftovers_here();
    frame_ = frame;
    width_ = static_cast<std::size_t>(width);
    at_ = 0;
  }
  // Restarts the frame after a reset. Comparisons made so far still count.
  void restart() { at_ = 0; }

  void got(const Value& value, std::uint64_t cycle) {
    if (blind()) return;
    count();
    if (at_ == frame_.size()) {
      fail({"", fmt::format("cycle {}", cycle), "after the frame's end", "", "nothing",
            describe_(value)});
      return;
    }
    const Value& wanted = frame_[at_];
    if (!(wanted == value))
      fail({"", fmt::format("cycle {}", cycle), pixel(at_), "", describe_(wanted),
            describe_(value)});
    ++at_;
  }
  // Reports a framing error instead of a wrong pixel.
  void complain(std::uint64_t cycle, std::size_t position, std::string field, std::string expected,
                std::string got) {
    fail({"", fmt::format("cycle {}", cycle), pixel(position), std::move(field),
          std::move(expected), std::move(got)});
  }
  // Resynchronises at another pixel after a framing error, so that the error counts as a single
  // mismatch.
  void go_on_at(std::size_t position) { at_ = std::min(position, frame_.size()); }
  std::uint64_t leftovers() const override { return lost_ + leftovers_here(); }
  std::size_t position() const { return at_; }

 private:
  std::uint64_t leftovers_here() const { return frame_.size() - at_; }
  std::string first_leftover() const override {
    return lost_ > 0 ? "pixels of an earlier frame"
                     : fmt::format("{}: {}", pixel(at_), describe_(frame_[at_]));
  }
  std::string pixel(std::size_t position) const {
    return fmt::format("pixel ({}, {})", position % width_, position / width_);
  }

  Describe describe_;
  std::span<const Value> frame_;
  std::size_t width_ = 1, at_ = 0;
  std::uint64_t lost_ = 0;
};

}  // namespace deburr::tb
