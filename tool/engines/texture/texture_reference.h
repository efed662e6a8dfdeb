// SPDX-License-Identifier: MIT
// The supersampled reference of a textured scene, and the resulting quality of a run.
#pragma once

#include <memory>
#include <string>

#include "tb/engines/texture/texture_scene.h"
#include "tb/run/result.h"
#include "tb/scene/image.h"
#include "tb/scene/reference.h"
#include "tool/pages/run_context.h"

namespace deburr::tool {

// Computes the reference of the scene, with 16 x 16 samples per pixel, and adds the quality to the
// result. After Ctrl-C the result is marked, the picture is empty, and earlier measurements remain.
inline constexpr int kReferenceSamples = 16;
std::string reference_caption();
// Shared by runs of the same scene (RunContext::shared). Throws Interrupted.
std::shared_ptr<const tb::Image> scene_reference(const tb::TextureScene& scene,
                                                 tb::RenderOptions options,
                                                 const RunContext& context);
tb::Image compare_with_scene(const tb::TextureScene& scene, tb::RenderOptions options,
                             const tb::Image& before, const tb::Image& after, tb::Result& result,
                             const RunContext& context);

}  // namespace deburr::tool
