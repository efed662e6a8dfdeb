// SPDX-License-Identifier: MIT
#include "tool/engines/frame/frame_meter.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tb/env/collect.h"
#include "tb/run/amount.h"

namespace deburr::tool {

using tb::Figure;

FrameMeter::FrameMeter(const FrameParts& parts)
    : tb::Meter(""), parts_(parts), words_(parts.drawer.words()) {}

void FrameMeter::collect(tb::Result& result) const {
  parts_.environments.front()->collect(result);
  add(result, "frame_buffer", parts_.buffer);
  for (std::size_t i = 1; i < parts_.environments.size(); ++i)
    parts_.environments[i]->collect(result);
  parts_.drawing.collect(result);
  add(result, "frame_buffer_bytes_written", parts_.buffer.bytes_written);
  add(result, "frame_buffer_bytes_read", parts_.buffer.bytes_read);
  add(result, "frame_buffer_bytes", std::uint64_t{FrameBuffer::kPixelBytes} * pixels(), "byte",
      "Size of the frame buffer. It is not counted as a memory, and its accesses are not timed.");
}

void FrameMeter::show_parts(tb::Observer& observer) const {
  for (const tb::Environment* part : parts_.environments) part->show_parts(observer);
  observer.see("frame_buffer", parts_.buffer, tb::activity_keys(parts_.buffer));
  observer.see("frame_buffer_bytes_written", parts_.buffer.bytes_written);
  observer.see("frame_buffer_bytes_read", parts_.buffer.bytes_read);
}

FrameMeter::Cycles FrameMeter::cycles(const tb::Result& result,
                                      const FrameProgress& progress) const {
  const auto since_begin = [&](rtl::Cycle cycle) {
    return cycle - std::min(cycle, progress.begun);
  };
  const FrameBuffer& buffer = parts_.buffer;
  Cycles c;
  const int width = buffer.frame().width, height = buffer.frame().height;
  c.colours = since_begin(buffer.last_colour());
  c.colours_bound = parts_.drawing.cycles_bound();
  if (parts_.mesh) {
    c.drawing = progress.drawing_cycles;
    c.drawing_bound = parts_.mesh->cycles_bound(width, height);
  }
  if (parts_.rows) {
    c.smoothing = result.cycles - std::min(result.cycles, since_begin(buffer.first_beat()));
    c.smoothing_bound = parts_.rows->cycles_bound(width, height);
  }
  return c;
}

std::uint64_t FrameMeter::bound(const Cycles& c) const {
  return parts_.mesh ? c.colours_bound + c.drawing_bound + c.smoothing_bound
                     : std::max(c.colours_bound, c.smoothing_bound);
}

std::string FrameMeter::meaning_of_bound(const Cycles& c) const {
  if (parts_.mesh)
    return fmt::format(
        "Pixels of the frame divided by the cycles of the engines in sequence: {} {}, drawing "
        "edges {}{}.",
        words_.doing, tb::grouped(c.colours_bound), tb::grouped(c.drawing_bound),
        parts_.rows ? fmt::format(", smoothing {}", tb::grouped(c.smoothing_bound)) : "");
  return fmt::format(
      "Pixels of the frame divided by the cycles of the slower engine ({0}), since both run at the "
      "same time: {1} takes at least {2} cycles, smoothing {3}.",
      c.smoothing_bound >= c.colours_bound ? "smoothing" : words_.doing, words_.doing,
      tb::grouped(c.colours_bound), tb::grouped(c.smoothing_bound));
}

std::string FrameMeter::colours_key() const { return fmt::format("{}_cycles", words_.doing); }

void FrameMeter::collect_cycles(tb::Result& result, const Cycles& c) const {
  add(result, colours_key(), c.colours, "clk",
      fmt::format("From the first {} to the last colour.", words_.from));
  if (parts_.mesh)
    add(result, "drawing_cycles", c.drawing, "clk",
        fmt::format("Cycles from the last colour in the frame buffer until the {} is done.",
                    parts_.mesh_title));
  if (parts_.rows) {
    add(result, "smoothing_cycles", c.smoothing, "clk",
        "Cycles from the first row read from the frame buffer to the last pixel.");
    add(result, "smoothing_cycles_by_formula", c.smoothing_bound, "clk",
        fmt::format("Cycles of the {} without stalls.", parts_.rows_title));
  }
  if (!parts_.mesh)
    add(result, "overlapped_cycles", c.together() - std::min(c.together(), result.cycles), "clk",
        "Cycles in which both engines processed this frame.");
  add(result, parts_.mesh ? "engine_cycles_bound" : "slower_engine_cycles", bound(c), "clk",
      parts_.mesh ? "Cycles of all engines in sequence, without stalls."
                  : fmt::format("Cycles of the slower engine without stalls: {}, or "
                                "smoothing_cycles_by_formula.",
                                words_.bound_meaning));
}

void FrameMeter::collect_headline(tb::Result& result, const FrameProgress& progress) const {
  const Cycles c = cycles(result, progress);
  collect_cycles(result, c);
  const SmoothingStage& last = parts_.rows ? static_cast<const SmoothingStage&>(*parts_.rows)
                                           : static_cast<const SmoothingStage&>(*parts_.mesh);
  result.latency = last.latency();
  result.throughput =
      tb::ratio(parts_.rows ? parts_.rows->delivered_in_all() : pixels(), result.cycles);
  result.throughput_unit = "pixel/clk";
  result.throughput_bound = tb::ratio(pixels(), bound(c));
  result.throughput_bound_meaning = meaning_of_bound(c);
  result.figures = headline_figures(progress.complete);
  result.bottleneck = find_bottleneck(result.units, std::string(last.last_unit()));
}

std::vector<Figure> FrameMeter::headline_figures(bool complete) const {
  std::vector<Figure> figures;
  const auto append = [&](std::vector<Figure> more) {
    for (Figure& figure : more) figures.push_back(std::move(figure));
  };
  if (complete) {
    figures.push_back(
        parts_.mesh
            ? Figure{"Frame", "cycles", "engines alone", "work.engine_cycles_bound", true}
            : Figure{"Frame", "cycles", "slower engine", "work.slower_engine_cycles", true});
    figures.push_back({std::string(words_.label), "work." + colours_key(),
                       std::string(words_.bound_label), std::string(words_.bound_key)});
    if (parts_.mesh) figures.push_back({"Edges", "work.drawing_cycles"});
    if (parts_.rows)
      figures.push_back(
          {"Smoothing", "work.smoothing_cycles", "formula", "work.smoothing_cycles_by_formula"});
    if (!parts_.mesh) figures.push_back({"Both at once", "work.overlapped_cycles"});
  }
  append(parts_.drawing.figures());
  append({{"Frame buffer, not counted as a memory", "work.frame_buffer_bytes"},
          {"Written to the frame buffer", "work.frame_buffer_bytes_written"},
          {"Read from the frame buffer", "work.frame_buffer_bytes_read"}});
  for (const SmoothingStage* stage : parts_.smoothing) append(stage->work_figures());
  return figures;
}

}  // namespace deburr::tool
