// SPDX-License-Identifier: MIT
#include "tb/engines/frame/frame_composition.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "spec/error.h"
#include "tb/engines/geometric/edge_table.h"
#include "tb/env/collect.h"
#include "tb/env/morphological_frames.h"
#include "tb/results/report.h"
#include "tb/scene/depth_codes.h"

namespace deburr::tb {
namespace {

// As it lies in the frame buffer: nothing is marked before the geometric engine marks it.
Rgba8 unmarked(Rgba8 colour, Smoothing smoothing) {
  if (smoothing == Smoothing::kGeometricMorphological)
    colour[3] = static_cast<std::uint8_t>(colour[3] | 1);
  return colour;
}

// The frame that the first engine behind the texture unit should get. Without a golden model only
// its size counts.
Image golden_image(const TextureScene& scene, const FrameSetup& setup, bool golden) {
  if (!golden) return {scene.stream().width, scene.stream().height};
  Image image = golden_frame(scene, setup.texture.texture, error_range(setup.texture.memory)).image;
  for (Rgba8& pixel : image.pixels) pixel = unmarked(pixel, setup.smoothing);
  return image;
}

std::vector<geometric::Frame> geometric_frames(const TextureScene& scene, const FrameSetup& setup,
                                               bool golden) {
  if (!has_geometric(setup.smoothing)) return {};
  const FragmentStream& stream = scene.stream();
  geometric::Frame frame;
  frame.image = golden_image(scene, setup, golden);
  frame.depth = stream.depth;
  frame.depths = depth_codes(stream.depth);
  frame.table = build_edge_table(scene.scene().mesh);
  frame.screen = project_edges(frame.table, scene.scene().camera, stream.width, stream.height);
  std::vector<geometric::Frame> frames;
  frames.push_back(std::move(frame));
  return frames;
}

// Behind the geometric engine the image comes when that is done.
std::vector<MorphologicalInput> morphological_frames(const TextureScene& scene,
                                                     const FrameSetup& setup, bool golden) {
  if (!has_morphological(setup.smoothing)) return {};
  const bool first = !has_geometric(setup.smoothing);
  return {{golden_image(scene, setup, golden && first), depth_codes(scene.stream().depth)}};
}

Rows rows_of(Smoothing smoothing) {
  if (!has_morphological(smoothing)) return Rows::kNever;
  return has_geometric(smoothing) ? Rows::kWhenReleased : Rows::kAsTheyCome;
}

}  // namespace

FrameComposition::FrameComposition(Simulation& simulation, const TextureScene& scene,
                                   const FrameSetup& setup)
    : Environment(simulation, ""),
      smoothing_(setup.smoothing),
      geometric_frames_(geometric_frames(scene, setup, golden())),
      morphological_frames_(morphological_frames(scene, setup, golden())),
      texture(simulation, scene, setup.texture, "texture"),
      buffer("frame_buffer", simulation.clock(), scene, lanes_of(setup.morphological.morphological),
             rows_of(setup.smoothing)),
      width_(scene.stream().width),
      height_(scene.stream().height),
      morphological_parameters_(setup.morphological.morphological) {
  if (has_geometric(smoothing_)) {
    geometric = std::make_unique<GeometricEnvironment>(simulation, geometric_frames_,
                                                       setup.geometric, "geometric");
    buffer.on_pixel = [this](int x, int y, const Rgba8& colour) { put(x, y, colour); };
  }
  if (has_morphological(smoothing_)) {
    morphological = std::make_unique<MorphologicalEnvironment>(
        simulation, morphological_frames_, setup.morphological, "morphological");
    (*buffer.pixels_out)(morphological->pixels);
  }
  buffer.colours_in(texture.colours);
  buffer.on_colour = [this](rtl::Cycle cycle, const spec::texture::Colour& colour) {
    texture.judge(cycle, colour);
  };
}

template <class Self, class Visit>
void FrameComposition::each_part(Self& self, Visit&& visit) {
  visit(self.texture);
  if (self.geometric) visit(*self.geometric);
  if (self.morphological) visit(*self.morphological);
}

// ---- running ------------------------------------------------------------------------------------

void FrameComposition::configure() {
  each_part(*this, [](Environment& part) { part.configure(); });
}

bool FrameComposition::begin(std::size_t piece) {
  if (!texture.begin(piece)) return false;
  if (!geometric) return morphological->begin(piece);
  geometric->begin(piece);
  put_sky();
  return true;
}

void FrameComposition::put(int x, int y, const Rgba8& colour) {
  geometric->put(x, y, unmarked(colour, smoothing_));
}

// Nothing else has come yet.
void FrameComposition::put_sky() {
  const Image& sky = buffer.frame();
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) put(x, y, sky.at(x, y));
}

void FrameComposition::watch() {
  each_part(*this, [](Environment& part) { part.watch(); });
  if (geometric) hand_on();
}

