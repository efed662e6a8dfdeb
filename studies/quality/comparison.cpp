// SPDX-License-Identifier: MIT
#include "studies/quality/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "golden/geometric/configuration.h"
#include "golden/morphological/configuration.h"
#include "golden/morphological/morphological_golden.h"
#include "spec/error.h"
#include "tb/base/forked.h"
#include "tb/engines/geometric/geometric_environment.h"
#include "tb/engines/geometric/geometric_stimuli.h"
#include "tb/engines/morphological/morphological_environment.h"
#include "tb/scene/compose.h"
#include "tb/scene/flip.h"
#include "tb/scene/label.h"
#include "tb/scene/quality.h"
#include "tb/scene/scenes.h"
#include "tb/scene/ssim.h"
#include "tb/stimuli/reference_filters.h"

namespace deburr::studies {

using tb::Image;

namespace {

using tb::geometric::Checker;
using tb::geometric::Frame;
using MorphologicalConfiguration = spec::morphological::Parameters;
using GeometricConfiguration = spec::geometric::Parameters;

constexpr int kWidth = 640, kHeight = 480, kSamples = 16;
constexpr int kLinePixels = 1920;
constexpr double kStreamBytes = 2 * spec::morphological::kFramePixelBytes;  // input and output
constexpr double kDepthBytes = 4;

struct Method {
  std::string name, label;
  std::optional<GeometricConfiguration> geometric;
  std::optional<MorphologicalConfiguration> morphological;
};

std::vector<Method> compared_methods() {
  namespace m = spec::morphological;
  namespace g = spec::geometric;
  std::vector<Method> all;
  const auto morphological = [](m::Preset preset) {
    MorphologicalConfiguration p = golden::morphological::preset_parameters(preset);
    p.line_pixels = kLinePixels;
    return p;
  };
  const auto add = [&](std::string name, std::string label, std::optional<g::Preset> edges,
                       std::optional<m::Preset> smoothing) {
    Method method{std::move(name), std::move(label), {}, {}};
    if (edges) method.geometric = golden::geometric::preset_parameters(*edges);
    if (smoothing) method.morphological = morphological(*smoothing);
    if (edges && smoothing) {
      method.geometric->mark = true;
      method.morphological = golden::morphological::following_geometric(*method.morphological);
    }
    all.push_back(std::move(method));
  };
  add("`mlaa`", "mlaa", {}, m::Preset::kMlaa);
  add("`mlaa-slope`", "mlaa-slope", {}, m::Preset::kMlaaSlope);
  add("`smaa`", "smaa", {}, m::Preset::kSmaa);
  add("`smaa-dynamic`", "smaa-dynamic", {}, m::Preset::kSmaaDynamic);
  add("`deburr-line`, morphological", "deburr line", {}, m::Preset::kDeburrLine);
  add("`deburr`, morphological", "deburr morph", {}, m::Preset::kDeburr);
  add("`gpaa`", "gpaa", g::Preset::kGpaa, {});
  add("`gpaa-optimised`", "gpaa-optimised", g::Preset::kGpaaOptimised, {});
  add("`deburr`, geometric", "deburr geo", g::Preset::kDeburr, {});
  add("geometric, then morphological", "deburr both", g::Preset::kDeburr,
      m::FollowingRules().preset);
  return all;
}

Image drawn(const Frame& frame, const GeometricConfiguration& configuration) {
  return tb::geometric::smoothed(frame, configuration).image;
}

Image smoothed(const Frame& frame, const Image& image,
               const MorphologicalConfiguration& configuration) {
  golden::morphological::MorphologicalGolden golden(
      configuration, golden::morphological::MorphologicalGolden::Detail::kPixels);
  Image result = image;
  result.pixels = golden.process({image.pixels, image.width, image.height},
                                 {frame.depths, image.width, image.height});
  return result;
}

Image picture_of(const Method& method, const Frame& frame) {
  Image image = method.geometric ? drawn(frame, *method.geometric) : frame.image;
  return method.morphological ? smoothed(frame, image, *method.morphological) : image;
}

// ---- costs --------------------------------------------------------------------------------------

// Runs the environment that `make` creates, in its own process.
template <class Make, class Measure>
ComparisonCost cost_of(Make make, Measure measure) {
  return tb::forked<ComparisonCost>([&] {
    tb::SimulationOptions options;
    options.check_links = false;
    tb::Simulation simulation(options);
    auto environment = make(simulation);
    simulation.elaborate(*environment);
    simulation.run();
    environment->check();
    tb::Result result;
    simulation.collect(result);
    ComparisonCost cost = measure(*environment);
    for (const tb::MemoryFigures& memory : result.memories) cost.bits += memory.physical_bits;
    return cost;
  });
}

ComparisonCost cost_of(const GeometricConfiguration& configuration, const Frame& frame) {
  return cost_of(
      [&](tb::Simulation& simulation) {
        tb::GeometricSetup setup;
        setup.geometric = configuration;
        return std::make_unique<tb::GeometricEnvironment>(simulation, std::span(&frame, 1), setup);
      },
      [](const tb::GeometricEnvironment& environment) {
        const rtl::geometric::GeometricEngine& engine = environment.engine();
        const std::uint64_t bytes =
            engine.memory_port.bytes_read.value() + engine.memory_port.bytes_written.value();
        return ComparisonCost{tb::number(engine.work().blended_pixels),
                              tb::number(engine.frame_sequencer.frame_cycles.value()),
                              tb::number(bytes) / (kWidth * kHeight), 0};
      });
}

ComparisonCost cost_of(const MorphologicalConfiguration& configuration,
                       const tb::MorphologicalInput& input) {
  const bool depth = configuration.edge_source == spec::morphological::EdgeSource::kDepth ||
                     configuration.edge_source == spec::morphological::EdgeSource::kPredicated;
  return cost_of(
      [&](tb::Simulation& simulation) {
        tb::MorphologicalSetup setup;
        setup.morphological = configuration;
        return std::make_unique<tb::MorphologicalEnvironment>(simulation, std::span(&input, 1),
                                                              setup);
      },
      [&](const tb::MorphologicalEnvironment& environment) {
        return ComparisonCost{tb::number(environment.engine().work().blended_pixels),
                              tb::number(environment.engine().sequencer.frame_cycles.value()),
                              kStreamBytes + (depth ? kDepthBytes : 0), 0};
      });
}

ComparisonCost cost_of(const Method& method, const Frame& frame) {
  ComparisonCost sum;
  const auto add = [&](const ComparisonCost& cost) {
    sum.blended += cost.blended;
    sum.cycles += cost.cycles;
    sum.bytes += cost.bytes;
    sum.bits += cost.bits;
  };
  if (method.geometric) add(cost_of(*method.geometric, frame));
  if (method.morphological) {
    tb::MorphologicalInput input{frame.image, frame.depths};
    if (method.geometric) input.image = drawn(frame, *method.geometric);
    add(cost_of(*method.morphological, input));
  }
  return sum;
}

// ---- tables -------------------------------------------------------------------------------------

// Groups digits in threes.
std::string grouped_digits(double value) {
  std::string digits = fmt::format("{}", std::llround(value));
  for (int i = static_cast<int>(digits.size()) - 3; i > 0; i -= 3)
    digits.insert(static_cast<std::size_t>(i), 1, ' ');
  return digits;
}

// A quality column.
struct Column {
  const char* title;
  double ComparisonRow::*value;
  int digits;
  bool least_is_best;
};
constexpr Column kColumns[] = {{"PSNR, dB", &ComparisonRow::psnr, 2, false},
                               {"edges, dB", &ComparisonRow::edges, 2, false},
                               {"silhouettes, dB", &ComparisonRow::silhouettes, 2, false},
                               {"FLIP", &ComparisonRow::flip, 4, true},
                               {"SSIM", &ComparisonRow::ssim, 4, false}};

bool is_reference(const ComparisonRow& row) { return !std::isfinite(row.psnr); }

// Empty for the reference.
std::string cell(const ComparisonRow& row, const Column& column) {
  return fmt::format("{:.{}f}", row.*column.value, column.digits);
}

// The best cell of a column.
std::string best(std::span<const ComparisonRow> rows, const Column& column) {
  const auto rank = [&](const ComparisonRow& row) {
    if (is_reference(row)) return -std::numeric_limits<double>::infinity();
    return row.*column.value * (column.least_is_best ? -1 : 1);
  };
  return cell(*std::max_element(rows.begin(), rows.end(),
                                [&](const ComparisonRow& a, const ComparisonRow& b) {
                                  return rank(a) < rank(b);
                                }),
              column);
}

}  // namespace

std::span<const std::string_view> comparison_scenes() {
  static constexpr std::array<std::string_view, 9> kScenes = {
      "cube", "sphere", "wheelcover", "wing", "canopy", "cylinders", "object", "road", "terrain"};
  return kScenes;
}

std::vector<ComparisonRow> compare_methods(const std::string& scene) {
  const Checker checker(tb::make_scene(scene), kWidth, kHeight, kSamples);
  std::vector<ComparisonRow> rows;
  std::vector<Image> images;
  const auto add = [&](const std::string& name, Image image) -> ComparisonRow& {
    ComparisonRow row;
    row.method = name;
    row.psnr = psnr(image, checker.reference);
    row.edges = checker.edge_psnr(image);
    row.silhouettes = checker.silhouette_psnr(image);
    images.push_back(std::move(image));
    rows.push_back(std::move(row));
    return rows.back();
  };
  add("none", checker.frame.image);
  add("MSAA 4x", checker.msaa);
  for (const tb::stimuli::ReferenceFilter& reference : tb::stimuli::kReferenceFilters)
    add(reference.name, reference.filter(checker.frame.image, true));
  for (const Method& method : compared_methods())
    add(method.name, picture_of(method, checker.frame)).cost = cost_of(method, checker.frame);
  add("supersampled, 256 samples", checker.reference);
  std::vector<const Image*> tests;
  tests.reserve(images.size());
  for (const Image& image : images) tests.push_back(&image);
  const std::vector<double> flips = tb::flip(checker.reference, tests),
                            similar = ssim(checker.reference, tests);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].flip = flips[i];
    rows[i].ssim = similar[i];
  }
  return rows;
}

