// SPDX-License-Identifier: MIT
#include "tb/env/geometric_environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

#include "golden/geometric/classify.h"
#include "golden/geometric/configuration.h"
#include "golden/geometric/resolve.h"
#include "spec/error.h"
#include "spec/geometric/registers.h"
#include "tb/env/collect.h"
#include "tb/env/geometric_coverage.h"
#include "tb/stimuli/random.h"

namespace deburr::tb {
namespace {

using golden::geometric::FrameLayout;
using spec::geometric::BlockRecord;
using spec::geometric::Candidate;
using spec::geometric::Direction;
using spec::geometric::Edge;
using spec::geometric::LineRecord;
using spec::geometric::MemoryAccess;
using spec::geometric::Parameters;
using spec::geometric::Region;
using spec::geometric::Rgba8;
using spec::geometric::Vertex;
using spec::geometric::WorkCount;
namespace reg = spec::geometric::reg;
namespace flag = spec::geometric::flag;

constexpr std::uint64_t kLine = spec::geometric::kLineBytes;
constexpr std::uint64_t kRegionAlignment = 4096;
constexpr std::uint64_t kAddresses = std::uint64_t{1} << 32;
constexpr double kPortBound = 0.9;  // from here on the port is what a run waits for
constexpr std::uint64_t kDividerClocks = 13;

template <class Enum>
constexpr std::size_t index_of(Enum value) {
  return static_cast<std::size_t>(value);
}

std::uint64_t lines_for(std::uint64_t records, std::uint64_t in_line) {
  return (records + in_line - 1) / in_line;
}

void put_word(std::vector<std::uint8_t>& bytes, std::uint32_t word) {
  for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(word >> (8 * i)));
}
void put_word(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint32_t word) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(word >> (8 * i));
}

std::vector<std::uint8_t> in_memory(std::span<const Edge> edges) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(edges.size() * spec::geometric::kEdgeBytes);
  for (const Edge& e : edges)
    for (const std::uint32_t word :
         {e.v0, e.v1, e.f0 | std::uint32_t{e.flags} << spec::geometric::kFlagShift, e.f1})
      put_word(bytes, word);
  return bytes;
}

std::vector<std::uint8_t> in_memory(std::span<const Vertex> vertices) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(vertices.size() * spec::geometric::kVertexBytes);
  for (const Vertex& v : vertices)
    for (const std::uint32_t word :
         {static_cast<std::uint32_t>(v.x), static_cast<std::uint32_t>(v.y), v.depth,
          std::uint32_t{v.usable}})
      put_word(bytes, word);
  return bytes;
}

std::vector<std::uint8_t> in_memory(const FrameLayout& layout, int width,
                                    std::span<const std::uint32_t> depths) {
  std::vector<std::uint8_t> bytes(layout.bytes());
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const auto x = static_cast<int>(i % static_cast<std::size_t>(width)),
               y = static_cast<int>(i / static_cast<std::size_t>(width));
    put_word(bytes, layout.offset_of(x, y), depths[i]);
  }
  return bytes;
}

std::vector<std::uint8_t> in_memory(const FrameLayout& layout, const Image& image) {
  std::vector<std::uint8_t> bytes(layout.bytes());
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Rgba8& pixel = image.at(x, y);
      std::copy(pixel.begin(), pixel.end(),
                bytes.begin() + static_cast<std::ptrdiff_t>(layout.offset_of(x, y)));
    }
  return bytes;
}

std::uint32_t rules_register(const Parameters& p) {
  const auto code = [](auto value, int shift) {
    return static_cast<std::uint32_t>(value) << shift;
  };
  return code(p.select, 0) | code(p.crease, 2) | code(p.depth_test, 4) | code(p.combine, 6) |
         code(p.linear_light, 7) | code(p.depth_bias, 8) | code(p.mark, 13) | code(p.layout, 14) |
         code(p.frame_copy, 15);
}

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

spec::geometric::CacheLines other_size(spec::geometric::CacheLines lines) {
  using spec::geometric::CacheLines;
  return lines == CacheLines::k16 ? CacheLines::k32 : static_cast<CacheLines>(index_of(lines) - 1);
}

std::uint64_t words_of(spec::geometric::CacheLines lines) {
  return spec::geometric::kCacheLineCount[index_of(lines)];
}
std::uint64_t count_of(spec::geometric::Lanes lanes) {
  return spec::geometric::kLaneCount[index_of(lanes)];
}

// Lines of memory by region, from the counters of the units that move them.
struct LinesMoved {
  std::array<std::uint64_t, RegionMap::kRegions> read{}, written{};
};

