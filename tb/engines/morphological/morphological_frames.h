// SPDX-License-Identifier: MIT
// Input of the morphological engine: an image file, optionally with depth and reference files, or a
// scene rendered without anti-aliasing, with its depth and a supersampled reference. Files are
// converted to codes as in docs/reference/morphological/algorithm.md, "Conversion of images".
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "golden/morphological/morphological_golden.h"
#include "tb/engines/morphological/morphological_input.h"
#include "tb/env/sequence.h"
#include "tb/run/given_work.h"
#include "tb/scene/image.h"
#include "tb/scene/reference.h"

namespace deburr::tb {

struct FrameParameters {
  std::string source = "cylinders";
  std::string depth, reference, mask, weights;
  std::int32_t width = 640, height = 480;
  std::int32_t reference_samples = 8;
  std::int32_t count = 1;
  CameraMove move{};  // of a scene's camera; not a parameter
};

template <class Visitor>
void describe(FrameParameters& p, Visitor& v) {
  v.text("source", p.source, "name | file or list",
         "An image file, or a scene (plane, quad, tunnel, object, road, cylinders, or a mesh file) "
         "rendered without anti-aliasing; for one per frame, a list or a pattern. So for all files "
         "here.");
  v.text("depth", p.depth, "file or list",
         "Depth buffer of an image: 24 bits in R, G, B, 16 bits of grey, or one float channel; "
         "larger is nearer.");
  v.text("reference", p.reference, "file or list",
         "Reference image: the anti-aliased picture that an image is compared with.");
  v.text("mask", p.mask, "file or list",
         "Mask: pixels with red of 128 or more are bypassed. Bit 0 of their alpha becomes 0, of "
         "all other pixels 1, and `morphological.bypass` becomes masked.");
  v.text("weights", p.weights, "file",
         "Learned weights, as written by `deburr train`, that replace the built-in ones; they are "
         "loaded through the registers.");
  v.integer("width", p.width, 1, 8192, "pixel", "Width of a rendered scene.");
  v.integer("height", p.height, 1, 8192, "pixel", "Height of a rendered scene.");
  v.integer("reference_samples", p.reference_samples, 0, 32, "",
            "N of the N x N samples per pixel of a scene's reference image; 0: no reference.");
  v.integer("count", p.count, 1, 1000, "frame", "Number of times the frame is sent.");
  v.is_work("source", GivenWork::kSource);
  for (const char* const name : {"width", "height", "count", "reference_samples"})
    v.is_work(name, GivenWork::kSetting);
}

// Per-frame values: all files may be lists.
FrameLists lists_of(const FrameParameters& parameters);
FrameParameters in_frame(FrameParameters parameters, const FrameLists& lists, int frame);

// Whether the source is a scene or a mesh, not an image file.
bool is_rendered(const FrameParameters& parameters);

struct LoadedFrame {
  MorphologicalInput input;
  std::optional<Image> reference;
  std::optional<DepthImage> depth;
  std::string reference_name;            // "supersampled-64", or the file name
  std::vector<std::string> conversions;  // changes by the reader of images or meshes
  std::optional<golden::morphological::WeightTables> weights;  // if absent, those of the ROMs
  std::vector<std::filesystem::path> inputs;                   // files that were read or looked for
};

// Renderings of a scene go through a cache of this type. Loading a frame throws FileError for
// unreadable files, ConfigError for sizes that do not match, and Interrupted once `interrupted`
// returns true.
using KeptFrames = std::function<LitFrames(const std::function<LitFrames()>& make)>;
LoadedFrame load_frame(const FrameParameters& parameters, std::uint32_t seed,
                       const std::function<bool()>& interrupted = nullptr,
                       const KeptFrames& kept = nullptr);

// LoadedFrame::inputs, without loading.
std::vector<std::filesystem::path> frame_files(const FrameParameters& parameters,
                                               MeshFiles& meshes);

// Golden model of a frame; null weights: those of the ROMs.
golden::morphological::MorphologicalGolden golden_frame(
    const MorphologicalInput& input, const spec::morphological::Parameters& parameters,
    const golden::morphological::WeightTables* weights = nullptr);

// Whether 24-bit depths, split into R, G and B, look like a colour image: two channels change alike
// from pixel to pixel. In true depth G and B are lower digits of R and fall as R rises.
bool looks_like_a_picture(const DepthImage& depth);

}  // namespace deburr::tb
