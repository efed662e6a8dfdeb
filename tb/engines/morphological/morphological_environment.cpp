// SPDX-License-Identifier: MIT
#include "tb/engines/morphological/morphological_environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "golden/morphological/configuration.h"
#include "spec/error.h"
#include "spec/morphological/registers.h"
#include "tb/engines/morphological/morphological_unprogrammed.h"
#include "tb/stimuli/weight_file.h"

namespace deburr::tb {
namespace {

namespace reg = spec::morphological::reg;

constexpr std::uint32_t kLinkDepth = 2;

// Lanes that are not built have no wires.
rtl::PayloadShape shape_of(const spec::morphological::Parameters& p) {
  return {static_cast<std::uint32_t>(platform::lanes_of(p)), {}};
}

std::span<const MorphologicalInput> checked(std::span<const MorphologicalInput> frames,
                                            const MorphologicalSetup& setup) {
  for (const MorphologicalInput& frame : frames)
    golden::morphological::check_frame(setup.morphological, frame.image.width, frame.image.height);
  return frames;
}

}  // namespace

// ---- construction -------------------------------------------------------------------------------

MorphologicalEnvironment::MorphologicalEnvironment(Simulation& simulation,
                                                   std::span<const MorphologicalInput> frames,
                                                   const MorphologicalSetup& setup,
                                                   std::string name)
    : Environment(simulation, std::move(name)),
      pixels("pixels", kLinkDepth, shape_of(setup.morphological)),
      frames_(checked(frames, setup)),
      setup_(setup),
      faults_(simulation.faults(), this->name(), frames, setup_),
      blended_("blended", kLinkDepth, shape_of(setup.morphological)),
      source_(this->name().empty()
                  ? std::make_unique<FrameSource>("source", simulation.clock(), lanes())
                  : nullptr),
      engine_("morphological", simulation.clock(), as_built()),
      sink_("sink", simulation.clock()),
      memory_(memory_for(frames)),
      host_("morphological_host"),
      driver_(host_, setup.morphological, memory_.get()),
      meter_(this->name(), engine_, progress_, setup_),
      checks_(setup_, golden()) {
  know(faults_.list());
  faults_.inject(engine_);
  let_misdecode(
      engine_.control,
      std::array{reg::kConfiguration, reg::kThreshold, reg::kThresholdOn, reg::kThresholdOff,
                 reg::kAlpha, reg::kFloor, reg::kDepthThreshold, reg::kSmaa},
      programs() ? "" : "run.program = registers");
  progress_.source = source_.get();
  progress_.memory = memory_.get();
  let_blind(
      {&checks_.pixels, &checks_.probes, &checks_.registers.board(), &checks_.figures.board()});
  let_miscount(checks_.figures);
  std::vector<std::uint32_t> checked;
  for (const spec::morphological::WorkCount& each : spec::morphological::kWorkCounts)
    checked.push_back(each.offset);
  checked.insert(checked.end(), {reg::kFrameCycles, reg::kMemoryErrors});
  let_miscount(checks_.registers, checked);
  if (setup.descriptors) let_blind({&checks_.runs, &checks_.lines});
  if (in_memory()) let_blind({&checks_.traffic});
  if (source_) source_->pixels_out(pixels);
  engine_.pixels_in(pixels);
  engine_.pixels_out(blended_);
  sink_.beats_in(blended_);
  host_.bus.bind(engine_.registers);
  if (memory_) {
    engine_.memory()->bind(memory_->ports);
    inject_in(*memory_, setup.memory);
  }
  sink_.keep(false);
  sink_.on_beat = [this](rtl::Cycle cycle, const spec::morphological::BlendedBeat& beat) {
    check_output(cycle, beat);
  };
  if (simulation.options().maps) maps_.emplace();
  if (const std::optional<PixelAddress>& pixel = simulation.options().pixel) {
    for (const MorphologicalInput& frame : frames)
      reject_outside(*pixel, frame.image.width, frame.image.height);
    history_.emplace(*pixel);
  }
  const bool descriptors = golden() && setup.descriptors;
  if (!descriptors && !maps_ && !history_) return;
  const auto cycle = [this] { return this->simulation().clock().cycle(); };
  engine_.observe_runs([this, descriptors, cycle](const spec::morphological::RunDescriptor& run) {
    if (descriptors) checks_.got(run);
    if (maps_) maps_->see(run);
    if (history_) history_->see(run, cycle());
  });
  engine_.observe_lines(
      [this, descriptors, cycle](const spec::morphological::LineDescriptor& line) {
        if (descriptors) checks_.got(line);
        if (maps_) maps_->see(line);
        if (history_) history_->see(line, cycle());
      });
}

std::unique_ptr<platform::MemoryModel> MorphologicalEnvironment::memory_for(
    std::span<const MorphologicalInput> frames) const {
  if (!in_memory()) return nullptr;
  std::uint64_t bytes = 0;
  for (const MorphologicalInput& frame : frames)
    bytes = std::max(bytes, platform::frame_bytes(frame.image.width, frame.image.height));
  platform::MemoryModelParameters m = memory_model_parameters(
      setup_.memory, setup_.pixel_base + bytes, simulation().options().seed);
  m.record_writes = true;
  return std::make_unique<platform::MemoryModel>(memory_name().c_str(),
                                                 simulation().clock().period(), m);
}

spec::morphological::Parameters MorphologicalEnvironment::as_built() const {
  const spec::morphological::Parameters run = faults_.as_built();
  return programs() ? unprogrammed(run) : run;
}

// ---- simulation ---------------------------------------------------------------------------------

void MorphologicalEnvironment::configure() {
  driver_.identify();
  if (programs()) driver_.set_configuration(faults_.as_built());
  if (setup_.weights) driver_.load_weights(stimuli::entries_of(*setup_.weights));
  checks_.clear_counters();
}

bool MorphologicalEnvironment::begin(std::size_t piece) {
  if (piece >= frames_.size()) return false;
  current_ = piece;
  const Image& image = frames_[piece].image;
  frame_ = Image(image.width, image.height);
  progress_.width = image.width;
  progress_.height = image.height;
  probes_.assign(frame_.pixels.size(), {});
  position_ = 0;
  checks_.begin(frames_[piece]);
  start();
  return true;
}

void MorphologicalEnvironment::start() {
  const Image& image = frames_[current_].image;
  if (in_memory()) driver_.place(setup_.pixel_base);
  driver_.set_size(image.width, image.height);
  if (source_) source_->start(frames_[current_]);
  if (maps_) maps_->begin(image.width, image.height);
  if (history_) history_->begin(image.width);
  taken_before_ = pixels.pops();
  ended_ = false;
}

void MorphologicalEnvironment::watch() {
  if (pixels.pops() == taken_before_ + 1) first_taken_ = pixels.last_pop();
  if (memory_) checks_.check_traffic(*memory_, simulation().clock().cycle());
}

void MorphologicalEnvironment::restart() {
  if (memory_) {
    // Earlier requests are still outstanding; they complete before the frame starts. A composition
    // starts frames itself and has waited during the reset.
    if (source_) drain_memory();
    memory_->clear_statistics();
  }
  position_ = 0;
  progress_.delivered = 0;
  checks_.restart();
  hash_ = {};
  start();
}

bool MorphologicalEnvironment::done() const {
  return (!source_ || source_->done()) && engine_.idle() && pixels.empty() && blended_.empty();
}

void MorphologicalEnvironment::end() {
  watch();
  checks_.end(simulation().clock().cycle(), current_);
  ended_ = true;
}

void MorphologicalEnvironment::finish() {
  checks_.finish(frames_, engine_.work(), blended_.last_push() + 1 - first_taken_, host_);
  checks_.check_figures(frames_, engine_, memory_.get());
}

void MorphologicalEnvironment::reject_memory_errors() {
  if (const std::uint32_t errors = driver_.memory_errors(); errors != 0)
    throw spec::SimulationError(
        fmt::format("memory answered {} lines with an error, which read as zero: look at "
                    "{}.error_address and at PIXEL_BASE",
                    errors, memory_name()));
}

void MorphologicalEnvironment::reject_unused_errors() const {
  if (memory_) reject_untouched(*memory_, setup_.memory);
}

Amount MorphologicalEnvironment::amount() const {
  std::uint64_t all = 0;
  for (const MorphologicalInput& frame : frames_) all += frame.image.pixels.size();
  return {progress_.delivered,
          engine_.sequencer.beats.value() * static_cast<std::uint64_t>(lanes()), all, "pixel"};
}

// ---- checking -----------------------------------------------------------------------------------

Environment::Boards MorphologicalEnvironment::outputs() const {
  Boards boards = {&checks_.pixels, &checks_.probes};
  if (setup_.descriptors) boards.insert(boards.end(), {&checks_.runs, &checks_.lines});
  return boards;
}

Environment::Boards MorphologicalEnvironment::traffic() const {
  return in_memory() ? Boards{&checks_.traffic} : Boards{};
}

void MorphologicalEnvironment::check_output(rtl::Cycle cycle,
                                            const spec::morphological::BlendedBeat& beat) {
  const auto width = static_cast<std::size_t>(frame_.width);
  const std::size_t x = position_ % width;
  const std::size_t left = position_ < frame_.pixels.size() ? width - x : 0;
  checks_.got_frame(cycle, position_, left, beat);
  for (std::size_t i = 0; i < std::min<std::size_t>(beat.count, spec::morphological::kMaxLanes);
       ++i) {
    const spec::morphological::Rgba8& p = beat.pixel[i];
    const spec::morphological::BlendProbe& t = beat.probe[i];
    const std::uint64_t word = std::uint64_t{p[0]} | std::uint64_t{p[1]} << 8 |
                               std::uint64_t{p[2]} << 16 | std::uint64_t{p[3]} << 24 |
                               std::uint64_t{t.first} << 32 | std::uint64_t{t.second} << 40 |
                               std::uint64_t{t.edges} << 48 | std::uint64_t{t.horizontal} << 56;
    hash_.add(word);
    checks_.got(p, t, cycle);
    if (position_ < frame_.pixels.size()) {
      frame_.pixels[position_] = p;
      probes_[position_] = t;
    }
    if (maps_) maps_->see(position_, t);
    if (history_)
      history_->see(position_, {p, t, beat.start_of_frame && i == 0,
                                beat.end_of_row && i + 1 == beat.count, cycle});
    ++position_;
    ++progress_.delivered;
  }
  // Resynchronise at the nearest row, so that a row of the wrong length does not affect later ones.
  if (beat.end_of_row && position_ % width != 0) {
    position_ = (position_ + width / 2) / width * width;
    checks_.resynchronise_at(position_);
  }
}

// ---- results ------------------------------------------------------------------------------------

std::optional<PixelHistory> MorphologicalEnvironment::pixel_history() const {
  if (!history_) return std::nullopt;
  PixelHistory all =
      history_->history(frames_[current_], ended_, golden() ? &golden_model() : nullptr);
  for (PixelStep& step : all.steps) step.part = name();
  return all;
}

std::vector<PictureMap> MorphologicalEnvironment::maps() const {
  return maps_ ? meter_.named(maps_->maps(engine_, frames_.size() == 1))
               : std::vector<PictureMap>();
}

// Defined here, because inlined copies can keep the compiler from optimising the units.
MorphologicalEnvironment::~MorphologicalEnvironment() = default;

}  // namespace deburr::tb
