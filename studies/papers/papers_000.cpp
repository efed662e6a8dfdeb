// SPDX-License-Identifier: MIT
// Paper 000 (and 001, a second scan of it): Zhong and Wang, Slope-based straight line predicting
// morphological antialiasing technique, 2012.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "golden/morphological/configuration.h"
#include "golden/morphological/morphological_golden.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"
#include "studies/papers/papers.h"
#include "studies/training/training_frames.h"
#include "tb/base/random.h"
#include "tb/run/progress.h"
#include "tb/scene/compose.h"
#include "tb/scene/quality.h"
#include "tb/scene/reference.h"
#include "tb/scene/scenes.h"
#include "tb/stimuli/discs.h"
#include "tb/stimuli/line_fans.h"

namespace deburr::studies::paper_000 {

using tb::Image;
using tb::Mask;
using tb::Random;

namespace {

using golden::morphological::MorphologicalGolden;
using golden::morphological::preset_parameters;
using spec::morphological::Parameters;
using spec::morphological::Preset;
using tb::stimuli::FanFigures;
using tb::stimuli::FanOptions;
using tb::stimuli::FanRow;

constexpr int kPaperLoops = 4;        // "all results use 4"
constexpr int kReferenceSamples = 8;  // per pixel, in each direction

double ratio(double a, double b) { return b > 0 ? a / b : 0; }

// ---- digital lines, as positions of their steps -------------------------------------------------

// Step i of the line y = slope x + phase, sampled at pixel centres: the first pixel of row i.
struct DigitalLine {
  double slope;
  std::vector<int> steps;
};

DigitalLine digital_line(double slope, double phase, int count) {
  DigitalLine line{slope, {}};
  for (int i = 1; i <= count; ++i)
    line.steps.push_back(static_cast<int>(std::ceil((i - phase) / slope - 0.5)));
  return line;
}

// Slopes below 1 only: the steps are at least a pixel long.
DigitalLine random_line(Random& random, int count) {
  const double phase = random.uniform(0, 1);
  return digital_line(1 / random.uniform(1, 40), phase, count);
}

// ---- Theorem 1 ----------------------------------------------------------------------------------

PaperTable theorem(const PaperOptions& options) {
  constexpr int kSteps = 60;
  const int lines = options.quick ? 400 : 4000;
  Random random(1);
  std::int64_t runs = 0, pairs = 0, violations = 0, outside = 0, neighbours = 0;
  std::int64_t obeying = 0, impossible = 0;
  for (int i = 0; i < lines; ++i) {
    const DigitalLine line = random_line(random, kSteps);
    int shortest = 1 << 20, longest = 0;
    std::vector<int> lengths;
    for (std::size_t k = 0; k + 1 < line.steps.size(); ++k) {
      const int length = line.steps[k + 1] - line.steps[k];
      lengths.push_back(length);
      shortest = std::min(shortest, length);
      longest = std::max(longest, length);
      // 1 / (L + 1) < k < 1 / (L - 1), for slopes other than 1 / n.
      if (!(line.slope * (length + 1) > 1 && line.slope * (length - 1) < 1)) ++outside;
    }
    runs += static_cast<std::int64_t>(lengths.size());
    ++pairs;
    violations += longest - shortest > 1;
    // In a digital line the rarer of the two lengths never occurs twice in a row.
    const auto rare = 2 * std::count(lengths.begin(), lengths.end(), longest) <
                              static_cast<std::ptrdiff_t>(lengths.size())
                          ? longest
                          : shortest;
    if (longest != shortest)
      for (std::size_t k = 0; k + 1 < lengths.size(); ++k)
        neighbours += lengths[k] == rare && lengths[k + 1] == rare;
    // Random lengths of L and L + 1 satisfy the theorem, but most of them are not digital lines.
    bool twice[2] = {false, false};
    int last = -1;
    for (int k = 0; k < 12; ++k) {
      const int length = random.chance(500) ? 1 : 0;
      if (length == last) twice[length] = true;
      last = length;
    }
    ++obeying;
    impossible += twice[0] && twice[1];
  }
  PaperTable table{"Theorem 1: the step lengths of a digital line differ by at most 1",
                   "Complete runs of random digital lines of slopes 1 to 1/40. The printed proof "
                   "does not hold; from "
                   "L2 >= L1 + 2 follows k < 1/(L2 - 1) <= 1/(L1 + 1) < k, a contradiction.",
                   {"item", "paper", "ours", "verdict"},
                   {}};
  table.rows = {
      {fmt::format("lines whose step lengths differ by more than 1, of {} ({} runs)", pairs, runs),
       "0", fmt::format("{}", violations), claim(violations)},
      {"runs with a slope outside 1/(L+1) .. 1/(L-1)", "0", fmt::format("{}", outside),
       claim(outside)},
      {"two adjacent steps of the rarer length", "not said", fmt::format("{}", neighbours),
       claim(neighbours, "never", "happens")},
      {"random sequences of L and L + 1 that obey the theorem but are not a line, %", "not said",
       decimals(100 * ratio(static_cast<double>(impossible), static_cast<double>(obeying)), 1),
       claim(impossible, "sufficient", "insufficient")}};
  return table;
}

// ---- the pseudo-code ----------------------------------------------------------------------------

struct Search {
  int end = 0;      // where it stops
  int steps = 0;    // extensions taken
  int tests = 0;    // end points tested, in sequence
  int fetches = 0;  // texture samples: one returns two neighbouring pixels
  bool on_corner = true;
};

// Extends the run between steps `at` and `at + 1` to the right. `literal`: the third branch as
// printed, x = x + 1.
Search search(const DigitalLine& line, std::size_t at, int loops, bool literal) {
  const int length = line.steps[at + 1] - line.steps[at];
  Search s;
  int other = 0;  // L'
  s.end = line.steps[at + 1];
  for (int i = 0; i < loops; ++i) {
    const int corner = line.steps[at + 2 + static_cast<std::size_t>(i)];
    const auto hits = [&](int step) {
      ++s.tests;
      return step > 0 && s.end + step == corner;
    };
    ++s.fetches;
    if (hits(length)) {
      s.end += length;
    } else if (other != 0) {
      if (!hits(other)) return s;
      s.end += other;
    } else if (hits(length - 1)) {
      other = length - 1;
      s.end += other;
    } else {
      ++s.fetches;
      if (!hits(length + 1)) return s;
      other = length + 1;
      s.end += literal ? 1 : other;
      s.on_corner = !literal;
    }
    ++s.steps;
  }
  return s;
}

PaperTable third_branch(const PaperOptions& options) {
  PaperTable table{"Pseudo-code: the third branch",
                   "Printed: x = x + 1, L' = L + 1. Right: x = x + L + 1. Runs of random digital "
                   "lines, N = 4, the right "
                   "side; the slope is that of the chord from the run's start.",
                   {"third branch", "sides", "take it, %", "end next to a corner, %", "steps taken",
                    "slope error, RMS %", "verdict"},
                   {}};
  const int lines = options.quick ? 2000 : 20000;
  std::array<double, 2> errors{};
  for (const bool literal : {false, true}) {
    Random random(2);
    std::int64_t sides = 0, taken = 0, beside = 0, steps = 0;
    double squares = 0;
    for (int i = 0; i < lines; ++i) {
      const DigitalLine line = random_line(random, 24);
      for (const std::size_t at : {2u, 5u, 9u}) {
        const int length = line.steps[at + 1] - line.steps[at];
        const Search s = search(line, at, kPaperLoops, literal);
        const Search right = search(line, at, kPaperLoops, false);
        ++sides;
        for (int k = 0; k < right.steps; ++k)
          if (line.steps[at + 2 + static_cast<std::size_t>(k)] -
                  line.steps[at + 1 + static_cast<std::size_t>(k)] ==
              length + 1) {
            ++taken;
            break;
          }
        beside += !s.on_corner;
        steps += s.steps;
        const double slope = (1.0 + s.steps) / std::max(1, s.end - line.steps[at]);
        squares += (slope / line.slope - 1) * (slope / line.slope - 1);
      }
    }
    const auto n = static_cast<double>(sides);
    const double error = 100 * std::sqrt(squares / n);
    errors[literal ? 1 : 0] = error;
    table.rows.push_back(
        {literal ? "as printed" : "corrected", fmt::format("{}", sides),
         decimals(100 * static_cast<double>(taken) / n, 1),
         decimals(100 * static_cast<double>(beside) / n, 1),
         decimals(static_cast<double>(steps) / n, 2), decimals(error, 2),
         literal ? at_most(errors[1], errors[0], "harmless", "misprint") : claim(beside)});
  }
  return table;
}

PaperTable complexity(const PaperOptions& options) {
  PaperTable table{"Complexity: at most N + 2 samples per side, against L N / 2 of a walk",
                   "A sample shows two neighbouring pixels. Sides of runs of random digital lines.",
                   {"N", "L", "sides", "N + 2", "samples, mean", "samples, most",
                    "sequential tests, maximum", "walk, mean", "verdict"},
                   {}};
  constexpr std::array<std::pair<int, int>, 5> kClasses = {
      {{1, 2}, {3, 5}, {6, 10}, {11, 20}, {21, 40}}};
  const int lines = options.quick ? 2000 : 20000;
  for (const int loops : {1, 2, 4, 8}) {
    struct Sums {
      std::int64_t sides = 0, fetches = 0;
      int most = 0, tests = 0;
      double walk = 0;
    };
    std::array<Sums, kClasses.size()> sums{};
    Random random(3);
    for (int i = 0; i < lines; ++i) {
      const DigitalLine line = random_line(random, 24);
      const int length = line.steps[4] - line.steps[3];
      const Search s = search(line, 3, loops, false);
      for (std::size_t c = 0; c < kClasses.size(); ++c) {
        if (length < kClasses[c].first || length > kClasses[c].second) continue;
        Sums& sum = sums[c];
        ++sum.sides;
        sum.fetches += s.fetches;
        sum.most = std::max(sum.most, s.fetches);
        sum.tests = std::max(sum.tests, s.tests);
        sum.walk += 0.5 * (s.end - line.steps[4]);
      }
    }
    for (std::size_t c = 0; c < kClasses.size(); ++c) {
      const Sums& sum = sums[c];
      if (sum.sides == 0) continue;
      const auto n = static_cast<double>(sum.sides);
      table.rows.push_back(
          {fmt::format("{}", loops), fmt::format("{}-{}", kClasses[c].first, kClasses[c].second),
           fmt::format("{}", sum.sides), fmt::format("{}", loops + 2),
           decimals(static_cast<double>(sum.fetches) / n, 2), fmt::format("{}", sum.most),
           fmt::format("{}", sum.tests), decimals(sum.walk / n, 2), at_most(sum.most, loops + 2)});
    }
  }
  return table;
}

PaperTable probes(const PaperOptions& options) {
  PaperTable table{
      "Complexity: corners that the engine tests, for each pixel of the line",
      "Lines of slope 1/(L + u) through the whole engine, preset mlaa-slope; all runs that are "
      "extended by N steps on both sides. A walk from a pixel to both ends of its extended line "
      "visits the corners between them one by one; the engine finds runs once, and tests at most "
      "three corners per step.",
      {"N", "L", "line pixels", "engine, per pixel", "walk, per pixel", "walk / engine", "verdict"},
      {}};
  Random random(4);
  const int lines = options.quick ? 2 : 12;
  tb::Waiting waiting("paper 000: lines through the engine", options.quiet);
  for (const int loops : {1, 2, 4, 8})
    for (const int length : {1, 2, 4, 8, 16}) {
      Parameters p = preset_parameters(Preset::kMlaaSlope);
      p.steps = loops;
      p.search_columns = 2048;
      double pixels = 0, tested = 0, walked = 0;
      for (int i = 0; i < lines; ++i) {
        const double slope = 1 / (length + random.uniform(0, 1)), phase = random.uniform(0, 1);
        const int width = (3 * loops + 20) * (length + 1);
        Image frame(width, static_cast<int>(width * slope) + 8);
        for (int y = 0; y < frame.height; ++y)
          for (int x = 0; x < width; ++x) {
            const std::uint8_t v = y + 0.5 < 3 + phase + slope * (x + 0.5) ? 255 : 0;
            frame.at(x, y) = {v, v, v, 255};
          }
        MorphologicalGolden golden(p);
        golden.process({frame.pixels, frame.width, frame.height});
        waiting.update();
        for (const auto& run : golden.runs()) {
          const spec::morphological::LineDescriptor& line = run.line;
          if (line.run.axis != spec::morphological::Axis::kHorizontal || line.left_steps != loops ||
              line.right_steps != loops)
            continue;
          pixels += line.run.length;
          tested += run.probes;
          walked += static_cast<double>(line.run.length * line.span);
        }
      }
      table.rows.push_back({fmt::format("{}", loops), fmt::format("{}", length),
                            decimals(pixels, 0), decimals(ratio(tested, pixels), 2),
                            decimals(ratio(walked, pixels), 1), decimals(ratio(walked, tested), 1),
                            below(tested, walked, "fewer", "more")});
    }
  return table;
}

// ---- quality on straight lines ------------------------------------------------------------------

std::vector<FanRow> quality_rows() {
  std::vector<FanRow> rows = tb::stimuli::fan_rows();
  FanRow none_taken = rows[2];  // chord N = 1
  none_taken.name = "chord N = 0";
  none_taken.parameters.steps = 0;
  rows.insert(rows.begin() + 2, none_taken);
  return rows;
}

// Without `digits`, values are printed as given.
std::vector<std::string> cells_of(std::string name, const FanFigures& figures,
                                  std::optional<int> digits = {}) {
  std::vector<std::string> cells = {std::move(name)};
  const auto add = [&](double f) {
    cells.push_back(f <= 0 ? "-" : digits ? decimals(f, *digits) : fmt::format("{:g}", f));
  };
  for (const double f : figures.by_class) add(f);
  add(figures.undulation);
  add(figures.jump);
  return cells;
}

// "kept", or the names of the figures that exceed the contract.
std::string contract_text(const std::vector<std::string>& above) {
  std::string text = above.empty() ? "kept" : "above:";
  for (const std::string& name : above) text += " " + name + (name == above.back() ? "" : ",");
  return text;
}

PaperTable quality(const PaperOptions& options, double low, double high) {
  FanOptions fan;
  fan.u_low = low;
  fan.u_high = high;
  if (options.quick) fan.lines = 8, fan.seeds = 1;
  PaperTable table{
      fmt::format("RMSE × 1000 to analytic coverage, slopes 1/(n + u), u in [{}, {}]", low, high),
      fmt::format(
          "{} lines for each n and seed, {} seeds. The paper gives no numbers: it shows less "
          "undulation than MLAA (undulation: RMS of a column's error; jump: RMS of its change from "
          "column to column; n = 2..20). Chord is the paper's line, fit is ours. Against MLAA: "
          "smoother means less undulation, steadier less jump. Rows in brackets are required "
          "values, found by another program on other lines: ours must not exceed its line fit. "
          "Verdicts: mlaa, whether it has less undulation than no anti-aliasing; a chord without "
          "steps, whether it equals mlaa; the other chords and two steps per side, whether they "
          "have less undulation than mlaa; the others, whether the required values are met.",
          fan.lines, fan.seeds),
      {"line"},
      {}};
  for (const std::string_view name : tb::stimuli::kSlopeClasses)
    table.columns.push_back(fmt::format("n = {}", name));
  for (const char* name : {"undulation", "jump", "against mlaa", "contract", "verdict"})
    table.columns.emplace_back(name);
  const std::vector<FanRow> rows = quality_rows();
  FanFigures none, mlaa;
  tb::Progress progress("paper 000", rows.size(), "row", options.quiet);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    options.go_on();
    const FanFigures figures = measure_fans(tb::stimuli::smoothing_of(rows[r]), fan);
    if (rows[r].name == "none") none = figures;
    if (rows[r].name == "mlaa") mlaa = figures;
    const bool chord = rows[r].name.starts_with("chord") && rows[r].parameters.steps > 0;
    const bool ours = rows[r].name.starts_with("fit") || rows[r].name.starts_with("deburr");
    // The contract's row assumes at least four steps per side.
    const bool checked = ours && rows[r].parameters.steps >= 4;
    const std::vector<std::string> above = exceeded(tb::stimuli::asked_of_ours(), figures);
    std::vector<std::string> cells = cells_of(rows[r].name, figures, 1);
    cells.push_back(!chord && !ours
                        ? "-"
                        : fmt::format("{}, {}",
                                      figures.undulation < mlaa.undulation ? "smoother" : "rougher",
                                      figures.jump < mlaa.jump ? "steadier" : "less steady"));
    cells.push_back(checked ? contract_text(above) : "-");
    if (checked)
      cells.push_back(claim(std::ssize(above), "right", "worse"));
    else if (chord || ours)
      cells.push_back(below(figures.undulation, mlaa.undulation));
    else if (rows[r].name == "chord N = 0")
      cells.push_back(verdict(mlaa.undulation, 9, figures.undulation, "wrong"));
    else if (rows[r].name == "mlaa")
      cells.push_back(below(figures.undulation, none.undulation));
    else
      cells.emplace_back("-");
    table.rows.push_back(cells);
    for (const tb::stimuli::FanLimit& limit : tb::stimuli::contract_figures()) {
      if (limit.name != rows[r].name) continue;
      cells = cells_of(fmt::format("({})", limit.name), limit.figures);
      cells.insert(cells.end(), {"-", "-", "-"});
      table.rows.push_back(cells);
    }
    progress.update(r + 1);
  }
  return table;
}

// ---- rendered frames ----------------------------------------------------------------------------

Image smoothed(const Image& frame, const Parameters& parameters) {
  MorphologicalGolden golden(parameters, MorphologicalGolden::Detail::kPixels);
  Image out(frame.width, frame.height);
  out.pixels = golden.process({frame.pixels, frame.width, frame.height});
  return out;
}

struct Method {
  std::string name, caption;
  Image image;
};

std::vector<Method> methods(const tb::Scene& scene, const Image& noaa, bool with_msaa) {
  std::vector<Method> all = {{"none", "no anti-aliasing", noaa}};
  if (with_msaa)
    all.push_back({"MSAA 4x", "four samples on the rotated grid",
                   tb::render_msaa4(scene, noaa.width, noaa.height)});
  all.push_back({"mlaa", "run ends", smoothed(noaa, preset_parameters(Preset::kMlaa))});
  all.push_back(
      {"mlaa-slope", "the paper, N = 4", smoothed(noaa, preset_parameters(Preset::kMlaaSlope))});
  all.push_back(
      {"deburr-line", "line fit, N = 8", smoothed(noaa, preset_parameters(Preset::kDeburrLine))});
  all.push_back(
      {"deburr", "line fit, learned weights", smoothed(noaa, preset_parameters(Preset::kDeburr))});
  return all;
}

Mask crop_mask(const Mask& mask, int x0, int y0, int size) {
  Mask out(size, size);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) out.at(x, y) = mask.at(x0 + x, y0 + y);
  return out;
}

