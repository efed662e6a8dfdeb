// SPDX-License-Identifier: MIT
#include "studies/quality/harm.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "golden/morphological/configuration.h"
#include "golden/morphological/morphological_golden.h"
#include "spec/error.h"
#include "studies/training/stand_ins.h"
#include "tb/scene/flip.h"
#include "tb/scene/image_io.h"
#include "tb/scene/quality.h"
#include "tb/scene/reference.h"
#include "tb/scene/ssim.h"
#include "tb/stimuli/reference_filters.h"

namespace deburr::studies::harm {

using tb::Image;

namespace {

namespace fs = std::filesystem;
namespace m = spec::morphological;

constexpr int kWidth = 480, kHeight = 360;

// ---- filters ------------------------------------------------------------------------------------

struct Filter {
  std::string name;
  std::function<Image(const Image&)> apply;
};

Filter preset(std::string name, m::Preset which, m::Quality quality = m::Quality::kHigh,
              bool text_guard = false) {
  return {std::move(name), [which, quality, text_guard](const Image& image) {
            using golden::morphological::MorphologicalGolden;
            m::Parameters parameters = golden::morphological::preset_parameters(which, quality);
            parameters.text_guard = text_guard;
            MorphologicalGolden golden(parameters, MorphologicalGolden::Detail::kPixels);
            Image out = image;
            out.pixels = golden.process({image.pixels, image.width, image.height});
            return out;
          }};
}

// Filters of one sample per pixel.
std::vector<Filter> filters() {
  std::vector<Filter> all = {preset("mlaa", m::Preset::kMlaa)};
  for (const m::Quality quality : {m::Quality::kHigh, m::Quality::kUltra})
    all.push_back(
        preset(fmt::format("smaa {}", m::kQualityNames[static_cast<std::size_t>(quality)]),
               m::Preset::kSmaa, quality));
  for (const tb::stimuli::ReferenceFilter& reference : tb::stimuli::kReferenceFilters)
    all.push_back({reference.name, [filter = reference.filter](const Image& image) {
                     return filter(image, true);
                   }});
  all.push_back(preset("`deburr-line`", m::Preset::kDeburrLine));
  all.push_back(preset("`deburr`", m::Preset::kDeburr));
  return all;
}

// ---- measures -----------------------------------------------------------------------------------

struct Figures {
  double small = 0, large = 0;  // % of the correct pixels that change by more than 2 and 16 codes
  double psnr = 0, flip = 0, ssim = 0;
};

// Measured against the reference; without one, against the frame, which is then correct everywhere.
std::vector<Figures> measure(const Image& frame, const Image& reference,
                             std::span<const Image> smoothed) {
  const tb::Mask right = inverted(tb::edge_mask(reference, frame));
  const auto of_right = static_cast<double>(count(right));
  std::vector<const Image*> tests;
  for (const Image& image : smoothed) tests.push_back(&image);
  const std::vector<double> flips = tb::flip(reference, tests), similar = ssim(reference, tests);
  std::vector<Figures> all;
  for (std::size_t i = 0; i < tests.size(); ++i) {
    const auto changed = [&](int codes) {
      const auto pixels = static_cast<double>(tb::count_different(*tests[i], frame, right, codes));
      return 100 * pixels / of_right;
    };
    all.push_back({changed(2), changed(16), psnr(*tests[i], reference), flips[i], similar[i]});
  }
  return all;
}

std::vector<Image> smoothed_by(std::span<const Filter> filters, const Image& frame) {
  std::vector<Image> all;
  for (const Filter& filter : filters) all.push_back(filter.apply(frame));
  return all;
}

// ---- tables -------------------------------------------------------------------------------------

std::string percents(const Figures& f) { return fmt::format("{:.1f} / {:.1f}", f.small, f.large); }
std::string decibels(const Figures& f) {
  return std::isfinite(f.psnr) ? fmt::format("{:.2f}", f.psnr) : "-";
}
std::string both(const Figures& f) { return fmt::format("{:.3f} / {:.3f}", f.flip, f.ssim); }

std::string head(const std::vector<std::string>& titles) {
  std::string text = "|", line = "|";
  for (const std::string& title : titles) {
    text += title.empty() ? " |" : " " + title + " |";
    line += "---|";
  }
  return text + "\n" + line + "\n";
}

std::string row(const std::vector<std::string>& cells) {
  std::string text = "|";
  for (const std::string& cell : cells) text += " " + cell + " |";
  return text + "\n";
}

// A frame that needs no smoothing, and the output of every filter.
struct Checked {
  std::string name;
  std::vector<Figures> figures;
};

Checked checked(std::string name, const Image& frame, std::span<const Filter> filters) {
  return {std::move(name), measure(frame, frame, smoothed_by(filters, frame))};
}

std::string changed_table(std::span<const Filter> filters, std::span<const Checked> frames) {
  std::vector<std::string> titles = {""};
  for (const Filter& filter : filters) titles.push_back(filter.name);
  std::string text = "Pixels changed by more than 2 / 16 codes, %:\n\n" + head(titles);
  for (const Checked& frame : frames) {
    std::vector<std::string> cells = {frame.name};
    for (const Figures& figures : frame.figures) cells.push_back(percents(figures));
    text += row(cells);
  }
  return text + "\n";
}

std::string textured_table(std::span<const Filter> filters) {
  std::vector<std::string> titles = {""};
  std::vector<std::vector<std::string>> rows(filters.size() + 1);
  rows[0] = {"none"};
  for (std::size_t i = 0; i < filters.size(); ++i) rows[i + 1] = {filters[i].name};
  for (int view = 0; view < 3; ++view) {
    const Textured textured = textured_frame(view, 2 * kWidth, 2 * kHeight);
    std::vector<Image> images = smoothed_by(filters, textured.frame);
    images.insert(images.begin(), textured.frame);
    const std::vector<Figures> figures = measure(textured.frame, textured.reference, images);
    const auto right =
        static_cast<double>(count(inverted(tb::edge_mask(textured.reference, textured.frame))));
    titles.push_back(fmt::format("view {}, {:.1f} % correct: changed, %", view + 1,
                                 100 * right / static_cast<double>(textured.frame.pixels.size())));
    titles.insert(titles.end(), {"PSNR, dB", "FLIP / SSIM"});
    for (std::size_t i = 0; i < rows.size(); ++i)
      rows[i].insert(rows[i].end(), {percents(figures[i]), decibels(figures[i]), both(figures[i])});
  }
  std::string text = head(titles);
  for (const auto& cells : rows) text += row(cells);
  return text;
}

// ---- frames with reference ----------------------------------------------------------------------

struct Pair {
  Image frame, reference;
};

Pair rendered(const tb::Scene& scene, int width, int height) {
  tb::LitFrames lit = tb::render_lit_frames(scene, width, height, 8);
  return {std::move(lit.noaa), std::move(lit.reference)};
}

// A column: the mean over some frames.
struct Column {
  std::string title;
  std::vector<Pair> pairs;
};

std::string perceptual_table(std::span<const Filter> filters, std::span<const Column> columns) {
  std::vector<std::string> titles = {""};
  std::vector<std::vector<std::string>> rows(filters.size() + 1);
  rows[0] = {"none"};
  for (std::size_t i = 0; i < filters.size(); ++i) rows[i + 1] = {filters[i].name};
  for (const Column& column : columns) {
    std::vector<Figures> mean(rows.size());
    for (const Pair& pair : column.pairs) {
      std::vector<Image> images = smoothed_by(filters, pair.frame);
      images.insert(images.begin(), pair.frame);
      const std::vector<Figures> figures = measure(pair.frame, pair.reference, images);
      const auto frames = static_cast<double>(column.pairs.size());
      for (std::size_t i = 0; i < mean.size(); ++i) {
        mean[i].psnr += figures[i].psnr / frames;
        mean[i].flip += figures[i].flip / frames;
        mean[i].ssim += figures[i].ssim / frames;
      }
    }
    titles.push_back(column.title);
    for (std::size_t i = 0; i < rows.size(); ++i)
      rows[i].push_back(
          fmt::format("{:.2f}; {:.4f} / {:.4f}", mean[i].psnr, mean[i].flip, mean[i].ssim));
  }
  std::string text = head(titles);
  for (const auto& cells : rows) text += row(cells);
  return text + "\n";
}

std::vector<Pair> stand_ins() {
  const fs::path folder = fs::temp_directory_path() / fmt::format("deburr_harm_{}", ::getpid());
  fs::create_directories(folder);
  std::vector<Pair> all;
  for (const char* const kind : {"street", "vehicle", "forest"})
    for (const std::uint64_t seed : {1, 2, 3})
      all.push_back(rendered(tb::import_scene(write_stand_in(folder, kind, seed)), 512, 512));
  fs::remove_all(folder);
  return all;
}

// ---- the text guard -----------------------------------------------------------------------------

// Each preset without and with the guard.
constexpr std::array<m::Preset, 2> kGuardedPresets = {m::Preset::kDeburr, m::Preset::kSmaa};

std::vector<Filter> guarded_filters() {
  std::vector<Filter> all;
  for (const m::Preset which : kGuardedPresets) {
    const std::string name(m::kPresetNames[static_cast<std::size_t>(which)]);
    for (const bool on : {false, true}) all.push_back(preset(name, which, m::Quality::kHigh, on));
  }
  return all;
}

double guarded_percent(const Image& image) {
  const golden::morphological::TextGuard guard({image.pixels, image.width, image.height});
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) count += guard.at(x, y).guarded();
  return 100.0 * count / static_cast<double>(image.pixels.size());
}

std::vector<std::string> guard_head(const std::string& of_cells) {
  std::vector<std::string> titles = {"", "guarded, %"};
  for (const m::Preset which : kGuardedPresets) {
    const std::string_view name = m::kPresetNames[static_cast<std::size_t>(which)];
    titles.push_back(fmt::format("{}: {}", name, of_cells));
    titles.emplace_back("PSNR, dB");
  }
  return titles;
}

std::string of_right_frame_with_guard(const std::string& name, const Image& frame,
                                      std::span<const Filter> filters) {
  const std::vector<Figures> figures = measure(frame, frame, smoothed_by(filters, frame));
  std::vector<std::string> cells = {name, fmt::format("{:.1f}", guarded_percent(frame))};
  for (std::size_t i = 0; i < figures.size(); i += 2) {
    cells.push_back(fmt::format("{:.1f} > {:.1f}", figures[i].small, figures[i + 1].small));
    cells.push_back(fmt::format("{} > {}", decibels(figures[i]), decibels(figures[i + 1])));
  }
  return row(cells);
}

// Omits the sign if the value rounds to zero.
std::string difference(double decibels) {
  std::string text = fmt::format("{:.2f}", decibels);
  return text == "-0.00" ? "0.00" : text;
}

// For frames with a reference: change of PSNR over edges and over the frame when the guard is
// enabled, per preset for the frame that loses most; and the largest fraction of guarded pixels.
std::string worst_with_guard(const std::string& name, std::span<const Pair> pairs,
                             std::span<const Filter> filters) {
  double guarded = 0;
  std::vector<std::pair<double, double>> worst(kGuardedPresets.size(), {1000, 1000});
  for (const Pair& pair : pairs) {
    guarded = std::max(guarded, guarded_percent(pair.frame));
    const tb::Mask edges = tb::edge_mask(pair.reference, pair.frame);
    const std::vector<Image> smoothed = smoothed_by(filters, pair.frame);
    for (std::size_t i = 0; i < worst.size(); ++i) {
      const Image &without = smoothed[2 * i], &with = smoothed[2 * i + 1];
      worst[i].first = std::min(
          worst[i].first, psnr(with, pair.reference, edges) - psnr(without, pair.reference, edges));
      worst[i].second =
          std::min(worst[i].second, psnr(with, pair.reference) - psnr(without, pair.reference));
    }
  }
  std::vector<std::string> cells = {name, fmt::format("{:.2f}", guarded)};
  for (const auto& [over_edges, over_frame] : worst)
    cells.push_back(fmt::format("{} / {}", difference(over_edges), difference(over_frame)));
  return row(cells);
}

std::string guard_reference_head() {
  std::vector<std::string> titles = {"", "guarded, %"};
  for (const m::Preset which : kGuardedPresets)
    titles.emplace_back(m::kPresetNames[static_cast<std::size_t>(which)]);
  return head(titles);
}

// ---- data ---------------------------------------------------------------------------------------

constexpr std::array<const char*, 3> kPhotos = {"brick", "gravel", "grass"};
struct FramePair {
  const char *title, *frame, *reference;
};
constexpr std::array<FramePair, 2> kFrames = {
    {{"`track` 720p", "frames/track_720p_noaa.png", "frames/track_720p_ssaa256.png"},
     {"`track` 1080p", "frames/track_1080p_noaa.png", "frames/track_1080p_ssaa64.png"}}};
// Outside the training set; evaluated once (docs/measurements/morphological_quality.md, "Frames
// with a reference").
constexpr std::array<const char*, 17> kHeldOut = {"kenney/city/models/building-small-b.glb",
                                                  "kenney/city/models/building-small-d.glb",
                                                  "kenney/city/models/grass-trees.glb",
                                                  "kenney/city/models/grass.glb",
                                                  "kenney/city/models/pavement.glb",
                                                  "kenney/city/models/road-split.glb",
                                                  "kenney/city/models/road-straight.glb",
                                                  "kenney/city/models/road-corner.glb",
                                                  "kenney/city/models/road-intersection.glb",
                                                  "kenney/racing/models/track-corner.glb",
                                                  "kenney/racing/models/track-bump.glb",
                                                  "kenney/racing/models/track-straight.glb",
                                                  "kenney/racing/models/track-tents.glb",
                                                  "kenney/racing/models/vehicle-truck-purple.glb",
                                                  "kenney/racing/models/vehicle-truck-yellow.glb",
                                                  "kenney/racing/models/vehicle-truck-green.glb",
                                                  "kenney/racing/models/decoration-empty.glb"};

fs::path photo_file(const fs::path& data, const char* name) {
  return data / "textures" / (std::string(name) + ".png");
}

}  // namespace

