// SPDX-License-Identifier: MIT
// Declaration of 32-bit registers. A row has offset, name, meaning and fields of a register; each
// field has bits, access, reset value and meaning. Register sockets, masks, encoders and decoders,
// the tables in docs/, the C header for software and the SystemRDL file are made from these rows.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace deburr::spec {

// Access to a field by software and hardware.
enum class Access : std::uint8_t {
  kConstant,        // software reads; constant
  kReadOnly,        // software reads; hardware changes
  kReadWrite,       // software reads and writes; hardware reads
  kShared,          // software reads and writes; hardware also changes
  kWriteOnly,       // software writes
  kCommand,         // one bit: writing 1 starts something; reads as 0
  kWriteOneToClear  // hardware sets; writing 1 clears the bit
};
constexpr bool is_readable(Access access) {
  return access != Access::kWriteOnly && access != Access::kCommand;
}
constexpr bool is_writable(Access access) {
  return access != Access::kConstant && access != Access::kReadOnly;
}

// Bits [high:low] of a register.
struct Field {
  std::string_view name;  // the name of its parameter, if it has one
  std::uint8_t high, low;
  Access access;
  std::string_view meaning;
  std::span<const std::string_view> codes{};  // names of the codes, for a choice
  // Value after a reset, unless loaded_registers() of the engine derives another value from the
  // build parameters. nullopt: a reset does not change the field.
  std::optional<std::uint32_t> reset = 0;

  constexpr std::uint32_t mask() const { return (~std::uint32_t{0} >> (31 - high + low)) << low; }
  // of() extracts the field from a word; in() places a value into a word and drops excess bits.
  constexpr std::uint32_t of(std::uint32_t word) const { return (word & mask()) >> low; }
  constexpr std::uint32_t in(std::uint32_t value) const { return value << low & mask(); }
};

// The only field, without a name, of a register that contains a single number.
constexpr std::array<Field, 1> number(Access access, std::optional<std::uint32_t> reset = 0) {
  return {{{{}, 31, 0, access, {}, {}, reset}}};
}
inline constexpr std::array kNumber = number(Access::kReadWrite);
inline constexpr std::array kCounter = number(Access::kReadOnly);

struct RegisterInfo {
  std::uint32_t offset;
  std::string_view name;
  std::string_view meaning;
  std::span<const Field> fields;  // lowest first

  constexpr bool is_number() const { return fields.size() == 1 && fields.front().name.empty(); }
  // Existing bits; all others read as 0 and ignore writes.
  constexpr std::uint32_t mask() const {
    return bits([](Access) { return true; });
  }
  constexpr std::uint32_t bits(Access access) const {
    return bits([access](Access other) { return other == access; });
  }
  constexpr std::uint32_t readable() const { return bits(is_readable); }
  constexpr std::uint32_t writable() const { return bits(is_writable); }
  // Bits that store what software writes.
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

// A register whose reset value is derived from the build parameters.
struct LoadedRegister {
  std::uint32_t offset, value;
};

// Find a register by its name, and a field of a register by its name, for any engine. Without a
// match they return nullptr and 0.
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

// The field of a register that holds the address of a memory line.
inline constexpr Field kLineAddress{"address", 31, 6, Access::kReadWrite,
                                    "bits 31..6 of a multiple of 64"};

// Whether fields are ordered from the lowest bit and do not overlap, commands are single bits that
// reset to 0, and reset values fit.
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
