// SPDX-License-Identifier: MIT
// An engine's role in a composition. A composition draws a scene into a frame buffer and smooths it
// there. Each engine declares its role once, with a class below; the composition is built from the
// roles and names no engine (docs/howto/add_an_engine.md, "In a composition").
//
//   PictureDrawer   draws a picture: one colour per fragment, in any order
//   MeshSmoother    smooths along the edges of the mesh: the frame buffer is its memory
//   RowSmoother     smooths a finished picture: receives its rows, outputs its pixels
//
// A role holds the parameters of its engine and derives dependent values. For a run it builds a
// stage: the engine, its environment, and the interfaces to the frame buffer and to adjacent
// engines.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "rtl_model/fabric/clocked.h"
#include "tb/env/environment.h"
#include "tb/env/simulation.h"
#include "tb/run/parameter_set.h"
#include "tb/run/result.h"
#include "tb/scene/drawn_scene.h"
#include "tb/scene/image.h"
#include "tb/scene/mesh.h"
#include "tb/scene/reference.h"
#include "tool/pages/run_context.h"
#include "tool/run/engine.h"
#include "tool/run/pictures.h"

namespace deburr::tool {

// ---- stages: engines of a composition -----------------------------------------------------------

class Stage {
 public:
  virtual ~Stage() = default;
  virtual tb::Environment& environment() = 0;
  const tb::Environment& environment() const { return const_cast<Stage&>(*this).environment(); }

 protected:
  Stage() = default;
  Stage(const Stage&) = default;
  Stage& operator=(const Stage&) = default;
};

// A colour as accepted by the frame buffer.
struct DrawnColour {
  bool inside = false;   // inside the frame; the engine's own checks report others
  bool visible = false;  // the nearest fragment of its pixel
  int x = 0, y = 0;
  tb::Rgba8 colour{};
};

// A port of the frame buffer that accepts the previous engine's beats.
class ColoursPort {
 public:
  virtual ~ColoursPort() = default;
  virtual bool can_pop(rtl::Cycle cycle) const = 0;
  // Takes a beat and calls `each` for each of its colours. The engine's environment checks the
  // colours too.
  virtual void take(rtl::Cycle cycle, const std::function<void(const DrawnColour&)>& each) = 0;
};

class DrawingStage : public Stage {
 public:
  // Creates and binds the port. Called in the constructor of the frame buffer, which owns the port.
  virtual std::unique_ptr<ColoursPort> colours_port(const char* name) = 0;
  // The golden model's picture of the scene.
  virtual tb::Image golden_picture() const = 0;
  // Lower bound in cycles.
  virtual std::uint64_t cycles_bound() const = 0;
  // Adds the stage's figures, under its name, to those of its environment, and their place in a
  // report.
  virtual void collect(tb::Result& result) const = 0;
  virtual std::vector<tb::Figure> figures() const = 0;
};

class SmoothingStage : public Stage {
 public:
  // The frame as smoothed so far, and the expected frame.
  virtual tb::Image frame() const = 0;
  virtual tb::Image expected_frame() const = 0;
  virtual tb::Latency latency() const = 0;
  // The unit that determines when the others finish.
  virtual std::string_view last_unit() const = 0;
  // Lower bound in cycles for this frame.
  virtual std::uint64_t cycles_bound(int width, int height) const = 0;
  virtual std::vector<tb::Figure> work_figures() const = 0;
  // Notes for the user after the run.
  virtual std::vector<std::string> notes() const { return {}; }
};

class MeshStage : public SmoothingStage {
 public:
  // Writes the frame in memory in zero time.
  virtual void put(int x, int y, const tb::Rgba8& colour) = 0;
  // The frame is complete: the engine starts in the next cycle.
  virtual void draw() = 0;
  // Adds pictures of weights and lines, under names unique to the stage.
  virtual void add_pictures(RunContext& context, const tb::Image& before, bool followed) const = 0;
};

// A port of the frame buffer that outputs the next engine's beats.
class RowsPort {
 public:
  virtual ~RowsPort() = default;
  virtual bool can_push(rtl::Cycle cycle) const = 0;
  // Pushes a beat of pixels starting at (x, y); returns their number.
  virtual int push(rtl::Cycle cycle, const tb::Image& image, int x, int y) = 0;
};

class RowStage : public SmoothingStage {
 public:
  // Sets the golden model's input, if the input is known only during the run.
  virtual void expect(tb::Image image) = 0;
  // Number of delivered pixels: of frame(), and of all frames.
  virtual std::size_t delivered() const = 0;
  virtual std::uint64_t delivered_in_all() const = 0;
  // Adds pictures of the whole frame, and of the engine's intermediate results.
  virtual void add_pictures(RunContext& context, const SmoothedFrame& frame) const = 0;
};

// ---- roles --------------------------------------------------------------------------------------

// Data passed through the frame buffer in addition to colours.
enum class Handed : std::uint8_t {
  kDepth,
  kMeshEdges,
  kMarkedPixels,  // bit 0 of alpha: 0 for a pixel that is already smoothed
};
using HandedOn = std::vector<Handed>;

class CompositionRole {
 public:
  virtual ~CompositionRole() = default;
  // The name as in engine.h, and as shown in a title ("texture unit").
  virtual std::string_view name() const = 0;
  virtual std::string_view title() const = 0;
  virtual HandedOn needs() const { return {}; }
  virtual HandedOn hands_on() const { return {}; }

