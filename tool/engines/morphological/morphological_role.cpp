// SPDX-License-Identifier: MIT
#include "tool/engines/morphological/morphological_role.h"

#include <fmt/format.h>

#include <utility>

#include "golden/morphological/configuration.h"
#include "spec/morphological/check_build.h"
#include "tb/engines/morphological/morphological_environment.h"
#include "tb/engines/morphological/morphological_frames.h"
#include "tb/env/collect.h"
#include "tb/scene/depth_codes.h"
#include "tool/engines/morphological/morphological_configuration.h"
#include "tool/engines/morphological/morphological_pictures.h"
#include "tool/run/input_rules.h"

namespace deburr::tool {

using tb::Image;

namespace {

using spec::morphological::PixelBeat;

class RowsToMorphological final : public RowsPort {
 public:
  RowsToMorphological(const char* name, std::vector<std::uint32_t> depth, int lanes)
      : out(name), depth_(std::move(depth)), lanes_(lanes) {}
  rtl::Out<PixelBeat> out;

  bool can_push(rtl::Cycle cycle) const override { return out.can_push(cycle); }
  int push(rtl::Cycle cycle, const Image& image, int x, int y) override {
    const PixelBeat beat =
        platform::pixel_beat({image.width, image.height, image.pixels, depth_}, x, y, lanes_);
    out.push(cycle, beat);
    return beat.count;
  }

 private:
  std::vector<std::uint32_t> depth_;
  int lanes_;
};

class MorphologicalStage final : public RowStage {
 public:
  MorphologicalStage(tb::Simulation& simulation, const tb::DrawnScene& scene, Image frame,
                     const tb::MorphologicalSetup& setup, RowsToMorphological& port)
      : frames_{{std::move(frame), depth_codes(scene.stream().depth)}},
        environment_(simulation, frames_, setup, "morphological") {
    port.out(environment_.pixels);
  }

  tb::Environment& environment() override { return environment_; }
  Image frame() const override { return environment_.frame(); }
  std::size_t delivered() const override { return environment_.delivered(); }
  Image expected_frame() const override {
    const Image& size = frames_.front().image;
    Image image(size.width, size.height);
    const std::vector<tb::Rgba8>& expected = environment_.golden_model().pixels();
    if (expected.size() == image.pixels.size()) image.pixels = expected;
    return image;
  }
  tb::Latency latency() const override {
    return tb::latency_of(environment_.engine().beat_latency);
  }
  std::string_view last_unit() const override { return "morphological_blender"; }
  std::uint64_t cycles_bound(int width, int height) const override {
    return tb::frame_cycles_by_formula(environment_.engine().parameters(), width, height);
  }
  std::vector<tb::Figure> work_figures() const override {
    return environment_.meter().work_figures();
  }

  void expect(Image image) override { frames_.front().image = std::move(image); }
  std::uint64_t delivered_in_all() const override { return environment_.delivered_in_all(); }
  void add_pictures(RunContext& context, const SmoothedFrame& frame) const override {
    add_smoothing_pictures(context, frame, environment_.probes());
  }

 private:
  std::vector<tb::MorphologicalInput> frames_;
  tb::MorphologicalEnvironment environment_;
};

class MorphologicalRole final : public RowSmoother {
 public:
  std::string_view name() const override { return "morphological"; }
  std::string_view title() const override { return "morphological engine"; }
  HandedOn needs() const override { return {Handed::kDepth}; }
  bool looks_at_marks() const override { return true; }

  void add_parameters(tb::ParameterSet& set) override {
    set.add_engine("morphological", parameters_);
    add_memory(set, tb::kMorphologicalMemory, memory_);
  }
  std::vector<std::string> prefixes() const override {
    return {"morphological.", fmt::format("{}.", tb::kMorphologicalMemory)};
  }
  void apply_preset(tb::ParameterSet& set) override { tool::apply_preset(set, parameters_); }
  void follow_preset(tb::ParameterSet& set, std::string_view why) override {
    set.imply("morphological.preset",
              tb::name_of(spec::morphological::FollowingRules().preset,
                          spec::morphological::kPresetNames),
              why);
  }
  void follow(tb::ParameterSet& set, std::string_view why) override {
    const spec::morphological::Parameters configuration =
        golden::morphological::following_geometric(parameters_);
    std::vector<std::string> names = {"bypass"};
    if (configuration.edge_source != parameters_.edge_source) names.push_back("edges.source");
    if (configuration.edge_source == spec::morphological::EdgeSource::kPredicated &&
        !set.given("morphological.edges.source"))
      names.insert(names.end(),
                   {"edges.threshold_on_depth_edge", "edges.threshold_off_depth_edge"});
    for (const std::string& name : names)
      set.imply("morphological." + name, spec::value_text(configuration, name), why);
  }
  void resolve(tb::ParameterSet& set) override {
    reject_unused_configuration(set, parameters_, tb::kMorphologicalMemory);
    reject_unused_memory(set, tb::kMorphologicalMemory, memory_);
    if (parameters_.storage == spec::morphological::Storage::kMemory)
      reject_slow_memory(set, tb::kMorphologicalMemory, memory_);
    label_ = preset_label(set, parameters_);
  }
  std::string label() const override { return label_; }
  std::vector<std::string> notes() const override { return build_notes(parameters_); }
  std::vector<Shorthand> shorthands() const override { return smoothing_shorthands(); }
  std::vector<std::string_view> pictures() const override { return {"edges", "weights"}; }
  // Build parameters for small pictures.
  LongRun long_run() const override { return {{}, {".line_pixels"}}; }
  void check(const tb::DrawnScene& scene) const override {
    golden::morphological::check_frame(parameters_, scene.stream().width, scene.stream().height);
  }
  bool linear_light() const override { return parameters_.linear_light; }

  Image golden_picture(const tb::DrawnScene& scene, const Image& frame) const override {
    const tb::MorphologicalInput input{frame, depth_codes(scene.stream().depth)};
    Image after(input.image.width, input.image.height);
    after.pixels = tb::golden_frame(input, parameters_).pixels();
    return after;
  }

  std::unique_ptr<RowsPort> rows_port(const char* name,
                                      const tb::DrawnScene& scene) const override {
    return std::make_unique<RowsToMorphological>(name, depth_codes(scene.stream().depth),
                                                 platform::lanes_of(parameters_));
  }
  std::unique_ptr<RowStage> build(tb::Simulation& simulation, const tb::DrawnScene& scene,
                                  Image frame, RowsPort& port) const override {
    return std::make_unique<MorphologicalStage>(
        simulation, scene, std::move(frame),
        tb::MorphologicalSetup{.morphological = parameters_, .memory = memory_},
        static_cast<RowsToMorphological&>(port));
  }

 private:
  spec::morphological::Parameters parameters_;
  tb::MemoryParameters memory_;
  std::string label_;
};

}  // namespace

std::unique_ptr<CompositionRole> make_morphological_role() {
  return std::make_unique<MorphologicalRole>();
}

}  // namespace deburr::tool
