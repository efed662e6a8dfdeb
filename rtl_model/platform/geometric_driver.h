// SPDX-License-Identifier: MIT
// The geometric engine as software sees it: mesh and frame into memory, registers, START, results.
//
//   GeometricDriver driver(registers, memory, parameters);      // as the engine was built
//   driver.identify();
//   driver.place(GeometricRegions::allocate(sizes, parameters));
//   driver.load(frame);
//   driver.start();
//   // ... until driver.idle()
//   driver.require_accepted();
//   picture = driver.picture();
//
// A driver takes no simulated time but what its buses take. Regions that overlap, sizes out of
// range and a start while the engine is busy are errors here; the engine checks none of the
// regions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "rtl_model/platform/engine_driver.h"
#include "rtl_model/platform/geometric_records.h"
#include "rtl_model/platform/host.h"
#include "spec/geometric/packets.h"
#include "spec/geometric/parameters.h"
#include "spec/geometric/registers.h"

namespace deburr::platform {

// Pixels of the frame, records of its mesh; of its edges the boundaries (records = split).
struct GeometricSizes {
  int width = 0, height = 0;
  std::uint64_t edges = 0, vertices = 0, faces = 0, boundaries = 0;
};

// What lies in memory for a frame; spans are someone else's. Values of pixels row by row; empty:
// what is there stays.
struct GeometricFrame {
  int width = 0, height = 0;
  std::span<const spec::geometric::Edge> edges;
  std::span<const spec::geometric::Vertex> vertices;
  std::uint64_t faces = 0;
  std::span<const std::uint8_t> facing;  // a bit a face
  std::span<const std::uint32_t> depths;
  std::span<const spec::geometric::Rgba8> colours;
  GeometricSizes sizes() const {
    return {width, height, edges.size(), vertices.size(), faces, boundaries_of(edges)};
  }
};

// Where the regions begin.
class GeometricRegions {
 public:
  static constexpr std::size_t kCount = spec::geometric::kRegionNames.size();
  using Bytes = std::array<std::uint64_t, kCount>;  // by spec::geometric::Region

  // Everything at address 0.
  GeometricRegions() = default;
  // At these addresses.
  explicit GeometricRegions(const std::array<std::uint32_t, kCount>& bases) : base_(bases) {}
  // Behind each other in the order of Region, at multiples of 4096 from 0 on, with room for each of
  // the frames. ConfigError if addresses of 32 bits do not reach.
  static GeometricRegions allocate(std::span<const GeometricSizes> frames,
                                   const spec::geometric::Parameters& parameters);
  // What a frame needs of each.
  static Bytes needed(const GeometricSizes& frame, const spec::geometric::Parameters& parameters);

  // Where the pairs of edges that are no boundaries begin.
  std::uint32_t other_pairs(std::uint64_t boundaries) const;
  std::uint32_t base(spec::geometric::Region region) const {
    return base_[static_cast<std::size_t>(region)];
  }
  // The end of what was allocated.
  std::uint64_t bytes() const { return end_; }
  // Of what was allocated, the region with this address; kCount: behind all of them.
  std::size_t region_of(std::uint64_t address) const;
  // Of what was allocated, where the region with this address ends.
  std::uint64_t end_of(std::uint64_t address) const;

 private:
  std::array<std::uint32_t, kCount> base_{};
  std::uint64_t end_ = 0;
};

// Cycles of the last frame.
struct GeometricCycles {
  std::uint32_t frame = 0, edges = 0, resolve = 0;
};

class GeometricDriver final : public EngineDriver {
 public:
  // Both must outlive the driver. `rules`: those that the engine has from its reset on.
  GeometricDriver(RegisterBus& registers, HostMemory& memory,
                  const spec::geometric::Parameters& configuration);

  // The rules of the next frame, `layout` and `frame_copy` among them.
  void set_configuration(const spec::geometric::Parameters& configuration);
  const spec::geometric::Parameters& configuration() const { return configuration_; }
  void place(const GeometricRegions& regions) { regions_ = regions; }
  const GeometricRegions& regions() const { return regions_; }

  // Writes a frame and its mesh to memory. ConfigError for sizes that registers do not hold, spans
  // of another length, regions that overlap or do not fit into memory.
  void load(const GeometricFrame& frame);
  // The buffers of pixels alone, of the frame that was loaded last.
  void load_depths(std::span<const std::uint32_t> depths);
  void load_colours(std::span<const spec::geometric::Rgba8> colours);
  void put(int x, int y, const spec::geometric::Rgba8& colour);

  // Writes sizes and bases of the frame that was loaded last.
  void program();
  // START. SimulationError while a frame is under way.
  void start();
  // Both.
  void draw() {
    program();
    start();
  }
  // Of the last start, from the clock after it on.
  spec::geometric::Rejection rejection() {
    return static_cast<spec::geometric::Rejection>(
        registers_.read(spec::geometric::reg::kRejection));
  }
  // SimulationError, with the reason, if it was rejected.
  void require_accepted();

  // Since the counters were cleared.
  spec::geometric::Work work();
  GeometricCycles cycles();
  // The frame as it is in memory.
  std::vector<spec::geometric::Rgba8> picture() const;
  spec::geometric::Rgba8 pixel(int x, int y) const;
  std::uint32_t colour_address(int x, int y) const;
  PixelLayout layout() const { return {configuration_.layout, sizes_.width, sizes_.height}; }

 private:
  void check(const GeometricFrame& frame) const;
  void require_pixels(std::string_view what, std::size_t count, const GeometricSizes& frame) const;
  void fill(spec::geometric::Region region, std::span<const std::uint8_t> bytes) {
    memory_.write(regions_.base(region), bytes);
  }

  HostMemory& memory_;
  spec::geometric::Parameters configuration_;
  GeometricRegions regions_;
  GeometricSizes sizes_;  // of the frame that was loaded last
};

}  // namespace deburr::platform
