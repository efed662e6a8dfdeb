// SPDX-License-Identifier: MIT
// Paper 004: Xu, Du, Zeng and Wang, Hardware implementation of an anisotropic texture filter, 2019.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "golden/ideal/box.h"
#include "golden/ideal/ewa.h"
#include "golden/ideal/footprint.h"
#include "golden/ideal/integrate.h"
#include "golden/ideal/lod.h"
#include "golden/texture/footprint.h"
#include "golden/texture/level_of_detail.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/packets.h"
#include "spec/texture/parameters.h"
#include "studies/papers/papers.h"
#include "tb/engines/texture/texture_scene.h"
#include "tb/run/progress.h"
#include "tb/scene/compose.h"
#include "tb/scene/quality.h"
#include "tool/cost/embedded_cost.h"

namespace deburr::studies::paper_004 {

using tb::TextureScene;

namespace {

namespace ideal = golden::ideal;
namespace gold = golden::texture;
using spec::texture::Axes;
using spec::texture::CountRule;
using spec::texture::FootprintRule;
using spec::texture::Log2Rule;

constexpr double kLog2One = 4096;   // S5.12
constexpr double kSideOne = 65536;  // U16.16
constexpr double kAlphas[] = {0.5, 0.25, 0.3284};

spec::texture::Parameters papers_configuration() {
  return spec::texture::preset_parameters(spec::texture::Preset::kPaper);
}

template <class Enum, std::size_t N>
std::string name_of(Enum value, const std::array<std::string_view, N>& names) {
  return std::string(names.at(static_cast<std::size_t>(value)));
}

// ---- section 1.2: the side of the footprint -----------------------------------------------------

PaperTable coefficients() {
  PaperTable table{"Equation 7: f(α) = c2 α² − c1 α + c0, the mean square error of a + α b",
                   "",
                   {"coefficient", "paper", "ours", "verdict"},
                   {}};
  const double c2 = ideal::mean(0, 1, [](double k) { return k * k; });
  const double c1 = ideal::mean(0, 1, [](double k) { return 2 * k * (std::sqrt(1 + k * k) - 1); });
  const double c0 = ideal::mean(0, 1, [](double k) {
    const double e = 1 - std::sqrt(1 + k * k);
    return e * e;
  });
  const double best = ideal::best_alpha();
  table.rows = {checked_row("c2", "1/3", c2, 6, "wrong"),
                checked_row("c1", "0.219", c1, 6, "wrong"),
                checked_row("c0", "0.0377", c0, 6, "wrong"),
                checked_row("α of the least error", "0.3284", best, 6, "wrong")};
  return table;
}

PaperTable table_1() {
  PaperTable table{"Table 1: error of the side a + α b",
                   "The paper's figure is the mean square times 100, not a percentage of the side.",
                   {"α", "paper", "ours, mean square × 100", "ours, RMS %", "verdict"},
                   {}};
  const char* const paper[] = {"1.16", "0.38", "0.18"};
  for (int i = 0; i < 3; ++i) {
    const double square = ideal::mean_square_side_error(kAlphas[i]);
    table.rows.push_back({fmt::format("{}", kAlphas[i]), paper[i], decimals(100 * square, 4),
                          decimals(100 * std::sqrt(square), 1),
                          verdict(paper[i], 100 * square, "wrong")});
  }
  return table;
}

PaperTable table_2() {
  PaperTable table{"Table 2: error of the level from the side alone",
                   "Again the mean square times 100; RMS and largest error are in levels.",
                   {"α", "paper", "ours, mean square × 100", "RMS", "largest", "verdict"},
                   {}};
  const char* const paper[] = {"1.60", "0.38", "0.28"};
  for (int i = 0; i < 3; ++i) {
    const double square = ideal::mean_square_level_error(kAlphas[i]);
    table.rows.push_back({fmt::format("{}", kAlphas[i]), paper[i], decimals(100 * square, 4),
                          decimals(std::sqrt(square), 3),
                          decimals(ideal::largest_level_error(kAlphas[i]), 3),
                          verdict(paper[i], 100 * square, "wrong")});
  }
  return table;
}

// Equation 8 is claimed to be monotone over [0, π/4]: searches for its maximum.
std::vector<std::string> monotone_row(double alpha) {
  const auto error = [&](double theta) {
    return std::log2(std::cos(theta) + alpha * std::sin(theta));
  };
  constexpr int kSteps = 100000;
  const double step = std::numbers::pi / 4 / kSteps;
  int best = 0;
  for (int i = 0; i <= kSteps; ++i)
    if (error(i * step) > error(best * step)) best = i;
  const bool inside = best > 0 && best < kSteps;
  return {fmt::format("equation 8 at α = {}", alpha), "monotone",
          inside ? fmt::format("maximum at tan θ = {:.4f}", std::tan(best * step)) : "monotone",
          claim(inside)};
}

// ---- section 1.4 and 1.5: logarithm and level ---------------------------------------------------

PaperTable logarithm() {
  const ideal::LogarithmError error = ideal::logarithm_error();
  PaperTable table{"Equation 13: lb x ≈ n + y", "", {"item", "paper", "ours", "verdict"}, {}};
  const auto row = [&](const char* item, double value, int digits) {
    table.rows.push_back(checked_row(item, "3.12", value, digits, "irreproducible"));
  };
  row("mean square × 100", 100 * error.mean_square, 3);
  row("RMS × 100", 100 * error.root_mean_square, 2);
  row("mean × 100", 100 * error.mean, 2);
  row("largest × 100", 100 * error.largest, 2);
  table.rows.push_back(checked_row("y of the largest", kNotPrinted, error.at, 4, "wrong"));
  // (1 + 2 s1)(1 + k/2) over the domain; lb(1 + u) ≈ u needs u < 1.
  const double argument = (1 + 2 * 0.5) * (1 + 0.5 * 1.0);
  table.rows.push_back({"equation 17: lb(1 + u) ≈ u, largest argument 1 + u", "below 2",
                        decimals(argument, 1), below(argument, 2)});
  table.rows.push_back(monotone_row(0.5));
  table.rows.push_back(monotone_row(0.25));
  return table;
}

PaperTable equation_23() {
  PaperTable table{
      "Equation 23: the integer level differs from the exact one",
      "The integral is right; the domain of k and s1 has area 1/2, so the probability is "
      "twice the integral.",
      {"item", "paper", "ours", "verdict"},
      {}};
  const double area = ideal::level_flip_area();
  const double closed = std::asinh(1.0) - 2 * std::log(1.5);
  const double probability = ideal::level_flip_probability();
  // The unit's integer arithmetic over the same domain, and over lengths spread evenly on a log
  // scale.
  const auto measured = [](bool log_uniform) {
    constexpr int kSteps = 1024;
    int flips = 0;
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps; ++j) {
        const double k = (i + 0.5) / kSteps, u = (j + 0.5) / kSteps;
        const double a = 256 * (log_uniform ? std::exp2(u) : 1 + u);
        const auto s = static_cast<std::uint32_t>(a * kSideOne);
        const auto t = static_cast<std::uint32_t>(a * k * kSideOne);
        const int level = gold::log2_fixed(Log2Rule::kMitchell,
                                           gold::footprint_side(FootprintRule::kHalf, s, t)) >>
                          12;
        flips += level != static_cast<int>(std::floor(std::log2(a * std::sqrt(1 + k * k))));
      }
    }
    return static_cast<double>(flips) / (kSteps * kSteps);
  };
  table.rows = {
      checked_row("the double integral", "0.0704", area, 6, "wrong"),
      checked_row("its closed form asinh 1 − 2 ln 1.5", kNotPrinted, closed, 6, "wrong"),
      checked_row("as a probability", "0.07", probability, 4, "unnormalised"),
      checked_row("measured on the unit's integers, s1 uniform", "0.07", measured(false), 4,
                  "unnormalised"),
      checked_row("the same, lengths log-uniform", kNotPrinted, measured(true), 4, "wrong")};
  return table;
}

