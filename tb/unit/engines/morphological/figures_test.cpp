// SPDX-License-Identifier: MIT
// Figures, maps and expectations of runs of several frames that differ in size and content.
#include <cmath>

#include "spec/error.h"
#include "tb/system/morphological_runs.h"
#include "tb/unit/engines/run_figures.h"

namespace deburr::tb::figures_test {
namespace {

using spec::morphological::Lanes;
using spec::morphological::Preset;
using spec::morphological::Storage;

constexpr double kMhz = 200;

// Rows of full beats, and rows that end in a half beat.
const std::vector<MorphologicalInput>& frames() {
  static const std::vector<MorphologicalInput> all = {
      morphological_system::blocks(47, 20, 3), morphological_system::noise(24, 33, 5),
      // A shallow edge next to a steep one: runs that are extended.
      morphological_system::draw(50, 22, [](int x, int y) {
        return morphological_system::grey((x < 30 ? 7 * y > x + 40 : 2 * y > 15 * (x - 37)) ? 200
                                                                                            : 40);
      })};
  return all;
}

MorphologicalSetup lines_on_chip() {
  MorphologicalSetup setup;
  setup.morphological = morphological_system::preset(Preset::kDeburr);
  setup.descriptors = true;
  return setup;
}
MorphologicalSetup in_memory() {
  MorphologicalSetup setup = lines_on_chip();
  setup.morphological = morphological_system::preset(Preset::kDeburrLine);
  setup.morphological.storage = Storage::kMemory;
  setup.memory.latency = 30;
  setup.pixel_base = 4096;
  return setup;
}
MorphologicalSetup two_lanes() {
  MorphologicalSetup setup = in_memory();
  setup.morphological.lanes = Lanes::kTwo;
  return setup;
}
const std::vector<MorphologicalSetup>& setups() {
  static const std::vector<MorphologicalSetup> all = {lines_on_chip(), in_memory(), two_lanes()};
  return all;
}

struct Options : SimulationOptions {
  Options() {
    clock_mhz = kMhz;
    coverage = true;
  }
};

Json run(const std::vector<MorphologicalInput>& input, const MorphologicalSetup& setup,
         const SimulationOptions& options = Options()) {
  return Json::parse(forked_text([&] {
    Simulation simulation(options);
    MorphologicalEnvironment environment(simulation, input, setup);
    simulation.elaborate(environment);
    std::string error;
    try {
      simulation.run();
    } catch (const spec::Error& ended) {
      error = ended.what();
    }
    if (error.empty() || error.starts_with("memory answered")) environment.check();
    Json json = json_of(simulation);
    json["error"] = error;
    json["maps"] = json_of(environment.maps());
    const Amount amount = environment.amount();
    json["amount"] = {amount.delivered, amount.total, std::string(amount.unit)};
    json["taken"] = amount.taken;
    json["hash"] = environment.pixel_hash();
    json["delivered"] = environment.delivered();
    json["input_cycles"] = environment.input_cycles();
    Json& colours = json["frame"] = Json::array();
    for (const Rgba8& pixel : environment.frame().pixels) colours.push_back(pixel);
    return json.dump();
  }));
}

std::vector<Json> each_alone(const MorphologicalSetup& setup) {
  std::vector<Json> alone;
  for (const MorphologicalInput& frame : frames()) alone.push_back(run({frame}, setup));
  return alone;
}

const SeveralFrames kFigures = {
    .from_last = {"frame_cycles", "frame_cycles_by_formula", "latency_by_formula",
                  "slot_sequencer_frame_cycles"},
    .largest = {"memory_port_max_outstanding"},
    .by_formula = {"edge_pixels_percent", "blended_pixels_percent", "line_unit_h_occupancy_percent",
                   "line_unit_v_occupancy_percent", "input_pixels_per_cycle",
                   "memory_bytes_per_pixel", "frame_rate", "clock_for_1080p60",
                   "pixel_clock_of_1080p60", "fits_1080p60"}};

double area(const std::vector<MorphologicalInput>& input) {
  double all = 0;
  for (const MorphologicalInput& frame : input) all += frame.image.width * frame.image.height;
  return all;
}

void expect_formulas(const Json& r, double lanes) {
  const auto w = [&](const char* name) { return work(r, name); };
  const double pixels = area(frames());
  EXPECT_EQ(w("blender_pixels"), pixels);
  EXPECT_DOUBLE_EQ(w("edge_pixels_percent"), 100 * w("edge_detector_edge_pixels") / pixels);
  EXPECT_DOUBLE_EQ(w("blended_pixels_percent"), 100 * w("blender_blended_pixels") / pixels);
  for (const std::string divider : {"line_unit_h", "line_unit_v"}) {
    const Json& unit = r["units"][divider];
    double cycles = unit["busy"].get<double>() + unit["idle"].get<double>();
    for (const auto& [cause, stalled] : unit["stalls"].items()) cycles += stalled.get<double>();
    EXPECT_DOUBLE_EQ(work(r, divider + "_occupancy_percent"),
                     100 * work(r, divider + "_occupancy") / (lanes * cycles));
  }
  EXPECT_DOUBLE_EQ(
      w("memory_bytes_per_pixel"),
      (number_at(r, "/memory/bytes_read") + number_at(r, "/memory/bytes_written")) / pixels);
  EXPECT_DOUBLE_EQ(number_at(r, "/throughput/value"), pixels / number_at(r, "/cycles"));
  EXPECT_EQ(number_at(r, "/throughput/bound"), lanes);
  const MorphologicalInput& last = frames().back();
  EXPECT_DOUBLE_EQ(w("input_pixels_per_cycle"),
                   last.image.width * last.image.height / number_at(r, "/input_cycles"));
  EXPECT_DOUBLE_EQ(w("frame_rate"), kMhz * 1e6 / w("frame_cycles"));
  // docs/reference/morphological/hardware.md: R + 5 rows and the cycles of the pipe.
  const morphological_system::Parameters p = lines_on_chip().morphological;
  const int rows = p.window_rows / 2 - 1 + 5;
  const double beats = std::ceil(last.image.width / lanes),
               latency = rows * beats + spec::morphological::kPipelineLatency;
  EXPECT_EQ(w("latency_by_formula"), latency);
  EXPECT_EQ(w("frame_cycles_by_formula"), latency + last.image.height * beats);
  const double hd = 1920 / lanes, slowness = w("frame_cycles") / w("frame_cycles_by_formula");
  EXPECT_GE(slowness, 1);
  EXPECT_DOUBLE_EQ(
      w("clock_for_1080p60"),
      slowness * (rows * hd + spec::morphological::kPipelineLatency + 1080 * hd) * 60 / 1e6);
  EXPECT_EQ(r["work"]["fits_1080p60"], w("clock_for_1080p60") <= 148.5);
}

TEST(MorphologicalFigures, ThreeFramesGiveSumsRatiosOrLastValues) {
  for (const MorphologicalSetup& setup : setups()) {
    const std::vector<Json> alone = each_alone(setup);
    const Json all = run(frames(), setup);
    const double lanes = platform::lanes_of(setup.morphological);
    // With memory, the arrival of a unit's inputs may shift by a few cycles after another frame.
    const bool stored = setup.morphological.storage == Storage::kMemory;
    SeveralFrames figures = kFigures;
    if (stored)
      figures.by_formula.insert({"run_extractor_interlock_stalls",
                                 "run_extractor_descriptor_stalls",
                                 "endpoint_predictor_h_occupancy", "endpoint_predictor_v_occupancy",
                                 "area_unit_bank_conflicts"});
    expect_sums(all, alone, figures, stored ? 10 : 0);
    expect_formulas(all, lanes);
    EXPECT_EQ(all["amount"], Json({area(frames()), area(frames()), "pixel"}));
    double beats = 0;
    for (const MorphologicalInput& frame : frames())
      beats += std::ceil(frame.image.width / lanes) * frame.image.height;
    EXPECT_EQ(all["taken"], beats * lanes);
    if (!stored) {
      EXPECT_EQ(all["input_cycles"], frames().back().image.pixels.size()) << "a pixel a clock";
    }
    if (stored) {
      EXPECT_GT(work(all, "line_unit_h_occupancy"), 0);
      EXPECT_GT(work(all, "line_unit_v_occupancy"), 0);
    }
    EXPECT_EQ(all["delivered"], frames().back().image.pixels.size());
    EXPECT_EQ(all["frame"], alone.back()["frame"]);
    for (const auto& [name, memory] : all["memories"].items())
      EXPECT_EQ(memory["logical_bits_at_frame_width"],
                alone.back()["memories"][name]["logical_bits_at_frame_width"])
          << name;
    // Lines of 16 pixels, each written once and read once.
    double lines = 0;
    for (const MorphologicalInput& frame : frames())
      lines += std::ceil(frame.image.width / 16.0) * frame.image.height;
    if (setup.morphological.storage != Storage::kMemory) lines = 0;
    EXPECT_EQ(number_at(all, "/memory/lines_filled"), lines);
    EXPECT_EQ(number_at(all, "/checks/traffic_comparisons"), 2 * lines);
    EXPECT_EQ(number_at(all, "/memory/bytes_read"), 64 * lines);
    // Every run and line of each frame is compared.
    EXPECT_EQ(
        number_at(all, "/scoreboards/runs/comparisons"),
        work(all, "run_extractor_horizontal_runs") + work(all, "run_extractor_vertical_runs"));
    EXPECT_GE(number_at(all, "/scoreboards/lines/comparisons"), work(all, "run_extractor_z_runs"));
    EXPECT_GT(work(all, "run_extractor_z_runs"), 10);
    for (const char* const board : {"pixels", "probes"})
      EXPECT_EQ(all["scoreboards"][board]["comparisons"], area(frames())) << board;
  }
}

// The hash covers every pixel and probe of every frame, in order.
TEST(MorphologicalFigures, HashCoversEveryFrame) {
  const MorphologicalSetup setup = lines_on_chip();
  OutputHash hash;
  golden::morphological::MorphologicalGolden golden(setup.morphological);
  for (const MorphologicalInput& frame : frames()) {
    const Image& image = frame.image;
    golden.process({image.pixels, image.width, image.height},
                   frame.depth.empty()
                       ? golden::morphological::DepthView()
                       : golden::morphological::DepthView(frame.depth, image.width, image.height));
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      const auto& p = golden.pixels()[i];
      const auto& t = golden.probes()[i];
      std::uint64_t word = 0;
      for (const std::uint64_t byte :
           {std::uint64_t{t.horizontal}, std::uint64_t{t.edges}, std::uint64_t{t.second},
            std::uint64_t{t.first}, std::uint64_t{p[3]}, std::uint64_t{p[2]}, std::uint64_t{p[1]},
            std::uint64_t{p[0]}})
        word = word << 8 | byte;
      hash.add(word);
    }
  }
  EXPECT_EQ(run(frames(), setup)["hash"], hash.value());
}

// The required clock scales with the cycles that stalls add to the frame.
TEST(MorphologicalFigures, StalledFrameNeedsFasterClock) {
  Options options;
  options.stall_permille = 200;
  const Json r = run(frames(), lines_on_chip(), options);
  EXPECT_GT(work(r, "frame_cycles"), 1.1 * work(r, "frame_cycles_by_formula"));
  EXPECT_GT(number_at(r, "/input_cycles"), 1.1 * area({frames().back()}));
  expect_formulas(r, 1);
}

// A bright rectangle with its corner at (3, 2).
Json run_of_a_rectangle(int wide, int high) {
  const MorphologicalInput frame = morphological_system::draw(12, 8, [&](int x, int y) {
    return morphological_system::grey(x >= 3 && x < 3 + wide && y >= 2 && y < 2 + high ? 240 : 10);
  });
  MorphologicalSetup setup;
  setup.morphological = morphological_system::preset(Preset::kMlaa);
  Options options;
  options.maps = true;
  options.pixel = PixelAddress{4, 1 + high};
  Json r = run({frame}, setup, options);
  const auto at = [&](const char* map, int x, int y) {
    return r["maps"][map]["values"].at(static_cast<std::size_t>(12 * y + x));
  };
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 12; ++x) {
      const bool top = (y == 2 || y == 2 + high) && x >= 3 && x < 3 + wide,
                 left = (x == 3 || x == 3 + wide) && y >= 2 && y < 2 + high;
      EXPECT_EQ(at("edges", x, y), int{top} + int{left}) << x << ' ' << y;
      EXPECT_EQ(at("run_length", x, y), std::max(top ? wide : 0, left ? high : 0)) << x << ' ' << y;
    }
  return r;
}