// Allowed positions of a window's corner.
struct Region {
  int left, right, top, bottom;  // pixels; right and bottom excluded
};

// The corner of the window of this size that contains the most pixels of the mask.
std::pair<int, int> busiest(const Mask& mask, int size, const Region& region) {
  std::pair<int, int> best{region.left, region.top};
  std::int64_t most = -1;
  const int step = std::max(1, size / 8);
  for (int y = region.top; y < region.bottom && y + size <= mask.height; y += step)
    for (int x = region.left; x < region.right && x + size <= mask.width; x += step) {
      std::int64_t sum = 0;
      for (int j = 0; j < size; ++j)
        for (int i = 0; i < size; ++i) sum += mask.at(x + i, y + j);
      if (sum > most) most = sum, best = {x, y};
    }
  return best;
}

// One sheet of zoomed crops. Columns: methods. Rows: the whole picture, then for each of `strips`
// vertical strips the window with the most silhouettes (within `rows` of the height), at 4 x with
// an inset at 8 x.
Image zooms(const std::vector<Method>& list, const Mask& silhouettes, int strips,
            std::pair<double, double> rows) {
  constexpr int kSide = 192;
  const int width = silhouettes.width, height = silhouettes.height;
  const int wide = std::min({kSide, width, height});
  std::vector<Image> cells;
  const auto add_row = [&](std::pair<int, int> corner, int size) {
    for (const Method& m : list)
      cells.push_back(zoom(crop(m.image, corner.first, corner.second, size, size), wide / size));
  };
  add_row(busiest(silhouettes, wide, {0, width, 0, height}), wide);
  for (int strip = 0; strip < strips; ++strip) {
    const auto [x, y] =
        busiest(silhouettes, wide / 4,
                {strip * width / strips, (strip + 1) * width / strips - wide / 4 + 1,
                 static_cast<int>(rows.first * height), static_cast<int>(rows.second * height)});
    add_row({x, y}, wide / 4);
    const auto [dx, dy] =
        busiest(crop_mask(silhouettes, x, y, wide / 4), wide / 8, {0, wide, 0, wide});
    add_row({x + dx, y + dy}, wide / 8);
  }
  return tb::sheet(cells, static_cast<int>(list.size()));
}

