// SPDX-License-Identifier: MIT
// Figures, maps and expectations of runs of the texture unit, also of one that was reset.
#include <algorithm>
#include <bit>
#include <cmath>
#include <set>
#include <span>

#include "spec/error.h"
#include "tb/system/texture_runs.h"
#include "tb/unit/engines/run_figures.h"

namespace deburr::tb::figures_test {
namespace {

// No square, and more fragments than pixels.
const TextureScene& scene(spec::texture::Format format = spec::texture::Format::kRgba8) {
  static std::map<spec::texture::Format, TextureScene> all;
  if (const auto found = all.find(format); found != all.end()) return found->second;
  SceneParameters p;
  p.source = "object";
  p.width = 40;
  p.height = 26;
  p.texture_size = 64;
  p.visibility = Visibility::kOverdraw;
  SamplerParameters sampler;
  sampler.format = format;
  return all.try_emplace(format, p, sampler, 1).first->second;
}

TextureSetup small_setup() {
  TextureSetup setup;
  setup.memory.latency = 30;
  return setup;
}

Json run(const TextureScene& of, const TextureSetup& setup, const SimulationOptions& options = {}) {
  return Json::parse(forked_text([&] {
    Simulation simulation(options);
    TextureEnvironment environment(simulation, of, setup);
    simulation.elaborate(environment);
    std::string error;
    try {
      simulation.run();
    } catch (const spec::Error& ended) {
      error = ended.what();
    }
    environment.check();
    Json json = json_of(simulation);
    json["error"] = error;
    json["maps"] = json_of(environment.maps());
    const Amount amount = environment.amount();
    json["amount"] = {amount.delivered, amount.taken, amount.total, std::string(amount.unit)};
    json["hash"] = environment.colour_hash();
    Json& colours = json["frame"] = Json::array();
    for (const Rgba8& pixel : environment.frame().pixels) colours.push_back(pixel);
    Json& golden = json["golden"] = Json::array();
    for (const Rgba8& pixel : environment.golden_frame().pixels) golden.push_back(pixel);
    json["came"] = environment.came();
    json["by_samples"] = environment.golden_work().by_samples;
    return json.dump();
  }));
}

SimulationOptions watched() {
  SimulationOptions options;
  options.maps = options.coverage = true;
  const FragmentStream& stream = scene().stream();
  const spec::texture::Quad& quad = stream.quads[stream.quads.size() / 2];
  const auto pixel = stream.pixel(quad.tag, std::countr_zero(quad.coverage));
  options.pixel = PixelAddress{pixel.x, pixel.y};
  return options;
}

TEST(TextureFigures, AResetChangesNoFigure) {
  SimulationOptions options = watched();
  const Json whole = run(scene(), small_setup(), options);
  const auto cycles = static_cast<rtl::Cycle>(number_at(whole, "/cycles"));
  // Clocks are counted from the first clock of the run on.
  const auto without_clocks = [](Json json) {
    for (Json& step : json["pixel"]["steps"]) step.erase("clock");
    return json;
  };
  for (const rtl::Cycle at : {rtl::Cycle{40}, cycles / 2, cycles - 5}) {
    options.reset_after = at;
    Json again = run(scene(), small_setup(), options);
    for (const char* const key : {"checks", "scoreboards"}) again[key] = whole[key];
    for (const auto& [name, unit] : whole["units"].items())
      again["units"][name]["idle"] = unit["idle"];
    EXPECT_EQ(Json::diff(without_clocks(whole), without_clocks(again)), Json::array()) << at;
  }
}

TEST(TextureFigures, AreOfEveryFragmentAndLine) {
  const std::pair<spec::texture::Format, double> formats[] = {{spec::texture::Format::kRgba8, 4},
                                                              {spec::texture::Format::kL8, 1}};
  for (const auto& [format, bytes] : formats)
    for (const int line : {64, 128}) {
      TextureSetup setup = small_setup();
      setup.texture.cache_line_bytes = line;
      const TextureScene& of = scene(format);
      const Json r = run(of, setup);
      const auto w = [&](const char* name) { return work(r, name); };
      const auto fragments = static_cast<double>(of.stream().counts.fragments);
      const double lines = w("miss_queue_line_fills"), bilinears = w("addresser_bilinears");
      EXPECT_EQ(r["amount"], Json({fragments, fragments, fragments, "fragment"}));
      EXPECT_EQ(w("fragments"), fragments);
      EXPECT_EQ(w("bilinears"), bilinears);
      EXPECT_DOUBLE_EQ(w("bilinears_per_fragment"), bilinears / fragments);
      EXPECT_DOUBLE_EQ(w("misses_per_texel"), lines / (4 * bilinears));
      EXPECT_DOUBLE_EQ(w("texel_hits_percent"), 100 - 100 * lines / (4 * bilinears));
      EXPECT_DOUBLE_EQ(w("texels_fetched_per_fragment"), lines * line / bytes / fragments);
      const double look_ups = w("tag_stage_hits") + w("tag_stage_merged") + w("tag_stage_misses");
      EXPECT_DOUBLE_EQ(w("look_up_hits_percent"), 100 * w("tag_stage_hits") / look_ups);
      EXPECT_DOUBLE_EQ(w("look_up_merged_percent"), 100 * w("tag_stage_merged") / look_ups);
      EXPECT_DOUBLE_EQ(w("look_up_misses_percent"), 100 * w("tag_stage_misses") / look_ups);
      EXPECT_EQ(number_at(r, "/memory/lines_filled"), lines);
      EXPECT_EQ(number_at(r, "/memory/bytes_read"), lines * line);
      EXPECT_EQ(number_at(r, "/memory/bytes_written"), 0);
      EXPECT_DOUBLE_EQ(number_at(r, "/throughput/value"), bilinears / number_at(r, "/cycles"));
      EXPECT_EQ(number_at(r, "/scoreboards/colours/comparisons"), fragments);
      EXPECT_EQ(number_at(r, "/checks/traffic_comparisons"), lines * line / 64);
      double latencies = 0;
      for (const Json& bin : r["latency"]["histogram"]) latencies += bin["count"].get<double>();
      EXPECT_EQ(latencies, fragments);
      EXPECT_EQ(r["frame"], r["golden"]);
    }
}

TEST(TextureFigures, TheHashIsOfEveryPartOfEveryColour) {
  const TextureSetup setup = small_setup();
  golden::texture::TextureGolden golden = make_golden(scene(), setup.texture);
  OutputHash hash;
  for (const spec::texture::Quad& quad : scene().stream().quads)
    golden.process(quad, [&](const spec::texture::Colour& colour) {
      hash.add(colour.tag);
      hash.add(std::uint64_t{2} * colour.lane + colour.last);
      for (const std::uint8_t channel : colour.rgba) hash.add(channel);
    });
  EXPECT_EQ(run(scene(), setup)["hash"], hash.value());
}

// Each fragment's pixel has its values, and no other: sums over the picture are the counters.
TEST(TextureFigures, MapsAreOfThePixelsThatWereDrawn) {
  const Json r = run(scene(), small_setup(), watched());
  std::vector<int> fragments(40 * 26);
  const FragmentStream& stream = scene().stream();
  for (const auto& quad : stream.quads)
    for (int lane = 0; lane < 4; ++lane)
      if (quad.coverage >> lane & 1) {
        const auto at = stream.pixel(quad.tag, lane);
        ++fragments[static_cast<std::size_t>(40 * at.y + at.x)];
      }
  double samples = 0;
  for (const auto& [name, map] : r["maps"].items()) {
    EXPECT_EQ(map["agrees"], true) << name;
    EXPECT_EQ(map["account"], name != "level") << name;
    ASSERT_EQ(map["values"].size(), fragments.size());
    for (std::size_t i = 0; i < fragments.size(); ++i) {
      const Json& value = map["values"][i];
      ASSERT_EQ(value.is_null(), fragments[i] == 0) << name << i;
      if (value.is_null()) continue;
      if (name == "samples") {
        EXPECT_GE(value, fragments[i]) << i;
        samples += value.get<double>();
      }
      if (name == "latency") {
        EXPECT_GE(value.get<double>(), fragments[i] * 30.0) << i;
      }
    }
  }
  double by_samples = 0;
  for (std::size_t n = 0; n < r["by_samples"].size(); ++n)
    by_samples += static_cast<double>(n) * r["by_samples"][n].get<double>();
  EXPECT_EQ(samples, by_samples);
  EXPECT_EQ(samples, work(r, "walker_samples"));
  EXPECT_GT(r["pixel"]["steps"].size(), 10u);
  for (const Json& step : r["pixel"]["steps"]) EXPECT_EQ(step["differs"], false) << step.dump();
}

// Each line that the range has a byte of fails as often as it is read.
TEST(TextureFigures, ErrorsOfLinesAreExpected) {
  const auto errors_of = [](std::int64_t from, std::int64_t bytes) {
    TextureSetup setup = small_setup();
    setup.memory.error_address = from;
    setup.memory.error_bytes = bytes;
    const Json r = run(scene(), setup);
    EXPECT_EQ(number_at(r, "/checks/mismatches"), 0);
    EXPECT_EQ(r["frame"], r["golden"]);
    const std::string error = r["error"];
    EXPECT_TRUE(error.empty() || error.starts_with("memory answered ")) << error;
    const std::uint64_t count =
        error.empty() ? 0 : std::stoull(error.substr(sizeof "memory answered " - 1));
    EXPECT_EQ(work(r, "miss_queue_memory_errors"), count);
    return count;
  };
  // Two lines side by side that are read.
  golden::texture::TextureGolden golden = make_golden(
      scene(), small_setup().texture, golden::texture::TextureGolden::Traffic::kPredict);
  golden.record_fills(true);
  for (const spec::texture::Quad& quad : scene().stream().quads) golden.process(quad);
  const std::set<std::uint32_t> lines(golden.fills().begin(), golden.fills().end());
  const auto both = std::adjacent_find(lines.begin(), lines.end(),
                                       [](std::uint32_t a, std::uint32_t b) { return b == a + 1; });
  ASSERT_NE(both, lines.end());
  const std::int64_t line = std::int64_t{64} * *both;
  const std::uint64_t first = errors_of(line, 64), second = errors_of(line + 64, 64);
  EXPECT_GT(first, 0u);
  EXPECT_GT(second, 0u);
  EXPECT_EQ(errors_of(line, 128), first + second);
  EXPECT_EQ(errors_of(line + 63, 2), first + second);
  EXPECT_EQ(errors_of(line + 1, 1), first);
}

}  // namespace
}  // namespace deburr::tb::figures_test
