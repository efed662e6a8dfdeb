// SPDX-License-Identifier: MIT
// `deburr run frame`: a scene through the texture unit and the engines that smooth.
#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <utility>

#include "golden/morphological/configuration.h"
#include "spec/error.h"
#include "spec/geometric/check_build.h"
#include "spec/morphological/check_build.h"
#include "spec/texture/check_build.h"
#include "tb/app/input_rules.h"
#include "tb/app/pictures.h"
#include "tb/app/shorthands.h"
#include "tb/app/simulate.h"
#include "tb/engines/frame/frame_composition.h"
#include "tb/engines/geometric/geometric_pictures.h"
#include "tb/engines/geometric/geometric_rules.h"
#include "tb/engines/morphological/morphological_pictures.h"
#include "tb/engines/morphological/morphological_rules.h"
#include "tb/engines/texture/texture_rules.h"
#include "tb/engines/texture/texture_traces.h"
#include "tb/engines/texture/texture_truth.h"
#include "tb/scene/truth.h"

namespace deburr::tb {
namespace {

struct FrameChoice {
  Smoothing smoothing = Smoothing::kMorphological;
};

template <class Visitor>
void describe(FrameChoice& p, Visitor& v) {
  v.choice("smoothing", p.smoothing, kSmoothingNames,
           "What smooths the textured frame: the morphological engine, the geometric one, or the "
           "first behind the second.");
}

// Why a parameter is what it is.
constexpr std::string_view kFollows = "frame.smoothing = geometric-morphological";

class FrameCommand final : public Engine {
 public:
  FrameCommand() { scene_.source = "object"; }

  std::string_view name() const override { return "frame"; }
  std::string_view summary() const override {
    return "A scene through the texture unit, a frame buffer and the engines that smooth";
  }

  void add_parameters(ParameterSet& set) override {
    set.add("run", ParameterKind::kRun, look_up_trace_);
    set.add("scene", ParameterKind::kInput, scene_);
    add_sampler(set, sampler_);
    set.add("frame", ParameterKind::kRule, choice_);
    set.add_engine("texture", texture_);
    add_memory(set, "memory", memory_);
    set.add_engine("geometric", geometric_);
    add_memory(set, "geometric_memory", geometric_memory_);
    set.add_engine("morphological", morphological_);
    add_memory(set, "frame_memory", frame_memory_);
  }
  void resolve(ParameterSet& set) override {
    apply_preset(set, texture_);
    apply_preset(set, geometric_);
    const bool follows = choice_.smoothing == Smoothing::kGeometricMorphological;
    if (follows)
      set.imply("morphological.preset",
                spec::morphological::kPresetNames[static_cast<std::size_t>(
                    spec::morphological::FollowingRules().preset)],
                kFollows);
    apply_preset(set, morphological_);
    if (follows) let_follow(set);
    resolve_geometric(set);
    resolve_morphological(set);
    refuse_unused_look_ups(set);
    refuse_unused_memory(set, "memory", memory_);
    refuse_slow_memory(set, "memory", memory_);
    refuse_empty_lod_range(sampler_);
    if (sampler_.format == spec::texture::Format::kSrgb8A8 &&
        texture_.srgb_output == spec::texture::SrgbOutput::kLinear)
      throw spec::ConfigError(
          "sampler.format: the frame buffer keeps codes, and srgb8_a8 delivers linear light: set "
          "texture.srgb_output = encoded");
  }

  std::vector<std::string_view> examples() const override {
    return {"--scene object --size 512x512 --storage memory --truth --out out/whole",
            "--in mesh.obj --smoothing geometric-morphological --out out/joined"};
  }
  std::vector<Shorthand> shorthands() const override {
    return joined(joined(scene_shorthands("object"), smoothing_shorthands()),
                  {{"--smoothing", "frame.smoothing",
                    "morphological (default), geometric or geometric-morphological"}});
  }

  void judge(const RunParameters& run, RunContext& context) override { judge(*load(run, context)); }

