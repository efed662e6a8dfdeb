// SPDX-License-Identifier: MIT
// Payloads of the links of the morphological engine: one struct per link, with fields and widths.
// Lanes that a frame does not use keep old bits.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <string>

#include "rtl_model/fabric/link.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"
#include "spec/morphological/shapes.h"

namespace deburr::rtl::morphological {

using Lanes32 = std::array<std::uint32_t, spec::morphological::kMaxLanes>;
using Lanes8 = std::array<std::uint8_t, spec::morphological::kMaxLanes>;
using LanePixels = std::array<spec::morphological::Rgba8, spec::morphological::kMaxLanes>;

// Position in the frame's raster of slots. Rows 0 .. height - 1 take input; R + 5 more rows flush.
struct Slot {
  std::uint32_t number;  // U27, from 0 in each frame
  std::uint16_t row;     // U14
  std::uint16_t beat;    // U13
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("number", self.number, 27, "U27");
    visit("row", self.row, 14, "U14");
    visit("beat", self.beat, 13, "U13");
  }
};

// SlotSequencer -> LumaUnit.
struct SlotToken {
  Slot slot;
  LanePixels pixel;
  Lanes32 depth;  // U24
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("slot", self.slot);
    visit.lanes("pixel", self.pixel, 8, "U0.8", "rgba");
    visit.lanes("depth", self.depth, 24, "U24");
  }
};

// SlotSequencer -> PixelStore.
struct BeatToken {
  Slot slot;
  LanePixels pixel;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("slot", self.slot);
    visit.lanes("pixel", self.pixel, 8, "U0.8", "rgba");
  }
};

// SlotSequencer -> TextGuard: slot rows 0 .. height + kGuardRows - 1; the last rows have no pixels.
inline constexpr std::int32_t kGuardRows = 8;  // rows after a row on which its result depends
struct GuardSlotToken {
  std::uint16_t row;   // U14
  std::uint16_t beat;  // U13
  std::array<std::array<std::uint8_t, 3>, spec::morphological::kMaxLanes> pixel;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("row", self.row, 14, "U14");
    visit("beat", self.beat, 13, "U13");
    visit.lanes("pixel", self.pixel, 8, "U0.8", "rgb");
  }
};

// TextGuard -> Blender: one beat, in raster order.
struct GuardToken {
  std::uint8_t guarded;  // bit k: lane k
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit.lane_bits("guarded", self.guarded, spec::morphological::kMaxLanes);
  }
};

// LumaUnit -> EdgeDetector.
inline constexpr std::uint32_t kMarkedLuma = 1u << 24;
struct LumaToken {
  Slot slot;
  Lanes32 luma;   // U8.16; with colour edges R, G, B in U0.8; kMarkedLuma: no edge
  Lanes32 depth;  // U24
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("slot", self.slot);
    visit.lanes("luma", self.luma, 25, "U8.16 or R, G, B; bit 24 marked");
    visit.lanes("depth", self.depth, 24, "U24");
  }
};

// EdgeDetector -> RunExtractor: edges of row slot.row - 1; bit k is lane k.
struct EdgeToken {
  Slot slot;
  std::uint8_t left, top;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("slot", self.slot);
    visit.lane_bits("left", self.left, spec::morphological::kMaxLanes);
    visit.lane_bits("top", self.top, spec::morphological::kMaxLanes);
  }
};

// RunExtractor -> AreaUnit: edges of row slot.row - R - 5, which is being blended; with learned
// weights also of the row below, whose weights are being looked up.
struct AreaSlotToken {
  Slot slot;
  std::uint8_t left, top;
  std::uint8_t next_left, next_top;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("slot", self.slot);
    visit.lane_bits("left", self.left, spec::morphological::kMaxLanes);
    visit.lane_bits("top", self.top, spec::morphological::kMaxLanes);
    visit.lane_bits("next_left", self.next_left, spec::morphological::kMaxLanes);
    visit.lane_bits("next_top", self.next_top, spec::morphological::kMaxLanes);
  }
};

inline PayloadShape area_slot_shape(const spec::morphological::Parameters& p, int lanes) {
  PayloadShape shape{.lanes = static_cast<std::uint32_t>(lanes)};
  if (p.area != spec::morphological::AreaSource::kLearned)
    for (const char* const field : {"next_left", "next_top"}) shape.widths.emplace_back(field, 0);
  return shape;
}

// RunExtractor -> PixelStore: sent if the slot blends a row of the frame and needs its pixels.
struct FetchToken {
  Slot slot;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("slot", self.slot);
  }
};

