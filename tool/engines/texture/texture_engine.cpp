// SPDX-License-Identifier: MIT
// `deburr run texture`: a scene through the texture unit.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "spec/error.h"
#include "spec/texture/descriptor.h"
#include "tb/base/interrupt.h"
#include "tb/engines/texture/texture_environment.h"
#include "tb/engines/texture/texture_sequence.h"
#include "tb/engines/texture/texture_testbench.h"
#include "tb/run/amount.h"
#include "tb/scene/compose.h"
#include "tb/scene/quality.h"
#include "tb/scene/reference.h"
#include "tb/scene/textures.h"
#include "tb/traces/fragment_reader.h"
#include "tb/traces/fragment_writer.h"
#include "tool/engines/texture/texture_configuration.h"
#include "tool/engines/texture/texture_draws.h"
#include "tool/engines/texture/texture_reference.h"
#include "tool/engines/texture/texture_role.h"
#include "tool/run/flicker.h"
#include "tool/run/input_rules.h"
#include "tool/run/pictures.h"
#include "tool/run/preset_help.h"
#include "tool/run/shorthands.h"
#include "tool/run/simulate.h"

namespace deburr::tool {

using tb::Image;
using tb::TextureScene;

namespace {

class TextureEngine final : public Engine, public tb::TextureTestbench {
 public:
  std::string_view summary() const override {
    return "Texture a scene with the texture unit, checked colour by colour and line by line";
  }
  std::unique_ptr<CompositionRole> role() const override { return make_texture_role(); }

  std::vector<std::string_view> examples() const override {
    return {"--scene tunnel --size 640x360 --aniso 8 --truth --out out/tunnel",
            "--in mesh.obj --preset paper --mode trilinear --out out/mesh",
            "--windows 2000 --maps --set memory.latency=200"};
  }
  std::vector<Shorthand> shorthands() const override {
    return joined(
        joined(scene_shorthands("plane"), sequence_shorthands()),
        {{"--preset", "texture.preset",
          preset_help(spec::texture::kPresetNames, spec::texture::Configuration().preset)},
         {"--roll", "scene.roll", "Degrees by which the camera is turned"},
         {"--wrap", "sampler.wrap", "repeat, mirrored_repeat, clamp_to_edge, or scene (default)"},
         {"--format", "sampler.format",
          "rgba8 (default), rgb565, rgba4444, l8, srgb8_a8; with --set texture.decode=after or "
          "before: bc1, "
          "bc3, bc4, bc5, etc2_rgb, etc2_rgb_a1, etc2_rgba8"},
         {"--layout", "sampler.layout", "tiled (default) or linear"},
         {"--fragments", "scene.fragments",
          "Fragments of another rasteriser: a trace, text or binary (docs/reference/traces.md)"},
         {"--fragment-trace", "run.fragment_trace",
          "Write the fragments as such a trace: text or binary"},
         {"--hdl", "run.hdl",
          "Units that run as SystemVerilog: address, cache, filter (separated by commas), or "
          "all"}});
  }

  void resolve(tb::ParameterSet& set) override {
    apply_preset(set, texture_);
    preset_label_ = preset_label(set, texture_);
    reject_unused_memory(set, "memory", memory_);
    reject_slow_memory(set, "memory", memory_);
    reject_empty_lod_range(sampler_);
    reject_unsupported_format(sampler_, texture_);
    reject_unused_lookups(set, texture_);
    reject_unused_parameters(set, texture_);
    counterpart_units_ = tb::counterpart_units(counterparts_.units);
    if (!counterpart_units_.empty()) {
      reject_views_inside(set);
      stand_ins(0);  // rejects what the build does not have
    }
    if (foreign()) reject_unused_scene(set);
    lists_ = lists_of(scene_);
    frames_ = frames_of(set, sequence_, lists_);
    if (foreign() && frames_ > 1)
      set.reject(lists_.longest(), "the file scene.fragments holds the fragments of one frame");
  }

