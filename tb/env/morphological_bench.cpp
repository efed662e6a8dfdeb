// SPDX-License-Identifier: MIT
#include "tb/env/morphological_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <tuple>
#include <utility>

#include "golden/morphological/configuration.h"
#include "golden/morphological/traffic.h"
#include "spec/error.h"
#include "tb/env/collect.h"
#include "tb/results/progress.h"

namespace deburr::tb {
namespace {

using golden::morphological::DepthView;
using golden::morphological::frame_stride;
using golden::morphological::ImageView;
using golden::morphological::MorphologicalGolden;
namespace reg = spec::morphological::reg;

constexpr rtl::Cycle kProgressPeriod = 4096;
constexpr std::uint64_t kFaultyRequest = 20;
constexpr double kPixelClock1080p60 = 148.5;  // MHz

constexpr std::array kFaults = {
    MorphologicalFault{"flip-bit", "Flips a bit of the red channel of output beat 100."},
    MorphologicalFault{"drop-pixel", "Drops output beat 100."},
    MorphologicalFault{"duplicate-pixel", "Delivers output beat 100 twice."},
    MorphologicalFault{"drop-input", "Drops input beat 50 on its way into the engine."},
    MorphologicalFault{"wrong-edge",
                       "Flips the left edge of a pixel in row 1, behind the edge detector."},
    MorphologicalFault{"wrong-rule", "The engine tries one step less than was ordered."},
    MorphologicalFault{"stuck-ready", "Holds back the slots of the luma unit from cycle 500 on."},
    MorphologicalFault{"duplicate-fetch", "Sends memory request 20 twice (storage = memory)."},
    MorphologicalFault{"lost-response", "Memory never answers request 20 (storage = memory)."},
    MorphologicalFault{"memory-error",
                       "Memory answers request 20 with an error (storage = memory)."}};

bool planted(const MorphologicalBenchOptions& options, std::string_view fault) {
  return std::find(options.faults.begin(), options.faults.end(), fault) != options.faults.end();
}

int lanes_of(const spec::morphological::Parameters& p) {
  return spec::morphological::kLaneCount[static_cast<std::size_t>(p.lanes)];
}

// What the hardware is built with; the golden model always gets what was ordered.
spec::morphological::Parameters hardware_parameters(const MorphologicalBenchOptions& options) {
  spec::morphological::Parameters p = options.morphological;
  if (planted(options, "wrong-rule")) p.steps = std::max(0, p.steps - 1);
  return p;
}

// The faults of links that the names stand for, for frames of this width.
std::vector<std::string> link_faults(const MorphologicalBenchOptions& options, int width) {
  constexpr int kLeftEdgeBit = 64;  // of an EdgeToken: behind its slot
  const bool memory = options.morphological.storage == spec::morphological::Storage::kMemory;
  const std::uint64_t row = beats_a_row(width, lanes_of(options.morphological));
  std::vector<std::string> faults;
  for (const std::string& name : options.faults) {
    if (name.find(':') != std::string::npos) {
      faults.push_back(name);
      continue;
    }
    const auto found = std::find_if(kFaults.begin(), kFaults.end(),
                                    [&](const MorphologicalFault& f) { return f.name == name; });
    if (found == kFaults.end()) {
      std::string known;
      for (const MorphologicalFault& f : kFaults) known += fmt::format(" {}", f.name);
      throw spec::ConfigError(fmt::format(
          "no fault '{}': known are{}, and LINK faults such as drop:blended:100", name, known));
    }
    if (!memory && found->meaning.find("storage = memory") != std::string_view::npos)
      throw spec::ConfigError(fmt::format("fault '{}' needs morphological.storage = memory", name));
    if (name == "flip-bit") faults.emplace_back("flip:blended:100:4");
    if (name == "drop-pixel") faults.emplace_back("drop:blended:100");
    if (name == "duplicate-pixel") faults.emplace_back("duplicate:blended:100");
    if (name == "drop-input") faults.emplace_back("drop:pixels:50");
    if (name == "wrong-edge")
      faults.push_back(
          fmt::format("flip:morphological.edge_bits:{}:{}", 2 * row + row / 2, kLeftEdgeBit));
    if (name == "stuck-ready") faults.emplace_back("stuck_ready:morphological.slots:500");
    if (name == "duplicate-fetch")
      faults.push_back(fmt::format("duplicate:morphological.requests:{}", kFaultyRequest));
  }
  return faults;
}

std::uint64_t memory_bytes(std::span<const MorphologicalInput> frames, std::uint32_t base) {
  std::uint64_t bytes = 0;
  for (const MorphologicalInput& frame : frames)
    bytes = std::max(bytes, std::uint64_t{frame_stride(frame.image.width)} *
                                static_cast<std::uint64_t>(frame.image.height));
  return base + bytes;
}

std::string_view register_name(std::uint32_t offset) {
  for (const spec::RegisterInfo& info : spec::morphological::kRegisters)
    if (info.offset == offset) return info.name;
  return "?";
}

std::string describe_pixel(const spec::morphological::Rgba8& p) {
  return fmt::format("RGBA ({}, {}, {}, {})", p[0], p[1], p[2], p[3]);
}
std::string describe_tap(const spec::morphological::BlendTap& t) {
  return fmt::format("{} shares {} {}, edges{}{}", t.horizontal ? "left/right" : "up/down", t.first,
                     t.second, t.edges & 1 ? " left" : "", t.edges & 2 ? " top" : "");
}
std::string describe_run(const spec::morphological::RunRecord& r) {
  constexpr std::array<std::string_view, 3> kParts = {"", " head", " tail"};
  return fmt::format("{} run{} line {} start {} length {} {}",
                     r.axis == spec::morphological::Axis::kHorizontal ? "horizontal" : "vertical",
                     kParts[static_cast<std::size_t>(r.part)], r.line, r.start, r.length,
                     spec::morphological::kRunShapes[r.shape & 15].name);
}
std::string describe_line(const spec::morphological::LineRecord& l) {
  return fmt::format("{}: steps {} {}, scale {} offset {} shift {} slope {} inverse {} span {}",
                     describe_run(l.run), l.left_steps, l.right_steps, l.scale, l.offset, l.shift,
                     l.slope, l.inverse, l.span);
}

// Any order that both sides can be brought into.
auto order_of(const spec::morphological::RunRecord& r) {
  return std::tuple(r.axis, r.line, r.start, r.part);
}

double ratio(double a, double b) { return b > 0 ? a / b : 0.0; }
double number(std::uint64_t value) { return static_cast<double>(value); }

// Clocks of 1/60 s that a frame may take, in MHz.
double clock_for_60(std::uint64_t frame_clocks) { return number(frame_clocks) * 60 / 1e6; }

}  // namespace

std::span<const MorphologicalFault> morphological_faults() { return kFaults; }

std::uint64_t latency_by_formula(const spec::morphological::Parameters& p, int width) {
  const auto reach = static_cast<std::uint64_t>(p.window_rows / 2 - 1);
  return (reach + spec::morphological::kRowLag) * beats_a_row(width, lanes_of(p)) +
         spec::morphological::kPipelineLatency;
}

std::uint64_t frame_clocks_by_formula(const spec::morphological::Parameters& p, int width,
                                      int height) {
  return latency_by_formula(p, width) +
         static_cast<std::uint64_t>(height) * beats_a_row(width, lanes_of(p));
}

void collect_morphological(rtl::morphological::MorphologicalEngine& engine, int width,
                           const std::string& prefix, Result& result) {
  const auto add = [&](const std::string& name, nlohmann::ordered_json value, std::string unit,
                       std::string meaning) {
    result.work.push_back({prefix + name, std::move(value), std::move(unit), std::move(meaning)});
  };
  for (const rtl::Unit* unit : engine.units())
    result.units.push_back(unit_cycles(prefix + name_within(engine, *unit), *unit));
  for (const rtl::MemoryBase* memory : engine.memories())
    result.sram.push_back({prefix + name_within(engine, *memory), memory->ports(), memory->bits(),
                           memory->bits_at(static_cast<std::uint64_t>(width))});
  const spec::morphological::Work work = engine.work();
  add("edge_pixels_percent", 100 * ratio(number(work.edge_pixels), number(work.pixels)), "%",
      "Pixels with a left or a top edge.");
  add("blended_pixels_percent", 100 * ratio(number(work.blended_pixels), number(work.pixels)), "%",
      "Pixels that took a share of a neighbour.");
  for (const auto* divider : {&engine.divider_h, &engine.divider_v}) {
    const double clocks =
        number(divider->busy_cycles() + divider->idle_cycles() + divider->stalled_cycles());
    const double lanes = lanes_of(engine.parameters());
    add(name_within(engine, *divider) + "_occupancy_percent",
        100 * ratio(number(divider->occupancy.value()), lanes * clocks), "%",
        "Occupancy: divisions x divider.interval over clocks x lanes, the clocks in which a "
        "divider could not start another; at 100 % it is the limit. The unit is busy for longer, "
        "while a division is under way.");
  }
  const auto figure = [&](const char* label, const char* name, const char* remark = "") {
    result.figures.push_back({label, "work." + prefix + name, remark});
  };
  constexpr const char* kOccupancy = "divisions x interval, of clocks x lanes";
  figure("Divider occupancy, horizontal runs", "divider_h_occupancy_percent", kOccupancy);
  figure("Divider occupancy, vertical runs", "divider_v_occupancy_percent", kOccupancy);
  figure("Pixels on edges", "edge_pixels_percent");
  figure("Pixels blended", "blended_pixels_percent");
  for (const rtl::Counter* counter : engine.counters())
    add(name_within(engine, *counter), counter->value(), counter->unit(),
        sentence(counter->meaning()));
}

// ---- building -----------------------------------------------------------------------------------

MorphologicalBench::MorphologicalBench(std::span<const MorphologicalInput> frames,
                                       const MorphologicalBenchOptions& options)
    : frames_(frames),
      options_(options),
      clock_("clock", clock_period(options.clock_mhz)),
      source_("source", clock_, lanes_of(options.morphological)),
      engine_("morphological", clock_, hardware_parameters(options)),
      sink_("sink", clock_),
      host_("host"),
      golden_(options.morphological),
      pixel_board_("pixels", describe_pixel),
      tap_board_("taps", describe_tap),
      run_board_("runs", 0, describe_run),
      line_board_("lines", 0, describe_line),
      traffic_board_("memory lines", 0,
                     [](const spec::morphological::FrameAccess& a) {
                       return fmt::format("{} of address {:#x}", a.write ? "write" : "read",
                                          a.address);
                     }),
      register_board_("status registers", 0, [](const Status& s) {
        return fmt::format("{} = {}", register_name(s.offset), s.value);
      }) {
  for (const MorphologicalInput& frame : frames)
    golden::morphological::check_frame(options.morphological, frame.image.width,
                                       frame.image.height);
  const std::vector<std::string> faults =
      link_faults(options, frames.empty() ? 1 : frames.front().image.width);
  source_.pixels_out(pixels_link_);
  engine_.pixels_in(pixels_link_);
  engine_.pixels_out(blended_);
  sink_.beats_in(blended_);
  host_.bus.bind(engine_.registers);
  if (engine_.memory() != nullptr) {
    MemoryModelParameters m = memory_model_parameters(
        options.memory, memory_bytes(frames, options.pixel_base), options.seed);
    m.record_writes = true;
    memory_ = std::make_unique<MemoryModel>("memory", clock_.period(), m);
    engine_.memory()->bind(memory_->ports);
    plant_memory_faults();
  }

  BenchOptions bench = bench_options(options, faults);
  bench.at_limit = [this] {
    std::uint64_t pixels = 0;
    for (const MorphologicalInput& frame : frames_) pixels += frame.image.pixels.size();
    return out_of_cycles(options_.max_cycles, pixels_, pixels, "pixel");
  };
  bench_ = std::make_unique<Bench>(clock_, bench);

  sink_.keep(false);
  sink_.on_beat = [this](rtl::Cycle cycle, const spec::morphological::BlendedBeat& beat) {
    judge(cycle, beat);
  };
  if (options.golden && options.records) {
    engine_.observe_runs(
        [this](const spec::morphological::RunRecord& run) { runs_.push_back(run); });
    engine_.observe_lines(
        [this](const spec::morphological::LineRecord& line) { lines_.push_back(line); });
  }
}

// The wave is closed before anything that it shows is gone.
MorphologicalBench::~MorphologicalBench() { bench_.reset(); }

int MorphologicalBench::lanes() const { return lanes_of(options_.morphological); }

void MorphologicalBench::plant_memory_faults() {
  if (planted(options_, "lost-response")) memory_->lose_request(kFaultyRequest);
  if (planted(options_, "memory-error")) memory_->fail_request(kFaultyRequest);
  if (options_.memory.error_address < 0) return;
  const auto from = static_cast<std::uint64_t>(options_.memory.error_address);
  const std::uint64_t to = from + static_cast<std::uint64_t>(options_.memory.error_bytes);
  memory_->fail_range(from, to);
  golden_.set_read_errors(
      [from, to](std::uint32_t line) {
        return line < to && std::uint64_t{line} + spec::morphological::kFrameLineBytes > from;
      },
      options_.pixel_base);
}

// ---- running ------------------------------------------------------------------------------------

void MorphologicalBench::reset() {
  constexpr rtl::Cycle kResetCycles = 4;
  clock_.set_reset_n(false);
  clock_.run(kResetCycles);
  clock_.set_reset_n(true);
  golden_work_ = {};
}

void MorphologicalBench::run(const Progress& progress) {
  reset();
  if (const std::uint32_t id = host_.read(reg::kId); id != reg::kIdValue)
    throw spec::SimulationError(
        fmt::format("the ID register reads {:#x}, expected {:#x}", id, reg::kIdValue));
  for (std::size_t i = 0; i < frames_.size() && !stopped_; ++i)
    run_frame(frames_[i], i == 0 && options_.reset_after > 0, progress);
  if (stopped_) return;
  judge_registers();
  complete_ = true;
  if (const std::uint32_t errors = host_.read(reg::kMemoryErrors); errors != 0)
    throw spec::SimulationError(
        fmt::format("memory answered {} lines with an error, which read as zero: look at "
                    "memory.error_address and at PIXEL_BASE",
                    errors));
}

void MorphologicalBench::expect(const MorphologicalInput& frame) {
  const Image& image = frame.image;
  frame_ = Image(image.width, image.height);
  taps_.assign(frame_.pixels.size(), {});
  position_ = 0;
  runs_.clear();
  lines_.clear();
  if (!options_.golden) return;
  const DepthView depth =
      frame.depth.empty() ? DepthView() : DepthView(frame.depth, image.width, image.height);
  golden_.process(ImageView(image.pixels, image.width, image.height), depth);
  pixel_board_.expect(golden_.pixels(), image.width);
  tap_board_.expect(golden_.taps(), image.width);
}

void MorphologicalBench::run_frame(const MorphologicalInput& frame, bool reset_within,
                                   const Progress& progress) {
  expect(frame);
  const auto begin_frame = [&] {
    host_.write(reg::kSize, static_cast<std::uint32_t>(frame.image.width) |
                                static_cast<std::uint32_t>(frame.image.height) << 16);
    if (in_memory()) host_.write(reg::kPixelBase, options_.pixel_base);
    source_.start(frame);
  };
  const rtl::Cycle limit = options_.cycle_limit();
  const rtl::Cycle reset_at = clock_.cycle() + options_.reset_after;
  bool reset_due = reset_within;
  const auto done = [&] {
    if (progress && clock_.cycle() >= next_progress_) {
      next_progress_ = clock_.cycle() + kProgressPeriod;
      if (!progress(pixels_, engine_.sequencer.beats.value() * static_cast<std::uint64_t>(lanes())))
        return stopped_ = true;
    }
    if (reset_due && clock_.cycle() >= reset_at) return true;
    return source_.done() && engine_.idle() && pixels_link_.empty() && blended_.empty();
  };

  begin_frame();
  started_ = clock_.cycle();
  running_ = true;
  const rtl::Cycle before = cycles_;
  const auto begin = std::chrono::steady_clock::now();
  const std::clock_t cpu_begin = std::clock();
  const auto stop_clock = [&] {
    host_seconds_ +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    cpu_seconds_ += static_cast<double>(std::clock() - cpu_begin) / CLOCKS_PER_SEC;
    cycles_ = before + clock_.cycle() - started_;
    running_ = false;
  };
  try {
    bench_->run(done, std::max(limit, cycles_) - cycles_, false);
    if (reset_due && clock_.cycle() >= reset_at) {
      reset_due = false;
      // What was asked of memory before is still on its way; it goes by before the frame begins.
      reset();
      if (in_memory()) {
        clock_.run(static_cast<rtl::Cycle>(
            2 * std::max(options_.memory.latency, options_.memory.latency_max) + 100));
        memory_->clear_statistics();
      }
      position_ = 0;
      runs_.clear();
      lines_.clear();
      pixels_ = 0;
      pixel_board_.restart();
      tap_board_.restart();
      hash_ = 0xCBF29CE484222325ULL;
      begin_frame();
      started_ = clock_.cycle();
      bench_->run(done, limit, false);
    }
  } catch (...) {
    stop_clock();
    throw;
  }
  stop_clock();
  if (stopped_) return;
  if (bench_->links()) bench_->links()->check_empty();
  ++frames_done_;
  judge_records();
  judge_traffic();
}

// ---- judging ------------------------------------------------------------------------------------

void MorphologicalBench::judge(rtl::Cycle cycle, const spec::morphological::BlendedBeat& beat) {
  constexpr std::uint64_t kPrime = 0x100000001B3ULL;  // FNV-1a
  const auto width = static_cast<std::size_t>(frame_.width);
  const std::size_t x = position_ % width;
  const std::size_t left = position_ < frame_.pixels.size() ? width - x : 0;
  const bool framed =
      beat.count == std::min<std::size_t>(left, static_cast<std::size_t>(lanes())) &&
      beat.start_of_frame == (position_ == 0) && beat.end_of_row == (beat.count == left);
  if (options_.golden && !framed)
    pixel_board_.complain(fmt::format(
        "cycle {}: pixel ({}, {}): the beat has {} pixels, start of frame {}, end of row {}", cycle,
        x, position_ / width, beat.count, beat.start_of_frame, beat.end_of_row));
  for (std::size_t i = 0; i < std::min<std::size_t>(beat.count, spec::morphological::kMaxLanes);
       ++i) {
    const spec::morphological::Rgba8& p = beat.pixel[i];
    const spec::morphological::BlendTap& t = beat.tap[i];
    const std::uint64_t word = std::uint64_t{p[0]} | std::uint64_t{p[1]} << 8 |
                               std::uint64_t{p[2]} << 16 | std::uint64_t{p[3]} << 24 |
                               std::uint64_t{t.first} << 32 | std::uint64_t{t.second} << 40 |
                               std::uint64_t{t.edges} << 48 | std::uint64_t{t.horizontal} << 56;
    hash_ = (hash_ ^ word) * kPrime;
    hash_ ^= hash_ >> 29;
    if (options_.golden) {
      pixel_board_.got(p, cycle);
      tap_board_.got(t, cycle);
    }
    if (position_ < frame_.pixels.size()) {
      frame_.pixels[position_] = p;
      taps_[position_] = t;
    }
    ++position_;
    ++pixels_;
  }
}

void MorphologicalBench::judge_records() {
  if (!options_.golden) return;
  const spec::morphological::Work& w = golden_.work();
  const auto sum = [](std::uint64_t& total, std::uint64_t frame) { total += frame; };
  sum(golden_work_.pixels, w.pixels);
  sum(golden_work_.edge_pixels, w.edge_pixels);
  sum(golden_work_.horizontal_runs, w.horizontal_runs);
  sum(golden_work_.vertical_runs, w.vertical_runs);
  sum(golden_work_.long_runs, w.long_runs);
  sum(golden_work_.z_runs, w.z_runs);
  sum(golden_work_.extended_runs, w.extended_runs);
  sum(golden_work_.steps, w.steps);
  sum(golden_work_.probes, w.probes);
  sum(golden_work_.divides, w.divides);
  sum(golden_work_.blended_pixels, w.blended_pixels);
  if (!options_.records) return;
  std::vector<spec::morphological::RunRecord> runs;
  std::vector<spec::morphological::LineRecord> lines;
  for (const golden::morphological::PredictedRun& run : golden_.runs()) {
    runs.push_back(run.line.run);
    const spec::morphological::RunShape& shape =
        spec::morphological::kRunShapes[run.line.run.shape];
    if (shape.before != spec::morphological::Side::kNone ||
        shape.after != spec::morphological::Side::kNone)
      lines.push_back(run.line);
  }
  const auto by_run = [](const spec::morphological::RunRecord& a,
                         const spec::morphological::RunRecord& b) {
    return order_of(a) < order_of(b);
  };
  const auto by_line = [&](const spec::morphological::LineRecord& a,
                           const spec::morphological::LineRecord& b) {
    return by_run(a.run, b.run);
  };
  for (auto* list : {&runs, &runs_}) std::sort(list->begin(), list->end(), by_run);
  for (auto* list : {&lines, &lines_}) std::sort(list->begin(), list->end(), by_line);
  for (const spec::morphological::RunRecord& run : runs) run_board_.expect(run);
  for (const spec::morphological::LineRecord& line : lines) line_board_.expect(line);
  const std::string where = fmt::format("frame {}", frames_done_ - 1);
  for (const spec::morphological::RunRecord& run : runs_) run_board_.got(run, where);
  for (const spec::morphological::LineRecord& line : lines_) line_board_.got(line, where);
}

// All writes ascending, all reads ascending; how they interleave is timing.
void MorphologicalBench::judge_traffic() {
  if (!options_.golden || !in_memory()) return;
  for (const spec::morphological::FrameAccess& access : golden_.traffic(options_.pixel_base))
    traffic_board_.expect(access);
  const std::string where = fmt::format("frame {}", frames_done_ - 1);
  const auto judge_lines = [&](const std::vector<std::uint64_t>& lines, std::size_t& judged,
                               bool write) {
    for (; judged < lines.size(); ++judged)
      traffic_board_.got({static_cast<std::uint32_t>(lines[judged]), write}, where);
  };
  judge_lines(memory_->lines_written(), writes_judged_, true);
  judge_lines(memory_->lines_read(), reads_judged_, false);
}

// The engine's own counters, read as a driver would, against the golden model's.
void MorphologicalBench::judge_registers() {
  if (!options_.golden) return;
  const spec::morphological::Work& w = golden_work_;
  const std::pair<std::uint32_t, std::uint64_t> expected[] = {
      {reg::kPixels, w.pixels},
      {reg::kEdgePixels, w.edge_pixels},
      {reg::kHorizontalRuns, w.horizontal_runs},
      {reg::kVerticalRuns, w.vertical_runs},
      {reg::kLongRuns, w.long_runs},
      {reg::kZRuns, w.z_runs},
      {reg::kExtendedRuns, w.extended_runs},
      {reg::kSteps, w.steps},
      {reg::kProbes, w.probes},
      {reg::kDivides, w.divides},
      {reg::kBlendedPixels, w.blended_pixels}};
  for (const auto& [offset, value] : expected) {
    register_board_.expect({offset, static_cast<std::uint32_t>(value)});
    register_board_.got({offset, host_.read(offset)}, std::string(register_name(offset)));
  }
}

void MorphologicalBench::check() const {
  if (!options_.golden) return;
  pixel_board_.check();
  tap_board_.check();
  run_board_.check();
  line_board_.check();
  traffic_board_.check();
  register_board_.check();
}

// ---- results ------------------------------------------------------------------------------------

void MorphologicalBench::collect(Result& result) const {
  auto& engine = const_cast<rtl::morphological::MorphologicalEngine&>(engine_);
  const spec::morphological::Parameters& p = options_.morphological;
  result.cycles = running_ ? cycles_ + clock_.cycle() - started_ : cycles_;
  result.host_seconds = host_seconds_;
  result.host_cpu_seconds = cpu_seconds_;
  const ScoreboardBase* boards[] = {&pixel_board_, &tap_board_, &run_board_, &line_board_,
                                    &register_board_};
  result.comparisons = result.mismatches = 0;
  for (const ScoreboardBase* board : boards) {
    result.comparisons += board->comparisons();
    result.mismatches += board->mismatches() + (complete_ ? board->leftovers() : 0);
  }
  result.traffic_comparisons = traffic_board_.comparisons();
  result.traffic_mismatches =
      traffic_board_.mismatches() + (complete_ ? traffic_board_.leftovers() : 0);
  if (memory_) {
    result.bytes_read = memory_->bytes_read();
    result.bytes_written = memory_->bytes_written();
    result.lines_filled = memory_->reads();
  }

  result.latency = latency_of(engine.beat_latency);

  result.throughput = ratio(number(pixels_), number(result.cycles));
  result.throughput_unit = "pixel/clk";
  result.throughput_bound = lanes();
  result.throughput_bound_meaning =
      "A beat a clock, a pixel a lane; filling and flushing the window not counted.";

  const auto add = [&](std::string name, nlohmann::ordered_json value, std::string unit,
                       std::string meaning) {
    result.work.push_back({std::move(name), std::move(value), std::move(unit), std::move(meaning)});
  };
  const int width = std::max(1, frame_.width), height = std::max(1, frame_.height);
  const std::uint64_t frame_clocks = engine.sequencer.frame_cycles.value();
  const std::uint64_t by_formula = frame_clocks_by_formula(p, width, height);
  add("frame_clocks", frame_clocks, "clk",
      "Of the last frame, from its first input beat to its last output beat.");
  add("frame_clocks_by_formula", by_formula, "clk", "The same if nothing stalls.");
  add("latency_by_formula", latency_by_formula(p, width), "clk",
      "From a pixel going in to it coming out if nothing stalls: (R + 5) rows and the clocks of "
      "the pipe.");
  add("input_pixels_per_clock",
      source_.done()
          ? ratio(number(static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height)),
                  number(input_clocks()))
          : 0.0,
      "pixel/clk", "Pixels of the last frame over clocks from its first to its last input beat.");
  add("memory_bytes_per_pixel",
      ratio(number(result.bytes_read + result.bytes_written), number(pixels_)), "byte/pixel",
      "Written and read again; 0 with line buffers.");
  add("frame_rate", frame_clocks ? options_.clock_mhz * 1e6 / number(frame_clocks) : 0.0, "frame/s",
      "Frames of this size a second at the stated clock.");
  // As slow for its clocks as this frame was, if that was slower than the formula; unknown before
  // the first frame is through.
  const double slowness = std::max(1.0, ratio(number(frame_clocks), number(by_formula)));
  const double hd = slowness * clock_for_60(frame_clocks_by_formula(p, 1920, 1080));
  using Json = nlohmann::ordered_json;
  add("clock_for_1080p60", frame_clocks ? Json(hd) : Json(), "MHz",
      "Clock that 60 frames of 1920 x 1080 need, stalls of this run in proportion.");
  add("pixel_clock_of_1080p60", kPixelClock1080p60, "MHz", "Of the standard, blanking included.");
  add("fits_1080p60", frame_clocks ? Json(hd <= kPixelClock1080p60) : Json(), "",
      "Whether clock_for_1080p60 is at most the pixel clock of 1080p60, 148.5 MHz.");

  result.figures.clear();
  if (frame_clocks)
    result.figures = {
        {"Frame", "work.frame_clocks", "formula", "work.frame_clocks_by_formula", true},
        {"Clock for 1080p60", "work.clock_for_1080p60", "pixel clock",
         "work.pixel_clock_of_1080p60", true},
        {"Fits 1080p60", "work.fits_1080p60"},
        {"Frames of this size", "work.frame_rate"}};
  if (engine.beat_latency.count() > 0)
    result.figures.push_back(
        {"Latency of a pixel", "latency.max", "formula", "work.latency_by_formula", true});
  if (source_.done() && frame_clocks)
    result.figures.push_back(
        {"Input rate", "work.input_pixels_per_clock", "lanes", "throughput.bound"});
  if (memory_)
    result.figures.push_back({"Memory traffic", "work.memory_bytes_per_pixel", "", "", true});
  collect_morphological(engine, width, "", result);
  result.bottleneck = find_bottleneck(result.units, "blender");
}

}  // namespace deburr::tb
