// SPDX-License-Identifier: MIT
#include "studies/training/title_weights.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <utility>

#include "golden/morphological/configuration.h"
#include "golden/morphological/morphological_golden.h"
#include "spec/error.h"
#include "studies/training/weight_samples.h"
#include "studies/training/weight_trainer.h"
#include "tb/scene/compose.h"
#include "tb/scene/quality.h"

namespace deburr::studies::training {
namespace {

using golden::morphological::MorphologicalGolden;
using golden::morphological::WeightTables;

constexpr int kLeastSide = 32;  // pixels, of a picture for training or measurement

void check(const TitlePair& pair) {
  const tb::Image &frame = pair.frame, &reference = pair.reference;
  if (frame.width != reference.width || frame.height != reference.height)
    throw spec::ConfigError(
        fmt::format("'{}' has {} x {} pixels, its reference {} x {}: expected one size", pair.name,
                    frame.width, frame.height, reference.width, reference.height));
  if (frame.width < kLeastSide || frame.height < kLeastSide)
    throw spec::ConfigError(fmt::format("'{}' has {} x {} pixels: expected at least {} x {}",
                                        pair.name, frame.width, frame.height, kLeastSide,
                                        kLeastSide));
  if (count(tb::edge_mask(reference, frame)) == 0)
    throw spec::ConfigError(fmt::format(
        "'{}' equals its reference within 2 codes: expected a supersampled reference", pair.name));
}

TitlePair part_of(const TitlePair& pair, const char* name, int x, int width) {
  const int height = pair.frame.height;
  return {fmt::format("{}, {}", pair.name, name), crop(pair.frame, x, 0, width, height),
          crop(pair.reference, x, 0, width, height)};
}

struct Split {
  std::vector<TitlePair> trained_on, kept_back;
};

Split split_of(const std::vector<TitlePair>& pairs) {
  if (pairs.empty()) throw spec::ConfigError("no pairs of frames to train on");
  Split split;
  if (pairs.size() == 1) {
    const TitlePair& pair = pairs.front();
    if (pair.frame.width < 2 * kLeastSide)
      throw spec::ConfigError(
          fmt::format("'{}' is {} pixels wide: a single pair needs at least {}, since half of it "
                      "is kept for validation",
                      pair.name, pair.frame.width, 2 * kLeastSide));
    check(pair);
    const int half = pair.frame.width / 2;
    split.trained_on.push_back(part_of(pair, "left half", 0, half));
    split.kept_back.push_back(part_of(pair, "right half", half, pair.frame.width - half));
  } else {
    for (std::size_t i = 0; i < pairs.size(); ++i)
      (i % 2 == 0 ? split.trained_on : split.kept_back).push_back(pairs[i]);
  }
  for (const auto* part : {&split.trained_on, &split.kept_back})
    for (const TitlePair& pair : *part) check(pair);
  return split;
}

KeptBack measured(const TitlePair& pair, const WeightTables& tables) {
  const tb::Mask edges = tb::edge_mask(pair.reference, pair.frame);
  const tb::Image shipped = smoothed(pair.frame, WeightTables()),
                  trained = smoothed(pair.frame, tables);
  return {pair.name,
          psnr(pair.frame, pair.reference, edges),
          psnr(shipped, pair.reference, edges),
          psnr(trained, pair.reference, edges),
          psnr(shipped, pair.reference),
          psnr(trained, pair.reference)};
}

}  // namespace

tb::Image smoothed(const tb::Image& frame, const WeightTables& tables) {
  MorphologicalGolden golden(
      golden::morphological::preset_parameters(spec::morphological::Preset::kDeburr),
      MorphologicalGolden::Detail::kPixels);
  golden.set_weight_tables(tables);
  tb::Image out(frame.width, frame.height);
  out.pixels = golden.process({frame.pixels, frame.width, frame.height});
  return out;
}

TitleWeights train_title(const std::vector<TitlePair>& pairs, const TitleOptions& options) {
  const Split split = split_of(pairs);
  TitleWeights result;
  std::vector<std::vector<WeightSample>> samples;
  const auto before_picture = [&] {
    if (options.before_picture) options.before_picture();
  };
  for (const TitlePair& pair : split.trained_on) {
    before_picture();
    samples.push_back(samples_of({pair.name, pair.name, pair.frame, pair.reference, {}}));
    if (samples.back().empty())
      throw spec::ConfigError(
          fmt::format("'{}' has no edge that the engine smooths: nothing to train on", pair.name));
    result.trained_on.push_back(pair.name);
  }
  Recipe recipe;
  recipe.batches = options.batches;
  recipe.rate = 0.02;
  recipe.seed = options.seed;
  result.tables = train(samples, recipe, WeightTables(), options.batch_done);
  for (const TitlePair& pair : split.kept_back) {
    before_picture();
    result.kept_back.push_back(measured(pair, result.tables));
    const KeptBack& last = result.kept_back.back();
    result.gain += last.trained - last.shipped;
    result.frame_gain += last.trained_frame - last.shipped_frame;
  }
  result.gain /= static_cast<double>(result.kept_back.size());
  result.frame_gain /= static_cast<double>(result.kept_back.size());
  return result;
}

}  // namespace deburr::studies::training