// RunExtractor -> DiagonalUnit: the beat's columns around row y = slot.row - R - 3. Bit k is row y
// + k - M, with M as built.
struct DiagonalColumnsToken {
  Slot slot;
  std::array<std::uint64_t, spec::morphological::kMaxLanes> left, top;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("slot", self.slot);
    visit.lanes("left", self.left, 2 * spec::morphological::kMaxDiagonalSteps + 1);
    visit.lanes("top", self.top, 2 * spec::morphological::kMaxDiagonalSteps + 1);
  }
};
inline PayloadShape diagonal_columns_shape(const spec::morphological::Parameters& p, int lanes) {
  const auto rows = static_cast<std::uint32_t>(2 * p.diagonal_steps + 1);
  return {.lanes = static_cast<std::uint32_t>(lanes), .widths = {{"left", rows}, {"top", rows}}};
}
// Beats from a column to the last column that its pixels depend on.
inline int diagonal_delay(int steps, int lanes) { return (steps + 1 + lanes - 1) / lanes; }

// DiagonalUnit -> AreaUnit: lanes whose top edge takes its weights from a diagonal.
struct DiagonalWeightsToken {
  std::uint8_t taken;  // bit k: lane k
  Lanes8 first, second;
  Lanes8 span;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit.lane_bits("taken", self.taken, spec::morphological::kMaxLanes);
    visit.lanes("first", self.first, 8, "U0.8");
    visit.lanes("second", self.second, 8, "U0.8");
    visit.lanes("span", self.span, 6, "U6");
  }
};

// Weights of one pixel's neighbours, and the spans of the lines that produce them.
struct Weights {
  std::uint8_t up, down, left, right;                       // U0.8
  std::uint16_t span_up, span_down, span_left, span_right;  // U12
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("up", self.up, 8, "U0.8");
    visit("down", self.down, 8, "U0.8");
    visit("left", self.left, 8, "U0.8");
    visit("right", self.right, 8, "U0.8");
    visit("span_up", self.span_up, 12, "U12");
    visit("span_down", self.span_down, 12, "U12");
    visit("span_left", self.span_left, 12, "U12");
    visit("span_right", self.span_right, 12, "U12");
  }
};

// AreaUnit -> Blender.
struct WeightToken {
  Slot slot;
  bool any;  // a weight below is not 0; if false, the weights hold old bits
  std::uint8_t left, top;
  std::array<Weights, spec::morphological::kMaxLanes> weights;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("slot", self.slot);
    visit("any", self.any);
    visit.lane_bits("left", self.left, spec::morphological::kMaxLanes);
    visit.lane_bits("top", self.top, spec::morphological::kMaxLanes);
    visit.lanes("weights", self.weights);
  }
};

// PixelStore -> Blender: the pixels of a beat, of the beats above and below, and the pixels left
// and right of it. Outside the frame: old bits.
struct PixelToken {
  LanePixels above, centre, below;
  spec::morphological::Rgba8 before, after;  // left of lane 0, right of the last lane
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit.lanes("above", self.above, 8, "U0.8", "rgba");
    visit.lanes("centre", self.centre, 8, "U0.8", "rgba");
    visit.lanes("below", self.below, 8, "U0.8", "rgba");
    visit("before", self.before, 8, "U0.8", "rgba");
    visit("after", self.after, 8, "U0.8", "rgba");
  }
};

// Low bits of the slot number in a descriptor. When the AreaUnit sees them, the slot is the next
// one, the one after, or at most two rows of 8192 beats earlier.
inline constexpr std::uint32_t kSlotMask = (1u << 15) - 1;

// Removes fields that are not built. `token`, `run`: prefixes of the RunToken ("run.") and of its
// RunDescriptor.
inline PayloadShape descriptor_shape(const spec::morphological::Parameters& p,
                                     const std::string& token, const std::string& run) {
  PayloadShape shape;
  if (!p.round_corners) shape.widths.emplace_back(run + "far", 0);
  if (p.border != spec::morphological::Border::kClamp)
    shape.widths.emplace_back(run + "endless", 0);
  if (p.ends != spec::morphological::Ends::kCrossings)
    for (const char* const field : {"entry", "beyond"}) shape.widths.emplace_back(token + field, 0);
  return shape;
}

// Removes the fields of learned weights. `line`: their prefix.
inline void leave_out_weights(PayloadShape& shape, const spec::morphological::Parameters& p,
                              const std::string& line) {
  if (p.area != spec::morphological::AreaSource::kLearned)
    for (const char* const field : {"learned", "start_class", "end_class"})
      shape.widths.emplace_back(line + field, 0);
}

