// SPDX-License-Identifier: MIT
// What an engine is in a composition, which draws a scene into a frame buffer and smooths it there.
// An engine declares its role here, once; the composition is made of the roles and names no
// engine (docs/howto/add_an_engine.md, "In a composition").
//
//   PictureDrawer   draws a picture: a colour a fragment, in whatever order
//   MeshSmoother    smooths along the edges of the mesh: the frame buffer is its memory
//   RowSmoother     smooths a finished picture: takes its rows, delivers its pixels
//
// A role has the parameters of its engine and what follows from them. For a run it builds a stage:
// the engine with its environment, and what the frame buffer and the engines beside it need of it.
#pragma once

#include <cstdint>
#include <filesystem>
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

// ---- stages: engines that are built -------------------------------------------------------------

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

// A colour as the frame buffer takes it.
struct DrawnColour {
  bool inside = false;   // of the frame; what is not is found by the engine's own checks
  bool visible = false;  // the nearest fragment of its pixel
  int x = 0, y = 0;
  tb::Rgba8 colour{};
};

// A port of the frame buffer, in the beats that the engine before it speaks.
class ColoursPort {
 public:
  virtual ~ColoursPort() = default;
  virtual bool can_pop(rtl::Cycle cycle) const = 0;
  // The engine's environment has seen it too.
  virtual DrawnColour take(rtl::Cycle cycle) = 0;
};

class DrawingStage : public Stage {
 public:
  // Made in the constructor of the frame buffer, whose port it is; bound.
  virtual std::unique_ptr<ColoursPort> colours_port(const char* name) = 0;
  // The golden model's picture of the scene.
  virtual tb::Image golden_picture() const = 0;
  // Cycles that it needs at least.
  virtual std::uint64_t cycles_bound() const = 0;
  // Figures beside those of its environment, under its name, and what a report shows of them.
  virtual void collect(tb::Result& result) const = 0;
  virtual std::vector<tb::Figure> figures() const = 0;
};

class SmoothingStage : public Stage {
 public:
  // What was smoothed so far, and what it should be.
  virtual tb::Image frame() const = 0;
  virtual tb::Image expected_frame() const = 0;
  virtual tb::Latency latency() const = 0;
  // The unit that the others wait for.
  virtual std::string_view last_unit() const = 0;
  // Cycles that it needs at least for this frame.
  virtual std::uint64_t cycles_bound(int width, int height) const = 0;
  virtual std::vector<tb::Figure> work_figures() const = 0;
  // What a user should know of the run that is over.
  virtual std::vector<std::string> notes() const { return {}; }
};

class MeshStage : public SmoothingStage {
 public:
  // The frame in memory, without time.
  virtual void put(int x, int y, const tb::Rgba8& colour) = 0;
  // It is complete: the engine begins in the next clock.
  virtual void draw() = 0;
  // Weights and lines, under names that no other stage has.
  virtual void add_pictures(RunContext& context, const tb::Image& before, bool followed) const = 0;
};

// A port of the frame buffer, in the beats that the engine after it speaks.
class RowsPort {
 public:
  virtual ~RowsPort() = default;
  virtual bool can_push(rtl::Cycle cycle) const = 0;
  // A beat of the pixels from (x, y) on; gives how many they were.
  virtual int push(rtl::Cycle cycle, const tb::Image& image, int x, int y) = 0;
};

class RowStage : public SmoothingStage {
 public:
  // The picture that the golden model gets, where it is known later only.
  virtual void expect(tb::Image image) = 0;
  // Pixels of frame() that came, and those of all frames.
  virtual std::size_t delivered() const = 0;
  virtual std::uint64_t delivered_in_all() const = 0;
  // Of the whole frame, and what else the engine did.
  virtual void add_pictures(RunContext& context, const SmoothedFrame& frame) const = 0;
};

// ---- roles --------------------------------------------------------------------------------------

// What is handed on through the frame buffer, beside colours.
enum class Handed : std::uint8_t {
  kDepth,
  kMeshEdges,
  kMarkedPixels,  // bit 0 of alpha: 0 where a pixel was smoothed already
};
using HandedOn = std::vector<Handed>;

class CompositionRole {
 public:
  virtual ~CompositionRole() = default;
  // As engine.h has it, and as a title has it ("texture unit").
  virtual std::string_view name() const = 0;
  virtual std::string_view title() const = 0;
  virtual HandedOn needs() const { return {}; }
  virtual HandedOn hands_on() const { return {}; }

