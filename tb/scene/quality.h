// SPDX-License-Identifier: MIT
// Quality metrics: PSNR over a frame or a mask, and edge and silhouette masks
// (docs/reference/scenes.md, "Pictures and quality"). All of them use stored 8-bit R, G and B;
// alpha is never compared.
#pragma once

#include <cstdint>

#include "tb/scene/image.h"

namespace deburr::tb {

[[noreturn]] void reject_sizes(int width, int height, int other_width, int other_height);

// Throws ConfigError if sizes differ.
template <class A, class B>
void require_same_size(const ImageOf<A>& a, const ImageOf<B>& b) {
  if (a.width != b.width || a.height != b.height)
    reject_sizes(a.width, a.height, b.width, b.height);
}

// Mean squared error over R, G and B, in units of 1/255. Throws ConfigError if sizes differ.
double mean_squared_error(const Image& a, const Image& b);
double mean_squared_error(const Image& a, const Image& b,
                          const Mask& mask);  // NaN if the mask is empty

// 10 log10(255^2 / mse) in dB: +infinity for equal images, NaN for an empty mask.
double psnr(const Image& a, const Image& b);
double psnr(const Image& a, const Image& b, const Mask& mask);
double psnr_from_mse(double mse);

// Flicker: the change between two consecutive images minus the change between their references.
// Returns its mean square over R, G and B, in units of 1/255; NaN if the mask is empty.
double flicker_square(const Image& before, const Image& after, const Image& reference_before,
                      const Image& reference_after, const Mask& mask);

// flicker_square() over a sequence of frames.
class FlickerMeter {
 public:
  static Mask everywhere(const Image& image);
  // Pixels count if `drawn` selects them here and in the previous frame. A pair of frames without
  // such pixels is skipped. Sizes must be equal.
  void add(Image picture, Image reference, Mask drawn);
  int frames() const { return frames_; }
  int width() const { return picture_.width; }  // of the last frame
  int height() const { return picture_.height; }
  double mean() const;  // root mean square over all pairs of frames, in units of 1/255
  double worst() const { return worst_; }           // maximum over the pairs
  int worst_frame() const { return worst_frame_; }  // the second frame of this pair

 private:
  Image picture_, reference_;
  Mask drawn_;
  int frames_ = 0, pairs_ = 0, worst_frame_ = 0;
  double sum_ = 0, worst_ = 0;
};

std::int64_t count(const Mask& mask);
// Pixels that differ by more than `tolerance` in R, G or B, and the largest difference.
std::int64_t count_different(const Image& a, const Image& b, int tolerance = 0);
std::int64_t count_different(const Image& a, const Image& b, const Mask& mask, int tolerance = 0);
int max_difference(const Image& a, const Image& b);

// Edge pixels: pixels in which the reference and the unfiltered input differ by more than 2/255 in
// a channel.
Mask edge_mask(const Image& reference, const Image& input, int threshold = 2);
// The pixels outside `mask`. For an edge mask these are the pixels that were right before
// filtering.
Mask inverted(const Mask& mask);
// Pixels of `mask` that are not in `other`.
Mask without(const Mask& mask, const Mask& other);

// Silhouette pixels: the pixels of `edges` whose depth differs from that of one of their four
// neighbours by more than 5 %: max > 1.05 min. Since this is a ratio, it works for depth and for
// inverse depth. 0, infinity and NaN are background; a pixel of background next to a surface counts
// as a step.
Mask silhouette_mask(const Mask& edges, const DepthImage& depth, double relative_step = 0.05);

}  // namespace deburr::tb