std::string text_table(Text kind) {
  const std::vector<Filter> all = filters();
  const Checked page = checked("text, aliased", text_page(kind, kWidth, kHeight), all);
  return changed_table(all, {&page, 1});
}

std::string formula_tables() {
  const std::vector<Filter> all = filters();
  const Image hall = smoothed_hall(kWidth, kHeight);
  const std::vector<Checked> frames = {
      checked("synthetic photograph: landscape", landscape_photo(kWidth, kHeight), all),
      checked("synthetic photograph: foliage", foliage_photo(kWidth, kHeight), all),
      checked("smoothed hall", hall, all),
      checked("text, aliased", text_page(Text::kAliased, kWidth, kHeight), all),
      checked("text, smoothed", text_page(Text::kSmoothed, kWidth, kHeight), all),
      checked("text, bitmap font", text_page(Text::kBitmapFont, kWidth, kHeight), all),
      checked("pixel art x 1", pixel_art(1, kWidth, kHeight), all),
      checked("pixel art x 2", pixel_art(2, kWidth, kHeight), all),
      checked("smoothed hall, JPEG 90", compressed(hall, 90), all),
      checked("smoothed hall, JPEG 50", compressed(hall, 50), all)};
  return "\nTextured frames (`none`: the frame itself):\n\n" + textured_table(all) +
         "\nFrames that are correct as they are. " + changed_table(all, frames);
}