  // What is built, and the memory around it, under names that no other engine of a composition has.
  virtual void add_parameters(tb::ParameterSet& set) = 0;
  // Beginnings of their names.
  virtual std::vector<std::string> prefixes() const = 0;
  virtual void apply_preset(tb::ParameterSet& set) = 0;
  // After every preset: rejects what was given and has no effect, or cannot be.
  virtual void resolve(tb::ParameterSet& set) = 0;
  virtual std::vector<std::string> notes() const { return {}; }
  virtual std::vector<Shorthand> shorthands() const { return {}; }
  // Pictures beside those of the frame, and what makes a long run of a composition.
  virtual std::vector<std::string_view> pictures() const { return {}; }
  virtual LongRun long_run() const { return {}; }
  // ConfigError for a scene that the engine does not take.
  virtual void check(const tb::DrawnScene& scene) const = 0;

 protected:
  CompositionRole() = default;
  CompositionRole(const CompositionRole&) = default;
  CompositionRole& operator=(const CompositionRole&) = default;
};

// "texturing": what is said of its cycles.
struct DrawingWords {
  std::string_view doing, from;  // "texturing", from the first "quad"
  std::string_view label;        // of its cycles in a report, beside ...
  std::string_view bound_label, bound_key, bound_meaning;
};

class PictureDrawer : public CompositionRole {
 public:
  // The scene, before any engine's parameters.
  virtual void add_scene(tb::ParameterSet& set) = 0;
  virtual DrawingWords words() const = 0;
  // "textured": what a picture of its frame is called, and by what.
  virtual std::string_view caption() const = 0;

  // What the scene was named.
  virtual const std::string& source() const = 0;
  virtual std::vector<std::filesystem::path> input_files(tb::MeshFiles& meshes) const = 0;
  virtual std::shared_ptr<const tb::DrawnScene> load(std::uint32_t seed,
                                                     const RunContext& context) const = 0;
  // To elaborate with.
  virtual std::shared_ptr<const tb::DrawnScene> smallest() const = 0;

  // The supersampled reference, made once for all runs of a scene, and what results are compared
  // with, as of compare_with_scene().
  virtual std::string reference_caption() const = 0;
  virtual void prepare_reference(const tb::DrawnScene& scene, const tb::RenderOptions& options,
                                 const RunContext& context) const = 0;
  virtual tb::Image compare_with_reference(const tb::DrawnScene& scene,
                                           const tb::RenderOptions& options,
                                           const tb::Image& before, const tb::Image& after,
                                           tb::Result& result, const RunContext& context) const = 0;

  virtual std::unique_ptr<DrawingStage> build(tb::Simulation& simulation,
                                              const tb::DrawnScene& scene) const = 0;

  // Of several frames, whose flicker is measured: how many, the scene of one, and without a
  // simulation what the golden model draws and the reference of it. An engine without them has one.
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
  // What a title says of its rules. After resolve().
  virtual std::string label() const = 0;
  // Whether it blends in linear light, in which coverage is averaged then.
  virtual bool linear_light() const = 0;
  // What the golden model makes of a picture of the scene, without a simulation; empty: it has
  // none, and no flicker is measured.
  virtual tb::Image golden_picture(const tb::DrawnScene& /*scene*/,
                                   const tb::Image& /*frame*/) const {
    return {};
  }
};

// `frame` is what its golden model gets; without one only its size counts. Scene and role outlive
// the stage.
class MeshSmoother : public PictureSmoother {
 public:
  // Marks what it smooths, since an engine follows that looks at it.
  virtual void mark(tb::ParameterSet&, std::string_view /*why*/) {}
  virtual std::unique_ptr<MeshStage> build(tb::Simulation& simulation, const tb::DrawnScene& scene,
                                           tb::Image frame) const = 0;
};

class RowSmoother : public PictureSmoother {
 public:
  // Whether it looks at Handed::kMarkedPixels where they are.
  virtual bool looks_at_marks() const { return false; }
  // Behind an engine that marks what it smooths: the preset where none is given, then the rules
  // that no preset has.
  virtual void follow_preset(tb::ParameterSet&, std::string_view /*why*/) {}
  virtual void follow(tb::ParameterSet&, std::string_view /*why*/) {}
  // Made in the constructor of the frame buffer, whose port it is; build() binds it.
  virtual std::unique_ptr<RowsPort> rows_port(const char* name,
                                              const tb::DrawnScene& scene) const = 0;
  virtual std::unique_ptr<RowStage> build(tb::Simulation& simulation, const tb::DrawnScene& scene,
                                          tb::Image frame, RowsPort& port) const = 0;
};

}  // namespace deburr::tool
