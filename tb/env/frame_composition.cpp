// SPDX-License-Identifier: MIT
#include "tb/env/frame_composition.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tb/env/collect.h"
#include "tb/env/morphological_frames.h"
#include "tb/results/report.h"

namespace deburr::tb {
namespace {

// The frame that the morphological engine should get. Without a golden model only its size counts.
MorphologicalInput golden_input(const TextureScene& scene, const TextureSetup& setup, bool golden) {
  if (!golden) return {Image(scene.stream().width, scene.stream().height), {}};
  return {golden_frame(scene, setup.texture, error_range(setup.memory)).image,
          depth_codes(scene.stream().depth)};
}

Environment::Boards joined(Environment::Boards first, const Environment::Boards& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

}  // namespace

FrameComposition::FrameComposition(Simulation& simulation, const TextureScene& scene,
                                   const FrameSetup& setup)
    : Environment(simulation, ""),
      golden_frames_{golden_input(scene, setup.texture, golden())},
      texture(simulation, scene, setup.texture, "texture"),
      buffer("frame_buffer", simulation.clock(), scene, lanes_of(setup.smoothing.morphological)),
      smoothing(simulation, golden_frames_, setup.smoothing, "morphological"),
      width_(scene.stream().width),
      height_(scene.stream().height),
      smoothing_parameters_(setup.smoothing.morphological) {
  buffer.colours_in(texture.colours);
  buffer.pixels_out(smoothing.pixels);
  buffer.on_colour = [this](rtl::Cycle cycle, const spec::texture::Colour& colour) {
    texture.judge(cycle, colour);
  };
}

void FrameComposition::configure() {
  texture.configure();
  smoothing.configure();
}

bool FrameComposition::begin(std::size_t piece) {
  return texture.begin(piece) && smoothing.begin(piece);
}

void FrameComposition::watch() {
  texture.watch();
  smoothing.watch();
}

bool FrameComposition::done() const { return buffer.done() && texture.done() && smoothing.done(); }

void FrameComposition::end() {
  texture.end();
  smoothing.end();
}

// Both engines begin by themselves, so answers of memory that are on their way go by during reset.
void FrameComposition::restart() {
  simulation().clock().set_reset_n(false);
  simulation().clock().run(clocks_to_drain());
  simulation().clock().set_reset_n(true);
  configure();
  texture.restart();
  smoothing.restart();
}

void FrameComposition::finish() {
  texture.finish();
  smoothing.finish();
}

void FrameComposition::refuse_memory_errors() {
  texture.refuse_memory_errors();
  smoothing.refuse_memory_errors();
}

void FrameComposition::refuse_unused_errors() const {
  texture.refuse_unused_errors();
  smoothing.refuse_unused_errors();
}

rtl::Cycle FrameComposition::clocks_to_drain() const {
  return std::max(texture.clocks_to_drain(), smoothing.clocks_to_drain());
}

Environment::Boards FrameComposition::outputs() const {
  return joined(texture.outputs(), smoothing.outputs());
}
Environment::Boards FrameComposition::traffic() const {
  return joined(texture.traffic(), smoothing.traffic());
}

Environment::Boards FrameComposition::counters() const {
  return joined(texture.counters(), smoothing.counters());
}

void FrameComposition::collect(Result& result) const {
  texture.collect(result);
  add(result, "frame_buffer", buffer);
  smoothing.collect(result);
  const rtl::Histogram& latency = texture.unit().fragment_latency;
  add(result, "texture_fragment_latency_p50", latency.percentile(50), "clk",
      "Of the texture unit.");
  add(result, "texture_fragment_latency_max", latency.max(), "clk", "Of the texture unit.");
  add(result, "frame_buffer_bytes_written", buffer.bytes_written);
  add(result, "frame_buffer_bytes_read", buffer.bytes_read);
  add(result, "frame_buffer_bytes",
      std::uint64_t{spec::morphological::kFramePixelBytes} * static_cast<std::uint64_t>(width_) *
          static_cast<std::uint64_t>(height_),
      "byte",
      "Size of the frame buffer, which is not among the memories: it is not modelled in time.");
}

void FrameComposition::collect_headline(Result& result) const {
  const std::uint64_t bilinears = texture.unit().address.addresser.bilinears.value();
  const std::uint64_t raster = frame_clocks_by_formula(smoothing_parameters_, width_, height_);
  const std::uint64_t slower = std::max(bilinears, raster);
  const auto since_begin = [&](rtl::Cycle cycle) {
    return cycle - std::min(cycle, simulation().begun());
  };
  const std::uint64_t texturing = since_begin(buffer.last_colour());
  const std::uint64_t smoothed =
      result.cycles - std::min(result.cycles, since_begin(buffer.first_beat()));
  add(result, "texturing_clocks", texturing, "clk", "From the first quad to the last colour.");
  add(result, "smoothing_clocks", smoothed, "clk",
      "From the first row out of the frame buffer to the last pixel.");
  add(result, "overlapped_clocks",
      texturing + smoothed - std::min(texturing + smoothed, result.cycles), "clk",
      "Clocks in which both engines were at this frame.");
  add(result, "smoothing_clocks_by_formula", raster, "clk",
      "Of the morphological engine alone, if nothing stalls.");
  add(result, "slower_engine_clocks", slower, "clk",
      "Of the slower engine alone if nothing stalls: the texture unit's bilinears, one a clock, or "
      "smoothing_clocks_by_formula.");

  result.latency = latency_of(smoothing.engine().beat_latency);
  result.throughput = ratio(smoothing.delivered_in_all(), result.cycles);
  result.throughput_unit = "pixel/clk";
  result.throughput_bound =
      ratio(static_cast<std::uint64_t>(width_) * static_cast<std::uint64_t>(height_), slower);
  result.throughput_bound_meaning = fmt::format(
      "Pixels of the frame over the clocks of the slower engine alone ({}), the other one hidden "
      "behind it: texturing takes {} clocks at least, smoothing {}.",
      raster >= bilinears ? "smoothing" : "texturing", grouped(bilinears), grouped(raster));
  result.figures.clear();
  if (simulation().complete())
    result.figures = {
        {"Frame", "cycles", "slower engine alone", "work.slower_engine_clocks", true},
        {"Texturing", "work.texturing_clocks", "bilinears", "work.texture_bilinears"},
        {"Smoothing", "work.smoothing_clocks", "formula", "work.smoothing_clocks_by_formula"},
        {"Both at once", "work.overlapped_clocks"}};
  for (const Figure& figure : std::initializer_list<Figure>{
           {"Latency of a texture fragment, median", "work.texture_fragment_latency_p50"},
           {"Frame buffer, not among the memories", "work.frame_buffer_bytes"},
           {"Written to the frame buffer", "work.frame_buffer_bytes_written"},
           {"Read from the frame buffer", "work.frame_buffer_bytes_read"}})
    result.figures.push_back(figure);
  for (Figure& figure : smoothing.work_figures()) result.figures.push_back(std::move(figure));
  result.bottleneck = find_bottleneck(result.units, "morphological_blender");
}

}  // namespace deburr::tb