LinesMoved lines_moved(const rtl::geometric::GeometricEngine& engine, bool frame_copy) {
  LinesMoved lines;
  const auto read = [&](Region region) -> std::uint64_t& { return lines.read[index_of(region)]; };
  const auto written = [&](Region region) -> std::uint64_t& {
    return lines.written[index_of(region)];
  };
  read(Region::kFaces) = engine.facing_store.lines_read.value();
  read(Region::kEdges) = engine.edge_reader.lines_read.value();
  read(Region::kVertices) = engine.vertex_fetch.misses.value();
  read(Region::kDepth) = engine.depth_test.misses.value();
  read(Region::kWeights) =
      engine.weight_combiner.blocks_read.value() + engine.block_fetch.weights_read.value();
  read(frame_copy ? Region::kCopy : Region::kColour) = engine.block_fetch.lines_read.value();
  read(Region::kColour) += engine.frame_copier.lines_copied.value();
  written(Region::kWeights) = engine.weight_combiner.blocks_written.value();
  written(Region::kColour) = engine.resolver.lines_written.value();
  written(Region::kCopy) = engine.frame_copier.lines_copied.value();
  return lines;
}

// Clocks below which no frame of this work can be done (docs/geometric_hardware.md, "Clocks"), from
// what the engine counted in `frames` of the same size.
std::uint64_t clocks_bound(const rtl::geometric::GeometricEngine& e, const GeometricSetup& setup,
                           const geometric::Frame& frame, std::uint64_t frames) {
  const Parameters& p = setup.geometric;
  const spec::geometric::Work work = e.work();
  const LinesMoved lines = lines_moved(e, p.frame_copy);
  const auto read = [&](Region region) { return lines.read[index_of(region)]; };
  const auto written = [&](Region region) { return lines.written[index_of(region)]; };
  const auto words = static_cast<std::uint64_t>(
      golden::geometric::touched_words(frame.image.width, frame.image.height));
  std::uint64_t begin = std::max(
      {words, words_of(p.vertex_lines), words_of(p.depth_lines), words_of(p.weight_blocks)});
  if (p.select == spec::geometric::Select::kEdges)
    begin = std::max(begin, lines_for(frame.screen.faces, spec::geometric::kFacesInLine) +
                                static_cast<std::uint64_t>(setup.memory.latency));
  const std::uint64_t divided = work.lines - e.line_setup.table_lines.value();
  const std::uint64_t resolve_weights = e.block_fetch.weights_read.value(),
                      colours = e.block_fetch.lines_read.value();
  const std::uint64_t edges_phase = std::max(
      {lines_for(work.edges, count_of(p.edge_lanes)), work.kept_edges, read(Region::kVertices),
       p.pipelined ? work.lines : kDividerClocks * divided / static_cast<std::uint64_t>(p.dividers),
       work.groups, lines_for(e.depth_test.lookups.value(), 2), read(Region::kDepth),
       read(Region::kEdges) + read(Region::kVertices) + read(Region::kDepth) +
           read(Region::kWeights) - resolve_weights + written(Region::kWeights) +
           2 * written(Region::kCopy)});
  const std::uint64_t resolve_phase =
      std::max({words * frames, work.blocks, resolve_weights + colours + written(Region::kColour),
                lines_for(work.blended_pixels, count_of(p.resolve_lanes))});
  return begin * frames + edges_phase + resolve_phase;
}

// Clocks of 1/60 s that a frame may take, in MHz.
double clock_for_60(std::uint64_t frame_clocks) { return number(frame_clocks) * 60 / 1e6; }

}  // namespace

// ---- where things lie ---------------------------------------------------------------------------

RegionMap::RegionMap(std::span<const geometric::Frame> frames, const Parameters& p) {
  std::array<std::uint64_t, kRegions> bytes{};
  for (const geometric::Frame& frame : frames) {
    const FrameLayout layout(p.layout, frame.image.width, frame.image.height);
    const auto need = [&](Region region, std::uint64_t size) {
      bytes[index_of(region)] = std::max(bytes[index_of(region)], size);
    };
    need(Region::kFaces, kLine * lines_for(frame.screen.faces, spec::geometric::kFacesInLine));
    need(Region::kEdges,
         kLine * lines_for(frame.screen.edges.size(), spec::geometric::kEdgesInLine));
    need(Region::kVertices,
         kLine * lines_for(frame.screen.vertices.size(), spec::geometric::kVerticesInLine));
    need(Region::kDepth, layout.bytes());
    need(Region::kWeights, kLine * static_cast<std::uint64_t>(layout.block_columns()) *
                               static_cast<std::uint64_t>(layout.block_rows()));
    need(Region::kColour, layout.bytes());
    need(Region::kCopy, p.frame_copy ? layout.bytes() : 0);
  }
  for (std::size_t i = 0; i < kRegions; ++i)
    begin_[i + 1] = begin_[i] + lines_for(bytes[i], kRegionAlignment) * kRegionAlignment;
  if (begin_.back() > kAddresses)
    throw spec::ConfigError(
        fmt::format("frame and mesh need {} bytes of memory, addresses of 32 bits reach {}: use a "
                    "smaller frame "
                    "or mesh",
                    begin_.back(), kAddresses));
}

golden::geometric::Bases RegionMap::bases() const {
  return {base(Region::kEdges), base(Region::kVertices), base(Region::kFaces),
          base(Region::kDepth), base(Region::kColour),   base(Region::kWeights),
          base(Region::kCopy)};
}

