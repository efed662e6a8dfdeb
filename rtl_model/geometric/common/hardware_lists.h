// SPDX-License-Identifier: MIT
// Lists of operators for the datasheets of units that contain fill stores and caches.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "rtl_model/fabric/operators.h"
#include "spec/geometric/parameters.h"

namespace deburr::rtl::geometric {

struct Hardware {
  std::vector<Operator> operators{};
  std::uint32_t registers = 0;  // bits
};

// Both lists without what a build does not need: a mux of one value, an operator of no bits.
inline std::vector<Operator> built(std::vector<Operator> operators,
                                   const std::vector<Operator>& more = {}) {
  operators.insert(operators.end(), more.begin(), more.end());
  std::erase_if(operators, [](const Operator& one) {
    return one.count == 0 || one.a == 0 || (one.kind == OperatorKind::kMux && one.b < 2);
  });
  return operators;
}

// Bits of a number below `values`.
constexpr std::uint32_t bits_below(std::uint32_t values) {
  return static_cast<std::uint32_t>(std::bit_width(std::max(values, 2U) - 1));
}
constexpr std::uint32_t lane_count(spec::geometric::Lanes lanes) {
  return spec::geometric::kLaneCount[static_cast<std::size_t>(lanes)];
}

// FillStore: the choice of one arrived bit, two pointers that wrap, the number of free entries.
// The arrived bits belong to its memory.
inline Hardware fill_store(std::int32_t entries) {
  const auto places = static_cast<std::uint32_t>(entries);
  const std::uint32_t bits = bits_below(places);
  return {{op::mux(1, places), 2 * op::add(bits), 2 * op::equal(bits), op::add(bits + 1),
           op::logic(3 * places)},
          3 * bits + 3};
}

// LineCache without its fill store: a comparator per port, the choice of what is written into the
// tags, the counter that clears them in SRAM, and control.
inline Hardware line_cache(std::uint32_t lines, std::uint32_t tag_bits, std::uint32_t ports,
                           bool tags_in_sram) {
  const std::uint32_t index_bits = bits_below(lines), sources = ports + tags_in_sram;
  return {built({ports * op::equal(tag_bits), (ports - 1) * op::equal(index_bits),
                 op::mux(index_bits + tag_bits, sources), op::mux(index_bits, ports),
                 (tags_in_sram ? 1U : 0U) * op::add(index_bits + 1), op::logic(24)}),
          2 * ports + 1 + (tags_in_sram ? index_bits + 1 : 0)};
}

}  // namespace deburr::rtl::geometric
