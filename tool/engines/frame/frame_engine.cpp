// SPDX-License-Identifier: MIT
// `deburr run frame`: draws a scene, and smooths it with the engines that declare a smoothing role.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "spec/error.h"
#include "tb/base/interrupt.h"
#include "tb/run/amount.h"
#include "tool/engines/frame/frame_composition.h"
#include "tool/engines/frame/frame_roles.h"
#include "tool/run/flicker.h"
#include "tool/run/pictures.h"
#include "tool/run/simulate.h"

namespace deburr::tool {

using tb::DrawnScene;

namespace {

class FrameCommand final : public Engine {
 public:
  std::string_view name() const override { return "frame"; }
  std::string_view summary() const override {
    return "Draw a scene into a frame buffer and smooth it with one or two engines";
  }

  void add_parameters(tb::ParameterSet& set) override {
    roles().add_parameters(set);
    set.add("run", tb::ParameterKind::kRun, program_);
  }
  void resolve(tb::ParameterSet& set) override { roles().resolve(set); }

  std::vector<std::string_view> examples() const override {
    two_ = fmt::format("--in mesh.obj --smoothing {} --out out/joined",
                       roles().smoothings().back().name);
    return {"--scene object --size 512x512 --storage memory --truth --out out/whole", two_};
  }
  std::vector<Shorthand> shorthands() const override { return roles().shorthands(); }

  void check(const RunParameters& run, RunContext& context) override { check(*load(run, context)); }

  void run(const RunParameters& run, RunContext& context, tb::Result& result) override {
    const std::shared_ptr<const DrawnScene> shared = load(run, context);
    const DrawnScene& scene = *shared;
    check(scene);
    tb::MeshFiles meshes;
    context.add_inputs(drawer().frames() > 1 ? input_files(meshes) : scene.inputs());
    context.set_title("Frame: " + std::filesystem::path(drawer().source()).filename().string(),
                      fmt::format("{} x {} pixels, {} fragments; {} ({}), frame buffer and {}",
                                  scene.stream().width, scene.stream().height,
                                  tb::grouped(scene.stream().counts.fragments), drawer().title(),
                                  drawer().label(), engines_line()));
    for (const std::string& note : scene.scene().mesh.notes) context.add_note(note);
    for (const PictureSmoother* smoother : roles().chosen_smoothers())
      for (const std::string& note : smoother->notes()) context.add_note(note);
    tb::Simulation simulation(simulation_options(run, context));
    FrameComposition frame(simulation, scene, roles());
    simulate(simulation, frame, context, result, [&] {
      for (const std::string& note : frame.notes()) context.add_note(note);
      add_pictures(run, context, scene, frame, result);
    });
    if (drawer().frames() > 1 && !result.interrupted && !context.checking_only())
      measure_flicker(drawer().frames(), context, result,
                      [&](int i) { return picture_of(i, static_cast<std::uint32_t>(run.seed)); });
  }

  std::vector<std::filesystem::path> input_files(tb::MeshFiles& meshes) const override {
    return drawer().input_files(meshes);
  }

  void prepare(const RunParameters& run, RunContext& context) override {
    const std::shared_ptr<const DrawnScene> scene = load(run, context);
    if (run.reference) drawer().prepare_reference(*scene, reference_options(), context);
  }

  // Covers all engines at once.
  void describe_statistics(tb::Result& result) override {
    const std::shared_ptr<const DrawnScene> scene = drawer().smallest();
    tb::Simulation simulation({});
    const std::unique_ptr<FrameComposition> frame =
        FrameComposition::of_all(simulation, *scene, roles());
    describe(simulation, *frame, result);
    add_flicker(result, {}, {});
  }

  // Covers the chosen engines.
  void describe_build(tb::Result& result) override {
    const std::shared_ptr<const DrawnScene> scene = drawer().smallest();
    tb::Simulation simulation({});
    FrameComposition frame(simulation, *scene, roles());
    describe(simulation, frame, result);
  }

  std::vector<std::string_view> parts() const override {
    std::vector<std::string_view> names;
    for (const CompositionRole* role : roles().all()) names.push_back(role->name());
    return names;
  }
  std::vector<std::string_view> pictures() const override {
    std::vector<std::string_view> all = {"before",    "after", "golden", "difference",
                                         "reference", "error", "change"};
    for (const CompositionRole* role : roles().all())
      for (const std::string_view picture : role->pictures())
        if (std::find(all.begin(), all.end(), picture) == all.end()) all.push_back(picture);
    return all;
  }