std::vector<GuardedText> guarded_text(int width, int height) {
  const std::vector<Filter> all = guarded_filters();
  std::vector<GuardedText> pages;
  for (const Text kind : {Text::kAliased, Text::kSmoothed, Text::kLightOnDark, Text::kBitmapFont}) {
    const Image page = text_page(kind, width, height);
    const std::vector<Image> smoothed = smoothed_by(std::span(all).first(2), page);
    const std::vector<Figures> figures = measure(page, page, smoothed);
    pages.push_back({kind, figures[0].small, figures[1].small});
  }
  return pages;
}

std::string guarded_text_table(Text kind) {
  return "\n" + head(guard_head("changed, %")) +
         of_right_frame_with_guard("text, aliased", text_page(kind, kWidth, kHeight),
                                   guarded_filters());
}

std::string guard_tables() {
  const std::vector<Filter> all = guarded_filters();
  std::string text =
      "\nFrames that are correct as they are: pixels changed by more than 2 codes, %, and PSNR to "
      "the input, without\nthe guard > with it:\n\n" +
      head(guard_head("changed, %"));
  const auto right = [&](const std::string& name, const Image& frame) {
    text += of_right_frame_with_guard(name, frame, all);
  };
  right("text, aliased", text_page(Text::kAliased, kWidth, kHeight));
  right("text, bitmap font", text_page(Text::kBitmapFont, kWidth, kHeight));
  right("text, smoothed", text_page(Text::kSmoothed, kWidth, kHeight));
  right("text over a scene", text_over_scene(kWidth, kHeight));
  for (const int size : {1, 2})
    right(fmt::format("pixel art x {}", size), pixel_art(size, kWidth, kHeight));
  right("synthetic photograph: landscape", landscape_photo(kWidth, kHeight));
  right("synthetic photograph: foliage", foliage_photo(kWidth, kHeight));
  right("smoothed hall", smoothed_hall(kWidth, kHeight));
  std::vector<Pair> of_scenes, textured;
  for (const tb::SceneName& scene : tb::scene_names())
    of_scenes.push_back(rendered(tb::make_scene(scene.name), 512, 512));
  for (int view = 0; view < 3; ++view) {
    Textured t = textured_frame(view, 2 * kWidth, 2 * kHeight);
    textured.push_back({std::move(t.frame), std::move(t.reference)});
  }
  text += "\nFrames with a reference:\n\n" + guard_reference_head();
  text += worst_with_guard(fmt::format("{} scenes", of_scenes.size()), of_scenes, all);
  text += worst_with_guard("nine generated scenes", stand_ins(), all);
  text += worst_with_guard("textured frames, three views", textured, all);
  return text + "\n";
}

