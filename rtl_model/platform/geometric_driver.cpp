// SPDX-License-Identifier: MIT
#include "rtl_model/platform/geometric_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "rtl_model/platform/region_check.h"
#include "spec/error.h"

namespace deburr::platform {
namespace {

constexpr std::uint64_t kMemoryLine = spec::geometric::kLineBytes;
constexpr std::uint64_t kRegionAlignment = 4096;
constexpr std::uint64_t kAddresses = std::uint64_t{1} << 32;

constexpr std::size_t index_of(spec::geometric::Region region) {
  return static_cast<std::size_t>(region);
}

constexpr std::uint64_t rounded_up(std::uint64_t value, std::uint64_t to) {
  return (value + to - 1) / to * to;
}

}  // namespace

// ---- memory layout ------------------------------------------------------------------------------

GeometricRegions::Bytes GeometricRegions::needed(const GeometricSizes& frame,
                                                 const spec::geometric::Parameters& p) {
  const std::uint64_t pixels = PixelLayout(p.layout, frame.width, frame.height).bytes();
  const auto blocks = [](int size) { return static_cast<std::uint64_t>((size + 3) / 4); };
  Bytes bytes{};
  bytes[index_of(spec::geometric::Region::kFaces)] = rounded_up((frame.faces + 7) / 8, kMemoryLine);
  const bool split = p.records == spec::geometric::RecordsLayout::kSplit;
  bytes[index_of(spec::geometric::Region::kEdges)] =
      split ? split_bytes(frame.edges)
            : rounded_up(frame.edges * spec::geometric::kEdgeBytes, kMemoryLine);
  if (split)
    bytes[index_of(spec::geometric::Region::kPairs)] =
        split_bytes(frame.boundaries) + split_bytes(frame.edges - frame.boundaries);
  bytes[index_of(spec::geometric::Region::kVertices)] =
      rounded_up(frame.vertices * spec::geometric::kVertexBytes, kMemoryLine);
  bytes[index_of(spec::geometric::Region::kDepth)] = pixels;
  bytes[index_of(spec::geometric::Region::kWeights)] =
      kMemoryLine * blocks(frame.width) * blocks(frame.height);
  bytes[index_of(spec::geometric::Region::kColour)] = pixels;
  bytes[index_of(spec::geometric::Region::kCopy)] = p.frame_copy ? pixels : 0;
  if (p.coarse_lines != spec::geometric::CoarseLines::kNone)
    bytes[index_of(spec::geometric::Region::kCoarse)] = coarse_bytes(frame.width, frame.height);
  return bytes;
}

GeometricRegions GeometricRegions::allocate(std::span<const GeometricSizes> frames,
                                            const spec::geometric::Parameters& p) {
  Bytes most{};
  for (const GeometricSizes& frame : frames) {
    const Bytes bytes = needed(frame, p);
    for (std::size_t i = 0; i < kCount; ++i) most[i] = std::max(most[i], bytes[i]);
  }
  GeometricRegions regions;
  for (std::size_t i = 0; i < kCount; ++i) {
    regions.base_[i] = static_cast<std::uint32_t>(regions.end_);
    regions.end_ += rounded_up(most[i], kRegionAlignment);
  }
  if (regions.end_ > kAddresses)
    throw spec::ConfigError(
        fmt::format("frame and mesh need {} bytes of memory, but 32-bit addresses cover {}: use a "
                    "smaller frame or mesh",
                    regions.end_, kAddresses));
  return regions;
}

std::uint32_t GeometricRegions::other_pairs(std::uint64_t boundaries) const {
  return base(spec::geometric::Region::kPairs) +
         static_cast<std::uint32_t>(split_bytes(boundaries));
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
                                 const spec::geometric::Parameters& configuration)
    : EngineDriver(registers, {"geometric engine", spec::geometric::kRegisters}),
      memory_(memory),
      configuration_(configuration) {}

void GeometricDriver::set_configuration(const spec::geometric::Parameters& configuration) {
  require_idle("a new configuration");
  registers_.write(spec::geometric::reg::kConfiguration,
                   spec::geometric::configuration_word(configuration));
  configuration_ = configuration;
}

void GeometricDriver::require_pixels(std::string_view what, std::size_t count,
                                     const GeometricSizes& frame) const {
  if (count != static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height))
    reject(fmt::format("{} {} for a frame of {} x {} pixels: expected one per pixel", count, what,
                       frame.width, frame.height));
}

