// SPDX-License-Identifier: MIT
#include "tb/app/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "tb/results/interrupt.h"
#include "tb/results/progress.h"
#include "tb/results/report.h"
#include "tb/scene/compose.h"
#include "tb/scene/image_bytes.h"
#include "tb/scene/quality.h"

namespace deburr::tb {
namespace {

constexpr int kAnyDifference = 255;  // gain that makes it full scale

std::optional<double> value_of(double psnr) {
  return std::isnan(psnr) ? std::nullopt : std::optional(psnr);
}

}  // namespace

std::string truth_caption() {
  return fmt::format("{} samples a pixel", kTruthSamples * kTruthSamples);
}

std::shared_ptr<const Image> scene_truth(const TextureScene& scene, RenderOptions options,
                                         const RunContext& context) {
  options.width = scene.stream().width;
  options.height = scene.stream().height;
  options.samples = kTruthSamples;
  Waiting waiting("rendering the truth", context.quiet());
  options.interrupted = [&] {
    waiting.update();
    return interrupted();
  };
  const std::string what =
      fmt::format("truth of {}, sampling {}, averaging {}", kTruthSamples,
                  static_cast<int>(options.sampling), static_cast<int>(options.averaging));
  const std::initializer_list<std::string_view> depends = {"scene.", "sampler.wrap"};
  return context.shared<Image>(what, depends, [&] {
    const std::string bytes = context.shared_bytes(what, depends, [&] {
      std::string made;
      append_bytes(made, render(scene.scene(), options));
      return made;
    });
    std::string_view rest = bytes;
    return take_image<Rgba8>(rest);
  });
}

Image judge_by_scene(const TextureScene& scene, RenderOptions options, const Image& before,
                     const Image& after, Result& result, const RunContext& context) {
  try {
    Image truth = *scene_truth(scene, std::move(options), context);
    result.quality = judge_quality(fmt::format("supersampled-{}", kTruthSamples * kTruthSamples),
                                   before, after, truth, &scene.stream().depth);
    return truth;
  } catch (const Interrupted&) {
    result.interrupted = true;
    return {};
  }
}

Quality judge_quality(std::string reference, const Image& before, const Image& after,
                      const Image& truth, const DepthImage* depth) {
  const Mask edges = edge_mask(truth, before);
  Quality quality;
  quality.reference = std::move(reference);
  quality.psnr_db = value_of(psnr(after, truth));
  quality.psnr_before_db = value_of(psnr(before, truth));
  quality.psnr_edge_db = value_of(psnr(after, truth, edges));
  quality.psnr_edge_before_db = value_of(psnr(before, truth, edges));
  if (depth) {
    const Mask silhouettes = silhouette_mask(edges, *depth);
    quality.psnr_silhouette_db = value_of(psnr(after, truth, silhouettes));
    quality.psnr_silhouette_before_db = value_of(psnr(before, truth, silhouettes));
  }
  return quality;
}

Image without(Image image, const std::vector<bool>& missing, const Rgba8& colour) {
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    if (missing[i]) image.pixels[i] = colour;
  return image;
}

Image delivered_part(const Image& image, std::size_t delivered, const Rgba8& rest) {
  Image part = image;
  const auto from = std::min(delivered, part.pixels.size());
  std::fill(part.pixels.begin() + static_cast<std::ptrdiff_t>(from), part.pixels.end(), rest);
  return part;
}

void add_frame_pictures(RunContext& context, const SmoothedFrame& frame) {
  const std::size_t all = frame.after.pixels.size();
  const Image after = delivered_part(frame.after, frame.delivered, kNotDelivered);
  const auto compared = [&](const Image& with, int gain) {
    return delivered_part(difference(frame.after, with, gain), frame.delivered, kNotCompared);
  };
  const std::string missing =
      frame.delivered >= all ? ""
                             : fmt::format("; {} of {} pixels, the grey rest was not delivered",
                                           grouped(frame.delivered), grouped(all));
  const std::string unknown = missing.empty() ? "" : "; black where nothing was delivered";
  context.add_image("before", frame.before, "Before", frame.before_caption);
  context.add_image("after", after, "After",
                    "the pixels that the hardware model delivered" + missing);
  if (frame.golden) {
    context.add_image("golden", *frame.golden, "Golden model",
                      "the same frame by the golden model");
    const Image apart = compared(*frame.golden, kAnyDifference);
    const bool none = count_different(apart, Image(apart.width, apart.height, kNotCompared)) == 0;
    context.add_image("difference", apart, "Difference",
                      (none ? "hardware against golden: none"
                            : "hardware against golden: any difference is bright") +
                          unknown);
  }
  if (frame.truth) {
    context.add_image("truth", *frame.truth, "Truth", frame.truth_caption);
    context.add_image("error", compared(*frame.truth, kDifferenceGain), "Error",
                      fmt::format("after against truth, {} times{}", kDifferenceGain, unknown));
  }
  context.add_image("change", compared(frame.before, kDifferenceGain), "Change",
                    fmt::format("after against before, {} times{}", kDifferenceGain, unknown));
}

void add_smoothing_pictures(RunContext& context, const SmoothedFrame& frame,
                            const std::vector<spec::morphological::BlendTap>& taps) {
  add_frame_pictures(context, frame);
  context.add_image("edges", edge_picture(frame.before, taps), "Edges",
                    "left edges red, top edges green");
  context.add_image("weights", weight_picture(frame.after.width, frame.after.height, taps),
                    "Weights",
                    "share of the upper or left neighbour red, of the lower or right one green, "
                    "blue where the two are left and right");
}

Image edge_picture(const Image& frame, const std::vector<spec::morphological::BlendTap>& taps) {
  constexpr int kDim = 3;
  Image picture(frame.width, frame.height);
  for (std::size_t i = 0; i < taps.size(); ++i) {
    const Rgba8& p = frame.pixels[i];
    const auto grey = static_cast<std::uint8_t>((p[0] + 2 * p[1] + p[2]) / 4 / kDim);
    picture.pixels[i] = {taps[i].edges & 1 ? std::uint8_t{255} : grey,
                         taps[i].edges & 2 ? std::uint8_t{255} : grey, grey, 255};
  }
  return picture;
}

Image weight_picture(int width, int height,
                     const std::vector<spec::morphological::BlendTap>& taps) {
  const auto bright = [](int share) { return static_cast<std::uint8_t>(std::min(255, 2 * share)); };
  Image picture(width, height);
  for (std::size_t i = 0; i < taps.size(); ++i)
    picture.pixels[i] = {bright(taps[i].first), bright(taps[i].second),
                         static_cast<std::uint8_t>(taps[i].horizontal ? 160 : 0), 255};
  return picture;
}

}  // namespace deburr::tb
