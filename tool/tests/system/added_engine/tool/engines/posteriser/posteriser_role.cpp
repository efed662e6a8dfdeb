// SPDX-License-Identifier: MIT
#include "tool/engines/posteriser/posteriser_role.h"

#include <fmt/format.h>

#include <utility>

#include "spec/posteriser/check_build.h"
#include "tb/engines/posteriser/posteriser_environment.h"

namespace deburr::tool {

using tb::Image;

namespace {

using spec::posteriser::Tone;

class RowsToPosteriser final : public RowsPort {
 public:
  explicit RowsToPosteriser(const char* name) : out(name) {}
  rtl::Out<Tone> out;
  bool can_push(rtl::Cycle cycle) const override { return out.can_push(cycle); }
  int push(rtl::Cycle cycle, const Image& image, int x, int y) override {
    const tb::Rgba8& p = image.at(x, y);
    out.push(cycle, {{p[0], p[1], p[2]}, x == image.width - 1 && y == image.height - 1});
    return 1;
  }
};

class PosteriserStage final : public RowStage {
 public:
  PosteriserStage(tb::Simulation& simulation, Image frame,
                  const spec::posteriser::Parameters& parameters, RowsToPosteriser& port)
      : picture_(std::move(frame)), environment_(simulation, picture_, parameters, "posteriser") {
    port.out(environment_.tones_in);
  }
  tb::Environment& environment() override { return environment_; }
  Image frame() const override { return environment_.frame(); }
  Image expected_frame() const override { return environment_.golden_frame(); }
  tb::Latency latency() const override { return {}; }
  std::string_view last_unit() const override { return "posteriser_levels"; }
  std::uint64_t cycles_bound(int width, int height) const override {
    return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  }
  std::vector<tb::Figure> work_figures() const override { return {}; }
  void expect(Image image) override { picture_ = std::move(image); }
  std::size_t delivered() const override { return environment_.delivered(); }
  std::uint64_t delivered_in_all() const override { return environment_.delivered(); }
  void add_pictures(RunContext& context, const SmoothedFrame& frame) const override {
    add_frame_pictures(context, frame);
  }

 private:
  Image picture_;
  tb::PosteriserEnvironment environment_;
};

class PosteriserRole final : public RowSmoother {
 public:
  std::string_view name() const override { return "posteriser"; }
  std::string_view title() const override { return "posteriser"; }
  void add_parameters(tb::ParameterSet& set) override { set.add_engine("posteriser", parameters_); }
  std::vector<std::string> prefixes() const override { return {"posteriser."}; }
  void apply_preset(tb::ParameterSet&) override {}
  void resolve(tb::ParameterSet&) override {}
  void check(const tb::DrawnScene&) const override {}
  std::string label() const override { return fmt::format("{} bits", parameters_.bits); }
  bool linear_light() const override { return false; }
  std::unique_ptr<RowsPort> rows_port(const char* name, const tb::DrawnScene&) const override {
    return std::make_unique<RowsToPosteriser>(name);
  }
  std::unique_ptr<RowStage> build(tb::Simulation& simulation, const tb::DrawnScene&, Image frame,
                                  RowsPort& port) const override {
    return std::make_unique<PosteriserStage>(simulation, std::move(frame), parameters_,
                                             static_cast<RowsToPosteriser&>(port));
  }

 private:
  spec::posteriser::Parameters parameters_;
};

}  // namespace

std::unique_ptr<CompositionRole> make_posteriser_role() {
  return std::make_unique<PosteriserRole>();
}

}  // namespace deburr::tool