  void check(const RunParameters& run, RunContext& context) override {
    const std::shared_ptr<const TextureScene> scene = load(run, context);
    if (foreign())
      fragments_of_file(*scene);
    else
      reject_nothing_drawn(*scene);
    reject_maps_of_nothing(run, *scene);
  }

  void run(const RunParameters& run, RunContext& context, tb::Result& result) override {
    const std::shared_ptr<const TextureScene> shared = load(run, context);
    const TextureScene& scene = *shared;
    tb::TextureSetup setup{texture_, memory_};
    setup.stand_ins = stand_ins(run.seed);
    if (foreign())
      setup.foreign = fragments_of_file(scene);
    else
      reject_nothing_drawn(scene);
    reject_maps_of_nothing(run, scene);
    tb::MeshFiles meshes;
    context.add_inputs(frames_ > 1 ? input_files(meshes) : with_trace(scene.inputs()));
    context.set_title(title(), summary_line(scene, setup));
    for (const std::string& note : scene.scene().mesh.notes) context.add_note(note);
    tb::Simulation simulation(simulation_options(run, context));
    if (!foreign() && run.pixel.empty()) setup.expectation = expectation(scene, context);
    std::unique_ptr<tb::traces::FragmentWriter> writer;
    if (trace_out_.fragments != tb::traces::TraceChoice::kNone && !context.checking_only()) {
      writer = std::make_unique<tb::traces::FragmentWriter>(
          context.fragment_trace_file(), format_of(trace_out_.fragments), scene.stream().width,
          scene.stream().height);
      setup.observer = [&writer](const tb::traces::TracedQuad& quad) { writer->put(quad); };
    }
    tb::TextureEnvironment environment(simulation, scene, setup);
    simulate(simulation, environment, context, result, [&] {
      if (writer) writer->finish();
      add_pictures(run, context, scene, environment, result);
    });
    if (frames_ > 1 && !result.interrupted && !context.checking_only())
      measure_flicker(frames_, context, result, [&](int frame) {
        return picture_of(frame, static_cast<std::uint32_t>(run.seed));
      });
  }

  void prepare(const RunParameters& run, RunContext& context) override {
    const std::shared_ptr<const TextureScene> scene = load(run, context);
    if (run.reference) scene_reference(*scene, reference_options(), context);
    expectation(*scene, context);
  }

  std::vector<std::string_view> pictures() const override {
    return {"before", "after", "golden", "difference", "reference", "error"};
  }
  std::vector<std::string_view> maps() const override {
    return {"samples", "level", "misses", "latency"};
  }

  std::string_view pixel_history() const override {
    return "footprint, level and samples, texels, lines with hit, merged or miss, colour";
  }

  RandomDraws random_draws() const override { return texture_draws(); }
  LongRun long_run() const override { return {{{"scene.width", "321"}, {"scene.height", "243"}}}; }

 private:
  std::shared_ptr<const TextureScene> load(const RunParameters& run,
                                           const RunContext& context) const {
    return context.shared<TextureScene>("texture scene", {"scene.", "sampler."}, [&] {
      const auto seed = static_cast<std::uint32_t>(run.seed);
      const tb::SceneParameters first = in_frame(scene_, lists_, 0);
      if (!foreign()) return TextureScene(first, sampler_, seed);
      // The picture's size is in the header; textures are counted where available.
      const tb::traces::FragmentReader reader(trace_in_.file, spec::texture::kMaxTextures);
      return TextureScene::without_fragments(first, sampler_, seed, reader.width(),
                                             reader.height());
    });
  }

  bool foreign() const { return !trace_in_.file.empty(); }

  rtl::texture::TextureUnit::StandIns stand_ins(std::uint64_t seed) const {
    return tb::texture_counterparts(
        counterpart_units_,
        tb::as_built(texture_, memory_cycles(memory_, texture_.cache_line_bytes)), seed);
  }

