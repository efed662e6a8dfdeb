// SPDX-License-Identifier: MIT
// Paper 004: Xu, Du, Zeng and Wang, Hardware implementation of an anisotropic texture filter, 2019.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

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
#include "tb/env/texture_scene.h"
#include "tb/papers/papers.h"
#include "tb/results/progress.h"
#include "tb/scene/compose.h"
#include "tb/scene/quality.h"

namespace deburr::tb {
namespace {

namespace ideal = golden::ideal;
namespace gold = golden::texture;
using spec::texture::FootprintRule;
using spec::texture::Log2Rule;

constexpr double kLog2One = 4096;   // S5.12
constexpr double kSideOne = 65536;  // U16.16
constexpr double kAlphas[] = {0.5, 0.25, 0.3284};

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
  table.rows = {
      {"c2", "1/3", decimals(c2, 6), std::fabs(c2 - 1.0 / 3) < 1e-9 ? "right" : "wrong"},
      {"c1", "0.219", decimals(c1, 6), verdict(0.219, 3, c1, "wrong")},
      {"c0", "0.0377", decimals(c0, 6), verdict(0.0377, 4, c0, "wrong")},
      {"α of the least error", "0.3284", decimals(best, 6), verdict(0.3284, 4, best, "wrong")}};
  return table;
}

PaperTable table_1() {
  PaperTable table{"Table 1: error of the side a + α b",
                   "The paper's figure is the mean square times 100, not a percentage of the side.",
                   {"α", "paper", "ours, mean square × 100", "ours, RMS %", "verdict"},
                   {}};
  const double paper[] = {1.16, 0.38, 0.18};
  for (int i = 0; i < 3; ++i) {
    const double square = ideal::mean_square_side_error(kAlphas[i]);
    table.rows.push_back({fmt::format("{}", kAlphas[i]), decimals(paper[i], 2),
                          decimals(100 * square, 4), decimals(100 * std::sqrt(square), 1),
                          verdict(paper[i], 2, 100 * square, "wrong")});
  }
  return table;
}

PaperTable table_2() {
  PaperTable table{"Table 2: error of the level from the side alone",
                   "Again the mean square times 100; RMS and largest error are in levels.",
                   {"α", "paper", "ours, mean square × 100", "RMS", "largest", "verdict"},
                   {}};
  const double paper[] = {1.60, 0.38, 0.28};
  for (int i = 0; i < 3; ++i) {
    const double square = ideal::mean_square_level_error(kAlphas[i]);
    table.rows.push_back({fmt::format("{}", kAlphas[i]), decimals(paper[i], 2),
                          decimals(100 * square, 4), decimals(std::sqrt(square), 3),
                          decimals(ideal::largest_level_error(kAlphas[i]), 3),
                          verdict(paper[i], 2, 100 * square, "wrong")});
  }
  return table;
}

// Equation 8 is said to be monotone over [0, π/4]: looks for its maximum.
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
          inside ? "wrong" : "right"};
}

// ---- section 1.4 and 1.5: logarithm and level ---------------------------------------------------

