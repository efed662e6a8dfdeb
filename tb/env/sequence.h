// SPDX-License-Identifier: MIT
// Frame sequences: a moving camera, or files and cameras given as lists.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "tb/env/camera_parameters.h"
#include "tb/run/given_work.h"
#include "tb/scene/mesh.h"
#include "tb/scene/motion.h"
#include "tb/scene/quality.h"

namespace deburr::tb {

struct Result;

struct SequenceParameters {
  std::int32_t frames = 1;
  Motion motion = Motion::kRoll;
};

template <class Visitor>
void describe(SequenceParameters& p, Visitor& v) {
  v.integer(
      "frames", p.frames, 1, 1000, "frame",
      "Frames of a moving camera. The golden model renders them all and measures their flicker "
      "against their reference images; the hardware model runs the first. 1: no flicker.");
  v.is_work("frames", GivenWork::kSetting);
  v.choice("motion", p.motion, kMotionNames,
           "Camera motion: zoom (1 % per frame), roll (3 degrees), pan (1/400 of the view).");
}

// Separates entries of a list.
inline constexpr char kListSeparator = ';';

// Splits a list; a text without a separator is a single entry.
std::vector<std::string> listed(std::string_view text);
// As listed(), for file names. A pattern with *, ? or [ ] expands to the matching files in natural
// order. Throws ConfigError for a pattern without a match. If the text is the name of an existing
// file, it is neither split nor expanded.
std::vector<std::string> listed_files(std::string_view parameter, const std::string& text);

// Per-frame values of list parameters.
class FrameLists {
 public:
  // Throws ConfigError if two lists differ in length, and for an empty entry.
  void add(std::string parameter, std::vector<std::string> entries);
  // The value of a parameter in a frame: the entry for this frame or, if there is only one entry,
  // this entry.
  const std::string& at(std::string_view parameter, int frame) const;
  int frames() const { return frames_; }
  // Name of a list parameter; empty if there is none.
  const std::string& longest() const { return longest_; }

 private:
  std::map<std::string, std::vector<std::string>, std::less<>> entries_;
  std::string longest_;
  int frames_ = 1;
};

// Every file of all frames, using lists_of(), in_frame() and frame_files() for an engine's
// parameters.
template <class Parameters>
std::vector<std::filesystem::path> files_of_frames(const Parameters& parameters,
                                                   MeshFiles& meshes) {
  const FrameLists lists = lists_of(parameters);
  std::vector<std::filesystem::path> files;
  for (int i = 0; i < lists.frames(); ++i)
    for (const std::filesystem::path& file : frame_files(in_frame(parameters, lists, i), meshes))
      add_once(files, file);
  return files;
}

// Adds eye and target of a camera, parameters "scene.*", which may be lists.
void add_camera(FrameLists& lists, const CameraParameters& camera);
void choose_camera(CameraParameters& camera, const FrameLists& lists, int frame);

// Adds the flicker of a run of several frames: that of the golden model's output and that of its
// input.
void add_flicker(Result& result, const FlickerMeter& after, const FlickerMeter& before);

}  // namespace deburr::tb