// Rendered scenes whose edges are mostly geometry.
std::vector<tb::LitFrames> frames_of_configuration(const PaperOptions& options) {
  std::vector<tb::LitFrames> frames;
  tb::Waiting waiting("paper 000: rendering scenes and reference", options.quiet);
  for (const char* scene : {"cylinders", "object", "road"})
    frames.push_back(tb::render_lit_frames(tb::make_scene(scene), options.size, options.size,
                                           options.quick ? 4 : 8, options.watching(waiting)));
  return frames;
}

// The row that this row is compared with: the previous one, or the one that it names ("mlaa,
// deburr's edges"); none for a preset itself.
std::optional<std::size_t> made_of(const std::vector<FanRow>& rows, std::size_t row) {
  const std::string& name = rows[row].name;
  const std::size_t comma = name.find(',');
  for (std::size_t i = 0; comma != std::string::npos && i < row; ++i)
    if (rows[i].name == name.substr(0, comma) ||
        rows[i].name.ends_with("= " + name.substr(0, comma)))
      return i;
  if (row == 0) return {};
  return row - 1;
}

// The gain of each configuration step of deburr.
PaperTable configuration(const PaperOptions& options) {
  PaperTable table{
      "The options of preset deburr, added one by one",
      "RMSE × 1000 to exact coverage on straight lines (n = 2..20, u in [0.05, 0.95]) and on "
      "discs, by radius in pixels; PSNR in dB, mean over the scenes cylinders, object and road, on "
      "edges and on silhouettes. Most extensions on a curve are wrong: contiguous and safe reject "
      "them, trim undoes those already made at a bend. These scenes have strong edges only; "
      "contrast and threshold pay on frames with weak ones. Learned weights were trained on these "
      "scenes (docs/measurements/morphological_quality.md has frames that were not). The verdict: "
      "the gain of a row over the row above, or over the row that it names, in the figures shown "
      "here.",
      {"rules", "lines", "discs 8-32", "discs 64-256", "edges", "silhouettes", "verdict"},
      {}};
  FanOptions fan;
  if (options.quick) fan.lines = 8;
  fan.seeds = 1;
  const std::vector<tb::LitFrames> frames = frames_of_configuration(options);
  std::vector<FanRow> rows = tb::stimuli::rule_rows();
  std::vector<Figures> figures;
  tb::Progress progress("paper 000", rows.size(), "row", options.quiet);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    options.go_on();
    double edges = 0, silhouettes = 0;
    for (const tb::LitFrames& lit : frames) {
      const Mask edge = tb::edge_mask(lit.reference, lit.noaa);
      const Image image = smoothed(lit.noaa, rows[r].parameters);
      edges += psnr(image, lit.reference, edge) / static_cast<double>(frames.size());
      silhouettes += psnr(image, lit.reference, tb::silhouette_mask(edge, lit.depth)) /
                     static_cast<double>(frames.size());
    }
    rows[r].parameters.linear_light = false;  // coverage is measured in codes
    const tb::stimuli::Smoothing smoothing = tb::stimuli::smoothing_of(rows[r]);
    const tb::stimuli::DiscFigures discs =
        tb::stimuli::measure_discs(smoothing, {.pixels = options.quick ? 1000 : 4000, .seeds = 1});
    const auto mean = [&](std::size_t from, std::size_t to) {
      double sum = 0;
      for (std::size_t i = from; i <= to; ++i) sum += discs.by_radius[i] * discs.by_radius[i];
      return std::sqrt(sum / static_cast<double>(to - from + 1));
    };
    figures.push_back({{measure_fans(smoothing, fan).by_class.back(), mean(0, 2), mean(3, 5)},
                       {edges, silhouettes}});
    std::vector<std::string> cells = {rows[r].name};
    for (const double error : figures.back().errors) cells.push_back(decimals(error, 1));
    for (const double quality : figures.back().qualities) cells.push_back(decimals(quality, 2));
    const std::optional<std::size_t> before = made_of(rows, r);
    cells.push_back(before ? brings(figures[*before], figures[r], 1, 2) : "-");
    table.rows.push_back(std::move(cells));
    progress.update(r + 1);
  }
  return table;
}