  RandomDraws random_draws() const override {
    RandomDraws own;
    own.frequent = {"frame.smoothing"};
    return own;
  }
  LongRun long_run() const override {
    LongRun all;
    for (const CompositionRole* role : roles().all()) {
      const LongRun one = role->long_run();
      all.settings.insert(all.settings.end(), one.settings.begin(), one.settings.end());
      all.without.insert(all.without.end(), one.without.begin(), one.without.end());
    }
    return all;
  }

 private:
  // Created on first use: listing the engines creates one of these too.
  FrameRoles& roles() const {
    if (!roles_) roles_ = std::make_unique<FrameRoles>();
    return *roles_;
  }
  const PictureDrawer& drawer() const { return roles().drawer(); }

  std::shared_ptr<const DrawnScene> load(const RunParameters& run,
                                         const RunContext& context) const {
    return drawer().load(static_cast<std::uint32_t>(run.seed), context);
  }

  void check(const DrawnScene& scene) const {
    drawer().check(scene);
    for (const PictureSmoother* smoother : roles().chosen_smoothers()) smoother->check(scene);
  }

  SequencePicture picture_of(int frame, std::uint32_t seed) const {
    const std::shared_ptr<const DrawnScene> scene = drawer().scene_of(frame, seed);
    check(*scene);
    const tb::Image before = drawer().golden_picture(*scene);
    tb::Image after = before;
    for (const PictureSmoother* smoother : roles().chosen_smoothers()) {
      after = smoother->golden_picture(*scene, after);
      if (after.empty())
        throw spec::ConfigError(
            fmt::format("the {} has no golden picture of a single frame, so flicker cannot be "
                        "measured: leave out sequence.frames",
                        smoother->title()));
    }
    tb::RenderOptions options = reference_options();
    options.interrupted = [] { return tb::interrupted(); };
    return {before, std::move(after), drawer().reference_of(*scene, options)};
  }

  std::string engines_line() const {
    std::string line;
    for (const PictureSmoother* smoother : roles().chosen_smoothers())
      line +=
          fmt::format("{}{} ({})", line.empty() ? "" : ", ", smoother->title(), smoother->label());
    return line + (roles().chosen().mesh ? " in one clock domain, one after the other"
                                         : " in one clock domain, overlapped row by row");
  }

  tb::RenderOptions reference_options() const {
    tb::RenderOptions options;
    // Coverage is averaged in the light (linear or encoded) in which the last engine blends.
    options.averaging = roles().chosen_smoothers().back()->linear_light() ? tb::Averaging::kLinear
                                                                          : tb::Averaging::kStored;
    return options;
  }

  void add_pictures(const RunParameters& run, RunContext& context, const DrawnScene& scene,
                    const FrameComposition& frame, tb::Result& result) const {
    const tb::Image& before = frame.buffer().frame();
    const tb::Image after = frame.frame();
    const bool whole = frame.delivered() == after.pixels.size();
    tb::Image expected, reference;
    if (after.pixels.size() != before.pixels.size()) return;  // nothing was started
    const bool golden = run.check == CheckMode::kGolden;
    if (golden) expected = frame.expected_frame();
    if (run.reference && whole)
      reference = drawer().compare_with_reference(scene, reference_options(), before, after, result,
                                                  context);
    if (whole)
      result.change = measure_change(before, after, reference.empty() ? nullptr : &reference);
    const SmoothedFrame smoothed{before,
                                 after,
                                 frame.delivered(),
                                 golden ? &expected : nullptr,
                                 reference.empty() ? nullptr : &reference,
                                 std::string(drawer().caption()),
                                 drawer().reference_caption()};
    if (frame.rows())
      frame.rows()->add_pictures(context, smoothed);
    else
      add_frame_pictures(context, smoothed);
    if (frame.mesh()) frame.mesh()->add_pictures(context, before, frame.rows() != nullptr);
  }

  tb::ProgramParameters program_;  // of the smoothing engines
  mutable std::unique_ptr<FrameRoles> roles_;
  mutable std::string two_;  // an example
};

}  // namespace

std::unique_ptr<Engine> make_frame_engine() { return std::make_unique<FrameCommand>(); }

}  // namespace deburr::tool