void FrameComposition::hand_on() {
  if (!drawing_) {
    if (!buffer.complete()) return;
    drawing_ = true;
    drawn_from_ = simulation().clock().cycle();
    geometric->draw();
  } else if (!drawn_ && geometric->done()) {
    drawn_ = true;
    drawn_until_ = simulation().clock().cycle();
    if (!morphological) return;
    if (!followed_) {
      if (golden()) morphological_frames_.front().image = geometric->expected_frame();
      followed_ = morphological->begin(0);
    }
    buffer.release(geometric->frame());
  }
}

bool FrameComposition::done() const {
  return buffer.done() && texture.done() && (!geometric || drawn_) &&
         (!morphological || morphological->done());
}

void FrameComposition::end() {
  each_part(*this, [](Environment& part) { part.end(); });
}

// The engines begin by themselves, so answers of memory that are on their way go by during reset.
void FrameComposition::restart() {
  simulation().clock().set_reset_n(false);
  drain_memory();
  simulation().clock().set_reset_n(true);
  configure();
  texture.restart();
  if (geometric) {
    geometric->restart();
    put_sky();
  }
  if (morphological && (!geometric || followed_)) morphological->restart();
  drawing_ = drawn_ = false;
}

void FrameComposition::finish() {
  each_part(*this, [](Environment& part) { part.finish(); });
}

void FrameComposition::refuse_memory_errors() {
  each_part(*this, [](Environment& part) { part.refuse_memory_errors(); });
}

void FrameComposition::refuse_unused_errors() const {
  each_part(*this, [](const Environment& part) { part.refuse_unused_errors(); });
}

Amount FrameComposition::amount() const {
  return morphological ? morphological->amount() : geometric->amount();
}

bool FrameComposition::memory_at_rest() const {
  bool at_rest = true;
  each_part(*this, [&](const Environment& part) { at_rest = at_rest && part.memory_at_rest(); });
  return at_rest;
}

// ---- judging ------------------------------------------------------------------------------------

Environment::Boards FrameComposition::boards(Boards (Environment::*of)() const) const {
  Boards all;
  each_part(*this, [&](const Environment& part) {
    const Boards more = (part.*of)();
    all.insert(all.end(), more.begin(), more.end());
  });
  return all;
}

Environment::Boards FrameComposition::outputs() const { return boards(&Environment::outputs); }
Environment::Boards FrameComposition::traffic() const { return boards(&Environment::traffic); }
Environment::Boards FrameComposition::counters() const { return boards(&Environment::counters); }

Image FrameComposition::frame() const {
  return morphological ? morphological->frame() : geometric->frame();
}

std::size_t FrameComposition::delivered() const {
  if (morphological) return morphological->delivered();
  return drawn_ ? static_cast<std::size_t>(pixels()) : 0;
}

Image FrameComposition::golden_frame() const {
  if (!morphological) return geometric->expected_frame();
  Image image(width_, height_);
  const std::vector<Rgba8>& expected = morphological->golden_model().pixels();
  if (expected.size() == image.pixels.size()) image.pixels = expected;
  return image;
}

std::uint64_t FrameComposition::pixels() const {
  return static_cast<std::uint64_t>(width_) * static_cast<std::uint64_t>(height_);
}

// ---- results ------------------------------------------------------------------------------------

void FrameComposition::collect(Result& result) const {
  texture.collect(result);
  add(result, "frame_buffer", buffer);
  if (geometric) geometric->collect(result);
  if (morphological) morphological->collect(result);
  const rtl::Histogram& latency = texture.unit().fragment_latency;
  add(result, "texture_fragment_latency_p50", latency.percentile(50), "clk",
      "Of the texture unit.");
  add(result, "texture_fragment_latency_max", latency.max(), "clk", "Of the texture unit.");
  add(result, "frame_buffer_bytes_written", buffer.bytes_written);
  add(result, "frame_buffer_bytes_read", buffer.bytes_read);
  add(result, "frame_buffer_bytes", std::uint64_t{spec::morphological::kFramePixelBytes} * pixels(),
      "byte",
      "Size of the frame buffer, which is not among the memories: what the texture unit writes and "
      "the morphological engine reads of it is not modelled in time.");
}

void FrameComposition::show_parts(Observer& observer) const {
  each_part(*this, [&](const Environment& part) { part.show_parts(observer); });
  observer.see("frame_buffer", buffer, activity_keys(buffer));
  observer.see("frame_buffer_bytes_written", buffer.bytes_written);
  observer.see("frame_buffer_bytes_read", buffer.bytes_read);
}

std::vector<PictureMap> FrameComposition::maps() const {
  std::vector<PictureMap> all;
  each_part(*this, [&](const Environment& part) {
    for (PictureMap& map : part.maps()) all.push_back(std::move(map));
  });
  return all;
}

Coverage FrameComposition::coverage() const {
  Coverage all;
  each_part(*this, [&](const Environment& part) { all.merge(part.coverage()); });
  return all;
}