std::string wires_table() {
  constexpr std::array<double, 2> kThickness = {1.5, 2};
  constexpr std::array<int, 4> kDegrees = {10, 20, 30, 40};
  const std::vector<Filter> all = guarded_filters();
  std::vector<std::string> titles = {"", "guarded, %", "none"};
  for (const m::Preset which : kGuardedPresets)
    titles.emplace_back(m::kPresetNames[static_cast<std::size_t>(which)]);
  std::string text = "\n" + head(titles);
  for (const double thickness : kThickness)
    for (const int degrees : kDegrees) {
      const Textured frames = wires(thickness, degrees, 256, 256);
      const std::vector<Image> smoothed = smoothed_by(all, frames.frame);
      const auto of = [&](const Image& image) {
        return fmt::format("{:.2f}", psnr(image, frames.reference));
      };
      std::vector<std::string> cells = {fmt::format("{} px at {}°", thickness, degrees),
                                        fmt::format("{:.1f}", guarded_percent(frames.frame)),
                                        of(frames.frame)};
      for (std::size_t i = 0; i < smoothed.size(); i += 2)
        cells.push_back(fmt::format("{} > {}", of(smoothed[i]), of(smoothed[i + 1])));
      text += row(cells);
    }
  return text + "\n";
}

std::string formula_frames_with_reference() {
  std::vector<Column> columns;
  columns.push_back({"five scenes", {}});
  for (const char* const scene : {"cylinders", "object", "road", "quad", "tunnel"})
    columns.back().pairs.push_back(rendered(tb::make_scene(scene), 512, 512));
  columns.push_back({"nine generated scenes", stand_ins()});
  return "\n" + perceptual_table(filters(), columns);
}

