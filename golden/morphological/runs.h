// SPDX-License-Identifier: MIT
// Runs of edges along an axis, maximal or cut at crossing edges, as descriptors with the shape
// given by their ends.
//
// Third block; docs/reference/morphological/algorithm.md, "Runs" and "Long runs";
// docs/reference/morphological/smaa.md, "Runs that end at crossings". Written for horizontal runs;
// AxisEdges shows vertical ones the same way. Source: Reshetov's L, U and Z patterns (paper 000,
// section 2); SMAA's searches.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "golden/morphological/planes.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"

namespace deburr::golden::morphological {

// Calls sink(first, end) for every maximal row of set bits, end exclusive, in order.
template <class Sink>
void for_each_run(const BitPlane& along, int line, Sink&& sink) {
  const std::uint64_t* row = along.row(line);
  int i = 0;
  std::uint64_t rest = row[0];  // not yet searched
  for (;;) {
    while (rest == 0) {
      if (++i == along.words()) return;
      rest = row[i];
    }
    const int first_bit = std::countr_zero(rest);
    const int first = 64 * i + first_bit;
    // The last word ends in a 0, so a run that fills a word continues in an existing one.
    int end_bit = first_bit + std::countr_one(rest >> first_bit);
    while (end_bit == 64) {
      rest = row[++i];
      end_bit = std::countr_one(rest);
      if (end_bit != 64) break;
    }
    sink(first, 64 * i + end_bit);
    rest &= ~std::uint64_t{0} << end_bit;
  }
}

// The first position in from..end-1 whose corner has a crossing edge, else `end`.
int next_crossing(const AxisEdges& edges, int line, int from, int end);

// Calls sink(first, end) for every run of a line, in order.
template <class Sink>
void for_each_run(const AxisEdges& edges, spec::morphological::Ends ends, int line, Sink&& sink) {
  if (ends == spec::morphological::Ends::kGaps) {
    for_each_run(edges.along, line, sink);
    return;
  }
  for_each_run(edges.along, line, [&](int first, int end) {
    while (first != end) {
      const int cut = next_crossing(edges, line, first + 1, end);
      sink(first, cut);
      first = cut;
    }
  });
}

// The index into kRunShapes from the codes of both ends.
int run_shape(const AxisEdges& edges, int line, int first, int end);

// The descriptors of a run, start first: one, or head and tail of a run longer than the search
// range.
struct RunParts {
  spec::morphological::RunDescriptor descriptor[2];
  int count = 0;
  const spec::morphological::RunDescriptor* begin() const { return descriptor; }
  const spec::morphological::RunDescriptor* end() const { return descriptor + count; }
};
RunParts descriptors_of(const spec::morphological::Parameters& parameters, const AxisEdges& edges,
                        int line, int first, int end);

// Every descriptor of the axis, by line, then by start.
std::vector<spec::morphological::RunDescriptor> find_runs(
    const spec::morphological::Parameters& parameters, const AxisEdges& edges);

}  // namespace deburr::golden::morphological
