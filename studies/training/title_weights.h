// SPDX-License-Identifier: MIT
// Weights for a title: trained on pairs of its own frames, without and with supersampling, starting
// from the shipped weights; measured on kept-back frames.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "golden/morphological/learned_weights.h"
#include "tb/scene/image.h"

namespace deburr::studies::training {

struct TitlePair {
  std::string name;  // name in errors and tables
  tb::Image frame, reference;
};

struct TitleOptions {
  int batches = 600;
  std::uint64_t seed = 1;
  // Both may throw, which cancels the training.
  std::function<void(int)> batch_done = nullptr;
  std::function<void()> before_picture = nullptr;  // called before a picture is sampled or measured
};

// PSNR in dB of a kept-back picture, over the edges (docs/reference/scenes.md) and over the frame.
struct KeptBack {
  std::string name;
  double none = 0, shipped = 0, trained = 0;  // edges
  double shipped_frame = 0, trained_frame = 0;
};

struct TitleWeights {
  golden::morphological::WeightTables tables;
  std::vector<std::string> trained_on;
  std::vector<KeptBack> kept_back;
  double gain = 0;        // dB on edges, mean over the kept-back pictures
  double frame_gain = 0;  // over all pixels
};

// The engine's output for a frame with these weights and preset `deburr`.
tb::Image smoothed(const tb::Image& frame, const golden::morphological::WeightTables& tables);

// With several pairs every second one is kept back, with one pair its right half. Throws
// ConfigError for no pair, sizes that differ or are too small, a frame without an edge, and a
// reference equal to the frame.
TitleWeights train_title(const std::vector<TitlePair>& pairs, const TitleOptions& options);

}  // namespace deburr::studies::training
