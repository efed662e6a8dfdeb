// SPDX-License-Identifier: MIT
// Packets of the morphological engine: input and output pixels, and packets in which golden model
// and RTL model are compared. Formats: docs/reference/morphological/algorithm.md.
#pragma once

#include <array>
#include <cstdint>
#include <iterator>

#include "spec/morphological/parameters.h"
#include "spec/morphological/registers.h"
#include "spec/morphological/shapes.h"

namespace deburr::spec::morphological {

using Rgba8 = std::array<std::uint8_t, 4>;  // R, G, B, A codes, U0.8 unorm

// The pixels of one cycle, all from one row, in raster order, with lane 0 leftmost. Each row starts
// with a new beat.
struct PixelBeat {
  std::array<Rgba8, kMaxLanes> pixel{};
  std::array<std::uint32_t, kMaxLanes> depth{};  // U24, grows towards the eye; 0 without depth
  std::uint8_t count = 0;       // valid lanes, 1..lanes; fewer only at the end of a row
  bool start_of_frame = false;  // first beat of the frame
  bool end_of_row = false;      // last beat of a row
  friend bool operator==(const PixelBeat&, const PixelBeat&) = default;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit.lanes("pixel", self.pixel, 8, "U0.8", "rgba");
    visit.lanes("depth", self.depth, 24, "U24");
    visit("count", self.count, 3, "U3");
    visit("start_of_frame", self.start_of_frame);
    visit("end_of_row", self.end_of_row);
  }
};

// Probe of the blend decision, for checks and pictures. `first` is the weight of the upper (left)
// neighbour, `second` that of the lower (right) one, both U0.8 and before blend = strongest mixes
// them. Both are 0 if the pixel passed unchanged.
struct BlendProbe {
  bool horizontal = false;  // the neighbours are left and right
  std::uint8_t first = 0, second = 0;
  std::uint8_t edges = 0;  // bit 0 left, bit 1 top
  friend bool operator==(const BlendProbe&, const BlendProbe&) = default;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("horizontal", self.horizontal);
    visit("first", self.first, 8, "U0.8");
    visit("second", self.second, 8, "U0.8");
    visit("edges", self.edges, 2, "bit 0 left, bit 1 top");
  }
};

struct BlendedBeat {
  std::array<Rgba8, kMaxLanes> pixel{};
  std::array<BlendProbe, kMaxLanes> probe{};
  std::uint8_t count = 0;
  bool start_of_frame = false;
  bool end_of_row = false;
  friend bool operator==(const BlendedBeat&, const BlendedBeat&) = default;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit.lanes("pixel", self.pixel, 8, "U0.8", "rgba");
    visit.lanes("probe", self.probe);
    visit("count", self.count, 3, "U3");
    visit("start_of_frame", self.start_of_frame);
    visit("end_of_row", self.end_of_row);
  }
};

enum class Axis : std::uint8_t { kHorizontal, kVertical };  // direction of the run
// A run longer than the search range gives two descriptors, one for each end.
enum class RunPart : std::uint8_t { kWhole, kHead, kTail };

// A run descriptor. Horizontal: `line` is the row of the top edges, positions are columns.
// Vertical: `line` is the column of the left edges, positions are rows. The corners of the run are
// `start` and `start + length`; a head has only the first of them, a tail only the second.
// `far`: crossings that continue for a second pixel (docs/reference/morphological/smaa.md,
// "Corners"). Bits 0 and 1 are for the first and second side at the start, bits 2 and 3 for those
// at the end. 0 without round_corners.
// `endless`: ends that go on beyond the frame, with border = clamp (smaa.md, "Border"). Bit 0 is
// for the start, bit 1 for the end. Such an end has no crossings.
struct RunDescriptor {
  Axis axis = Axis::kHorizontal;
  RunPart part = RunPart::kWhole;
  std::uint16_t line = 0;
  std::uint16_t start = 0;
  std::uint16_t length = 0;  // pixels covered by this descriptor
  std::uint8_t shape = 0;    // index of kRunShapes
  std::uint8_t far = 0;
  std::uint8_t endless = 0;
  friend bool operator==(const RunDescriptor&, const RunDescriptor&) = default;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("axis", self.axis, 1, "0 horizontal, 1 vertical");
    visit("part", self.part, 2, "0 whole, 1 head, 2 tail");
    visit("line", self.line, 13, "U13");
    visit("start", self.start, 13, "U13");
    visit("length", self.length, 12, "U12");
    visit("shape", self.shape, 4, "index of kRunShapes");
    visit("far", self.far, 4, "sharp corners: start first, second, end first, second");
    visit("endless", self.endless, 2, "beyond the frame: bit 0 start, bit 1 end");
  }
};