inline PayloadShape sums_shape(const spec::morphological::Parameters& p) {
  PayloadShape shape = descriptor_shape(p, "run.", "run.run.");
  leave_out_weights(shape, p, "");
  return shape;
}

inline PayloadShape line_shape(const spec::morphological::Parameters& p) {
  PayloadShape shape;
  leave_out_weights(shape, p, "line.");
  if (!p.round_corners) shape.widths.emplace_back("line.run.far", 0);
  if (p.border != spec::morphological::Border::kClamp)
    shape.widths.emplace_back("line.run.endless", 0);
  if (p.ends != spec::morphological::Ends::kCrossings) shape.widths.emplace_back("entry", 0);
  return shape;
}

// RunExtractor -> EndpointPredictor.
struct RunToken {
  spec::morphological::RunDescriptor run;
  // With crossings: entry is which of its column's two entries a vertical run uses. beyond: edges
  // along the run continue, bit 0 before its start, bit 1 after its end.
  std::uint8_t entry, beyond;
  std::uint32_t slot;  // low bits of the number of the slot in which the run was found
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("run", self.run);
    visit("slot", self.slot, 15, "U15");
    visit("entry", self.entry, 1, "U1");
    visit("beyond", self.beyond, 2, "edges continue: before the start, after the end");
  }
};

// EndpointPredictor -> LineUnit: sums over corners -left .. right + 1 of the line.
struct SumsToken {
  RunToken run;
  bool learned;                         // learned weights: no line
  std::uint8_t start_class, end_class;  // of its crossings, if learned
  std::uint8_t left, right;             // steps kept
  std::int16_t first, last;             // positions of the outermost corners
  std::int32_t sum, indexed_sum;        // of X_i, of i X_i
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("run", self.run);
    visit("learned", self.learned);
    visit("start_class", self.start_class, 4, "0..8");
    visit("end_class", self.end_class, 4, "0..8");
    visit("left", self.left, 5, "U5");
    visit("right", self.right, 5, "U5");
    visit("first", self.first, 13, "S13");
    visit("last", self.last, 13, "S13");
    visit("sum", self.sum, 18, "S18");
    visit("indexed_sum", self.indexed_sum, 24, "S24");
  }
};

// LineUnit -> AreaUnit.
struct LineToken {
  spec::morphological::LineDescriptor line;
  std::uint32_t slot;  // U15
  std::uint8_t entry;  // U1
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("line", self.line);
    visit("slot", self.slot, 15, "U15");
    visit("entry", self.entry, 1, "U1");
  }
};

// AreaUnit -> RunExtractor: number of finished descriptors, by parity of their slot's row.
struct FinishToken {
  std::array<std::uint8_t, 2> count;  // U4
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("count", self.count, 4, "U4");
  }
};

// Blender -> SlotSequencer: the last beat of the frame has been pushed.
struct FrameDoneToken {
  std::uint32_t slot;  // U27, its slot number
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("slot", self.slot, 27, "U27");
  }
};

// One link or port per built lane.
template <class T>
struct LaneLinks {
  std::deque<Link<T>> lane;
  LaneLinks(const char* name, int lanes, const PayloadShape& shape = {}) {
    for (int i = 0; i < lanes; ++i) lane.emplace_back((name + std::to_string(i)).c_str(), 2, shape);
  }
};
template <class Port>
class LanePorts {
 public:
  LanePorts(const char* name, int lanes) {
    for (int i = 0; i < lanes; ++i)
      at_[static_cast<std::size_t>(i)] = &lane_.emplace_back((name + std::to_string(i)).c_str());
  }
  Port& operator[](std::size_t i) { return *at_[i]; }
  // Is data available at any of the first `lanes` ports?
  bool any_arrives(Cycle cycle, std::size_t lanes) const {
    bool arrives = false;
    for (std::size_t i = 0; i < lanes; ++i) arrives |= at_[i]->can_pop(cycle);
    return arrives;
  }
  template <class T>
  void bind(LaneLinks<T>& links) {
    for (std::size_t i = 0; i < lane_.size(); ++i) lane_[i].bind(links.lane[i]);
  }

 private:
  std::deque<Port> lane_;  // a deque, since ports must not move
  std::array<Port*, spec::morphological::kMaxLanes> at_{};
};

}  // namespace deburr::rtl::morphological