  void run(const RunParameters& run, RunContext& context, Result& result) override {
    const std::shared_ptr<const TextureScene> shared = load(run, context);
    const TextureScene& scene = *shared;
    judge(scene);
    context.add_inputs(scene.inputs());
    context.set_title("Frame: " + std::filesystem::path(scene_.source).filename().string(),
                      fmt::format("{} x {} pixels, {} fragments; texture unit, frame buffer and {}",
                                  scene.stream().width, scene.stream().height,
                                  scene.stream().counts.fragments, engines_line()));
    for (const std::string& note : scene.scene().mesh.notes) context.add_note(note);
    if (has_geometric(choice_.smoothing))
      for (const std::string& note : build_notes(geometric_)) context.add_note(note);
    if (has_morphological(choice_.smoothing))
      for (const std::string& note : build_notes(morphological_)) context.add_note(note);
    Simulation simulation(simulation_options(run, context));
    FrameComposition frame(simulation, scene, setup(choice_.smoothing));
    simulate(simulation, frame, context, result,
             [&] { add_pictures(run, context, scene, frame, result); });
  }

  std::vector<std::filesystem::path> input_files(MeshFiles& meshes) const override {
    return scene_files(scene_, meshes);
  }

  void prepare(const RunParameters& run, RunContext& context) override {
    const std::shared_ptr<const TextureScene> scene = load(run, context);
    if (run.truth) scene_truth(*scene, truth_options(), context);
  }

  // Of all engines at once.
  void describe_statistics(Result& result) override {
    const TextureScene scene = smallest(scene_, sampler_);
    Simulation simulation({});
    FrameComposition frame(simulation, scene, setup(Smoothing::kGeometricMorphological));
    describe(simulation, frame, result);
  }

  std::vector<std::string_view> parts() const override {
    return {"texture", "geometric", "morphological"};
  }
  std::vector<std::string_view> pictures() const override {
    return {"before", "after", "golden",  "difference", "truth",       "error",
            "change", "edges", "weights", "classes",    "edge_weights"};
  }

  RandomDraws random_draws() const override {
    RandomDraws own;
    own.frequent = {"frame.smoothing"};
    return own;
  }
  LongRun long_run() const override {
    return {{{"scene.width", "321"}, {"scene.height", "243"}}, {".line_pixels", ".touched_words"}};
  }

 private:
  FrameSetup setup(Smoothing smoothing) const {
    return {{texture_, memory_},
            {morphological_, frame_memory_},
            {geometric_, geometric_memory_},
            smoothing};
  }

  void judge(const TextureScene& scene) const {
    refuse_nothing_drawn(scene);
    if (has_geometric(choice_.smoothing)) refuse_too_many_faces(scene.scene(), geometric_);
    if (has_morphological(choice_.smoothing))
      golden::morphological::check_frame(morphological_, scene.stream().width,
                                         scene.stream().height);
  }

  // What the one engine does for the other, unless something else is given.
  void let_follow(ParameterSet& set) const {
    set.imply("geometric.mark", "true", kFollows);
    const spec::morphological::Parameters rules =
        golden::morphological::following_geometric(morphological_);
    std::vector<std::string> names = {"leave"};
    if (rules.edge_source != morphological_.edge_source) names.push_back("edges.source");
    if (rules.edge_source == spec::morphological::EdgeSource::kPredicated &&
        !set.given("morphological.edges.source"))
      names.insert(names.end(),
                   {"edges.threshold_on_depth_edge", "edges.threshold_off_depth_edge"});
    for (const std::string& name : names)
      set.imply("morphological." + name, spec::value_text(rules, name), kFollows);
  }

  void resolve_geometric(ParameterSet& set) {
    if (!has_geometric(choice_.smoothing)) {
      for (const char* const prefix : {"geometric.", "geometric_memory."})
        set.refuse_all(prefix, "frame.smoothing = morphological draws no edges");
      return;
    }
    refuse_unused_rules(set, geometric_);
    refuse_unused_memory(set, "geometric_memory", geometric_memory_);
    refuse_slow_memory(set, "geometric_memory", geometric_memory_);
    geometric_label_ = preset_label(set, geometric_);
  }

