// SPDX-License-Identifier: MIT
// Flicker of a run's frames: how much more or less a pixel changes from frame to frame than it does
// in the reference, or in the input if there is no reference. The frames are those of the golden
// model, which equal those of the hardware.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "tb/env/sequence.h"
#include "tb/run/parameter_set.h"
#include "tb/run/result.h"
#include "tb/scene/image.h"
#include "tool/pages/run_context.h"
#include "tool/run/engine.h"

namespace deburr::tool {

// --frames, --motion.
std::vector<Shorthand> sequence_shorthands();

// The number of frames. ConfigError if a camera motion is given although a list defines the frames
// or there is only one frame. Called in resolve().
int frames_of(const tb::ParameterSet& set, const tb::SequenceParameters& sequence,
              const tb::FrameLists& lists);
// The camera motion of a frame: none if lists define the frames.
inline tb::CameraMove move_of(const tb::SequenceParameters& sequence, const tb::FrameLists& lists,
                              int frame) {
  return {sequence.motion, lists.frames() > 1 ? 0 : frame};
}

struct SequencePicture {
  tb::Image before, after;          // input, and the golden model's output
  tb::Image reference;              // empty: unknown
  std::optional<tb::Mask> drawn{};  // measured pixels; nullopt: all
};
// Adds work and figures to the result, and writes each output frame and frames.csv, with the
// quality of each. ConfigError if frames differ in size. Ctrl-C cancels the measurement, and the
// result is marked.
void measure_flicker(int frames, RunContext& context, tb::Result& result,
                     const std::function<SequencePicture(int)>& picture);

}  // namespace deburr::tool
