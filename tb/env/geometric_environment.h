// SPDX-License-Identifier: MIT
// The geometric engine on one or several frames.
//
//   frames ─► MemoryModel ◄─► GeometricEngine ─► lines, candidates, blocks, as they come
//              edges, vertices, facing bits,       └ registers ◄─ RegisterHost: sizes, bases, START
//              depth, colours; weights, copy                                    all of them at the
//              end
//
// The golden model works on a frame before it begins. What the engine's observers see is judged as
// it comes, so are the lines of memory that it reads and writes, each region's in order; when the
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
#include "spec/geometric/packets.h"
#include "spec/geometric/parameters.h"
#include "tb/engines/geometric/geometric_stimuli.h"
#include "tb/env/environment.h"
#include "tb/env/geometric_maps.h"
#include "tb/env/memory_parameters.h"
#include "tb/env/raster_scoreboard.h"

namespace deburr::tb {

struct GeometricSetup {
  spec::geometric::Parameters geometric;
  MemoryParameters memory;
};

// Where things lie in memory: the regions follow each other at multiples of 4096, in their order.
class RegionMap {
 public:
  static constexpr std::size_t kRegions = spec::geometric::kRegionNames.size();
  // Room for each of the frames. ConfigError if addresses of 32 bits do not reach.
  RegionMap(std::span<const geometric::Frame> frames,
            const spec::geometric::Parameters& parameters);
  std::uint32_t base(spec::geometric::Region region) const {
    return static_cast<std::uint32_t>(begin_[static_cast<std::size_t>(region)]);
  }
  std::uint64_t bytes() const { return begin_.back(); }
  golden::geometric::Bases bases() const;
  // kRegions: behind all of them.
  std::size_t region_of(std::uint64_t address) const;

 private:
  std::array<std::uint64_t, kRegions + 1> begin_{};
};

class GeometricEnvironment final : public Environment {
 public:
  // The frames, which must outlive it, are what the golden model smooths. With a name it is part of
  // a composition, which puts the colours into memory and says when they are complete: put(),
  // draw(). ConfigError for wrong parameters or a frame that the engine does not take.
  GeometricEnvironment(Simulation& simulation, std::span<const geometric::Frame> frames,
                       const GeometricSetup& setup, std::string name = {});

  void configure() override;
  bool begin(std::size_t piece) override;
  void watch() override;
  bool done() const override { return started_ && engine_.idle(); }
  void end() override;
  void restart() override;
  void finish() override;
  void refuse_memory_errors() override;
  void refuse_unused_errors() const override;
  Amount amount() const override;
  bool memory_at_rest() const override { return memory_.at_rest(); }
  Boards outputs() const override;
  Boards traffic() const override { return {&traffic_board_}; }
  Boards counters() const override { return {&register_board_.board()}; }
  void collect(Result& result) const override;
  void show_parts(Observer& observer) const override;
  std::vector<PictureMap> maps() const override;
  Coverage coverage() const override;
  void collect_headline(Result& result) const override;

  // ---- the frame in memory, without time; for a composition
  void put(int x, int y, const Rgba8& colour);
  Rgba8 pixel(int x, int y) const;
  // The frame is complete: the engine begins in the next clock. Alone, begin() does it.
  void draw();

  // Of its work, for the report of a composition too.
  std::vector<Figure> work_figures() const;
  // The frame as it is in memory, and as it should be when the engine is done.
  Image frame() const;
  Image expected_frame() const;
  // Clocks below which no frame of the work done so far can be drawn.
  std::uint64_t frame_clocks_bound() const;
  // Weights of the last frame's blended pixels, as the engine resolved them.
  const std::vector<spec::geometric::BlockRecord>& blocks() const { return blocks_; }
  // The golden model, which has seen every frame (none without golden).
  const golden::geometric::GeometricGolden& golden_model() const { return golden_; }
  // Over all pixels of all frames in order.
  std::uint64_t pixel_hash() const { return hash_.value(); }
  std::uint64_t frames_done() const { return frames_done_; }

  rtl::geometric::GeometricEngine& engine() { return engine_; }
  const rtl::geometric::GeometricEngine& engine() const { return engine_; }
  RegisterHost& host() { return host_; }
  MemoryModel& memory() { return memory_; }
  const RegionMap& regions() const { return regions_; }

 private:
  std::vector<PlantedFault> faults() const;
  spec::geometric::Parameters as_built() const;
  void plant_in_table();
  std::optional<std::uint32_t> face_of_a_fault() const;
  std::optional<std::size_t> block_that_takes_from_above() const;
  // Of the model and of its parameters; memory alone is called that.
  std::string memory_name() const { return name().empty() ? "memory" : "geometric_memory"; }
  const geometric::Frame& current() const { return frames_[current_]; }
  golden::geometric::FrameLayout layout() const;
  std::uint32_t colour_address(int x, int y) const;
  void observe();
  void load();
  void expect();
  void judge_traffic();
  void judge_frame();
  void judge_registers();
  std::vector<std::pair<std::uint32_t, std::uint64_t>> expected_registers();

  std::span<const geometric::Frame> frames_;
  GeometricSetup setup_;
  RegionMap regions_;
  rtl::geometric::GeometricEngine engine_;
  MemoryModel memory_;
  RegisterHost host_;

  golden::geometric::GeometricGolden golden_;
  spec::geometric::Work golden_work_;  // of all frames since the last reset
  std::uint64_t golden_errors_ = 0;
  Scoreboard<spec::geometric::LineRecord> line_board_;
  Scoreboard<spec::geometric::Candidate> candidate_board_;
  Scoreboard<spec::geometric::BlockRecord> block_board_;
  RasterScoreboard<Rgba8> pixel_board_;
  Scoreboard<spec::geometric::MemoryAccess> traffic_board_;
  RegisterScoreboard register_board_;

  std::size_t current_ = 0;  // of frames_
  bool started_ = false;
  Image expected_;
  std::vector<spec::geometric::BlockRecord> blocks_;
  std::size_t reads_judged_ = 0, writes_judged_ = 0;
  std::uint64_t frames_done_ = 0, edges_done_ = 0, edge_clocks_ = 0, resolve_clocks_ = 0;
  OutputHash hash_;
  std::optional<GeometricMaps> maps_;
};

}  // namespace deburr::tb
