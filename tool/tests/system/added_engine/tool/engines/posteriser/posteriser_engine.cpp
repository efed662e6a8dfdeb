// SPDX-License-Identifier: MIT
// `deburr run posteriser`: a procedural picture through the posteriser. The smallest possible fifth
// engine, built with the others by the tests.
#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tb/base/random.h"
#include "tb/engines/posteriser/posteriser_environment.h"
#include "tb/engines/posteriser/posteriser_testbench.h"
#include "tool/engines/posteriser/posteriser_role.h"
#include "tool/run/pictures.h"
#include "tool/run/simulate.h"

namespace deburr::tool {
namespace {

class PosteriserCommand final : public Engine, public tb::PosteriserTestbench {
 public:
  std::string_view summary() const override {
    return "A picture through the posteriser, checked pixel by pixel";
  }
  std::unique_ptr<CompositionRole> role() const override { return make_posteriser_role(); }
  std::vector<std::string_view> examples() const override { return {"--size 31x17 --bits 2"}; }
  std::vector<Shorthand> shorthands() const override {
    return {{"--size", "picture.width", "Size of the picture, WxH (32x24)", "picture.height"},
            {"--bits", "posteriser.bits", "Levels of a colour, as a power of two"}};
  }
  void check(const RunParameters&, RunContext&) override {}

  void run(const RunParameters& run, RunContext& context, tb::Result& result) override {
    const tb::Image picture = picture_of(static_cast<std::uint64_t>(run.seed));
    context.set_title("Posteriser", fmt::format("{} x {} pixels, {} bits", picture.width,
                                                picture.height, parameters_.bits));
    tb::Simulation simulation(simulation_options(run, context));
    tb::PosteriserEnvironment environment(simulation, picture, parameters_);
    simulate(simulation, environment, context, result, [&] {
      const tb::Image expected = environment.golden_frame();
      add_frame_pictures(context, {picture, environment.frame(), environment.delivered(),
                                   run.check == CheckMode::kGolden ? &expected : nullptr, nullptr,
                                   "the picture as it was made", ""});
    });
  }

  std::vector<std::string_view> pictures() const override {
    return {"before", "after", "golden", "difference", "change"};
  }
  std::vector<std::string_view> maps() const override { return {"level"}; }
  RandomDraws random_draws() const override {
    RandomDraws all;
    all.draws = {{"picture.width", side_of_picture}, {"picture.height", side_of_picture}};
    all.fixed = {"run.line_trace"};  // it makes no memory requests
    return all;
  }
  LongRun long_run() const override {
    return {{{"picture.width", "1021"}, {"picture.height", "765"}}};
  }

 private:
  tb::Image picture_of(std::uint64_t seed) const {
    tb::Random random(seed, "posteriser");
    tb::Image picture(picture_.width, picture_.height);
    for (tb::Rgba8& pixel : picture.pixels)
      for (std::size_t c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(random.below(256));
    return picture;
  }
};

}  // namespace

std::unique_ptr<Engine> make_posteriser_engine() { return std::make_unique<PosteriserCommand>(); }

}  // namespace deburr::tool
