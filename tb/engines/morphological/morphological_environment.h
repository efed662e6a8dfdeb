// SPDX-License-Identifier: MIT
// Environment of the morphological engine for one or several frames.
//
//   frames ─► FrameSource ─► MorphologicalEngine ─► Sink ─► pixels, probes
//                                │       └ registers ◄─ RegisterHost
//                            MemoryModel (storage = memory) ─► lines written, lines read
//
//   RegisterHost  writes SIZE; reads the counters at the end
//
// The golden model processes a frame before it is sent. Every output pixel is checked as it
// appears, with its probe of the blend decision (axis, weights, edge bits); optionally also runs
// and lines inside the engine.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <systemc>
#include <vector>

#include "golden/morphological/morphological_golden.h"
#include "rtl_model/morphological/morphological_engine.h"
#include "rtl_model/platform/memory_model.h"
#include "rtl_model/platform/morphological_driver.h"
#include "rtl_model/platform/register_host.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"
#include "tb/engines/morphological/frame_source.h"
#include "tb/engines/morphological/morphological_checks.h"
#include "tb/engines/morphological/morphological_coverage.h"
#include "tb/engines/morphological/morphological_faults.h"
#include "tb/engines/morphological/morphological_history.h"
#include "tb/engines/morphological/morphological_maps.h"
#include "tb/engines/morphological/morphological_meter.h"
#include "tb/engines/morphological/morphological_setup.h"
#include "tb/env/environment.h"
#include "tb/harness/driver.h"

namespace deburr::tb {

class MorphologicalEnvironment final : public Environment {
 public:
  // The golden model processes the frames, which must outlive the environment. With a name it is
  // part of a composition, which sends the frames to `pixels`. Throws ConfigError for invalid
  // parameters or a frame that the engine does not support.
  MorphologicalEnvironment(Simulation& simulation, std::span<const MorphologicalInput> frames,
                           const MorphologicalSetup& setup, std::string name = {});
  ~MorphologicalEnvironment() override;

  void configure() override;
  bool begin(std::size_t piece) override;
  void watch() override;
  bool done() const override;
  void end() override;
  void restart() override;
  void finish() override;
  void reject_memory_errors() override;
  void reject_unused_errors() const override;
  Amount amount() const override;
  bool memory_at_rest() const override { return !memory_ || memory_->at_rest(); }
  Boards outputs() const override;
  Boards traffic() const override;
  Boards counters() const override {
    return {&checks_.registers.board(), &checks_.figures.board()};
  }
  void collect(Result& result) const override { meter_.collect(result); }
  void show_parts(Observer& observer) const override {
    meter_.show_parts(observer, pixels, blended_);
  }
  std::vector<PictureMap> maps() const override;
  std::optional<PixelHistory> pixel_history() const override;
  Coverage coverage() const override { return morphological_coverage(golden_model()); }
  void collect_headline(Result& result) const override {
    meter_.collect_headline(result, simulation().options().clock_mhz);
  }

  rtl::Link<spec::morphological::PixelBeat> pixels;

  const MorphologicalMeter& meter() const { return meter_; }
  std::uint64_t delivered_in_all() const { return progress_.delivered; }
  // For the last frame: the engine's output, and the cycles from its first to its last input beat.
  const Image& frame() const { return frame_; }
  std::size_t delivered() const { return position_; }
  const std::vector<spec::morphological::BlendProbe>& probes() const { return probes_; }
  rtl::Cycle input_cycles() const { return progress_.input_cycles(); }
  // The golden model after all frames so far; unused if SimulationOptions::golden is false.
  const golden::morphological::MorphologicalGolden& golden_model() const {
    return checks_.golden_model();
  }
  // Hash of all pixels and probes in order.
  std::uint64_t pixel_hash() const { return hash_.value(); }

  rtl::morphological::MorphologicalEngine& engine() { return engine_; }
  const rtl::morphological::MorphologicalEngine& engine() const { return engine_; }
  platform::RegisterHost& host() { return host_; }

 private:
  int lanes() const { return platform::lanes_of(setup_.morphological); }
  bool in_memory() const {
    return setup_.morphological.storage == spec::morphological::Storage::kMemory;
  }
  // Name of the memory model and of its parameters; "memory" outside a composition.
  std::string memory_name() const {
    return name().empty() ? "memory" : std::string(kMorphologicalMemory);
  }
  std::unique_ptr<platform::MemoryModel> memory_for(
      std::span<const MorphologicalInput> frames) const;
  spec::morphological::Parameters as_built() const;
  void start();
  void check_output(rtl::Cycle cycle, const spec::morphological::BlendedBeat& beat);

  std::span<const MorphologicalInput> frames_;
  MorphologicalSetup setup_;
  MorphologicalFaults faults_;
  rtl::Link<spec::morphological::BlendedBeat> blended_;
  std::unique_ptr<FrameSource> source_;  // null in a composition
  rtl::morphological::MorphologicalEngine engine_;
  Sink<spec::morphological::BlendedBeat> sink_;
  std::unique_ptr<platform::MemoryModel> memory_;
  platform::RegisterHost host_;
  platform::MorphologicalDriver driver_;
  MorphologicalProgress progress_;
  MorphologicalMeter meter_;
  MorphologicalChecks checks_;

  std::size_t current_ = 0;  // index in frames_
  Image frame_;
  std::vector<spec::morphological::BlendProbe> probes_;
  std::size_t position_ = 0;        // index of the next pixel in the frame
  std::uint64_t taken_before_ = 0;  // beats taken before this frame
  rtl::Cycle first_taken_ = 0;      // cycle in which the engine took this frame's first beat
  OutputHash hash_;
  std::optional<MorphologicalMaps> maps_;
  std::optional<MorphologicalHistory> history_;
  bool ended_ = false;  // the current frame is done
};

}  // namespace deburr::tb
