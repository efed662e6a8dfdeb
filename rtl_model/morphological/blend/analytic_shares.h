// SPDX-License-Identifier: MIT
// The area that a record's line cuts off at one of its edges: a trapezoid, or two triangles where
// the line crosses the edge.
//
// Where: in the AreaUnit, behind its RecordWalk, with whose stages it moves. The model does the
// arithmetic at once, as an edge is asked for. Source: Reshetov 2009; paper 000, section 2.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/morphological/blend/edge_shares.h"
#include "rtl_model/morphological/blend/stored_record.h"
#include "spec/morphological/shapes.h"

namespace deburr::rtl::morphological {

class AnalyticShares final : public sc_core::sc_module {
 public:
  explicit AnalyticShares(const sc_core::sc_module_name& name) : sc_module(name) {}

  // Of pixel k of a record.
  static EdgeShares of(const StoredRecord& record, std::uint32_t k) {
    const std::int64_t t0 = record.t + std::int64_t{record.growth} * k, t1 = t0 + record.growth;
    const std::uint32_t q0 = quantise(t0), q1 = quantise(t1);
    std::uint32_t before = 0, after = 0;
    if (t1 <= 0) {
      before = trapezoid(q0, q1);
    } else if (t0 >= 0) {
      after = trapezoid(q0, q1);
    } else {
      before = triangle(q0, record.inverse);
      after = triangle(q1, record.inverse);
    }
    using spec::morphological::Side;
    std::uint32_t first = 0, second = 0;
    (record.before == Side::kFirst ? first : second) += record.before == Side::kNone ? 0 : before;
    (record.after == Side::kFirst ? first : second) += record.after == Side::kNone ? 0 : after;
    return {static_cast<std::uint8_t>(limit(first)), static_cast<std::uint8_t>(limit(second)),
            record.span};
  }

  static Datasheet datasheet();

 private:
  // |t|, S.24, to U1.12: rounded, saturated.
  static std::uint32_t quantise(std::int64_t t) {
    constexpr int kDrop = 12;
    const auto magnitude = static_cast<std::uint64_t>(std::abs(t));
    return static_cast<std::uint32_t>(
        std::min<std::uint64_t>(4096, (magnitude + (1u << (kDrop - 1))) >> kDrop));
  }
  static std::uint32_t limit(std::uint64_t share) {
    return static_cast<std::uint32_t>(
        std::min<std::uint64_t>(share, spec::morphological::kMaxWeight));
  }
  // U1.12 + U1.12, halved, to U0.8.
  static std::uint32_t trapezoid(std::uint32_t q0, std::uint32_t q1) {
    return limit((q0 + q1 + 16) >> 5);
  }
  // U2.24 x U12.12, halved, to U0.8.
  static std::uint32_t triangle(std::uint32_t q, std::uint32_t inverse) {
    return limit((std::uint64_t{q} * q * inverse + (std::uint64_t{1} << 28)) >> 29);
  }
};

}  // namespace deburr::rtl::morphological
