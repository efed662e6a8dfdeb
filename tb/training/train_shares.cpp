// SPDX-License-Identifier: MIT
// Trains the ROMs of learned shares, says how good they are on frames that they saw and on frames
// that they did not, and writes spec/morphological/learned_shares.h. Called by
// scripts/train-shares.
#include <fmt/format.h>

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
#include <string>
#include <string_view>
#include <vector>

#include "golden/morphological/configuration.h"
#include "golden/morphological/morphological_golden.h"
#include "spec/error.h"
#include "tb/base/atomic_file.h"
#include "tb/scene/quality.h"
#include "tb/training/share_trainer.h"
#include "tb/training/training_frames.h"

namespace deburr::tb::training {
namespace {

using golden::morphological::MorphologicalGolden;
using golden::morphological::preset_parameters;
using golden::morphological::ShareTables;
using spec::morphological::Parameters;
using spec::morphological::Preset;

struct Figures {
  double edges = 0, silhouettes = std::nan("");  // PSNR, dB
};

Image smoothed(const Image& frame, const Parameters& parameters, const ShareTables* tables) {
  MorphologicalGolden golden(parameters, MorphologicalGolden::Detail::kPixels);
  if (tables != nullptr) golden.set_share_tables(*tables);
  Image out(frame.width, frame.height);
  out.pixels = golden.process({frame.pixels, frame.width, frame.height});
  return out;
}

struct Checker {
  const TruthFrame& frame;
  Mask edges;
  std::optional<Mask> silhouettes;
  explicit Checker(const TruthFrame& f) : frame(f), edges(edge_mask(f.truth, f.frame)) {
    if (!f.depth.empty()) silhouettes = silhouette_mask(edges, f.depth);
  }
  Figures of(const Image& image) const {
    return {psnr(image, frame.truth, edges),
            silhouettes ? psnr(image, frame.truth, *silhouettes) : std::nan("")};
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

// A table with a row a frame: the other methods, then deburr with these tables.
void report(const std::string& title, const std::vector<const TruthFrame*>& frames,
            const std::function<const ShareTables&(const TruthFrame&)>& tables_of, bool brief) {
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
  for (const TruthFrame* frame : frames) {
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

// How much of what lies beside text changes by more than two codes, in percent.
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

void report_text(const std::vector<const TruthFrame*>& frames, const ShareTables& tables) {
  std::cout << "\nPixels beside text that is the same in frame and truth: changed by more than 2 "
               "codes, %; PSNR over edges of all\n\n| frame |";
  for (const Preset preset : kOthers) std::cout << ' ' << name_of(preset) << " |";
  std::cout << " deburr |\n|---|---|---|---|---|---|\n";
  for (const TruthFrame* frame : frames) {
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

template <class Table>
std::string listed(const Table& table) {
  std::string text, line = "   ";
  for (const std::int8_t v : table) {
    const std::string item = fmt::format(" {},", v);
    if (line.size() + item.size() > 100) {
      text += line + '\n';
      line = "   ";
    }
    line += item;
  }
  text += line;
  text.pop_back();
  return text;
}

std::uint32_t sum_of(const ShareTables& tables) {
  std::uint32_t sum = 0, index = 0;
  const auto add = [&](const auto& table) {
    for (const std::int8_t v : table) sum += ++index * static_cast<std::uint8_t>(v);
  };
  add(tables.of_codes);
  add(tables.of_near);
  add(tables.of_far);
  return sum;
}

std::string header_of(const ShareTables& tables, const std::string& recipe) {
  return fmt::format(
      R"(// SPDX-License-Identifier: MIT
// Contents of the ROMs of learned shares (docs/reference/morphological/learned_shares.md) as an
// engine is built with them. Written by scripts/train-shares; do not edit.
#pragma once

#include <array>
#include <cstdint>

namespace deburr::spec::morphological {{

// FNV-1a (64 bits) of the recipe that these were trained by.
inline constexpr std::uint64_t kSharesRecipe = 0x{:016x};

// Of all entries, as the register SHARES_SUM has it.
inline constexpr std::uint32_t kSharesSum = {};

// clang-format off
// A, S3.4: ((code_near * 4 + code_far) * 8 + D(d_near)) * 8 + D(d_far).
inline constexpr std::array<std::int8_t, 1024> kSharesOfCodes = {{
{}}};

// B, S3.4: (E_near * 8 + D(d_near)) * 4 + Lambda(L).
inline constexpr std::array<std::int8_t, 640> kSharesOfNear = {{
{}}};

// C, S3.4: (E_far * 8 + D(d_far)) * 4 + Lambda(L).
inline constexpr std::array<std::int8_t, 640> kSharesOfFar = {{
{}}};
// clang-format on

}}  // namespace deburr::spec::morphological
)",
      hash_of(recipe), sum_of(tables), listed(tables.of_codes), listed(tables.of_near),
      listed(tables.of_far));
}

using Samples = std::map<std::string, std::vector<ShareSample>>;

ShareTables trained(const std::vector<const TruthFrame*>& frames, const Samples& samples,
                    const Recipe& recipe) {
  std::vector<std::vector<ShareSample>> chosen;
  chosen.reserve(frames.size());
  for (const TruthFrame* frame : frames) chosen.push_back(samples.at(frame->name));
  return train(chosen, recipe);
}

int run(int argc, char** argv) {
  FrameOptions options;
  Recipe recipe;
  std::string write;
  int folds = 4;
  bool quiet = false, brief = false;
  CLI::App app("Trains the ROMs of learned shares and tests them");
  app.add_option("--data", options.data, "folder of meshes, kenney and frames");
  app.add_option("--cache", options.cache, "folder where rendered frames are kept");
  app.add_option("--write", write, "header to write");
  app.add_option("--folds", folds, "trainings that test the training frames themselves");
  app.add_option("--batches", recipe.batches, "");
  app.add_option("--rate", recipe.rate, "");
  app.add_option("--decay", recipe.decay, "");
  app.add_option("--seed", recipe.seed, "");
  app.add_option("--shapes", options.shapes, "frames of plain shapes");
  app.add_option("--overlays", options.overlays, "training frames that come once more with text");
  app.add_option("--views", options.views, "of each mesh to be trained on");
  app.add_option("--axis", recipe.axis_slope, "");
  app.add_flag("--brief", brief, "of the training frames, only means and where deburr is worse");
  app.add_flag("--quiet", quiet, "no progress");
  CLI11_PARSE(app, argc, argv);
  if (!quiet) options.progress = [](const std::string& name) { std::cerr << "\r\x1b[K" << name; };

  std::vector<TruthFrame> training = own_frames(options);
  for (TruthFrame& frame : mesh_frames(options)) training.push_back(std::move(frame));
  for (int i = 0; i < options.overlays; ++i)
    training.push_back(overlaid(training[static_cast<std::size_t>(i * 7) % 100]).frame);
  const std::vector<TruthFrame> held_out = held_out_frames(options);
  Samples samples;
  std::string names;
  std::vector<const TruthFrame*> all;
  std::vector<std::string> groups;
  for (const TruthFrame& frame : training) {
    std::vector<ShareSample> found = samples_of(frame);
    if (found.empty()) continue;
    samples[frame.name] = std::move(found);
    all.push_back(&frame);
    names += ' ' + frame.name;
    if (std::find(groups.begin(), groups.end(), frame.group) == groups.end())
      groups.push_back(frame.group);
  }
  if (!quiet) std::cerr << '\n';
  const std::string text = recipe.text() + " frames:" + names;
  std::cout << text << '\n';
  const ShareTables tables = trained(all, samples, recipe);
  if (!write.empty()) write_file_atomically(write, header_of(tables, text));

  report(
      "Trained on (in sample)", all,
      [&](const TruthFrame&) -> const ShareTables& { return tables; }, brief);
  if (!held_out.empty()) {
    std::vector<const TruthFrame*> others;
    others.reserve(held_out.size());
    for (const TruthFrame& frame : held_out) others.push_back(&frame);
    report_text({others.begin(), others.begin() + std::min<std::ptrdiff_t>(8, std::ssize(others))},
                tables);
    report(
        "Held out", others, [&](const TruthFrame&) -> const ShareTables& { return tables; }, false);
  }
  if (folds < 2) return 0;
  // Every group is measured with tables that were trained on the groups of the other folds.
  const auto fold_of = [&](const TruthFrame& frame) {
    return static_cast<int>(std::find(groups.begin(), groups.end(), frame.group) - groups.begin()) %
           folds;
  };
  std::vector<ShareTables> by_fold;
  for (int fold = 0; fold < folds; ++fold) {
    std::vector<const TruthFrame*> others;
    for (const TruthFrame* frame : all)
      if (fold_of(*frame) != fold) others.push_back(frame);
    by_fold.push_back(trained(others, samples, recipe));
  }
  report(
      fmt::format("The same frames, by tables trained without their meshes ({} folds)", folds), all,
      [&](const TruthFrame& frame) -> const ShareTables& {
        return by_fold[static_cast<std::size_t>(fold_of(frame))];
      },
      brief);
  return 0;
}

}  // namespace
}  // namespace deburr::tb::training

int main(int argc, char** argv) {
  try {
    return deburr::tb::training::run(argc, argv);
  } catch (const deburr::spec::Error& error) {
    std::cerr << error.what() << '\n';
    return static_cast<int>(error.code());
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return static_cast<int>(deburr::spec::ExitCode::kSimulation);
  }
}
