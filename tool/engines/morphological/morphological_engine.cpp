// SPDX-License-Identifier: MIT
// `deburr run morphological`: an image, or a scene without anti-aliasing, through the morphological
// engine.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>

#include "golden/morphological/configuration.h"
#include "spec/error.h"
#include "tb/base/file.h"
#include "tb/base/interrupt.h"
#include "tb/engines/morphological/morphological_environment.h"
#include "tb/engines/morphological/morphological_testbench.h"
#include "tb/run/progress.h"
#include "tb/scene/image_bytes.h"
#include "tb/scene/reference.h"
#include "tool/engines/morphological/morphological_configuration.h"
#include "tool/engines/morphological/morphological_draws.h"
#include "tool/engines/morphological/morphological_pictures.h"
#include "tool/engines/morphological/morphological_role.h"
#include "tool/run/flicker.h"
#include "tool/run/input_rules.h"
#include "tool/run/pictures.h"
#include "tool/run/shorthands.h"
#include "tool/run/simulate.h"

namespace deburr::tool {

using tb::Image;
using tb::LoadedFrame;
using tb::name_of;

namespace {

class MorphologicalCommand final : public Engine, public tb::MorphologicalTestbench {
 public:
  std::string_view summary() const override {
    return "Smooth an image or a scene with the morphological engine, checked pixel by pixel";
  }
  std::unique_ptr<CompositionRole> role() const override { return make_morphological_role(); }

  void resolve(tb::ParameterSet& set) override {
    apply_preset(set, parameters_);
    lists_ = lists_of(frame_);
    frames_ = frames_of(set, sequence_, lists_);
    if (frames_ > 1 && lists_.frames() == 1 && !is_rendered(first()) && tb::is_there(frame_.source))
      throw spec::ConfigError(
          "sequence.frames: a single image file has no motion: give one file per frame, such as "
          "--in 'frames/*.png'");
    if (!frame_.mask.empty()) {
      set.imply("morphological.bypass", "masked", "frame.mask");
      if (parameters_.bypass == spec::morphological::Bypass::kNone)
        set.reject("frame.mask", "morphological.bypass = none ignores the mask");
    }
    reject_unused_configuration(set, parameters_, "memory");
    reject_unused_memory(set, "memory", memory_);
    if (parameters_.storage == spec::morphological::Storage::kMemory)
      reject_slow_memory(set, "memory", memory_);
    else if (set.find("run.line_trace")->text() != "none")
      set.reject("run.line_trace",
                 "no memory is used: only morphological.storage = memory requests lines");
    if (!frame_.weights.empty() && parameters_.area != spec::morphological::AreaSource::kLearned)
      set.reject("frame.weights",
                 fmt::format("morphological.area = {} does not use learned weights",
                             name_of(parameters_.area, spec::morphological::kAreaSourceNames)));
    reject_unused_frame(set);
    preset_label_ = preset_label(set, parameters_);
  }

  std::vector<std::string_view> examples() const override {
    return {"--scene road --size 1280x720 --out out/road",
            "--in frame.png --preset smaa --lanes 2 --out out/smaa",
            "--storage memory --set memory.latency=200"};
  }
  std::vector<Shorthand> shorthands() const override {
    return joined(
        {{"--in", "frame.source",
          "Image file of any format that OpenImageIO reads, or a mesh file"},
         {"--scene", "frame.source", "Scene instead of a file: cylinders (default), road, ..."},
         {"--truth", "frame.reference", "Anti-aliased picture to compare with"},
         {"--depth", "frame.depth",
          "Depth of the image, for depth edges and the quality of silhouettes"},
         {"--mask", "frame.mask", "Mask of pixels to bypass: white pixels are not changed"},
         {"--shares", "frame.weights",
          "Learned weights of `deburr train` instead of those shipped"},
         {"--size", "frame.width", "Size of a rendered scene, WxH (640x480)", "frame.height"}},
        joined(smoothing_shorthands(), sequence_shorthands()));
  }

  void check(const RunParameters& run, RunContext& context) override {
    check(run, *load(run, context));
  }

