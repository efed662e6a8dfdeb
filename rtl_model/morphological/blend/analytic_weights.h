// SPDX-License-Identifier: MIT
// Area that a descriptor's line cuts off at one of its edges: a trapezoid, or two triangles where
// the line crosses the edge.
//
// Position  In the AreaUnit after the DescriptorWalk, with whose stages it advances. The model
//           computes all stages at once.
// Source    Reshetov 2009; paper 000, section 2.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/morphological/blend/edge_weights.h"
#include "rtl_model/morphological/blend/stored_descriptor.h"
#include "spec/morphological/shapes.h"

namespace deburr::rtl::morphological {

class AnalyticWeights final : public sc_core::sc_module {
 public:
  explicit AnalyticWeights(const sc_core::sc_module_name& name) : sc_module(name) {}

  // Weights at pixel k of a descriptor.
  static EdgeWeights of(const StoredDescriptor& descriptor, std::uint32_t k) {
    const std::int64_t t0 = descriptor.t + std::int64_t{descriptor.growth} * k,
                       t1 = t0 + descriptor.growth;
    const std::uint32_t q0 = quantise(t0), q1 = quantise(t1);
    std::uint32_t before = 0, after = 0;
    if (t1 <= 0) {
      before = trapezoid(q0, q1);
    } else if (t0 >= 0) {
      after = trapezoid(q0, q1);
    } else {
      before = triangle(q0, descriptor.inverse);
      after = triangle(q1, descriptor.inverse);
    }
    using spec::morphological::Side;
    std::uint32_t first = 0, second = 0;
    (descriptor.before == Side::kFirst ? first : second) +=
        descriptor.before == Side::kNone ? 0 : before;
    (descriptor.after == Side::kFirst ? first : second) +=
        descriptor.after == Side::kNone ? 0 : after;
    return {static_cast<std::uint8_t>(limit(first)), static_cast<std::uint8_t>(limit(second)),
            descriptor.span};
  }

  static Datasheet datasheet(const spec::morphological::Parameters& parameters = {});

 private:
  // |t|, S.24, to U1.12: rounded, saturated.
  static std::uint32_t quantise(std::int64_t t) {
    constexpr int kDrop = 12;
    const auto magnitude = static_cast<std::uint64_t>(std::abs(t));
    return static_cast<std::uint32_t>(
        std::min<std::uint64_t>(4096, (magnitude + (1u << (kDrop - 1))) >> kDrop));
  }
  static std::uint32_t limit(std::uint64_t weight) {
    return static_cast<std::uint32_t>(
        std::min<std::uint64_t>(weight, spec::morphological::kMaxWeight));
  }
  // (U1.12 + U1.12) / 2, to U0.8.
  static std::uint32_t trapezoid(std::uint32_t q0, std::uint32_t q1) {
    return limit((q0 + q1 + 16) >> 5);
  }
  // U2.24 x U12.12 / 2, to U0.8.
  static std::uint32_t triangle(std::uint32_t q, std::uint32_t inverse) {
    return limit((std::uint64_t{q} * q * inverse + (std::uint64_t{1} << 28)) >> 29);
  }
};

}  // namespace deburr::rtl::morphological