std::size_t RegionMap::region_of(std::uint64_t address) const {
  const auto behind = std::upper_bound(begin_.begin(), begin_.end(), address);
  return static_cast<std::size_t>(behind - begin_.begin()) - 1;
}

// ---- building -----------------------------------------------------------------------------------

// A face of the first edge of two faces, whose class goes by it.
std::optional<std::uint32_t> GeometricEnvironment::face_of_a_fault() const {
  if (setup_.geometric.select == spec::geometric::Select::kAll || frames_.empty())
    return std::nullopt;
  const ScreenEdges& screen = frames_.front().screen;
  for (const Edge& edge : screen.edges)
    if (!(edge.flags & flag::kBoundary) && edge.f0 < screen.faces) return edge.f0;
  return std::nullopt;
}

// The number of a block with a pixel that takes from a blended one in the block above, and would be
// another if it took that as it is now. The block above was written long before: lines are read
// ahead, and what was read before it was written is not stale.
std::optional<std::size_t> GeometricEnvironment::block_that_takes_from_above() const {
  constexpr int kInside = 16;  // blocks in the stages of the resolve
  if (frames_.empty() || setup_.geometric.frame_copy) return std::nullopt;
  const std::int32_t ahead = kInside + setup_.geometric.resolve_lines / 4 +
                             std::max(setup_.memory.latency, setup_.memory.latency_max);
  const geometric::Frame& frame = frames_.front();
  golden::geometric::GeometricGolden golden(setup_.geometric);
  const std::vector<Rgba8>& after = golden.process(frame.input());
  std::map<std::pair<int, int>, int> numbers;  // of the blocks, by row and column
  for (int i = 0; i < static_cast<int>(golden.blocks().size()); ++i) {
    const BlockRecord& block = golden.blocks()[static_cast<std::size_t>(i)];
    numbers[{block.y, block.x}] = i;
    const auto above = numbers.find({block.y - 1, block.x});
    if (above == numbers.end() || above->second + ahead > i) continue;
    for (std::size_t k = 0; k < spec::geometric::kBlockSize; ++k) {
      const golden::geometric::Tap tap = golden::geometric::tap_of(block.weights[k]);
      if (tap.left_right || tap.first == 0) continue;
      const int x = 4 * block.x + static_cast<int>(k), y = 4 * block.y;
      const Rgba8 &pixel = frame.image.at(x, y),
                  &below = tap.second != 0 ? frame.image.at(x, y + 1) : pixel;
      const Rgba8& stale = after[frame.image.index(x, y - 1)];
      if (golden::geometric::resolve(setup_.geometric, tap, pixel, stale, below) !=
          after[frame.image.index(x, y)])
        return static_cast<std::size_t>(i);
    }
  }
  return std::nullopt;
}

std::vector<PlantedFault> GeometricEnvironment::faults() const {
  const Parameters& p = setup_.geometric;
  const auto unless = [](bool there, std::string needs) {
    return there ? std::string() : std::move(needs);
  };
  const std::string tested = unless(p.depth_test != spec::geometric::DepthTest::kOff,
                                    "geometric.depth_test = own, farther");
  std::string stale_neighbour;
  if (planted("stale-neighbour"))
    if (const auto block = block_that_takes_from_above())
      stale_neighbour = fmt::format("flip:geometric.touched_blocks:{}:above", *block);
  std::vector<PlantedFault> list = {
      {"wrong-facing", "Flips the facing bit of a face.", "",
       unless(face_of_a_fault().has_value(), "geometric.select = edges, an edge of two faces")},
      {"wrong-slope", "Flips the lowest bit of every reciprocal in the table.", "",
       unless(p.reciprocal_table > 0, "geometric.reciprocal_table of at least 1")},
      {"drop-line", "Drops line 5 on its way to the walkers.",
       "drop:geometric.line_fifo_entries:5"},
      {"duplicate-line", "Walks line 5 twice.", "duplicate:geometric.line_fifo_entries:5"},
      {"drop-group", "Drops a group of candidates.", "drop:geometric.candidates:20"},
      {"duplicate-group", "Tests and draws a group of candidates twice.",
       "duplicate:geometric.candidates:20"},
      {"wrong-direction", "A group of candidates takes its neighbours along the other axis.",
       "flip:geometric.candidates:20:vertical"},
      {"stale-depth", "The first line of depths is taken before it has come.",
       "flip:geometric.depth_test.latency_fifo_entries:0:missed.0", tested},
      {"wrong-replacement", "The caches have other sizes than were ordered."},
      {"stale-neighbour", "A block takes from the block above as that was blended.",
       stale_neighbour,
       unless(!planted("stale-neighbour") || !stale_neighbour.empty(),
              "geometric.frame_copy = false, a pixel that takes from one above that was written "
              "long before (a "
              "larger frame, a faster memory)")},
      {"double-blend", "Resolves block 5 twice.", "duplicate:geometric.touched_blocks:5"},
      {"flip-weight", "Flips a bit of a weight of block 5.",
       "flip:geometric.block_fifo_entries:5:weights.5.u.4"},
      {"duplicate-fetch", "Sends memory request 20 twice.",
       fmt::format("duplicate:geometric.requests:{}", kFaultyRequest)},
      {"stuck-ready", "Holds back the touched blocks.",
       "stuck_ready:geometric.touched_blocks:100"}};
  for (PlantedFault& fault : memory_faults()) list.push_back(std::move(fault));
  return list;
}