TEST(MorphologicalFigures, MapsOfRectangleMatchValuesByHand) {
  run_of_a_rectangle(3, 5);
  const Json r = run_of_a_rectangle(5, 3);
  // The edge below an inner pixel belongs to the next row.
  std::set<std::string> seen;
  for (const Json& step : r["pixel"]["steps"]) {
    seen.insert(step["step"].get<std::string>() + " " + step["item"].get<std::string>());
    EXPECT_EQ(step.value("golden", ""), step.value("hardware", "")) << step.dump();
  }
  EXPECT_TRUE(seen.contains("bottom edge run")) << r["pixel"].dump();
  EXPECT_FALSE(seen.contains("top edge run"));
  EXPECT_FALSE(seen.contains("left edge run"));
  EXPECT_FALSE(seen.contains("right edge run"));
}

// Maps of one frame must add up to its counters; those of several frames show the last.
TEST(MorphologicalFigures, MapsAndHistoryShowLastFrame) {
  Options options;
  options.maps = true;
  options.pixel = PixelAddress{9, 6};
  for (const std::size_t last : {0, 2}) {
    const std::vector<MorphologicalInput> several = {frames()[1], frames()[last]};
    const Json alone = run({several.back()}, in_memory(), options),
               all = run(several, in_memory(), options);
    ASSERT_EQ(alone["maps"].size(), 3u);
    expect_maps_of_the_last(all, alone, several.back().image.width, several.back().image.height);
    EXPECT_EQ(without_cycles(all["pixel"]), without_cycles(alone["pixel"]));
  }
}