std::string missing_data(const fs::path& data) {
  std::vector<fs::path> files;
  files.reserve(kPhotos.size() + 2 * kFrames.size() + kHeldOut.size());
  for (const char* const name : kPhotos) files.push_back(photo_file(data, name));
  for (const FramePair& pair : kFrames)
    files.insert(files.end(), {data / pair.frame, data / pair.reference});
  for (const char* const name : kHeldOut) files.push_back(data / name);
  for (const fs::path& file : files)
    if (!fs::exists(file)) return file.string();
  return "";
}

namespace {

void require(const fs::path& data) {
  if (const std::string missing = missing_data(data); !missing.empty())
    throw spec::FileError(fmt::format(
        "'{}' not found: set DEBURR_DATA to the folder that holds frames/, kenney/ and textures/",
        missing));
}

}  // namespace

std::string data_tables(const fs::path& data) {
  require(data);
  const std::vector<Filter> all = filters();
  std::vector<Checked> photos;
  photos.reserve(kPhotos.size());
  for (const char* const name : kPhotos)
    photos.push_back(
        checked(fmt::format("photograph: {}", name), tb::read_image(photo_file(data, name)), all));
  return "\nPhotographs. " + changed_table(all, photos);
}

namespace {

std::vector<Pair> held_out(const fs::path& data) {
  std::vector<Pair> all;
  all.reserve(kHeldOut.size());
  for (const char* const name : kHeldOut)
    all.push_back(rendered(tb::import_scene(data / name), 512, 512));
  return all;
}

}  // namespace

std::string data_guard_table(const fs::path& data) {
  require(data);
  const std::vector<Filter> all = guarded_filters();
  std::string text = "\n" + guard_reference_head();
  for (const FramePair& pair : kFrames) {
    const Pair one = {tb::read_image(data / pair.frame), tb::read_image(data / pair.reference)};
    text += worst_with_guard(pair.title, {&one, 1}, all);
  }
  return text + worst_with_guard("17 held-out meshes", held_out(data), all) + "\n";
}

std::string data_frames_with_reference(const fs::path& data) {
  require(data);
  std::vector<Column> columns;
  columns.reserve(kFrames.size() + 1);
  for (const FramePair& pair : kFrames)
    columns.push_back(
        {pair.title, {{tb::read_image(data / pair.frame), tb::read_image(data / pair.reference)}}});
  columns.push_back({"17 held-out meshes", held_out(data)});
  return "\n" + perceptual_table(filters(), columns);
}

}  // namespace deburr::studies::harm
