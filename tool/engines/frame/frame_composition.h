// SPDX-License-Identifier: MIT
// A whole frame: a scene is drawn into a frame buffer, and smoothed there by one or two engines.
// All of them and their environments share one clock; the roles determine the engines
// (tool/run/composition.h).
//
//   DrawingStage ─► colours ─► FrameBuffer ─► rows ─► RowStage
//                               │       ▲ rows
//                               ▼       │
//                              MeshStage: its memory is the frame buffer then
//
// With a row stage only, drawing and smoothing overlap: the frame buffer outputs a row as soon as
// every fragment of this row and of the rows above has arrived. With a mesh stage only, its engine
// starts in the cycle in which the last fragment arrives. With both, rows are output when the mesh
// engine is done. If the second engine reads the marks of the first, the frame buffer sets bit 0 of
// every received alpha, so that only blended pixels are marked.
//
// Each engine is checked against its own golden model. The input of a golden model is the output of
// the golden model before it.
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
  // The selected engines. Scene and roles must outlive it. ConfigError for wrong parameters.
  FrameComposition(tb::Simulation& simulation, const tb::DrawnScene& scene,
                   const FrameRoles& roles);
  // A composition of every smoothing engine, used to describe their hardware. It is never run.
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

  // The frame as smoothed so far, its number of delivered pixels, and the expected frame.
  tb::Image frame() const { return last().frame(); }
  std::size_t delivered() const;
  tb::Image expected_frame() const { return last().expected_frame(); }
  // Notes of its smoothing stages, in processing order.
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
  // All engines present, in processing order.
  std::vector<tb::Environment*> parts();
  std::vector<const tb::Environment*> parts() const;
  Boards boards(Boards (tb::Environment::*of)() const) const;
  // Between cycles: starts each engine when its predecessor is done.
  void hand_on();
  // The colour as the frame buffer stores it: no pixel is marked until the first engine marks it.
  tb::Rgba8 unmarked(tb::Rgba8 colour) const;
  void put_sky();
  std::uint64_t pixels() const;

  const FrameRoles& roles_;
  bool follows_;
  std::string_view mesh_title_, rows_title_;
  int width_, height_;
  std::unique_ptr<DrawingStage> drawing_stage_;
  std::unique_ptr<FrameBuffer> buffer_;
  std::vector<std::unique_ptr<MeshStage>> mesh_;  // at most one, unless it is only described
  std::vector<std::unique_ptr<RowStage>> rows_;   //
  std::vector<std::unique_ptr<RowsPort>> unused_ports_;
  bool drawing_ = false, drawn_ = false;  // along the edges of the mesh
  bool followed_ = false;                 // the second engine has started after the first
  rtl::Cycle drawn_from_ = 0, drawn_until_ = 0;
};

}  // namespace deburr::tool