PaperTable figure_1() {
  // Sides (6, 3) and (1, 2) texels: d_x = 3 sqrt 5, d_y = sqrt 5, as printed.
  const spec::texture::Parameters parameters = papers_configuration();
  spec::texture::Descriptor descriptor;
  descriptor.width = descriptor.height = 1024;
  descriptor.levels = 11;
  descriptor.max_anisotropy_log2 = 4;
  const gold::Footprint f = gold::footprint(parameters.axes, parameters.footprint,
                                            {6 << 16, 3 << 16}, {1 << 16, 2 << 16});
  const gold::LevelOfDetail lod =
      gold::select_level(parameters, descriptor, gold::log2_fixed(Log2Rule::kMitchell, f.d_max),
                         gold::log2_fixed(Log2Rule::kMitchell, f.d_min));
  PaperTable table{"Figure 1: a footprint of 3√5 by √5 texels",
                   "The figure shows the ratio 3; the rule of section 1.3 is N = 2^⌊L⌋.",
                   {"item", "paper", "ours", "verdict"},
                   {}};
  table.rows = {checked_row("N", "3", lod.samples, 0, "inconsistent"),
                checked_row("L", kNotPrinted, lod.anisotropy / kLog2One, 3, "wrong"),
                checked_row("l", kNotPrinted, lod.l / kLog2One, 3, "wrong")};
  return table;
}

