// SPDX-License-Identifier: MIT
#include "studies/training/title_shares.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <utility>

#include "golden/morphological/configuration.h"
#include "golden/morphological/morphological_golden.h"
#include "spec/error.h"
#include "studies/training/share_samples.h"
#include "studies/training/share_trainer.h"
#include "tb/scene/compose.h"
#include "tb/scene/quality.h"

namespace deburr::studies::training {
namespace {

using golden::morphological::MorphologicalGolden;
using golden::morphological::ShareTables;

constexpr int kLeastSide = 32;  // pixels, of a picture that is trained on or measured

void check(const TitlePair& pair) {
  const tb::Image &frame = pair.frame, &truth = pair.truth;
  if (frame.width != truth.width || frame.height != truth.height)
    throw spec::ConfigError(
        fmt::format("'{}' has {} x {} pixels, its truth {} x {}: expected one size", pair.name,
                    frame.width, frame.height, truth.width, truth.height));
  if (frame.width < kLeastSide || frame.height < kLeastSide)
    throw spec::ConfigError(fmt::format("'{}' has {} x {} pixels: expected at least {} x {}",
                                        pair.name, frame.width, frame.height, kLeastSide,
                                        kLeastSide));
  if (count(tb::edge_mask(truth, frame)) == 0)
    throw spec::ConfigError(fmt::format(
        "'{}' is its truth within 2 codes: expected the same picture with supersampling",
        pair.name));
}

TitlePair part_of(const TitlePair& pair, const char* name, int x, int width) {
  const int height = pair.frame.height;
  return {fmt::format("{}, {}", pair.name, name), crop(pair.frame, x, 0, width, height),
          crop(pair.truth, x, 0, width, height)};
}

struct Split {
  std::vector<TitlePair> trained_on, kept_back;
};

Split split_of(const std::vector<TitlePair>& pairs) {
  if (pairs.empty()) throw spec::ConfigError("no pairs of frames to learn from");
  Split split;
  if (pairs.size() == 1) {
    const TitlePair& pair = pairs.front();
    if (pair.frame.width < 2 * kLeastSide)
      throw spec::ConfigError(fmt::format(
          "'{}' is {} pixels wide: a single pair, of which half is kept back, has at least {}",
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

KeptBack measured(const TitlePair& pair, const ShareTables& tables) {
  const tb::Mask edges = tb::edge_mask(pair.truth, pair.frame);
  const tb::Image shipped = smoothed(pair.frame, ShareTables()),
                  trained = smoothed(pair.frame, tables);
  return {pair.name,
          psnr(pair.frame, pair.truth, edges),
          psnr(shipped, pair.truth, edges),
          psnr(trained, pair.truth, edges),
          psnr(shipped, pair.truth),
          psnr(trained, pair.truth)};
}

}  // namespace

tb::Image smoothed(const tb::Image& frame, const ShareTables& tables) {
  MorphologicalGolden golden(
      golden::morphological::preset_parameters(spec::morphological::Preset::kDeburr),
      MorphologicalGolden::Detail::kPixels);
  golden.set_share_tables(tables);
  tb::Image out(frame.width, frame.height);
  out.pixels = golden.process({frame.pixels, frame.width, frame.height});
  return out;
}

TitleShares train_title(const std::vector<TitlePair>& pairs, const TitleOptions& options) {
  const Split split = split_of(pairs);
  TitleShares result;
  std::vector<std::vector<ShareSample>> samples;
  const auto before_picture = [&] {
    if (options.before_picture) options.before_picture();
  };
  for (const TitlePair& pair : split.trained_on) {
    before_picture();
    samples.push_back(samples_of({pair.name, pair.name, pair.frame, pair.truth, {}}));
    if (samples.back().empty())
      throw spec::ConfigError(
          fmt::format("'{}' has no edge that the engine smooths: nothing to learn", pair.name));
    result.trained_on.push_back(pair.name);
  }
  Recipe recipe;
  recipe.batches = options.batches;
  recipe.rate = 0.02;
  recipe.seed = options.seed;
  result.tables = train(samples, recipe, ShareTables(), options.batch_done);
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
