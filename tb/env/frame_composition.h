// SPDX-License-Identifier: MIT
// A whole frame: a scene through the texture unit into a frame buffer, and out of it through the
// morphological engine. Both engines with their environments, on one clock.
//
//   TextureEnvironment ─► colours ─► FrameBuffer ─► pixels ─► MorphologicalEnvironment
//
// The two overlap: the frame buffer hands a row to the morphological engine as soon as every
// fragment of it and of the rows above has come. What is smoothed is judged against the smoothed
// picture of the texture unit's golden model.
#pragma once

#include <string_view>
#include <vector>

#include "tb/env/environment.h"
#include "tb/env/frame_buffer.h"
#include "tb/env/morphological_environment.h"
#include "tb/env/texture_environment.h"

namespace deburr::tb {

struct FrameSetup {
  TextureSetup texture;
  MorphologicalSetup smoothing;
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
  Amount amount() const override { return smoothing.amount(); }
  rtl::Cycle clocks_to_drain() const override;
  Boards outputs() const override;
  Boards traffic() const override;
  Boards counters() const override;
  void collect(Result& result) const override;
  void collect_headline(Result& result) const override;

 private:
  std::vector<MorphologicalInput> golden_frames_;

 public:
  TextureEnvironment texture;
  FrameBuffer buffer;
  MorphologicalEnvironment smoothing;

 private:
  int width_, height_;
  spec::morphological::Parameters smoothing_parameters_;
};

}  // namespace deburr::tb
