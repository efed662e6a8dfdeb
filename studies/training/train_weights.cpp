// SPDX-License-Identifier: MIT
// Trains the ROMs of learned weights, reports their quality on training frames and on held-out
// frames, and writes spec/morphological/learned_weights.h and its recipe. Called by
// scripts/train-weights.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <functional>
#include <iostream>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "golden/morphological/configuration.h"
#include "golden/morphological/morphological_golden.h"
#include "spec/error.h"
#include "studies/training/recipe.h"
#include "studies/training/training_frames.h"
#include "studies/training/weight_trainer.h"
#include "tb/base/atomic_file.h"
#include "tb/base/file.h"
#include "tb/base/terminal.h"
#include "tb/scene/quality.h"
#include "tb/stimuli/weight_file.h"

namespace deburr::studies::training {

using tb::Image;

namespace {

using golden::morphological::MorphologicalGolden;
using golden::morphological::preset_parameters;
using golden::morphological::WeightTables;
using spec::morphological::Parameters;
using spec::morphological::Preset;

struct Figures {
  double edges = 0, silhouettes = std::nan("");  // PSNR, dB
};

Image smoothed(const Image& frame, const Parameters& parameters, const WeightTables* tables) {
  MorphologicalGolden golden(parameters, MorphologicalGolden::Detail::kPixels);
  if (tables != nullptr) golden.set_weight_tables(*tables);
  Image out(frame.width, frame.height);
  out.pixels = golden.process({frame.pixels, frame.width, frame.height});
  return out;
}

struct Checker {
  const ReferenceFrame& frame;
  tb::Mask edges;
  std::optional<tb::Mask> silhouettes;
  explicit Checker(const ReferenceFrame& f) : frame(f), edges(tb::edge_mask(f.reference, f.frame)) {
    if (!f.depth.empty()) silhouettes = tb::silhouette_mask(edges, f.depth);
  }
  Figures of(const Image& image) const {
    return {psnr(image, frame.reference, edges),
            silhouettes ? psnr(image, frame.reference, *silhouettes) : std::nan("")};
  }
};

std::string shown(const Figures& f) {
  return std::isnan(f.silhouettes) ? fmt::format("{:.2f}", f.edges)
                                   : fmt::format("{:.2f} / {:.2f}", f.edges, f.silhouettes);
}

constexpr std::array kOthers = {Preset::kMlaa, Preset::kSmaa, Preset::kSmaaDynamic,
                                Preset::kDeburrLine};

std::string_view name_of(Preset preset) {
  return spec::morphological::kPresetNames[static_cast<std::size_t>(preset)];
}

// A table with one row per frame: the other methods, then deburr with these tables.
void report(const std::string& title, const std::vector<const ReferenceFrame*>& frames,
            const std::function<const WeightTables&(const ReferenceFrame&)>& tables_of,
            bool brief) {
  std::string head = fmt::format("\n{}\n\n| frame | none |", title), line = "|---|---|";
  for (const Preset preset : kOthers) {
    head += fmt::format(" {} |", name_of(preset));
    line += "---|";
  }
  std::cout << head << " deburr |\n" << line << "---|\n";
  std::vector<Figures> sums;
  std::vector<int> silhouettes;
  const Parameters deburr = preset_parameters(Preset::kDeburr);
  int worse = 0;
  for (const ReferenceFrame* frame : frames) {
    const Checker checker(*frame);
    std::vector<Figures> row = {checker.of(frame->frame)};
    for (const Preset preset : kOthers)
      row.push_back(checker.of(smoothed(frame->frame, preset_parameters(preset), nullptr)));
    row.push_back(checker.of(smoothed(frame->frame, deburr, &tables_of(*frame))));
    sums.resize(row.size(), {0, 0});
    silhouettes.resize(row.size());
    std::string text = "| " + frame->name + " |";
    bool best = true;
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += fmt::format(" {} |", shown(row[i]));
      sums[i].edges += row[i].edges;
      if (!std::isnan(row[i].silhouettes)) {
        sums[i].silhouettes += row[i].silhouettes;
        ++silhouettes[i];
      }
      best = best && !(row[i].edges > row.back().edges) &&
             !(row[i].silhouettes > row.back().silhouettes);
    }
    if (!best) ++worse;
    if (!brief || !best) std::cout << text << (best ? "" : " worse") << '\n' << std::flush;
  }
  std::string text = "| mean |";
  for (std::size_t i = 0; i < sums.size(); ++i) {
    sums[i].edges /= static_cast<double>(frames.size());
    sums[i].silhouettes /= silhouettes[i];
    text += fmt::format(" {} |", shown(sums[i]));
  }
  std::cout << text << "\n\nworse than another method on " << worse << " of " << frames.size()
            << " frames\n";
}

// Pixels next to text that change by more than two codes, in percent.
double changed_beside_text(const Overlaid& text, const Image& image) {
  const Image& before = text.frame.frame;
  std::int64_t beside = 0, changed = 0;
  for (int y = 1; y + 1 < before.height; ++y) {
    for (int x = 1; x + 1 < before.width; ++x) {
      const auto ink = [&](int dx, int dy) { return text.ink.at(x + dx, y + dy); };
      const int own = ink(0, 0);
      if (ink(1, 0) == own && ink(-1, 0) == own && ink(0, 1) == own && ink(0, -1) == own) continue;
      ++beside;
      int most = 0;
      for (std::size_t c = 0; c < 3; ++c)
        most = std::max(most, std::abs(image.at(x, y)[c] - before.at(x, y)[c]));
      changed += most > 2;
    }
  }
  return 100.0 * static_cast<double>(changed) / static_cast<double>(beside);
}

void report_text(const std::vector<const ReferenceFrame*>& frames, const WeightTables& tables) {
  std::cout << "\nPixels next to text that is the same in frame and reference: changed by more "
               "than 2 codes, %; PSNR over edges of all\n\n| frame |";
  for (const Preset preset : kOthers) std::cout << ' ' << name_of(preset) << " |";
  std::cout << " deburr |\n|---|---|---|---|---|---|\n";
  for (const ReferenceFrame* frame : frames) {
    const Overlaid text = overlaid(*frame);
    std::cout << "| " << text.frame.name << " |";
    const auto show = [&](const Image& image) {
      std::cout << fmt::format(" {:.1f}; {:.2f} |", changed_beside_text(text, image),
                               Checker(text.frame).of(image).edges);
    };
    for (const Preset preset : kOthers)
      show(smoothed(text.frame.frame, preset_parameters(preset), nullptr));
    show(smoothed(text.frame.frame, preset_parameters(Preset::kDeburr), &tables));
    std::cout << '\n' << std::flush;
  }
}

using Samples = std::map<std::string, std::vector<WeightSample>>;

WeightTables trained(const std::vector<const ReferenceFrame*>& frames, const Samples& samples,
                     const Recipe& recipe) {
  std::vector<std::vector<WeightSample>> chosen;
  chosen.reserve(frames.size());
  for (const ReferenceFrame* frame : frames) chosen.push_back(samples.at(frame->name));
  return train(chosen, recipe);
}

// Triangles by their corners, rounded to 1e-5 units: parts shared by two meshes of one kit have the
// same coordinates.
std::set<std::array<std::int64_t, 9>> triangles_of(const tb::Mesh& mesh) {
  std::set<std::array<std::int64_t, 9>> found;
  for (const tb::Triangle& triangle : mesh.triangles) {
    std::array<std::array<std::int64_t, 3>, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        corners[i][c] =
            std::llround(1e5 * mesh.vertices[triangle.vertex[i]].position[static_cast<int>(c)]);
    std::sort(corners.begin(), corners.end());
    std::array<std::int64_t, 9> key{};
    for (std::size_t i = 0; i < 9; ++i) key[i] = corners[i / 3][i % 3];
    found.insert(key);
  }
  return found;
}

// The fraction of each held-out mesh that was trained on too.
void report_overlap(const std::vector<FrameSource>& trained_on,
                    const std::vector<FrameSource>& held_out) {
  std::set<std::array<std::int64_t, 9>> seen;
  std::set<std::string> groups;
  for (const FrameSource& source : trained_on)
    if (source.mesh && groups.insert(source.group).second) seen.merge(triangles_of(source.mesh()));
  std::cout << "\nHeld-out meshes: number of triangles, and how many of them a training mesh has "
               "at the same position\n\n| mesh | triangles | trained on |\n|---|---|---|\n";
  for (const FrameSource& source : held_out) {
    if (!source.mesh) continue;
    const auto own = triangles_of(source.mesh());
    const auto common = std::count_if(own.begin(), own.end(),
                                      [&](const auto& each) { return seen.contains(each); });
    std::cout << fmt::format("| {} | {} | {} % |\n", source.group, own.size(),
                             100 * common / std::ssize(own));
  }
}

int run(int argc, char** argv) {
  FrameOptions options;
  Recipe recipe;
  std::string write, check;
  int folds = 4, overlays = 0;
  bool quiet = false, brief = false, meshes = false;
  CLI::App app("Train the ROMs of learned weights and test them");
  app.add_option("--data", options.data, "data folder with meshes/, kenney/ and frames/");
  app.add_option("--cache", options.cache, "folder that caches rendered frames");
  app.add_option("--write", write, "folder of the repository: writes ROMs and recipe");
  app.add_option("--check", check, "folder of the repository: compares them, byte for byte");
  app.add_option("--folds", folds, "folds of the cross-validation over the training frames");
  app.add_option("--batches", recipe.batches, "");
  app.add_option("--rate", recipe.rate, "");
  app.add_option("--decay", recipe.decay, "");
  app.add_option("--seed", recipe.seed, "");
  app.add_option("--axis", recipe.axis_slope, "");
  app.add_option("--overlays", overlays, "training frames that are added again with text");
  app.add_flag("--meshes", meshes, "also train on meshes of the data folder");
  app.add_flag("--brief", brief,
               "for training frames, print only means and the frames where deburr is worse");
  app.add_flag("--quiet", quiet, "no progress");
  CLI11_PARSE(app, argc, argv);
  const bool of_recipe = recipe.text() == Recipe().text() && overlays == 0 && !meshes;
  const bool kept = !write.empty() || !check.empty();
  if (kept && !of_recipe)
    throw spec::ConfigError(
        "--write and --check need the recipe's options: leave out --batches, --rate, --decay, "
        "--seed, --axis, --overlays, --meshes");
  if (kept && !options.cache.empty())
    throw spec::ConfigError("--write and --check render every frame: leave out --cache");

  std::vector<FrameSource> sources = training_set(options);
  if (meshes)
    for (FrameSource& source : mesh_set(options)) sources.push_back(std::move(source));
  const std::vector<FrameSource> held_out_sources =
      check.empty() ? held_out_set(options) : std::vector<FrameSource>();
  const bool overwrites = tb::takes_control_sequences(STDERR_FILENO);
  const auto made = [&](const FrameSource& source) {
    if (!quiet)
      std::cerr << (overwrites ? "\r\x1b[K" : "") << source.name << (overwrites ? "" : "\n");
    return source.make();
  };
  std::vector<ReferenceFrame> training;
  training.reserve(sources.size());
  for (const FrameSource& source : sources) training.push_back(made(source));
  for (int i = 0; i < overlays; ++i)
    training.push_back(overlaid(training[static_cast<std::size_t>(i) * 7 % sources.size()]).frame);
  Samples samples;
  std::vector<HashedFrame> hashed;
  std::vector<const ReferenceFrame*> all;
  std::vector<std::string> groups;
  for (const ReferenceFrame& frame : training) {
    std::vector<WeightSample> found = samples_of(frame);
    if (found.empty())
      throw spec::ConfigError(fmt::format("the frame '{}' has no edge to train on", frame.name));
    samples[frame.name] = std::move(found);
    all.push_back(&frame);
    hashed.emplace_back(frame.name, hash_of(frame));
    if (std::find(groups.begin(), groups.end(), frame.group) == groups.end())
      groups.push_back(frame.group);
  }
  const std::string text = recipe_text(recipe, options, hashed);
  if (!quiet)
    std::cerr << (overwrites ? "\r\x1b[K" : "") << "training on " << all.size() << " frames\n";
  const WeightTables tables = trained(all, samples, recipe);
  std::cout << fmt::format("recipe {:016x}, {} frames, sum of the weights {}\n", hash_of(text),
                           all.size(), tb::stimuli::sum_of(tables));
  constexpr const char *kHeader = "spec/morphological/learned_weights.h",
                       *kRecipe = "studies/training/recipe.txt";
  if (!write.empty())
    tb::write_files_atomically({{std::filesystem::path(write) / kHeader, header_of(tables, text)},
                                {std::filesystem::path(write) / kRecipe, text}});
  if (!check.empty()) {
    bool same = true;
    for (const auto& [file, made_again] :
         {std::pair(kHeader, header_of(tables, text)), std::pair(kRecipe, text)}) {
      const bool equal = tb::read_file(std::filesystem::path(check) / file, 1 << 20) == made_again;
      std::cout << file << (equal ? ": the same, byte for byte\n" : ": DIFFERENT\n");
      same = same && equal;
    }
    return same ? 0 : 1;
  }

  report(
      "Trained on (in sample)", all,
      [&](const ReferenceFrame&) -> const WeightTables& { return tables; }, brief);
  report_overlap(sources, held_out_sources);
  std::vector<ReferenceFrame> held_out;
  held_out.reserve(held_out_sources.size());
  for (const FrameSource& source : held_out_sources) held_out.push_back(made(source));
  std::vector<const ReferenceFrame*> others;
  others.reserve(held_out.size());
  for (const ReferenceFrame& frame : held_out) others.push_back(&frame);
  report_text({others.begin(), others.begin() + std::min<std::ptrdiff_t>(8, std::ssize(others))},
              tables);
  report(
      "Held out", others, [&](const ReferenceFrame&) -> const WeightTables& { return tables; },
      false);
  if (folds < 2) return 0;
  // Each group is measured with tables trained on the groups of the other folds.
  const auto fold_of = [&](const ReferenceFrame& frame) {
    return static_cast<int>(std::find(groups.begin(), groups.end(), frame.group) - groups.begin()) %
           folds;
  };
  std::vector<WeightTables> by_fold;
  for (int fold = 0; fold < folds; ++fold) {
    std::vector<const ReferenceFrame*> those;
    for (const ReferenceFrame* frame : all)
      if (fold_of(*frame) != fold) those.push_back(frame);
    by_fold.push_back(trained(those, samples, recipe));
  }
  report(
      fmt::format("The same frames, by tables trained without their groups ({} folds)", folds), all,
      [&](const ReferenceFrame& frame) -> const WeightTables& {
        return by_fold[static_cast<std::size_t>(fold_of(frame))];
      },
      brief);
  return 0;
}

}  // namespace
}  // namespace deburr::studies::training

int main(int argc, char** argv) {
  try {
    return deburr::studies::training::run(argc, argv);
  } catch (const deburr::spec::Error& error) {
    std::cerr << error.what() << '\n';
    return static_cast<int>(error.code());
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return static_cast<int>(deburr::spec::ExitCode::kSimulation);
  }
}