  void run(const RunParameters& run, RunContext& context, tb::Result& result) override {
    const std::shared_ptr<const LoadedFrame> shared = load(run, context);
    const LoadedFrame& loaded = *shared;
    check(run, loaded);
    tb::MeshFiles meshes;
    context.add_inputs(frames_ > 1 ? input_files(meshes) : loaded.inputs);
    context.set_title(
        "Morphological engine: " + std::filesystem::path(frame_.source).filename().string(),
        summary_line(loaded));
    for (const std::string& conversion : loaded.conversions) context.add_note(conversion);
    for (const std::string& note : build_notes(parameters_)) context.add_note(note);
    const std::vector<tb::MorphologicalInput> frames(static_cast<std::size_t>(frame_.count),
                                                     loaded.input);
    tb::Simulation simulation(simulation_options(run, context));
    tb::MorphologicalEnvironment environment(simulation, frames,
                                             {.morphological = parameters_,
                                              .memory = memory_,
                                              .weights = loaded.weights,
                                              .expectation = golden_of(loaded, context)});
    simulate(simulation, environment, context, result,
             [&] { add_pictures(run, context, loaded, environment, result); });
    if (frames_ > 1 && !result.interrupted && !context.checking_only())
      measure_flicker(frames_, context, result, [&](int frame) {
        return picture_of(frame, static_cast<std::uint32_t>(run.seed));
      });
  }

  void prepare(const RunParameters& run, RunContext& context) override {
    golden_of(*load(run, context), context);
  }

  std::vector<std::string_view> pictures() const override {
    return {"before", "after",  "golden", "difference", "reference",
            "error",  "change", "edges",  "weights"};
  }
  std::string_view pixel_history() const override {
    return "edges, runs and lines of its four sides, weights, blend, colour";
  }
  std::vector<std::string_view> maps() const override { return {"edges", "run_length", "steps"}; }

  RandomDraws random_draws() const override { return morphological_draws(); }
  LongRun long_run() const override { return {{{"frame.count", "300"}}}; }

 private:
  void check(const RunParameters& run, const LoadedFrame& loaded) const {
    if (is_rendered(first())) reject_nothing_drawn(*loaded.depth, first().source);
    if (run.reference && !loaded.reference)
      throw spec::ConfigError(
          "run.reference: this image comes without a reference; name one with --truth FILE");
    const Image& image = loaded.input.image;
    golden::morphological::check_frame(parameters_, image.width, image.height);
  }

  std::shared_ptr<const LoadedFrame> load(const RunParameters& run,
                                          const RunContext& context) const {
    tb::FrameParameters wanted = first();
    if (context.checking_only()) wanted.reference_samples = std::min(1, wanted.reference_samples);
    const auto render = [&](const std::function<tb::LitFrames()>& make) {
      const std::string bytes = context.shared_bytes("lit frames", {"frame."}, [&] {
        const tb::LitFrames frames = make();
        std::string made;
        append_bytes(made, frames.noaa);
        append_bytes(made, frames.reference);
        append_bytes(made, frames.depth);
        return made;
      });
      std::string_view rest = bytes;
      tb::LitFrames frames;
      frames.noaa = tb::take_image<tb::Rgba8>(rest);
      frames.reference = tb::take_image<tb::Rgba8>(rest);
      frames.depth = tb::take_image<float>(rest);
      return frames;
    };
    return context.shared<LoadedFrame>("loaded frame", {"frame."}, [&] {
      tb::Waiting waiting("rendering scene and reference", context.quiet());
      return tb::load_frame(
          wanted, static_cast<std::uint32_t>(run.seed),
          [&] {
            waiting.update();
            return tb::interrupted();
          },
          render);
    });
  }

  std::shared_ptr<const golden::morphological::MorphologicalGolden> golden_of(
      const LoadedFrame& loaded, const RunContext& context) const {
    using golden::morphological::MorphologicalGolden;
    return context.shared_golden<MorphologicalGolden>(built_for_golden(), [&] {
      return tb::golden_frame(loaded.input, parameters_, weights_of(loaded));
    });
  }

  static const golden::morphological::WeightTables* weights_of(const LoadedFrame& loaded) {
    return loaded.weights ? &*loaded.weights : nullptr;
  }

  tb::FrameParameters first() const { return in_frame(frame_, lists_, 0); }

