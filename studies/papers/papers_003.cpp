// SPDX-License-Identifier: MIT
// Paper 003: Liu, Du and Du, Improvement of sub-pixel morphological anti-aliasing algorithm,
// Journal of Computer Applications 37(10), 2017.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "golden/ideal/smaa_area.h"
#include "golden/morphological/area_table.h"
#include "golden/morphological/configuration.h"
#include "golden/morphological/diagonals.h"
#include "golden/morphological/edges.h"
#include "golden/morphological/morphological_golden.h"
#include "spec/morphological/parameters.h"
#include "studies/papers/papers.h"
#include "tb/base/forked.h"
#include "tb/engines/morphological/morphological_environment.h"
#include "tb/engines/morphological/morphological_frames.h"
#include "tb/run/progress.h"
#include "tb/scene/quality.h"
#include "tb/scene/reference.h"
#include "tb/scene/scenes.h"
#include "tb/stimuli/discs.h"
#include "tb/stimuli/frames.h"
#include "tb/stimuli/line_fans.h"
#include "tb/stimuli/reference_filters.h"

namespace deburr::studies::paper_003 {

using tb::Image;

namespace {

using golden::morphological::EdgePlanes;
using golden::morphological::MorphologicalGolden;
using golden::morphological::preset_parameters;
using spec::morphological::DynamicLuma;
using spec::morphological::LocalContrast;
using spec::morphological::Parameters;
using spec::morphological::Preset;
using spec::morphological::Quality;
using spec::morphological::ThresholdMode;
using tb::stimuli::FanFigures;
using tb::stimuli::FanOptions;

// ---- the table ----------------------------------------------------------------------------------

// Size of a texture of two-byte texels as the public generator prints it: six characters per byte,
// plus six for each line of twelve bytes.
struct Texture {
  int width, height;
  int bytes() const { return 2 * width * height; }
  int printed() const { return 6 * bytes() + bytes() / 12 * 6; }
  int printed_kilobytes() const { return (printed() + 60 + 1023) / 1024; }  // 60: its header
};

PaperTable sizes() {
  // SMAA's texture, and one with seven rows of 8 orthogonal and 16 diagonal tiles of 16 x 16.
  constexpr Texture kFull{160, 560}, kMerged{96, 448};
  const auto saving = [](double before, double after) { return 100 * (before - after) / before; };
  const double printed = saving(kFull.printed_kilobytes(), kMerged.printed_kilobytes());
  PaperTable table{"Storage of the area table",
                   "The paper's sizes are those of the table as source text. In binary it has 175 "
                   "and 84 KiB. An engine without subsample offsets needs far less: by symmetry, "
                   "two tiles of one value each.",
                   {"item", "paper", "ours", "verdict"},
                   {}};
  const auto add = [&](std::string item, const std::string& paper, double ours, int digits = 0) {
    table.rows.push_back(checked_row(std::move(item), paper, ours, digits, "wrong"));
  };
  add("SMAA, printed, KB", "1138", kFull.printed_kilobytes());
  add("merged, printed, KB", "547", kMerged.printed_kilobytes());
  add("saving, printed, %", "51.93", printed, 2);
  add("SMAA, binary, bytes", kNotPrinted, kFull.bytes());
  add("merged, binary, bytes", kNotPrinted, kMerged.bytes());
  add("saving, binary, %", kNotPrinted, saving(kFull.bytes(), kMerged.bytes()), 2);
  add("orthogonal patterns, saving, %", "50",
      saving(golden::morphological::FullAreaTable::kBits,
             golden::morphological::MergedAreaTable::kBits));
  add("ROM of SMAA 1x, bits: table_full", kNotPrinted, golden::morphological::FullAreaTable::kBits);
  add("table_merged", kNotPrinted, golden::morphological::MergedAreaTable::kBits);
  add("table_minimal", kNotPrinted, golden::morphological::MinimalAreaTable::kBits);
  add("diagonals", kNotPrinted, golden::morphological::DiagonalTable::kBits);
  return table;
}

PaperTable merging() {
  PaperTable table{
      "Error of merging patterns",
      "Patterns 7, 14 read as 6 and 11, 13 as 9: largest difference of an entry, in 1/255. The "
      "paper calls their areas the same; with the subsample offsets of SMAA's other modes they are "
      "not.",
      {"offset", "paper", "ours", "verdict"},
      {}};
  for (const double offset : golden::ideal::kSmaaOffsets) {
    const int loss = golden::ideal::loss_by_merging(offset);
    table.rows.push_back({fmt::format("{:g}", offset), "0", fmt::format("{}", loss),
                          claim(loss, "right", "inconsistent")});
  }
  return table;
}

// ---- edges --------------------------------------------------------------------------------------

EdgePlanes edges_of(const Image& image, const Parameters& p) {
  return golden::morphological::find_edges(p, {image.pixels, image.width, image.height});
}

double edge_pixels_percent(const Image& image, const EdgePlanes& edges) {
  std::int64_t count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) count += edges.left.at(x, y) || edges.top.at(x, y);
  return 100.0 * static_cast<double>(count) / static_cast<double>(image.pixels.size());
}

Parameters fixed(int threshold) {
  Parameters p = preset_parameters(Preset::kSmaa);
  p.local_contrast = LocalContrast::kPaper;
  p.threshold = threshold;
  return p;
}
Parameters dynamic(int alpha, int floor, DynamicLuma luma = DynamicLuma::kCurrent) {
  Parameters p = preset_parameters(Preset::kSmaaDynamic);
  p.alpha = alpha;
  p.floor = floor;
  p.dynamic_luma = luma;
  return p;
}

struct Share {
  double real;
  int threshold;  // U8.16
  int alpha;      // U0.24
};
constexpr std::array<Share, 3> kShares = {
    {{0.05, 835584, 838860}, {0.1, 1671168, 1677721}, {0.2, 3342336, 3355443}}};
constexpr int kTwoCodes = 131072;
constexpr int kNoFloor = 1;

struct NamedImage {
  std::string name;
  Image image;
};

std::vector<NamedImage> frames(const PaperOptions& options) {
  std::vector<NamedImage> all;
  for (const char* scene : {"cylinders", "object", "road", "quad", "tunnel", "plane"}) {
    tb::RenderOptions render_options;
    render_options.width = render_options.height = options.size;
    render_options.shading = tb::Shading::kLit;
    all.push_back({scene, render(tb::make_scene(scene), render_options)});
  }
  return all;
}

PaperTable densities(const PaperOptions& options) {
  PaperTable table{"Edge pixels, % of the frame",
                   "Fixed T against T' = alpha x luma of the current pixel, eq (2) and (3). T' is "
                   "above T where luma is above T / alpha, so it is not a stricter threshold: with "
                   "alpha = T it finds more edges in dark areas and nowhere fewer. Next to black "
                   "every step is an edge unless a floor prevents it: shades is a frame of dark "
                   "greys. The verdict: does alpha give more edges than T of the same value?",
                   {"frame", "T, alpha", "fixed", "dynamic", "dynamic, floor 2/255", "verdict"},
                   {}};
  std::vector<NamedImage> shown = frames(options);
  shown.push_back({"shades", tb::stimuli::shades_image(options.size, options.size)});
  for (const NamedImage& frame : shown) {
    for (const Share& share : kShares) {
      const auto percent = [&](const Parameters& p) {
        return edge_pixels_percent(frame.image, edges_of(frame.image, p));
      };
      const double t = percent(fixed(share.threshold)),
                   open = percent(dynamic(share.alpha, kNoFloor)),
                   floored = percent(dynamic(share.alpha, kTwoCodes));
      table.rows.push_back({frame.name, fmt::format("{:g}", share.real), decimals(t, 2),
                            decimals(open, 2), decimals(floored, 2), below(t, open)});
    }
  }
  return table;
}

PaperTable symmetry(const PaperOptions& options) {
  PaperTable table{"Raw edges that change when the frame is mirrored",
                   "alpha = 0.1, floor 2/255, no local contrast; % of the edge bits of both "
                   "planes. Using the luma of only one pixel of the pair is not symmetric.",
                   {"luma", "paper", "bits that change, %", "verdict"},
                   {}};
  const std::vector<NamedImage> all = frames(options);
  for (std::size_t luma = 0; luma < spec::morphological::kDynamicLumaNames.size(); ++luma) {
    Parameters p = dynamic(1677721, kTwoCodes, static_cast<DynamicLuma>(luma));
    p.local_contrast = LocalContrast::kOff;
    std::int64_t changed = 0, bits = 0;
    for (const NamedImage& frame : all) {
      const EdgePlanes edges = edges_of(frame.image, p),
                       mirrored = edges_of(tb::stimuli::mirrored_x(frame.image), p);
      bits += static_cast<std::int64_t>(edges.left.count() + edges.top.count());
      for (int y = 0; y < frame.image.height; ++y)
        for (int x = 0; x < frame.image.width; ++x) {
          changed += edges.top.at(x, y) != mirrored.top.at(frame.image.width - 1 - x, y);
          changed += edges.left.at(x, y) != mirrored.left.at(frame.image.width - x, y);
        }
    }
    const double percent = 100.0 * static_cast<double>(changed) / static_cast<double>(bits);
    table.rows.push_back({std::string(spec::morphological::kDynamicLumaNames[luma]),
                          luma == 0 ? "used" : kNotPrinted, decimals(percent, 2),
                          claim(changed, "symmetric", "asymmetric")});
  }
  return table;
}

// ---- the quality matrix -------------------------------------------------------------------------

struct Method {
  std::string name;
  bool smoothed = true;
  Parameters parameters;
  const tb::stimuli::ReferenceFilter* reference =
      nullptr;  // replaces the engine: no hardware exists
  bool by_engine() const { return smoothed && reference == nullptr; }
};

std::vector<Method> methods() {
  std::vector<Method> all = {{"none", false, {}},
                             {"mlaa", true, preset_parameters(Preset::kMlaa)},
                             {"mlaa-slope", true, preset_parameters(Preset::kMlaaSlope)}};
  for (const Quality quality : {Quality::kLow, Quality::kMedium, Quality::kHigh, Quality::kUltra})
    all.push_back(
        {fmt::format("smaa {}",
                     spec::morphological::kQualityNames[static_cast<std::size_t>(quality)]),
         true, preset_parameters(Preset::kSmaa, quality)});
  for (const Share& share : kShares) {
    Method method{fmt::format("smaa-dynamic {:g}", share.real), true,
                  preset_parameters(Preset::kSmaaDynamic)};
    method.parameters.alpha = share.alpha;
    all.push_back(method);
  }
  for (const tb::stimuli::ReferenceFilter& reference : tb::stimuli::kReferenceFilters)
    all.push_back({reference.name, true, {}, &reference});
  all.push_back({"deburr", true, preset_parameters(Preset::kDeburr)});
  all.push_back({"deburr-line", true, preset_parameters(Preset::kDeburrLine)});
  const auto with = [&](const char* name, void (*change)(Parameters&)) {
    Method method{name, true, preset_parameters(Preset::kDeburrLine)};
    change(method.parameters);
    all.push_back(method);
  };
  with("deburr-line + diagonals", [](Parameters& p) { p.diagonals = true; });
  with("deburr-line + corners", [](Parameters& p) { p.round_corners = true; });
  with("deburr-line + strongest",
       [](Parameters& p) { p.blend = spec::morphological::BlendRule::kStrongest; });
  return all;
}

Image smoothed(const Image& frame, const Method& method) {
  if (!method.smoothed) return frame;
  if (method.reference) return method.reference->filter(frame, method.parameters.linear_light);
  MorphologicalGolden golden(method.parameters, MorphologicalGolden::Detail::kPixels);
  Image out(frame.width, frame.height);
  out.pixels = golden.process({frame.pixels, frame.width, frame.height});
  return out;
}

PaperTable matrix_of_lines(const PaperOptions& options) {
  PaperTable table{
      "Quality matrix: lines and discs",
      "RMSE x 1000 to exact coverage on straight lines of slopes 1/(n + u), u in [0.05, 0.95], "
      "by n, and on discs of all radii; linear_light off. Verdicts: is deburr below every other "
      "row in all columns?",
      {"rules"},
      {}};
  for (const std::string_view name : tb::stimuli::kSlopeClasses)
    table.columns.push_back(fmt::format("n = {}", name));
  for (const char* name : {"undulation", "discs", "verdict"}) table.columns.emplace_back(name);
  FanOptions fan;
  if (options.quick) fan.lines = 8, fan.seeds = 1;
  std::vector<Method> all = methods();
  std::vector<std::vector<double>> figures;
  tb::Progress progress("paper 003", all.size(), "row", options.quiet);
  for (Method& method : all) {
    method.parameters.linear_light = false;
    const tb::stimuli::Smoothing smoothing = [&](const Image& image) {
      return smoothed(image, method);
    };
    const FanFigures lines = measure_fans(smoothing, fan);
    std::vector<double> row(lines.by_class.begin(), lines.by_class.end());
    row.push_back(lines.undulation);
    row.push_back(tb::stimuli::measure_discs(smoothing, {.pixels = options.quick ? 1000 : 4000,
                                                         .seeds = options.quick ? 1 : 3})
                      .all);
    figures.push_back(row);
    progress.update(figures.size());
  }
  std::size_t deburr = 0;
  while (all[deburr].name != "deburr") ++deburr;
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::vector<std::string> cells = {all[i].name};
    std::int64_t ahead = 0;
    for (std::size_t k = 0; k < figures[i].size(); ++k) {
      cells.push_back(decimals(figures[i][k], 1));
      ahead += figures[i][k] <= figures[deburr][k];
    }
    cells.push_back(i == deburr  ? "ours"
                    : i > deburr ? "variant"
                                 : claim(ahead, "behind", "ahead"));
    table.rows.push_back(cells);
  }
  return table;
}