// The golden model always gets what was ordered.
Parameters GeometricEnvironment::as_built() const {
  Parameters p = setup_.geometric;
  if (planted("wrong-replacement"))
    for (spec::geometric::CacheLines* const lines :
         {&p.vertex_lines, &p.depth_lines, &p.weight_blocks})
      *lines = other_size(*lines);
  return p;
}

void GeometricEnvironment::plant_in_table() {
  if (!planted("wrong-slope")) return;
  rtl::for_each<rtl::Memory<std::uint32_t>>(engine_, [](rtl::Memory<std::uint32_t>& memory) {
    if (memory.basename() != std::string_view("reciprocal_rom")) return;
    for (std::uint64_t word = 0; word < memory.words(); ++word) memory.backdoor(word) ^= 1;
  });
}

namespace {

MemoryModelParameters memory_of(const GeometricSetup& setup, const RegionMap& regions,
                                std::uint64_t seed) {
  MemoryModelParameters m = memory_model_parameters(setup.memory, regions.bytes(), seed);
  m.record_writes = true;
  return m;
}

}  // namespace

GeometricEnvironment::GeometricEnvironment(Simulation& simulation,
                                           std::span<const geometric::Frame> frames,
                                           const GeometricSetup& setup, std::string name)
    : Environment(simulation, std::move(name)),
      frames_(frames),
      setup_(setup),
      regions_(frames, setup.geometric),
      engine_("geometric", simulation.clock(), as_built()),
      memory_(memory_name().c_str(), simulation.clock().period(),
              memory_of(setup, regions_, simulation.options().seed)),
      host_("geometric_host"),
      golden_(setup.geometric),
      line_board_("lines", 0),
      candidate_board_("candidates", 0),
      block_board_("blocks", 0, describe_block),
      pixel_board_("pixels", describe_pixel),
      traffic_board_("memory lines", 0, describe_access,
                     [this](const MemoryAccess& access) {
                       return 2 * regions_.region_of(access.address) + (access.write ? 1 : 0);
                     }),
      register_board_(spec::geometric::kRegisters) {
  for (const geometric::Frame& frame : frames)
    golden::geometric::check_frame(
        setup.geometric, {frame.image.width, frame.image.height, frame.screen.edges.size(),
                          frame.screen.vertices.size(), frame.screen.faces});
  know(faults());
  plant_in_table();
  let_blind({&line_board_, &candidate_board_, &block_board_, &pixel_board_, &traffic_board_,
             &register_board_.board()});
  std::array<std::uint32_t, spec::geometric::kRegisters.size()> judged{};
  std::transform(spec::geometric::kRegisters.begin(), spec::geometric::kRegisters.end(),
                 judged.begin(), [](const spec::RegisterInfo& info) { return info.offset; });
  let_miscount(register_board_, judged);
  candidate_board_.call_items(
      [](const Candidate& c) { return fmt::format("pixel ({}, {})", c.x, c.y); });
  block_board_.call_items(
      [](const BlockRecord& b) { return fmt::format("block ({}, {})", b.x, b.y); });
  engine_.memory()->bind(memory_.ports);
  host_.bus.bind(engine_.registers);
  plant_in(memory_, setup.memory);
  if (const auto range = error_range(setup.memory))
    golden_.set_memory_errors(
        [range = *range](std::uint32_t line) { return range.touches(line, kLine); });
  if (simulation.options().maps) maps_.emplace();
  observe();
}

void GeometricEnvironment::observe() {
  const rtl::ClockDomain& clock = simulation().clock();
  engine_.resolver.observer = [this, &clock](const BlockRecord& block) {
    blocks_.push_back(block);
    if (maps_) maps_->see(block);
    if (golden()) block_board_.got(block, clock.cycle());
  };
  if (maps_ || golden())
    engine_.depth_test.observer = [this, &clock](const Candidate& candidate) {
      if (maps_) maps_->see(candidate);
      if (golden()) candidate_board_.got(candidate, clock.cycle());
    };
  if (!golden()) return;
  engine_.line_setup.observer = [this, &clock](const LineRecord& line) {
    line_board_.got(line, clock.cycle());
  };
}

// ---- running ------------------------------------------------------------------------------------

void GeometricEnvironment::configure() {
  require_id(host_, reg::kId, reg::kIdValue);
  golden_work_ = {};
  golden_errors_ = 0;
}

bool GeometricEnvironment::begin(std::size_t piece) {
  if (piece >= frames_.size()) return false;
  current_ = piece;
  started_ = false;
  blocks_.clear();
  if (maps_) maps_->begin(current().image.width, current().image.height);
  watch();
  memory_.forget_lines();
  reads_judged_ = writes_judged_ = 0;
  load();
  expect();
  if (name().empty()) draw();
  return true;
}

