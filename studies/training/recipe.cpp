// SPDX-License-Identifier: MIT
#include "studies/training/recipe.h"

#include <fmt/format.h>

#include <sstream>
#include <string_view>

#include "golden/morphological/configuration.h"
#include "golden/morphological/morphological_golden.h"
#include "spec/error.h"
#include "tb/base/fnv.h"
#include "tb/stimuli/weight_file.h"

namespace deburr::studies::training {
namespace {

using golden::morphological::WeightTables;

constexpr std::string_view kFrame = "frame ";

void add(tb::FnvHash& hash, const tb::Image& image) {
  hash.lowest_first(static_cast<std::uint64_t>(image.width), 4);
  hash.lowest_first(static_cast<std::uint64_t>(image.height), 4);
  for (const tb::Rgba8& pixel : image.pixels)
    for (std::size_t c = 0; c < 3; ++c) hash.byte(pixel[c]);
}

template <class Table>
std::string listed(const Table& table) {
  std::string text, line = "   ";
  for (const std::int8_t v : table) {
    const std::string item = fmt::format(" {},", v);
    if (line.size() + item.size() > 100) {
      text += line + '\n';
      line = "   ";
    }
    line += item;
  }
  text += line;
  text.pop_back();
  return text;
}

// The least step of a colour that is an edge of preset deburr, whatever units its T has.
int least_step() {
  for (int step = 1; step < 256; ++step) {
    golden::morphological::MorphologicalGolden golden(
        golden::morphological::preset_parameters(spec::morphological::Preset::kDeburr));
    const auto code = static_cast<std::uint8_t>(step);
    const std::vector<tb::Rgba8> pixels = {{0, 0, 0, 255}, {code, code, code, 255}};
    golden.process({pixels, 2, 1});
    if (golden.edges().left.at(1, 0)) return step;
  }
  return 256;
}

}  // namespace

std::uint64_t hash_of(const ReferenceFrame& frame) {
  tb::FnvHash hash;
  for (const char c : frame.name) hash.byte(static_cast<unsigned char>(c));
  add(hash, frame.frame);
  add(hash, frame.reference);
  return hash.value();
}

std::string recipe_text(const Recipe& recipe, const FrameOptions& options,
                        const std::vector<HashedFrame>& frames) {
  std::string text = fmt::format(
      "# SPDX-License-Identifier: MIT\ntrainer {}\n{}\nedges from {} codes on\nframes samples={} "
      "size={}\n",
      kTrainerVersion, recipe.text(), least_step(), options.samples, options.size);
  for (const auto& [name, hash] : frames) text += fmt::format("{}{} {:016x}\n", kFrame, name, hash);
  return text;
}

std::vector<HashedFrame> frames_of_recipe(const std::string& text) {
  std::vector<HashedFrame> frames;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(kFrame)) continue;
    std::istringstream words(line.substr(kFrame.size()));
    HashedFrame frame;
    if (!(words >> frame.first >> std::hex >> frame.second))
      throw spec::FileError(fmt::format("no frame of a recipe: '{}'", line));
    frames.push_back(std::move(frame));
  }
  return frames;
}

std::string header_of(const WeightTables& tables, const std::string& recipe) {
  return fmt::format(
      R"(// SPDX-License-Identifier: MIT
// Contents of the ROMs of learned weights (docs/reference/morphological/learned_weights.md) as an
// engine is built with them. Written by scripts/train-weights; do not edit.
#pragma once

#include <array>
#include <cstdint>

namespace deburr::spec::morphological {{

// FNV-1a (64 bits) of the recipe that these were trained by.
inline constexpr std::uint64_t kWeightsRecipe = 0x{:016x};

// Of all entries, as the register WEIGHTS_SUM has it.
inline constexpr std::uint32_t kWeightsSum = {};

// clang-format off
// A, S3.4: ((code_near * 4 + code_far) * 8 + D(d_near)) * 8 + D(d_far).
inline constexpr std::array<std::int8_t, 1024> kWeightsOfCodes = {{
{}}};

// B, S3.4: (E_near * 8 + D(d_near)) * 4 + Lambda(L).
inline constexpr std::array<std::int8_t, 640> kWeightsOfNear = {{
{}}};

// C, S3.4: (E_far * 8 + D(d_far)) * 4 + Lambda(L).
inline constexpr std::array<std::int8_t, 640> kWeightsOfFar = {{
{}}};
// clang-format on

}}  // namespace deburr::spec::morphological
)",
      hash_of(recipe), tb::stimuli::sum_of(tables), listed(tables.of_codes), listed(tables.of_near),
      listed(tables.of_far));
}

}  // namespace deburr::studies::training
