// SPDX-License-Identifier: MIT
#include "tb/engines/geometric/geometric_checks.h"

#include <fmt/format.h>

#include <algorithm>

#include "spec/geometric/registers.h"

namespace deburr::tb {
namespace {

using spec::geometric::BlockRecord;
using spec::geometric::Candidate;
using spec::geometric::LineRecord;
using spec::geometric::MemoryAccess;
using spec::geometric::Region;
using spec::geometric::WorkCount;
namespace reg = spec::geometric::reg;

std::string describe_pixel(const Rgba8& p) {
  return fmt::format("RGBA ({}, {}, {}, {})", p[0], p[1], p[2], p[3]);
}
std::string describe_block(const BlockRecord& b) {
  std::string text = fmt::format("block ({}, {})", b.x, b.y);
  for (std::size_t i = 0; i < b.pixels.size(); ++i)
    if (b.blended >> i & 1)
      text += fmt::format(", pixel {}: {} {} {} {} {}", i, b.weights[i][0], b.weights[i][1],
                          b.weights[i][2], b.weights[i][3], describe_pixel(b.pixels[i]));
  return text;
}
std::string describe_access(const MemoryAccess& access) {
  return fmt::format("{} of address {:#x}", access.write ? "write" : "read", access.address);
}

}  // namespace

GeometricChecks::GeometricChecks(const GeometricSetup& setup,
                                 const platform::GeometricRegions& regions, bool golden)
    : lines("lines", 0),
      candidates("candidates", 0),
      blocks("blocks", 0, describe_block),
      pixels("pixels", describe_pixel),
      traffic("memory lines", 0, describe_access,
              [&regions](const MemoryAccess& access) {
                return 2 * regions.region_of(access.address) + (access.write ? 1 : 0);
              }),
      registers(spec::geometric::kRegisters),
      setup_(setup),
      regions_(regions),
      used_(golden),
      golden_(setup.geometric) {
  candidates.call_items([](const Candidate& c) { return fmt::format("pixel ({}, {})", c.x, c.y); });
  blocks.call_items([](const BlockRecord& b) { return fmt::format("block ({}, {})", b.x, b.y); });
  if (const auto range = error_range(setup.memory))
    golden_.set_memory_errors([range = *range](std::uint32_t line) {
      return range.touches(line, spec::geometric::kLineBytes);
    });
}

void GeometricChecks::clear_counters() {
  work_ = {};
  moved_ = {};
  errors_ = 0;
}

golden::geometric::Bases GeometricChecks::bases() const {
  return {regions_.base(Region::kEdges),  regions_.base(Region::kVertices),
          regions_.base(Region::kFaces),  regions_.base(Region::kDepth),
          regions_.base(Region::kColour), regions_.base(Region::kWeights),
          regions_.base(Region::kCopy),   regions_.base(Region::kPairs),
          regions_.base(Region::kCoarse)};
}

void GeometricChecks::begin(const geometric::Frame& frame) {
  frame_ = &frame;
  layout_ = {setup_.geometric.layout, frame.image.width, frame.image.height};
  reads_checked_ = writes_checked_ = 0;
  if (!used_) return;
  golden_.process(frame.input(bases()));
  for (const LineRecord& line : golden_.lines()) lines.expect(line);
  for (const Candidate& candidate : golden_.candidates()) candidates.expect(candidate);
  for (const BlockRecord& block : golden_.blocks()) blocks.expect(block);
  const auto expect_all = [&](const auto& lists, bool write) {
    for (const auto& list : lists)
      for (const std::uint32_t address : list) traffic.expect({address, write});
  };
  expect_all(golden_.traffic().reads, false);
  expect_all(golden_.traffic().writes, true);
}

void GeometricChecks::restart() {
  reads_checked_ = writes_checked_ = 0;
  lines.restart();
  candidates.restart();
  blocks.restart();
  traffic.restart();
  golden_.clear_coverage();  // a reset occurs only in the first frame
}

void GeometricChecks::got(const LineRecord& line, rtl::Cycle cycle) {
  if (used_) lines.got(line, cycle);
}
void GeometricChecks::got(const Candidate& candidate, rtl::Cycle cycle) {
  if (used_) candidates.got(candidate, cycle);
}
void GeometricChecks::got(const BlockRecord& block, rtl::Cycle cycle) {
  if (used_) blocks.got(block, cycle);
}

void GeometricChecks::check_traffic(const platform::MemoryModel& memory, rtl::Cycle cycle) {
  if (!used_) return;
  const auto check = [&](const std::vector<std::uint64_t>& moved, std::size_t& checked,
                         bool write) {
    for (; checked < moved.size(); ++checked)
      traffic.got({static_cast<std::uint32_t>(moved[checked]), write}, cycle);
  };
  check(memory.lines_read(), reads_checked_, false);
  check(memory.lines_written(), writes_checked_, true);
}

std::uint32_t GeometricChecks::line_offset(int x, int y) const {
  return layout_.offset_of(layout_.line_of(x, y));
}

Image GeometricChecks::expected_frame() const {
  Image expected(frame_->image.width, frame_->image.height);
  expected.pixels = golden_.pixels();
  return expected;
}

void GeometricChecks::end(const Image& after, rtl::Cycle cycle) {
  if (!used_) return;
  expected_ = expected_frame();
  pixels.expect(expected_.pixels, after.width);
  for (const Rgba8& pixel : after.pixels) pixels.got(pixel, cycle);
  for (const WorkCount& each : spec::geometric::kWorkCounts)
    work_.*each.count += golden_.work().*each.count;
  for (std::size_t i = 0; i < moved_.read.size(); ++i) {
    moved_.read[i] += golden_.traffic().reads[i].size();
    moved_.written[i] += golden_.traffic().writes[i].size();
  }
  errors_ += golden_.memory_errors();
}

// Sets the minimum of comparisons from frames and memory; for lines, which a frame may lack, from
// the engine's counter.
void GeometricChecks::finish(const rtl::geometric::GeometricEngine& engine,
                             const platform::MemoryModel& memory, std::uint64_t area,
                             platform::RegisterBus& bus) {
  if (!used_) return;
  const spec::geometric::Work work = engine.work();
  lines.require(work.lines);
  candidates.require(work.candidates);
  blocks.require(work.blocks);
  traffic.require(std::max<std::uint64_t>(1, memory.reads() + memory.writes()));
  pixels.require(area);
  registers.check(bus, expected_registers(engine));
  check_figures(engine, memory);
}

void GeometricChecks::check_figures(const rtl::geometric::GeometricEngine& engine,
                                    const platform::MemoryModel& memory) {
  using rtl::geometric::Client;
  figures.check(engine, engine.memory_port, memory);
  const LinesMoved counted = lines_moved(engine, setup_.geometric.frame_copy);
  for (std::size_t i = 0; i < moved_.read.size(); ++i) {
    const std::string_view region = spec::geometric::kRegionNames[i];
    figures.check(fmt::format("lines_read_{}", region), counted.read[i], moved_.read[i]);
    figures.check(fmt::format("lines_written_{}", region), counted.written[i], moved_.written[i]);
  }
  // Reads whose latency the arbiter measured: per client that is the only reader of a region, and
  // in total.
  constexpr std::pair<Client, Region> kAlone[] = {
      {Client::kFacing, Region::kFaces},      {Client::kEdges, Region::kEdges},
      {Client::kVertices, Region::kVertices}, {Client::kDepth, Region::kDepth},
      {Client::kPairs, Region::kPairs},       {Client::kCoarse, Region::kCoarse}};
  std::uint64_t all = 0;
  for (const Client client : rtl::geometric::clients_of(setup_.geometric)) {
    const std::uint64_t reads = engine.memory_arbiter.read_latency(client).count();
    all += reads;
    for (const auto& [alone, region] : kAlone)
      if (alone == client)
        figures.check(fmt::format("reads of client {}",
                                  rtl::geometric::kClientNames[static_cast<std::size_t>(client)]),
                      reads, moved_.read[static_cast<std::size_t>(region)]);
  }
  figures.check("reads of all clients", all, memory.reads());
}

std::vector<std::pair<std::uint32_t, std::uint64_t>> GeometricChecks::expected_registers(
    const rtl::geometric::GeometricEngine& engine) const {
  const geometric::Frame& frame = *frame_;
  const golden::geometric::Bases at = bases();
  const std::uint64_t boundaries = platform::boundaries_of(frame.screen.edges);
  std::uint32_t status = reg::kStatusIdle | reg::kStatusFrameDone;
  if (errors_ > 0) status |= reg::kStatusMemoryError;
  if (work_.invalid_edges > 0) status |= reg::kStatusInvalidEdge;
  std::vector<std::pair<std::uint32_t, std::uint64_t>> expected = {
      {reg::kId, reg::kIdValue},
      {reg::kControl, reg::kControlEnable},
      {reg::kStatus, status},
      {reg::kSize, spec::geometric::size_word(static_cast<std::uint32_t>(frame.image.width),
                                              static_cast<std::uint32_t>(frame.image.height))},
      {reg::kConfiguration, spec::geometric::configuration_word(setup_.geometric)},
      {reg::kEdgeCount, frame.screen.edges.size()},
      {reg::kVertexCount, frame.screen.vertices.size()},
      {reg::kFaceCount, frame.screen.faces},
      {reg::kEdgeBase, at.edges},
      {reg::kVertexBase, at.vertices},
      {reg::kFaceBase, at.facing},
      {reg::kDepthBase, at.depth},
      {reg::kColourBase, at.colour},
      {reg::kWeightBase, at.weights},
      {reg::kCopyBase, at.copy},
      {reg::kBoundaryCount, boundaries},
      {reg::kPairBase, regions_.base(Region::kPairs)},
      {reg::kOtherPairBase, regions_.other_pairs(boundaries)},
      {reg::kCoarseBase, regions_.base(Region::kCoarse)},
      {reg::kRejection, 0}};
  for (const WorkCount& each : spec::geometric::kWorkCounts)
    expected.emplace_back(each.offset, work_.*each.count);
  expected.emplace_back(reg::kMemoryErrors, errors_);
  // The golden model is untimed, so check only that the registers show the model's counters and
  // that they add up.
  const rtl::geometric::FrameSequencer& sequencer = engine.frame_sequencer;
  const std::uint64_t edge_cycles = sequencer.edge_cycles.value(),
                      resolve_cycles = sequencer.resolve_cycles.value();
  expected.emplace_back(reg::kFrameCycles, edge_cycles + resolve_cycles);
  expected.emplace_back(reg::kEdgeCycles, edge_cycles);
  expected.emplace_back(reg::kResolveCycles, resolve_cycles);
  return expected;
}

}  // namespace deburr::tb