std::string comparison_section(const std::string& name, std::span<const ComparisonRow> rows) {
  std::string text = fmt::format("### {}\n\n|", name), line = "|";
  for (const Column& column : kColumns) text += fmt::format(" | {}", column.title);
  text += fmt::format(" | blended pixels | cycles, M = {} | bytes per pixel | memory, bits |\n",
                      tb::GeometricSetup().memory.latency);
  for (std::size_t i = 0; i < std::size(kColumns) + 5; ++i) line += "---|";
  text += line + "\n";
  for (const ComparisonRow& row : rows) {
    if (is_reference(row)) continue;
    text += "| " + row.method;
    for (const Column& column : kColumns) {
      const std::string value = cell(row, column);
      text += value == best(rows, column) ? " | **" + value + "**" : " | " + value;
    }
    if (row.cost)
      text += fmt::format(" | {} | {} | {:.1f} | {} |\n", grouped_digits(row.cost->blended),
                          grouped_digits(row.cost->cycles), row.cost->bytes,
                          grouped_digits(static_cast<double>(row.cost->bits)));
    else
      text += " | - | - | - | - |\n";
  }
  return text + "\n";
}

std::vector<ComparisonRow> means_of(std::span<const std::vector<ComparisonRow>> scenes) {
  std::vector<ComparisonRow> means = scenes.front();
  const double n = static_cast<double>(scenes.size());
  for (std::size_t i = 0; i < means.size(); ++i) {
    ComparisonRow& mean = means[i];
    for (const auto& rows : scenes.subspan(1)) {
      for (const Column& column : kColumns) mean.*column.value += rows[i].*column.value;
      if (!mean.cost) continue;
      mean.cost->blended += rows[i].cost->blended;
      mean.cost->cycles += rows[i].cost->cycles;
      mean.cost->bytes += rows[i].cost->bytes;
      DEBURR_CHECK(mean.cost->bits == rows[i].cost->bits, "memory that depends on the scene");
    }
    for (const Column& column : kColumns) mean.*column.value /= n;
    if (!mean.cost) continue;
    mean.cost->blended /= n;
    mean.cost->cycles /= n;
    mean.cost->bytes /= n;
  }
  return means;
}

