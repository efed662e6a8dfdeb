// SPDX-License-Identifier: MIT
// `deburr run posteriser`: a picture by formula through the posteriser. What a fifth engine is, as
// small as it gets: the tests build it beside the others.
#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "rtl_model/posteriser/posteriser.h"
#include "rtl_model/posteriser/register_section.h"
#include "spec/posteriser/check_build.h"
#include "tb/base/random.h"
#include "tb/engines/posteriser/posteriser_environment.h"
#include "tb/run/given_work.h"
#include "tool/engines/posteriser/posteriser_role.h"
#include "tool/run/pictures.h"
#include "tool/run/simulate.h"

namespace deburr::tb {
namespace {

struct PictureParameters {
  std::int32_t width = 32, height = 24;
};

template <class Visitor>
void describe(PictureParameters& p, Visitor& v) {
  v.integer("width", p.width, 1, 4096, "pixel", "Width of the picture.");
  v.integer("height", p.height, 1, 4096, "pixel", "Height of the picture.");
  for (const char* const name : {"width", "height"}) v.is_work(name, GivenWork::kSetting);
}

constexpr std::array<CoverageGroup, 1> kGroups = {
    {{"posteriser/red", "Where the red of a pixel goes."}}};

class PosteriserCommand final : public Engine {
 public:
  std::string_view name() const override { return "posteriser"; }
  std::string_view summary() const override {
    return "A picture through the posteriser, checked pixel by pixel";
  }
  std::unique_ptr<CompositionRole> role() const override { return make_posteriser_role(); }
  void add_parameters(ParameterSet& set) override {
    set.add("picture", ParameterKind::kInput, picture_);
    set.add_engine("posteriser", parameters_);
  }
  std::vector<std::string_view> examples() const override { return {"--size 31x17 --bits 2"}; }
  std::vector<Shorthand> shorthands() const override {
    return {{"--size", "picture.width", "Size of the picture, WxH (32x24)", "picture.height"},
            {"--bits", "posteriser.bits", "Levels of a colour, as a power of two"}};
  }
  void check(const RunParameters&, RunContext&) override {}
  std::vector<std::filesystem::path> input_files(MeshFiles&) const override { return {}; }

  void run(const RunParameters& run, RunContext& context, Result& result) override {
    const Image picture = picture_of(static_cast<std::uint64_t>(run.seed));
    context.set_title("Posteriser", fmt::format("{} x {} pixels, {} bits", picture.width,
                                                picture.height, parameters_.bits));
    Simulation simulation(simulation_options(run, context));
    PosteriserEnvironment environment(simulation, picture, parameters_);
    simulate(simulation, environment, context, result, [&] {
      const Image expected = environment.golden_frame();
      add_frame_pictures(context, {picture, environment.frame(), environment.delivered(),
                                   run.check == CheckMode::kGolden ? &expected : nullptr, nullptr,
                                   "the picture as it was made", ""});
    });
  }
  void describe_statistics(Result& result) override {
    const Image picture(2, 2);
    Simulation simulation({});
    PosteriserEnvironment environment(simulation, picture, parameters_);
    describe(simulation, environment, result);
  }

  std::vector<std::string_view> pictures() const override {
    return {"before", "after", "golden", "difference", "change"};
  }
  std::vector<std::string_view> maps() const override { return {"level"}; }
  rtl::RegisterSection registers() const override {
    return rtl::posteriser::register_section(parameters_);
  }
  DatasheetSection datasheets() const override {
    return {"Posteriser", {rtl::posteriser::LevelUnit::datasheet()}};
  }
  CoverageSection coverage() const override {
    return {"Posteriser", PosteriserEnvironment::declared_coverage(), kGroups};
  }
  RandomDraws random_draws() const override {
    RandomDraws all;
    all.draws = {{"picture.width", side_of_picture}, {"picture.height", side_of_picture}};
    all.fixed = {"run.line_trace"};  // it asks no memory for anything
    return all;
  }
  LongRun long_run() const override {
    return {{{"picture.width", "1021"}, {"picture.height", "765"}}};
  }

 private:
  Image picture_of(std::uint64_t seed) const {
    Random random(seed, "posteriser");
    Image picture(picture_.width, picture_.height);
    for (Rgba8& pixel : picture.pixels)
      for (std::size_t c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(random.below(256));
    return picture;
  }

  PictureParameters picture_;
  spec::posteriser::Parameters parameters_;
};

}  // namespace

std::unique_ptr<Engine> make_posteriser_engine() { return std::make_unique<PosteriserCommand>(); }

}  // namespace deburr::tb