// The verdict of one method among those of a scene.
std::string scene_verdict(const std::vector<Method>& list, const std::vector<Scores>& scores,
                          std::size_t which) {
  if (list[which].name.starts_with("deburr")) return place(scores, which);
  const auto better_than = [&](std::string_view other) {
    const auto found = std::find_if(list.begin(), list.end(),
                                    [&](const Method& method) { return method.name == other; });
    return beats(scores[which], scores[static_cast<std::size_t>(found - list.begin())]) ? "better"
                                                                                        : "worse";
  };
  if (list[which].name == "none") return "-";
  return better_than(list[which].name == "mlaa-slope" ? "mlaa" : "none");
}

struct Compared {
  PaperTable table;
  std::vector<PaperFigure> figures;
};

Compared rendered_scenes(const PaperOptions& options) {
  Compared compared;
  PaperTable& table = compared.table;
  table = {"Rendered frames against supersampled reference, PSNR in dB",
           "Edge pixels: reference and frame differ by more than 2/255; silhouettes: with a depth "
           "step of 5 % to a neighbour. Verdicts: MSAA 4x and mlaa, whether they are better than "
           "none on both; mlaa-slope, whether it is better than mlaa; deburr-line and deburr, "
           "their ranks among all six, where the best is better than all others on both. The edges "
           "of tunnel and plane are texture: smoothing them gains little or loses.",
           {"scene", "method", "frame", "edges", "silhouettes", "verdict"},
           {}};
  struct Shown {
    const char* scene;
    const char* title;  // none: no pictures
    int strips = 0;     // vertical strips of the zoom sheet
    std::pair<double, double> rows = {0, 1};
  };
  constexpr std::array<Shown, 6> kScenes = {
      {{"cylinders", "Figures 6 and 7: five cylinders of different slopes", 5, {0.4, 0.5}},
       {"object", "Figure 8: an object", 2},
       {"road", "Figure 9: a wide scene", 2},
       {"quad", nullptr},
       {"tunnel", nullptr},
       {"plane", nullptr}}};
  tb::Waiting waiting("paper 000: rendering scenes and reference, and smoothing", options.quiet);
  for (const Shown& shown : kScenes) {
    const tb::Scene scene = tb::make_scene(shown.scene);
    const tb::LitFrames lit = tb::render_lit_frames(scene, options.size, options.size,
                                                    kReferenceSamples, options.watching(waiting));
    const Mask edges = tb::edge_mask(lit.reference, lit.noaa);
    const Mask silhouettes = tb::silhouette_mask(edges, lit.depth);
    const std::vector<Method> list = methods(scene, lit.noaa, true);
    std::vector<Scores> scores;
    for (const Method& m : list) {
      scores.push_back(
          {psnr(m.image, lit.reference, edges), psnr(m.image, lit.reference, silhouettes)});
      waiting.update();
    }
    for (std::size_t i = 0; i < list.size(); ++i)
      table.rows.push_back(
          {shown.scene, list[i].name, decimals(psnr(list[i].image, lit.reference), 2),
           decimals(scores[i].edges, 2),
           std::isnan(scores[i].silhouettes) ? "-" : decimals(scores[i].silhouettes, 2),
           scene_verdict(list, scores, i)});
    if (shown.title == nullptr) continue;
    PaperFigure figure{shown.title, "", {}};
    for (const Method& m : list) {
      std::string file = fmt::format("{}_{}", shown.scene, m.name);
      std::replace(file.begin(), file.end(), ' ', '_');
      figure.images.push_back({file, m.name, m.caption, m.image, false});
    }
    std::vector<Method> columns = list;
    columns.push_back({"reference", "", lit.reference});
    figure.images.push_back(
        {fmt::format("{}_zooms", shown.scene), "Zooms",
         fmt::format(
             "columns: none, MSAA 4x, mlaa, mlaa-slope, deburr-line, deburr, reference ({} samples "
             "per pixel); rows: unscaled, then 4 x and 8 x at {} silhouettes from left to right",
             kReferenceSamples * kReferenceSamples, shown.strips),
         zooms(columns, silhouettes, shown.strips, shown.rows), true});
    compared.figures.push_back(figure);
  }
  return compared;
}