// ---- section 3: synthesis results ---------------------------------------------------------------

struct Synthesis {
  double flip_flops = 0, look_up_tables = 0;
};

// Our RTL of preset `paper` on the same family (xc7): the sum of these modules; absent if a row of
// docs/measurements/cost.json was not mapped.
std::optional<Synthesis> mapped(std::span<const std::string_view> modules) {
  using Json = nlohmann::json;
  constexpr std::array<std::string_view, 3> kPaper = {"VAddressPaper", "VCacheDefault",
                                                      "VFilterPaper"};
  const Json cost = Json::parse(tool::embedded::mapped_json());
  Synthesis sum;
  std::size_t found = 0;
  for (const Json& unit : cost.at("units")) {
    const Json& names = unit.at("configurations");
    const auto is_paper = [&](std::string_view name) {
      return std::find(names.begin(), names.end(), name) != names.end();
    };
    if (std::none_of(kPaper.begin(), kPaper.end(), is_paper) ||
        std::find(modules.begin(), modules.end(), unit.at("unit")) == modules.end())
      continue;
    const Json& row = unit.at("xc7");
    if (!row.is_object()) return std::nullopt;
    sum.flip_flops += row.at("flip_flops").get<double>();
    sum.look_up_tables += row.at("luts").get<double>();
    ++found;
  }
  if (found != modules.size()) return std::nullopt;
  return sum;
}

PaperTable synthesis() {
  constexpr std::array<std::string_view, 3> kWhole = {"address_unit", "texture_cache",
                                                      "filter_pipeline"};
  // Without descriptors, links and cache.
  constexpr std::array<std::string_view, 7> kCore = {
      "derivative_unit", "footprint_unit",  "log2_unit",      "level_unit",
      "sample_walker",   "texel_addresser", "filter_pipeline"};
  const std::optional<Synthesis> whole = mapped(kWhole), core = mapped(kCore);
  PaperTable table{
      "Tables 3 and 4: synthesis, and the clock on the board",
      "Zynq ZC706, and Design Compiler for 0.13 μm of SMIC. Ours: preset paper, mapped by "
      "yosys to the same FPGA family, not placed; \"core\" is without descriptors, links "
      "and cache. Our times are quoted for the paper's 166.67 MHz; it is not shown that "
      "our unit reaches this frequency.",
      {"item", "paper", "ours", "core", "why", "verdict"},
      {}};
  const auto absent = [&](const char* item, const char* paper, const char* why) {
    table.rows.push_back(
        {item, paper, kNotPrinted, kNotPrinted, why, verdict(paper, std::nullopt, "other")});
  };
  const auto compared = [&](const char* item, const char* paper, double Synthesis::*figure,
                            const char* why) {
    if (!whole || !core)
      return absent(item, paper, "a row of docs/measurements/cost.json is not mapped");
    table.rows.push_back({item, paper, decimals(*whole.*figure, 0), decimals(*core.*figure, 0), why,
                          "not comparable"});
  };
  // Fractions of the board's resources: the paper's own arithmetic, which needs no synthesis.
  const auto share = [&](const char* item, const char* paper, double used, double there) {
    const double percent = 100 * used / there;
    table.rows.push_back({item, paper, decimals(percent, 2), kNotPrinted, kNotPrinted,
                          verdict(paper, percent, "other")});
  };
  constexpr const char* kNoTop = "pins belong to a synthesised top level";
  constexpr const char* kNoClock = "yosys reports no reliable delays of an FPGA, and no wires";
  compared("FF", "672", &Synthesis::flip_flops,
           "the paper does not say which bit widths, descriptors and texture memory these contain");
  share("FF, % of 437 200", "0.15", 672, 437200);
  compared("LUT", "3 357", &Synthesis::look_up_tables,
           "tags and descriptors of ours are logic; small memories become LUTs");
  share("LUT, % of 218 600", "1.54", 3357, 218600);
  absent("I/O", "147", kNoTop);
  share("I/O, % of 362", "40.61", 147, 362);
  absent("BUFG", "1", kNoTop);
  share("BUFG, % of 32", "3.12", 1, 32);
  absent("clock on the board, MHz", "50", kNoClock);
  absent("clock of the ASIC, MHz", "166.67",
         "the library of 0.13 μm is not available; docs/measurements/cost.md has 180 nm");
  absent("power, mW", "54", "no activity of its nets, and not this library");
  absent("area, μm²", "1 846 160.13",
         "not this library; about 12 times the logic of Table 3, so it must contain memories");
  return table;
}

