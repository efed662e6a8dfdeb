// SPDX-License-Identifier: MIT
#include "tool/engines/frame/frame_composition.h"

#include <string>
#include <utility>

#include "spec/error.h"

namespace deburr::tool {

using tb::Environment;

namespace {

template <class T>
std::vector<const T*> list_of(const T* one) {
  return one ? std::vector<const T*>{one} : std::vector<const T*>{};
}

}  // namespace

FrameComposition::FrameComposition(tb::Simulation& simulation, const tb::DrawnScene& scene,
                                   const FrameRoles& roles)
    : FrameComposition(simulation, scene, roles, list_of(roles.chosen().mesh),
                       list_of(roles.chosen().rows), roles.chosen().follows()) {}

std::unique_ptr<FrameComposition> FrameComposition::of_all(tb::Simulation& simulation,
                                                           const tb::DrawnScene& scene,
                                                           const FrameRoles& roles) {
  return std::unique_ptr<FrameComposition>(new FrameComposition(
      simulation, scene, roles, roles.mesh_smoothers(), roles.row_smoothers(), false));
}

FrameComposition::FrameComposition(tb::Simulation& simulation, const tb::DrawnScene& scene,
                                   const FrameRoles& roles,
                                   const std::vector<const MeshSmoother*>& mesh,
                                   const std::vector<const RowSmoother*>& rows, bool follows)
    : Environment(simulation, ""),
      roles_(roles),
      follows_(follows),
      width_(scene.stream().width),
      height_(scene.stream().height),
      drawing_stage_(roles.drawer().build(simulation, scene)) {
  BufferEnds ends;
  ends.drawer = roles.drawer().name();
  ends.colours = [this](const char* name) { return drawing_stage_->colours_port(name); };
  if (!mesh.empty()) {
    ends.mesh = mesh.front()->name();
    mesh_title_ = mesh.front()->title();
  }
  if (!rows.empty()) {
    ends.rows = [&](const char* name) { return rows.front()->rows_port(name, scene); };
    rows_title_ = rows.front()->title();
  }
  buffer_ = std::make_unique<FrameBuffer>("frame_buffer", simulation.clock(), scene, ends);

  // The expected input of the first engine after the frame buffer; without a golden model only its
  // size matters. The second engine gets its input when the first is done.
  tb::Image first = golden() ? drawing_stage_->golden_picture() : tb::Image(width_, height_);
  for (tb::Rgba8& pixel : first.pixels) pixel = unmarked(pixel);
  for (const MeshSmoother* smoother : mesh)
    mesh_.push_back(smoother->build(simulation, scene, first));
  if (!mesh.empty()) {
    first = tb::Image(width_, height_);
    buffer_->on_pixel = [this](int x, int y, const tb::Rgba8& colour) {
      this->mesh()->put(x, y, unmarked(colour));
    };
  }
  for (const RowSmoother* smoother : rows) {
    RowsPort* port = buffer_->rows();
    if (!rows_.empty())
      port = unused_ports_.emplace_back(smoother->rows_port("not_sent", scene)).get();
    rows_.push_back(smoother->build(simulation, scene, first, *port));
  }
}

tb::Rgba8 FrameComposition::unmarked(tb::Rgba8 colour) const {
  if (follows_) colour[3] = static_cast<std::uint8_t>(colour[3] | 1);
  return colour;
}

std::vector<const Environment*> FrameComposition::parts() const {
  std::vector<const Environment*> all = {&std::as_const(*drawing_stage_).environment()};
  for (const auto& stage : mesh_) all.push_back(&std::as_const(*stage).environment());
  for (const auto& stage : rows_) all.push_back(&std::as_const(*stage).environment());
  return all;
}

std::vector<Environment*> FrameComposition::parts() {
  std::vector<Environment*> all = {&drawing_stage_->environment()};
  for (const auto& stage : mesh_) all.push_back(&stage->environment());
  for (const auto& stage : rows_) all.push_back(&stage->environment());
  return all;
}

const SmoothingStage& FrameComposition::last() const {
  if (rows()) return *rows();
  return *mesh();
}

// ---- running ------------------------------------------------------------------------------------

void FrameComposition::configure() {
  DEBURR_CHECK(mesh_.size() <= 1 && rows_.size() <= 1, "a composition of all engines never runs");
  for (Environment* part : parts()) part->configure();
}

bool FrameComposition::begin(std::size_t piece) {
  if (!drawing_stage_->environment().begin(piece)) return false;
  if (!mesh()) return rows()->environment().begin(piece);
  mesh()->environment().begin(piece);
  put_sky();
  return true;
}

// Writes the sky to the memory of the mesh engine; nothing else is drawn yet.
void FrameComposition::put_sky() {
  const tb::Image& sky = buffer_->frame();
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) mesh()->put(x, y, unmarked(sky.at(x, y)));
}

