// SPDX-License-Identifier: MIT
// A whole frame: a scene through the texture unit into a frame buffer, and there through one or two
// engines that smooth it. All with their environments, on one clock.
//
//   TextureEnvironment ─► colours ─► FrameBuffer ─► pixels ─► MorphologicalEnvironment
//                                     │       ▲ rows
//                                     ▼       │
//                                GeometricEnvironment: its memory is the frame buffer then
//
// morphological: the two overlap: the frame buffer hands a row to the morphological engine as soon
// as every fragment of it and of the rows above has come. geometric: the engine begins in the clock
// in which the last fragment has come. geometric-morphological: and rows go out when it is done;
// the frame buffer sets bit 0 of every alpha as it comes, so that only what is blended is marked.
//
// Each engine is judged against its golden model, which gets what the golden model before it made.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "tb/engines/frame/frame_buffer.h"
#include "tb/engines/frame/frame_meter.h"
#include "tb/engines/geometric/geometric_environment.h"
#include "tb/engines/morphological/morphological_environment.h"
#include "tb/engines/texture/texture_environment.h"
#include "tb/env/environment.h"

namespace deburr::tb {

enum class Smoothing : std::uint8_t { kMorphological, kGeometric, kGeometricMorphological };
inline constexpr std::array<std::string_view, 3> kSmoothingNames = {"morphological", "geometric",
                                                                    "geometric-morphological"};
constexpr bool has_geometric(Smoothing s) { return s != Smoothing::kMorphological; }
constexpr bool has_morphological(Smoothing s) { return s != Smoothing::kGeometric; }

struct FrameSetup {
  TextureSetup texture;
  MorphologicalSetup morphological;
  GeometricSetup geometric;
  Smoothing smoothing = Smoothing::kMorphological;
  bool crossings = false;  // of the mesh's faces are edges, too
};

class FrameComposition final : public Environment {
 public:
  // The scene must outlive it. ConfigError for wrong parameters.
  FrameComposition(Simulation& simulation, const TextureScene& scene, const FrameSetup& setup);

  void configure() override;
  bool begin(std::size_t piece) override;
  void watch() override;
  bool done() const override;
  void end() override;
  void restart() override;
  void finish() override;
  void refuse_memory_errors() override;
  void refuse_unused_errors() const override;
  Amount amount() const override;
  bool memory_at_rest() const override;
  Boards outputs() const override;
  Boards traffic() const override;
  Boards counters() const override;
  void collect(Result& result) const override { meter().collect(result); }
  void show_parts(Observer& observer) const override { meter().show_parts(observer); }
  std::vector<PictureMap> maps() const override;
  Coverage coverage() const override;
  void collect_headline(Result& result) const override;

  // What was smoothed so far, how many pixels of it were delivered, and what it should be.
  Image frame() const;
  std::size_t delivered() const;
  Image golden_frame() const;
  // The frame with its edges that the geometric engine's golden model gets.
  const geometric::Frame& edges() const { return geometric_frames_.front(); }

 private:
  Smoothing smoothing_;
  std::vector<geometric::Frame> geometric_frames_;  // one, or none
  std::vector<MorphologicalInput> morphological_frames_;

 public:
  TextureEnvironment texture;
  FrameBuffer buffer;
  std::unique_ptr<GeometricEnvironment> geometric;          // if it smooths
  std::unique_ptr<MorphologicalEnvironment> morphological;  //

 private:
  FrameMeter meter() const;
  // Of all engines that there are, in the order of the frame's way.
  template <class Self, class Visit>
  static void each_part(Self& self, Visit&& visit);
  Boards boards(Boards (Environment::*of)() const) const;
  // Between clocks: engines that begin when the one before them is done.
  void hand_on();
  void put(int x, int y, const Rgba8& colour);
  void put_sky();
  std::uint64_t pixels() const;

  int width_, height_;
  bool drawing_ = false, drawn_ = false;  // by the geometric engine
  bool followed_ = false;                 // the morphological engine has begun behind it
  rtl::Cycle drawn_from_ = 0, drawn_until_ = 0;
};

}  // namespace deburr::tb
