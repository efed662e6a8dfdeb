// SPDX-License-Identifier: MIT
// Environment of the geometric engine for one or several frames.
//
//   frames ─► MemoryModel ◄─► GeometricEngine ─► lines, candidates, blocks
//                                    └ registers ◄─ RegisterHost
//
//   MemoryModel   edges, vertices, facing bits, depth, colours, weights, copy
//   RegisterHost  writes sizes, bases and START; reads all registers at the end
//
// The golden model processes a frame before the engine starts it. Observed lines, candidates and
// blocks are checked as they appear, as are the memory lines of each region in order; when the
// frame is done, every pixel in memory.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <systemc>
#include <vector>

#include "golden/geometric/geometric_golden.h"
#include "rtl_model/geometric/geometric_engine.h"
#include "rtl_model/platform/geometric_driver.h"
#include "rtl_model/platform/memory_model.h"
#include "rtl_model/platform/register_host.h"
#include "spec/geometric/packets.h"
#include "tb/engines/geometric/geometric_checks.h"
#include "tb/engines/geometric/geometric_faults.h"
#include "tb/engines/geometric/geometric_history.h"
#include "tb/engines/geometric/geometric_maps.h"
#include "tb/engines/geometric/geometric_meter.h"
#include "tb/engines/geometric/geometric_setup.h"
#include "tb/engines/geometric/geometric_stimuli.h"
#include "tb/env/environment.h"

namespace deburr::tb {

// Allocates memory for the largest frame. Throws ConfigError if 32-bit addresses are not enough.
platform::GeometricRegions regions_of(std::span<const geometric::Frame> frames,
                                      const spec::geometric::Parameters& parameters);

class GeometricEnvironment final : public Environment {
 public:
  // The golden model processes the frames, which must outlive the environment. With a name it is
  // part of a composition, which writes the colours to memory with put() and starts the engine with
  // draw(). Throws ConfigError for invalid parameters or a frame that the engine does not support.
  GeometricEnvironment(Simulation& simulation, std::span<const geometric::Frame> frames,
                       const GeometricSetup& setup, std::string name = {});
  ~GeometricEnvironment() override;

  void configure() override;
  bool begin(std::size_t piece) override;
  void watch() override;
  bool done() const override { return started_ && engine_.idle(); }
  void end() override;
  void restart() override;
  void finish() override;
  void reject_memory_errors() override;
  void reject_unused_errors() const override;
  Amount amount() const override;
  bool memory_at_rest() const override { return memory_.at_rest(); }
  Boards outputs() const override;
  Boards traffic() const override { return {&checks_.traffic}; }
  Boards counters() const override {
    return {&checks_.registers.board(), &checks_.figures.board()};
  }
  void collect(Result& result) const override { meter_.collect(result); }
  void show_parts(Observer& observer) const override { meter_.show_parts(observer); }
  std::vector<PictureMap> maps() const override;
  std::optional<PixelHistory> pixel_history() const override;
  Coverage coverage() const override;
  void collect_headline(Result& result) const override {
    meter_.collect_headline(result, simulation().options().clock_mhz);
  }

  // ---- the frame in memory, untimed; for compositions
  void put(int x, int y, const Rgba8& colour) { driver_.put(x, y, colour); }
  // Call when the frame is complete: the engine starts in the next cycle. Without a composition
  // begin() calls it.
  void draw();

  // The frame in memory, and the expected one when the engine is done.
  Image frame() const;
  Image expected_frame() const { return checks_.expected_frame(); }
  // Weights of the last frame's blended pixels, as the resolver used them.
  const std::vector<spec::geometric::BlockRecord>& blocks() const { return blocks_; }
  // The golden model after all frames so far; unused if SimulationOptions::golden is false.
  const golden::geometric::GeometricGolden& golden_model() const { return checks_.golden_model(); }
  // Hash of all pixels of all frames in order.
  std::uint64_t pixel_hash() const { return hash_.value(); }
  const GeometricMeter& meter() const { return meter_; }

  rtl::geometric::GeometricEngine& engine() { return engine_; }
  const rtl::geometric::GeometricEngine& engine() const { return engine_; }
  platform::RegisterHost& host() { return host_; }
  platform::MemoryModel& memory() { return memory_; }
  const platform::GeometricDriver& driver() const { return driver_; }

 private:
  // Name of the memory model and of its parameters; "memory" outside a composition.
  std::string memory_name() const {
    return name().empty() ? "memory" : std::string(kGeometricMemory);
  }
  const geometric::Frame& current() const { return frames_[current_]; }
  spec::geometric::Parameters as_built() const;
  void observe();
  void load();
  using LinesByRegion = std::array<std::uint64_t, platform::GeometricRegions::kCount>;
  // Lines of all frames that memory answered with an error.
  LinesByRegion error_lines() const;

  std::span<const geometric::Frame> frames_;
  GeometricSetup setup_;
  GeometricFaults faults_;
  platform::GeometricRegions regions_;
  rtl::geometric::GeometricEngine engine_;
  platform::MemoryModel memory_;
  platform::RegisterHost host_;
  platform::GeometricDriver driver_;
  GeometricMeter meter_;
  GeometricChecks checks_;

  std::size_t current_ = 0;  // index in frames_
  bool started_ = false;
  std::vector<spec::geometric::BlockRecord> blocks_;
  OutputHash hash_;
  std::optional<GeometricMaps> maps_;
  std::optional<GeometricHistory> history_;
  bool ended_ = false;           // the current frame is done
  LinesByRegion error_lines_{};  // of earlier frames
};

}  // namespace deburr::tb
