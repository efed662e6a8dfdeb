// SPDX-License-Identifier: MIT
// Figures, maps and expectations of runs of the texture unit, including a run with a reset.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>

#include "spec/error.h"
#include "tb/system/texture_runs.h"
#include "tb/unit/engines/run_figures.h"

namespace deburr::tb::figures_test {
namespace {

// A non-square frame with more fragments than pixels.
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

// Large triangles: most quads have all four fragments.
const TextureScene& road() {
  static const TextureScene scene = [] {
    SceneParameters p;
    p.source = "road";
    p.width = 24;
    p.height = 16;
    p.texture_size = 64;
    return TextureScene(p, {}, 1);
  }();
  return scene;
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
    json["came"] = environment.received();
    json["magnified"] = environment.golden_work().magnified;
    json["by_samples"] = environment.golden_work().by_samples;
    return json.dump();
  }));
}

// A pixel with several fragments, not in the first lane.
PixelAddress busy_pixel() {
  const FragmentStream& stream = scene().stream();
  std::map<std::pair<int, int>, int> fragments;
  for (const spec::texture::Quad& quad : stream.quads)
    for (int lane = 0; lane < 4; ++lane)
      if (quad.coverage >> lane & 1) {
        const auto at = stream.pixel(quad.tag, lane);
        if (++fragments[{at.x, at.y}] > 1 && lane == 3) return {at.x, at.y};
      }
  ADD_FAILURE() << "no pixel has two";
  return {};
}

SimulationOptions watched() {
  SimulationOptions options;
  options.maps = options.coverage = true;
  options.pixel = busy_pixel();
  return options;
}

TEST(TextureFigures, ResetChangesNoFigure) {
  SimulationOptions options = watched();
  const Json whole = run(scene(), small_setup(), options);
  const auto cycles = static_cast<rtl::Cycle>(number_at(whole, "/cycles"));
  // Cycles are counted from the start of the run.
  const auto without_cycles = [](Json json) {
    for (Json& step : json["pixel"]["steps"]) step.erase("clock");
    return json;
  };
  for (const rtl::Cycle at : {rtl::Cycle{40}, cycles / 2, cycles - 5}) {
    options.reset_after = at;
    Json again = run(scene(), small_setup(), options);
    for (const char* const key : {"checks", "scoreboards"}) again[key] = whole[key];
    for (const auto& [name, unit] : whole["units"].items())
      again["units"][name]["idle"] = unit["idle"];
    EXPECT_EQ(Json::diff(without_cycles(whole), without_cycles(again)), Json::array()) << at;
  }
}

