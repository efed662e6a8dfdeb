// SPDX-License-Identifier: MIT
// Compares the bits of each field of a token with its number format.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "rtl_model/fabric/payload.h"

namespace deburr::tb {

// Bits of "U15.16", "S7.24" (plus one for the sign), "U8", "S13" (including the sign); 0: not a
// number format.
inline std::uint32_t bits_of_format(const std::string& format) {
  if (format.size() < 2 || (format[0] != 'U' && format[0] != 'S')) return 0;
  char* end = nullptr;
  unsigned long bits = std::strtoul(format.c_str() + 1, &end, 10);
  if (end == format.c_str() + 1) return 0;
  if (*end == '.') bits += std::strtoul(end + 1, &end, 10) + (format[0] == 'S' ? 1 : 0);
  return *end == '\0' ? static_cast<std::uint32_t>(bits) : 0;
}

// Expects the width of every field with a number format, and returns the number of such fields.
template <class... Tokens>
int expect_widths_of_formats() {
  int checked = 0;
  const auto check = [&](const rtl::Payload& payload) {
    for (const rtl::Field& field : payload.fields()) {
      const std::uint32_t bits = bits_of_format(field.format);
      if (bits == 0) continue;
      EXPECT_EQ(field.bits, bits) << field.name << " is " << field.format;
      ++checked;
    }
  };
  (check(rtl::Payload::of<Tokens>()), ...);
  return checked;
}

}  // namespace deburr::tb
