// SPDX-License-Identifier: MIT
#include "tb/engines/morphological/morphological_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <tuple>

#include "golden/morphological/traffic.h"
#include "spec/morphological/registers.h"

namespace deburr::tb {
namespace {

using golden::morphological::DepthView;
using golden::morphological::ImageView;
using spec::morphological::FrameAccess;
using spec::morphological::LineDescriptor;
using spec::morphological::RunDescriptor;
namespace reg = spec::morphological::reg;

std::string describe_pixel(const spec::morphological::Rgba8& p) {
  return fmt::format("RGBA ({}, {}, {}, {})", p[0], p[1], p[2], p[3]);
}
std::string describe_probe(const spec::morphological::BlendProbe& t) {
  return fmt::format("{} weights {} {}, edges{}{}", t.horizontal ? "left/right" : "up/down",
                     t.first, t.second, t.edges & 1 ? " left" : "", t.edges & 2 ? " top" : "");
}
std::string describe_run(const RunDescriptor& r) {
  constexpr std::array<std::string_view, 3> kParts = {"", " head", " tail"};
  return fmt::format("{} run{} line {} start {} length {} {}",
                     r.axis == spec::morphological::Axis::kHorizontal ? "horizontal" : "vertical",
                     kParts[static_cast<std::size_t>(r.part)], r.line, r.start, r.length,
                     spec::morphological::kRunShapes[r.shape & 15].name);
}
std::string describe_line(const LineDescriptor& l) {
  return fmt::format("{}: steps {} {}, scale {} offset {} shift {} slope {} inverse {} span {}",
                     describe_run(l.run), l.left_steps, l.right_steps, l.scale, l.offset, l.shift,
                     l.slope, l.inverse, l.span);
}

// Any order that both sides can be sorted into.
auto order_of(const RunDescriptor& r) { return std::tuple(r.axis, r.line, r.start, r.part); }

}  // namespace

MorphologicalChecks::MorphologicalChecks(const MorphologicalSetup& setup, bool golden)
    : pixels("pixels", describe_pixel),
      probes("probes", describe_probe),
      runs("runs", 0, describe_run),
      lines("lines", 0, describe_line),
      traffic(
          "memory lines", 0,
          [](const FrameAccess& a) {
            return fmt::format("{} of address {:#x}", a.write ? "write" : "read", a.address);
          },
          [](const FrameAccess& a) { return a.write ? 1u : 0u; }),
      registers(spec::morphological::kRegisters),
      setup_(setup),
      used_(golden),
      golden_(setup.morphological) {
  if (setup.weights) golden_.set_weight_tables(*setup.weights);
  if (const auto range = error_range(setup.memory); range && in_memory())
    golden_.set_read_errors(
        [range = *range](std::uint32_t line) {
          return range.touches(line, spec::morphological::kFrameLineBytes);
        },
        setup.pixel_base);
}

void MorphologicalChecks::clear_counters() {
  work_ = {};
  iterations_ = {};
  unreadable_lines_ = 0;
}

void MorphologicalChecks::begin(const MorphologicalInput& frame) {
  frame_ = &frame;
  runs_.clear();
  lines_.clear();
  if (!used_) return;
  expect_traffic();
  const Image& image = frame.image;
  const DepthView depth =
      frame.depth.empty() ? DepthView() : DepthView(frame.depth, image.width, image.height);
  if (!setup_.expectation)
    golden_.process(ImageView(image.pixels, image.width, image.height), depth);
  pixels.expect(golden_model().pixels(), image.width);
  probes.expect(golden_model().probes(), image.width);
}

// Writes and reads are each in ascending order; their interleaving is a matter of timing.
void MorphologicalChecks::expect_traffic() {
  if (!in_memory()) return;
  for (const FrameAccess& access : golden::morphological::frame_traffic(
           setup_.pixel_base, frame_->image.width, frame_->image.height))
    traffic.expect(access);
}

void MorphologicalChecks::restart() {
  runs_.clear();
  lines_.clear();
  pixels.restart();
  probes.restart();
  traffic.restart();
  if (used_) expect_traffic();
}

void MorphologicalChecks::got_frame(rtl::Cycle cycle, std::size_t position, std::size_t left,
                                    const spec::morphological::BlendedBeat& beat) {
  const auto lanes = static_cast<std::size_t>(platform::lanes_of(setup_.morphological));
  const bool first = position == 0, last = beat.count == left;
  if (!used_ || (beat.count == std::min(left, lanes) && beat.start_of_frame == first &&
                 beat.end_of_row == last))
    return;
  // Select the pixel to report: the first one that the row lacks, or the last one, after which the
  // row should have ended. A row that ends in its first half counts as a repeated start of the row.
  const auto width = static_cast<std::size_t>(frame_->image.width);
  const bool missing_pixels =
      beat.end_of_row && beat.count < left && left - beat.count <= width / 2;
  const std::size_t wrong = missing_pixels             ? position + beat.count
                            : last && !beat.end_of_row ? position + left - 1
                                                       : position;
  pixels.complain(
      cycle, wrong, "frame",
      fmt::format("{} pixels at most, start of frame {}, end of row {}", left, first, last),
      fmt::format("{} pixels, start of frame {}, end of row {}", beat.count, beat.start_of_frame,
                  beat.end_of_row));
}

void MorphologicalChecks::resynchronise_at(std::size_t position) {
  pixels.go_on_at(position);
  probes.go_on_at(position);
}

void MorphologicalChecks::check_traffic(platform::MemoryModel& memory, rtl::Cycle cycle) {
  if (used_) {
    const auto check = [&](const std::vector<std::uint64_t>& moved, bool write) {
      for (const std::uint64_t line : moved)
        traffic.got({static_cast<std::uint32_t>(line), write}, cycle);
    };
    check(memory.lines_written(), true);
    check(memory.lines_read(), false);
  }
  memory.forget_lines();
}

void MorphologicalChecks::end(rtl::Cycle cycle, std::size_t frame) {
  if (!used_) return;
  for (const spec::morphological::WorkCount& each : spec::morphological::kWorkCounts)
    work_.*each.count += golden_model().work().*each.count;
  for (const golden::morphological::PredictedRun& run : golden_model().runs())
    iterations_[static_cast<std::size_t>(run.line.run.axis)] += run.iterations;
  unreadable_lines_ += golden_model().memory_errors();
  if (!setup_.descriptors) return;
  std::vector<RunDescriptor> all_runs;
  std::vector<LineDescriptor> all_lines;
  for (const golden::morphological::PredictedRun& run : golden_model().runs()) {
    all_runs.push_back(run.line.run);
    const spec::morphological::RunShape& shape =
        spec::morphological::kRunShapes[run.line.run.shape];
    if (run.line.learned || shape.before != spec::morphological::Side::kNone ||
        shape.after != spec::morphological::Side::kNone)
      all_lines.push_back(run.line);
  }
  const auto by_run = [](const RunDescriptor& a, const RunDescriptor& b) {
    return order_of(a) < order_of(b);
  };
  const auto by_line = [&](const LineDescriptor& a, const LineDescriptor& b) {
    return by_run(a.run, b.run);
  };
  for (auto* list : {&all_runs, &runs_}) std::sort(list->begin(), list->end(), by_run);
  for (auto* list : {&all_lines, &lines_}) std::sort(list->begin(), list->end(), by_line);
  for (const RunDescriptor& run : all_runs) runs.expect(run);
  for (const LineDescriptor& line : all_lines) lines.expect(line);
  // Frame order, which differs from the order in time.
  const std::string where = fmt::format("cycle {}, the end of frame {}", cycle, frame);
  for (const RunDescriptor& run : runs_) runs.got(run, where);
  for (const LineDescriptor& line : lines_) lines.got(line, where);
}

// Sets the minimum of comparisons from the frames; for runs and lines, which a frame may lack, from
// the engine's counters.
void MorphologicalChecks::require(std::span<const MorphologicalInput> frames,
                                  const spec::morphological::Work& work) {
  std::uint64_t area = 0, moved = 0;
  for (const MorphologicalInput& frame : frames) {
    area += frame.image.pixels.size();
    moved += golden::morphological::frame_stride(frame.image.width) /
             spec::morphological::kFrameLineBytes * static_cast<std::uint64_t>(frame.image.height);
  }
  pixels.require(area);
  probes.require(area);
  if (in_memory()) traffic.require(2 * moved);
  if (!setup_.descriptors) return;
  runs.require(work.horizontal_runs + work.vertical_runs);
  lines.require(work.z_runs);
}

void MorphologicalChecks::finish(std::span<const MorphologicalInput> frames,
                                 const spec::morphological::Work& work, std::uint64_t frame_cycles,
                                 platform::RegisterBus& bus) {
  if (!used_) return;
  require(frames, work);
  std::vector<std::pair<std::uint32_t, std::uint64_t>> expected;
  for (const spec::morphological::WorkCount& each : spec::morphological::kWorkCounts)
    expected.emplace_back(each.offset, work_.*each.count);
  expected.emplace_back(reg::kFrameCycles, frame_cycles);
  // An unreadable line also failed when it was written.
  expected.emplace_back(reg::kMemoryErrors, 2 * unreadable_lines_);
  registers.check(bus, expected);
}

void MorphologicalChecks::check_figures(std::span<const MorphologicalInput> frames,
                                        const rtl::morphological::MorphologicalEngine& engine,
                                        const platform::MemoryModel* memory) {
  if (!used_) return;
  std::uint64_t beats = 0;
  for (const MorphologicalInput& frame : frames)
    beats += platform::beats_a_row(frame.image.width, platform::lanes_of(setup_.morphological)) *
             static_cast<std::uint64_t>(frame.image.height);
  figures.check(engine, engine.sequencer.frames, frames.size());
  figures.check(engine, engine.sequencer.beats, beats);
  figures.check(engine, engine.endpoint_predictor_h.iterations, iterations_[0]);
  figures.check(engine, engine.endpoint_predictor_v.iterations, iterations_[1]);
  if (!memory) return;
  figures.check(engine, *engine.memory_port, *memory);
  figures.check(engine, engine.pixel_store.lines_read, memory->reads());
  figures.check(engine, engine.pixel_store.lines_written, memory->writes());
}

}  // namespace deburr::tb