void GeometricDriver::check(const GeometricFrame& frame) const {
  const GeometricSizes sizes = frame.sizes();
  require_range("width of the frame", static_cast<std::uint64_t>(std::max(0, sizes.width)), 1,
                spec::geometric::kMaxFrameSize);
  require_range("height of the frame", static_cast<std::uint64_t>(std::max(0, sizes.height)), 1,
                spec::geometric::kMaxFrameSize);
  require_range("edges", sizes.edges, 0, spec::geometric::kMaxEdges);
  require_range("vertices", sizes.vertices, 0, spec::geometric::kMaxVertices);
  // Facing bits are read only if they select edges.
  const bool unread = configuration_.select != spec::geometric::Select::kEdges;
  require_range("faces", sizes.faces, 0,
                unread ? spec::geometric::kIndexMask + 1 : spec::geometric::kMaxFaces);
  if (frame.facing.size() < (sizes.faces + 7) / 8)
    reject(fmt::format("{} bytes of facing bits are too few for {} faces", frame.facing.size(),
                       sizes.faces));
  if (!frame.depths.empty()) require_pixels("depths", frame.depths.size(), sizes);
  if (!frame.colours.empty()) require_pixels("colours", frame.colours.size(), sizes);
  const GeometricRegions::Bytes bytes = GeometricRegions::needed(sizes, configuration_);
  std::array<NamedRegion, GeometricRegions::kCount> regions;
  for (std::size_t i = 0; i < regions.size(); ++i)
    regions[i] = {spec::geometric::kRegionNames[i],
                  regions_.base(static_cast<spec::geometric::Region>(i)), bytes[i]};
  if (const std::string complaint =
          region_complaint(regions, kMemoryLine, std::min(memory_.size(), kAddresses));
      !complaint.empty())
    reject(complaint);
}

void GeometricDriver::load(const GeometricFrame& frame) {
  check(frame);
  sizes_ = frame.sizes();
  fill(spec::geometric::Region::kFaces, frame.facing.first((sizes_.faces + 7) / 8));
  if (configuration_.records == spec::geometric::RecordsLayout::kSplit) {
    fill(spec::geometric::Region::kEdges, face_records(frame.edges));
    fill(spec::geometric::Region::kPairs, pair_records(frame.edges, true));
    memory_.write(regions_.other_pairs(sizes_.boundaries), pair_records(frame.edges, false));
  } else {
    fill(spec::geometric::Region::kEdges, edge_records(frame.edges));
  }
  fill(spec::geometric::Region::kVertices, vertex_records(frame.vertices));
  if (!frame.depths.empty()) load_depths(frame.depths);
  if (!frame.colours.empty()) load_colours(frame.colours);
}

void GeometricDriver::load_depths(std::span<const std::uint32_t> depths) {
  require_pixels("depths", depths.size(), sizes_);
  fill(spec::geometric::Region::kDepth, depth_buffer(layout(), depths));
  if (configuration_.coarse_lines != spec::geometric::CoarseLines::kNone)
    fill(spec::geometric::Region::kCoarse, coarse_depth(sizes_.width, sizes_.height, depths));
}

void GeometricDriver::load_colours(std::span<const spec::geometric::Rgba8> colours) {
  require_pixels("colours", colours.size(), sizes_);
  fill(spec::geometric::Region::kColour, colour_buffer(layout(), colours));
}