FrameComposition::Clocks FrameComposition::clocks(const Result& result) const {
  const auto since_begin = [&](rtl::Cycle cycle) {
    return cycle - std::min(cycle, simulation().begun());
  };
  Clocks c;
  c.texturing = since_begin(buffer.last_colour());
  c.texturing_bound = texture.unit().address.addresser.bilinears.value();
  if (geometric) {
    c.drawing = drawn_ ? drawn_until_ - drawn_from_ : 0;
    c.drawing_bound = geometric->frame_clocks_bound();
  }
  if (morphological) {
    c.smoothing = result.cycles - std::min(result.cycles, since_begin(buffer.first_beat()));
    c.smoothing_bound = frame_clocks_by_formula(morphological_parameters_, width_, height_);
  }
  return c;
}

void FrameComposition::collect_headline(Result& result) const {
  const Clocks c = clocks(result);
  const std::uint64_t together = c.texturing + c.drawing + c.smoothing;
  // Engines behind each other add up; the texture unit and the morphological engine overlap.
  const std::uint64_t bound = geometric ? c.texturing_bound + c.drawing_bound + c.smoothing_bound
                                        : std::max(c.texturing_bound, c.smoothing_bound);
  add(result, "texturing_clocks", c.texturing, "clk", "From the first quad to the last colour.");
  if (geometric)
    add(result, "drawing_clocks", c.drawing, "clk",
        "From the last colour in the frame buffer until the geometric engine is done.");
  if (morphological) {
    add(result, "smoothing_clocks", c.smoothing, "clk",
        "From the first row out of the frame buffer to the last pixel.");
    add(result, "smoothing_clocks_by_formula", c.smoothing_bound, "clk",
        "Of the morphological engine alone, if nothing stalls.");
  }
  if (!geometric)
    add(result, "overlapped_clocks", together - std::min(together, result.cycles), "clk",
        "Clocks in which both engines were at this frame.");
  add(result, geometric ? "engine_clocks_bound" : "slower_engine_clocks", bound, "clk",
      geometric ? "Of all engines, one after the other, if nothing stalls."
                : "Of the slower engine alone if nothing stalls: the texture unit's bilinears, one "
                  "a clock, or smoothing_clocks_by_formula.");

  result.latency = morphological ? latency_of(morphological->engine().beat_latency)
                                 : latency_of(geometric->engine().edge_latency);
  result.throughput = ratio(pixels(), result.cycles);
  if (morphological) result.throughput = ratio(morphological->delivered_in_all(), result.cycles);
  result.throughput_unit = "pixel/clk";
  result.throughput_bound = ratio(pixels(), bound);
  if (geometric)
    result.throughput_bound_meaning = fmt::format(
        "Pixels of the frame over the clocks that the engines need one after the other: texturing "
        "{}, drawing edges {}{}.",
        grouped(c.texturing_bound), grouped(c.drawing_bound),
        morphological ? fmt::format(", smoothing {}", grouped(c.smoothing_bound)) : "");
  else
    result.throughput_bound_meaning = fmt::format(
        "Pixels of the frame over the clocks of the slower engine alone ({}), the other one hidden "
        "behind it: texturing takes {} clocks at least, smoothing {}.",
        c.smoothing_bound >= c.texturing_bound ? "smoothing" : "texturing",
        grouped(c.texturing_bound), grouped(c.smoothing_bound));

  result.figures.clear();
  if (simulation().complete()) {
    result.figures.push_back(
        geometric
            ? Figure{"Frame", "cycles", "engines alone", "work.engine_clocks_bound", true}
            : Figure{"Frame", "cycles", "slower engine alone", "work.slower_engine_clocks", true});
    result.figures.push_back(
        {"Texturing", "work.texturing_clocks", "bilinears", "work.texture_bilinears"});
    if (geometric) result.figures.push_back({"Edges", "work.drawing_clocks"});
    if (morphological)
      result.figures.push_back(
          {"Smoothing", "work.smoothing_clocks", "formula", "work.smoothing_clocks_by_formula"});
    if (!geometric) result.figures.push_back({"Both at once", "work.overlapped_clocks"});
  }
  for (const Figure& figure : std::initializer_list<Figure>{
           {"Latency of a texture fragment, median", "work.texture_fragment_latency_p50"},
           {"Frame buffer, not among the memories", "work.frame_buffer_bytes"},
           {"Written to the frame buffer", "work.frame_buffer_bytes_written"},
           {"Read from the frame buffer", "work.frame_buffer_bytes_read"}})
    result.figures.push_back(figure);
  if (geometric)
    for (Figure& figure : geometric->work_figures()) result.figures.push_back(std::move(figure));
  if (morphological)
    for (Figure& figure : morphological->work_figures())
      result.figures.push_back(std::move(figure));
  result.bottleneck =
      find_bottleneck(result.units, morphological ? "morphological_blender" : "geometric_resolver");
}

}  // namespace deburr::tb
