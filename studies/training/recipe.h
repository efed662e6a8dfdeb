// SPDX-License-Identifier: MIT
// What the ROMs of learned weights were made of, as text: the trainer's version, its options, the
// rules that frames are looked at by, every frame with a hash of its pixels.
// spec/morphological/learned_weights.h has the hash of that text (kWeightsRecipe).
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

// To be raised with everything that changes tables and stands in no other line of the recipe
// (WeightTrainer.GivesTheTablesOfItsVersion says when).
inline constexpr int kTrainerVersion = 2;

// Of name, size and colours of frame and reference.
std::uint64_t hash_of(const ReferenceFrame& frame);

// A frame is its name and hash, in the order of the training.
using HashedFrame = std::pair<std::string, std::uint64_t>;
std::string recipe_text(const Recipe& recipe, const FrameOptions& options,
                        const std::vector<HashedFrame>& frames);
// The frames of such a text.
std::vector<HashedFrame> frames_of_recipe(const std::string& text);

// spec/morphological/learned_weights.h.
std::string header_of(const golden::morphological::WeightTables& tables, const std::string& recipe);

}  // namespace deburr::studies::training
