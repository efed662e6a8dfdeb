// SPDX-License-Identifier: MIT
#include "tb/app/texture_engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "spec/error.h"
#include "tb/app/input_rules.h"
#include "tb/app/morphological_rules.h"
#include "tb/app/pictures.h"
#include "tb/app/shorthands.h"
#include "tb/app/simulate.h"
#include "tb/env/texture_environment.h"
#include "tb/results/report.h"
#include "tb/scene/compose.h"
#include "tb/scene/quality.h"
#include "tb/scene/textures.h"
#include "tb/scene/truth.h"

namespace deburr::tb {
namespace {

class TextureEngine final : public Engine {
 public:
  std::string_view name() const override { return "texture"; }
  std::string_view summary() const override {
    return "A scene through the texture unit, checked colour by colour and line by line";
  }

  void add_parameters(ParameterSet& set) override {
    set.add("scene", ParameterKind::kInput, scene_);
    set.add("sampler", ParameterKind::kInput, sampler_);
    set.add_engine("texture", texture_);
    add_memory(set, "memory", memory_);
  }

  std::vector<Shorthand> shorthands() const override {
    return joined(
        scene_shorthands("plane"),
        {{"--wrap", "sampler.wrap", "repeat, mirrored_repeat, clamp_to_edge, or scene (default)"},
         {"--format", "sampler.format", "rgba8 (default), rgb565, rgba4444, l8, srgb8_a8"},
         {"--layout", "sampler.layout", "tiled (default) or linear"}});
  }

  void resolve(ParameterSet& set) override {
    refuse_unused_memory(set, "memory", memory_);
    refuse_slow_memory(set, "memory", memory_);
    refuse_empty_lod_range(sampler_);
  }

  void run(const RunParameters& run, RunContext& context, Result& result) override {
    const std::shared_ptr<const TextureScene> shared = load(run, context);
    const TextureScene& scene = *shared;
    refuse_nothing_drawn(scene);
    for (const auto& input : scene.inputs()) context.add_input(input);
    context.set_title(title(), summary_line(scene));
    for (const std::string& note : scene.scene().mesh.notes) context.add_note(note);
    Simulation simulation(simulation_options(run, context));
    TextureEnvironment environment(simulation, scene,
                                   {texture_, memory_, expectation(scene, context)});
    simulate(simulation, environment, context, result,
             [&] { add_pictures(run, context, scene, environment, result); });
  }

  void prepare(const RunParameters& run, RunContext& context) override {
    const std::shared_ptr<const TextureScene> scene = load(run, context);
    if (run.truth) scene_truth(*scene, truth_options(), context);
    expectation(*scene, context);
  }

  std::vector<std::string_view> built_for_golden() const override {
    return {"texture.cache.bytes", "texture.cache.line_bytes", "texture.cache.ways",
            "texture.cache.replacement"};
  }

  void describe_statistics(Result& result) override {
    const TextureScene scene = smallest(scene_, sampler_);
    Simulation simulation({});
    TextureEnvironment environment(simulation, scene, {});
    describe(simulation, environment, result);
  }

 private:
  std::shared_ptr<const TextureScene> load(const RunParameters& run,
                                           const RunContext& context) const {
    return context.shared<TextureScene>("texture scene", {"scene.", "sampler."}, [&] {
      return TextureScene(scene_, sampler_, static_cast<std::uint32_t>(run.seed));
    });
  }

  std::shared_ptr<const TextureExpectation> expectation(const TextureScene& scene,
                                                        const RunContext& context) const {
    return context.shared_golden<TextureExpectation>(built_for_golden(),
                                                     [&] { return expected_of(scene, texture_); });
  }

  RenderOptions truth_options() const {
    RenderOptions options;
    options.sampling = Sampling::kBilinear;
    options.averaging = linear_light() ? Averaging::kLinear : Averaging::kStored;
    return options;
  }

  std::string title() const {
    return "Texture unit: " + std::filesystem::path(scene_.source).filename().string();
  }

