// SPDX-License-Identifier: MIT
#include "rtl_model/platform/geometric_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "rtl_model/platform/region_check.h"
#include "spec/error.h"

namespace deburr::platform {
namespace {

using spec::geometric::Parameters;
using spec::geometric::Region;
using spec::geometric::Rgba8;
namespace reg = spec::geometric::reg;

constexpr std::uint64_t kLine = spec::geometric::kLineBytes;
constexpr std::uint64_t kAlignment = 4096;
constexpr std::uint64_t kAddresses = std::uint64_t{1} << 32;

constexpr DriverLayout kLayout = {.engine = "geometric engine",
                                  .id = reg::kId,
                                  .id_value = reg::kIdValue,
                                  .control = reg::kControl,
                                  .clear_counters = reg::kControlClearCounters,
                                  .status = reg::kStatus,
                                  .idle = reg::kStatusIdle,
                                  .memory_errors = reg::kMemoryErrors};

constexpr std::size_t index_of(Region region) { return static_cast<std::size_t>(region); }

constexpr std::uint64_t rounded_up(std::uint64_t value, std::uint64_t to) {
  return (value + to - 1) / to * to;
}

}  // namespace

// ---- where things lie ---------------------------------------------------------------------------

GeometricRegions::Bytes GeometricRegions::needed(const GeometricSizes& frame, const Parameters& p) {
  const std::uint64_t pixels = PixelLayout(p.layout, frame.width, frame.height).bytes();
  const auto blocks = [](int size) { return static_cast<std::uint64_t>((size + 3) / 4); };
  Bytes bytes{};
  bytes[index_of(Region::kFaces)] = rounded_up((frame.faces + 7) / 8, kLine);
  bytes[index_of(Region::kEdges)] = rounded_up(frame.edges * spec::geometric::kEdgeBytes, kLine);
  bytes[index_of(Region::kVertices)] =
      rounded_up(frame.vertices * spec::geometric::kVertexBytes, kLine);
  bytes[index_of(Region::kDepth)] = pixels;
  bytes[index_of(Region::kWeights)] = kLine * blocks(frame.width) * blocks(frame.height);
  bytes[index_of(Region::kColour)] = pixels;
  bytes[index_of(Region::kCopy)] = p.frame_copy ? pixels : 0;
  return bytes;
}

GeometricRegions GeometricRegions::allocate(std::span<const GeometricSizes> frames,
                                            const Parameters& p) {
  Bytes most{};
  for (const GeometricSizes& frame : frames) {
    const Bytes bytes = needed(frame, p);
    for (std::size_t i = 0; i < kCount; ++i) most[i] = std::max(most[i], bytes[i]);
  }
  GeometricRegions regions;
  for (std::size_t i = 0; i < kCount; ++i) {
    regions.base_[i] = static_cast<std::uint32_t>(regions.end_);
    regions.end_ += rounded_up(most[i], kAlignment);
  }
  if (regions.end_ > kAddresses)
    throw spec::ConfigError(
        fmt::format("frame and mesh need {} bytes of memory, addresses of 32 bits reach {}: use a "
                    "smaller frame or mesh",
                    regions.end_, kAddresses));
  return regions;
}

std::size_t GeometricRegions::region_of(std::uint64_t address) const {
  if (address >= end_) return kCount;
  const auto behind = std::upper_bound(base_.begin(), base_.end(), address);
  return static_cast<std::size_t>(behind - base_.begin()) - 1;
}

std::uint64_t GeometricRegions::end_of(std::uint64_t address) const {
  const auto behind = std::upper_bound(base_.begin(), base_.end(), address);
  return behind == base_.end() ? end_ : *behind;
}

// ---- a frame ------------------------------------------------------------------------------------

GeometricDriver::GeometricDriver(RegisterBus& registers, HostMemory& memory,
                                 const Parameters& rules)
    : EngineDriver(registers, kLayout), memory_(memory), rules_(rules) {}

void GeometricDriver::set_rules(const Parameters& rules) {
  require_idle("new rules");
  registers_.write(reg::kRules, rules_register(rules));
  rules_ = rules;
}

void GeometricDriver::require_pixels(std::string_view what, std::size_t count,
                                     const GeometricSizes& frame) const {
  if (count != static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height))
    reject(
        fmt::format("{} {} for a frame of {} x {} pixels", count, what, frame.width, frame.height));
}

