// SPDX-License-Identifier: MIT
// `deburr run geometric`: a lit scene and the edges of its mesh through the geometric engine.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "golden/geometric/configuration.h"
#include "tb/base/interrupt.h"
#include "tb/engines/geometric/geometric_environment.h"
#include "tb/engines/geometric/geometric_testbench.h"
#include "tb/run/amount.h"
#include "tb/run/progress.h"
#include "tool/engines/geometric/geometric_configuration.h"
#include "tool/engines/geometric/geometric_draws.h"
#include "tool/engines/geometric/geometric_pictures.h"
#include "tool/engines/geometric/geometric_role.h"
#include "tool/run/flicker.h"
#include "tool/run/input_rules.h"
#include "tool/run/pictures.h"
#include "tool/run/shorthands.h"
#include "tool/run/simulate.h"

namespace deburr::tool {

using tb::LoadedGeometricFrame;
using tb::name_of;

namespace {

class GeometricCommand final : public Engine, public tb::GeometricTestbench {
 public:
  std::string_view summary() const override {
    return "Smooth a lit scene along the edges of its mesh with the geometric engine";
  }
  std::unique_ptr<CompositionRole> role() const override { return make_geometric_role(); }

  void resolve(tb::ParameterSet& set) override {
    apply_preset(set, parameters_);
    lists_ = lists_of(scene_);
    frames_ = frames_of(set, sequence_, lists_);
    imply_crossings(set, "scene.crossings", parameters_);
    reject_unused_configuration(set, parameters_);
    reject_unused_memory(set, "memory", memory_);
    reject_slow_memory(set, "memory", memory_);
    if (set.find("run.reference")->text() == "false" && frames_ == 1)
      set.reject("scene.reference_samples", "it needs run.reference (--truth)");
    preset_label_ = preset_label(set, parameters_);
  }

  std::vector<std::string_view> examples() const override {
    return {"--in mesh.obj --size 1280x720 --truth --out out/mesh",
            "--scene wing --preset gpaa --walkers 2"};
  }
  std::vector<Shorthand> shorthands() const override {
    return joined({{"--scene", "scene.source",
                    "Scene: cube, wheelcover (default), wing, canopy, sphere, ..."},
                   {"--in", "scene.source", "Mesh file instead of a scene: .obj, .gltf, .glb"},
                   {"--size", "scene.width", "Size of the frame, WxH (640x480)", "scene.height"}},
                  joined(edge_shorthands(), sequence_shorthands()));
  }

  void check(const RunParameters& run, RunContext& context) override { check(*load(run, context)); }

  void run(const RunParameters& run, RunContext& context, tb::Result& result) override {
    const std::shared_ptr<const LoadedGeometricFrame> shared = load(run, context);
    const LoadedGeometricFrame& loaded = *shared;
    check(loaded);
    const tb::geometric::Frame& frame = loaded.frame;
    tb::MeshFiles meshes;
    context.add_inputs(frames_ > 1 ? input_files(meshes) : loaded.inputs);
    context.set_title(
        "Geometric engine: " + std::filesystem::path(scene_.source).filename().string(),
        summary_line(frame));
    for (const std::string& note : loaded.notes) context.add_note(note);
    for (const std::string& note : build_notes(rtl::geometric::sized(
             parameters_, memory_cycles(tb::GeometricSetup{parameters_, memory_}))))
      context.add_note(note);
    const std::vector<tb::geometric::Frame> frames(static_cast<std::size_t>(scene_.count), frame);
    tb::Simulation simulation(simulation_options(run, context));
    tb::GeometricEnvironment environment(simulation, frames, {parameters_, memory_});
    simulate(simulation, environment, context, result, [&] {
      for (const std::string& note : dropped_notes(environment.engine().work()))
        context.add_note(note);
      add_pictures(run, context, loaded, environment, result);
    });
    if (frames_ > 1 && !result.interrupted && !context.checking_only())
      measure_flicker(frames_, context, result,
                      [&](int i) { return picture_of(i, static_cast<std::uint32_t>(run.seed)); });
  }

  void prepare(const RunParameters& run, RunContext& context) override { load(run, context); }

  std::vector<std::string_view> pictures() const override {
    return {"before", "after",  "golden",  "difference", "reference",
            "error",  "change", "weights", "classes"};
  }
  std::vector<std::string_view> maps() const override {
    return {"lines", "passed", "weight", "depth_reads"};
  }

  std::string_view pixel_history() const override {
    return "lines that pass it, candidates with depth and test, weights, colour";
  }

  RandomDraws random_draws() const override { return geometric_draws(); }
  LongRun long_run() const override { return {{{"scene.count", "60"}}}; }

