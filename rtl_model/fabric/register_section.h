// SPDX-License-Identifier: MIT
// Generated descriptions of an engine's registers: a section of docs/reference/registers.md, C
// macros, SystemRDL 2.0, from which other tools generate IP-XACT, and UVM register models. Each
// engine provides one by register_section() (rtl_model/NAME/register_section.h).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "spec/registers.h"

namespace deburr::rtl {

// Repeated registers: those in the section whose names begin with NAME0_ represent all copies.
struct RepeatedRegisters {
  std::string name;  // in capitals: TEXTURE
  std::uint32_t stride = 0, count = 0;
};

struct RegisterSection {
  std::string module;  // title on its page; empty: the engine has no registers of its own
  std::string macros;  // prefix of its macros
  std::vector<spec::RegisterInfo> rows;
  std::vector<spec::LoadedRegister> loaded{};  // set by parameters of the build
  bool busy_ignores_writes = false;            // except those to CONTROL and STATUS
  std::optional<RepeatedRegisters> repeated{};
};

// Markdown tables: | offset | name | access | reset | meaning |, then the fields as | register |
// bits | field | access | reset | meaning |.
std::string register_table_markdown(std::span<const spec::RegisterInfo> table,
                                    std::span<const spec::LoadedRegister> loaded = {});
// C macros for software: PREFIX_NAME is an offset; PREFIX_NAME_RESET a reset value other than 0;
// PREFIX_NAME_FIELD_MASK and _SHIFT a field; PREFIX_NAME_FIELD_CODE a code of it.
std::string register_c_macros(std::span<const spec::RegisterInfo> table, std::string_view prefix,
                              std::span<const spec::LoadedRegister> loaded = {});
// The section of the page: tables, and the note on repeated registers.
std::string register_page(const RegisterSection& section);
// One address map per section.
std::string register_systemrdl(std::span<const RegisterSection> sections);
// A package of SystemVerilog with one uvm_reg_block per section.
std::string register_uvm(std::span<const RegisterSection> sections);
// The macros of all sections, as a header.
std::string register_c_header(std::span<const RegisterSection> sections);

}  // namespace deburr::rtl