void GeometricDriver::program() {
  const std::pair<std::uint32_t, std::uint32_t> values[] = {
      {spec::geometric::reg::kSize,
       spec::geometric::size_word(static_cast<std::uint32_t>(sizes_.width),
                                  static_cast<std::uint32_t>(sizes_.height))},
      {spec::geometric::reg::kEdgeCount, static_cast<std::uint32_t>(sizes_.edges)},
      {spec::geometric::reg::kVertexCount, static_cast<std::uint32_t>(sizes_.vertices)},
      {spec::geometric::reg::kFaceCount, static_cast<std::uint32_t>(sizes_.faces)},
      {spec::geometric::reg::kEdgeBase, regions_.base(spec::geometric::Region::kEdges)},
      {spec::geometric::reg::kVertexBase, regions_.base(spec::geometric::Region::kVertices)},
      {spec::geometric::reg::kFaceBase, regions_.base(spec::geometric::Region::kFaces)},
      {spec::geometric::reg::kDepthBase, regions_.base(spec::geometric::Region::kDepth)},
      {spec::geometric::reg::kColourBase, regions_.base(spec::geometric::Region::kColour)},
      {spec::geometric::reg::kWeightBase, regions_.base(spec::geometric::Region::kWeights)},
      {spec::geometric::reg::kCopyBase, regions_.base(spec::geometric::Region::kCopy)},
      {spec::geometric::reg::kBoundaryCount, static_cast<std::uint32_t>(sizes_.boundaries)},
      {spec::geometric::reg::kPairBase, regions_.base(spec::geometric::Region::kPairs)},
      {spec::geometric::reg::kOtherPairBase, regions_.other_pairs(sizes_.boundaries)},
      {spec::geometric::reg::kCoarseBase, regions_.base(spec::geometric::Region::kCoarse)}};
  require_idle("sizes and bases");
  for (const auto& [offset, value] : values) registers_.write(offset, value);
}

void GeometricDriver::start() {
  require_idle("START");
  registers_.write(spec::geometric::reg::kControl,
                   spec::geometric::reg::kControlEnable | spec::geometric::reg::kControlStart);
}

void GeometricDriver::require_accepted() {
  const spec::geometric::Rejection why = rejection();
  if (why == spec::geometric::Rejection::kNone) return;
  const auto code = static_cast<std::size_t>(why);
  throw spec::SimulationError(fmt::format("the geometric engine rejected the start: {}",
                                          code < spec::geometric::kRejectionNames.size()
                                              ? spec::geometric::kRejectionNames[code]
                                              : "?"));
}

// ---- results ------------------------------------------------------------------------------------

spec::geometric::Work GeometricDriver::work() {
  spec::geometric::Work work;
  for (const spec::geometric::WorkCount& each : spec::geometric::kWorkCounts)
    work.*each.count = registers_.read(each.offset);
  return work;
}

GeometricCycles GeometricDriver::cycles() {
  return {registers_.read(spec::geometric::reg::kFrameCycles),
          registers_.read(spec::geometric::reg::kEdgeCycles),
          registers_.read(spec::geometric::reg::kResolveCycles)};
}

std::uint32_t GeometricDriver::colour_address(int x, int y) const {
  return regions_.base(spec::geometric::Region::kColour) + layout().offset_of(x, y);
}

void GeometricDriver::put(int x, int y, const spec::geometric::Rgba8& colour) {
  memory_.write(colour_address(x, y), colour);
}

spec::geometric::Rgba8 GeometricDriver::pixel(int x, int y) const {
  spec::geometric::Rgba8 colour{};
  const std::vector<std::uint8_t> bytes = memory_.read(colour_address(x, y), colour.size());
  std::copy(bytes.begin(), bytes.end(), colour.begin());
  return colour;
}

std::vector<spec::geometric::Rgba8> GeometricDriver::picture() const {
  return colours_of(
      layout(), memory_.read(regions_.base(spec::geometric::Region::kColour), layout().bytes()));
}

}  // namespace deburr::platform