PaperTable matrix_of_frames(const PaperOptions& options) {
  PaperTable table{"Quality matrix: frames",
                   "PSNR in dB against the supersampled reference over edge pixels. The last "
                   "columns are means over all frames: on edges, on silhouettes (of frames that "
                   "have any), edge pixels in %. Textured frames are tunnel and plane.",
                   {"rules"},
                   {}};
  std::vector<Method> all = methods();
  struct Sum {
    double edges = 0, silhouettes = 0, density = 0;
    int with_silhouettes = 0;
    std::vector<std::string> cells;
  };
  std::vector<Sum> sums(all.size() + 1);
  std::vector<const char*> scenes = {"cylinders", "object", "road", "quad", "tunnel", "plane"};
  tb::Progress progress("paper 003", scenes.size(), "scene", options.quiet);
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    table.columns.emplace_back(scenes[s]);
    const tb::Scene scene = tb::make_scene(scenes[s]);
    const tb::LitFrames lit =
        tb::render_lit_frames(scene, options.size, options.size, options.quick ? 4 : 8);
    const tb::Mask edges = tb::edge_mask(lit.reference, lit.noaa);
    const tb::Mask silhouettes = tb::silhouette_mask(edges, lit.depth);
    const auto check = [&](Sum& sum, const Image& image) {
      const double on_edges = psnr(image, lit.reference, edges),
                   on_silhouettes = psnr(image, lit.reference, silhouettes);
      sum.edges += on_edges;
      if (!std::isnan(on_silhouettes)) sum.silhouettes += on_silhouettes, ++sum.with_silhouettes;
      sum.cells.push_back(decimals(on_edges, 2));
    };
    for (std::size_t i = 0; i < all.size(); ++i) {
      check(sums[i], smoothed(lit.noaa, all[i]));
      if (all[i].by_engine())
        sums[i].density += edge_pixels_percent(lit.noaa, edges_of(lit.noaa, all[i].parameters));
    }
    check(sums.back(), tb::render_msaa4(scene, options.size, options.size));
    progress.update(s + 1);
  }
  for (const char* name : {"edges", "silhouettes", "edge pixels, %", "verdict"})
    table.columns.emplace_back(name);
  all.push_back({"MSAA 4x", false, {}});
  std::size_t deburr = 0;
  while (all[deburr].name != "deburr") ++deburr;
  const auto n = static_cast<double>(scenes.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    Sum& sum = sums[i];
    std::vector<std::string> cells = {all[i].name};
    cells.insert(cells.end(), sum.cells.begin(), sum.cells.end());
    cells.push_back(decimals(sum.edges / n, 2));
    cells.push_back(decimals(sum.silhouettes / std::max(1, sum.with_silhouettes), 2));
    cells.push_back(all[i].by_engine() ? decimals(sum.density / n, 2) : "-");
    cells.push_back(i == deburr ? "ours"
                                : at_most(sum.edges, sums[deburr].edges, "behind", "ahead"));
    table.rows.push_back(cells);
  }
  return table;
}

