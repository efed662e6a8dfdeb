// SPDX-License-Identifier: MIT
// The whole project on the same scenes: every method's quality against supersampling, and what the
// hardware model of it costs: tables and picture of docs/measurements/comparison.md.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tb/scene/image.h"

namespace deburr::studies {

// Of a frame, by the hardware model, compared with golden throughout.
struct ComparisonCost {
  double blended = 0;  // pixels that took a share of a neighbour; of two engines the sum
  double cycles = 0;
  double bytes = 0;        // a pixel of the frame, streams and memory
  std::uint64_t bits = 0;  // of all memories, physical
};

struct ComparisonRow {
  std::string method;
  double psnr = 0, edges = 0, silhouettes = 0;  // dB; infinite for the reference
  double flip = 0, ssim = 0;                    // over the frame
  std::optional<ComparisonCost> cost;           // of what the project has hardware for
};

std::span<const std::string_view> comparison_scenes();

// All methods on a scene. Costs are measured in processes of their own, so call it before anything
// of SystemC is elaborated.
std::vector<ComparisonRow> compare_methods(const std::string& scene);

// "### name", the table, and an empty line.
std::string comparison_section(const std::string& name, std::span<const ComparisonRow> rows);
// Means over scenes, row by row.
std::vector<ComparisonRow> means_of(std::span<const std::vector<ComparisonRow>> scenes);

// Crops of some scenes, a cell a method, with its name and PSNR over edges.
tb::Image comparison_sheet();

}  // namespace deburr::studies