// ---- effect of the approximations on levels and counts ------------------------------------------

struct Flips {
  std::uint64_t fragments = 0, counts = 0;
  double percent() const {
    return fragments ? 100.0 * static_cast<double>(counts) / static_cast<double>(fragments) : 0;
  }
};

// Counts how often N differs from exact arithmetic on the fragments of a scene.
Flips count_flips(const TextureScene& scene, const spec::texture::Parameters& parameters) {
  const gold::TextureGolden golden = tb::make_golden(scene, parameters);
  Flips flips;
  for (const spec::texture::Quad& quad : scene.stream().quads) {
    const spec::texture::Descriptor& d = golden.texture(quad.texture);
    for (int lane = 0; lane < 4; ++lane) {
      if (!(quad.coverage >> lane & 1)) continue;
      const ideal::LevelOfDetail exact = ideal::level_of_detail(
          parameters, d, ideal::pixel_footprint(quad, lane, d.width, d.height));
      ++flips.fragments;
      flips.counts += exact.samples != golden.analyse(quad, lane).lod.samples;
    }
  }
  return flips;
}

std::vector<TextureScene> reference_scenes(int size) {
  std::vector<TextureScene> scenes;
  for (const char* name : {"plane", "quad", "tunnel"}) {
    tb::SceneParameters scene;
    scene.source = name;
    scene.width = scene.height = size;
    scenes.emplace_back(scene, tb::SamplerParameters{}, 1);
  }
  return scenes;
}

