// SPDX-License-Identifier: MIT
// One simulation of a whole frame: a scene through the texture unit into a frame buffer, and out of
// it through the morphological engine. Both engines on one clock, in one elaboration.
//
//   TextureScene ─► Driver ─► TextureUnit ─► FrameBuffer ─► MorphologicalEngine ─► Sink
//                     │        MemoryModel      │                 (MemoryModel)       │
//                     ▼                         ▼                                     ▼
//               texture golden ─► expected colours, fills      morphological golden of the texture
//                                                              golden's frame ─► pixels and taps
//
// The two overlap: the frame buffer hands a row to the morphological engine as soon as every
// fragment of it and of the rows above has come.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <systemc>
#include <vector>

#include "golden/morphological/morphological_golden.h"
#include "golden/texture/texture_golden.h"
#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/morphological/morphological_engine.h"
#include "rtl_model/texture/texture_unit.h"
#include "tb/env/frame_source.h"
#include "tb/env/memory_parameters.h"
#include "tb/env/raster_scoreboard.h"
#include "tb/env/simulation.h"
#include "tb/env/texture_scene.h"
#include "tb/harness/bench.h"
#include "tb/harness/driver.h"
#include "tb/harness/memory_model.h"
#include "tb/harness/register_host.h"
#include "tb/harness/scoreboard.h"
#include "tb/results/result.h"

namespace deburr::tb {

// The frame buffer: takes a colour a clock, gives a beat of a complete row a clock. Its memory is
// not modelled in time. Stalls: `texture` (the next row still lacks fragments), `downstream`.
class FrameBuffer final : public rtl::Unit {
 public:
  rtl::In<spec::texture::Colour> colours_in{"colours_in"};
  rtl::Out<spec::morphological::PixelBeat> pixels_out{"pixels_out"};

  FrameBuffer(const sc_core::sc_module_name& name, rtl::ClockDomain& clock,
              const TextureScene& scene, int lanes);
  rtl::Activity tick(rtl::Cycle cycle) override;
  void reset() override;

  bool done() const { return y_ == input_.image.height; }
  const Image& frame() const { return input_.image; }
  std::function<void(rtl::Cycle, const spec::texture::Colour&)> on_colour;
  rtl::Cycle last_colour() const { return last_colour_; }
  rtl::Cycle first_beat() const { return first_beat_; }
  rtl::Counter bytes_written{"bytes_written", "byte", "bytes of colours written"};
  rtl::Counter bytes_read{"bytes_read", "byte", "bytes of pixels read"};

 private:
  void store(rtl::Cycle cycle, const spec::texture::Colour& colour);
  const TextureScene& scene_;
  int lanes_;
  rtl::Activity waiting_;
  MorphologicalInput input_;
  Image sky_;
  std::vector<std::uint32_t> missing_;  // fragments that each row still lacks
  int x_ = 0, y_ = 0;
  rtl::Cycle last_colour_ = 0, first_beat_ = 0;
};

struct FrameBenchOptions : SimulationOptions {
  spec::texture::Parameters texture;
  MemoryParameters memory;
  spec::morphological::Parameters morphological;
  MemoryParameters frame_memory;  // of the morphological engine, storage = memory
};

// A fault by name, for `--fault`; docs/verification.md says what must catch it.
struct FrameFault {
  std::string_view name, meaning;
  std::string_view link_fault;  // empty: planted in the memory
};
std::span<const FrameFault> frame_faults();

class FrameBench {
 public:
  // Called every few thousand cycles with the numbers of pixels delivered and of pixels that the
  // morphological engine has taken; false ends the run early.
  using Progress = std::function<bool(std::uint64_t pixels, std::uint64_t taken)>;

  // The scene must outlive the bench. ConfigError for wrong parameters.
  FrameBench(const TextureScene& scene, const FrameBenchOptions& options);
  ~FrameBench();
  void run(const Progress& progress = {});
  void check() const;
  void collect(Result& result) const;

  bool complete() const { return complete_; }
  const Image& textured() const { return buffer_.frame(); }
  const Image& smoothed() const { return frame_; }
  std::size_t delivered() const { return position_; }
  const std::vector<spec::morphological::BlendTap>& taps() const { return taps_; }
  const golden::morphological::MorphologicalGolden& golden() const { return smoothing_golden_; }

 private:
  struct Fill {
    std::uint64_t address;
    friend bool operator==(const Fill&, const Fill&) = default;
  };
  void judge(rtl::Cycle cycle, const spec::morphological::BlendedBeat& beat);

  const TextureScene& scene_;
  FrameBenchOptions options_;
  rtl::ClockDomain clock_;
  rtl::Link<spec::texture::Quad> quads_{"quads"};
  rtl::Link<spec::texture::Colour> colours_{"colours"};
  rtl::Link<spec::morphological::PixelBeat> pixels_{"pixels"};
  rtl::Link<spec::morphological::BlendedBeat> blended_{"blended"};
  Driver<spec::texture::Quad> driver_;
  rtl::texture::TextureUnit texture_;
  FrameBuffer buffer_;
  rtl::morphological::MorphologicalEngine engine_;
  Sink<spec::morphological::BlendedBeat> sink_;
  MemoryModel memory_;
  std::unique_ptr<MemoryModel> frame_memory_;
  RegisterHost texture_host_{"texture_host"}, engine_host_{"engine_host"};
  std::unique_ptr<Bench> bench_;

  golden::texture::TextureGolden texture_golden_;
  golden::morphological::MorphologicalGolden smoothing_golden_;
  Scoreboard<spec::texture::Colour> colour_board_;
  Scoreboard<Fill> fill_board_;
  RasterScoreboard<spec::morphological::Rgba8> pixel_board_;
  RasterScoreboard<spec::morphological::BlendTap> tap_board_;
  Scoreboard<spec::morphological::FrameAccess> traffic_board_;
  Image golden_textured_, frame_;
  std::vector<spec::morphological::BlendTap> taps_;
  std::size_t position_ = 0, fills_judged_ = 0;
  rtl::Cycle cycles_ = 0, started_ = 0;
  double host_seconds_ = 0, cpu_seconds_ = 0;
  bool running_ = false, complete_ = false;
};

}  // namespace deburr::tb
