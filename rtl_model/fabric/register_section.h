// SPDX-License-Identifier: MIT
// What software and tools are told of an engine's registers: a section of
// docs/reference/registers.md, macros of C, and SystemRDL 2.0, of which other tools make IP-XACT
// and register models for UVM. Each engine has one (register_section() in
// rtl_model/NAME/register_section.h).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "spec/registers.h"

namespace deburr::rtl {

// Registers that are there several times: those in the section whose names begin with NAME0_ stand
// for all.
struct RepeatedRegisters {
  std::string name;  // in capitals: TEXTURE
  std::uint32_t stride = 0, count = 0;
};

struct RegisterSection {
  std::string module;  // as its page calls it; empty: the engine has no registers of its own
  std::string macros;  // what the names of its macros begin with
  std::vector<spec::RegisterInfo> rows;
  std::vector<spec::LoadedRegister> loaded{};  // by the parameters of the build
  bool busy_ignores_writes = false;            // but those to CONTROL and STATUS
  std::optional<RepeatedRegisters> repeated{};
};

// As Markdown: | offset | name | access | reset | meaning |, and after it a table of the fields,
// | register | bits | field | access | reset | meaning |.
std::string register_table_markdown(std::span<const spec::RegisterInfo> table,
                                    std::span<const spec::LoadedRegister> loaded = {});
// For a user's software, in C: PREFIX_NAME is an offset; PREFIX_NAME_RESET a reset value other than
// 0; PREFIX_NAME_FIELD_MASK and _SHIFT a field, PREFIX_NAME_FIELD_CODE a choice of it.
std::string register_c_macros(std::span<const spec::RegisterInfo> table, std::string_view prefix,
                              std::span<const spec::LoadedRegister> loaded = {});
// The section of a page: its tables, and what is repeated.
std::string register_page(const RegisterSection& section);
// An address map a section.
std::string register_systemrdl(std::span<const RegisterSection> sections);
// The macros of all sections, as a header.
std::string register_c_header(std::span<const RegisterSection> sections);

}  // namespace deburr::rtl