void GeometricDriver::check(const GeometricFrame& frame) const {
  const GeometricSizes sizes = frame.sizes();
  require_range("width of the frame", static_cast<std::uint64_t>(std::max(0, sizes.width)), 1,
                spec::geometric::kMaxFrameSize);
  require_range("height of the frame", static_cast<std::uint64_t>(std::max(0, sizes.height)), 1,
                spec::geometric::kMaxFrameSize);
  require_range("edges", sizes.edges, 0, spec::geometric::kMaxEdges);
  require_range("vertices", sizes.vertices, 0, spec::geometric::kMaxVertices);
  // Nobody reads facing bits where all edges are drawn.
  const bool all = rules_.select == spec::geometric::Select::kAll;
  require_range("faces", sizes.faces, 0,
                all ? spec::geometric::kIndexMask + 1 : spec::geometric::kMaxFaces);
  if (frame.facing.size() < (sizes.faces + 7) / 8)
    reject(fmt::format("{} bytes of facing bits are too few for {} faces", frame.facing.size(),
                       sizes.faces));
  if (!frame.depths.empty()) require_pixels("depths", frame.depths.size(), sizes);
  if (!frame.colours.empty()) require_pixels("colours", frame.colours.size(), sizes);
  const GeometricRegions::Bytes bytes = GeometricRegions::needed(sizes, rules_);
  std::array<NamedRegion, GeometricRegions::kCount> regions;
  for (std::size_t i = 0; i < regions.size(); ++i)
    regions[i] = {spec::geometric::kRegionNames[i], regions_.base(static_cast<Region>(i)),
                  bytes[i]};
  if (const std::string complaint =
          region_complaint(regions, kLine, std::min(memory_.size(), kAddresses));
      !complaint.empty())
    reject(complaint);
}

void GeometricDriver::load(const GeometricFrame& frame) {
  check(frame);
  sizes_ = frame.sizes();
  fill(Region::kFaces, frame.facing.first((sizes_.faces + 7) / 8));
  fill(Region::kEdges, edge_records(frame.edges));
  fill(Region::kVertices, vertex_records(frame.vertices));
  if (!frame.depths.empty()) load_depths(frame.depths);
  if (!frame.colours.empty()) load_colours(frame.colours);
}

void GeometricDriver::load_depths(std::span<const std::uint32_t> depths) {
  require_pixels("depths", depths.size(), sizes_);
  fill(Region::kDepth, depth_buffer(layout(), depths));
}

void GeometricDriver::load_colours(std::span<const Rgba8> colours) {
  require_pixels("colours", colours.size(), sizes_);
  fill(Region::kColour, colour_buffer(layout(), colours));
}

void GeometricDriver::program() {
  const std::pair<std::uint32_t, std::uint32_t> values[] = {
      {reg::kSize, size_register(static_cast<std::uint32_t>(sizes_.width),
                                 static_cast<std::uint32_t>(sizes_.height))},
      {reg::kEdgeCount, static_cast<std::uint32_t>(sizes_.edges)},
      {reg::kVertexCount, static_cast<std::uint32_t>(sizes_.vertices)},
      {reg::kFaceCount, static_cast<std::uint32_t>(sizes_.faces)},
      {reg::kEdgeBase, regions_.base(Region::kEdges)},
      {reg::kVertexBase, regions_.base(Region::kVertices)},
      {reg::kFaceBase, regions_.base(Region::kFaces)},
      {reg::kDepthBase, regions_.base(Region::kDepth)},
      {reg::kColourBase, regions_.base(Region::kColour)},
      {reg::kWeightBase, regions_.base(Region::kWeights)},
      {reg::kCopyBase, regions_.base(Region::kCopy)}};
  require_idle("sizes and bases");
  for (const auto& [offset, value] : values) registers_.write(offset, value);
}

void GeometricDriver::start() {
  require_idle("START");
  registers_.write(reg::kControl, reg::kControlEnable | reg::kControlStart);
}

void GeometricDriver::require_accepted() {
  const spec::geometric::Refusal why = refusal();
  if (why == spec::geometric::Refusal::kNone) return;
  const auto code = static_cast<std::size_t>(why);
  throw spec::SimulationError(fmt::format(
      "the geometric engine refused to start: {}",
      code < spec::geometric::kRefusalNames.size() ? spec::geometric::kRefusalNames[code] : "?"));
}

// ---- results ------------------------------------------------------------------------------------

spec::geometric::Work GeometricDriver::work() {
  spec::geometric::Work work;
  for (const spec::geometric::WorkCount& each : spec::geometric::kWorkCounts)
    work.*each.count = registers_.read(each.offset);
  return work;
}

GeometricClocks GeometricDriver::clocks() {
  return {registers_.read(reg::kFrameCycles), registers_.read(reg::kEdgeCycles),
          registers_.read(reg::kResolveCycles)};
}

std::uint32_t GeometricDriver::colour_address(int x, int y) const {
  return regions_.base(Region::kColour) + layout().offset_of(x, y);
}

void GeometricDriver::put(int x, int y, const Rgba8& colour) {
  memory_.write(colour_address(x, y), colour);
}

Rgba8 GeometricDriver::pixel(int x, int y) const {
  Rgba8 colour{};
  const std::vector<std::uint8_t> bytes = memory_.read(colour_address(x, y), colour.size());
  std::copy(bytes.begin(), bytes.end(), colour.begin());
  return colour;
}

std::vector<Rgba8> GeometricDriver::picture() const {
  return colours_of(layout(), memory_.read(regions_.base(Region::kColour), layout().bytes()));
}

}  // namespace deburr::platform
