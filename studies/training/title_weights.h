// SPDX-License-Identifier: MIT
// Weights for a title: trained on pairs of its own frames, without and with supersampling, from the
// shipped weights on, and measured on what was kept back.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "golden/morphological/learned_weights.h"
#include "tb/scene/image.h"

namespace deburr::studies::training {

struct TitlePair {
  std::string name;  // what errors and tables call it
  tb::Image frame, reference;
};

struct TitleOptions {
  int batches = 600;
  std::uint64_t seed = 1;
  // Both may throw: then nothing was trained.
  std::function<void(int)> batch_done = nullptr;
  std::function<void()> before_picture = nullptr;  // is sampled or measured
};

// PSNR in dB of a kept-back picture, over the edges (docs/reference/scenes.md) and over all of it.
struct KeptBack {
  std::string name;
  double none = 0, shipped = 0, trained = 0;  // edges
  double shipped_frame = 0, trained_frame = 0;
};

struct TitleWeights {
  golden::morphological::WeightTables tables;
  std::vector<std::string> trained_on;
  std::vector<KeptBack> kept_back;
  double gain = 0;        // dB on edges, the mean over what was kept back
  double frame_gain = 0;  // over all pixels
};

// What the engine with these weights makes of a frame, by the rules of the preset `deburr`.
tb::Image smoothed(const tb::Image& frame, const golden::morphological::WeightTables& tables);

// Of several pairs every second one is kept back, of one pair the right half. ConfigError for no
// pair, sizes that differ or are too small, a frame without an edge, and a reference that is the
// frame.
TitleWeights train_title(const std::vector<TitlePair>& pairs, const TitleOptions& options);

}  // namespace deburr::studies::training