// ---- the picture --------------------------------------------------------------------------------

namespace {

struct Place {
  const char* scene;
  int x, y;  // crop corner
};
constexpr Place kPlaces[] = {{"object", 264, 116}, {"cylinders", 414, 136}};
constexpr int kCrop = 28, kZoom = 6, kAcross = 8, kGap = 8, kLetters = 2, kLeading = 4;

// The picture with lines of text over it.
Image captioned(const Image& picture, std::span<const std::string> lines) {
  constexpr tb::Rgba8 kPaper = {255, 255, 255, 255};
  std::vector<Image> labels;
  int top = 0;
  for (const std::string& line : lines) {
    labels.push_back(tb::label(line, kLetters));
    top += labels.back().height + kLeading;
  }
  Image result(picture.width, picture.height + top, kPaper);
  int y = 0;
  for (const Image& text : labels) {
    paste(result, crop(text, 0, 0, std::min(text.width, result.width), text.height), 0, y);
    y += text.height + kLeading;
  }
  paste(result, picture, 0, top);
  return result;
}

}  // namespace

Image comparison_sheet() {
  std::vector<Image> cells;
  for (const Place& place : kPlaces) {
    const Checker checker(tb::make_scene(place.scene), kWidth, kHeight, kSamples);
    const auto add = [&](const std::string& name, const Image& image) {
      const double edges = checker.edge_psnr(image);
      const std::string lines[] = {
          name, std::isfinite(edges) ? fmt::format("{:.1f} dB", edges) : "256 samples"};
      cells.push_back(captioned(zoom(crop(image, place.x, place.y, kCrop, kCrop), kZoom), lines));
    };
    add("none", checker.frame.image);
    add("MSAA 4x", checker.msaa);
    for (const tb::stimuli::ReferenceFilter& reference : tb::stimuli::kReferenceFilters)
      add(reference.name, reference.filter(checker.frame.image, true));
    for (const Method& method : compared_methods())
      add(method.label, picture_of(method, checker.frame));
    add("reference", checker.reference);
    // Pads to a full row.
    while (cells.size() % kAcross != 0)
      cells.emplace_back(cells.front().width, cells.front().height, tb::Rgba8{255, 255, 255, 255});
  }
  const Image inner = tb::sheet(cells, kAcross, kGap);
  Image result(inner.width + 2 * kGap, inner.height + 2 * kGap, {255, 255, 255, 255});
  paste(result, inner, kGap, kGap);
  return result;
}

}  // namespace deburr::studies
