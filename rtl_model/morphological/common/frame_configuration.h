// SPDX-License-Identifier: MIT
// Configuration of the current frame, decoded from the registers: a wire that every unit reads.
// Loaded with the first beat of a frame and constant until the next frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "rtl_model/fabric/payload.h"
#include "spec/morphological/parameters.h"

namespace deburr::rtl::morphological {

struct FrameConfiguration {
  std::uint16_t width = 0, height = 0;  // pixels
  std::uint32_t beats = 0;              // per row
  std::uint32_t rows = 0;               // slot rows: height + R + 5
  std::uint16_t last_count = 0;         // lanes used in the last beat of a row
  spec::morphological::EdgeSource source{};
  bool dynamic = false;
  spec::morphological::DynamicLuma dynamic_luma{};
  spec::morphological::LocalContrast local_contrast{};
  // Thresholds for luma steps.
  std::uint32_t threshold = 0, threshold_on = 0, threshold_off = 0, floor = 0;
  std::uint32_t alpha = 0, depth_threshold = 0;
  spec::morphological::Predictor predictor{};
  std::uint16_t steps = 0;
  bool contiguous = false, safe = false, trim = false, linear_light = false;
  bool crossings = false;               // runs also end at crossings
  bool clamp = false;                   // edges outside the frame repeat the nearest pixel's
  bool table = false, learned = false;  // source of areas; both false: analytic
  std::uint16_t search_steps = 0;       // 1..112
  std::uint16_t diagonal_steps = 0;     // 0: none
  bool corners = false;                 // corners are rounded
  std::uint16_t corner_loss = 0;        // 256 - corner_rounding
  bool strongest = false;               // blend = strongest
  spec::morphological::Bypass bypass{};
  bool text_guard = false;
  std::uint32_t pixel_base = 0;  // bytes

  friend bool operator==(const FrameConfiguration&, const FrameConfiguration&) = default;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("width", self.width, 14, "U14");
    visit("height", self.height, 14, "U14");
    visit("beats", self.beats, 14, "U14");
    visit("rows", self.rows, 14, "U14");
    visit("last_count", self.last_count, 3, "U3");
    visit("source", self.source, 2, "U2");
    visit("dynamic", self.dynamic);
    visit("dynamic_luma", self.dynamic_luma, 2, "U2");
    visit("local_contrast", self.local_contrast, 2, "U2");
    visit("threshold", self.threshold, 24, "U8.16");
    visit("threshold_on", self.threshold_on, 24, "U8.16");
    visit("threshold_off", self.threshold_off, 24, "U8.16");
    visit("floor", self.floor, 24, "U8.16");
    visit("alpha", self.alpha, 24, "U0.24");
    visit("depth_threshold", self.depth_threshold, 16, "U0.16");
    visit("predictor", self.predictor, 2, "U2");
    visit("steps", self.steps, 5, "U5");
    visit("contiguous", self.contiguous);
    visit("safe", self.safe);
    visit("trim", self.trim);
    visit("linear_light", self.linear_light);
    visit("crossings", self.crossings);
    visit("clamp", self.clamp);
    visit("table", self.table);
    visit("learned", self.learned);
    visit("search_steps", self.search_steps, 7, "U7");
    visit("diagonal_steps", self.diagonal_steps, 5, "U5");
    visit("corners", self.corners);
    visit("corner_loss", self.corner_loss, 9, "U9");
    visit("strongest", self.strongest);
    visit("bypass", self.bypass, 3, "U3");
    visit("text_guard", self.text_guard);
    visit("pixel_base", self.pixel_base, 32, "U32");
  }
};

// Decoded registers; `valid`: SIZE is in range.
struct Decoded {
  FrameConfiguration configuration;
  bool valid = false;

  friend bool operator==(const Decoded&, const Decoded&) = default;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("configuration", self.configuration);
    visit("valid", self.valid);
  }
};

inline std::int32_t built_lanes(const spec::morphological::Parameters& p) {
  return spec::morphological::kLaneCount[static_cast<std::size_t>(p.lanes)];
}
inline bool has_depth(const spec::morphological::Parameters& p) {
  return p.edge_source == spec::morphological::EdgeSource::kDepth ||
         p.edge_source == spec::morphological::EdgeSource::kPredicated;
}
// For the copies in a datasheet.
inline std::uint32_t lane_copies(const spec::morphological::Parameters& p) {
  return static_cast<std::uint32_t>(built_lanes(p));
}
inline std::int32_t search_range_rows_of(const spec::morphological::Parameters& p) {  // R
  return p.window_rows / 2 - 1;
}
inline bool has_table(const spec::morphological::Parameters& p) {
  return p.area != spec::morphological::AreaSource::kAnalytic &&
         p.area != spec::morphological::AreaSource::kLearned;
}

// Widths of the fields that are built. `within`: prefix of the field names.
inline PayloadShape configuration_shape(const spec::morphological::Parameters& p,
                                        const std::string& within = "") {
  const bool crossings = p.ends == spec::morphological::Ends::kCrossings;
  const std::pair<const char*, bool> built[] = {
      {"contiguous", p.contiguous},
      {"crossings", crossings},
      {"clamp", p.border == spec::morphological::Border::kClamp && crossings && has_table(p)},
      {"table", has_table(p)},
      {"search_steps", has_table(p)},
      {"learned", p.area == spec::morphological::AreaSource::kLearned},
      {"diagonal_steps", p.diagonals},
      {"corners", p.round_corners},
      {"corner_loss", p.round_corners},
      {"text_guard", p.text_guard},
      {"pixel_base", p.storage == spec::morphological::Storage::kMemory}};
  PayloadShape shape;
  for (const auto& [name, is_built] : built)
    if (!is_built) shape.widths.emplace_back(within + name, 0);
  return shape;
}

}  // namespace deburr::rtl::morphological
