// SPDX-License-Identifier: MIT
#include "tb/engines/geometric/geometric_environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "golden/geometric/configuration.h"
#include "spec/error.h"
#include "spec/geometric/registers.h"
#include "tb/base/random.h"
#include "tb/engines/geometric/geometric_coverage.h"
#include "tb/engines/geometric/geometric_unprogrammed.h"

namespace deburr::tb {
namespace {

using spec::geometric::BlockRecord;
using spec::geometric::Candidate;
using spec::geometric::LineRecord;
using spec::geometric::Region;
using spec::geometric::Rgba8;

platform::MemoryModelParameters memory_of(const GeometricSetup& setup,
                                          const platform::GeometricRegions& regions,
                                          std::uint64_t seed) {
  platform::MemoryModelParameters m = memory_model_parameters(setup.memory, regions.bytes(), seed);
  m.record_writes = true;
  return m;
}

}  // namespace

platform::GeometricRegions regions_of(std::span<const geometric::Frame> frames,
                                      const spec::geometric::Parameters& parameters) {
  std::vector<platform::GeometricSizes> sizes;
  for (const geometric::Frame& frame : frames)
    sizes.push_back({frame.image.width, frame.image.height, frame.screen.edges.size(),
                     frame.screen.vertices.size(), frame.screen.faces,
                     platform::boundaries_of(frame.screen.edges)});
  return platform::GeometricRegions::allocate(sizes, parameters);
}

// ---- construction -------------------------------------------------------------------------------

GeometricEnvironment::GeometricEnvironment(Simulation& simulation,
                                           std::span<const geometric::Frame> frames,
                                           const GeometricSetup& setup, std::string name)
    : Environment(simulation, std::move(name)),
      frames_(frames),
      setup_(setup),
      faults_(simulation.faults(), this->name(), frames, setup_),
      regions_(regions_of(frames, setup.geometric)),
      engine_("geometric", simulation.clock(), as_built(), memory_cycles(setup_)),
      memory_(memory_name().c_str(), simulation.clock().period(),
              memory_of(setup, regions_, simulation.options().seed)),
      host_("geometric_host"),
      driver_(host_, memory_, as_built()),
      meter_(this->name(), engine_, memory_, frames, setup_),
      checks_(setup_, regions_, golden()) {
  for (const geometric::Frame& frame : frames)
    golden::geometric::check_frame(
        setup.geometric, {frame.image.width, frame.image.height, frame.screen.edges.size(),
                          frame.screen.vertices.size(), frame.screen.faces});
  know(faults_.list());
  faults_.inject(engine_);
  let_misdecode(engine_.control, std::array{spec::geometric::reg::kConfiguration},
                programs() ? "" : "run.program = registers");
  driver_.place(regions_);
  let_blind({&checks_.lines, &checks_.candidates, &checks_.blocks, &checks_.pixels,
             &checks_.traffic, &checks_.registers.board(), &checks_.figures.board()});
  let_miscount(checks_.figures);
  std::array<std::uint32_t, spec::geometric::kRegisters.size()> checked{};
  std::transform(spec::geometric::kRegisters.begin(), spec::geometric::kRegisters.end(),
                 checked.begin(), [](const spec::RegisterInfo& info) { return info.offset; });
  let_miscount(checks_.registers, checked);
  engine_.memory()->bind(memory_.ports);
  host_.bus.bind(engine_.registers);
  inject_in(memory_, setup.memory);
  if (simulation.options().maps) maps_.emplace();
  if (const std::optional<PixelAddress>& pixel = simulation.options().pixel) {
    for (const geometric::Frame& frame : frames)
      reject_outside(*pixel, frame.image.width, frame.image.height);
    history_.emplace(*pixel);
  }
  observe();
}

spec::geometric::Parameters GeometricEnvironment::as_built() const {
  const spec::geometric::Parameters run = faults_.as_built();
  return programs() ? unprogrammed(run) : run;
}

void GeometricEnvironment::observe() {
  const auto cycle = [this] { return simulation().clock().cycle(); };
  engine_.resolver.observer = [this, cycle](const BlockRecord& block) {
    blocks_.push_back(block);
    if (maps_) maps_->see(block);
    if (history_) history_->see(block, cycle());
    checks_.got(block, cycle());
  };
  if (maps_ || history_ || golden())
    engine_.depth_test.observer = [this, cycle](const Candidate& candidate) {
      if (maps_) maps_->see(candidate);
      if (history_) history_->see(candidate, cycle());
      checks_.got(candidate, cycle());
    };
  if (history_ || golden())
    engine_.line_setup.observer = [this, cycle](const LineRecord& line) {
      if (history_) history_->see(line, cycle());
      checks_.got(line, cycle());
    };
}

// ---- simulation ---------------------------------------------------------------------------------

void GeometricEnvironment::configure() {
  driver_.identify();
  if (programs()) driver_.set_configuration(faults_.as_built());
  checks_.clear_counters();
}

bool GeometricEnvironment::begin(std::size_t piece) {
  if (piece >= frames_.size()) return false;
  current_ = piece;
  ended_ = false;
  meter_.begin(piece);
  started_ = false;
  blocks_.clear();
  if (maps_) maps_->begin(current().image.width, current().image.height);
  if (history_) history_->begin();
  watch();
  error_lines_ = error_lines();
  memory_.forget_lines();
  load();
  checks_.begin(current());
  if (name().empty()) draw();
  return true;
}

void GeometricEnvironment::load() {
  const geometric::Frame& frame = current();
  const std::vector<std::uint8_t> facing = faults_.facing(frame);
  platform::GeometricFrame in_memory = {frame.image.width,  frame.image.height,
                                        frame.screen.edges, frame.screen.vertices,
                                        frame.screen.faces, facing,
                                        frame.depths,       {}};
  if (name().empty()) in_memory.colours = frame.image.pixels;
  driver_.load(in_memory);
  if (!simulation().options().poison) return;
  // Memory that has not been written holds noise.
  Random random(simulation().options().seed, "memory");
  for (const Region region : {Region::kWeights, Region::kCopy}) {
    const std::uint64_t end =
        regions_.base(region == Region::kCopy ? Region::kPairs : Region::kColour);
    std::vector<std::uint8_t> noise(end - regions_.base(region));
    for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random.word());
    memory_.preload(regions_.base(region), noise);
  }
}

