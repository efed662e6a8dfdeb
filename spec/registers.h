// SPDX-License-Identifier: MIT
// How a 32-bit register is declared once: offset, name, access, reset value and meaning. The
// register sockets, the generated header and the tables of the docs read these.
#pragma once

#include <cstdint>
#include <string_view>

namespace deburr::spec {

enum class Access : std::uint8_t { kReadOnly, kReadWrite, kWriteOneToClear, kCommand };

struct RegisterInfo {
  std::uint32_t offset;
  std::string_view name;
  Access access;
  std::uint32_t reset;
  std::string_view meaning;
};

}  // namespace deburr::spec
