// SPDX-License-Identifier: MIT
// The quads that were sent into the texture unit and may still come out of it, so that a colour
// finds its pixel without a list of all of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "spec/texture/packets.h"
#include "tb/scene/image.h"
#include "tb/traces/fragment_trace.h"

namespace deburr::tb {

// Puts a colour where its quad says, if it is to be seen.
void show(const traces::TracedQuad& quad, const spec::texture::Colour& colour, Image& picture);

class SentQuads {
 public:
  // In the order of their tags, which count from 0.
  void add(const traces::TracedQuad& quad);
  // nullptr for a tag that was not sent, or so long ago that it is forgotten.
  const traces::TracedQuad* find(std::uint32_t tag) const;
  // The quad of a colour that has come, once a lane; else CheckFailed if the colour is `trusted`,
  // and nullptr if it may be anything.
  const traces::TracedQuad* take(const spec::texture::Colour& colour, bool trusted);

 private:
  // More than the unit holds: colours that come twice or too late find their pixel too.
  static constexpr std::size_t kKept = 4096;
  struct Sent {
    traces::TracedQuad quad;
    std::uint8_t pending;  // bit i: the colour of lane i has not come
  };
  std::deque<Sent> quads_;
  std::uint32_t next_ = 0;   // tag
  std::uint32_t taken_ = 0;  // the largest tag that has come
};

}  // namespace deburr::tb
