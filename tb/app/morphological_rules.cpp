// SPDX-License-Identifier: MIT
#include "tb/app/morphological_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

#include "golden/morphological/configuration.h"

namespace deburr::tb {
namespace {

constexpr std::string_view kMorphologicalPrefix = "morphological.";

std::string_view preset_name(const spec::morphological::Parameters& values) {
  return spec::morphological::kPresetNames[static_cast<std::size_t>(values.preset)];
}

bool has_qualities(const spec::morphological::Parameters& values) {
  return std::any_of(
      spec::morphological::kPresets.begin(), spec::morphological::kPresets.end(),
      [&](const auto& row) { return row.preset == values.preset && row.has_qualities; });
}

// "preset mlaa", "preset smaa, quality high".
std::string source_of(const spec::morphological::Parameters& values) {
  std::string source = fmt::format("preset {}", preset_name(values));
  if (has_qualities(values))
    source +=
        fmt::format(", quality {}",
                    spec::morphological::kQualityNames[static_cast<std::size_t>(values.quality)]);
  return source;
}

}  // namespace

void apply_preset(ParameterSet& set, const spec::morphological::Parameters& values) {
  spec::morphological::Parameters rules =
      golden::morphological::preset_parameters(values.preset, values.quality);
  const std::string by = source_of(values);
  ParameterSet preset;
  preset.add_engine("morphological", rules);
  const auto imply = [&](std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names) {
      const std::string full = fmt::format("{}{}", kMorphologicalPrefix, name);
      set.imply(full, preset.find(full)->text(), by);
    }
  };
  imply({"edges.source", "edges.threshold_mode", "edges.dynamic_luma", "edges.threshold",
         "edges.local_contrast", "ends", "predictor", "steps", "contiguous", "safe", "trim", "area",
         "diagonals", "round_corners", "blend"});
  if (has_qualities(values))
    imply({"search_steps", "diagonal_steps", "corner_rounding", "window_rows"});
}

std::string preset_label(const ParameterSet& set, const spec::morphological::Parameters& values) {
  std::string label = source_of(values);
  bool first = true;
  for (const Parameter* p : set.changed()) {
    if (!p->name.starts_with(kMorphologicalPrefix)) continue;
    label += first ? ", changed: " : ", ";
    label += p->name.substr(kMorphologicalPrefix.size());
    first = false;
  }
  return label;
}

void refuse_unused_rules(const ParameterSet& set, const spec::morphological::Parameters& p,
                         std::string_view memory) {
  const auto refuse = [&](std::string_view why, std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names)
      set.refuse(fmt::format("{}{}", kMorphologicalPrefix, name), why);
  };
  const bool depth = p.edge_source == spec::morphological::EdgeSource::kDepth;
  const bool predicated = p.edge_source == spec::morphological::EdgeSource::kPredicated;
  if (depth)
    refuse("morphological.edges.source = depth compares depths, by edges.depth_threshold",
           {"edges.threshold_mode", "edges.local_contrast"});
  if (depth || predicated)
    refuse("morphological.edges.source is neither luma nor colour and has thresholds of its own",
           {"edges.threshold"});
  if (depth || p.threshold_mode == spec::morphological::ThresholdMode::kFixed)
    refuse("it belongs to morphological.edges.threshold_mode = dynamic",
           {"edges.alpha", "edges.floor", "edges.dynamic_luma"});
  else
    refuse("morphological.edges.threshold_mode = dynamic computes the threshold",
           {"edges.threshold"});
  if (!depth && !predicated)
    refuse("it belongs to morphological.edges.source = depth or predicated",
           {"edges.depth_threshold"});
  if (!predicated)
    refuse("it belongs to morphological.edges.source = predicated",
           {"edges.threshold_on_depth_edge", "edges.threshold_off_depth_edge"});
  if (p.predictor == spec::morphological::Predictor::kNone)
    refuse("morphological.predictor = none extends no run",
           {"steps", "contiguous", "safe", "trim"});
  if (!has_qualities(p))
    refuse("it belongs to morphological.preset = smaa or smaa-dynamic", {"quality"});
  if (p.area == spec::morphological::AreaSource::kAnalytic ||
      p.area == spec::morphological::AreaSource::kLearned)
    refuse("morphological.area = analytic and learned search nothing", {"search_steps"});
  if (!p.diagonals) refuse("it belongs to morphological.diagonals = true", {"diagonal_steps"});
  if (!p.round_corners)
    refuse("it belongs to morphological.round_corners = true", {"corner_rounding"});
  if (p.storage == spec::morphological::Storage::kLineBuffers) {
    constexpr std::string_view kWhy = "morphological.storage = line_buffers uses no memory";
    refuse(kWhy, {"memory.outstanding"});
    set.refuse_all(fmt::format("{}.", memory), kWhy);
  }
}

void refuse_unused_memory(const ParameterSet& set, std::string_view prefix,
                          const MemoryParameters& memory) {
  const auto refuse = [&](std::string_view name, std::string_view why) {
    set.refuse(fmt::format("{}.{}", prefix, name), why);
  };
  if (memory.latency_max > 0 && memory.latency_max <= memory.latency)
    refuse("latency_max", fmt::format("it is not above {}.latency = {}", prefix, memory.latency));
  if (memory.banks == 1) refuse("interleave_bytes", fmt::format("{}.banks = 1", prefix));
  if (memory.error_address < 0)
    refuse("error_bytes", fmt::format("{}.error_address names no address", prefix));
}

std::vector<std::string> build_notes(const spec::morphological::Parameters& values) {
  if (values.trial_clocks >= 4) return {};
  return {fmt::format(
      "morphological.trial_clocks = {}: steps of a trial share a clock, so the engine is not made "
      "for 250 MHz (docs/morphological_hardware.md, Trials)",
      values.trial_clocks)};
}

}  // namespace deburr::tb