  void reject_maps_of_nothing(const RunParameters& run, const TextureScene& scene) const {
    if (run.maps && scene.stream().width == 0)
      throw spec::ConfigError(
          fmt::format("run.maps: the fragments of '{}' have no position in a picture: leave it "
                      "out, or add 'size WIDTH HEIGHT' and the position of each quad to the trace "
                      "(docs/reference/traces.md)",
                      trace_in_.file));
  }

  // Reads and checks the whole file.
  tb::ForeignFragments fragments_of_file(const TextureScene& scene) const {
    const std::size_t textures = scene.memory().descriptors().size();
    const tb::traces::FragmentSummary summary =
        tb::traces::examine_fragments(trace_in_.file, textures);
    if (summary.fragments == 0)
      throw spec::ConfigError(
          fmt::format("the trace '{}' has no covered fragment in {} quads: nothing to filter",
                      trace_in_.file, summary.quads));
    const auto open = [file = trace_in_.file, textures]() -> tb::traces::QuadSource {
      const auto reader = std::make_shared<tb::traces::FragmentReader>(file, textures);
      return [reader](tb::traces::TracedQuad& quad) { return reader->next(quad); };
    };
    return {open, summary.fragments};
  }

  std::shared_ptr<const tb::TextureExpectation> expectation(const TextureScene& scene,
                                                            const RunContext& context) const {
    return context.shared_golden<tb::TextureExpectation>(
        built_for_golden(), [&] { return expected_of(scene, texture_); });
  }

  tb::RenderOptions reference_options() const {
    tb::RenderOptions options;
    options.sampling = tb::Sampling::kBilinear;
    options.averaging = is_srgb(sampler_) ? tb::Averaging::kLinear : tb::Averaging::kStored;
    return options;
  }

  std::string title() const {
    return "Texture unit: " +
           std::filesystem::path(foreign() ? trace_in_.file : scene_.source).filename().string();
  }

  std::string summary_line(const TextureScene& scene, const tb::TextureSetup& setup) const {
    const auto name = [](auto value, const auto& names) {
      return names[static_cast<std::size_t>(value)];
    };
    return fmt::format(
        "{}{} fragments, {}, N_max {}, {}{} {}{}; {}; axes {}, footprint {}, log2 {}, count {}, "
        "kernel {}, blend {}; width {}, cache {} bytes, {} ways; memory latency {}{}{}",
        scene.stream().width > 0
            ? fmt::format("{} x {} pixels, ", scene.stream().width, scene.stream().height)
            : "",
        tb::grouped(foreign() ? setup.foreign.fragments : scene.stream().counts.fragments),
        name(sampler_.mode, spec::texture::kMinFilterNames),
        name(sampler_.anisotropy, tb::kAnisotropyNames),
        name(sampler_.format, spec::texture::kFormatNames), sampler_.srgb ? " sRGB" : "",
        name(sampler_.layout, spec::texture::kLayoutNames),
        texture_.decode == spec::texture::Decode::kNone
            ? ""
            : fmt::format(", decoded {} the cache",
                          name(texture_.decode, spec::texture::kDecodeNames)),
        preset_label_, name(texture_.axes, spec::texture::kAxesNames),
        name(texture_.footprint, spec::texture::kFootprintNames),
        name(texture_.log2, spec::texture::kLog2Names),
        name(texture_.count, spec::texture::kCountNames),
        name(texture_.kernel, spec::texture::kKernelNames),
        name(texture_.blend, spec::texture::kBlendNames), texture_.width,
        tb::grouped(static_cast<std::uint64_t>(texture_.cache_bytes)), texture_.cache_ways,
        latency_text(memory_), counterpart_units_.empty() ? "" : "; in SystemVerilog: ",
        fmt::join(counterpart_units_, ", "));
  }

  bool linear_light() const {
    return is_srgb(sampler_) && texture_.srgb_output == spec::texture::SrgbOutput::kLinear;
  }

