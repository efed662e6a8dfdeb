// SPDX-License-Identifier: MIT
#pragma once

#include "spec/geometric/parameters.h"
#include "tb/harness/other_configuration.h"

namespace deburr::tb {

// The same hardware with a different configuration as reset values, which software must overwrite
// completely.
inline spec::geometric::Parameters unprogrammed(spec::geometric::Parameters p) {
  using spec::geometric::CoarseLines, spec::geometric::DepthTest, spec::geometric::Layout;
  OtherConfiguration other;
  describe(static_cast<spec::geometric::Configuration&>(p), other);
  p.layout = p.layout == Layout::kTiled ? Layout::kRaster : Layout::kTiled;
  p.frame_copy = !p.frame_copy;
  // An engine with coarse depth cannot be built without a depth test.
  if (p.depth_test == DepthTest::kOff && p.coarse_lines != CoarseLines::kNone)
    p.depth_test = DepthTest::kOwn;
  return p;
}

}  // namespace deburr::tb