FrameLayout GeometricEnvironment::layout() const {
  return {setup_.geometric.layout, current().image.width, current().image.height};
}

std::uint32_t GeometricEnvironment::colour_address(int x, int y) const {
  return regions_.base(Region::kColour) + layout().offset_of(x, y);
}

void GeometricEnvironment::load() {
  const geometric::Frame& frame = current();
  const auto fill = [&](Region region, std::span<const std::uint8_t> bytes) {
    memory_.preload(regions_.base(region), bytes);
  };
  std::vector<std::uint8_t> facing = frame.screen.facing;
  if (planted("wrong-facing"))
    if (const auto face = face_of_a_fault(); face && *face / 8 < facing.size())
      facing[*face / 8] = static_cast<std::uint8_t>(facing[*face / 8] ^ 1u << (*face % 8));
  fill(Region::kFaces, facing);
  fill(Region::kEdges, in_memory(frame.screen.edges));
  fill(Region::kVertices, in_memory(frame.screen.vertices));
  fill(Region::kDepth, in_memory(layout(), frame.image.width, frame.depths));
  if (name().empty()) fill(Region::kColour, in_memory(layout(), frame.image));
  if (!simulation().options().poison) return;
  // Nobody has written there.
  Random random(simulation().options().seed, "memory");
  for (const Region region : {Region::kWeights, Region::kCopy}) {
    const std::uint64_t end =
        region == Region::kCopy ? regions_.bytes() : regions_.base(Region::kColour);
    std::vector<std::uint8_t> noise(end - regions_.base(region));
    for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random.word());
    fill(region, noise);
  }
}

void GeometricEnvironment::expect() {
  if (!golden()) return;
  golden_.process(current().input(regions_.bases()));
  for (const LineRecord& line : golden_.lines()) line_board_.expect(line);
  for (const Candidate& candidate : golden_.candidates()) candidate_board_.expect(candidate);
  for (const BlockRecord& block : golden_.blocks()) block_board_.expect(block);
  const auto expect_all = [&](const auto& lists, bool write) {
    for (const auto& list : lists)
      for (const std::uint32_t address : list) traffic_board_.expect({address, write});
  };
  expect_all(golden_.traffic().reads, false);
  expect_all(golden_.traffic().writes, true);
}

void GeometricEnvironment::put(int x, int y, const Rgba8& colour) {
  memory_.preload(colour_address(x, y), colour);
}

Rgba8 GeometricEnvironment::pixel(int x, int y) const {
  Rgba8 colour{};
  const std::vector<std::uint8_t> bytes = memory_.dump(colour_address(x, y), colour.size());
  std::copy(bytes.begin(), bytes.end(), colour.begin());
  return colour;
}

void GeometricEnvironment::draw() {
  const geometric::Frame& frame = current();
  const golden::geometric::Bases bases = regions_.bases();
  const std::pair<std::uint32_t, std::uint32_t> values[] = {
      {reg::kSize, static_cast<std::uint32_t>(frame.image.width) |
                       static_cast<std::uint32_t>(frame.image.height) << 16},
      {reg::kEdgeCount, static_cast<std::uint32_t>(frame.screen.edges.size())},
      {reg::kVertexCount, static_cast<std::uint32_t>(frame.screen.vertices.size())},
      {reg::kFaceCount, frame.screen.faces},
      {reg::kEdgeBase, bases.edges},
      {reg::kVertexBase, bases.vertices},
      {reg::kFaceBase, bases.facing},
      {reg::kDepthBase, bases.depth},
      {reg::kColourBase, bases.colour},
      {reg::kWeightBase, bases.weights},
      {reg::kCopyBase, bases.copy},
      {reg::kControl, reg::kControlEnable | reg::kControlStart}};
  for (const auto& [offset, value] : values) host_.write(offset, value);
  started_ = true;
}

void GeometricEnvironment::restart() {
  // What was asked of memory before is still on its way; it goes by before the frame begins. In a
  // composition frames begin by themselves, so it has seen to that during reset.
  if (name().empty()) drain_memory();
  memory_.clear_statistics();
  reads_judged_ = writes_judged_ = 0;
  line_board_.restart();
  candidate_board_.restart();
  block_board_.restart();
  traffic_board_.restart();
  begin(current_);
}

void GeometricEnvironment::watch() {
  if (golden()) judge_traffic();
}

void GeometricEnvironment::end() {
  watch();
  judge_frame();
  ++frames_done_;
  edges_done_ += current().screen.edges.size();
  edge_clocks_ += engine_.frame_sequencer.edge_cycles.value();
  resolve_clocks_ += engine_.frame_sequencer.resolve_cycles.value();
  if (!golden()) return;
  for (const WorkCount& each : spec::geometric::kWorkCounts)
    golden_work_.*each.count += golden_.work().*each.count;
  golden_errors_ += golden_.memory_errors();
}

