// SPDX-License-Identifier: MIT
// Paper 002: Fan and others, Geometric information anti-aliasing algorithm with edge optimization,
// 2016. Its equations are illegible in the scan; docs/reference/geometric/algorithm.md has the
// reconstruction.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "golden/geometric/configuration.h"
#include "golden/geometric/geometric_golden.h"
#include "golden/ideal/coverage.h"
#include "golden/ideal/geometric.h"
#include "spec/geometric/packets.h"
#include "spec/geometric/parameters.h"
#include "studies/papers/papers.h"
#include "tb/base/random.h"
#include "tb/engines/geometric/edge_table.h"
#include "tb/engines/geometric/geometric_stimuli.h"
#include "tb/run/progress.h"
#include "tb/scene/compose.h"
#include "tb/scene/quality.h"
#include "tb/scene/scenes.h"

namespace deburr::studies::paper_002 {

using tb::make_scene;

namespace {

using golden::geometric::GeometricGolden;
using golden::geometric::preset_parameters;
using golden::ideal::CutPixel;
using Imath::V3d;
using spec::geometric::Combine;
using spec::geometric::EdgeClass;
using spec::geometric::Parameters;
using spec::geometric::Preset;
using spec::geometric::Region;
using tb::geometric::Checker;
using tb::geometric::Frame;
using tb::geometric::make_frame;
using tb::geometric::smoothed;

// Counterparts of the paper's models, in its order.
struct Model {
  const char *scene, *figure;
};
constexpr std::array<Model, 4> kModels = {{{"cube", "Figure 3: cube"},
                                           {"wheelcover", "Figure 4: wheel cover"},
                                           {"wing", "Figure 5: wing"},
                                           {"canopy", "Figure 6: canopy"}}};

std::string number(std::uint64_t value) { return fmt::format("{}", value); }

// A cube whose side x = 1 is seen edge on.
tb::Scene edge_on_cube() {
  tb::Scene scene = make_scene("cube");
  const double side = bounds(scene.mesh).high.x;
  scene.camera.eye = V3d(side, 0.3, 4);
  scene.camera.target = V3d(0, 0, 0);
  return scene;
}

// ---- equations (1) to (4) -----------------------------------------------------------------------

// The sign of N . V, with V from the eye to the centre of a face; the table takes V to a corner.
double facing_of(const tb::Scene& scene, std::size_t face) {
  const auto& corners = scene.mesh.triangles[face].vertex;
  const V3d &a = scene.mesh.vertices[corners[0]].position,
            &b = scene.mesh.vertices[corners[1]].position,
            &c = scene.mesh.vertices[corners[2]].position;
  return (b - a).cross(c - a).dot((a + b + c) / 3.0 - scene.camera.eye);
}

struct Silhouettes {
  std::uint64_t edges = 0, open = 0;  // vertices where a loop ends
};

template <class IsSilhouette>
Silhouettes silhouettes_of(const tb::EdgeTable& table, IsSilhouette&& is_silhouette) {
  Silhouettes found;
  std::vector<int> degree(table.vertices.size());
  for (const spec::geometric::Edge& edge : table.edges) {
    if ((edge.flags & spec::geometric::flag::kBoundary) != 0 || !is_silhouette(edge)) continue;
    ++found.edges;
    ++degree[edge.v0];
    ++degree[edge.v1];
  }
  for (const int d : degree) found.open += static_cast<std::uint64_t>(d % 2);
  return found;
}

PaperTable equations_1_to_3() {
  PaperTable table{
      "Equations 1 to 3: facing and silhouettes",
      "A face points to the eye where N·V < 0, and a silhouette lies between two faces of which "
      "exactly one does. The paper's product (N1·V)(N2·V) <= 0 is the same except for faces seen "
      "edge-on, where it selects every edge of such a face and leaves loops open; the exclusive or "
      "of equation 1 for both faces closes them. Loops of an open mesh end at its boundary.",
      {"scene", "faces", "facing bits that differ from N·V", "silhouettes, product",
       "silhouettes, exclusive or", "loose ends, product", "loose ends, exclusive or", "verdict"},
      {}};
  const auto row = [&](const std::string& name, const tb::Scene& scene) {
    const tb::EdgeTable edges = tb::build_edge_table(scene.mesh);
    const tb::ScreenEdges screen = project_edges(edges, scene.camera, 640, 480);
    const auto front = [&](std::uint32_t f) { return (screen.facing[f / 8] >> (f % 8) & 1) != 0; };
    std::int64_t wrong = 0;
    for (std::uint32_t f = 0; f < screen.faces; ++f) {
      const double side = facing_of(scene, f), rounding = 1e-12 * edges.normals[f].length();
      if (std::abs(side) > rounding) wrong += front(f) != (side < 0.0);
    }
    const auto side = [&](std::uint32_t f) {
      return edges.normals[f].dot(edges.corners[f] - scene.camera.eye);
    };
    const Silhouettes product = silhouettes_of(
        edges, [&](const auto& edge) { return side(edge.f0) * side(edge.f1) <= 0.0; });
    const Silhouettes either =
        silhouettes_of(edges, [&](const auto& edge) { return front(edge.f0) != front(edge.f1); });
    const auto boundary = static_cast<std::int64_t>(edges.boundaries);
    const std::int64_t loose = boundary == 0 ? static_cast<std::int64_t>(either.open) : 0;
    const std::string holds = product.edges == either.edges ? "right" : "ambiguous";
    table.rows.push_back({name, number(screen.faces), fmt::format("{}", wrong),
                          number(product.edges), number(either.edges), number(product.open),
                          number(either.open), claim(wrong + loose, holds.c_str())});
  };
  for (const Model& model : kModels) row(model.scene, make_scene(model.scene));
  row("cube, a side edge on", edge_on_cube());
  return table;
}

PaperTable equation_4(const PaperOptions& options) {
  PaperTable table{
      "Equation 4: creases by their angle alone",
      "N1·N2 <= 0.99 is an angle of 8.1 degrees. RMSE on edge pixels of our preset without "
      "creases, with the paper's creases, and with creases where the shading is discontinuous. The "
      "verdict compares the paper's creases with none.",
      {"scene", "silhouettes alone", "angle (paper)", "angle and shading (ours)", "verdict"},
      {}};
  tb::Waiting waiting("paper 002: creases", options.quiet);
  for (const char* scene : {"cube", "wheelcover", "object"}) {
    const Checker checker(make_scene(scene), options.size, options.size, options.quick ? 4 : 8,
                          options.watching(waiting));
    const auto error = [&](spec::geometric::Crease crease) {
      Parameters p = preset_parameters(Preset::kDeburr);
      p.crease = crease;
      return checker.edge_rmse(smoothed(checker.frame, p).image);
    };
    const double none = error(spec::geometric::Crease::kOff),
                 paper = error(spec::geometric::Crease::kPaper),
                 ours = error(spec::geometric::Crease::kShading);
    table.rows.push_back({scene, decimals(none, 2), decimals(paper, 2), decimals(ours, 2),
                          below(paper, none, "helps", "hurts")});
  }
  return table;
}

// ---- equations (5) to (8) -----------------------------------------------------------------------

PaperTable equations_5_and_6() {
  PaperTable table{
      "Equations 5 and 6: the viewport and its bias",
      "The bias is the middle of the picture. The text claims that it compensates different depths "
      "of lines and faces; no shift in x and y can. Share of the pixels cut by silhouettes of the "
      "sphere that an equal-depth test against the pixel itself drops:",
      {"item", "paper", "ours", "verdict"},
      {}};
  const tb::Scene scene = make_scene("sphere");
  Frame frame = make_frame(scene, 640, 480);
  Parameters p = preset_parameters(Preset::kDeburr);
  p.depth_test = spec::geometric::DepthTest::kOwn;
  p.depth_bias = 24;
  const std::vector<spec::geometric::Vertex> vertices = frame.screen.vertices;
  double unshifted = 0;
  for (const int shift : {0, 64, 128, 256}) {
    frame.screen.vertices = vertices;
    for (spec::geometric::Vertex& vertex : frame.screen.vertices) {
      vertex.x += shift;
      vertex.y += shift;
    }
    const spec::geometric::Work work = smoothed(frame, p).work;
    const double dropped =
        100.0 - 100.0 * static_cast<double>(work.passed) / static_cast<double>(work.candidates);
    if (shift == 0) unshifted = dropped;
    table.rows.push_back(
        {fmt::format("dropped with a shift of {} pixels both ways, %", shift / 256.0),
         shift == 0 ? kNotPrinted : "less", decimals(dropped, 1),
         shift == 0 ? std::string("added") : below(dropped, 0.5 * unshifted, "right", "no cure")});
  }
  p = preset_parameters(Preset::kDeburr);
  frame.screen.vertices = vertices;
  const spec::geometric::Work work = smoothed(frame, p).work;
  table.rows.push_back({"dropped by the farther of pixel and neighbour, %", kNotPrinted,
                        decimals(100.0 - 100.0 * static_cast<double>(work.passed) /
                                             static_cast<double>(work.candidates),
                                 1),
                        "added"});
  return table;
}

PaperTable equations_7_and_8(const PaperOptions& options) {
  PaperTable table{
      "Equations 7 and 8: weights against the area that a line cuts off",
      "RMSE × 1000 of a pixel's own weight, over the pixels cut by lines of one slope, with evenly "
      "spread phases. The text's distance may be read as perpendicular to the line; equation 7 "
      "uses the distance along the axis, and one pixel per column. The perpendicular distance is "
      "closer to the area from slope 0.5 on, above all if the second cut pixel of a column gets "
      "its weight as well. The verdict: the equation against a single pixel per column.",
      {"slope", "none", "across the line", "across, one per column", "equation", "verdict"},
      {}};
  constexpr int kSize = 48;
  const int phases = options.quick ? 16 : 64;
  for (const double slope : {0.0, 0.1, 0.25, 0.5, 0.75, 1.0}) {
    const double across = 1.0 / std::sqrt(1.0 + slope * slope);
    std::array<double, 4> squares{};
    std::int64_t pixels = 0;
    for (int i = 0; i < phases; ++i) {
      const double start = 2.0 + (i + 0.5) / phases;
      const golden::ideal::HalfPlane inside{-slope, 1, -start};
      for (int x = 0; x < kSize; ++x) {
        const double at = start + slope * (x + 0.5);
        for (int y = static_cast<int>(at) - 2; y <= static_cast<int>(at) + 2; ++y) {
          const double covered = golden::ideal::coverage(inside, x, y);
          if (covered <= 0.0 || covered >= 1.0) continue;
          const double dis = at - (y + 0.5), weight = std::max(0.0, 0.5 - std::abs(dis));
          const double wider = std::max(0.0, 0.5 - std::abs(dis) * across);
          const std::array<double, 4> weights = {0.0, wider, weight > 0.0 ? wider : 0.0, weight};
          for (std::size_t k = 0; k < weights.size(); ++k) {
            const double kept = dis <= 0.0 ? 1.0 - weights[k] : weights[k];
            squares[k] += (kept - covered) * (kept - covered);
          }
          ++pixels;
        }
      }
    }
    std::vector<std::string> row = {decimals(slope, 2)};
    for (double& square : squares) {
      square = 1000.0 * std::sqrt(square / static_cast<double>(pixels));
      row.push_back(decimals(square, 1));
    }
    row.push_back(at_most(squares[3], squares[2] + 0.05, "right", "coarser"));
    table.rows.push_back(std::move(row));
  }
  return table;
}

// Pixels whose centre lies on a line, for all directions of a few pixels: compares the neighbour
// that the printed rule chooses with ours. The top-left rule decides which face owns such a pixel.
PaperTable ties() {
  constexpr int kReach = 12;
  std::int64_t ties = 0, printed_same = 0, ours_same = 0, borders = 0;
  for (int dy = -kReach; dy <= kReach; ++dy) {
    for (int dx = -kReach; dx <= kReach; ++dx) {
      if (std::gcd(dx, dy) != 1) continue;
      const bool horizontal = std::abs(dx) > std::abs(dy);
      // The centre pixel belongs to the face for which the line is a left edge (face to its right)
      // or a top edge (face below).
      const auto to_the_right_or_below = [&](int x, int y) {
        return dy == 0 ? y > 0 : (dy > 0 ? dy * x - dx * y > 0 : dx * y - dy * x > 0);
      };
      const auto same_owner = [&](int step) {
        return to_the_right_or_below(horizontal ? 0 : step, horizontal ? step : 0);
      };
      const bool rising_down = horizontal && dx * dy > 0;
      ++ties;
      printed_same += same_owner(1);
      ours_same += same_owner(rising_down ? 1 : -1);
    }
  }
  // |dis| = 1/2.
  for (const double y : {3.0, 4.0})
    borders +=
        static_cast<std::int64_t>(golden::ideal::cut_pixels({{2, y, 1}, {6, y, 1}}, 8, 8).size());
  PaperTable table{
      "Pseudo-code: exact ties and borders",
      fmt::format("Lines through a pixel's centre, {} directions. A neighbour of the same owner "
                  "has the same colour, and nothing is smoothed. At the pixel's border the text "
                  "repeats dis = 0 and coverage 0.5; it means |dis| = 1/2 and 0.",
                  ties),
      {"item", "paper", "ours", "verdict"},
      {}};
  table.rows = {{"ties where the neighbour chosen by dis >= 0 has the same owner, %", "0",
                 decimals(100.0 * static_cast<double>(printed_same) / static_cast<double>(ties), 1),
                 claim(printed_same)},
                {"the same by our rule, %", kNotPrinted,
                 decimals(100.0 * static_cast<double>(ours_same) / static_cast<double>(ties), 1),
                 claim(ours_same, "added", "wrong")},
                {"pixels with a weight where a line runs along their border", "with 0.5",
                 fmt::format("{}", borders), borders == 0 ? "misprint" : "right"}};
  return table;
}

// ---- table 1 ------------------------------------------------------------------------------------

// The set of drawn edges: every edge, the mesh's list, or those selected in the view.
struct Drawing {
  const char* name;
  Parameters parameters;
};
// Persson's chapter draws a list that is made once per mesh: boundaries, and creases by angle.
Parameters prefiltered() {
  Parameters p = preset_parameters(Preset::kGpaa);
  p.select = spec::geometric::Select::kMesh;
  return p;
}
std::array<Drawing, 3> drawings() {
  return {{{"all", preset_parameters(Preset::kGpaa)},
           {"prefiltered", prefiltered()},
           {"selected", preset_parameters(Preset::kGpaaOptimised)}}};
}

// Cycles of the hardware's edges phase, by the bounds in docs/reference/geometric/hardware.md,
// "Cycles".
struct EdgeCycles {
  std::uint64_t kept = 0, blended = 0;
  double rebuilt = 0;  // one record read per cycle, one kept record written per cycle
  std::array<double, 2> until_line{};     // classify, vertices, setup; for one and two lanes
  double until_group = 0, with_copy = 0;  // without and with the copy of the frame
};

EdgeCycles edge_cycles(const Frame& frame, const Parameters& parameters) {
  GeometricGolden golden(parameters);
  golden.process(frame.input());
  const spec::geometric::Work& work = golden.work();
  const int bits =
      spec::geometric::kCacheLineBits[static_cast<std::size_t>(parameters.vertex_lines)];
  golden::geometric::DirectMapped cache;
  cache.reset(bits, bits);
  std::array<std::uint64_t, 2> classify{}, beat{};
  std::uint64_t vertices = 0;
  for (std::size_t i = 0; i < golden.classes().size(); ++i) {
    const bool kept = golden::geometric::is_kept(golden.classes()[i]);
    if (kept) {
      const auto& edge = frame.screen.edges[i];
      const std::uint32_t first = edge.v0 / 4, second = edge.v1 / 4;
      std::uint64_t replaced = 0, misses = 0;
      misses += cache.look_up(first, 0, replaced) ? 0 : 1;
      if (second != first) misses += cache.look_up(second, 0, replaced) ? 0 : 1;
      vertices += misses == 2 ? 2 : 1;
    }
    for (const std::size_t lanes : {1u, 2u}) {
      beat[lanes - 1] += kept ? 1 : 0;
      if ((i + 1) % lanes != 0 && i + 1 < golden.classes().size()) continue;
      classify[lanes - 1] += std::max<std::uint64_t>(1, beat[lanes - 1]);
      beat[lanes - 1] = 0;
    }
  }
  EdgeCycles cycles;
  cycles.kept = work.kept_edges;
  cycles.blended = work.blended_pixels;
  cycles.rebuilt = static_cast<double>(work.edges + work.kept_edges);
  for (std::size_t i = 0; i < 2; ++i)
    cycles.until_line[i] = static_cast<double>(std::max({classify[i], vertices, work.lines}));
  std::uint64_t port = 0;
  for (const Region region : {Region::kEdges, Region::kVertices, Region::kDepth, Region::kWeights})
    port += golden.traffic().read(region).size();
  // The resolve reads weights later; here they are few.
  port += golden.traffic().write(Region::kWeights).size();
  const std::uint64_t copy =
      golden.traffic().read(Region::kColour).size() + golden.traffic().write(Region::kCopy).size();
  const auto until_group = [&](std::uint64_t lines) {
    return std::max(
        {cycles.until_line[1], static_cast<double>(work.groups), static_cast<double>(lines)});
  };
  cycles.until_group = until_group(port);
  cycles.with_copy = until_group(port + copy);
  return cycles;
}

PaperTable table_1() {
  PaperTable table{
      "Table 1: edge detection, all edges against fewer",
      "The paper's times are of software and illegible in the scan; their mean saving is printed. "
      "Ours are cycles, and savings over all edges. (a) The list is built for each frame; one "
      "record is read and one kept record written per cycle: (edges + kept) / (2 edges), at most "
      "50 % even if every edge is dropped. (b) The list is built once per mesh; cycles until the "
      "last line is set up: the saving is in lines, not in classification, which takes one cycle "
      "per edge with one lane and half a cycle with two. (c) Cycles until the last group of pixels "
      "arrives, with two lanes: without the frame copy that these presets make, and with its 115 "
      "200 memory lines, which are most of all cycles. Prefiltered: boundaries and creases by "
      "their angle, found once per mesh, independent of the view. 1280 x 720; bounds of the units, "
      "independent of memory latency, from formulas instead of the models.",
      {"model", "edges drawn", "kept", "blended pixels", "saving (a), %", "cycles (b), one lane",
       "saving, one lane, %", "cycles (b), two lanes", "saving, two lanes, %",
       "cycles (c), no copy", "saving, no copy, %", "cycles (c), with the copy",
       "saving, with the copy, %", "verdict"},
      {}};
  struct Savings {
    double rebuilt = 0, one_lane = 0, two_lanes = 0, no_copy = 0, with_copy = 0;
  };
  std::array<Savings, 3> means;
  for (const Model& model : kModels) {
    const Frame frame = make_frame(make_scene(model.scene), 1280, 720);
    EdgeCycles all;
    std::size_t which = 0;
    for (const Drawing& drawing : drawings()) {
      const EdgeCycles some = edge_cycles(frame, drawing.parameters);
      if (which == 0) all = some;
      const auto saving = [](double before, double after) {
        return 100.0 * (1.0 - after / before);
      };
      const Savings s = {
          saving(all.rebuilt, some.rebuilt), saving(all.until_line[0], some.until_line[0]),
          saving(all.until_line[1], some.until_line[1]), saving(all.until_group, some.until_group),
          saving(all.with_copy, some.with_copy)};
      for (double Savings::*const one : {&Savings::rebuilt, &Savings::one_lane, &Savings::two_lanes,
                                         &Savings::no_copy, &Savings::with_copy})
        means[which].*one += s.*one / kModels.size();
      const auto percent = [&](double value) {
        return which == 0 ? std::string("-") : decimals(value, 1);
      };
      table.rows.push_back(
          {model.scene, drawing.name, number(some.kept), number(some.blended), percent(s.rebuilt),
           fmt::format("{}", some.until_line[0]), percent(s.one_lane),
           fmt::format("{}", some.until_line[1]), percent(s.two_lanes),
           fmt::format("{}", some.until_group), percent(s.no_copy),
           fmt::format("{}", some.with_copy), percent(s.with_copy),
           which == 0 ? "-" : below(some.until_group, all.until_group, "saves", "-")});
      ++which;
    }
  }
  for (const std::size_t which : {1u, 2u}) {
    const Savings& mean = means[which];
    // Variant (a) cannot report more than half, so it is not compared.
    table.rows.push_back({"mean (paper: 22.55)", drawings()[which].name, "-", "-",
                          decimals(mean.rebuilt, 2), "-", decimals(mean.one_lane, 2), "-",
                          decimals(mean.two_lanes, 2), "-", decimals(mean.no_copy, 2), "-",
                          decimals(mean.with_copy, 2),
                          which == 1 ? "-" : verdict("22.55", mean.no_copy, "more")});
  }
  return table;
}

// ---- figures 3 to 6 -----------------------------------------------------------------------------

struct Compared {
  PaperTable table;
  std::vector<PaperFigure> figures;
};

Compared pictures(const PaperOptions& options) {
  Compared compared;
  compared.table = {
      "Figures 3 to 6: rendered models against supersampled reference",
      "PSNR in dB on edge pixels (reference and frame differ by more than 2/255) and on "
      "silhouettes (with a step of depth of 5 %). The paper says that selection saves time; it "
      "also improves quality, since an inner line blends pixels that belong to a silhouette. gpaa "
      "draws every edge, like the method's demonstration of 2011; prefiltered draws boundaries and "
      "creases by their angle, like its chapter: it misses the view-dependent silhouettes of "
      "smooth surfaces. Verdicts: gpaa and MSAA 4x, better than none on both; gpaa prefiltered and "
      "gpaa-optimised, better than gpaa; deburr, its rank among all six.",
      {"scene", "method", "edges drawn", "edges", "silhouettes", "verdict"},
      {}};
  tb::Waiting waiting("paper 002: rendering models and reference, and smoothing", options.quiet);
  std::vector<std::pair<std::string, std::string>> scenes;
  scenes.reserve(std::size(kModels) + 3);
  for (const Model& model : kModels) scenes.emplace_back(model.scene, model.figure);
  scenes.emplace_back("sphere", "");
  scenes.emplace_back("object", "");
  scenes.emplace_back("terrain", "");
  for (const auto& [name, title] : scenes) {
    const Checker checker(make_scene(name), options.size, options.size, options.quick ? 4 : 8,
                          options.watching(waiting));
    struct Method {
      std::string name;
      tb::Image image;
      std::string kept;
    };
    std::vector<Method> methods = {{"none", checker.frame.image, "-"},
                                   {"MSAA 4x", checker.msaa, "-"}};
    for (const auto& [method, parameters] :
         {std::pair{"gpaa", preset_parameters(Preset::kGpaa)},
          {"gpaa prefiltered", prefiltered()},
          {"gpaa-optimised", preset_parameters(Preset::kGpaaOptimised)},
          {"deburr", preset_parameters(Preset::kDeburr)}}) {
      auto result = smoothed(checker.frame, parameters);
      methods.push_back({method, std::move(result.image), number(result.work.kept_edges)});
    }
    constexpr std::size_t kGpaa = 2;
    std::vector<Scores> scores;
    scores.reserve(methods.size());
    for (const Method& method : methods)
      scores.push_back({checker.edge_psnr(method.image), checker.silhouette_psnr(method.image)});
    const auto word = [&](std::size_t i) -> std::string {
      if (i == 0) return "-";
      if (i + 1 == methods.size()) return place(scores, i);
      // Methods that draw fewer edges are compared with gpaa, the others with no filter.
      return beats(scores[i], scores[i > kGpaa ? kGpaa : 0]) ? "better" : "worse";
    };
    for (std::size_t i = 0; i < methods.size(); ++i)
      compared.table.rows.push_back({name, methods[i].name, methods[i].kept,
                                     decimals(scores[i].edges, 2),
                                     decimals(scores[i].silhouettes, 2), word(i)});
    if (title.empty()) continue;
    PaperFigure figure{title, "", {}};
    for (const Method& method : methods) {
      std::string file = fmt::format("{}_{}", name, method.name);
      std::replace(file.begin(), file.end(), ' ', '_');
      figure.images.push_back({file, method.name, "", method.image, false});
    }
    figure.images.push_back(
        {name + "_reference", "reference", "supersampled", checker.reference, false});
    compared.figures.push_back(std::move(figure));
    waiting.update();
  }
  return compared;
}

// ---- beyond the paper ---------------------------------------------------------------------------

PaperTable order_of_edges(const PaperOptions& options) {
  PaperTable table{
      "The order of edges",
      "Pixels that change when the same edges are drawn in another order, by the rule that "
      "combines the weights of several lines: the last line wins (the paper's drawing), the "
      "largest weight of each direction, or the same with the smallest weight where the neighbour "
      "is farther (outermost, ours).",
      {"scene", "blended pixels", "last: changed", "max: changed", "outermost: changed", "verdict"},
      {}};
  for (const char* scene : {"wheelcover", "object"}) {
    Frame frame = make_frame(make_scene(scene), options.size, options.size);
    constexpr std::array kConfiguration = {Combine::kLast, Combine::kMax, Combine::kOutermost};
    std::array<std::int64_t, kConfiguration.size()> changed{};
    std::uint64_t blended = 0;
    for (std::size_t rule = 0; rule < kConfiguration.size(); ++rule) {
      Parameters p = preset_parameters(Preset::kGpaaOptimised);
      p.combine = kConfiguration[rule];
      const tb::geometric::Smoothed before = smoothed(frame, p);
      blended = before.work.blended_pixels;
      tb::Random random(7);
      std::vector<spec::geometric::Edge>& edges = frame.screen.edges;
      const std::vector<spec::geometric::Edge> kept = edges;
      for (std::size_t i = edges.size(); i > 1; --i)
        std::swap(edges[i - 1], edges[random.below(static_cast<std::uint32_t>(i))]);
      changed[rule] = tb::count_different(before.image, smoothed(frame, p).image);
      edges = kept;
    }
    table.rows.push_back(
        {scene, number(blended), fmt::format("{}", changed[0]), fmt::format("{}", changed[1]),
         fmt::format("{}", changed[2]),
         claim(changed[1] + changed[2], changed[0] > 0 ? "matters" : "same", "wrong")});
  }
  return table;
}

}  // namespace

Paper build(const PaperOptions& options) {
  Paper paper;
  paper.id = "002";
  paper.title = "Geometric information anti-aliasing algorithm with edge optimization";
  paper.source =
      "Fan Yangyu, Hu Siqiang, Guo Zhe, Zhang Yandian and Wang Yi, Journal of Harbin Engineering "
      "University 37 (12), 2016. Eight equations, reconstructed from the text around them";
  const auto add = [&](PaperTable table) {
    paper.tables.push_back(std::move(table));
    options.go_on();
  };
  add(equations_1_to_3());
  add(equation_4(options));
  add(equations_5_and_6());
  add(equations_7_and_8(options));
  add(ties());
  add(table_1());
  Compared models = pictures(options);
  add(std::move(models.table));
  add(order_of_edges(options));
  paper.figures = std::move(models.figures);
  return paper;
}

}  // namespace deburr::studies::paper_002
