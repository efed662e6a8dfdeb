// SPDX-License-Identifier: MIT
#include "tool/engines/texture/texture_role.h"

#include <fmt/format.h>

#include <utility>

#include "spec/error.h"
#include "spec/texture/check_build.h"
#include "tb/engines/texture/texture_environment.h"
#include "tb/engines/texture/texture_traces.h"
#include "tool/engines/texture/texture_configuration.h"
#include "tool/engines/texture/texture_reference.h"
#include "tool/run/flicker.h"
#include "tool/run/input_rules.h"
#include "tool/run/shorthands.h"

namespace deburr::tool {

using tb::DrawnScene;
using tb::Image;
using tb::TextureScene;

namespace {

using spec::texture::Colour;

const TextureScene& textured(const DrawnScene& scene) {
  return static_cast<const TextureScene&>(scene);
}

class ColoursOfTexture final : public ColoursPort {
 public:
  ColoursOfTexture(const char* name, tb::TextureEnvironment& environment,
                   const tb::FragmentStream& stream)
      : in_(name), environment_(environment), stream_(stream) {
    in_(environment.colours);
  }
  bool can_pop(rtl::Cycle cycle) const override { return in_.can_pop(cycle); }
  void take(rtl::Cycle cycle, const std::function<void(const DrawnColour&)>& each) override {
    const spec::texture::ColourGroup& group = in_.take(cycle);
    environment_.check_output(cycle, group);
    for (const Colour& colour : group) each(drawn(colour));
  }

 private:
  DrawnColour drawn(const Colour& colour) const {
    DrawnColour outside;
    if (colour.tag >= stream_.quads.size() || colour.lane >= 4) return outside;
    const tb::FragmentStream::Pixel p = stream_.pixel(colour.tag, colour.lane);
    if (p.x >= stream_.width || p.y >= stream_.height) return outside;
    return {true, (stream_.visible[colour.tag] >> colour.lane & 1) != 0, p.x, p.y, colour.rgba};
  }

  rtl::In<spec::texture::ColourGroup> in_;
  tb::TextureEnvironment& environment_;
  const tb::FragmentStream& stream_;
};

class TextureStage final : public DrawingStage {
 public:
  TextureStage(tb::Simulation& simulation, const TextureScene& scene, const tb::TextureSetup& setup)
      : scene_(scene), setup_(setup), environment_(simulation, scene, setup, "texture") {}
  tb::Environment& environment() override { return environment_; }
  std::unique_ptr<ColoursPort> colours_port(const char* name) override {
    return std::make_unique<ColoursOfTexture>(name, environment_, scene_.stream());
  }
  Image golden_picture() const override {
    return tb::golden_frame(scene_, setup_.texture, error_range(setup_.memory)).image;
  }
  std::uint64_t cycles_bound() const override {
    const auto width = static_cast<std::uint64_t>(setup_.texture.width);
    return (environment_.unit().address.addresser.bilinears.value() + width - 1) / width;
  }
  void collect(tb::Result& result) const override {
    const rtl::Histogram& latency = environment_.unit().fragment_latency;
    constexpr const char* kMeaning = "Latency of the texture unit.";
    result.work.push_back(
        {"texture_fragment_latency_p50", latency.percentile(50), "clk", kMeaning});
    result.work.push_back({"texture_fragment_latency_max", latency.max(), "clk", kMeaning});
  }
  std::vector<tb::Figure> figures() const override {
    return {{"Latency of a texture fragment, median", "work.texture_fragment_latency_p50"}};
  }

 private:
  const TextureScene& scene_;
  tb::TextureSetup setup_;
  tb::TextureEnvironment environment_;
};

class TextureRole final : public PictureDrawer {
 public:
  TextureRole() { scene_.source = "object"; }
  std::string_view name() const override { return "texture"; }
  std::string_view title() const override { return "texture unit"; }
  HandedOn hands_on() const override { return {Handed::kDepth, Handed::kMeshEdges}; }
  DrawingWords words() const override {
    return {"texturing",
            "quad",
            "Texturing",
            "bilinears",
            "work.texture_bilinears",
            "the texture unit's bilinears, texture.width per cycle"};
  }
  std::string_view caption() const override {
    return "textured: the frame buffer after the texture unit";
  }