  std::string summary_line(const TextureScene& scene) const {
    const auto name = [](auto value, const auto& names) {
      return names[static_cast<std::size_t>(value)];
    };
    return fmt::format(
        "{} x {} pixels, {} fragments, {}, N_max {}, {} {}; footprint {}, log2 {}, count {}, "
        "kernel {}; "
        "cache {} bytes, {} ways; memory latency {} clk",
        scene.stream().width, scene.stream().height, scene.stream().counts.fragments,
        name(sampler_.mode, spec::texture::kMinFilterNames),
        name(sampler_.anisotropy, kAnisotropyNames),
        name(sampler_.format, spec::texture::kFormatNames),
        name(sampler_.layout, spec::texture::kLayoutNames),
        name(texture_.footprint, spec::texture::kFootprintNames),
        name(texture_.log2, spec::texture::kLog2Names),
        name(texture_.count, spec::texture::kCountNames),
        name(texture_.kernel, spec::texture::kKernelNames), texture_.cache_bytes,
        texture_.cache_ways, memory_.latency);
  }

  bool linear_light() const { return sampler_.format == spec::texture::Format::kSrgb8A8; }

  // The unit delivers linear light for sRGB textures; pictures are stored as sRGB again.
  Image stored(const Image& image, const TextureScene& scene) const {
    if (!linear_light()) return image;
    Image out = image;
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
      if (scene.stream().depth.pixels[i] == 0) continue;  // the sky is not from the unit
      for (std::size_t c = 0; c < 3; ++c)
        out.pixels[i][c] =
            static_cast<std::uint8_t>(std::lround(255 * linear_to_srgb(out.pixels[i][c] / 255.0)));
    }
    return out;
  }

  void add_pictures(const RunParameters& run, RunContext& context, const TextureScene& scene,
                    const TextureEnvironment& unit, Result& result) const {
    RenderOptions render_options;
    render_options.width = scene.stream().width;
    render_options.height = scene.stream().height;
    render_options.sampling = Sampling::kNearest;
    const Image before = render(scene.scene(), render_options);
    // What was under way when the run was ended came on one side only.
    std::vector<bool> missing(before.pixels.size());
    for (std::size_t i = 0; i < missing.size(); ++i)
      missing[i] = scene.stream().depth.pixels[i] != 0 && unit.came()[i] == 0;
    const auto lost = static_cast<std::uint64_t>(std::count(missing.begin(), missing.end(), true));
    const std::string note =
        lost == 0 ? "" : fmt::format("; grey: {} pixels were not delivered", grouped(lost));
    const Image after = without(stored(unit.frame(), scene), missing, kNotDelivered);
    context.add_image("before", before, "Before", "nearest texel of level 0, no filter");
    context.add_image("after", after, "Hardware model",
                      "the colours that the unit delivered" + note);
    if (run.check == CheckMode::kGolden) {
      // Once the run is over, what did not come is lost, and differs.
      const bool over = unit.done();
      Image expected = stored(unit.golden_frame(), scene);
      if (!over) expected = without(std::move(expected), missing, kNotDelivered);
      context.add_image("golden", expected, "Golden model",
                        over ? "the same fragments by the golden model"
                             : "the same fragments by the golden model" + note);
      context.add_image("difference", difference(after, expected, 255), "Difference",
                        std::string(count_different(after, expected) == 0
                                        ? "hardware against golden: none"
                                        : "hardware against golden: any difference is bright") +
                            (over || lost == 0 ? "" : "; black where nothing was delivered"));
    }
    if (run.truth && !result.interrupted) {
      const Image truth = judge_by_scene(scene, truth_options(), before, after, result, context);
      if (truth.empty()) return;
      context.add_image("truth", truth, "Truth", truth_caption());
      context.add_image("error", difference(after, truth, kDifferenceGain), "Error",
                        fmt::format("hardware against truth, {} times", kDifferenceGain));
    }
  }

  SceneParameters scene_;
  SamplerParameters sampler_;
  spec::texture::Parameters texture_;
  MemoryParameters memory_;
};

}  // namespace

std::unique_ptr<Engine> make_texture_engine() { return std::make_unique<TextureEngine>(); }

}  // namespace deburr::tb
