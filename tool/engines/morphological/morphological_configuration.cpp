// SPDX-License-Identifier: MIT
#include "tool/engines/morphological/morphological_configuration.h"

#include <fmt/format.h>

#include <initializer_list>

#include "spec/check_build.h"
#include "tool/run/input_rules.h"
#include "tool/run/preset_help.h"

namespace deburr::tool {
namespace {

constexpr std::string_view kMorphologicalPrefix = "morphological.";

std::string_view preset_name(const spec::morphological::Parameters& values) {
  return spec::morphological::kPresetNames[static_cast<std::size_t>(values.preset)];
}

// "preset mlaa", "preset smaa, quality high".
std::string source_of(const spec::morphological::Parameters& values) {
  std::string source = fmt::format("preset {}", preset_name(values));
  if (has_qualities(values.preset))
    source +=
        fmt::format(", quality {}",
                    spec::morphological::kQualityNames[static_cast<std::size_t>(values.quality)]);
  return source;
}

}  // namespace

void apply_preset(tb::ParameterSet& set, const spec::morphological::Parameters& values) {
  const spec::morphological::Parameters configuration =
      preset_parameters(values.preset, values.quality);
  for_each_of(values.preset, values.quality, [&](std::string_view name, auto, auto) {
    set.imply(fmt::format("{}{}", kMorphologicalPrefix, name),
              spec::value_text(configuration, name), source_of(values));
  });
}

std::string preset_label(const tb::ParameterSet& set,
                         const spec::morphological::Parameters& values) {
  return with_changes(source_of(values), set, kMorphologicalPrefix);
}

void reject_unused_configuration(const tb::ParameterSet& set,
                                 const spec::morphological::Parameters& p,
                                 std::string_view memory) {
  const auto reject = [&](std::string_view why, std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names)
      set.reject(fmt::format("{}{}", kMorphologicalPrefix, name), why);
  };
  const bool depth = p.edge_source == spec::morphological::EdgeSource::kDepth;
  const bool predicated = p.edge_source == spec::morphological::EdgeSource::kPredicated;
  if (depth)
    reject("morphological.edges.source = depth compares depths, by edges.depth_threshold",
           {"edges.threshold_mode", "edges.local_contrast"});
  if (depth || predicated)
    reject("morphological.edges.source is neither luma nor colour and has thresholds of its own",
           {"edges.threshold"});
  if (depth || p.threshold_mode == spec::morphological::ThresholdMode::kFixed)
    reject("it is only used with morphological.edges.threshold_mode = dynamic",
           {"edges.alpha", "edges.floor", "edges.dynamic_luma"});
  else
    reject("morphological.edges.threshold_mode = dynamic computes the threshold",
           {"edges.threshold"});
  if (!depth && !predicated)
    reject("it is only used with morphological.edges.source = depth or predicated",
           {"edges.depth_threshold"});
  if (!predicated)
    reject("it is only used with morphological.edges.source = predicated",
           {"edges.threshold_on_depth_edge", "edges.threshold_off_depth_edge"});
  if (p.predictor == spec::morphological::Predictor::kNone)
    reject("morphological.predictor = none extends no run",
           {"steps", "contiguous", "safe", "trim"});
  if (!has_qualities(p.preset))
    reject("it is only used with morphological.preset = smaa or smaa-dynamic", {"quality"});
  if (p.area == spec::morphological::AreaSource::kAnalytic ||
      p.area == spec::morphological::AreaSource::kLearned)
    reject("morphological.area = analytic and learned search nothing", {"search_steps"});
  if ((p.area == spec::morphological::AreaSource::kAnalytic ||
       p.area == spec::morphological::AreaSource::kLearned) &&
      !p.diagonals)
    reject("it is only used with tables: morphological.area or morphological.diagonals",
           {"area_values"});
  if (!p.diagonals)
    reject("it is only used with morphological.diagonals = true", {"diagonal_steps"});
  if (!p.round_corners)
    reject("it is only used with morphological.round_corners = true", {"corner_rounding"});
  if (p.storage == spec::morphological::Storage::kLineBuffers) {
    constexpr std::string_view kWhy = "morphological.storage = line_buffers uses no memory";
    reject(kWhy, {"memory.outstanding"});
    set.reject_all(fmt::format("{}.", memory), kWhy);
  }
}

namespace {

// Notes legal thresholds that are probably mistakes. In the former units (fractions of full scale)
// a value is 1/255 as large, for alpha 1/256. Five digits keep the largest value below 1.
std::vector<std::string> threshold_notes(const spec::morphological::Parameters& p) {
  std::vector<std::string> notes;
  const auto below_a_code = [&](std::string_view name, std::int32_t threshold) {
    if (threshold < spec::morphological::kOneCode)
      notes.push_back(fmt::format(
          "morphological.{} = {} is {:.5f} of a code, so noise makes edges: its unit is code / {}; "
          "multiply values for versions before 0.3.0 by 255",
          name, threshold, static_cast<double>(threshold) / spec::morphological::kOneCode,
          spec::morphological::kOneCode));
  };
  if (p.edge_source == spec::morphological::EdgeSource::kDepth) return notes;
  if (p.edge_source == spec::morphological::EdgeSource::kPredicated) {
    below_a_code("edges.threshold_on_depth_edge", p.threshold_on_depth_edge);
    below_a_code("edges.threshold_off_depth_edge", p.threshold_off_depth_edge);
  } else if (p.threshold_mode == spec::morphological::ThresholdMode::kFixed) {
    below_a_code("edges.threshold", p.threshold);
  } else {
    below_a_code("edges.floor", p.floor);
    // 255 alpha is below one code; to disable it, 0 is used.
    if (p.alpha > 0 && std::int64_t{255} * p.alpha < 1 << 24)
      notes.push_back(fmt::format(
          "morphological.edges.alpha = {} is {:.5f}, below one code even for white{}: its unit is "
          "1 / {}; multiply values for versions before 0.3.0 by 256",
          p.alpha, static_cast<double>(p.alpha) / (1 << 24),
          p.floor >= spec::morphological::kOneCode ? ", so edges.floor alone decides" : "",
          1 << 24));
  }
  return notes;
}

}  // namespace

std::vector<std::string> build_notes(const spec::morphological::Parameters& values) {
  std::vector<std::string> notes = threshold_notes(values);
  if (values.trial_cycles < 4)
    notes.push_back(fmt::format(
        "morphological.trial_cycles = {}: a trial weight needs more than one step per cycle, which "
        "does not reach 250 MHz (docs/reference/morphological/hardware.md, Trials)",
        values.trial_cycles));
  return notes;
}

std::vector<Shorthand> smoothing_shorthands() {
  return {
      {"--preset", "morphological.preset",
       preset_help(spec::morphological::kPresetNames, spec::morphological::Configuration().preset)},
      {"--lanes", "morphological.lanes",
       "Pixels per cycle of the morphological engine: 1 (default), 2 or 4"},
      {"--storage", "morphological.storage",
       "Where the morphological engine stores delayed pixels: line_buffers (default) or memory"}};
}

}  // namespace deburr::tool