// An aborted frame takes nothing from the previous one.
TEST(MorphologicalFigures, HistoryOfAbortedFrameIsItsOwn) {
  Options options;
  options.pixel = PixelAddress{9, 6};
  const std::vector<MorphologicalInput> two = {frames()[1], frames()[0]};
  const auto before = static_cast<rtl::Cycle>(number_at(run({two[0]}, lines_on_chip()), "/cycles"));
  options.max_cycles = 500;
  const Json alone = run({two[1]}, lines_on_chip(), options);
  options.max_cycles += before;
  const Json all = run(two, lines_on_chip(), options);
  EXPECT_EQ(without_cycles(all["pixel"]), without_cycles(alone["pixel"]));
  EXPECT_EQ(all["delivered"], alone["delivered"]);
  EXPECT_EQ(all["frame"], alone["frame"]);
}

TEST(MorphologicalFigures, ResetInFirstFrameChangesNoFigure) {
  const std::vector<MorphologicalInput> two = {frames()[2], frames()[0]};
  for (const MorphologicalSetup& setup : setups()) {
    Options options;
    options.maps = true;
    const Json whole = run(two, setup, options);
    // Before the first output pixel, during output, and before the last pixel.
    const auto first = static_cast<rtl::Cycle>(number_at(run({two[0]}, setup), "/cycles"));
    for (const rtl::Cycle at : {rtl::Cycle{70}, first - 300, first - 10}) {
      options.reset_after = at;
      Json again = run(two, setup, options);
      for (const char* const key : {"checks", "scoreboards"}) again[key] = whole[key];
      for (const auto& [name, unit] : whole["units"].items())
        again["units"][name]["idle"] = unit["idle"];  // includes draining memory
      again["work"]["line_unit_h_occupancy_percent"] =
          whole["work"]["line_unit_h_occupancy_percent"];
      again["work"]["line_unit_v_occupancy_percent"] =
          whole["work"]["line_unit_v_occupancy_percent"];
      EXPECT_EQ(Json::diff(whole, again), Json::array()) << at;
    }
  }
}

