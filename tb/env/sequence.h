// SPDX-License-Identifier: MIT
// Frames in a row: a camera that moves, or files and cameras that parameters list.
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

// What stands between the entries of a list.
inline constexpr char kListSeparator = ';';

// Entries of a list; a text without a separator is its only one.
std::vector<std::string> listed(std::string_view text);
// The same of names of files, where a pattern with *, ? or [ ] stands for the files that it
// matches, in the order of their names, numbers in them by value. ConfigError for a pattern that
// matches nothing. What is there under its whole name is neither list nor pattern.
std::vector<std::string> listed_files(std::string_view parameter, const std::string& text);

// What parameters say of each frame.
class FrameLists {
 public:
  // ConfigError for two lists that are not equally long, and for an empty entry.
  void add(std::string parameter, std::vector<std::string> entries);
  // Of a parameter in a frame: its entry, or the only one.
  const std::string& at(std::string_view parameter, int frame) const;
  int frames() const { return frames_; }
  const std::string& longest() const { return longest_; }  // name of a list; empty: there is none

 private:
  std::map<std::string, std::vector<std::string>, std::less<>> entries_;
  std::string longest_;
  int frames_ = 1;
};

// Every file of all frames, by lists_of(), in_frame() and frame_files() of an engine's parameters.
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

// Eye and target of a camera under "scene.": lists too.
void add_camera(FrameLists& lists, const CameraParameters& camera);
void choose_camera(CameraParameters& camera, const FrameLists& lists, int frame);

// Counters of a run of several frames: of the golden model's pictures, and of the input.
void add_flicker(Result& result, const FlickerMeter& after, const FlickerMeter& before);

}  // namespace deburr::tb