  void resolve_morphological(ParameterSet& set) {
    if (!has_morphological(choice_.smoothing)) {
      for (const char* const prefix : {"morphological.", "frame_memory."})
        set.refuse_all(prefix, "frame.smoothing = geometric has no morphological engine");
      return;
    }
    refuse_unused_rules(set, morphological_, "frame_memory");
    refuse_unused_memory(set, "frame_memory", frame_memory_);
    if (morphological_.storage == spec::morphological::Storage::kMemory)
      refuse_slow_memory(set, "frame_memory", frame_memory_);
    morphological_label_ = preset_label(set, morphological_);
  }

  std::string engines_line() const {
    switch (choice_.smoothing) {
      case Smoothing::kMorphological:
        return fmt::format("morphological engine ({}) on one clock, overlapped row by row",
                           morphological_label_);
      case Smoothing::kGeometric:
        return fmt::format("geometric engine ({}) on one clock, one after the other",
                           geometric_label_);
      default:
        return fmt::format(
            "geometric engine ({}), morphological engine ({}) on one clock, one after the other",
            geometric_label_, morphological_label_);
    }
  }

  bool blends_in_linear_light() const {
    return has_morphological(choice_.smoothing) ? morphological_.linear_light
                                                : geometric_.linear_light;
  }

  std::shared_ptr<const TextureScene> load(const RunParameters& run,
                                           const RunContext& context) const {
    return context.shared<TextureScene>("texture scene", {"scene.", "sampler."}, [&] {
      return TextureScene(scene_, sampler_, static_cast<std::uint32_t>(run.seed));
    });
  }

  RenderOptions truth_options() const {
    RenderOptions options;
    // Coverage is averaged in the light in which the engine blends.
    options.averaging = blends_in_linear_light() ? Averaging::kLinear : Averaging::kStored;
    return options;
  }

  void add_pictures(const RunParameters& run, RunContext& context, const TextureScene& scene,
                    const FrameComposition& frame, Result& result) const {
    const Image& before = frame.buffer.frame();
    const Image after = frame.frame();
    const bool whole = frame.delivered() == after.pixels.size();
    Image expected, truth;
    if (after.pixels.size() != before.pixels.size()) return;  // nothing was begun
    const bool golden = run.check == CheckMode::kGolden;
    if (golden) expected = frame.golden_frame();
    if (run.truth && whole)
      truth = judge_by_scene(scene, truth_options(), before, after, result, context);
    if (whole) result.change = measure_change(before, after, truth.empty() ? nullptr : &truth);
    const SmoothedFrame smoothed{before,
                                 after,
                                 frame.delivered(),
                                 golden ? &expected : nullptr,
                                 truth.empty() ? nullptr : &truth,
                                 "textured: what the texture unit left in the frame buffer",
                                 truth_caption()};
    if (frame.morphological)
      add_smoothing_pictures(context, smoothed, frame.morphological->taps());
    else
      add_frame_pictures(context, smoothed);
    if (!frame.geometric) return;
    geometric::Frame edges = frame.edges();
    edges.image = before;
    add_edge_pictures(context, edges, geometric_, frame.geometric->blocks(),
                      frame.morphological ? "edge_weights" : "weights");
  }

  LookUpTrace look_up_trace_;
  SceneParameters scene_;
  SamplerParameters sampler_;
  spec::texture::Parameters texture_;
  MemoryParameters memory_, geometric_memory_, frame_memory_;
  FrameChoice choice_;
  spec::geometric::Parameters geometric_;
  spec::morphological::Parameters morphological_;
  std::string geometric_label_, morphological_label_;
};

}  // namespace

std::unique_ptr<Engine> make_frame_engine() { return std::make_unique<FrameCommand>(); }

}  // namespace deburr::tb