// As much as frames and memory have, and as the engine counted: a frame may have no line.
void GeometricEnvironment::finish() {
  if (!golden()) return;
  const spec::geometric::Work work = engine_.work();
  line_board_.require(work.lines);
  candidate_board_.require(work.candidates);
  block_board_.require(work.blocks);
  traffic_board_.require(std::max<std::uint64_t>(1, memory_.reads() + memory_.writes()));
  std::uint64_t area = 0;
  for (const geometric::Frame& frame : frames_) area += frame.image.pixels.size();
  pixel_board_.require(area);
  judge_registers();
}

void GeometricEnvironment::refuse_memory_errors() {
  if (const std::uint32_t errors = host_.read(reg::kMemoryErrors); errors != 0)
    throw spec::SimulationError(
        fmt::format("memory answered {} lines with an error, which read as zero: look at "
                    "{}.error_address, or at the bases of the regions",
                    errors, memory_name()));
}

void GeometricEnvironment::refuse_unused_errors() const {
  refuse_untouched(memory_, setup_.memory);
}

Amount GeometricEnvironment::amount() const {
  std::uint64_t all = 0;
  for (const geometric::Frame& frame : frames_) all += frame.screen.edges.size();
  return {edges_done_, engine_.edge_classifier.edges.value(), all, "edge"};
}

// ---- judging ------------------------------------------------------------------------------------

Environment::Boards GeometricEnvironment::outputs() const {
  return {&line_board_, &candidate_board_, &block_board_, &pixel_board_};
}

void GeometricEnvironment::judge_traffic() {
  const auto judge = [&](const std::vector<std::uint64_t>& lines, std::size_t& judged, bool write) {
    for (; judged < lines.size(); ++judged)
      traffic_board_.got({static_cast<std::uint32_t>(lines[judged]), write},
                         simulation().clock().cycle());
  };
  judge(memory_.lines_read(), reads_judged_, false);
  judge(memory_.lines_written(), writes_judged_, true);
}

// Lines whose writes memory refuses stay as they were.
Image GeometricEnvironment::expected_frame() const {
  Image expected = current().image;
  const auto range = error_range(setup_.memory);
  const FrameLayout where = layout();
  for (int y = 0; y < expected.height; ++y) {
    for (int x = 0; x < expected.width; ++x) {
      const std::size_t i = expected.index(x, y);
      const std::uint64_t line =
          std::uint64_t{regions_.base(Region::kColour)} + where.offset_of(where.line_of(x, y));
      if (!range || !range->touches(line, kLine)) expected.pixels[i] = golden_.pixels()[i];
    }
  }
  return expected;
}

void GeometricEnvironment::judge_frame() {
  const Image after = frame();
  for (const Rgba8& pixel : after.pixels)
    hash_.add(pixel[0] | std::uint64_t{pixel[1]} << 8 | std::uint64_t{pixel[2]} << 16 |
              std::uint64_t{pixel[3]} << 24);
  if (!golden()) return;
  expected_ = expected_frame();
  pixel_board_.expect(expected_.pixels, after.width);
  const rtl::Cycle cycle = simulation().clock().cycle();
  for (const Rgba8& pixel : after.pixels) pixel_board_.got(pixel, cycle);
}

std::vector<std::pair<std::uint32_t, std::uint64_t>> GeometricEnvironment::expected_registers() {
  const geometric::Frame& frame = current();
  const golden::geometric::Bases bases = regions_.bases();
  std::uint32_t status = reg::kStatusIdle | reg::kStatusFrameDone;
  if (golden_errors_ > 0) status |= reg::kStatusMemoryError;
  if (golden_work_.invalid_edges > 0) status |= reg::kStatusInvalidEdge;
  std::vector<std::pair<std::uint32_t, std::uint64_t>> expected = {
      {reg::kId, reg::kIdValue},
      {reg::kControl, reg::kControlEnable},
      {reg::kStatus, status},
      {reg::kSize, static_cast<std::uint64_t>(frame.image.width) |
                       static_cast<std::uint64_t>(frame.image.height) << 16},
      {reg::kRules, rules_register(setup_.geometric)},
      {reg::kEdgeCount, frame.screen.edges.size()},
      {reg::kVertexCount, frame.screen.vertices.size()},
      {reg::kFaceCount, frame.screen.faces},
      {reg::kEdgeBase, bases.edges},
      {reg::kVertexBase, bases.vertices},
      {reg::kFaceBase, bases.facing},
      {reg::kDepthBase, bases.depth},
      {reg::kColourBase, bases.colour},
      {reg::kWeightBase, bases.weights},
      {reg::kCopyBase, bases.copy},
      {reg::kRefusal, 0}};
  for (const WorkCount& each : spec::geometric::kWorkCounts)
    expected.emplace_back(each.offset, golden_work_.*each.count);
  expected.emplace_back(reg::kMemoryErrors, golden_errors_);
  // Clocks are the model's own; that the registers show them is judged, and that they add up.
  const rtl::geometric::FrameSequencer& sequencer = engine_.frame_sequencer;
  const std::uint64_t edge_clocks = sequencer.edge_cycles.value(),
                      resolve_clocks = sequencer.resolve_cycles.value();
  expected.emplace_back(reg::kFrameCycles, edge_clocks + resolve_clocks);
  expected.emplace_back(reg::kEdgeCycles, edge_clocks);
  expected.emplace_back(reg::kResolveCycles, resolve_clocks);
  return expected;
}