PaperTable logarithm() {
  const ideal::LogarithmError error = ideal::logarithm_error();
  PaperTable table{"Equation 13: lb x ≈ n + y", "", {"item", "paper", "ours", "verdict"}, {}};
  const auto row = [&](const char* item, double value, int digits) {
    table.rows.push_back(
        {item, "3.12", decimals(value, digits), verdict(3.12, 2, value, "irreproducible")});
  };
  row("mean square × 100", 100 * error.mean_square, 3);
  row("RMS × 100", 100 * error.root_mean_square, 2);
  row("mean × 100", 100 * error.mean, 2);
  row("largest × 100", 100 * error.largest, 2);
  table.rows.push_back({"y of the largest", "-", decimals(error.at, 4), "added"});
  // (1 + 2 s1)(1 + k/2) over the domain; lb(1 + u) ≈ u needs u < 1.
  const double argument = (1 + 2 * 0.5) * (1 + 0.5 * 1.0);
  table.rows.push_back({"equation 17: lb(1 + u) ≈ u, largest argument 1 + u", "below 2",
                        decimals(argument, 1), argument < 2 ? "right" : "wrong"});
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
  // The unit's own integers over the same domain, and over lengths spread evenly in the logarithm.
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
      {"the double integral", "0.0704", decimals(area, 6), verdict(0.0704, 4, area, "wrong")},
      {"its closed form asinh 1 − 2 ln 1.5", "-", decimals(closed, 6), "added"},
      {"as a probability", "0.07", decimals(probability, 4),
       verdict(0.07, 2, probability, "unnormalised")},
      {"measured on the unit's integers, s1 uniform", "0.07", decimals(measured(false), 4),
       verdict(0.07, 2, measured(false), "unnormalised")},
      {"the same, lengths log-uniform", "-", decimals(measured(true), 4), "added"}};
  return table;
}

PaperTable figure_1() {
  // Sides (6, 3) and (1, 2) texels: d_x = 3 sqrt 5, d_y = sqrt 5, as printed.
  spec::texture::Parameters parameters;
  spec::texture::Descriptor descriptor;
  descriptor.width = descriptor.height = 1024;
  descriptor.levels = 11;
  descriptor.max_anisotropy_log2 = 4;
  const auto texels = [](int value) { return static_cast<std::uint32_t>(value) << 16; };
  const gold::Footprint f =
      gold::footprint(FootprintRule::kHalf, texels(6), texels(3), texels(1), texels(2));
  const gold::LevelOfDetail lod =
      gold::select_level(parameters, descriptor, gold::log2_fixed(Log2Rule::kMitchell, f.d_max),
                         gold::log2_fixed(Log2Rule::kMitchell, f.d_min));
  PaperTable table{"Figure 1: a footprint of 3√5 by √5 texels",
                   "The figure shows the ratio 3; the rule of section 1.3 is N = 2^⌊L⌋.",
                   {"item", "paper", "ours", "verdict"},
                   {}};
  table.rows = {
      {"N", "3", std::to_string(lod.samples()), lod.samples() == 3 ? "right" : "inconsistent"},
      {"L", "-", decimals(lod.anisotropy / kLog2One, 3), "added"},
      {"l", "-", decimals(lod.l / kLog2One, 3), "added"}};
  return table;
}

// ---- what the approximations do to levels and counts --------------------------------------------

struct Flips {
  std::uint64_t fragments = 0, counts = 0;
  double percent() const {
    return fragments ? 100.0 * static_cast<double>(counts) / static_cast<double>(fragments) : 0;
  }
};

// How often N differs from exact arithmetic on the fragments of a scene.
Flips count_flips(const TextureScene& scene, const spec::texture::Parameters& parameters) {
  const gold::TextureGolden golden = make_golden(scene, parameters);
  Flips flips;
  for (const spec::texture::Quad& quad : scene.stream().quads) {
    const spec::texture::Descriptor& d = golden.texture(quad.texture);
    for (int lane = 0; lane < 4; ++lane) {
      if (!(quad.coverage >> lane & 1)) continue;
      const ideal::LevelOfDetail exact = ideal::level_of_detail(
          parameters, d, ideal::pixel_footprint(quad, lane, d.width, d.height));
      ++flips.fragments;
      flips.counts += exact.lb_n != golden.analyse(quad, lane).lod.lb_n;
    }
  }
  return flips;
}

std::vector<TextureScene> reference_scenes(int size) {
  std::vector<TextureScene> scenes;
  for (const char* name : {"plane", "quad", "tunnel"}) {
    SceneParameters scene;
    scene.source = name;
    scene.width = scene.height = size;
    scenes.emplace_back(scene, SamplerParameters{}, 1);
  }
  return scenes;
}

