// SPDX-License-Identifier: MIT
// Trains the contents of the ROMs of learned weights: stochastic gradient descent (Adam) on the
// squared error of the output codes of the engine's blend.
//
// Differentiable approximations: weights and sums are real numbers; the axis is chosen by
// sigmoid(20 x difference of the sums of weights), and a pixel's error is the mean of both axes'
// errors weighted by it. Every frame has the same total weight: its pixels are weighted by one over
// its mean error before training. The same frames, recipe and seed give the same tables on every
// machine.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "golden/morphological/learned_weights.h"
#include "studies/training/weight_samples.h"

namespace deburr::studies::training {

struct Recipe {
  int batches = 3000;
  int batch = 8192;        // pixels
  double rate = 0.05;      // Adam's; falls to zero along half a cosine
  double axis_slope = 20;  // of the softened axis choice, per unit of weight
  double decay = 1e-4;  // pull of B and C towards their initial values, times the rate, per batch
  std::uint64_t seed = 1;
  std::string text() const;  // one line: all settings that the tables depend on, except the frames
};

// Initial tables: A from the areas under a line between the ends of its run; B and C are 0.
golden::morphological::WeightTables first_guess();

// `batch_done` receives the number of finished batches.
golden::morphological::WeightTables train(
    const std::vector<std::vector<WeightSample>>& frames, const Recipe& recipe,
    const golden::morphological::WeightTables& start = first_guess(),
    const std::function<void(int)>& batch_done = nullptr);

// FNV-1a, 64 bits.
std::uint64_t hash_of(const std::string& text);

}  // namespace deburr::studies::training
