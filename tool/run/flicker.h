// SPDX-License-Identifier: MIT
// Flicker of a run's frames, by the golden model, whose frames are those of the hardware: how much
// more or less a pixel changes from frame to frame than its reference does, or, where nobody knows
// the reference, than what went in.
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

// How many frames the run has. ConfigError for a camera that is to move where a list says what the
// frames are, and for a motion of one frame. In resolve().
int frames_of(const tb::ParameterSet& set, const tb::SequenceParameters& sequence,
              const tb::FrameLists& lists);
// Which motion of the camera a frame has: none where lists say what it is.
inline tb::CameraMove move_of(const tb::SequenceParameters& sequence, const tb::FrameLists& lists,
                              int frame) {
  return {sequence.motion, lists.frames() > 1 ? 0 : frame};
}

struct SequencePicture {
  tb::Image before, after;          // what goes in, and what the golden model makes of it
  tb::Image reference;              // empty: nobody knows it
  std::optional<tb::Mask> drawn{};  // pixels that are looked at; none: all
};
// Fills the result's work and figures. ConfigError where frames differ in size. Ctrl-C ends it: the
// result is marked.
void measure_flicker(int frames, const RunContext& context, tb::Result& result,
                     const std::function<SequencePicture(int)>& picture);

}  // namespace deburr::tool