  SequencePicture picture_of(int frame, std::uint32_t seed) const {
    tb::FrameParameters wanted = in_frame(frame_, lists_, frame);
    wanted.move = move_of(sequence_, lists_, frame);
    const LoadedFrame loaded = tb::load_frame(wanted, seed, [] { return tb::interrupted(); });
    const Image& image = loaded.input.image;
    golden::morphological::check_frame(parameters_, image.width, image.height);
    Image after(image.width, image.height);
    after.pixels = tb::golden_frame(loaded.input, parameters_, weights_of(loaded)).pixels();
    return {image, std::move(after), loaded.reference ? *loaded.reference : Image()};
  }

  void reject_unused_frame(const tb::ParameterSet& set) const {
    const bool depth_used = parameters_.edge_source == spec::morphological::EdgeSource::kDepth ||
                            parameters_.edge_source == spec::morphological::EdgeSource::kPredicated;
    // load_frame() has its own messages for a reference given with a scene, and for a missing file.
    if (is_rendered(first()) || !tb::is_there(first().source)) return;
    for (const char* name : {"frame.width", "frame.height"})
      set.reject(name, "frame.source is an image file, which determines the size");
    set.reject("frame.reference_samples",
               "an image file is compared with the file frame.reference (--truth)");
    if (depth_used && frame_.depth.empty())
      throw spec::ConfigError(fmt::format(
          "morphological.edges.source = {} needs the depth of the image: name it with --depth FILE",
          name_of(parameters_.edge_source, spec::morphological::kEdgeSourceNames)));
    if (!depth_used && frame_.reference.empty())
      set.reject("frame.depth",
                 "edges are found in colours, and silhouettes are measured only with --truth FILE");
  }

  std::string summary_line(const LoadedFrame& loaded) const {
    const spec::morphological::Parameters& p = parameters_;
    const int lanes = spec::morphological::kLaneCount[static_cast<std::size_t>(p.lanes)];
    return fmt::format(
        "{} x {} pixels, {}: edges from {} at T = {:.2f} codes, local contrast {}, predictor {} "
        "with N = {}{}{}{}, {} light; {} pixel{} per cycle, {} window rows, {}",
        loaded.input.image.width, loaded.input.image.height, preset_label_,
        name_of(p.edge_source, spec::morphological::kEdgeSourceNames), p.threshold / 65536.0,
        name_of(p.local_contrast, spec::morphological::kLocalContrastNames),
        name_of(p.predictor, spec::morphological::kPredictorNames), p.steps,
        p.contiguous ? ", contiguous" : "", p.safe ? ", safe" : "", p.trim ? ", trim" : "",
        p.linear_light ? "linear" : "stored", lanes, lanes == 1 ? "" : "s", p.window_rows,
        name_of(p.storage, spec::morphological::kStorageNames));
  }

  static void add_pictures(const RunParameters& run, RunContext& context, const LoadedFrame& loaded,
                           const tb::MorphologicalEnvironment& engine, tb::Result& result) {
    const Image& before = loaded.input.image;
    const Image& after = engine.frame();
    if (after.pixels.size() != before.pixels.size()) return;  // no frame was started
    Image expected(after.width, after.height);
    const bool golden = run.check == CheckMode::kGolden &&
                        engine.golden_model().pixels().size() == expected.pixels.size();
    if (golden) expected.pixels = engine.golden_model().pixels();
    add_smoothing_pictures(
        context,
        {before, after, engine.delivered(), golden ? &expected : nullptr,
         loaded.reference ? &*loaded.reference : nullptr, "the input frame", loaded.reference_name},
        engine.probes());
    if (engine.delivered() < after.pixels.size()) return;
    result.change = measure_change(before, after, loaded.reference ? &*loaded.reference : nullptr);
    if (loaded.reference)
      result.quality = measure_quality(loaded.reference_name, before, after, *loaded.reference,
                                       loaded.depth ? &*loaded.depth : nullptr);
  }

  tb::FrameLists lists_;
  int frames_ = 1;
  std::string preset_label_;
};

}  // namespace

std::unique_ptr<Engine> make_morphological_engine() {
  return std::make_unique<MorphologicalCommand>();
}

}  // namespace deburr::tool
