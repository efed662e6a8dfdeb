// SPDX-License-Identifier: MIT
// The configuration of the current frame, decoded from the registers: a wire that every unit reads.
// It is loaded when a frame begins and constant until the next one.
#pragma once

#include <cstdint>

#include "rtl_model/fabric/payload.h"
#include "spec/geometric/parameters.h"

namespace deburr::rtl::geometric {

struct FrameConfiguration {
  std::uint32_t width = 0, height = 0;  // pixels
  spec::geometric::Select select{};
  spec::geometric::Crease crease{};
  spec::geometric::Cull cull{};
  spec::geometric::DepthTest depth_test{};
  std::uint32_t depth_bias = 1;    // 1..24
  std::uint32_t crease_depth = 0;  // 0..24
  spec::geometric::Combine combine{};
  bool area = false;  // coverage
  bool linear_light = false, mark = false, tiled = false, frame_copy = false;
  std::uint32_t edge_count = 0, vertex_count = 0, face_count = 0, boundary_count = 0;
  std::uint32_t edge_base = 0, vertex_base = 0, face_base = 0, depth_base = 0, colour_base = 0,
                weight_base = 0, copy_base = 0, pair_base = 0, other_pair_base = 0, coarse_base = 0;
  std::uint32_t blocks_across = 0, blocks_down = 0;
  std::uint32_t words_across = 0;  // words of the TouchedMap per row
  std::uint32_t touched_words = 0;
  std::uint32_t lines_across = 0;  // raster: memory lines per row; tiled: tiles per row

  friend bool operator==(const FrameConfiguration&, const FrameConfiguration&) = default;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("width", self.width, 14, "U14");
    visit("height", self.height, 14, "U14");
    visit("select", self.select, 2, "U2");
    visit("crease", self.crease, 2, "U2");
    visit("cull", self.cull, 1, "U1");
    visit("depth_test", self.depth_test, 2, "U2");
    visit("depth_bias", self.depth_bias, 5, "U5");
    visit("crease_depth", self.crease_depth, 5, "U5");
    visit("combine", self.combine, 2, "U2");
    visit("area", self.area);
    visit("linear_light", self.linear_light);
    visit("mark", self.mark);
    visit("tiled", self.tiled);
    visit("frame_copy", self.frame_copy);
    visit("edge_count", self.edge_count, 25, "U25");
    visit("vertex_count", self.vertex_count, 25, "U25");
    visit("face_count", self.face_count, 32, "U32");  // any value if select needs no faces
    visit("boundary_count", self.boundary_count, 25, "U25");
    visit("edge_base", self.edge_base, 32, "U32");
    visit("vertex_base", self.vertex_base, 32, "U32");
    visit("face_base", self.face_base, 32, "U32");
    visit("depth_base", self.depth_base, 32, "U32");
    visit("colour_base", self.colour_base, 32, "U32");
    visit("weight_base", self.weight_base, 32, "U32");
    visit("copy_base", self.copy_base, 32, "U32");
    visit("pair_base", self.pair_base, 32, "U32");
    visit("other_pair_base", self.other_pair_base, 32, "U32");
    visit("coarse_base", self.coarse_base, 32, "U32");
    visit("blocks_across", self.blocks_across, 12, "U12");
    visit("blocks_down", self.blocks_down, 12, "U12");
    visit("words_across", self.words_across, 5, "U5");
    visit("touched_words", self.touched_words, 16, "U16");
    visit("lines_across", self.lines_across, 11, "U11");
  }

  // Memory lines of the colour frame.
  std::uint32_t frame_lines() const {
    return tiled ? 4 * lines_across * ((height + 7) / 8) : lines_across * height;
  }
  // Byte offset of memory line (u, v): a 13 x 10 multiply.
  std::uint32_t line_offset(std::uint32_t u, std::uint32_t v) const {
    if (!tiled) return (v * lines_across + u) << 6;
    return ((v >> 1) * lines_across + (u >> 1)) << 8 | (v & 1) << 7 | (u & 1) << 6;
  }
};

// The part of the configuration that is built.
inline PayloadShape configuration_shape(const spec::geometric::Parameters& p) {
  PayloadShape shape;
  if (p.records != spec::geometric::RecordsLayout::kSplit)
    for (const char* const name : {"boundary_count", "pair_base", "other_pair_base"})
      shape.widths.emplace_back(name, 0);
  if (p.coarse_lines == spec::geometric::CoarseLines::kNone)
    shape.widths.emplace_back("coarse_base", 0);
  return shape;
}

}  // namespace deburr::rtl::geometric
