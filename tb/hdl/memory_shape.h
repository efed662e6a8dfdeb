// SPDX-License-Identifier: MIT
// The port between the texture cache and memory, and which parts of its beats are built
// (docs/reference/texture/hardware.md, "Links"): for the program that prints a configuration and
// for the tests.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "rtl_model/fabric/memory_port.h"
#include "spec/texture/parameters.h"

namespace deburr::tb::hdl {

inline rtl::MemoryPortParameters memory_port_of(const spec::texture::Build& build) {
  rtl::MemoryPortParameters port;
  port.outstanding = static_cast<std::uint32_t>(build.cache_outstanding);
  port.line_bytes = std::min(static_cast<std::uint32_t>(build.cache_line_bytes), rtl::kLineBytes);
  port.max_burst_lines = static_cast<std::uint32_t>(build.cache_line_bytes) / port.line_bytes;
  port.read_only = true;
  return port;
}
// An address has 32 bits; a tag is the entry number of a line in flight.
inline std::uint32_t memory_tag_bits(const spec::texture::Build& build) {
  return static_cast<std::uint32_t>(
      std::bit_width(static_cast<std::uint32_t>(build.cache_outstanding) - 1));
}
inline rtl::PayloadShape memory_request_shape(const spec::texture::Build& build) {
  return rtl::request_shape(memory_port_of(build), 32, memory_tag_bits(build));
}
inline rtl::PayloadShape memory_response_shape(const spec::texture::Build& build) {
  return rtl::response_shape(memory_port_of(build), 32, memory_tag_bits(build));
}

}  // namespace deburr::tb::hdl