// Frames that the learned weights were not trained on.
PaperTable held_out(const PaperOptions& options) {
  PaperTable table{
      "Learned weights on frames outside the training set, PSNR in dB",
      "On edges / on silhouettes. Scenes and shapes that training leaves out, and with DEBURR_DATA "
      "set the frames of track and the 17 held-out meshes of that folder. The verdict: is deburr "
      "above every other row on both?",
      {"frame", "none", "mlaa", "mlaa-slope", "smaa", "smaa-dynamic", "deburr-line", "deburr",
       "verdict"},
      {}};
  training::FrameOptions frames;
  frames.size = options.size;
  if (const char* folder = std::getenv("DEBURR_DATA")) frames.data = folder;
  tb::Waiting waiting("paper 000: frames outside the training set", options.quiet);
  for (const training::FrameSource& source : training::held_out_set(frames)) {
    options.go_on();
    waiting.update();
    const training::ReferenceFrame frame = source.make();
    const Mask edges = tb::edge_mask(frame.reference, frame.frame);
    const Mask silhouettes = frame.depth.empty() ? Mask(edges.width, edges.height)
                                                 : tb::silhouette_mask(edges, frame.depth);
    std::vector<std::string> cells = {frame.name};
    std::vector<Scores> scores;
    const auto add = [&](const Image& image) {
      waiting.update();
      scores.push_back(
          {psnr(image, frame.reference, edges), psnr(image, frame.reference, silhouettes)});
      cells.push_back(std::isnan(scores.back().silhouettes)
                          ? decimals(scores.back().edges, 2)
                          : fmt::format("{} / {}", decimals(scores.back().edges, 2),
                                        decimals(scores.back().silhouettes, 2)));
    };
    add(frame.frame);
    for (const Preset preset : {Preset::kMlaa, Preset::kMlaaSlope, Preset::kSmaa,
                                Preset::kSmaaDynamic, Preset::kDeburrLine, Preset::kDeburr})
      add(smoothed(frame.frame, preset_parameters(preset)));
    cells.push_back(place(scores, scores.size() - 1));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

PaperTable cost_of_a_loop(const PaperOptions& options) {
  PaperTable table{
      "Cost of one more loop",
      "Paper: 0.07 ms on a GTX 560 Ti, size of the frame not given. Ours: cycles of all predictors "
      "of both axes for the frame of five cylinders, at 148.5 MHz; they run in parallel with the "
      "raster scan, so the frame takes no longer. `most` is a frame of noise.",
      {"N", "trials, cylinders", "one more loop, ms", "trials, most", "one more loop, ms, most",
       "frame, ms", "verdict"},
      {}};
  const int side = options.size;
  tb::RenderOptions render_options;
  render_options.width = render_options.height = side;
  render_options.shading = tb::Shading::kLit;
  const Image frame = render(tb::make_scene("cylinders"), render_options);
  Image noisy(side, side);
  Random random(5);
  for (tb::Rgba8& p : noisy.pixels) {
    const std::uint8_t v = random.chance(500) ? 255 : 0;
    p = {v, v, v, 255};
  }
  tb::Waiting waiting("paper 000: cost of a loop", options.quiet);
  const auto trials = [&waiting](const Image& image, int loops) {
    waiting.update();
    Parameters p = preset_parameters(Preset::kMlaaSlope);
    p.steps = loops;
    MorphologicalGolden golden(p);
    golden.process({image.pixels, image.width, image.height});
    std::uint64_t sum = 0;
    for (const auto& run : golden.runs()) sum += run.iterations;
    return static_cast<double>(sum);
  };
  constexpr double kCyclesAMs = 148500;
  const double frame_ms = (side + 37.0) * side / kCyclesAMs;
  double before = trials(frame, 0), before_most = trials(noisy, 0);
  for (int loops = 1; loops <= 8; ++loops) {
    const double now = trials(frame, loops), most = trials(noisy, loops);
    const double more = (now - before) / kCyclesAMs, more_most = (most - before_most) / kCyclesAMs;
    table.rows.push_back({fmt::format("{}", loops), decimals(now, 0), decimals(more, 4),
                          decimals(most, 0), decimals(more_most, 4), decimals(frame_ms, 3),
                          below(more, 0.07, "less", "more")});
    before = now;
    before_most = most;
  }
  return table;
}

}  // namespace

Paper build(const PaperOptions& options) {
  Paper paper;
  paper.id = "000";
  paper.title = "Slope-based straight line predicting morphological antialiasing";
  paper.source =
      "Zhong Yu-Chen and Wang Rui, Journal of Software 23, Suppl. 2, 2012 (001 is a second scan of "
      "it)";
  const auto add = [&](PaperTable table) {
    paper.tables.push_back(std::move(table));
    options.go_on();
  };
  add(theorem(options));
  add(third_branch(options));
  add(complexity(options));
  add(probes(options));
  add(quality(options, 0.05, 0.95));
  add(quality(options, 0, 1));
  add(configuration(options));
  Compared scenes = rendered_scenes(options);
  add(std::move(scenes.table));
  add(held_out(options));
  add(cost_of_a_loop(options));
  paper.figures = std::move(scenes.figures);
  return paper;
}

}  // namespace deburr::studies::paper_000
