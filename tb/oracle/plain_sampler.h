// SPDX-License-Identifier: MIT
// A small texture sampler with an exact level of detail and 8-bit weights, into which faults can be
// injected: the filtering criterion must accept it without a fault and reject it with one.
//
// Used only by the criterion's negative tests; independent of the golden model and the criterion.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "golden/ideal/filtering_criterion.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/packets.h"
#include "tb/oracle/encoded_texture.h"

namespace deburr::tb::texture {

enum class Fault {
  kNone,
  kFiveBitWeights,           // rounded to 1/32
  kFiveBitTruncatedWeights,  // truncated to 1/32
  kThreeBitWeights,
  kThreeBitTruncatedWeights,
  kHalfTexelShift,         // linear filtering forgets the half texel
  kNearestHalfTexelShift,  // nearest filtering rounds the position instead of truncating
  kWrongWrap,              // repeat <-> mirrored, clamp -> repeat
  kNeighbourPastEdge,      // the right neighbour of the last column is clamped for every wrap mode
  kTruncatedIndex,         // positions are truncated towards 0 instead of floored
  kTruncatedLevel,         // *_MIPMAP_NEAREST takes floor(l)
  kTwoBitLevelFraction,    // level fraction rounded to 1/4
  kLevelTooLow,            // l is 1/8 too low
  kLevelTooHigh,           // l is 3/4 too high
  kSwappedLevels,          // the two levels' weights are exchanged
  kSwappedAxes,            // u and v fractions are exchanged
  kLateMagnification,      // the switch to the magnification filter is at l = 1/2
  kUnreplicatedChannels,   // 4, 5 and 6-bit channels are widened with zeros
  kEncodedSrgb,            // sRGB is filtered and returned as stored
  kTruncatedColour,        // the result is truncated to 8 bits: legal for the criterion, biased
};
inline constexpr std::array<std::string_view, 20> kFaultNames = {"none",
                                                                 "five_bit_weights",
                                                                 "five_bit_truncated_weights",
                                                                 "three_bit_weights",
                                                                 "three_bit_truncated_weights",
                                                                 "half_texel_shift",
                                                                 "nearest_half_texel_shift",
                                                                 "wrong_wrap",
                                                                 "neighbour_past_edge",
                                                                 "truncated_index",
                                                                 "truncated_level",
                                                                 "two_bit_level_fraction",
                                                                 "level_too_low",
                                                                 "level_too_high",
                                                                 "swapped_levels",
                                                                 "swapped_axes",
                                                                 "late_magnification",
                                                                 "unreplicated_channels",
                                                                 "encoded_srgb",
                                                                 "truncated_colour"};

class PlainSampler {
 public:
  // Keeps a reference to the texture.
  PlainSampler(const EncodedTexture& texture, const golden::ideal::Sampler& sampler, Fault fault)
      : texture_(texture), sampler_(sampler), fault_(fault) {}

  std::array<std::uint8_t, 4> sample(const spec::texture::Quad& quad, int lane) const;

 private:
  using Colour = std::array<double, 4>;
  Colour texel(const EncodedLevel& level, std::int64_t x, std::int64_t y) const;
  Colour nearest(const EncodedLevel& level, double s, double t) const;
  Colour bilinear(const EncodedLevel& level, double s, double t) const;
  Colour spatial(std::size_t level, double s, double t, bool linear) const;
  std::int64_t to_index(double position) const;
  double weight(double fraction) const;
  spec::texture::Wrap wrap(spec::texture::Wrap asked) const;

  const EncodedTexture& texture_;
  golden::ideal::Sampler sampler_;
  Fault fault_;
};

}  // namespace deburr::tb::texture
