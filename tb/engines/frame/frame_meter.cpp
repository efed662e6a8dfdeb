// SPDX-License-Identifier: MIT
#include "tb/engines/frame/frame_meter.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tb/env/collect.h"
#include "tb/results/report.h"

namespace deburr::tb {

FrameMeter::FrameMeter(const FrameParts& parts) : Meter(""), parts_(parts) {}

void FrameMeter::collect(Result& result) const {
  parts_.texture.collect(result);
  add(result, "frame_buffer", parts_.buffer);
  if (parts_.geometric) parts_.geometric->collect(result);
  if (parts_.morphological) parts_.morphological->collect(result);
  const rtl::Histogram& latency = parts_.texture.unit().fragment_latency;
  add(result, "texture_fragment_latency_p50", latency.percentile(50), "clk",
      "Of the texture unit.");
  add(result, "texture_fragment_latency_max", latency.max(), "clk", "Of the texture unit.");
  add(result, "frame_buffer_bytes_written", parts_.buffer.bytes_written);
  add(result, "frame_buffer_bytes_read", parts_.buffer.bytes_read);
  add(result, "frame_buffer_bytes", std::uint64_t{spec::morphological::kFramePixelBytes} * pixels(),
      "byte",
      "Size of the frame buffer, which is not among the memories: what the texture unit writes and "
      "the morphological engine reads of it is not modelled in time.");
}

void FrameMeter::show_parts(Observer& observer) const {
  parts_.texture.show_parts(observer);
  if (parts_.geometric) parts_.geometric->show_parts(observer);
  if (parts_.morphological) parts_.morphological->show_parts(observer);
  observer.see("frame_buffer", parts_.buffer, activity_keys(parts_.buffer));
  observer.see("frame_buffer_bytes_written", parts_.buffer.bytes_written);
  observer.see("frame_buffer_bytes_read", parts_.buffer.bytes_read);
}

FrameMeter::Clocks FrameMeter::clocks(const Result& result, const FrameProgress& progress) const {
  const auto since_begin = [&](rtl::Cycle cycle) {
    return cycle - std::min(cycle, progress.begun);
  };
  const FrameBuffer& buffer = parts_.buffer;
  Clocks c;
  c.texturing = since_begin(buffer.last_colour());
  c.texturing_bound = parts_.texture.unit().address.addresser.bilinears.value();
  if (parts_.geometric) {
    c.drawing = progress.drawing_clocks;
    c.drawing_bound = parts_.geometric->meter().frame_clocks_bound();
  }
  if (parts_.morphological) {
    c.smoothing = result.cycles - std::min(result.cycles, since_begin(buffer.first_beat()));
    c.smoothing_bound = frame_clocks_by_formula(parts_.morphological->engine().parameters(),
                                                buffer.frame().width, buffer.frame().height);
  }
  return c;
}

std::uint64_t FrameMeter::bound(const Clocks& c) const {
  return parts_.geometric ? c.texturing_bound + c.drawing_bound + c.smoothing_bound
                          : std::max(c.texturing_bound, c.smoothing_bound);
}

std::string FrameMeter::meaning_of_bound(const Clocks& c) const {
  if (parts_.geometric)
    return fmt::format(
        "Pixels of the frame over the clocks that the engines need one after the other: texturing "
        "{}, drawing edges {}{}.",
        grouped(c.texturing_bound), grouped(c.drawing_bound),
        parts_.morphological ? fmt::format(", smoothing {}", grouped(c.smoothing_bound)) : "");
  return fmt::format(
      "Pixels of the frame over the clocks of the slower engine alone ({}), the other one hidden "
      "behind it: texturing takes {} clocks at least, smoothing {}.",
      c.smoothing_bound >= c.texturing_bound ? "smoothing" : "texturing",
      grouped(c.texturing_bound), grouped(c.smoothing_bound));
}

void FrameMeter::collect_clocks(Result& result, const Clocks& c) const {
  add(result, "texturing_clocks", c.texturing, "clk", "From the first quad to the last colour.");
  if (parts_.geometric)
    add(result, "drawing_clocks", c.drawing, "clk",
        "From the last colour in the frame buffer until the geometric engine is done.");
  if (parts_.morphological) {
    add(result, "smoothing_clocks", c.smoothing, "clk",
        "From the first row out of the frame buffer to the last pixel.");
    add(result, "smoothing_clocks_by_formula", c.smoothing_bound, "clk",
        "Of the morphological engine alone, if nothing stalls.");
  }
  if (!parts_.geometric)
    add(result, "overlapped_clocks", c.together() - std::min(c.together(), result.cycles), "clk",
        "Clocks in which both engines were at this frame.");
  add(result, parts_.geometric ? "engine_clocks_bound" : "slower_engine_clocks", bound(c), "clk",
      parts_.geometric
          ? "Of all engines, one after the other, if nothing stalls."
          : "Of the slower engine alone if nothing stalls: the texture unit's bilinears, one "
            "a clock, or smoothing_clocks_by_formula.");
}

void FrameMeter::collect_headline(Result& result, const FrameProgress& progress) const {
  const Clocks c = clocks(result, progress);
  collect_clocks(result, c);
  const MorphologicalEnvironment* const last = parts_.morphological;
  result.latency = last ? latency_of(last->engine().beat_latency)
                        : latency_of(parts_.geometric->engine().edge_latency);
  result.throughput = ratio(last ? last->delivered_in_all() : pixels(), result.cycles);
  result.throughput_unit = "pixel/clk";
  result.throughput_bound = ratio(pixels(), bound(c));
  result.throughput_bound_meaning = meaning_of_bound(c);
  result.figures = headline_figures(progress.complete);
  result.bottleneck =
      find_bottleneck(result.units, last ? "morphological_blender" : "geometric_resolver");
}

std::vector<Figure> FrameMeter::headline_figures(bool complete) const {
  std::vector<Figure> figures;
  if (complete) {
    figures.push_back(
        parts_.geometric
            ? Figure{"Frame", "cycles", "engines alone", "work.engine_clocks_bound", true}
            : Figure{"Frame", "cycles", "slower engine alone", "work.slower_engine_clocks", true});
    figures.push_back(
        {"Texturing", "work.texturing_clocks", "bilinears", "work.texture_bilinears"});
    if (parts_.geometric) figures.push_back({"Edges", "work.drawing_clocks"});
    if (parts_.morphological)
      figures.push_back(
          {"Smoothing", "work.smoothing_clocks", "formula", "work.smoothing_clocks_by_formula"});
    if (!parts_.geometric) figures.push_back({"Both at once", "work.overlapped_clocks"});
  }
  for (const Figure& figure : std::initializer_list<Figure>{
           {"Latency of a texture fragment, median", "work.texture_fragment_latency_p50"},
           {"Frame buffer, not among the memories", "work.frame_buffer_bytes"},
           {"Written to the frame buffer", "work.frame_buffer_bytes_written"},
           {"Read from the frame buffer", "work.frame_buffer_bytes_read"}})
    figures.push_back(figure);
  const auto add_work = [&](std::vector<Figure> work) {
    for (Figure& figure : work) figures.push_back(std::move(figure));
  };
  if (parts_.geometric) add_work(parts_.geometric->meter().work_figures());
  if (parts_.morphological) add_work(parts_.morphological->meter().work_figures());
  return figures;
}

}  // namespace deburr::tb
