// SPDX-License-Identifier: MIT
#include "tool/engines/geometric/geometric_role.h"

#include <fmt/format.h>

#include <utility>

#include "spec/geometric/check_build.h"
#include "tb/engines/geometric/edge_table.h"
#include "tb/engines/geometric/geometric_environment.h"
#include "tb/env/collect.h"
#include "tb/scene/depth_codes.h"
#include "tool/engines/geometric/geometric_configuration.h"
#include "tool/engines/geometric/geometric_pictures.h"
#include "tool/run/input_rules.h"

namespace deburr::tool {

using tb::Image;

namespace {

// The mesh parts drawn in a composition.
struct DrawnEdges {
  bool crossings = false;
};

template <class Visitor>
void describe(DrawnEdges& p, Visitor& v) {
  v.boolean("crossings", p.crossings,
            "Also draw the lines along which faces of the mesh intersect.");
}

std::vector<tb::geometric::Frame> frames_of(const tb::DrawnScene& scene, Image image,
                                            bool crossings) {
  const tb::FragmentStream& stream = scene.stream();
  tb::geometric::Frame frame;
  frame.image = std::move(image);
  frame.depth = stream.depth;
  frame.depths = depth_codes(stream.depth);
  frame.table = tb::build_edge_table(scene.scene().mesh, {.crossings = crossings});
  frame.screen = project_edges(frame.table, scene.scene().camera, stream.width, stream.height);
  std::vector<tb::geometric::Frame> frames;
  frames.push_back(std::move(frame));
  return frames;
}

class GeometricStage final : public MeshStage {
 public:
  GeometricStage(tb::Simulation& simulation, const tb::DrawnScene& scene, Image frame,
                 const tb::GeometricSetup& setup, bool crossings)
      : parameters_(setup.geometric),
        frames_(frames_of(scene, std::move(frame), crossings)),
        environment_(simulation, frames_, setup, "geometric") {}

  tb::Environment& environment() override { return environment_; }
  Image frame() const override { return environment_.frame(); }
  Image expected_frame() const override { return environment_.expected_frame(); }
  tb::Latency latency() const override {
    return tb::latency_of(environment_.engine().edge_latency);
  }
  std::string_view last_unit() const override { return "geometric_resolver"; }
  std::uint64_t cycles_bound(int /*width*/, int /*height*/) const override {
    return environment_.meter().frame_cycles_bound();
  }
  std::vector<tb::Figure> work_figures() const override {
    return environment_.meter().work_figures();
  }
  std::vector<std::string> notes() const override {
    return dropped_notes(environment_.engine().work());
  }

  void put(int x, int y, const tb::Rgba8& colour) override { environment_.put(x, y, colour); }
  void draw() override { environment_.draw(); }
  void add_pictures(RunContext& context, const Image& before, bool followed) const override {
    tb::geometric::Frame edges = frames_.front();
    edges.image = before;
    add_edge_pictures(context, edges, parameters_, environment_.blocks(),
                      followed ? "edge_weights" : "weights");
  }

 private:
  spec::geometric::Parameters parameters_;
  std::vector<tb::geometric::Frame> frames_;
  tb::GeometricEnvironment environment_;
};

class GeometricRole final : public MeshSmoother {
 public:
  std::string_view name() const override { return "geometric"; }
  std::string_view title() const override { return "geometric engine"; }
  HandedOn needs() const override { return {Handed::kDepth, Handed::kMeshEdges}; }
  HandedOn hands_on() const override { return {Handed::kMarkedPixels}; }

  void add_parameters(tb::ParameterSet& set) override {
    set.add_engine("geometric", parameters_);
    set.add("geometric", tb::ParameterKind::kRule, edges_);
    add_memory(set, tb::kGeometricMemory, memory_);
  }
  std::vector<std::string> prefixes() const override {
    return {"geometric.", fmt::format("{}.", tb::kGeometricMemory)};
  }
  void apply_preset(tb::ParameterSet& set) override { tool::apply_preset(set, parameters_); }
  void mark(tb::ParameterSet& set, std::string_view why) override {
    set.imply("geometric.mark", "true", why);
  }
  void resolve(tb::ParameterSet& set) override {
    imply_crossings(set, "geometric.crossings", parameters_);
    reject_unused_configuration(set, parameters_);
    reject_unused_memory(set, tb::kGeometricMemory, memory_);
    reject_slow_memory(set, tb::kGeometricMemory, memory_);
    label_ = preset_label(set, parameters_);
  }
  std::string label() const override { return label_; }
  std::vector<std::string> notes() const override {
    return build_notes(rtl::geometric::sized(
        parameters_, memory_cycles(tb::GeometricSetup{parameters_, memory_})));
  }
  std::vector<std::string_view> pictures() const override {
    return {"weights", "classes", "edge_weights"};
  }
  // Build parameters for small pictures.
  LongRun long_run() const override { return {{}, {".touched_words"}}; }
  void check(const tb::DrawnScene& scene) const override {
    reject_too_many_faces(scene.scene(), parameters_);
  }
  bool linear_light() const override { return parameters_.linear_light; }

  Image golden_picture(const tb::DrawnScene& scene, const Image& frame) const override {
    return tb::geometric::smoothed(frames_of(scene, frame, edges_.crossings).front(), parameters_)
        .image;
  }

  std::unique_ptr<MeshStage> build(tb::Simulation& simulation, const tb::DrawnScene& scene,
                                   Image frame) const override {
    return std::make_unique<GeometricStage>(simulation, scene, std::move(frame),
                                            tb::GeometricSetup{parameters_, memory_},
                                            edges_.crossings);
  }

 private:
  spec::geometric::Parameters parameters_;
  tb::MemoryParameters memory_;
  DrawnEdges edges_;
  std::string label_;
};

}  // namespace

std::unique_ptr<CompositionRole> make_geometric_role() { return std::make_unique<GeometricRole>(); }

}  // namespace deburr::tool
