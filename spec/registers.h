// SPDX-License-Identifier: MIT
// How a 32-bit register is declared once: offset, name, meaning and fields; of each field the bits,
// the access, the reset value and the meaning. The register sockets, masks, encoders and decoders,
// the tables of the docs, the C header for a user's software and SystemRDL are made from these
// rows.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace deburr::spec {

// What software and hardware do with a field.
enum class Access : std::uint8_t {
  kConstant,        // software reads it; nothing changes it
  kReadOnly,        // software reads it; hardware changes it
  kReadWrite,       // software reads and writes it; hardware reads it
  kShared,          // software reads and writes it; hardware changes it, too
  kWriteOnly,       // software writes it
  kCommand,         // one bit: a one written to it starts something; reads as 0
  kWriteOneToClear  // hardware sets it, a one written to a bit clears that bit
};
constexpr bool is_readable(Access access) {
  return access != Access::kWriteOnly && access != Access::kCommand;
}
constexpr bool is_writable(Access access) {
  return access != Access::kConstant && access != Access::kReadOnly;
}

// Bits [high:low] of a register.
struct Field {
  std::string_view name;  // of the parameter that it holds, where there is one
  std::uint8_t high, low;
  Access access;
  std::string_view meaning;
  std::span<const std::string_view> codes{};  // the name of each, where it is a choice
  // The value after a reset, unless the parameters of a build give another one (loaded_registers()
  // of an engine). None: a reset leaves it as it is.
  std::optional<std::uint32_t> reset = 0;

  constexpr std::uint32_t mask() const { return (~std::uint32_t{0} >> (31 - high + low)) << low; }
  // The field's value out of a word, and a value in its place within one: what does not fit is
  // dropped.
  constexpr std::uint32_t of(std::uint32_t word) const { return (word & mask()) >> low; }
  constexpr std::uint32_t in(std::uint32_t value) const { return value << low & mask(); }
};

// The field of a register that is one number: it has no name.
constexpr std::array<Field, 1> number(Access access, std::optional<std::uint32_t> reset = 0) {
  return {{{{}, 31, 0, access, {}, {}, reset}}};
}
inline constexpr std::array kNumber = number(Access::kReadWrite);
inline constexpr std::array kCounter = number(Access::kReadOnly);

struct RegisterInfo {
  std::uint32_t offset;
  std::string_view name;
  std::string_view meaning;
  std::span<const Field> fields;  // from the lowest on

  constexpr bool is_number() const { return fields.size() == 1 && fields.front().name.empty(); }
  // The bits that exist; the others read as 0 and are ignored.
  constexpr std::uint32_t mask() const {
    return bits([](Access) { return true; });
  }
  constexpr std::uint32_t bits(Access access) const {
    return bits([access](Access other) { return other == access; });
  }
  constexpr std::uint32_t readable() const { return bits(is_readable); }
  constexpr std::uint32_t writable() const { return bits(is_writable); }
  // Those that keep what software writes.
  constexpr std::uint32_t written() const {
    return bits(Access::kReadWrite) | bits(Access::kShared) | bits(Access::kWriteOnly);
  }
  constexpr std::uint32_t reset() const {
    std::uint32_t word = 0;
    for (const Field& field : fields) word |= field.in(field.reset.value_or(0));
    return word;
  }

 private:
  template <class Wanted>
  constexpr std::uint32_t bits(Wanted wanted) const {
    std::uint32_t all = 0;
    for (const Field& field : fields)
      if (wanted(field.access)) all |= field.mask();
    return all;
  }
};

// A register whose reset value the parameters of a build give.
struct LoadedRegister {
  std::uint32_t offset, value;
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
inline constexpr Field kLineAddress{"address", 31, 6, Access::kReadWrite,
                                    "bits 31..6 of a multiple of 64"};

// Whether every register has fields that stand from the lowest on and share no bit, a command is
// one bit that reads as 0, and each reset value fits.
constexpr bool fields_are_in_order(std::span<const RegisterInfo> table) {
  for (const RegisterInfo& info : table) {
    if (info.fields.empty()) return false;
    for (std::size_t i = 0; i < info.fields.size(); ++i) {
      const Field& field = info.fields[i];
      if (field.high > 31 || field.low > field.high) return false;
      if (i > 0 && field.low <= info.fields[i - 1].high) return false;
      const std::uint32_t reset = field.reset.value_or(0);
      if (field.of(field.in(reset)) != reset) return false;
      if (field.access == Access::kCommand && (field.high != field.low || field.reset != 0))
        return false;
    }
  }
  return true;
}

}  // namespace deburr::spec
