// SPDX-License-Identifier: MIT
// Trace parameters that only a texture unit has (docs/reference/traces.md).
#pragma once

#include <string>

#include "tb/traces/trace_file.h"

namespace deburr::tb {

// For every engine that contains a texture unit.
struct LookupTrace {
  bool lookups = false;
};

template <class Visitor>
void describe(LookupTrace& p, Visitor& v) {
  v.boolean("line_trace_lookups", p.lookups,
            "lines.trace also lists every lookup of the texture cache and its outcome.");
}

struct FragmentTraceOut {
  traces::TraceChoice fragments = traces::TraceChoice::kNone;
};

template <class Visitor>
void describe(FragmentTraceOut& p, Visitor& v) {
  v.choice("fragment_trace", p.fragments, traces::kTraceChoiceNames,
           "Writes fragments.trace: every quad sent to the texture unit.");
}

struct FragmentTraceIn {
  std::string file;
};

template <class Visitor>
void describe(FragmentTraceIn& p, Visitor& v) {
  v.text("fragments", p.file, "file",
         "Fragment trace of another rasteriser, instead of the scene's own fragments; the scene "
         "then only provides the textures (docs/reference/traces.md).");
}

}  // namespace deburr::tb
