// SPDX-License-Identifier: MIT
// A whole frame: a scene is drawn into a frame buffer, and smoothed there by one engine or two. All
// with their environments, on one clock; which they are, their roles say (tool/run/composition.h).
//
//   DrawingStage ─► colours ─► FrameBuffer ─► rows ─► RowStage
//                               │       ▲ rows
//                               ▼       │
//                              MeshStage: its memory is the frame buffer then
//
// Rows alone: the two overlap: the frame buffer hands on a row as soon as every fragment of it and
// of the rows above has come. Mesh alone: the engine begins in the clock in which the last fragment
// has come. Both: and rows go out when it is done. Where the second looks at what the first one
// marks, the frame buffer sets bit 0 of every alpha as it comes, so that only what is blended is
// marked.
//
// Each engine is checked against its golden model, which gets what the golden model before it made.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tb/env/environment.h"
#include "tool/engines/frame/frame_buffer.h"
#include "tool/engines/frame/frame_meter.h"
#include "tool/engines/frame/frame_roles.h"
#include "tool/run/composition.h"

namespace deburr::tool {

class FrameComposition final : public tb::Environment {
 public:
  // Of what is chosen. Scene and roles must outlive it. ConfigError for wrong parameters.
  FrameComposition(tb::Simulation& simulation, const tb::DrawnScene& scene,
                   const FrameRoles& roles);
  // Of every engine that smooths, for what is built of each: it never runs.
  static std::unique_ptr<FrameComposition> of_all(tb::Simulation& simulation,
                                                  const tb::DrawnScene& scene,
                                                  const FrameRoles& roles);

  void configure() override;
  bool begin(std::size_t piece) override;
  void watch() override;
  bool done() const override;
  void end() override;
  void restart() override;
  void finish() override;
  void reject_memory_errors() override;
  void reject_unused_errors() const override;
  tb::Amount amount() const override;
  bool memory_at_rest() const override;
  Boards outputs() const override;
  Boards traffic() const override;
  Boards counters() const override;
  void collect(tb::Result& result) const override { meter().collect(result); }
  void show_parts(tb::Observer& observer) const override { meter().show_parts(observer); }
  std::vector<tb::PictureMap> maps() const override;
  std::optional<tb::PixelHistory> pixel_history() const override;
  tb::Coverage coverage() const override;
  void collect_headline(tb::Result& result) const override;

  // What was smoothed so far, how many pixels of it were delivered, and what it should be.
  tb::Image frame() const { return last().frame(); }
  std::size_t delivered() const;
  tb::Image expected_frame() const { return last().expected_frame(); }
  // Of its smoothing stages, in the order of the frame's way.
  std::vector<std::string> notes() const;
  const FrameBuffer& buffer() const { return *buffer_; }
  const DrawingStage& drawing() const { return *drawing_stage_; }
  const MeshStage* mesh() const { return mesh_.empty() ? nullptr : mesh_.front().get(); }
  const RowStage* rows() const { return rows_.empty() ? nullptr : rows_.front().get(); }

 private:
  FrameComposition(tb::Simulation& simulation, const tb::DrawnScene& scene, const FrameRoles& roles,
                   const std::vector<const MeshSmoother*>& mesh,
                   const std::vector<const RowSmoother*>& rows, bool follows);

  FrameMeter meter() const;
  const SmoothingStage& last() const;
  MeshStage* mesh() { return mesh_.empty() ? nullptr : mesh_.front().get(); }
  RowStage* rows() { return rows_.empty() ? nullptr : rows_.front().get(); }
  // Of all engines that there are, in the order of the frame's way.
  std::vector<tb::Environment*> parts();
  std::vector<const tb::Environment*> parts() const;
  Boards boards(Boards (tb::Environment::*of)() const) const;
  // Between cycles: engines that begin when the one before them is done.
  void hand_on();
  // As it lies in the frame buffer: nothing is marked before the first engine marks it.
  tb::Rgba8 unmarked(tb::Rgba8 colour) const;
  void put_sky();
  std::uint64_t pixels() const;

  const FrameRoles& roles_;
  bool follows_;
  std::string_view mesh_title_, rows_title_;
  int width_, height_;
  std::unique_ptr<DrawingStage> drawing_stage_;
  std::unique_ptr<FrameBuffer> buffer_;
  std::vector<std::unique_ptr<MeshStage>> mesh_;  // one or none, but to be described
  std::vector<std::unique_ptr<RowStage>> rows_;   //
  std::vector<std::unique_ptr<RowsPort>> unused_ports_;
  bool drawing_ = false, drawn_ = false;  // along the edges of the mesh
  bool followed_ = false;                 // the second engine has begun behind the first
  rtl::Cycle drawn_from_ = 0, drawn_until_ = 0;
};

}  // namespace deburr::tool