void GeometricEnvironment::draw() {
  driver_.draw();
  started_ = true;
}

void GeometricEnvironment::restart() {
  // Earlier requests are still outstanding; they complete before the frame starts. A composition
  // starts frames itself and has waited during the reset.
  if (name().empty()) drain_memory();
  memory_.clear_statistics();
  error_lines_ = {};
  checks_.restart();
  begin(current_);
}

void GeometricEnvironment::watch() { checks_.check_traffic(memory_, simulation().clock().cycle()); }

void GeometricEnvironment::end() {
  watch();
  const Image after = frame();
  for (const Rgba8& pixel : after.pixels)
    hash_.add(pixel[0] | std::uint64_t{pixel[1]} << 8 | std::uint64_t{pixel[2]} << 16 |
              std::uint64_t{pixel[3]} << 24);
  checks_.end(after, simulation().clock().cycle());
  ended_ = true;
  meter_.end();
}

void GeometricEnvironment::finish() {
  std::uint64_t pixels = 0;
  for (const geometric::Frame& frame : frames_) pixels += frame.image.pixels.size();
  checks_.finish(engine_, memory_, pixels, host_);
}

void GeometricEnvironment::reject_memory_errors() {
  if (const std::uint32_t errors = driver_.memory_errors(); errors != 0)
    throw spec::SimulationError(
        fmt::format("memory answered {} lines with an error, which read as zero: look at "
                    "{}.error_address, or at the bases of the regions",
                    errors, memory_name()));
}

void GeometricEnvironment::reject_unused_errors() const {
  reject_untouched(memory_, setup_.memory);
}

Amount GeometricEnvironment::amount() const {
  std::uint64_t all = 0;
  for (const geometric::Frame& frame : frames_) all += frame.screen.edges.size();
  return {meter_.edges_done(), engine_.edge_classifier.edges.value(), all, "edge"};
}

// ---- checking -----------------------------------------------------------------------------------

Environment::Boards GeometricEnvironment::outputs() const {
  return {&checks_.lines, &checks_.candidates, &checks_.blocks, &checks_.pixels};
}

Image GeometricEnvironment::frame() const {
  Image image(current().image.width, current().image.height);
  image.pixels = driver_.picture();
  return image;
}

// ---- results ------------------------------------------------------------------------------------

GeometricEnvironment::LinesByRegion GeometricEnvironment::error_lines() const {
  LinesByRegion all = error_lines_;
  if (const auto range = error_range(setup_.memory))
    for (const auto* const lines : {&memory_.lines_read(), &memory_.lines_written()})
      for (const std::uint64_t line : *lines)
        if (range->touches(line, spec::geometric::kLineBytes)) ++all[regions_.region_of(line)];
  return all;
}

Coverage GeometricEnvironment::coverage() const {
  Coverage coverage = geometric_coverage(engine_, golden_model().coverage(), setup_.geometric);
  const LinesByRegion errors = error_lines();
  for (std::size_t region = 0; region < errors.size(); ++region)
    if (errors[region] > 0) {
      const std::string bin =
          fmt::format("geometric/error/{}", spec::geometric::kRegionNames[region]);
      coverage.declare(bin);
      coverage.hit(bin, errors[region]);
    }
  return coverage;
}

std::optional<PixelHistory> GeometricEnvironment::pixel_history() const {
  if (!history_) return std::nullopt;
  PixelHistory all =
      history_->history(current(), frame(), ended_, golden() ? &golden_model() : nullptr);
  for (PixelStep& step : all.steps) step.part = name();
  return all;
}

std::vector<PictureMap> GeometricEnvironment::maps() const {
  if (!maps_) return {};
  const auto line_of = [&](int x, int y) {
    return std::uint64_t{regions_.base(Region::kDepth)} + checks_.line_offset(x, y);
  };
  return meter_.named(maps_->maps(engine_, line_of, memory_.lines_read(), frames_.size() == 1));
}

// Defined here, because inlined copies can keep the compiler from optimising the units.
GeometricEnvironment::~GeometricEnvironment() = default;

}  // namespace deburr::tb
