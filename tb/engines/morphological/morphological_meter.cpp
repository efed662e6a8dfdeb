// SPDX-License-Identifier: MIT
#include "tb/engines/morphological/morphological_meter.h"

#include <algorithm>
#include <utility>

#include "tb/env/collect.h"

namespace deburr::tb {
namespace {

constexpr double kPixelClock1080p60 = 148.5;  // MHz

}  // namespace

std::uint64_t latency_by_formula(const spec::morphological::Parameters& p, int width) {
  const auto search_range = static_cast<std::uint64_t>(p.window_rows / 2 - 1);
  return (search_range + spec::morphological::kRowLag) *
             platform::beats_a_row(width, platform::lanes_of(p)) +
         spec::morphological::kPipelineLatency;
}

std::uint64_t frame_cycles_by_formula(const spec::morphological::Parameters& p, int width,
                                      int height) {
  return latency_by_formula(p, width) +
         static_cast<std::uint64_t>(height) * platform::beats_a_row(width, platform::lanes_of(p));
}

void MorphologicalMeter::collect(Result& result) const {
  const rtl::morphological::MorphologicalEngine& engine = engine_;
  add_parts(result, engine, progress_.width);
  if (progress_.memory) {
    add(result, *progress_.memory);
    result.lines_filled += progress_.memory->reads();
  }
  const spec::morphological::Work work = engine.work();
  add(result, "edge_pixels_percent", 100 * ratio(work.edge_pixels, work.pixels), "%",
      "Pixels with a left or a top edge.");
  add(result, "blended_pixels_percent", 100 * ratio(work.blended_pixels, work.pixels), "%",
      "Blended pixels: those with a blend weight above 0.");
  for (const auto* divider : {&engine.line_unit_h, &engine.line_unit_v}) {
    const double cycles =
        number(divider->busy_cycles() + divider->idle_cycles() + divider->stalled_cycles());
    add(result, name_within(engine, *divider) + "_occupancy_percent",
        100 * ratio(number(divider->occupancy.value()), lanes() * cycles), "%",
        "Occupancy: divisions x divider.interval / (cycles x lanes). These are the cycles in which "
        "a divider cannot start another division; at 100 % it is the limit. The unit is busy for "
        "longer, while a division is in progress.");
  }
  add_counters(result, engine);
}

void MorphologicalMeter::show_parts(Observer& observer, const rtl::LinkBase& in,
                                    const rtl::LinkBase& out) const {
  show(observer, "pixels_in", in);
  show(observer, engine_);
  show(observer, "pixels_out", out);
  observer.see(
      {"Pixels delivered", figure("blender_pixels"), "pixel/clk", static_cast<double>(lanes())});
}

std::vector<Figure> MorphologicalMeter::work_figures() const {
  constexpr const char* kOccupancy = "divisions x interval, of cycles x lanes";
  return {{"Divider occupancy, horizontal runs", key("line_unit_h_occupancy_percent"), kOccupancy},
          {"Divider occupancy, vertical runs", key("line_unit_v_occupancy_percent"), kOccupancy},
          {"Pixels on edges", key("edge_pixels_percent")},
          {"Pixels blended", key("blended_pixels_percent")}};
}

void MorphologicalMeter::collect_headline(Result& result, double clock_mhz) const {
  result.latency = latency_of(engine_.beat_latency);

  result.throughput = ratio(number(progress_.delivered), number(result.cycles));
  result.throughput_unit = "pixel/clk";
  result.throughput_bound = lanes();
  result.throughput_bound_meaning =
      "One beat per cycle, one pixel per lane; filling and flushing the window not counted.";

  collect_cycles(result, clock_mhz);
  result.figures = headline_figures();
  result.bottleneck = find_bottleneck(result.units, figure("blender"));
}

void MorphologicalMeter::collect_cycles(Result& result, double clock_mhz) const {
  const spec::morphological::Parameters& p = setup_.morphological;
  const int width = std::max(1, progress_.width), height = std::max(1, progress_.height);
  const std::uint64_t frame_cycles = engine_.sequencer.frame_cycles.value();
  const std::uint64_t by_formula = frame_cycles_by_formula(p, width, height);
  add(result, "frame_cycles", frame_cycles, "clk",
      "Cycles of the last frame, from its first input beat to its last output beat.");
  add(result, "frame_cycles_by_formula", by_formula, "clk", "The same without stalls, by formula.");
  add(result, "latency_by_formula", latency_by_formula(p, width), "clk",
      "Latency of a pixel without stalls: (R + 5) rows and the pipeline stages.");
  add(result, "input_pixels_per_cycle",
      progress_.source->done()
          ? ratio(number(static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height)),
                  number(progress_.input_cycles()))
          : 0.0,
      "pixel/clk", "Pixels of the last frame per cycle, from its first to its last input beat.");
  add(result, "memory_bytes_per_pixel",
      ratio(number(result.bytes_read + result.bytes_written), number(progress_.delivered)),
      "byte/pixel", "Pixel bytes written and read again; 0 with line buffers.");
  add(result, "frame_rate", frame_cycles ? clock_mhz * 1e6 / number(frame_cycles) : 0.0, "frame/s",
      "Frames of this size per second at the given clock frequency.");
  // Scales the formula by this frame's slowdown, if it was slower than the formula; unknown before
  // the first frame is complete.
  const double slowness = std::max(1.0, ratio(number(frame_cycles), number(by_formula)));
  const double hd = slowness * clock_for_60(frame_cycles_by_formula(p, 1920, 1080));
  add(result, "clock_for_1080p60", frame_cycles ? WorkValue(hd) : WorkValue(), "MHz",
      "Clock frequency for 60 frames of 1920 x 1080 per second, with stalls scaled from this run.");
  add(result, "pixel_clock_of_1080p60", kPixelClock1080p60, "MHz",
      "Pixel clock of 1080p60, including blanking.");
  add(result, "fits_1080p60", frame_cycles ? WorkValue(hd <= kPixelClock1080p60) : WorkValue(), "",
      "Whether clock_for_1080p60 is at most the pixel clock of 1080p60, 148.5 MHz.");
}

std::vector<Figure> MorphologicalMeter::headline_figures() const {
  const std::uint64_t frame_cycles = engine_.sequencer.frame_cycles.value();
  std::vector<Figure> figures;
  if (frame_cycles)
    figures = {{"Frame", "work.frame_cycles", "formula", "work.frame_cycles_by_formula", true},
               {"Clock for 1080p60", "work.clock_for_1080p60", "pixel clock",
                "work.pixel_clock_of_1080p60", true},
               {"Fits 1080p60", "work.fits_1080p60"},
               {"Frames of this size", "work.frame_rate"}};
  if (engine_.beat_latency.count() > 0)
    figures.push_back(
        {"Latency of a pixel", "latency.max", "formula", "work.latency_by_formula", true});
  if (progress_.source->done() && frame_cycles)
    figures.push_back({"Input rate", "work.input_pixels_per_cycle", "lanes", "throughput.bound"});
  if (progress_.memory)
    figures.push_back({"Memory traffic", "work.memory_bytes_per_pixel", "", "", true});
  for (Figure& figure : work_figures()) figures.push_back(std::move(figure));
  return figures;
}

}  // namespace deburr::tb
