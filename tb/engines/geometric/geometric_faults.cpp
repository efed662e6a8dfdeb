// SPDX-License-Identifier: MIT
#include "tb/engines/geometric/geometric_faults.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

#include "golden/geometric/geometric_golden.h"
#include "golden/geometric/resolve.h"

namespace deburr::tb {
namespace {

using spec::geometric::BlockRecord;
using spec::geometric::Edge;
using spec::geometric::Parameters;
using spec::geometric::Rgba8;
namespace flag = spec::geometric::flag;

spec::geometric::CacheLines other_size(spec::geometric::CacheLines lines) {
  using spec::geometric::CacheLines;
  return lines == CacheLines::k16 ? CacheLines::k32
                                  : static_cast<CacheLines>(static_cast<std::uint8_t>(lines) - 1);
}

// Inverts the lowest bit of every word.
template <class Word>
void flip_rom(rtl::geometric::GeometricEngine& engine, std::string_view name) {
  rtl::for_each<rtl::Memory<Word>>(engine, [name](rtl::Memory<Word>& memory) {
    if (memory.basename() != name) return;
    for (std::uint64_t word = 0; word < memory.words(); ++word) memory.backdoor(word) ^= 1;
  });
}

}  // namespace

// Returns a face of the first edge with two faces; the class of that edge depends on it.
std::optional<std::uint32_t> GeometricFaults::face_for_facing_fault() const {
  if (setup_.geometric.select != spec::geometric::Select::kEdges || frames_.empty())
    return std::nullopt;
  const ScreenEdges& screen = frames_.front().screen;
  for (const Edge& edge : screen.edges)
    if (!(edge.flags & flag::kBoundary) && edge.f0 < screen.faces) return edge.f0;
  return std::nullopt;
}

// Returns the index of a block with a pixel that blends with a blended pixel of the block above and
// would change if it used that pixel's final colour. Lines are prefetched, so the block above must
// be far enough ahead that its write comes before this block's read. A line read earlier still
// holds the original colour, so the fault would not show.
std::optional<std::size_t> GeometricFaults::block_blending_from_above() const {
  constexpr int kInside = 16;  // blocks in the stages of the resolver
  if (frames_.empty() || setup_.geometric.frame_copy) return std::nullopt;
  const rtl::MemoryCycles memory = memory_cycles(setup_);
  const std::int32_t ahead =
      kInside + rtl::geometric::sized(setup_.geometric, memory).resolve_lines / 4 + memory.latency;
  const geometric::Frame& frame = frames_.front();
  golden::geometric::GeometricGolden golden(setup_.geometric);
  const std::vector<Rgba8>& after = golden.process(frame.input());
  std::map<std::pair<int, int>, int> numbers;  // block indices by row and column
  for (int i = 0; i < static_cast<int>(golden.blocks().size()); ++i) {
    const BlockRecord& block = golden.blocks()[static_cast<std::size_t>(i)];
    numbers[{block.y, block.x}] = i;
    const auto above = numbers.find({block.y - 1, block.x});
    if (above == numbers.end() || above->second + ahead > i) continue;
    for (std::size_t k = 0; k < spec::geometric::kBlockSize; ++k) {
      const golden::geometric::Probe probe = golden::geometric::probe_of(block.weights[k]);
      if (probe.left_right || probe.first == 0) continue;
      const int x = 4 * block.x + static_cast<int>(k), y = 4 * block.y;
      const Rgba8 &pixel = frame.image.at(x, y),
                  &below = probe.second != 0 ? frame.image.at(x, y + 1) : pixel;
      const Rgba8& stale = after[frame.image.index(x, y - 1)];
      if (golden::geometric::resolve(setup_.geometric, probe, pixel, stale, below) !=
          after[frame.image.index(x, y)])
        return static_cast<std::size_t>(i);
    }
  }
  return std::nullopt;
}

std::vector<InjectedFault> GeometricFaults::list() const {
  const Parameters& p = setup_.geometric;
  const auto unless = [](bool there, std::string needs) {
    return there ? std::string() : std::move(needs);
  };
  const std::string tested = unless(p.depth_test != spec::geometric::DepthTest::kOff,
                                    "geometric.depth_test = own, farther");
  const std::string areas =
      unless(p.coverage == spec::geometric::CoverageRule::kArea, "geometric.coverage = area");
  const std::string split =
      unless(p.records == spec::geometric::RecordsLayout::kSplit, "geometric.records = split");
  std::string stale_neighbour;
  if (injected("stale-neighbour"))
    if (const auto block = block_blending_from_above())
      stale_neighbour = fmt::format("flip:geometric.touched_blocks:{}:above", *block);
  std::vector<InjectedFault> list = {
      {"wrong-facing", "Flips the facing bit of a face.", "",
       unless(face_for_facing_fault().has_value(),
              "geometric.select = edges, an edge of two faces")},
      {"wrong-slope", "Flips the lowest bit of every reciprocal in the table.", "",
       unless(p.reciprocal_table > 0, "geometric.reciprocal_table of at least 1")},
      {"wrong-cull", "Edges between faces turned away are culled where they are to stay, or stay.",
       "", unless(p.select == spec::geometric::Select::kEdges, "geometric.select = edges")},
      {"wrong-class", "A kept edge is taken for a crease, or a crease for another edge.",
       "flip:geometric.kept:5:crease"},
      {"wrong-pair", "An edge takes the vertices of another one.", "flip:geometric.kept:5:place.0",
       split},
      {"stale-pair", "The first line of pairs is taken before it has come.",
       "flip:geometric.pair_fetch.latency_fifo_entries:0:missed", split},
      {"wrong-area", "Flips the lowest bit of every area up to half a pixel from the centre.", "",
       areas},
      {"wrong-second", "A column of a group of candidates has a second one too few, or too many.",
       "flip:geometric.candidates:20:seconds.0", areas},
      {"wrong-nearer", "No pixel is taken for nearer than its neighbour.", "",
       unless(p.combine == spec::geometric::Combine::kOutermost, "geometric.combine = outermost")},
      {"drop-line", "Drops line 5 on its way to the walkers.",
       "drop:geometric.line_fifo_entries:5"},
      {"duplicate-line", "Walks line 5 twice.", "duplicate:geometric.line_fifo_entries:5"},
      {"drop-group", "Drops a group of candidates.", "drop:geometric.candidates:20"},
      {"duplicate-group", "Tests and draws a group of candidates twice.",
       "duplicate:geometric.candidates:20"},
      {"wrong-direction", "A group of candidates takes its neighbours along the other axis.",
       "flip:geometric.candidates:20:vertical"},
      {"wrong-screen", "A candidate is dropped that is not hidden, or kept that is.",
       "flip:geometric.screened:20:dropped.0",
       unless(p.coarse_lines != spec::geometric::CoarseLines::kNone,
              "geometric.coarse_lines of at least 4")},
      {"stale-depth", "The first line of depths is taken before it has come.",
       "flip:geometric.depth_test.latency_fifo_entries:0:missed.0", tested},
      {"wrong-replacement", "The caches have other sizes than were ordered."},
      {"wrong-kept", "Another number of lines of colours is kept than was ordered.", "",
       unless(p.colour_lines > 0, "geometric.colour_lines of at least 1")},
      {"stale-kept", "The first line of colours is taken for a kept one.",
       "flip:geometric.colour_order_entries:0:hit",
       unless(p.colour_lines > 0, "geometric.colour_lines of at least 1")},
      {"wrong-buffer", "The write buffer has another number of places than was ordered.", "",
       unless(p.write_buffer > 0, "geometric.write_buffer of at least 1")},
      {"stale-neighbour", "A block takes from the block above as that was blended.",
       stale_neighbour,
       unless(!injected("stale-neighbour") || !stale_neighbour.empty(),
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
  for (InjectedFault& fault : memory_faults()) list.push_back(std::move(fault));
  return list;
}

Parameters GeometricFaults::as_built() const {
  Parameters p = setup_.geometric;
  if (injected("wrong-replacement"))
    for (spec::geometric::CacheLines* const lines :
         {&p.vertex_lines, &p.depth_lines, &p.weight_blocks})
      *lines = other_size(*lines);
  if (injected("wrong-cull"))
    p.cull = p.cull == spec::geometric::Cull::kNone ? spec::geometric::Cull::kBack
                                                    : spec::geometric::Cull::kNone;
  const auto other = [](std::int32_t places) { return places <= 1 ? places + 1 : places - 1; };
  if (injected("wrong-kept")) p.colour_lines = other(p.colour_lines);
  if (injected("wrong-buffer")) p.write_buffer = other(p.write_buffer);
  if (injected("wrong-nearer")) p.combine = spec::geometric::Combine::kMax;
  return p;
}

void GeometricFaults::inject(rtl::geometric::GeometricEngine& engine) const {
  if (injected("wrong-slope")) flip_rom<std::uint32_t>(engine, "reciprocal_rom");
  if (injected("wrong-area")) flip_rom<std::uint8_t>(engine, "near_area_rom");
}

std::vector<std::uint8_t> GeometricFaults::facing(const geometric::Frame& frame) const {
  std::vector<std::uint8_t> bits = frame.screen.facing;
  if (injected("wrong-facing"))
    if (const auto face = face_for_facing_fault(); face && *face / 8 < bits.size())
      bits[*face / 8] = static_cast<std::uint8_t>(bits[*face / 8] ^ 1u << (*face % 8));
  return bits;
}

}  // namespace deburr::tb