struct Cost {
  std::uint64_t cycles, unstalled;   // per frame, measured and by formula
  std::uint64_t rom_bits, ram_bits;  // physical
};

// Runs the frame through the hardware model in its own process; every pixel is compared with
// golden.
Cost cost_of(const Parameters& parameters, const Image& image) {
  return tb::forked<Cost>([&] {
    const tb::MorphologicalInput frame{image, {}};
    tb::SimulationOptions options;
    options.check_links = false;
    tb::Simulation simulation(options);
    tb::MorphologicalSetup setup;
    setup.morphological = parameters;
    setup.morphological.line_pixels = std::max(1920, image.width);
    tb::MorphologicalEnvironment environment(simulation, {&frame, 1}, setup);
    simulation.elaborate(environment);
    simulation.run();
    environment.check();
    tb::Result result;
    simulation.collect(result);
    Cost cost{environment.engine().sequencer.frame_cycles.value(),
              tb::frame_cycles_by_formula(parameters, image.width, image.height), 0, 0};
    for (const tb::MemoryFigures& memory : result.memories)
      (memory.kind == "rom" ? cost.rom_bits : cost.ram_bits) += memory.physical_bits;
    return cost;
  });
}

PaperTable matrix_of_costs(const PaperOptions& options) {
  PaperTable table{
      "Quality matrix: cost",
      "The hardware model, one lane, lines of up to 1920 pixels. Cycles of a frame (object, at the "
      "size of the pictures) and physical bits, which include copies for more ports and the "
      "predictor's memories, which every engine has; then cycles relative to an engine that never "
      "stalls, for 256 x 144 random pixels of which 20 % have an edge, and 37 %, which the paper's "
      "threshold gives. The verdict: does it reach one pixel per cycle up to 20 %?",
      {"rules", "cycles", "ROM, bits", "flip-flops and SRAM, bits", "20 %", "37 %", "verdict"},
      {}};
  tb::RenderOptions render_options;
  render_options.width = render_options.height = options.size;
  render_options.shading = tb::Shading::kLit;
  const Image frame = render(tb::make_scene("object"), render_options);
  const Image fifth = tb::stimuli::random_edges(256, 144, 200),
              paper = tb::stimuli::random_edges(256, 144, 370);
  std::vector<Method> all = methods();
  std::erase_if(all, [](const Method& method) { return !method.by_engine(); });
  tb::Progress progress("paper 003", all.size(), "row", options.quiet);
  for (const Method& method : all) {
    options.go_on();
    const auto slowdown = [&](const Image& image) {
      const Cost cost = cost_of(method.parameters, image);
      return static_cast<double>(cost.cycles) / static_cast<double>(cost.unstalled);
    };
    const Cost cost = cost_of(method.parameters, frame);
    const double at_fifth = slowdown(fifth);
    table.rows.push_back({method.name, fmt::format("{}", cost.cycles),
                          fmt::format("{}", cost.rom_bits), fmt::format("{}", cost.ram_bits),
                          decimals(at_fifth, 3), decimals(slowdown(paper), 3),
                          below(at_fifth, 1.005)});
    progress.update(table.rows.size());
  }
  return table;
}

