// SPDX-License-Identifier: MIT
// How a 32-bit register is declared once: offset, name, access, reset value, meaning and fields.
// The register sockets, masks, encoders and decoders, the tables of the docs and the C header for a
// user's software are made from these rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace deburr::spec {

enum class Access : std::uint8_t { kReadOnly, kReadWrite, kWriteOneToClear, kCommand };

// Bits [high:low] of a register.
struct Field {
  std::string_view name;  // of the parameter that it holds, where there is one
  std::uint8_t high, low;
  std::string_view meaning;
  std::span<const std::string_view> codes{};  // the name of each, where it is a choice

  constexpr std::uint32_t mask() const { return (~std::uint32_t{0} >> (31 - high + low)) << low; }
  // The field's value out of a word, and a value in its place within one: what does not fit is
  // dropped.
  constexpr std::uint32_t of(std::uint32_t word) const { return (word & mask()) >> low; }
  constexpr std::uint32_t in(std::uint32_t value) const { return value << low & mask(); }
};

struct RegisterInfo {
  std::uint32_t offset;
  std::string_view name;
  Access access;
  std::uint32_t reset;
  std::string_view meaning;
  std::span<const Field> fields{};  // from the lowest on; none: the whole word is one number

  // The bits that exist; the others read as 0.
  constexpr std::uint32_t mask() const {
    std::uint32_t all = fields.empty() ? ~std::uint32_t{0} : 0;
    for (const Field& field : fields) all |= field.mask();
    return all;
  }
};

// A register of a table by its name, and a field of a register by its own: what every engine has,
// wherever it has it. Without one there is none such: nullptr, no bit.
constexpr const RegisterInfo* register_named(std::span<const RegisterInfo> table,
                                             std::string_view name) {
  for (const RegisterInfo& info : table)
    if (info.name == name) return &info;
  return nullptr;
}
constexpr std::uint32_t bits_named(const RegisterInfo& info, std::string_view field) {
  for (const Field& each : info.fields)
    if (each.name == field) return each.mask();
  return 0;
}

// Of a register that holds the address of a line of memory.
inline constexpr Field kLineAddress{"address", 31, 6, "bits 31..6 of a multiple of 64"};

// Whether the fields of every register stand from the lowest on and share no bit.
constexpr bool fields_are_in_order(std::span<const RegisterInfo> table) {
  for (const RegisterInfo& info : table)
    for (std::size_t i = 0; i < info.fields.size(); ++i) {
      const Field& field = info.fields[i];
      if (field.high > 31 || field.low > field.high) return false;
      if (i > 0 && field.low <= info.fields[i - 1].high) return false;
    }
  return true;
}

}  // namespace deburr::spec
