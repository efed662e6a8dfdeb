// SPDX-License-Identifier: MIT
#include "tb/engines/morphological/morphological_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "spec/error.h"
#include "tb/base/file.h"
#include "tb/scene/depth_codes.h"
#include "tb/scene/image_io.h"
#include "tb/scene/mesh.h"
#include "tb/scene/motion.h"
#include "tb/scene/reference.h"
#include "tb/scene/scenes.h"
#include "tb/stimuli/weight_file.h"

namespace deburr::tb {
namespace {

bool is_scene(const std::string& source) { return is_scene_name(source) || is_mesh_file(source); }

void require_size(const char* what, const std::string& file, int width, int height,
                  const Image& image) {
  if (width != image.width || height != image.height)
    throw spec::ConfigError(fmt::format("{} '{}' has {} x {} pixels, the frame has {} x {}", what,
                                        file, width, height, image.width, image.height));
}

LoadedFrame rendered(const FrameParameters& p, std::uint32_t seed,
                     const std::function<bool()>& interrupted, const KeptFrames& kept) {
  Scene scene = load_scene(p.source, {.seed = seed});
  scene.camera = moved(scene.camera, p.move.motion, p.move.frame);
  LoadedFrame frame;
  frame.conversions = scene.mesh.notes;
  const auto make = [&] {
    return render_lit_frames(scene, p.width, p.height, std::max(1, p.reference_samples),
                             interrupted);
  };
  const LitFrames lit = kept ? kept(make) : make();
  frame.input.image = lit.noaa;
  frame.depth = lit.depth;
  if (p.reference_samples > 0) {
    frame.reference = lit.reference;
    frame.reference_name =
        fmt::format("supersampled-{}", p.reference_samples * p.reference_samples);
  }
  frame.inputs = scene.mesh.files;
  return frame;
}

// Bit 0 of alpha becomes 0 where the mask is set, else 1.
void apply_mask(const std::string& file, LoadedFrame& frame) {
  ReadReport report;
  const Image mask = read_image(file, &report);
  for (const std::string& conversion : report.conversions)
    frame.conversions.push_back(fmt::format("'{}': {}", file, conversion));
  Image& image = frame.input.image;
  require_size("mask", file, mask.width, mask.height, image);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    std::uint8_t& alpha = image.pixels[i][3];
    alpha = static_cast<std::uint8_t>(mask.pixels[i][0] >= 128 ? alpha & ~1 : alpha | 1);
  }
  add_once(frame.inputs, file);
}

}  // namespace

FrameLists lists_of(const FrameParameters& p) {
  FrameLists lists;
  for (const auto& [name, text] :
       {std::pair("frame.source", &p.source), std::pair("frame.depth", &p.depth),
        std::pair("frame.reference", &p.reference), std::pair("frame.mask", &p.mask)})
    lists.add(name, listed_files(name, *text));
  return lists;
}

FrameParameters in_frame(FrameParameters p, const FrameLists& lists, int frame) {
  p.source = lists.at("frame.source", frame);
  p.depth = lists.at("frame.depth", frame);
  p.reference = lists.at("frame.reference", frame);
  p.mask = lists.at("frame.mask", frame);
  return p;
}

bool is_rendered(const FrameParameters& parameters) { return is_scene(parameters.source); }

bool looks_like_a_picture(const DepthImage& depth) {
  // Values; fewer, as from a few flat walls, are not conclusive.
  constexpr std::size_t kEnough = 64;
  constexpr double kMinCorrelation = 0.5;  // correlation of the differences of two channels
  const std::vector<std::uint32_t> codes = depth_codes(depth);
  std::array<double, 3> squares{}, products{};  // of differences in R, G, B; products of RG, GB, BR
  std::set<std::uint32_t> values;
  for (std::size_t i = 1; i < codes.size(); ++i) {
    // Skip silhouettes.
    if (codes[i] == codes[i - 1] || codes[i] == 0 || codes[i - 1] == 0) continue;
    std::array<double, 3> step{};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto channel = [&](std::uint32_t code) {
        return static_cast<double>(code >> (16 - 8 * c) & 255);
      };
      step[c] = channel(codes[i]) - channel(codes[i - 1]);
    }
    for (std::size_t c = 0; c < 3; ++c) {
      squares[c] += step[c] * step[c];
      products[c] += step[c] * step[(c + 1) % 3];
    }
    if (values.size() < kEnough) values.insert(codes[i]);
  }
  if (values.size() < kEnough) return false;
  for (std::size_t c = 0; c < 3; ++c)
    if (products[c] > kMinCorrelation * std::sqrt(squares[c] * squares[(c + 1) % 3])) return true;
  return false;
}

