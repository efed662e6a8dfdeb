// SPDX-License-Identifier: MIT
#include "tb/stimuli/line_fans.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "golden/ideal/coverage.h"
#include "golden/morphological/configuration.h"
#include "golden/morphological/morphological_golden.h"
#include "tb/base/random.h"
#include "tb/stimuli/frames.h"

namespace deburr::tb::stimuli {
namespace {

using golden::ideal::coverage;
using golden::ideal::HalfPlane;

constexpr int kSlopes = 20;
constexpr int kMarginSteps = 17;  // N = 16 and the run
constexpr int kCheckedColumns = 120;
constexpr int kMarginRows = 3;

struct Sum {
  double squares = 0;
  std::int64_t count = 0;
  void add(double e) {
    squares += e * e;
    ++count;
  }
  void add(const Sum& o) {
    squares += o.squares;
    count += o.count;
  }
  double rms() const {
    return count == 0 ? 0 : 1000 * std::sqrt(squares / static_cast<double>(count));
  }
};

struct Sums {
  std::array<Sum, kSlopes + 1> pixels;  // by n
  Sum columns, jumps;                   // n >= 2
};

bool in_class(std::size_t slope_class, int n) {
  constexpr std::array<int, kSlopeClasses.size()> kFirst = {1, 2, 3, 6, 11, 2};
  constexpr std::array<int, kSlopeClasses.size()> kLast = {1, 2, 5, 10, 20, 20};
  return n >= kFirst[slope_class] && n <= kLast[slope_class];
}

void measure_line(const Smoothing& smoothing, int n, double slope, double phase, bool transpose,
                  Sums& sums) {
  const int margin = kMarginSteps * (n + 1) + 1;
  const int width = kCheckedColumns + 2 * margin;
  const int height = static_cast<int>(width * std::abs(slope)) + 2 * kMarginRows + 2;
  const double start = slope > 0 ? kMarginRows : height - kMarginRows;
  const HalfPlane above{slope, -1, start + (slope > 0 ? phase : -phase)};
  const Image sampled = draw(
      width, height, [&](int x, int y) { return grey(above.at(x + 0.5, y + 0.5) > 0 ? 255 : 0); });
  const Image result = transpose ? transposed(smoothing(transposed(sampled))) : smoothing(sampled);

  double previous = 0;
  for (int x = margin; x < width - margin; ++x) {
    double column = 0;
    for (int y = 0; y < height; ++y) {
      const double reference = coverage(above, x, y);
      const double error = result.at(x, y)[0] / 255.0 - reference;
      column += error;
      if (reference > 0 && reference < 1) sums.pixels[static_cast<std::size_t>(n)].add(error);
    }
    if (n >= 2) {
      sums.columns.add(column);
      if (x > margin) sums.jumps.add(column - previous);
    }
    previous = column;
  }
}

}  // namespace

FanFigures measure_fans(const Smoothing& smoothing, const FanOptions& options) {
  Sums sums;
  for (int seed = 1; seed <= options.seeds; ++seed) {
    Random random(Random::kStride * static_cast<std::uint64_t>(seed) + 1);
    for (int n = 1; n <= kSlopes; ++n) {
      for (int i = 0; i < options.lines; ++i) {
        // Stratified: one line in each of `lines` equal parts of the interval, which lowers noise.
        const double part = (i + random.uniform(0, 1)) / options.lines;
        const double slope = 1 / (n + options.u_low + part * (options.u_high - options.u_low));
        const double phase = random.uniform(0, 1);
        measure_line(smoothing, n, i % 2 == 0 ? slope : -slope, phase, options.transposed, sums);
      }
    }
  }
  FanFigures figures;
  for (std::size_t c = 0; c < kSlopeClasses.size(); ++c) {
    Sum sum;
    for (int n = 1; n <= kSlopes; ++n) {
      if (in_class(c, n)) sum.add(sums.pixels[static_cast<std::size_t>(n)]);
    }
    figures.by_class[c] = sum.rms();
  }
  figures.undulation = sums.columns.rms();
  figures.jump = sums.jumps.rms();
  return figures;
}

std::vector<FanRow> fan_rows() {
  using golden::morphological::preset_parameters;
  std::vector<FanRow> rows;
  const auto add = [&](std::string name, spec::morphological::Preset preset, int steps) {
    FanRow row{std::move(name), true, preset_parameters(preset)};
    row.parameters.steps = steps;
    row.parameters.linear_light = false;
    rows.push_back(row);
  };
  add("none", spec::morphological::Preset::kMlaa, 0);
  rows.back().smoothed = false;
  add("mlaa", spec::morphological::Preset::kMlaa, 0);
  for (const int n : {1, 2, 4, 8}) {
    add(fmt::format("chord N = {}", n), spec::morphological::Preset::kMlaaSlope, n);
  }
  for (const int n : {2, 4}) {
    add(fmt::format("fit N = {}", n), spec::morphological::Preset::kDeburrLine, n);
  }
  add("deburr-line", spec::morphological::Preset::kDeburrLine, 8);
  add("deburr", spec::morphological::Preset::kDeburr, 8);
  add("fit N = 16", spec::morphological::Preset::kDeburrLine, 16);
  return rows;
}

std::vector<FanRow> rule_rows() {
  using golden::morphological::preset_parameters;
  using P = spec::morphological::Parameters;
  const P line = preset_parameters(spec::morphological::Preset::kDeburrLine);
  std::vector<FanRow> rows;
  const auto add = [&](const char* name, const P& p) { rows.push_back({name, true, p}); };
  P p = preset_parameters(spec::morphological::Preset::kMlaa);
  add("mlaa", p);
  p = preset_parameters(spec::morphological::Preset::kMlaaSlope);
  add("mlaa-slope", p);
  p.predictor = spec::morphological::Predictor::kFit;
  add("fit instead of the chord", p);
  p.contiguous = true;
  add("+ contiguous", p);
  p.safe = true;
  add("+ safe", p);
  p.steps = line.steps;
  add("+ N = 8", p);
  p.trim = true;
  add("+ trim", p);
  p.local_contrast = line.local_contrast;
  add("+ symmetric contrast", p);
  p.threshold = line.threshold;
  add("+ T = 0.03 = deburr-line", p);
  const P deburr = preset_parameters(spec::morphological::Preset::kDeburr);
  p.edge_source = deburr.edge_source;
  p.threshold = deburr.threshold;
  add("+ edges of colour", p);
  add("+ learned weights = deburr", deburr);
  for (const auto preset :
       {spec::morphological::Preset::kMlaa, spec::morphological::Preset::kMlaaSlope}) {
    p = preset_parameters(preset);
    p.threshold = line.threshold;
    p.local_contrast = line.local_contrast;
    add(preset == spec::morphological::Preset::kMlaa ? "mlaa, deburr-line's edges"
                                                     : "mlaa-slope, deburr-line's edges",
        p);
  }
  p = line;
  p.steps = spec::morphological::kMaxSteps;
  add("deburr-line, N = 16", p);
  return rows;
}

Smoothing smoothing_of(const FanRow& row) {
  if (!row.smoothed) return [](const Image& image) { return image; };
  return [parameters = row.parameters](const Image& image) {
    using golden::morphological::MorphologicalGolden;
    MorphologicalGolden golden(parameters, MorphologicalGolden::Detail::kPixels);
    Image result(image.width, image.height);
    result.pixels = golden.process({image.pixels, image.width, image.height});
    return result;
  };
}

const std::vector<FanLimit>& contract_figures() {
  // Classes 1, 2, 3-5, 6-10, 11-20, 2-20; undulation; jump.
  static const std::vector<FanLimit> rows = {
      {"none", {{227, 245, 261, 273, 280, 273}, 0, 0}},
      {"mlaa", {{105, 75, 48, 26, 15, 31}, 31.9, 16.5}},
      {"chord N = 4", {{100, 59, 43, 23, 13, 26}, 24, 23}},
      {"fit N = 4", {{55, 21, 20, 9, 6, 11.5}, 10.8, 3.7}},
  };
  return rows;
}

const FanLimit& asked_of_ours() { return contract_figures().back(); }

std::vector<std::string> exceeded(const FanLimit& limit, const FanFigures& figures, double slack) {
  std::vector<std::string> names;
  const auto check = [&](std::string name, double asked, double got) {
    if (asked > 0 && got > asked * (1 + slack)) names.push_back(std::move(name));
  };
  for (std::size_t c = 0; c < kSlopeClasses.size(); ++c) {
    check(fmt::format("n = {}", kSlopeClasses[c]), limit.figures.by_class[c], figures.by_class[c]);
  }
  check("undulation", limit.figures.undulation, figures.undulation);
  check("jump", limit.figures.jump, figures.jump);
  return names;
}

std::string to_text(std::string_view name, const FanFigures& figures) {
  std::string line = fmt::format("{:<14}", name);
  for (const double figure : figures.by_class) line += fmt::format("{:>8.1f}", figure);
  return line + fmt::format("{:>12.1f}{:>8.1f}", figures.undulation, figures.jump);
}

}  // namespace deburr::tb::stimuli