// The line through a run. t(X) = (scale * X - offset) * slope + shift * 2^23, U/S x.24, X relative
// to the start of the descriptor; t < 0 belongs to `before`, t > 0 to `after`.
struct LineDescriptor {
  RunDescriptor run{};
  bool learned = false;                         // weights come from the ROMs; no line and no sides
  std::uint8_t start_class = 0, end_class = 0;  // classes of the crossings, 0..8; 0 unless learned
  Side before = Side::kNone, after = Side::kNone;
  std::uint8_t left_steps = 0, right_steps = 0;  // extensions kept: up or left, down or right
  std::int32_t scale = 2;
  std::int32_t offset = 0;
  std::int32_t shift = 0;     // right_steps - left_steps
  std::uint32_t slope = 0;    // U0.24
  std::uint32_t inverse = 0;  // U12.12, pixels per step
  std::uint16_t span = 0;     // pixels between the two outermost corners; decides between axes
  friend bool operator==(const LineDescriptor&, const LineDescriptor&) = default;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("run", self.run);
    visit("learned", self.learned);
    visit("start_class", self.start_class, 4, "0..8");
    visit("end_class", self.end_class, 4, "0..8");
    visit("before", self.before, 2, "0 none, 1 first, 2 second");
    visit("after", self.after, 2, "0 none, 1 first, 2 second");
    visit("left_steps", self.left_steps, 5, "U5");
    visit("right_steps", self.right_steps, 5, "U5");
    visit("scale", self.scale, 7, "S7");
    visit("offset", self.offset, 24, "S24");
    visit("shift", self.shift, 6, "S6");
    visit("slope", self.slope, 24, "U0.24");
    visit("inverse", self.inverse, 24, "U12.12");
    visit("span", self.span, 12, "U12");
  }
};

// An access to a line of memory, with storage = memory.
struct FrameAccess {
  std::uint32_t address = 0;  // bytes, multiple of kFrameLineBytes
  bool write = false;
  friend bool operator==(const FrameAccess&, const FrameAccess&) = default;
};

// Counts of the work of a frame; golden model and RTL model must agree.
struct Work {
  std::uint64_t pixels = 0;
  std::uint64_t edge_pixels = 0;      // pixels with a left or a top edge
  std::uint64_t horizontal_runs = 0;  // maximal runs, each counted once
  std::uint64_t vertical_runs = 0;
  std::uint64_t long_runs = 0;  // in both axes, longer than the search range
  std::uint64_t z_runs = 0;     // clean Z, not long
  std::uint64_t extended_runs = 0;
  std::uint64_t steps = 0;            // extensions kept
  std::uint64_t probes = 0;           // corners tested
  std::uint64_t divides = 0;          // descriptors with a line and a side
  std::uint64_t blended_pixels = 0;   // pixels with a weight > 0
  std::uint64_t diagonal_pixels = 0;  // pixels whose top edge has the weights of a diagonal
  std::uint64_t bypassed_pixels = 0;  // a weight > 0 was dropped by `bypass` or `text_guard`
  friend bool operator==(const Work&, const Work&) = default;
};

// All counts of Work, and their registers.
struct WorkCount {
  std::uint64_t Work::*count;
  std::uint32_t offset;
};
inline constexpr WorkCount kWorkCounts[] = {{&Work::pixels, reg::kPixels},
                                            {&Work::edge_pixels, reg::kEdgePixels},
                                            {&Work::horizontal_runs, reg::kHorizontalRuns},
                                            {&Work::vertical_runs, reg::kVerticalRuns},
                                            {&Work::long_runs, reg::kLongRuns},
                                            {&Work::z_runs, reg::kZRuns},
                                            {&Work::extended_runs, reg::kExtendedRuns},
                                            {&Work::steps, reg::kSteps},
                                            {&Work::probes, reg::kProbes},
                                            {&Work::divides, reg::kDivides},
                                            {&Work::blended_pixels, reg::kBlendedPixels},
                                            {&Work::diagonal_pixels, reg::kDiagonals},
                                            {&Work::bypassed_pixels, reg::kBypassedPixels}};
static_assert(sizeof(Work) == std::size(kWorkCounts) * sizeof(std::uint64_t),
              "a count is not in the list");

}  // namespace deburr::spec::morphological
