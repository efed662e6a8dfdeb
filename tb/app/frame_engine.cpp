// SPDX-License-Identifier: MIT
#include "tb/app/frame_engine.h"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <utility>

#include "golden/morphological/configuration.h"
#include "spec/error.h"
#include "tb/app/input_rules.h"
#include "tb/app/morphological_engine.h"
#include "tb/app/morphological_rules.h"
#include "tb/app/pictures.h"
#include "tb/app/shorthands.h"
#include "tb/app/simulate.h"
#include "tb/env/frame_composition.h"
#include "tb/scene/truth.h"

namespace deburr::tb {
namespace {

class FrameCommand final : public Engine {
 public:
  FrameCommand() { scene_.source = "object"; }

  std::string_view name() const override { return "frame"; }
  std::string_view summary() const override {
    return "A scene through the texture unit, a frame buffer and the morphological engine";
  }

  void add_parameters(ParameterSet& set) override {
    set.add("scene", ParameterKind::kInput, scene_);
    set.add("sampler", ParameterKind::kInput, sampler_);
    set.add_engine("texture", texture_);
    add_memory(set, "memory", memory_);
    set.add_engine("morphological", morphological_);
    add_memory(set, "frame_memory", frame_memory_);
  }
  void resolve(ParameterSet& set) override {
    apply_preset(set, morphological_);
    refuse_unused_rules(set, morphological_, "frame_memory");
    refuse_unused_memory(set, "memory", memory_);
    refuse_unused_memory(set, "frame_memory", frame_memory_);
    refuse_slow_memory(set, "memory", memory_);
    if (morphological_.storage == spec::morphological::Storage::kMemory)
      refuse_slow_memory(set, "frame_memory", frame_memory_);
    refuse_empty_lod_range(sampler_);
    preset_label_ = preset_label(set, morphological_);
  }

  std::vector<Shorthand> shorthands() const override {
    return joined(scene_shorthands("object"), smoothing_shorthands());
  }

  void run(const RunParameters& run, RunContext& context, Result& result) override {
    golden::morphological::check_parameters(morphological_);
    if (sampler_.format == spec::texture::Format::kSrgb8A8)
      throw spec::ConfigError(
          "sampler.format: the frame buffer keeps codes; srgb8_a8 delivers linear light");
    const std::shared_ptr<const TextureScene> shared = load(run, context);
    const TextureScene& scene = *shared;
    refuse_nothing_drawn(scene);
    for (const auto& input : scene.inputs()) context.add_input(input);
    context.set_title(
        "Frame: " + std::filesystem::path(scene_.source).filename().string(),
        fmt::format("{} x {} pixels, {} fragments; texture unit, frame buffer and morphological "
                    "engine ({}) on one clock, overlapped row by row",
                    scene.stream().width, scene.stream().height, scene.stream().counts.fragments,
                    preset_label_));
    for (const std::string& note : scene.scene().mesh.notes) context.add_note(note);
    for (const std::string& note : build_notes(morphological_)) context.add_note(note);
    Simulation simulation(simulation_options(run, context));
    FrameComposition frame(simulation, scene, setup());
    simulate(simulation, frame, context, result,
             [&] { add_pictures(run, context, scene, frame, result); });
  }

  void prepare(const RunParameters& run, RunContext& context) override {
    const std::shared_ptr<const TextureScene> scene = load(run, context);
    if (run.truth) scene_truth(*scene, truth_options(), context);
  }

  void describe_statistics(Result& result) override {
    const TextureScene scene = smallest(scene_, sampler_);
    Simulation simulation({});
    FrameComposition frame(simulation, scene, {});
    describe(simulation, frame, result);
  }

 private:
  std::shared_ptr<const TextureScene> load(const RunParameters& run,
                                           const RunContext& context) const {
    return context.shared<TextureScene>("texture scene", {"scene.", "sampler."}, [&] {
      return TextureScene(scene_, sampler_, static_cast<std::uint32_t>(run.seed));
    });
  }

  RenderOptions truth_options() const {
    RenderOptions options;
    // Coverage is averaged in the light in which the engine blends.
    options.averaging = morphological_.linear_light ? Averaging::kLinear : Averaging::kStored;
    return options;
  }

  FrameSetup setup() const { return {{texture_, memory_}, {morphological_, frame_memory_}}; }

  void add_pictures(const RunParameters& run, RunContext& context, const TextureScene& scene,
                    const FrameComposition& frame, Result& result) const {
    const Image& before = frame.buffer.frame();
    const Image& after = frame.smoothing.frame();
    const bool whole = frame.smoothing.delivered() == after.pixels.size();
    Image expected(after.width, after.height), truth;
    if (after.pixels.size() != before.pixels.size()) return;  // nothing was begun
    const bool golden = run.check == CheckMode::kGolden;
    if (golden) expected.pixels = frame.smoothing.golden_model().pixels();
    if (run.truth && whole)
      truth = judge_by_scene(scene, truth_options(), before, after, result, context);
    add_smoothing_pictures(
        context, {before, after, frame.smoothing.taps(), frame.smoothing.delivered(),
                  golden ? &expected : nullptr, truth.empty() ? nullptr : &truth,
                  "textured: what the texture unit left in the frame buffer", truth_caption()});
  }

  SceneParameters scene_;
  SamplerParameters sampler_;
  spec::texture::Parameters texture_;
  MemoryParameters memory_, frame_memory_;
  spec::morphological::Parameters morphological_;
  std::string preset_label_;
};

}  // namespace

std::unique_ptr<Engine> make_frame_engine() { return std::make_unique<FrameCommand>(); }

}  // namespace deburr::tb
