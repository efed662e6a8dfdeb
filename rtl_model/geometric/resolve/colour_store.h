// SPDX-License-Identifier: MIT
// Lines of colours on their way from memory to the resolve.
//
// Where: between BlockFetch, which reserves places and fills them, and Resolver, which takes the
// lines out in the order in which they were asked for. Each holds its side alone. Timing and cost
// are the FillStore's.
#pragma once

#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/geometric/common/fill_store.h"
#include "spec/geometric/parameters.h"
#include "spec/geometric/records.h"

namespace deburr::rtl::geometric {

class ColourStore final : private FillStore<Line> {
 public:
  using FillStore<Line>::Filler;
  using FillStore<Line>::Reader;
  using FillStore<Line>::filler;
  using FillStore<Line>::reader;

  explicit ColourStore(const spec::geometric::Parameters& p)
      : FillStore("resolve_colours", p.resolve_lines / 2, 8 * spec::geometric::kLineBytes,
                  "colours on their way to the resolve") {}
};

}  // namespace deburr::rtl::geometric