  // Pictures are stored as sRGB, whatever the unit outputs for sRGB textures.
  Image stored(const Image& image, const tb::Mask& drawn) const {
    if (!linear_light()) return image;
    Image out = image;
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
      if (drawn.pixels[i] == 0) continue;  // not drawn by the unit
      for (std::size_t c = 0; c < 3; ++c)
        out.pixels[i][c] = static_cast<std::uint8_t>(
            std::lround(255 * tb::linear_to_srgb(out.pixels[i][c] / 255.0)));
    }
    return out;
  }

  static Image unfiltered(const TextureScene& scene) {
    tb::RenderOptions options;
    options.width = scene.stream().width;
    options.height = scene.stream().height;
    options.sampling = tb::Sampling::kNearest;
    return render(scene.scene(), options);
  }

  void add_pictures(const RunParameters& run, RunContext& context, const TextureScene& scene,
                    const tb::TextureEnvironment& unit, tb::Result& result) const {
    if (unit.frame().empty()) return;
    tb::Mask came;
    came.width = unit.frame().width;
    came.height = unit.frame().height;
    came.pixels = unit.received();
    // For a fragment file, pixels without a fragment are known only when all have arrived.
    const tb::Mask drawn = foreign() ? came : drawn_pixels(scene);
    const tb::Mask missing = without(drawn, came);
    const Image before = foreign() ? Image() : unfiltered(scene);
    // Work in flight when the run was interrupted arrived on one side only.
    const auto lost = static_cast<std::uint64_t>(count(missing));
    const std::string note =
        lost == 0 ? "" : fmt::format("; grey: {} pixels were not delivered", tb::grouped(lost));
    const Image after = painted(stored(unit.frame(), drawn), missing, kNotDelivered);
    if (!foreign())
      context.add_image("before", before, "Before", "nearest texel of level 0, no filter");
    context.add_image("after", after, "Hardware model", "the colours delivered by the unit" + note);
    if (run.check == CheckMode::kGolden) {
      // Once the run is over, pixels that have not arrived never will, so they count as
      // differences.
      const bool over = unit.done();
      Image expected = stored(unit.golden_frame(), drawn);
      if (!over) expected = painted(std::move(expected), missing, kNotDelivered);
      context.add_image("golden", expected, "Golden model",
                        over ? "the same fragments by the golden model"
                             : "the same fragments by the golden model" + note);
      context.add_image("difference", tb::difference(after, expected, 255), "Difference",
                        std::string(tb::count_different(after, expected) == 0
                                        ? "hardware against golden: none"
                                        : "hardware against golden: any difference is bright") +
                            (over || lost == 0 ? "" : "; black where nothing was delivered"));
    }
    if (run.reference && !result.interrupted) {
      const Image reference =
          compare_with_scene(scene, reference_options(), before, after, result, context);
      if (reference.empty()) return;
      context.add_image("reference", reference, "Reference", reference_caption());
      context.add_image("error", tb::difference(after, reference, kDifferenceGain), "Error",
                        fmt::format("hardware against reference, {} times", kDifferenceGain));
    }
  }

  SequencePicture picture_of(int frame, std::uint32_t seed) const {
    const TextureScene scene(in_frame(scene_, lists_, frame), sampler_, seed,
                             move_of(sequence_, lists_, frame));
    tb::RenderOptions options = reference_options();
    options.width = scene.stream().width;
    options.height = scene.stream().height;
    options.samples = kReferenceSamples;
    options.interrupted = [] { return tb::interrupted(); };
    const tb::Mask drawn = drawn_pixels(scene);
    return {unfiltered(scene), stored(tb::golden_frame(scene, texture_).image, drawn),
            render(scene.scene(), options), drawn};
  }

  std::vector<std::string> counterpart_units_;
  tb::FrameLists lists_;
  int frames_ = 1;
  std::string preset_label_;
};

}  // namespace

std::unique_ptr<Engine> make_texture_engine() { return std::make_unique<TextureEngine>(); }

}  // namespace deburr::tool
