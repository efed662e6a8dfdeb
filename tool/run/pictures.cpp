// SPDX-License-Identifier: MIT
#include "tool/run/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "tb/run/amount.h"
#include "tb/scene/compose.h"
#include "tb/scene/flip.h"
#include "tb/scene/quality.h"
#include "tb/scene/ssim.h"

namespace deburr::tool {

using tb::Change;
using tb::Image;

namespace {

constexpr int kAnyDifference = 255;  // gain that scales any difference to full scale

std::optional<double> value_of(double measure) {
  return std::isnan(measure) ? std::nullopt : std::optional(measure);
}

}  // namespace

tb::Quality measure_quality(std::string name, const Image& before, const Image& after,
                            const Image& reference, const tb::DepthImage* depth) {
  const tb::Mask edges = tb::edge_mask(reference, before);
  tb::Quality quality;
  quality.reference = std::move(name);
  quality.psnr_db = value_of(psnr(after, reference));
  quality.psnr_before_db = value_of(psnr(before, reference));
  quality.psnr_edge_db = value_of(psnr(after, reference, edges));
  quality.psnr_edge_before_db = value_of(psnr(before, reference, edges));
  if (depth) {
    const tb::Mask silhouettes = tb::silhouette_mask(edges, *depth);
    quality.psnr_silhouette_db = value_of(psnr(after, reference, silhouettes));
    quality.psnr_silhouette_before_db = value_of(psnr(before, reference, silhouettes));
  }
  const Image* const both[] = {&after, &before};
  const std::vector<double> flips = tb::flip(reference, both), similar = ssim(reference, both);
  quality.flip = flips[0];
  quality.flip_before = flips[1];
  quality.ssim = value_of(similar[0]);
  quality.ssim_before = value_of(similar[1]);
  return quality;
}

Change measure_change(const Image& before, const Image& after, const Image* reference) {
  const auto percent = [](std::int64_t part, std::size_t whole) {
    return 100 * static_cast<double>(part) / static_cast<double>(whole);
  };
  Change change;
  const std::size_t all = before.pixels.size();
  change.small_percent = percent(tb::count_different(after, before, Change::kSmall), all);
  change.large_percent = percent(tb::count_different(after, before, Change::kLarge), all);
  change.psnr_db = psnr(after, before);
  if (!reference) return change;
  const tb::Mask right = inverted(tb::edge_mask(*reference, before));
  const auto there = static_cast<std::size_t>(count(right));
  if (there == 0) return change;
  change.right_small_percent =
      percent(tb::count_different(after, before, right, Change::kSmall), there);
  change.right_large_percent =
      percent(tb::count_different(after, before, right, Change::kLarge), there);
  return change;
}

Image delivered_part(const Image& image, std::size_t delivered, const tb::Rgba8& rest) {
  Image part = image;
  const auto from = std::min(delivered, part.pixels.size());
  std::fill(part.pixels.begin() + static_cast<std::ptrdiff_t>(from), part.pixels.end(), rest);
  return part;
}

void add_frame_pictures(RunContext& context, const SmoothedFrame& frame) {
  const std::size_t all = frame.after.pixels.size();
  const Image after = delivered_part(frame.after, frame.delivered, kNotDelivered);
  const auto compared = [&](const Image& with, int gain) {
    return delivered_part(tb::difference(frame.after, with, gain), frame.delivered, kNotCompared);
  };
  const std::string missing =
      frame.delivered >= all ? ""
                             : fmt::format("; {} of {} pixels, the grey rest was not delivered",
                                           tb::grouped(frame.delivered), tb::grouped(all));
  const std::string unknown = missing.empty() ? "" : "; black where nothing was delivered";
  context.add_image("before", frame.before, "Before", frame.before_caption);
  context.add_image("after", after, "After",
                    "the pixels that the hardware model delivered" + missing);
  if (frame.golden) {
    context.add_image("golden", *frame.golden, "Golden model",
                      "the same frame by the golden model");
    const Image apart = compared(*frame.golden, kAnyDifference);
    const bool none =
        tb::count_different(apart, Image(apart.width, apart.height, kNotCompared)) == 0;
    context.add_image("difference", apart, "Difference",
                      (none ? "hardware against golden: none"
                            : "hardware against golden: any difference is bright") +
                          unknown);
  }
  if (frame.reference) {
    context.add_image("reference", *frame.reference, "Reference", frame.reference_caption);
    context.add_image("error", compared(*frame.reference, kDifferenceGain), "Error",
                      fmt::format("after against reference, {} times{}", kDifferenceGain, unknown));
  }
  context.add_image("change", compared(frame.before, kDifferenceGain), "Change",
                    fmt::format("after against before, {} times{}", kDifferenceGain, unknown));
}

Image weights_picture(int width, int height, const std::vector<Weights>& weights) {
  const auto bright = [](int weight) {
    return static_cast<std::uint8_t>(std::min(255, 2 * weight));
  };
  Image picture(width, height);
  for (std::size_t i = 0; i < weights.size(); ++i)
    picture.pixels[i] = {bright(weights[i].first), bright(weights[i].second),
                         static_cast<std::uint8_t>(weights[i].horizontal ? 160 : 0), 255};
  return picture;
}

}  // namespace deburr::tool
