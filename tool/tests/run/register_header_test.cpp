// SPDX-License-Identifier: MIT
// The C header of the registers, read back and compared with the field rows of every engine: each
// number exists, matches its row, and no others exist. Two names that are equal in C would lose
// one. systemrdl_test.py compares SystemRDL with this header, and c_header_test.py compares some
// numbers with the contract by hand.
#include <gtest/gtest.h>

#include <cctype>
#include <map>
#include <regex>
#include <string>

#include "rtl_model/fabric/register_section.h"
#include "tool/run/engine.h"
#include "tool/run/reference_pages.h"

namespace deburr::tool::register_header_test {
namespace {

using Macros = std::map<std::string, std::uint32_t>;

Macros read_back(const std::string& header) {
  static const std::regex kDefinition("#define (\\w+) (0x[0-9A-F]+|[0-9]+)u( /\\*.*)?");
  Macros macros;
  std::size_t at = 0;
  while ((at = header.find("#define ", at)) != std::string::npos) {
    const std::string line = header.substr(at, header.find('\n', at) - at);
    at += line.size();
    std::smatch match;
    if (!std::regex_match(line, match, kDefinition)) {
      // The include guard, and macros with parameters, which are tested in C.
      EXPECT_TRUE(line == "#define DEBURR_REGISTERS_H" || line.find('(') < line.find_last_of(' '))
          << line;
      continue;
    }
    const bool first =
        macros.emplace(match[1], static_cast<std::uint32_t>(std::stoul(match[2], nullptr, 0)))
            .second;
    EXPECT_TRUE(first) << match[1] << " is there twice";
  }
  return macros;
}

std::string in_c(std::string_view name) {
  std::string text;
  for (const char c : name)
    text += std::isalnum(static_cast<unsigned char>(c)) != 0
                ? static_cast<char>(std::toupper(static_cast<unsigned char>(c)))
                : '_';
  return text;
}

Macros of_rows(const rtl::RegisterSection& section) {
  Macros macros;
  const auto define = [&macros](const std::string& name, std::uint32_t value) {
    EXPECT_TRUE(macros.emplace(name, value).second) << name << " would be there twice";
  };
  for (const spec::RegisterInfo& row : section.rows) {
    const std::string name = section.macros + "_" + in_c(row.name);
    define(name, row.offset);
    std::uint32_t reset = row.reset();
    for (const spec::LoadedRegister& loaded : section.loaded)
      if (loaded.offset == row.offset) reset = loaded.value;
    if (reset != 0) define(name + "_RESET", reset);
    if (row.is_number()) continue;
    for (const spec::Field& field : row.fields) {
      const std::string full = name + "_" + in_c(field.name);
      std::uint32_t mask = 0;
      for (unsigned bit = field.low; bit <= field.high; ++bit) mask |= std::uint32_t{1} << bit;
      define(full + "_MASK", mask);
      define(full + "_SHIFT", field.low);
      for (std::uint32_t code = 0; code < field.codes.size(); ++code)
        define(full + "_" + in_c(field.codes[code]), code);
    }
  }
  if (section.repeated) {
    define(section.macros + "_STRIDE", section.repeated->stride);
    define(section.macros + "_COUNT", section.repeated->count);
  }
  return macros;
}

TEST(RegisterHeader, MatchesFieldRows) {
  const auto all = engines();
  Macros expected;
  std::size_t sections = 0;
  for (const rtl::RegisterSection& section : register_sections(all)) {
    ++sections;
    for (const auto& [name, value] : of_rows(section))
      EXPECT_TRUE(expected.emplace(name, value).second) << name << " is of two engines";
  }
  EXPECT_GE(sections, 3u);
  EXPECT_GE(expected.size(), 300u);
  const std::string header = registers_header(all);
  EXPECT_EQ(read_back(header), expected);
  // A lost or changed number is detected.
  std::string changed = header;
  const std::size_t at = changed.find("_SHIFT 1u");
  ASSERT_NE(at, std::string::npos);
  changed[at + 7] = '2';
  EXPECT_NE(read_back(changed), expected);
  changed.erase(changed.rfind("#define ", at), 8);
  EXPECT_NE(read_back(changed), expected);
}

// A program may be built without engines.
TEST(RegistersPage, OmitsSectionsWithoutEngines) {
  const std::string page = registers_page({});
  EXPECT_TRUE(page.starts_with("# Registers\n"));
  EXPECT_EQ(page.find("\n## "), std::string::npos);
  EXPECT_TRUE(coverage_page({}).starts_with("# Coverage\n"));
}

}  // namespace
}  // namespace deburr::tool::register_header_test
