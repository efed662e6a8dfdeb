// SPDX-License-Identifier: MIT
// The picture as the golden models compute it, which know nothing of buses, cycles and registers.
#pragma once

#include <cstdint>
#include <span>

#include "painter.h"
#include "spec/morphological/parameters.h"
#include "spec/texture/parameters.h"

namespace platform {

// `memory` begins at kMemory and holds the texture. Parameters are those of the engines.
Frame expected(const deburr::spec::texture::Parameters& texture,
               const deburr::spec::morphological::Parameters& smoother,
               std::span<const std::uint8_t> memory);

}  // namespace platform