LoadedFrame load_frame(const FrameParameters& p, std::uint32_t seed,
                       const std::function<bool()>& interrupted, const KeptFrames& kept) {
  LoadedFrame frame;
  if (is_scene(p.source)) {
    if (!p.reference.empty() || !p.depth.empty())
      throw spec::ConfigError(
          "frame.reference and frame.depth go with an image file; a scene has its own");
    frame = rendered(p, seed, interrupted, kept);
  } else {
    if (std::filesystem::path(p.source).extension().empty() && !is_there(p.source)) {
      std::string known;
      for (const SceneName& scene : scene_names()) known += fmt::format(" {}", scene.name);
      throw spec::ConfigError(
          fmt::format("no scene and no file '{}': scenes are{}", p.source, known));
    }
    ReadReport report;
    frame.input.image = read_image(p.source, &report);
    const auto note = [&](const std::string& file) {
      for (const std::string& conversion : report.conversions)
        frame.conversions.push_back(fmt::format("'{}': {}", file, conversion));
    };
    note(p.source);
    add_once(frame.inputs, p.source);
    const Image& image = frame.input.image;
    if (!p.depth.empty()) {
      frame.depth = read_depth(p.depth, &report);
      note(p.depth);
      require_size("depth", p.depth, frame.depth->width, frame.depth->height, image);
      add_once(frame.inputs, p.depth);
      if (report.channels > 1 && looks_like_a_picture(*frame.depth))
        frame.conversions.push_back(fmt::format(
            "'{}' looks like a picture, not like depth of 24 bits in R, G, B: its channels change "
            "alike",
            p.depth));
    }
    if (!p.reference.empty()) {
      frame.reference = read_image(p.reference, &report);
      note(p.reference);
      require_size("reference", p.reference, frame.reference->width, frame.reference->height,
                   image);
      frame.reference_name = std::filesystem::path(p.reference).filename().string();
      add_once(frame.inputs, p.reference);
    }
  }
  if (frame.depth) frame.input.depth = depth_codes(*frame.depth);
  if (!p.mask.empty()) apply_mask(p.mask, frame);
  if (!p.weights.empty()) {
    frame.weights = stimuli::read_weight_file(p.weights);
    add_once(frame.inputs, p.weights);
  }
  return frame;
}

golden::morphological::MorphologicalGolden golden_frame(
    const MorphologicalInput& input, const spec::morphological::Parameters& parameters,
    const golden::morphological::WeightTables* weights) {
  const Image& image = input.image;
  golden::morphological::MorphologicalGolden golden(parameters);
  if (weights != nullptr) golden.set_weight_tables(*weights);
  golden.process({image.pixels, image.width, image.height},
                 input.depth.empty()
                     ? golden::morphological::DepthView()
                     : golden::morphological::DepthView(input.depth, image.width, image.height));
  return golden;
}

std::vector<std::filesystem::path> frame_files(const FrameParameters& p, MeshFiles& meshes) {
  std::vector<std::filesystem::path> files;
  if (is_scene(p.source)) {
    files = scene_files(p.source, {}, meshes);
  } else {
    for (const std::string& file : {p.source, p.depth, p.reference})
      if (!file.empty()) add_once(files, file);
  }
  for (const std::string& file : {p.mask, p.weights})
    if (!file.empty()) add_once(files, file);
  return files;
}

}  // namespace deburr::tb
