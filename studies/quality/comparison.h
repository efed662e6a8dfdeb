// SPDX-License-Identifier: MIT
// All methods of the project on the same scenes: quality against supersampling, and the cost of the
// hardware model. Generates the tables and picture of docs/measurements/comparison.md.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tb/scene/image.h"

namespace deburr::studies {

// Cost per frame, from the hardware model, compared with golden throughout.
struct ComparisonCost {
  double blended = 0;  // pixels blended with a neighbour; for two engines the sum
  double cycles = 0;
  double bytes = 0;        // per pixel of the frame, streams and memory
  std::uint64_t bits = 0;  // all memories, physical
};

struct ComparisonRow {
  std::string method;
  double psnr = 0, edges = 0, silhouettes = 0;  // dB; infinite for the reference
  double flip = 0, ssim = 0;                    // over the frame
  std::optional<ComparisonCost> cost;           // for methods with hardware in this project
};

std::span<const std::string_view> comparison_scenes();

// All methods on one scene. Costs are measured in their own processes: call it before SystemC
// elaborates anything.
std::vector<ComparisonRow> compare_methods(const std::string& scene);

// "### name", the table, and an empty line.
std::string comparison_section(const std::string& name, std::span<const ComparisonRow> rows);
// Means over scenes, row by row.
std::vector<ComparisonRow> means_of(std::span<const std::vector<ComparisonRow>> scenes);

// Crops of some scenes, one cell per method, with its name and PSNR over edges.
tb::Image comparison_sheet();

}  // namespace deburr::studies
