// SPDX-License-Identifier: MIT
// The recipe of the learned weights' ROMs, as text: the trainer's version, its options, the
// configuration for frames, and every frame with a hash of its pixels.
// spec/morphological/learned_weights.h contains the hash of that text (kWeightsRecipe).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "golden/morphological/learned_weights.h"
#include "studies/training/training_frames.h"
#include "studies/training/weight_trainer.h"

namespace deburr::studies::training {

// Raise it with every change that affects the tables and no other line of the recipe
// (WeightTrainer.ReproducesTheTablesOfItsVersion reports that).
inline constexpr int kTrainerVersion = 2;

// Hash of name, size, and the colours of frame and reference.
std::uint64_t hash_of(const ReferenceFrame& frame);

// A frame's name and hash, in training order.
using HashedFrame = std::pair<std::string, std::uint64_t>;
std::string recipe_text(const Recipe& recipe, const FrameOptions& options,
                        const std::vector<HashedFrame>& frames);
// The frames listed in a recipe.
std::vector<HashedFrame> frames_of_recipe(const std::string& text);

// Text of spec/morphological/learned_weights.h.
std::string header_of(const golden::morphological::WeightTables& tables, const std::string& recipe);

}  // namespace deburr::studies::training
