// SPDX-License-Identifier: MIT
// Learns the contents of the ROMs of learned weights: stochastic descent (Adam) on the squared
// error of the codes that the engine's blend gives.
//
// Differentiable stand-ins: weights and sums are real numbers; the axis is chosen by
// sigmoid(20 x difference of the sums of weights); the error of a pixel is the mean of the errors
// of both axes by that. Every frame counts the same: its pixels weigh one over its mean error
// before training. The same frames, recipe and seed give the same tables, on every machine.
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
  double rate = 0.05;      // Adam's, falls to zero along half a cosine
  double axis_slope = 20;  // of the softened choice, a unit of weight
  double decay = 1e-4;     // of B and C towards what they began as, times the rate, a batch
  std::uint64_t seed = 1;
  std::string text() const;  // one line, everything that the tables depend on but the frames
};

// Where the training begins: A from the areas under a line between the ends of its run, B and C 0.
golden::morphological::WeightTables first_guess();

// `batch_done` is told how many batches are done.
golden::morphological::WeightTables train(
    const std::vector<std::vector<WeightSample>>& frames, const Recipe& recipe,
    const golden::morphological::WeightTables& start = first_guess(),
    const std::function<void(int)>& batch_done = nullptr);

// FNV-1a, 64 bits.
std::uint64_t hash_of(const std::string& text);

}  // namespace deburr::studies::training
