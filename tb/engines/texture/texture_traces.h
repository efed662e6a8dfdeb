// SPDX-License-Identifier: MIT
// Parameters of the traces that only a texture unit has (docs/reference/traces.md).
#pragma once

#include <string>

#include "tb/traces/trace_file.h"

namespace deburr::tb {

// Of every engine with a texture unit in it.
struct LookupTrace {
  bool lookups = false;
};

template <class Visitor>
void describe(LookupTrace& p, Visitor& v) {
  v.boolean("line_trace_lookups", p.lookups,
            "lines.trace has every look-up of the texture cache too, and what came of it.");
}

struct FragmentTraceOut {
  traces::TraceChoice fragments = traces::TraceChoice::kNone;
};

template <class Visitor>
void describe(FragmentTraceOut& p, Visitor& v) {
  v.choice("fragment_trace", p.fragments, traces::kTraceChoiceNames,
           "Leaves fragments.trace: every quad that the texture unit is given.");
}

struct FragmentTraceIn {
  std::string file;
};

template <class Visitor>
void describe(FragmentTraceIn& p, Visitor& v) {
  v.text("fragments", p.file, "file",
         "Fragments of another rasteriser instead of the scene's own, which then gives the "
         "textures alone (docs/reference/traces.md).");
}

}  // namespace deburr::tb