void GeometricEnvironment::judge_registers() { register_board_.judge(host_, expected_registers()); }

Image GeometricEnvironment::frame() const {
  Image image(current().image.width, current().image.height);
  const FrameLayout where = layout();
  const std::vector<std::uint8_t> bytes =
      memory_.dump(regions_.base(Region::kColour), where.bytes());
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(where.offset_of(x, y));
      std::copy_n(from, spec::geometric::kPixelBytes, image.at(x, y).begin());
    }
  return image;
}

// ---- results ------------------------------------------------------------------------------------

void GeometricEnvironment::collect(Result& result) const {
  const rtl::geometric::GeometricEngine& e = engine_;
  const Parameters& p = setup_.geometric;
  for (const rtl::Unit* unit : e.units()) add(result, name_within(e, *unit), *unit);
  for (const rtl::MemoryBase* memory : e.memories())
    add(result, name_within(e, *memory), *memory, frames_.empty() ? 0 : current().image.width);
  add(result, memory_);
  result.lines_filled += memory_.reads();

  const spec::geometric::Work work = e.work();
  const LinesMoved lines = lines_moved(e, p.frame_copy);
  constexpr const char* kBytes = "byte/pixel";
  std::uint64_t frame_bytes = e.memory_port.bytes_written.value();
  for (const Region region : {Region::kDepth, Region::kWeights, Region::kColour, Region::kCopy})
    frame_bytes += kLine * lines.read[index_of(region)];
  add(result, "edge_cycles", e.frame_sequencer.edge_cycles.value(), "clk",
      "Of the last frame, from its start until every edge was drawn.");
  add(result, "resolve_cycles", e.frame_sequencer.resolve_cycles.value(), "clk",
      "Of the last frame: the rest.");
  for (std::size_t i = 0; i < RegionMap::kRegions; ++i)
    add(result, fmt::format("lines_read_{}", spec::geometric::kRegionNames[i]), lines.read[i],
        "line", fmt::format("Lines of the region {} read.", spec::geometric::kRegionNames[i]));
  for (const Region region : {Region::kWeights, Region::kColour, Region::kCopy}) {
    const std::string_view name = spec::geometric::kRegionNames[index_of(region)];
    add(result, fmt::format("lines_written_{}", name), lines.written[index_of(region)], "line",
        fmt::format("Lines of the region {} written.", name));
  }
  add(result, "bytes_a_blended_pixel",
      ratio(e.memory_port.bytes_read.value() + e.memory_port.bytes_written.value(),
            work.blended_pixels),
      kBytes, "All bytes read and enabled in writes over blended pixels.");
  add(result, "frame_bytes_a_blended_pixel", ratio(frame_bytes, work.blended_pixels), kBytes,
      "The same of depth, weights, colours and copy alone: without the mesh.");
  add(result, "columns_a_clock", ratio(work.columns, work.groups), "column/clk",
      "Columns over the clocks in which the walkers stepped.");
  const auto hits = [&](const char* name, const rtl::Counter& lookups, const rtl::Counter& misses,
                        const char* meaning) {
    add(result, name, 100 * ratio(lookups.value() - misses.value(), lookups.value()), "%", meaning);
  };
  hits("vertex_hits_percent", e.vertex_fetch.lookups, e.vertex_fetch.misses,
       "Look-ups of lines of vertices that ordered none.");
  hits("depth_hits_percent", e.depth_test.lookups, e.depth_test.misses,
       "Look-ups of lines of depth that ordered none.");
  hits("weight_hits_percent", e.weight_combiner.lookups, e.weight_combiner.misses,
       "Look-ups of blocks of weights that were in the cache.");
  const std::uint64_t dividers =
      p.pipelined ? kDividerClocks : static_cast<std::uint64_t>(p.dividers);
  add(result, "divider_occupancy_percent",
      100 * ratio(e.line_setup.divider_clocks.value(), dividers * edge_clocks_), "%",
      "Clocks of dividers (of their stages, if pipelined) in use over those of the edges' phase; "
      "at "
      "100 % they are the limit.");
  add(result, "port_occupancy_percent",
      100 * ratio(e.memory_port.reads.value() + e.memory_port.writes.value(),
                  edge_clocks_ + resolve_clocks_),
      "%", "Requests to memory over clocks; at 100 % the port is the limit.");
  for (const rtl::Counter* counter : e.counters()) add(result, name_within(e, *counter), *counter);
}

void GeometricEnvironment::show_parts(Observer& observer) const {
  show(observer, engine_);
  observer.see({"Edges read", figure("edge_classifier_edges"), "edge/clk",
                number(count_of(setup_.geometric.edge_lanes))});
  observer.see({"Pixels blended", figure("resolver_blended_pixels"), "pixel/clk",
                number(count_of(setup_.geometric.resolve_lanes))});
}