PaperTable design_space(const std::vector<TextureScene>& scenes, const PaperOptions& options,
                        Progress& progress) {
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
      spec::texture::Parameters parameters;
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

// Every rule against both references on the checkerboard ground plane.
PaperTable quality(const PaperOptions& options) {
  SceneParameters scene_parameters;
  scene_parameters.source = "plane";
  scene_parameters.texture = "checker";
  scene_parameters.width = scene_parameters.height = options.size;
  TextureScene scene(scene_parameters, SamplerParameters{}, 1);
  const Texture& texture = scene.scene().mesh.textures.at(0);
  std::vector<std::uint8_t> texels;
  for (const Rgba8& texel : texture.image.pixels)
    texels.insert(texels.end(), texel.begin(), texel.end());
  const ideal::TextureImage image(texture.image.width, texture.image.height, texels, texture.wrap_s,
                                  texture.wrap_t);
  const std::vector<ideal::PixelFootprint> footprints =
      ideal::pixel_footprints(scene.stream().quads, texture.image.width, texture.image.height);

  // In blocks, so that progress is seen.
  std::vector<ideal::Colour> box;
  std::array<std::vector<ideal::Colour>, kGaussians.size()> ewa;
  {
    Progress progress("references", footprints.size(), "pixel");
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
      fmt::format(
          "PSNR over the {} textured pixels of {} x {}; box: the pixel's parallelogram "
          "supersampled 32 x 32; EWA: exact elliptical Gaussians, whole (standard deviation "
          "0.35 pixel), tapered (0.37) and cut as Heckbert's (0.41): which one is meant moves the "
          "figure more than any rule. Tents are spread over 1.6 x the axis, and at the end, for "
          "the paper's footprint and logarithm, over other lengths. "
          "LOD error: mean |l - exact l| over the same pixels.",
          footprints.size(), options.size, options.size),
      {"footprint", "log2", "count", "kernel", "spread", "samples a fragment", "LOD error",
       "box dB"},
      {}};
  for (const Gaussian& gaussian : kGaussians)
    table.columns.push_back(fmt::format("EWA {} dB", gaussian.name));
  // Of every pair of rules, then of the spreads of the paper's own.
  std::vector<spec::texture::Parameters> variants;
  for (std::size_t f = 0; f < spec::texture::kFootprintNames.size(); ++f)
    for (std::size_t g = 0; g < spec::texture::kLog2Names.size(); ++g)
      for (std::size_t c = 0; c < spec::texture::kCountNames.size(); ++c)
        for (std::size_t k = 0; k < spec::texture::kKernelNames.size(); ++k) {
          spec::texture::Parameters p;
          p.footprint = static_cast<FootprintRule>(f);
          p.log2 = static_cast<Log2Rule>(g);
          p.count = static_cast<spec::texture::CountRule>(c);
          p.kernel = static_cast<spec::texture::Kernel>(k);
          if (p.kernel == spec::texture::Kernel::kTent) p.spread = 102;  // 1.6 in 1/64
          variants.push_back(p);
        }
  for (const std::int32_t spread : {64, 77, 90, 112, 120, 128}) {
    spec::texture::Parameters p;
    p.count = spec::texture::CountRule::kCeil;
    p.kernel = spec::texture::Kernel::kTent;
    p.spread = spread;
    variants.push_back(p);
  }

  Progress progress("rules", variants.size(), "picture");
  for (const spec::texture::Parameters& p : variants) {
    const GoldenFrame frame = golden_frame(scene, p);
    const gold::TextureGolden golden = make_golden(scene, p);
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

// ---- Figures 5 to 9 -----------------------------------------------------------------------------

Image picture(const char* source, const char* texture, int texture_size, int size,
              spec::texture::MinFilter mode, int lb_anisotropy) {
  SceneParameters scene;
  scene.source = source;
  scene.texture = texture;
  scene.texture_size = texture_size;
  scene.width = scene.height = size;
  SamplerParameters sampler;
  sampler.mode = mode;
  sampler.anisotropy = static_cast<std::uint8_t>(lb_anisotropy);
  if (mode == spec::texture::MinFilter::kNearest)
    sampler.magnification = spec::texture::MagFilter::kNearest;
  return golden_frame(TextureScene(scene, sampler, 1), spec::texture::Parameters{}).image;
}

std::vector<PaperFigure> figures(int size) {
  std::vector<PaperFigure> all;
  constexpr int kRoad = 256;  // the paper's texture has 256 x 256 texels
  PaperFigure road{"Figure 5: the original road texture", "Ours is made by formula.", {}};
  SceneParameters scene;
  scene.source = "plane";
  scene.texture = "road";
  scene.texture_size = kRoad;
  scene.width = scene.height = 1;
  road.images.push_back(
      {"figure_5", "road", "256 x 256 texels",
       TextureScene(scene, SamplerParameters{}, 1).scene().mesh.textures.at(0).image});
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
  std::vector<Image> cells;
  for (const spec::texture::MinFilter mode : kOrder) {
    Image image = picture("road", "road", kRoad, size, mode, 0);
    const std::string name = name_of(mode, spec::texture::kMinFilterNames);
    cells.push_back(image);
    modes.images.push_back({"figure_6_" + name, name, "", std::move(image)});
  }
  modes.images.push_back(
      {"figure_6_sheet", "all six on one sheet", "in the order above", sheet(cells, 3), true});
  all.push_back(std::move(modes));

  PaperFigure checker{"Figures 7 and 8: checkerboard, nearest against trilinear, with zooms",
                      "The frame marks the part that is zoomed 8 times.",
                      {}};
  std::vector<Image> zooms;
  const int part = size / 8;
  const int left = size / 2 - part / 2, top = size / 4;
  for (const auto& [mode, lb_n, title] :
       {std::tuple{spec::texture::MinFilter::kNearest, 0, "nearest"},
        std::tuple{spec::texture::MinFilter::kLinearMipmapLinear, 0, "trilinear"},
        std::tuple{spec::texture::MinFilter::kLinearMipmapLinear, 4, "trilinear, 16 samples"}}) {
    Image image = picture("plane", "checker", 1024, size, mode, lb_n);
    zooms.push_back(zoom(crop(image, left, top, part, part), 8));
    draw_frame(image, left, top, part, part, {220, 40, 40, 255});
    checker.images.push_back(
        {fmt::format("figure_7_{}", checker.images.size()), title, "", std::move(image)});
  }
  checker.images.push_back({"figure_8", "zoomed", "nearest, trilinear, trilinear with 16 samples",
                            sheet(zooms, 3), true});
  all.push_back(std::move(checker));

  PaperFigure object{"Figure 9: a textured object, trilinear", "", {}};
  object.images.push_back(
      {"figure_9", "trilinear", "as the paper",
       picture("object", "", 1024, size, spec::texture::MinFilter::kLinearMipmapLinear, 0)});
  object.images.push_back(
      {"figure_9_anisotropic", "trilinear, 16 samples", "",
       picture("object", "", 1024, size, spec::texture::MinFilter::kLinearMipmapLinear, 4)});
  all.push_back(std::move(object));
  return all;
}

}  // namespace

Paper paper_004(const PaperOptions& options) {
  Paper paper{"004",
              "Hardware implementation of an anisotropic texture filter",
              "Xu, Du, Zeng and Wang, Journal of Computer-Aided Design & Computer Graphics, 2019",
              {},
              {}};
  paper.tables = {coefficients(), table_1(), table_2(), logarithm(), equation_23(), figure_1()};
  if (!options.quick) {
    const std::vector<TextureScene> scenes = reference_scenes(options.size);
    {
      Progress progress(
          "design space",
          spec::texture::kFootprintNames.size() * spec::texture::kLog2Names.size() * scenes.size(),
          "scene");
      paper.tables.push_back(design_space(scenes, options, progress));
    }
    paper.tables.push_back(quality(options));
  }
  paper.figures = figures(options.size);
  return paper;
}

}  // namespace deburr::tb