PaperTable design_space(const std::vector<TextureScene>& scenes, const PaperOptions& options,
                        tb::Progress& progress) {
  PaperTable table{
      "Design space: error of each footprint and logarithm rule",
      "Level error of one side over log-uniform lengths and b/a uniform in [0, 1]; N over the "
      "fragments of three scenes. The first row is the paper's. Areas come from the area table.",
      {"footprint", "log2", "RMS level", "largest", "⌊l⌋ differs %", "N differs %, plane", "quad",
       "tunnel", "mean"},
      {}};
  std::uint64_t done = 0;
  for (std::size_t f = 0; f < spec::texture::kFootprintNames.size(); ++f) {
    for (std::size_t g = 0; g < spec::texture::kLog2Names.size(); ++g) {
      const auto rule = static_cast<FootprintRule>(f);
      const auto log2 = static_cast<Log2Rule>(g);
      const ideal::LevelError error = ideal::level_error([&](double a, double b) {
        const std::uint32_t side =
            gold::footprint_side(rule, static_cast<std::uint32_t>(std::lround(a * kSideOne)),
                                 static_cast<std::uint32_t>(std::lround(b * kSideOne)));
        return gold::log2_fixed(log2, side) / kLog2One;
      });
      spec::texture::Parameters parameters = papers_configuration();
      parameters.footprint = rule;
      parameters.log2 = log2;
      std::vector<std::string> row = {
          name_of(rule, spec::texture::kFootprintNames), name_of(log2, spec::texture::kLog2Names),
          decimals(error.root_mean_square, 4), decimals(error.largest, 4),
          decimals(100 * error.floor_mismatch, 2)};
      double sum = 0;
      for (const TextureScene& scene : scenes) {
        const double percent = count_flips(scene, parameters).percent();
        row.push_back(decimals(percent, 2));
        sum += percent;
        progress.update(++done);
        options.go_on();
      }
      row.push_back(decimals(sum / static_cast<double>(scenes.size()), 2));
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

// ---- picture quality ----------------------------------------------------------------------------

struct Gaussian {
  std::string_view name;
  ideal::EwaOptions options;
};
constexpr std::array<Gaussian, 3> kGaussians = {{{"whole", ideal::kEwaGaussian},
                                                 {"tapered", ideal::kEwaTapered},
                                                 {"cut", ideal::kEwaHeckbert}}};

// Every configuration against both references on the checkerboard ground plane.
PaperTable quality(const PaperOptions& options) {
  tb::SceneParameters scene_parameters;
  scene_parameters.source = "plane";
  scene_parameters.texture = "checker";
  scene_parameters.width = scene_parameters.height = options.size;
  TextureScene scene(scene_parameters, tb::SamplerParameters{}, 1);
  const tb::Texture& texture = scene.scene().mesh.textures.at(0);
  std::vector<std::uint8_t> texels;
  for (const tb::Rgba8& texel : texture.image.pixels)
    texels.insert(texels.end(), texel.begin(), texel.end());
  const ideal::TextureImage image(texture.image.width, texture.image.height, texels, texture.wrap_s,
                                  texture.wrap_t);
  const std::vector<ideal::PixelFootprint> footprints =
      ideal::pixel_footprints(scene.stream().quads, texture.image.width, texture.image.height);

  // In blocks, so that progress is shown.
  std::vector<ideal::Colour> box;
  std::array<std::vector<ideal::Colour>, kGaussians.size()> ewa;
  {
    tb::Progress progress("references", footprints.size(), "pixel", options.quiet);
    constexpr std::size_t kBlock = 4096;
    for (std::size_t i = 0; i < footprints.size(); i += kBlock) {
      const std::span<const ideal::PixelFootprint> block(footprints.data() + i,
                                                         std::min(kBlock, footprints.size() - i));
      for (const ideal::Colour& c : ideal::box_image(image, block)) box.push_back(c);
      for (std::size_t g = 0; g < kGaussians.size(); ++g)
        for (const ideal::Colour& c : ideal::ewa_image(image, block, kGaussians[g].options))
          ewa[g].push_back(c);
      progress.update(i + block.size());
      options.go_on();
    }
  }

  PaperTable table{
      "Picture quality: checkerboard ground plane, N_max = 16",
      fmt::format("PSNR over the {} textured pixels of {} x {}; box: the pixel's parallelogram "
                  "supersampled 32 x 32; EWA: exact elliptical Gaussians, whole (standard "
                  "deviation 0.35 pixel), tapered (0.37) and cut like Heckbert's (0.41): the "
                  "choice among them changes the figure more than any rule. Tents are spread over "
                  "1.6 x the axis; the last rows, with the paper's footprint and logarithm, use "
                  "other lengths. LOD error: mean |l - exact l| over the same pixels.",
                  footprints.size(), options.size, options.size),
      {"footprint", "log2", "count", "kernel", "spread", "samples a fragment", "LOD error",
       "box dB"},
      {}};
  for (const Gaussian& gaussian : kGaussians)
    table.columns.push_back(fmt::format("EWA {} dB", gaussian.name));
  // Every pair of configurations, then the spreads of the paper's own.
  std::vector<spec::texture::Parameters> variants;
  for (std::size_t f = 0; f < spec::texture::kFootprintNames.size(); ++f)
    for (std::size_t g = 0; g < spec::texture::kLog2Names.size(); ++g)
      for (const CountRule count : {CountRule::kFloor, CountRule::kCeil})
        for (const auto kernel : {spec::texture::Kernel::kBox, spec::texture::Kernel::kTent}) {
          spec::texture::Parameters p = papers_configuration();
          p.footprint = static_cast<FootprintRule>(f);
          p.log2 = static_cast<Log2Rule>(g);
          p.count = count;
          p.kernel = kernel;
          if (kernel == spec::texture::Kernel::kTent) p.spread = 102;  // 1.6 in 1/64
          variants.push_back(p);
        }
  for (const std::int32_t spread : {64, 77, 90, 112, 120, 128}) {
    spec::texture::Parameters p = papers_configuration();
    p.count = CountRule::kCeil;
    p.kernel = spec::texture::Kernel::kTent;
    p.spread = spread;
    variants.push_back(p);
  }

  tb::Progress progress("rules", variants.size(), "picture", options.quiet);
  for (const spec::texture::Parameters& p : variants) {
    const tb::GoldenFrame frame = tb::golden_frame(scene, p);
    const gold::TextureGolden golden = tb::make_golden(scene, p);
    double lod_error = 0;
    std::size_t i = 0;
    for (const spec::texture::Quad& quad : scene.stream().quads)
      for (int lane = 0; lane < 4; ++lane)
        if (quad.coverage >> lane & 1) {
          const double exact =
              ideal::level_of_detail(p, golden.texture(quad.texture), footprints[i++]).l;
          lod_error += std::fabs(golden.analyse(quad, lane).lod.l / kLog2One - exact);
        }
    std::vector<std::string> row = {
        name_of(p.footprint, spec::texture::kFootprintNames),
        name_of(p.log2, spec::texture::kLog2Names),
        name_of(p.count, spec::texture::kCountNames),
        name_of(p.kernel, spec::texture::kKernelNames),
        decimals(p.spread / 64.0, 2),
        decimals(
            static_cast<double>(frame.work.samples) / static_cast<double>(frame.work.fragments), 2),
        decimals(lod_error / static_cast<double>(footprints.size()), 4),
        decimals(ideal::psnr(box, frame.rgba), 2)};
    for (const std::vector<ideal::Colour>& reference : ewa)
      row.push_back(decimals(ideal::psnr(reference, frame.rgba), 2));
    table.rows.push_back(std::move(row));
    progress.update(table.rows.size());
    options.go_on();
  }
  return table;
}

// ---- a camera that turns ------------------------------------------------------------------------

// Each configuration over roll on one texture, and its cost.
PaperTable over_roll(const PaperOptions& options) {
  constexpr double kRolls[] = {0, 11.25, 22.5, 33.75, 45};
  struct Rule {
    const char* name;
    spec::texture::Parameters parameters;
    int lb_n_max = 4;
  };
  const auto own = [](Axes axes, CountRule count) {
    auto p = spec::texture::preset_parameters(spec::texture::Preset::kDeburr);
    p.axes = axes;
    p.count = count;
    return p;
  };
  const Rule configuration[] = {{"trilinear", papers_configuration(), 0},
                                {"the paper", papers_configuration()},
                                {"two, ceil", own(Axes::kTwo, CountRule::kCeil)},
                                {"four, floor", own(Axes::kFour, CountRule::kFloor)},
                                {"four, ceil", own(Axes::kFour, CountRule::kCeil)},
                                {"four, any (preset deburr)", own(Axes::kFour, CountRule::kAny)},
                                {"eight, any", own(Axes::kEight, CountRule::kAny)}};
  // Configurations were tuned on the first texture only.
  constexpr const char* kTextures[] = {"stones", "checker", "road", "brick"};
  const int size = std::min(options.size, 192);

  PaperTable table{
      "Over roll: the ground plane with the camera turned, N_max = 16",
      fmt::format("PSNR in dB against the supersampled box over {} x {} pixels; bilinears and line "
                  "fills of 64 bytes (16 KB, 2 ways) per fragment at 0 and at 45 degrees. The "
                  "paper takes row and column of the picture as the axes of the footprint: at 45 "
                  "degrees both are equally long, so N is 1 and the filter is trilinear. Rules "
                  "were chosen on `stones` alone; the other textures are out of sample.",
                  size, size),
      {"texture", "rules"},
      {}};
  for (const double roll : kRolls) table.columns.push_back(fmt::format("{}°", roll));
  for (const char* const column :
       {"worst", "bilinears, 0°", "bilinears, 45°", "fills, 0°", "fills, 45°"})
    table.columns.push_back(column);

  tb::Progress progress("over roll", std::size(kTextures) * std::size(kRolls), "picture",
                        options.quiet);
  std::uint64_t done = 0;
  for (const char* const texture_name : kTextures) {
    std::vector<std::vector<std::string>> rows;
    std::vector<double> worst(std::size(configuration), 1e9);
    std::vector<std::array<double, 4>> work(std::size(configuration));
    for (const Rule& rule : configuration) rows.push_back({texture_name, rule.name});
    for (const double roll : kRolls) {
      tb::SceneParameters scene_parameters;
      scene_parameters.source = "plane";
      scene_parameters.texture = texture_name;
      scene_parameters.texture_size = 512;
      scene_parameters.width = scene_parameters.height = size;
      scene_parameters.roll = roll;
      const TextureScene scene(scene_parameters, tb::SamplerParameters{}, 1);
      const tb::Texture& texture = scene.scene().mesh.textures.at(0);
      std::vector<std::uint8_t> texels;
      for (const tb::Rgba8& texel : texture.image.pixels)
        texels.insert(texels.end(), texel.begin(), texel.end());
      const ideal::TextureImage image(texture.image.width, texture.image.height, texels,
                                      texture.wrap_s, texture.wrap_t);
      const std::vector<ideal::Colour> reference = ideal::box_image(
          image,
          ideal::pixel_footprints(scene.stream().quads, texture.image.width, texture.image.height),
          24);
      for (std::size_t r = 0; r < std::size(configuration); ++r) {
        gold::TextureGolden golden = tb::make_golden(scene, configuration[r].parameters,
                                                     gold::TextureGolden::Traffic::kPredict);
        spec::texture::Descriptor descriptor = golden.texture(0);
        descriptor.max_anisotropy_log2 = static_cast<std::uint8_t>(configuration[r].lb_n_max);
        golden.set_texture(0, descriptor);
        std::vector<std::uint8_t> rgba;
        for (const spec::texture::Quad& quad : scene.stream().quads)
          for (const spec::texture::Colour& colour : golden.process(quad))
            rgba.insert(rgba.end(), colour.rgba.begin(), colour.rgba.end());
        const double decibels = ideal::psnr(reference, rgba);
        worst[r] = std::min(worst[r], decibels);
        rows[r].push_back(decimals(decibels, 1));
        const auto fragments = static_cast<double>(golden.work().fragments);
        const std::size_t end = roll == 0 ? 0 : 1;
        work[r][end] = static_cast<double>(golden.work().bilinears) / fragments;
        work[r][2 + end] = static_cast<double>(golden.work().line_fills) / fragments;
      }
      progress.update(++done);
      options.go_on();
    }
    for (std::size_t r = 0; r < std::size(configuration); ++r) {
      rows[r].push_back(decimals(worst[r], 1));
      for (std::size_t i = 0; i < 4; ++i) rows[r].push_back(decimals(work[r][i], i < 2 ? 1 : 3));
      table.rows.push_back(std::move(rows[r]));
    }
  }
  return table;
}

// ---- Figures 5 to 9 -----------------------------------------------------------------------------

tb::Image picture(const char* source, const char* texture, int texture_size, int size,
                  spec::texture::MinFilter mode, int lb_anisotropy) {
  tb::SceneParameters scene;
  scene.source = source;
  scene.texture = texture;
  scene.texture_size = texture_size;
  scene.width = scene.height = size;
  tb::SamplerParameters sampler;
  sampler.mode = mode;
  sampler.anisotropy = static_cast<std::uint8_t>(lb_anisotropy);
  if (mode == spec::texture::MinFilter::kNearest)
    sampler.magnification = spec::texture::MagFilter::kNearest;
  return tb::golden_frame(TextureScene(scene, sampler, 1), papers_configuration()).image;
}

std::vector<PaperFigure> figures(const PaperOptions& options) {
  const int size = options.size;
  tb::Waiting waiting("paper 004: pictures", options.quiet);
  const auto next = [&] {
    waiting.update();
    options.go_on();
  };
  std::vector<PaperFigure> all;
  constexpr int kRoad = 256;  // the paper's texture has 256 x 256 texels
  PaperFigure road{"Figure 5: the original road texture", "Ours is procedural.", {}};
  tb::SceneParameters scene;
  scene.source = "plane";
  scene.texture = "road";
  scene.texture_size = kRoad;
  scene.width = scene.height = 1;
  road.images.push_back(
      {"figure_5", "road", "256 x 256 texels",
       TextureScene(scene, tb::SamplerParameters{}, 1).scene().mesh.textures.at(0).image});
  all.push_back(std::move(road));

  PaperFigure modes{"Figure 6: the six modes of GL on the road texture",
                    "Bit-identical to the hardware model, without anisotropy as in the paper.",
                    {}};
  constexpr spec::texture::MinFilter kOrder[] = {// the paper's list
                                                 spec::texture::MinFilter::kLinear,
                                                 spec::texture::MinFilter::kLinearMipmapLinear,
                                                 spec::texture::MinFilter::kLinearMipmapNearest,
                                                 spec::texture::MinFilter::kNearest,
                                                 spec::texture::MinFilter::kNearestMipmapLinear,
                                                 spec::texture::MinFilter::kNearestMipmapNearest};
  std::vector<tb::Image> cells;
  for (const spec::texture::MinFilter mode : kOrder) {
    tb::Image image = picture("road", "road", kRoad, size, mode, 0);
    next();
    const std::string name = name_of(mode, spec::texture::kMinFilterNames);
    cells.push_back(image);
    modes.images.push_back({"figure_6_" + name, name, "", std::move(image)});
  }
  modes.images.push_back(
      {"figure_6_sheet", "all six on one sheet", "in the order above", tb::sheet(cells, 3), true});
  all.push_back(std::move(modes));

  PaperFigure checker{"Figures 7 and 8: checkerboard, nearest against trilinear, with zooms",
                      "The frame marks the part that is zoomed 8 times.",
                      {}};
  std::vector<tb::Image> zooms;
  const int part = size / 8;
  const int left = size / 2 - part / 2, top = size / 4;
  for (const auto& [mode, lb_n, title] :
       {std::tuple{spec::texture::MinFilter::kNearest, 0, "nearest"},
        std::tuple{spec::texture::MinFilter::kLinearMipmapLinear, 0, "trilinear"},
        std::tuple{spec::texture::MinFilter::kLinearMipmapLinear, 4, "trilinear, 16 samples"}}) {
    tb::Image image = picture("plane", "checker", 1024, size, mode, lb_n);
    next();
    zooms.push_back(zoom(crop(image, left, top, part, part), 8));
    draw_frame(image, left, top, part, part, {220, 40, 40, 255});
    checker.images.push_back(
        {fmt::format("figure_7_{}", checker.images.size()), title, "", std::move(image)});
  }
  checker.images.push_back({"figure_8", "zoomed", "nearest, trilinear, trilinear with 16 samples",
                            tb::sheet(zooms, 3), true});
  all.push_back(std::move(checker));

  PaperFigure object{"Figure 9: a textured object, trilinear", "", {}};
  object.images.push_back(
      {"figure_9", "trilinear", "like the paper",
       picture("object", "", 1024, size, spec::texture::MinFilter::kLinearMipmapLinear, 0)});
  object.images.push_back(
      {"figure_9_anisotropic", "trilinear, 16 samples", "",
       picture("object", "", 1024, size, spec::texture::MinFilter::kLinearMipmapLinear, 4)});
  all.push_back(std::move(object));
  return all;
}

}  // namespace

Paper build(const PaperOptions& options) {
  Paper paper{"004",
              "Hardware implementation of an anisotropic texture filter",
              "Xu, Du, Zeng and Wang, Journal of Computer-Aided Design & Computer Graphics, 2019",
              {},
              {}};
  paper.tables = {coefficients(), table_1(),  table_2(),  logarithm(),
                  equation_23(),  figure_1(), synthesis()};
  if (!options.quick) {
    const std::vector<TextureScene> scenes = reference_scenes(options.size);
    {
      tb::Progress progress(
          "design space",
          spec::texture::kFootprintNames.size() * spec::texture::kLog2Names.size() * scenes.size(),
          "scene", options.quiet);
      paper.tables.push_back(design_space(scenes, options, progress));
    }
    paper.tables.push_back(quality(options));
    paper.tables.push_back(over_roll(options));
  }
  paper.figures = figures(options);
  return paper;
}

}  // namespace deburr::studies::paper_004
