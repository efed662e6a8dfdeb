// SPDX-License-Identifier: MIT
// Golden model of the posteriser, pixel by pixel.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "spec/posteriser/packets.h"
#include "spec/posteriser/parameters.h"

namespace deburr::golden::posteriser {

// The code of a level.
int code_of_level(int level, int bits);
// The level of a code.
int level_of(const spec::posteriser::Configuration& configuration, int code);

std::vector<spec::posteriser::Tone> posterised(const spec::posteriser::Configuration& configuration,
                                               std::span<const spec::posteriser::Tone> picture);

}  // namespace deburr::golden::posteriser
