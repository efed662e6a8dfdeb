// SPDX-License-Identifier: MIT
// Quality metrics: PSNR over a frame or a mask, edge and silhouette masks
// (docs/reference/scenes.md, "Pictures and quality"). All use stored 8-bit R, G and B; alpha is
// never compared.
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

// Flicker: mean square over R, G and B of the change between two consecutive images minus the
// change between their references, in units of 1/255; NaN if the mask is empty.
double flicker_square(const Image& before, const Image& after, const Image& reference_before,
                      const Image& reference_after, const Mask& mask);

// flicker_square() over a sequence of frames.
class FlickerMeter {
 public:
  static Mask everywhere(const Image& image);
  // `drawn` selects the pixels that count, if they were also drawn in the previous frame; a pair of
  // frames without any is skipped. Sizes must be equal.
  void add(Image picture, Image reference, Mask drawn);
  int frames() const { return frames_; }
  int width() const { return picture_.width; }  // of the last frame
  int height() const { return picture_.height; }
  double mean() const;  // root mean square over all pairs of frames, in units of 1/255
  double worst() const { return worst_; }           // maximum over the pairs
  int worst_frame() const { return worst_frame_; }  // its second frame

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

// Edge pixels: reference and unfiltered input differ by more than 2/255 in a channel.
Mask edge_mask(const Image& reference, const Image& input, int threshold = 2);
// The other pixels: they were right before filtering.
Mask inverted(const Mask& mask);
// Pixels of `mask` that are not in `other`.
Mask without(const Mask& mask, const Mask& other);

// Silhouette pixels: those of `edges` where the depth of one of the four neighbours differs by more
// than 5 %: max > 1.05 min. Because it is a ratio, it works for depth and inverse depth. 0,
// infinity and NaN are the background, and background next to a surface is a step.
Mask silhouette_mask(const Mask& edges, const DepthImage& depth, double relative_step = 0.05);

}  // namespace deburr::tb
