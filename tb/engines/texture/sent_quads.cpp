// SPDX-License-Identifier: MIT
#include "tb/engines/texture/sent_quads.h"

#include <fmt/format.h>

#include <algorithm>

#include "spec/error.h"

namespace deburr::tb {

void show(const traces::TracedQuad& quad, const spec::texture::Colour& colour, Image& picture) {
  if (quad.shows(colour.lane)) picture.at(quad.x(colour.lane), quad.y(colour.lane)) = colour.rgba;
}

void SentQuads::add(const traces::TracedQuad& quad) {
  DEBURR_CHECK(quad.quad.tag == next_, fmt::format("quad {} has the tag {}", next_, quad.quad.tag));
  ++next_;
  // Colours arrive in the order of quads.
  while (quads_.size() >= kKept &&
         (quads_.front().pending == 0 || quads_.front().quad.quad.tag < taken_))
    quads_.pop_front();
  quads_.push_back({quad, quad.quad.coverage});
}

const traces::TracedQuad* SentQuads::find(std::uint32_t tag) const {
  const std::size_t back = next_ - tag;
  return back == 0 || back > quads_.size() ? nullptr : &quads_[quads_.size() - back].quad;
}

const traces::TracedQuad* SentQuads::take(const spec::texture::Colour& colour, bool trusted) {
  const traces::TracedQuad* quad = find(colour.tag);
  const bool lane = colour.lane < 4;
  DEBURR_CHECK(!trusted || (quad && lane),
               fmt::format("colour with tag {} lane {}, {} quads were sent", colour.tag,
                           colour.lane, next_));
  if (!quad || !lane) return nullptr;
  Sent& sent = quads_[quads_.size() - (next_ - colour.tag)];
  const auto bit = static_cast<std::uint8_t>(1u << colour.lane);
  const bool due = (sent.pending & bit) != 0;
  DEBURR_CHECK(!trusted || due,
               fmt::format("colour for tag {} lane {}, which is not covered or already has one",
                           colour.tag, colour.lane));
  if (!due) return nullptr;
  sent.pending = static_cast<std::uint8_t>(sent.pending & ~bit);
  taken_ = std::max(taken_, colour.tag);
  return quad;
}

}  // namespace deburr::tb