// ---- pictures -----------------------------------------------------------------------------------

// Black where a pixel has an edge.
Image drawn(const Image& image, const EdgePlanes& edges) {
  Image out(image.width, image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      out.at(x, y) = tb::stimuli::grey(edges.left.at(x, y) || edges.top.at(x, y) ? 0 : 255);
  return out;
}

PaperFigure edge_figure(const char* title, const NamedImage& frame) {
  PaperFigure figure{title, "Edge pixels in black.", {}};
  figure.images.push_back({frame.name + "_frame", "the frame", "", frame.image, false});
  for (const Share& share : kShares) {
    figure.images.push_back({fmt::format("{}_fixed_{:g}", frame.name, share.real),
                             fmt::format("fixed, T = {:g}", share.real), "",
                             drawn(frame.image, edges_of(frame.image, fixed(share.threshold))),
                             false});
    figure.images.push_back(
        {fmt::format("{}_dynamic_{:g}", frame.name, share.real),
         fmt::format("dynamic, alpha = {:g}", share.real), "no floor, as in the paper",
         drawn(frame.image, edges_of(frame.image, dynamic(share.alpha, kNoFloor))), false});
  }
  return figure;
}

PaperFigure smoothed_figure(const char* title, const NamedImage& frame) {
  PaperFigure figure{title, "", {}};
  for (const Method& method : methods())
    if (method.name == "none" || method.name == "smaa high" || method.name == "smaa-dynamic 0.1" ||
        method.name == "deburr") {
      std::string file = fmt::format("{}_{}", frame.name, method.name);
      std::replace(file.begin(), file.end(), ' ', '_');
      figure.images.push_back({file, method.name, "", smoothed(frame.image, method), false});
    }
  return figure;
}

}  // namespace

Paper build(const PaperOptions& options) {
  Paper paper;
  paper.id = "003";
  paper.title = "Improvement of sub-pixel morphological anti-aliasing algorithm";
  paper.source =
      "Liu Jingrong, Du Huimin and Du Qinqin, Journal of Computer Applications 37(10), 2017";
  paper.tables.push_back(sizes());
  paper.tables.push_back(merging());
  paper.tables.push_back(densities(options));
  paper.tables.push_back(symmetry(options));
  paper.tables.push_back(matrix_of_lines(options));
  paper.tables.push_back(matrix_of_frames(options));
  paper.tables.push_back(matrix_of_costs(options));
  const std::vector<NamedImage> all = frames(options);
  paper.figures.push_back(edge_figure("Figure 3: edges of a figure", all[1]));
  paper.figures.push_back(edge_figure("Figure 4: edges of objects", all[0]));
  paper.figures.push_back(edge_figure("Figure 6: edges of a scene", all[2]));
  paper.figures.push_back(smoothed_figure("Figure 7: a complex scene", all[2]));
  paper.figures.push_back(smoothed_figure("Figure 8: a simple scene", all[0]));
  return paper;
}

}  // namespace deburr::studies::paper_003