  // Adds build parameters and memory parameters, under names unique within a composition.
  virtual void add_parameters(tb::ParameterSet& set) = 0;
  // Prefixes of these names.
  virtual std::vector<std::string> prefixes() const = 0;
  virtual void apply_preset(tb::ParameterSet& set) = 0;
  // Called after all presets have been applied. Rejects invalid settings and settings without
  // effect.
  virtual void resolve(tb::ParameterSet& set) = 0;
  // The configuration, as text for a title. Call after resolve().
  virtual std::string label() const = 0;
  virtual std::vector<std::string> notes() const { return {}; }
  virtual std::vector<Shorthand> shorthands() const { return {}; }
  // Names of pictures in addition to those of the frame, and settings for a long run of a
  // composition.
  virtual std::vector<std::string_view> pictures() const { return {}; }
  virtual LongRun long_run() const { return {}; }
  // ConfigError for a scene that the engine cannot process.
  virtual void check(const tb::DrawnScene& scene) const = 0;

 protected:
  CompositionRole() = default;
  CompositionRole(const CompositionRole&) = default;
  CompositionRole& operator=(const CompositionRole&) = default;
};

// Words that describe the cycles of a drawer: "texturing".
struct DrawingWords {
  std::string_view doing, from;  // "texturing", from the first "quad"
  std::string_view label;        // of its cycles in a report, next to ...
  std::string_view bound_label, bound_key, bound_meaning;
};

class PictureDrawer : public CompositionRole {
 public:
  // Adds the scene's parameters, before those of any engine.
  virtual void add_scene(tb::ParameterSet& set) = 0;
  virtual DrawingWords words() const = 0;
  // "textured": caption of a picture of its frame.
  virtual std::string_view caption() const = 0;

  // The scene's name as given.
  virtual const std::string& source() const = 0;
  virtual std::vector<std::filesystem::path> input_files(tb::MeshFiles& meshes) const = 0;
  virtual std::shared_ptr<const tb::DrawnScene> load(std::uint32_t seed,
                                                     const RunContext& context) const = 0;
  // The scene used for elaboration.
  virtual std::shared_ptr<const tb::DrawnScene> smallest() const = 0;

  // The supersampled reference, made once for all runs of a scene, and the pictures with which
  // results are compared (compare_with_scene()).
  virtual std::string reference_caption() const = 0;
  virtual void prepare_reference(const tb::DrawnScene& scene, const tb::RenderOptions& options,
                                 const RunContext& context) const = 0;
  virtual tb::Image compare_with_reference(const tb::DrawnScene& scene,
                                           const tb::RenderOptions& options,
                                           const tb::Image& before, const tb::Image& after,
                                           tb::Result& result, const RunContext& context) const = 0;

  virtual std::unique_ptr<DrawingStage> build(tb::Simulation& simulation,
                                              const tb::DrawnScene& scene) const = 0;

  // For measuring flicker over several frames: their number and, for each frame, the scene, the
  // golden picture (made without simulation) and the reference. Engines without sequences have one
  // frame.
  virtual int frames() const { return 1; }
  virtual std::shared_ptr<const tb::DrawnScene> scene_of(int /*frame*/,
                                                         std::uint32_t /*seed*/) const {
    return nullptr;
  }
  virtual tb::Image golden_picture(const tb::DrawnScene& /*scene*/) const { return {}; }
  virtual tb::Image reference_of(const tb::DrawnScene& /*scene*/,
                                 const tb::RenderOptions& /*options*/) const {
    return {};
  }
};

class PictureSmoother : public CompositionRole {
 public:
  // Whether it blends in linear light; coverage is then averaged in linear light too.
  virtual bool linear_light() const = 0;
  // The golden model's picture of a scene, made without simulation. If it is empty, none is
  // available and no flicker is measured.
  virtual tb::Image golden_picture(const tb::DrawnScene& /*scene*/,
                                   const tb::Image& /*frame*/) const {
    return {};
  }
};

// `frame` is the golden model's input; without a golden model only its size matters. Scene and role
// must outlive the stage.
class MeshSmoother : public PictureSmoother {
 public:
  // Enables marking of smoothed pixels for the engine that follows.
  virtual void mark(tb::ParameterSet&, std::string_view /*why*/) {}
  virtual std::unique_ptr<MeshStage> build(tb::Simulation& simulation, const tb::DrawnScene& scene,
                                           tb::Image frame) const = 0;
};

class RowSmoother : public PictureSmoother {
 public:
  // Whether the engine uses Handed::kMarkedPixels if they are present.
  virtual bool looks_at_marks() const { return false; }
  // Called if the previous engine marks the pixels that it smooths. Sets the preset, if none is
  // given, and then settings that are in no preset.
  virtual void follow_preset(tb::ParameterSet&, std::string_view /*why*/) {}
  virtual void follow(tb::ParameterSet&, std::string_view /*why*/) {}
  // Creates the port; called in the constructor of the frame buffer, which owns it. build() binds
  // it.
  virtual std::unique_ptr<RowsPort> rows_port(const char* name,
                                              const tb::DrawnScene& scene) const = 0;
  virtual std::unique_ptr<RowStage> build(tb::Simulation& simulation, const tb::DrawnScene& scene,
                                          tb::Image frame, RowsPort& port) const = 0;
};

}  // namespace deburr::tool