  void add_scene(tb::ParameterSet& set) override {
    set.add("run", tb::ParameterKind::kRun, lookup_trace_);
    set.add("scene", tb::ParameterKind::kInput, scene_);
    add_sampler(set, sampler_);
    set.add("sequence", tb::ParameterKind::kInput, sequence_);
  }
  void add_parameters(tb::ParameterSet& set) override {
    set.add_engine("texture", texture_);
    add_memory(set, "memory", memory_);
  }
  std::vector<std::string> prefixes() const override { return {"texture.", "memory."}; }
  void apply_preset(tb::ParameterSet& set) override { tool::apply_preset(set, texture_); }
  void resolve(tb::ParameterSet& set) override {
    lists_ = lists_of(scene_);
    frames_ = frames_of(set, sequence_, lists_);
    reject_unused_lookups(set, texture_);
    reject_unused_parameters(set, texture_);
    reject_unused_memory(set, "memory", memory_);
    reject_slow_memory(set, "memory", memory_);
    reject_empty_lod_range(sampler_);
    reject_unsupported_format(sampler_, texture_);
    if (is_srgb(sampler_) && texture_.srgb_output == spec::texture::SrgbOutput::kLinear)
      throw spec::ConfigError(
          fmt::format("sampler.{}: the frame buffer keeps codes, and {} delivers linear light: set "
                      "texture.srgb_output = encoded",
                      sampler_.srgb ? "srgb" : "format", sampler_.srgb ? "it" : "srgb8_a8"));
    label_ = fmt::format("{}, N_max {}, blend {}, width {}", preset_label(set, texture_),
                         tb::kAnisotropyNames[static_cast<std::size_t>(sampler_.anisotropy)],
                         spec::texture::kBlendNames[static_cast<std::size_t>(texture_.blend)],
                         texture_.width);
  }
  std::string label() const override { return label_; }
  std::vector<Shorthand> shorthands() const override {
    return joined(scene_shorthands("object"), sequence_shorthands());
  }
  LongRun long_run() const override { return {{{"scene.width", "321"}, {"scene.height", "243"}}}; }
  void check(const DrawnScene& scene) const override { reject_nothing_drawn(textured(scene)); }

  const std::string& source() const override { return scene_.source; }
  std::vector<std::filesystem::path> input_files(tb::MeshFiles& meshes) const override {
    return files_of_frames(scene_, meshes);
  }
  std::shared_ptr<const DrawnScene> load(std::uint32_t seed,
                                         const RunContext& context) const override {
    return context.shared<TextureScene>("texture scene", {"scene.", "sampler."}, [&] {
      return TextureScene(in_frame(scene_, lists_, 0), sampler_, seed);
    });
  }
  std::shared_ptr<const DrawnScene> smallest() const override {
    return std::make_shared<TextureScene>(tb::smallest(scene_, sampler_));
  }

  std::string reference_caption() const override { return tool::reference_caption(); }
  void prepare_reference(const DrawnScene& scene, const tb::RenderOptions& options,
                         const RunContext& context) const override {
    scene_reference(textured(scene), options, context);
  }
  Image compare_with_reference(const DrawnScene& scene, const tb::RenderOptions& options,
                               const Image& before, const Image& after, tb::Result& result,
                               const RunContext& context) const override {
    return compare_with_scene(textured(scene), options, before, after, result, context);
  }

  int frames() const override { return frames_; }
  std::shared_ptr<const DrawnScene> scene_of(int frame, std::uint32_t seed) const override {
    return std::make_shared<TextureScene>(in_frame(scene_, lists_, frame), sampler_, seed,
                                          move_of(sequence_, lists_, frame));
  }
  Image golden_picture(const DrawnScene& scene) const override {
    return tb::golden_frame(textured(scene), texture_).image;
  }
  Image reference_of(const DrawnScene& scene, const tb::RenderOptions& options) const override {
    tb::RenderOptions sampled = options;
    sampled.width = scene.stream().width;
    sampled.height = scene.stream().height;
    sampled.samples = kReferenceSamples;
    return render(scene.scene(), sampled);
  }

  std::unique_ptr<DrawingStage> build(tb::Simulation& simulation,
                                      const DrawnScene& scene) const override {
    return std::make_unique<TextureStage>(simulation, textured(scene),
                                          tb::TextureSetup{texture_, memory_});
  }

 private:
  tb::LookupTrace lookup_trace_;
  tb::SceneParameters scene_;
  tb::SamplerParameters sampler_;
  tb::SequenceParameters sequence_;
  tb::FrameLists lists_;
  int frames_ = 1;
  spec::texture::Parameters texture_;
  tb::MemoryParameters memory_;
  std::string label_;
};

}  // namespace

std::unique_ptr<CompositionRole> make_texture_role() { return std::make_unique<TextureRole>(); }

}  // namespace deburr::tool
