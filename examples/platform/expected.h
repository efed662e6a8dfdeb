// SPDX-License-Identifier: MIT
// The picture that the golden models compute, without buses, clocks and registers.
#pragma once

#include <cstdint>
#include <span>

#include "painter.h"
#include "spec/morphological/parameters.h"
#include "spec/texture/parameters.h"

namespace platform {

// `memory` begins at kMemory and holds the texture. The parameters are those of the engines.
Frame expected(const deburr::spec::texture::Parameters& texture,
               const deburr::spec::morphological::Parameters& smoother,
               std::span<const std::uint8_t> memory);

}  // namespace platform