TEST(TextureFigures, CoverEveryFragmentAndLine) {
  const std::pair<spec::texture::Format, double> formats[] = {{spec::texture::Format::kRgba8, 4},
                                                              {spec::texture::Format::kL8, 1},
                                                              {spec::texture::Format::kBc1, 0.5},
                                                              {spec::texture::Format::kBc3, 1}};
  for (const auto& [format, bytes] : formats)
    for (const int line : {64, 128}) {
      TextureSetup setup = small_setup();
      setup.texture.cache_line_bytes = line;
      if (spec::texture::is_compressed(format))
        setup.texture.decode = spec::texture::Decode::kAfter;
      const TextureScene& of = scene(format);
      const Json r = run(of, setup);
      const auto w = [&](const char* name) { return work(r, name); };
      const auto fragments = static_cast<double>(of.stream().counts.fragments);
      const double lines = w("miss_queue_line_fills"), bilinears = w("texel_addresser_bilinears");
      EXPECT_EQ(r["amount"], Json({fragments, fragments, fragments, "fragment"}));
      EXPECT_EQ(w("fragments"), fragments);
      EXPECT_EQ(w("bilinears"), bilinears);
      EXPECT_DOUBLE_EQ(w("bilinears_per_fragment"), bilinears / fragments);
      EXPECT_DOUBLE_EQ(w("misses_per_texel"), lines / (4 * bilinears));
      EXPECT_DOUBLE_EQ(w("texel_hits_percent"), 100 - 100 * lines / (4 * bilinears));
      EXPECT_DOUBLE_EQ(w("texels_fetched_per_fragment"), lines * line / bytes / fragments);
      const double lookups = w("tag_stage_hits") + w("tag_stage_merged") + w("tag_stage_misses");
      EXPECT_DOUBLE_EQ(w("lookup_hits_percent"), 100 * w("tag_stage_hits") / lookups);
      EXPECT_DOUBLE_EQ(w("lookup_merged_percent"), 100 * w("tag_stage_merged") / lookups);
      EXPECT_DOUBLE_EQ(w("lookup_misses_percent"), 100 * w("tag_stage_misses") / lookups);
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

TEST(TextureFigures, HashCoversEveryPartOfEveryColour) {
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

// Only drawn pixels have values: sums over the image equal the counters.
TEST(TextureFigures, MapsCoverTheDrawnPixels) {
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
  EXPECT_EQ(samples, work(r, "sample_walker_samples"));
  EXPECT_GT(r["pixel"]["steps"].size(), 10u);
  for (const Json& step : r["pixel"]["steps"]) EXPECT_EQ(step["differs"], false) << step.dump();
}

// A step of one fragment by the golden model: part, step, item, value.
using Decided = std::array<std::string, 4>;

// Numbers with this number of fraction bits, separated by blanks.
std::string numbers(int fraction_bits, std::initializer_list<double> values) {
  std::string text;
  for (const double value : values)
    text += (text.empty() ? "" : ", ") + fmt::format("{}", std::ldexp(value, -fraction_bits));
  return text;
}

// Steps of one pixel of a scene by the golden model.
std::vector<Decided> decided(const TextureScene& of, const PixelAddress& pixel,
                             const spec::texture::Parameters& p) {
  using golden::texture::TextureGolden;
  TextureGolden golden = make_golden(of, p, TextureGolden::Traffic::kPredict);
  const bool two = p.axes == spec::texture::Axes::kTwo;
  std::vector<Decided> all;
  int number = 0;
  const FragmentStream& stream = of.stream();
  for (std::size_t q = 0; q < stream.quads.size(); ++q) {
    const spec::texture::Quad& quad = stream.quads[q];
    int lane = 3;
    const auto is_it = [&] {
      const auto at = stream.pixel(quad.tag, lane);
      return (quad.coverage >> lane & 1) != 0 && at.x == pixel.x && at.y == pixel.y;
    };
    while (lane >= 0 && !is_it()) --lane;
    if (lane < 0) {
      golden.process(quad);
      continue;
    }
    const auto add = [&](const std::string& step, const std::string& item, std::string value) {
      all.push_back({"fragment " + std::to_string(number), step, item, std::move(value)});
    };
    const auto l = static_cast<std::size_t>(lane);
    const auto a = golden.analyse(quad, lane);
    std::vector<golden::texture::BilinearRequest> requests;
    const auto colours = golden.process(quad, lane, requests);
    add("quad", "tag, lane, texture", fmt::format("{}, {}, {}", quad.tag, lane, quad.texture));
    if (!(stream.visible[q] >> lane & 1))
      add("quad", "seen", "no: another fragment of the pixel is");
    const auto real = [](std::int64_t n) { return static_cast<double>(n); };
    const auto size = [](std::int64_t n) { return std::abs(static_cast<double>(n)); };
    add("coordinates", "s, t", numbers(24, {real(quad.s[l]), real(quad.t[l])}));
    add("derivatives", "along the row, texels", numbers(16, {size(a.p_x.s), size(a.p_x.t)}));
    add("derivatives", "along the column, texels", numbers(16, {size(a.p_y.s), size(a.p_y.t)}));
    add("footprint", "major axis, texels", numbers(16, {real(a.footprint.d_max)}));
    add("footprint", two ? "minor axis, texels" : "area, texels",
        numbers(16, {two ? real(a.footprint.d_min) : static_cast<double>(a.footprint.area)}));
    add("footprint", "axis, coordinates", numbers(24, {real(a.axis.s), real(a.axis.t)}));
    add("footprint", "log2 of the major axis", numbers(12, {real(a.lod.lb_d_max)}));
    add("level", "samples N", std::to_string(a.lod.samples));
    add("level", "level and 256ths of the next",
        numbers(0, {real(a.lod.level), real(a.lod.fraction)}));
    add("level", "filter", a.lod.linear ? "linear" : "nearest");
    for (const auto& request : requests) {
      const std::string step = fmt::format("sample {} level {}", request.sample, request.level);
      add(step, "s, t", numbers(24, {real(request.s), real(request.t)}));
      std::string texels;
      std::vector<std::uint32_t> lines;
      for (const std::uint32_t address : request.addresses) {
        texels += fmt::format("{}{:#x}", texels.empty() ? "" : ", ", address);
        const auto line = address / static_cast<std::uint32_t>(p.cache_line_bytes);
        if (std::count(lines.begin(), lines.end(), line) == 0) lines.push_back(line);
      }
      add(step, "texels at", texels);
      for (const std::uint32_t line : lines) {
        const bool miss = std::count(request.misses.begin(), request.misses.end(), line) > 0;
        add(step, "line",
            fmt::format("{:#x} {}", line * static_cast<std::uint32_t>(p.cache_line_bytes),
                        miss ? "miss" : "hit"));
      }
    }
    for (const spec::texture::Colour& colour : colours)
      if (colour.lane == lane)
        add("colour", "RGBA",
            fmt::format("{}, {}, {}, {}", colour.rgba[0], colour.rgba[1], colour.rgba[2],
                        colour.rgba[3]));
    ++number;
  }
  return all;
}

// docs/reference/run.md, "One pixel": the history has all golden steps in order, and all of the
// hardware's, also for one of four fragments of a quad.
TEST(TextureFigures, HistoryHasEveryStepOfEveryFragment) {
  SimulationOptions options = watched();
  const auto told = [&](const TextureScene& of, const TextureSetup& setup) {
    const Json r = run(of, setup, options);
    std::vector<Decided> steps;
    std::set<std::string> parts;
    for (const Json& step : r["pixel"]["steps"]) {
      EXPECT_EQ(step["differs"], false) << step.dump();
      parts.insert(step["part"]);
      if (!step["golden"].get<std::string>().empty())
        steps.push_back({step["part"], step["step"], step["item"], step["golden"]});
      if (step["step"] != "quad") {
        EXPECT_NE(step["hardware"], "") << step.dump();
      }
    }
    EXPECT_EQ(steps, decided(of, *options.pixel, setup.texture));
    return parts.size();
  };
  for (const auto axes : {spec::texture::Axes::kTwo, spec::texture::Axes::kEight})
    for (const int line : {64, 128}) {
      TextureSetup setup = small_setup();
      setup.texture.axes = axes;
      setup.texture.cache_line_bytes = line;
      EXPECT_GT(told(scene(), setup), 1);
    }
  const FragmentStream& stream = road().stream();
  const auto whole = std::ranges::find(stream.quads, 15, &spec::texture::Quad::coverage);
  ASSERT_NE(whole, stream.quads.end());
  for (const int lane : {0, 2, 3}) {
    const auto at = stream.pixel(whole->tag, lane);
    options.pixel = PixelAddress{at.x, at.y};
    EXPECT_EQ(told(road(), small_setup()), 1) << lane;
  }
}

// docs/reference/coverage.md: each fragment counts once in each group that it belongs to.
TEST(TextureFigures, BinsCoverEveryFragment) {
  using namespace spec::texture;
  SimulationOptions options;
  options.coverage = true;
  struct Case {
    const char* source;
    SamplerParameters sampler;
    Axes axes;
    Kernel kernel;
    SrgbOutput output;
  };
  SamplerParameters plain, nearest;
  nearest.mode = MinFilter::kNearest;
  nearest.magnification = MagFilter::kNearest;
  nearest.layout = Layout::kLinear;
  nearest.wrap = WrapChoice::kMirroredRepeat;
  nearest.format = Format::kSrgb8A8;
  for (const Case& c : {Case{"object", plain, Axes::kTwo, Kernel::kBox, SrgbOutput::kEncoded},
                        {"road", nearest, Axes::kEight, Kernel::kTent, SrgbOutput::kLinear},
                        {"tunnel", plain, Axes::kEight, Kernel::kAxis, SrgbOutput::kLinear},
                        {"quad", nearest, Axes::kTwo, Kernel::kTent, SrgbOutput::kEncoded}}) {
    SceneParameters p;
    p.source = c.source;
    p.width = 40;
    p.height = 26;
    p.texture_size = 32;
    const TextureScene of(p, c.sampler, 1);
    TextureSetup setup = small_setup();
    setup.texture.axes = c.axes;
    setup.texture.kernel = c.kernel;
    setup.texture.srgb_output = c.output;
    setup.texture.cache_outstanding = 4;
    const Json r = run(of, setup, options);
    const auto bin = [&](const std::string& name) { return hits(r, "texture/" + name); };
    const auto name = [](const auto& names, auto value) {
      return std::string(names[static_cast<std::size_t>(value)]);
    };
    const auto fragments = static_cast<double>(of.stream().counts.fragments),
               magnified = r["magnified"].get<double>();
    const Descriptor& texture = of.memory().descriptors().front();
    const std::string mode = "mode/" + name(kMinFilterNames, texture.min_filter) + '/',
                      layout = '/' + name(kLayoutNames, texture.layout);
    for (const Wrap wrap : {texture.wrap_s, texture.wrap_t})
      EXPECT_EQ(bin(mode + name(kWrapNames, wrap) + layout), fragments - magnified) << c.source;
    EXPECT_EQ(bin("mode/"), (fragments - magnified) * (texture.wrap_s == texture.wrap_t ? 1 : 2));
    EXPECT_EQ(bin("magnified/" + name(kMagFilterNames, texture.mag_filter)), magnified);
    EXPECT_EQ(bin("magnified/"), magnified);
    EXPECT_EQ(bin("format/" + name(kFormatNames, texture.format)), fragments);
    EXPECT_EQ(bin("format/"), fragments);
    const bool srgb = texture.format == Format::kSrgb8A8;
    EXPECT_EQ(bin("output/" + name(kSrgbOutputNames, c.output)), srgb ? fragments : 0);
    EXPECT_EQ(bin("output/"), srgb ? fragments : 0);
    double narrow = 0, wide = 0;
    for (std::size_t n = 1; n < r["by_samples"].size(); ++n) {
      const auto count = r["by_samples"][n].get<double>();
      EXPECT_EQ(bin("samples/" + std::to_string(n)), count) << c.source << n;
      (n < 4 ? narrow : wide) += count;
    }
    const bool tent = c.kernel == Kernel::kTent;
    EXPECT_EQ(bin("tent/narrow"), tent ? narrow : 0);
    EXPECT_EQ(bin("tent/wide"), tent ? wide : 0);
    const bool by_axis = c.kernel == Kernel::kAxis;
    EXPECT_EQ(bin("diagonal/"), by_axis ? bin("major/8/2") + bin("major/8/6") : 0);
    EXPECT_EQ(bin("diagonal/tent") > 0, by_axis);
    EXPECT_EQ(bin(c.axes == Axes::kTwo ? "major/2/" : "major/8/"), fragments);
    EXPECT_EQ(bin("major/"), fragments);
    EXPECT_EQ(bin("cache/hit"), work(r, "tag_stage_hits"));
    EXPECT_EQ(bin("cache/miss"), work(r, "tag_stage_misses"));
    EXPECT_EQ(bin("cache/merged"), work(r, "tag_stage_merged"));
    EXPECT_EQ(bin("cache/queue_full"), r["units"]["tag_stage"]["stalls"]["miss_queue_full"]);
  }
}

// Each line that overlaps the range fails at every read.
TEST(TextureFigures, LineErrorsMatchErrorRange) {
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
  // Two adjacent lines that are read.
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