 private:
  // Checks that need no rendering.
  void check(const tb::Scene& scene) const {
    reject_too_many_faces(scene, parameters_);
    golden::geometric::check_frame(parameters_, {scene_.width, scene_.height, 0, 0, 0});
  }

  void check(const LoadedGeometricFrame& loaded) const {
    check(loaded.scene);
    reject_nothing_drawn(loaded.scene, loaded.frame.depth);
    const tb::geometric::Frame& frame = loaded.frame;
    golden::geometric::check_frame(
        parameters_, {frame.image.width, frame.image.height, frame.screen.edges.size(),
                      frame.screen.vertices.size(), frame.screen.faces});
  }

  std::shared_ptr<const LoadedGeometricFrame> load(const RunParameters& run,
                                                   const RunContext& context) const {
    const bool reference = run.reference && !context.checking_only();
    return context.shared<LoadedGeometricFrame>(
        "geometric frame", {"scene.", "run.reference"}, [&] {
          tb::Waiting waiting(reference ? "rendering frame and reference" : "rendering the frame",
                              context.quiet());
          return tb::load_geometric_frame(
              in_frame(scene_, lists_, 0), static_cast<std::uint32_t>(run.seed), reference,
              [&] {
                waiting.update();
                return tb::interrupted();
              },
              [&](const tb::Scene& scene) { check(scene); });
        });
  }

  SequencePicture picture_of(int frame, std::uint32_t seed) const {
    tb::GeometricSceneParameters wanted = in_frame(scene_, lists_, frame);
    wanted.move = move_of(sequence_, lists_, frame);
    const LoadedGeometricFrame loaded =
        tb::load_geometric_frame(wanted, seed, true, [] { return tb::interrupted(); });
    check(loaded);
    return {loaded.frame.image, tb::geometric::smoothed(loaded.frame, parameters_).image,
            *loaded.reference};
  }

  std::string summary_line(const tb::geometric::Frame& frame) const {
    const spec::geometric::Parameters& p = parameters_;
    std::string clipped, crease;
    if (frame.screen.clipped > 0)
      clipped = fmt::format(" ({} clipped)", tb::grouped(frame.screen.clipped));
    if (p.select == spec::geometric::Select::kEdges)
      crease = fmt::format(", creases {}", name_of(p.crease, spec::geometric::kCreaseNames));
    return fmt::format(
        "{} x {} pixels, {} faces, {} edges{}, {}: select {}{}, depth test {}, combine {}, {} "
        "light; {} of 8 x 8 pixels, {} edges, {} pixels per cycle{}; memory latency {}",
        frame.image.width, frame.image.height, tb::grouped(frame.screen.faces),
        tb::grouped(frame.screen.edges.size()), clipped, preset_label_,
        name_of(p.select, spec::geometric::kSelectNames), crease,
        name_of(p.depth_test, spec::geometric::kDepthTestNames),
        name_of(p.combine, spec::geometric::kCombineNames), p.linear_light ? "linear" : "stored",
        p.layout == spec::geometric::Layout::kTiled ? "tiles" : "rows instead",
        name_of(p.edge_lanes, spec::geometric::kLanesNames),
        name_of(p.walkers, spec::geometric::kLanesNames),
        p.frame_copy ? ", the frame copied first" : "", latency_text(memory_));
  }

  void add_pictures(const RunParameters& run, RunContext& context,
                    const LoadedGeometricFrame& loaded, const tb::GeometricEnvironment& engine,
                    tb::Result& result) const {
    const tb::Image& before = loaded.frame.image;
    const tb::Image after = engine.frame();
    if (after.pixels.size() != before.pixels.size()) return;  // no frame was started
    tb::Image expected(after.width, after.height);
    const bool golden = run.check == CheckMode::kGolden &&
                        engine.golden_model().pixels().size() == expected.pixels.size();
    if (golden) expected.pixels = engine.golden_model().pixels();
    add_frame_pictures(context, {before, after, after.pixels.size(), golden ? &expected : nullptr,
                                 loaded.reference ? &*loaded.reference : nullptr,
                                 "the lit frame as rendered", loaded.reference_name});
    add_edge_pictures(context, loaded.frame, parameters_, engine.blocks());
    if (!engine.done()) return;
    result.change = measure_change(before, after, loaded.reference ? &*loaded.reference : nullptr);
    if (loaded.reference)
      result.quality = measure_quality(loaded.reference_name, before, after, *loaded.reference,
                                       &loaded.frame.depth);
  }

  tb::FrameLists lists_;
  int frames_ = 1;
  std::string preset_label_;
};

}  // namespace

std::unique_ptr<Engine> make_geometric_engine() { return std::make_unique<GeometricCommand>(); }

}  // namespace deburr::tool
