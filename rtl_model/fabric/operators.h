// SPDX-License-Identifier: MIT
// The operators of which a stage is built, with their widths in bits, as data. The text of the
// datasheets and the estimate of gates and nanoseconds are made from them (tool/cost/estimate.h).
//
//   .operators = {2 * op::multiply(23, 23), 28 * op::add(38)},
//   .longest = {op::multiply(23, 23)}
#pragma once

#include <concepts>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace deburr::rtl {

enum class OperatorKind : std::uint8_t {
  kAdd,
  kSubtract,
  kCompare,  // less than
  kEqual,
  kMagnitude,  // of a signed value
  kMaximum,    // or minimum: comparison and choice
  kMux,        // b values of a bits
  kMultiply,   // a x b
  kSquare,
  kMultiplyConstant,  // a bits, b additions
  kShift,             // a bits by a variable number of b positions
  kLeadingOne,
  kRootStage,  // two bits of a square root, with a rest of a bits
  kCountOnes,
  kPriority,  // the first of a
  kRomRead,   // b words of a bits, as logic
  kLogic,     // a NAND gates: hashes, codes, control
};

struct Operator {
  OperatorKind kind = OperatorKind::kLogic;
  std::uint32_t a = 0, b = 0;
  std::uint32_t count = 1;
  friend bool operator==(const Operator&, const Operator&) = default;
};

template <std::integral Count>
constexpr Operator operator*(Count count, Operator one) {
  one.count *= static_cast<std::uint32_t>(count);
  return one;
}

namespace op {

constexpr Operator add(std::uint32_t bits) { return {OperatorKind::kAdd, bits}; }
constexpr Operator subtract(std::uint32_t bits) { return {OperatorKind::kSubtract, bits}; }
constexpr Operator compare(std::uint32_t bits) { return {OperatorKind::kCompare, bits}; }
constexpr Operator equal(std::uint32_t bits) { return {OperatorKind::kEqual, bits}; }
constexpr Operator magnitude(std::uint32_t bits) { return {OperatorKind::kMagnitude, bits}; }
constexpr Operator maximum(std::uint32_t bits) { return {OperatorKind::kMaximum, bits}; }
// Of one input: wires.
constexpr Operator mux(std::uint32_t bits, std::uint32_t inputs) {
  return {OperatorKind::kMux, bits, inputs, inputs > 1 ? 1u : 0u};
}
constexpr Operator multiply(std::uint32_t a, std::uint32_t b) {
  return {OperatorKind::kMultiply, a, b};
}
constexpr Operator square(std::uint32_t bits) { return {OperatorKind::kSquare, bits}; }
// A shift by a constant is wires; a multiply by a constant is additions, one fewer than its
// non-zero signed digits.
constexpr Operator multiply_constant(std::uint32_t bits, std::uint32_t additions) {
  return {OperatorKind::kMultiplyConstant, bits, additions};
}
constexpr Operator shift(std::uint32_t bits, std::uint32_t positions) {
  return {OperatorKind::kShift, bits, positions};
}
constexpr Operator leading_one(std::uint32_t bits) { return {OperatorKind::kLeadingOne, bits}; }
constexpr Operator root_stage(std::uint32_t bits) { return {OperatorKind::kRootStage, bits}; }
constexpr Operator count_ones(std::uint32_t bits) { return {OperatorKind::kCountOnes, bits}; }
constexpr Operator priority(std::uint32_t inputs) { return {OperatorKind::kPriority, inputs}; }
constexpr Operator rom_read(std::uint32_t bits, std::uint32_t words) {
  return {OperatorKind::kRomRead, bits, words};
}
constexpr Operator logic(std::uint32_t gates) { return {OperatorKind::kLogic, gates}; }

}  // namespace op

const char* name_of(OperatorKind kind);  // "multiply_constant": the key in tool/cost/osu018.json

// "2 multiplies 23 x 23"; without the count "multiply 23 x 23".
std::string counted(const Operator& one);
std::string text_of(const Operator& one);
// "add 38 (28), 41; multiply 23 x 23 (2)": equal ones with their number in brackets.
std::string by_kind(std::span<const Operator> operators);
// Equal operators in one, in the order of their first; without those of count 0 (not built).
std::vector<Operator> summed(std::span<const Operator> operators);

}  // namespace deburr::rtl
