// SPDX-License-Identifier: MIT
#include "golden/geometric/coarse.h"

namespace deburr::golden::geometric {

CoarseLayout::CoarseLayout(int width, int height)
    : columns_(lines_of(static_cast<std::uint32_t>(width), kPixels)),
      rows_(lines_of(static_cast<std::uint32_t>(height), kPixels)),
      lines_across_(lines_of(columns_, std::uint32_t{spec::geometric::kCoarseAcross})) {}

}  // namespace deburr::golden::geometric