std::uint64_t errors_of(const std::vector<MorphologicalInput>& input, std::int64_t from,
                        std::int64_t bytes) {
  MorphologicalSetup setup = in_memory();
  setup.memory.error_address = from;
  setup.memory.error_bytes = bytes;
  const Json r = run(input, setup);
  EXPECT_EQ(number_at(r, "/checks/mismatches"), 0);
  EXPECT_EQ(work(r, "pixel_store_memory_errors"), work(r, "memory_port_errors"));
  const std::string error = r["error"];
  EXPECT_TRUE(error.empty() || error.starts_with("memory answered ")) << error;
  return error.empty() ? 0 : std::stoull(error.substr(sizeof "memory answered " - 1));
}

// Lines at the end of memory belong to the largest frame only: it has the errors, at any position
// among the others, and MEMORY_ERRORS keeps them to the end.
TEST(MorphologicalFigures, ExpectsErrorsInOnlyOneOfThreeFrames) {
  // 2 x 33 and 4 x 11 lines
  const MorphologicalInput &tall = frames()[1], flat = morphological_system::a_fifth(50, 11);
  const std::int64_t behind = 4096 + 64 * 50;
  for (const std::vector<MorphologicalInput>& order :
       {std::vector{tall, flat, flat}, {flat, tall, flat}, {flat, flat, tall}})
    EXPECT_EQ(errors_of(order, behind, 3 * 64), 2u * 3);
  EXPECT_EQ(errors_of({tall, flat, tall}, behind, 3 * 64), 2u * 2 * 3);
  EXPECT_EQ(errors_of({flat, flat}, behind, 3 * 64), 0u);
  // The last byte of a line and the first of the next: both lines fail as a whole.
  EXPECT_EQ(errors_of({flat, flat}, 4096 + 64 * 20 + 63, 2), 2u * 2 * 2);
  EXPECT_EQ(errors_of({flat, flat}, 4096 + 64 * 20 + 1, 63), 2u * 2 * 1);
}

}  // namespace
}  // namespace deburr::tb::figures_test
