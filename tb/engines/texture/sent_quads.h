// SPDX-License-Identifier: MIT
// Quads in flight in the texture unit, so that a colour finds its pixel without a list of all
// quads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "spec/texture/packets.h"
#include "tb/scene/image.h"
#include "tb/traces/fragment_trace.h"

namespace deburr::tb {

// Writes a colour to the pixel of its quad if the lane is visible.
void show(const traces::TracedQuad& quad, const spec::texture::Colour& colour, Image& picture);

class SentQuads {
 public:
  // Quads must be added in tag order, from 0.
  void add(const traces::TracedQuad& quad);
  // Returns nullptr for a tag that was not sent or is no longer kept.
  const traces::TracedQuad* find(std::uint32_t tag) const;
  // Returns the quad of a received colour, once per lane. Otherwise throws CheckFailed if the
  // colour is `trusted`, and returns nullptr if not.
  const traces::TracedQuad* take(const spec::texture::Colour& colour, bool trusted);

 private:
  // More than the unit holds, so that duplicated and late colours also find their pixel.
  static constexpr std::size_t kKept = 4096;
  struct Sent {
    traces::TracedQuad quad;
    std::uint8_t pending;  // bit i: lane i has not been received
  };
  std::deque<Sent> quads_;
  std::uint32_t next_ = 0;   // next tag
  std::uint32_t taken_ = 0;  // largest tag received
};

}  // namespace deburr::tb