Coverage GeometricEnvironment::coverage() const {
  Coverage coverage = geometric_coverage(engine_, golden_.coverage(), setup_.geometric);
  if (const auto range = error_range(setup_.memory))
    for (const auto* const lines : {&memory_.lines_read(), &memory_.lines_written()})
      for (const std::uint64_t line : *lines)
        if (range->touches(line, kLine)) {
          const std::string bin = fmt::format(
              "geometric/error/{}", spec::geometric::kRegionNames[regions_.region_of(line)]);
          coverage.declare(bin);
          coverage.hit(bin);
        }
  return coverage;
}

std::vector<PictureMap> GeometricEnvironment::maps() const {
  if (!maps_) return {};
  const FrameLayout where = layout();
  const auto line_of = [&](int x, int y) {
    return std::uint64_t{regions_.base(Region::kDepth)} + where.offset_of(where.line_of(x, y));
  };
  return named(maps_->maps(engine_, line_of, memory_.lines_read(), frames_.size() == 1));
}

std::vector<Figure> GeometricEnvironment::work_figures() const {
  return {{"Edges kept", key("edge_classifier_kept_edges"), "of", key("edge_classifier_edges")},
          {"Lines", key("line_setup_lines")},
          {"Pixels walked a clock", key("columns_a_clock"), "walkers, at most"},
          {"Vertices found in the cache", key("vertex_hits_percent")},
          {"Depths found in the cache", key("depth_hits_percent")},
          {"Weights found in the cache", key("weight_hits_percent")},
          {"Divider occupancy", key("divider_occupancy_percent")},
          {"Memory port occupancy", key("port_occupancy_percent")},
          {"Blended pixels", key("resolver_blended_pixels")},
          {"Traffic of frame buffers alone", key("frame_bytes_a_blended_pixel")}};
}

std::uint64_t GeometricEnvironment::frame_clocks_bound() const {
  return frames_done_ > 0 ? clocks_bound(engine_, setup_, current(), frames_done_) / frames_done_
                          : 0;
}

void GeometricEnvironment::collect_headline(Result& result) const {
  const rtl::geometric::GeometricEngine& e = engine_;
  const std::uint64_t edges = e.work().edges, frame_clocks = e.frame_sequencer.frame_cycles.value();
  result.latency = latency_of(e.edge_latency);

  result.throughput = ratio(edges, result.cycles);
  result.throughput_unit = "edge/clk";
  const std::uint64_t bound =
      frames_done_ > 0 ? clocks_bound(e, setup_, current(), frames_done_) : 0;
  result.throughput_bound = ratio(edges, bound);
  result.throughput_bound_meaning =
      "Edges over the clocks of the begin and of both phases, each as its slowest unit or the port "
      "needs for this work.";

  add(result, "frame_clocks", frame_clocks, "clk", "Of the last frame, from its start to its end.");
  add(result, "frame_clocks_bound", frame_clocks_bound(), "clk",
      "The bound of the throughput, in clocks of a frame.");
  add(result, "frame_rate",
      frame_clocks ? simulation().options().clock_mhz * 1e6 / number(frame_clocks) : 0.0, "frame/s",
      "Frames like this a second at the stated clock.");
  add(result, "clock_for_60_frames",
      frame_clocks ? WorkValue(clock_for_60(frame_clocks)) : WorkValue(), "MHz",
      "Clock that 60 frames like this a second need.");

  result.figures.clear();
  if (frame_clocks)
    result.figures = {{"Frame", "work.frame_clocks", "bound", "work.frame_clocks_bound", true},
                      {"Edges drawn", "work.edge_cycles"},
                      {"Pixels resolved", "work.resolve_cycles"},
                      {"Clock for 60 frames", "work.clock_for_60_frames", "", "", true},
                      {"Frames like this", "work.frame_rate"}};
  result.figures.push_back(
      {"Traffic of a blended pixel", "work.bytes_a_blended_pixel", "", "", true});
  for (Figure& figure : work_figures()) result.figures.push_back(std::move(figure));

  // From the input of the pipe to its output.
  std::vector<UnitCycles> pipe;
  const rtl::Unit* const units[] = {&e.edge_reader,   &e.edge_classifier, &e.vertex_fetch,
                                    &e.line_setup,    &e.line_walker,     &e.coverage_unit,
                                    &e.depth_test,    &e.weight_combiner, &e.frame_copier,
                                    &e.block_scanner, &e.block_fetch,     &e.resolver};
  for (const rtl::Unit* unit : units)
    pipe.push_back(unit_cycles(figure(name_within(e, *unit)), *unit));
  result.bottleneck = find_bottleneck(pipe, figure("resolver"));
  const std::uint64_t requests = e.memory_port.reads.value() + e.memory_port.writes.value();
  if (result.cycles > 0 && ratio(requests, result.cycles) >= kPortBound)
    result.bottleneck = Bottleneck{figure("memory_port"), "busy",
                                   "The port takes a request in nearly every clock.", requests};
}

}  // namespace deburr::tb