void FrameComposition::watch() {
  drawing_stage_->environment().watch();
  if (MeshStage* stage = mesh()) stage->environment().watch();
  if (RowStage* stage = rows()) stage->environment().watch();
  if (mesh()) hand_on();
}

void FrameComposition::hand_on() {
  if (!drawing_) {
    if (!buffer_->complete()) return;
    drawing_ = true;
    drawn_from_ = simulation().clock().cycle();
    mesh()->draw();
  } else if (!drawn_ && mesh()->environment().done()) {
    drawn_ = true;
    drawn_until_ = simulation().clock().cycle();
    if (!rows()) return;
    if (!followed_) {
      if (golden()) rows()->expect(mesh()->expected_frame());
      followed_ = rows()->environment().begin(0);
    }
    buffer_->release(mesh()->frame());
  }
}

bool FrameComposition::done() const {
  return buffer_->done() && std::as_const(*drawing_stage_).environment().done() &&
         (!mesh() || drawn_) && (!rows() || rows()->environment().done());
}

void FrameComposition::end() {
  for (Environment* part : parts()) part->end();
}

// The engines start by themselves, so outstanding memory responses drain during reset.
void FrameComposition::restart() {
  simulation().clock().set_reset_n(false);
  drain_memory();
  simulation().clock().set_reset_n(true);
  configure();
  drawing_stage_->environment().restart();
  if (mesh()) {
    mesh()->environment().restart();
    put_sky();
  }
  if (rows() && (!mesh() || followed_)) rows()->environment().restart();
  drawing_ = drawn_ = false;
}

void FrameComposition::finish() {
  for (Environment* part : parts()) part->finish();
}

void FrameComposition::reject_memory_errors() {
  for (Environment* part : parts()) part->reject_memory_errors();
}

void FrameComposition::reject_unused_errors() const {
  for (const Environment* part : parts()) part->reject_unused_errors();
}

tb::Amount FrameComposition::amount() const { return last().environment().amount(); }

bool FrameComposition::memory_at_rest() const {
  bool at_rest = true;
  for (const Environment* part : parts()) at_rest = at_rest && part->memory_at_rest();
  return at_rest;
}

// ---- checking -----------------------------------------------------------------------------------

Environment::Boards FrameComposition::boards(Boards (Environment::*of)() const) const {
  Boards all;
  for (const Environment* part : parts()) {
    const Boards more = (part->*of)();
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

Environment::Boards FrameComposition::outputs() const { return boards(&Environment::outputs); }
Environment::Boards FrameComposition::traffic() const { return boards(&Environment::traffic); }
Environment::Boards FrameComposition::counters() const { return boards(&Environment::counters); }

std::vector<std::string> FrameComposition::notes() const {
  std::vector<std::string> all;
  const auto add = [&](const SmoothingStage& stage) {
    for (std::string& note : stage.notes()) all.push_back(std::move(note));
  };
  if (mesh()) add(*mesh());
  if (rows()) add(*rows());
  return all;
}

std::size_t FrameComposition::delivered() const {
  if (rows()) return rows()->delivered();
  return drawn_ ? static_cast<std::size_t>(pixels()) : 0;
}

std::uint64_t FrameComposition::pixels() const {
  return static_cast<std::uint64_t>(width_) * static_cast<std::uint64_t>(height_);
}

// ---- results ------------------------------------------------------------------------------------

FrameMeter FrameComposition::meter() const {
  FrameParts in_order{roles_.drawer(), *drawing_stage_, *buffer_,    parts(), mesh(),
                      rows(),          mesh_title_,     rows_title_, {}};
  for (const auto& stage : mesh_) in_order.smoothing.push_back(stage.get());
  for (const auto& stage : rows_) in_order.smoothing.push_back(stage.get());
  return FrameMeter(in_order);
}

void FrameComposition::collect_headline(tb::Result& result) const {
  meter().collect_headline(result, {simulation().begun(), drawn_ ? drawn_until_ - drawn_from_ : 0,
                                    simulation().complete()});
}

std::vector<tb::PictureMap> FrameComposition::maps() const {
  std::vector<tb::PictureMap> all;
  for (const Environment* part : parts())
    for (tb::PictureMap& map : part->maps()) all.push_back(std::move(map));
  return all;
}

std::optional<tb::PixelHistory> FrameComposition::pixel_history() const {
  std::optional<tb::PixelHistory> all;
  for (const Environment* part : parts())
    if (const std::optional<tb::PixelHistory> one = part->pixel_history()) {
      if (!all) all = tb::PixelHistory{one->pixel};
      all->append(*one);
    }
  return all;
}

tb::Coverage FrameComposition::coverage() const {
  tb::Coverage all;
  for (const Environment* part : parts()) all.merge(part->coverage());
  return all;
}

}  // namespace deburr::tool
