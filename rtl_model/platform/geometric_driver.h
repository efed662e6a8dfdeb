// SPDX-License-Identifier: MIT
// Software driver of the geometric engine: loads mesh and frame, programs registers, starts, reads
// results.
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
// A driver advances simulated time only through its buses. Overlapping regions, sizes out of
// range and a start while the engine is busy are errors here; the engine itself does not check
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

// Pixels of the frame and records of its mesh; `boundaries`: those among its edges (records =
// split).
struct GeometricSizes {
  int width = 0, height = 0;
  std::uint64_t edges = 0, vertices = 0, faces = 0, boundaries = 0;
};

// Memory contents for a frame. The spans are not owned. Pixel values row by row; an empty span
// leaves the memory unchanged.
struct GeometricFrame {
  int width = 0, height = 0;
  std::span<const spec::geometric::Edge> edges;
  std::span<const spec::geometric::Vertex> vertices;
  std::uint64_t faces = 0;
  std::span<const std::uint8_t> facing;  // one bit per face
  std::span<const std::uint32_t> depths;
  std::span<const spec::geometric::Rgba8> colours;
  GeometricSizes sizes() const {
    return {width, height, edges.size(), vertices.size(), faces, boundaries_of(edges)};
  }
};

// Base addresses of the memory regions.
class GeometricRegions {
 public:
  static constexpr std::size_t kCount = spec::geometric::kRegionNames.size();
  using Bytes = std::array<std::uint64_t, kCount>;  // indexed by spec::geometric::Region

  // All regions at address 0.
  GeometricRegions() = default;
  // Regions at given addresses.
  explicit GeometricRegions(const std::array<std::uint32_t, kCount>& bases) : base_(bases) {}
  // Consecutive regions in the order of Region, at multiples of 4096 from 0 on, large enough for
  // each of the frames. ConfigError if they exceed 32-bit addresses.
  static GeometricRegions allocate(std::span<const GeometricSizes> frames,
                                   const spec::geometric::Parameters& parameters);
  // Bytes that a frame needs in each region.
  static Bytes needed(const GeometricSizes& frame, const spec::geometric::Parameters& parameters);

  // Start of the pairs of edges that are not boundaries.
  std::uint32_t other_pairs(std::uint64_t boundaries) const;
  std::uint32_t base(spec::geometric::Region region) const {
    return base_[static_cast<std::size_t>(region)];
  }
  // End of the allocated regions.
  std::uint64_t bytes() const { return end_; }
  // The allocated region that contains this address; kCount: after all regions.
  std::size_t region_of(std::uint64_t address) const;
  // The end of the allocated region that contains this address.
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
  // Both must outlive the driver. `configuration`: the reset configuration of the engine.
  GeometricDriver(RegisterBus& registers, HostMemory& memory,
                  const spec::geometric::Parameters& configuration);

  // Sets the configuration of the next frame, including `layout` and `frame_copy`.
  void set_configuration(const spec::geometric::Parameters& configuration);
  const spec::geometric::Parameters& configuration() const { return configuration_; }
  void place(const GeometricRegions& regions) { regions_ = regions; }
  const GeometricRegions& regions() const { return regions_; }

  // Writes a frame and its mesh to memory. ConfigError if a size exceeds its register, a span has
  // the wrong length, or regions overlap or exceed the memory.
  void load(const GeometricFrame& frame);
  // Writes only the pixel buffers of the frame loaded last.
  void load_depths(std::span<const std::uint32_t> depths);
  void load_colours(std::span<const spec::geometric::Rgba8> colours);
  void put(int x, int y, const spec::geometric::Rgba8& colour);

  // Writes the sizes and bases of the frame loaded last.
  void program();
  // START. SimulationError while a frame is in progress.
  void start();
  // program() and start().
  void draw() {
    program();
    start();
  }
  // Result of the last start, valid from the next cycle on.
  spec::geometric::Rejection rejection() {
    return static_cast<spec::geometric::Rejection>(
        registers_.read(spec::geometric::reg::kRejection));
  }
  // SimulationError with the reason if the start was rejected.
  void require_accepted();

  // Counts since the counters were cleared.
  spec::geometric::Work work();
  GeometricCycles cycles();
  // Reads the frame from memory.
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
  GeometricSizes sizes_;  // of the frame loaded last
};

}  // namespace deburr::platform
