// SPDX-License-Identifier: MIT
#include "tb/engines/frame/frame_composition.h"

#include <algorithm>
#include <string>
#include <utility>

#include "spec/error.h"
#include "tb/engines/geometric/edge_table.h"
#include "tb/engines/morphological/morphological_frames.h"
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
  frame.table = build_edge_table(scene.scene().mesh, {.crossings = setup.crossings});
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
      buffer("frame_buffer", simulation.clock(), scene,
             platform::lanes_of(setup.morphological.morphological), rows_of(setup.smoothing)),
      width_(scene.stream().width),
      height_(scene.stream().height) {
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

FrameMeter FrameComposition::meter() const {
  return FrameMeter({texture, buffer, geometric.get(), morphological.get()});
}

void FrameComposition::collect_headline(Result& result) const {
  meter().collect_headline(result, {simulation().begun(), drawn_ ? drawn_until_ - drawn_from_ : 0,
                                    simulation().complete()});
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

}  // namespace deburr::tb
