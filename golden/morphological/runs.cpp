// SPDX-License-Identifier: MIT
#include "golden/morphological/runs.h"

#include <algorithm>

#include "golden/morphological/configuration.h"

namespace deburr::golden::morphological {
namespace {

// Ends that continue outside the frame: bit 0 the start, bit 1 the end.
int endless_ends(const AxisEdges& edges, int line, int first, int end) {
  if (edges.border != spec::morphological::Border::kClamp) return 0;
  const bool end_crosses = edges.end_crossings(end, line) != 0;
  return (first == 0 ? 1 : 0) | (end == edges.along.width() && !end_crosses ? 2 : 0);
}

}  // namespace

int next_crossing(const AxisEdges& edges, int line, int from, int end) {
  const std::uint64_t* first_side = line > 0 ? edges.across.row(line - 1) : nullptr;
  const std::uint64_t* second_side = edges.across.row(line);
  std::uint64_t unseen = ~std::uint64_t{0} << (from & 63);
  for (int i = from >> 6; 64 * i < end; ++i, unseen = ~std::uint64_t{0}) {
    const std::uint64_t crossings =
        ((first_side != nullptr ? first_side[i] : 0) | second_side[i]) & unseen;
    if (crossings != 0) return std::min(end, 64 * i + std::countr_zero(crossings));
  }
  return end;
}

int run_shape(const AxisEdges& edges, int line, int first, int end) {
  return edges.end_crossings(first, line) + 4 * edges.end_crossings(end, line);
}

RunParts descriptors_of(const spec::morphological::Parameters& parameters, const AxisEdges& edges,
                        int line, int first, int end) {
  const auto descriptor = [&](spec::morphological::RunPart part, int start, int length, int shape,
                              int far, int endless) {
    return spec::morphological::RunDescriptor{edges.axis,
                                              part,
                                              static_cast<std::uint16_t>(line),
                                              static_cast<std::uint16_t>(start),
                                              static_cast<std::uint16_t>(length),
                                              static_cast<std::uint8_t>(shape),
                                              static_cast<std::uint8_t>(far),
                                              static_cast<std::uint8_t>(endless)};
  };
  const int shape = run_shape(edges, line, first, end);
  const int endless = endless_ends(edges, line, first, end);
  const auto far_of = [&](int position, bool beyond) {
    return parameters.round_corners && !beyond ? edges.far_crossings(position, line) : 0;
  };
  const int far = far_of(first, (endless & 1) != 0) + 4 * far_of(end, (endless & 2) != 0);
  const int longest = search_range(parameters, edges.axis);
  if (end - first <= longest) {
    return {
        {descriptor(spec::morphological::RunPart::kWhole, first, end - first, shape, far, endless),
         {}},
        1};
  }
  const int half = longest / 2;
  return {{descriptor(spec::morphological::RunPart::kHead, first, half, shape & 3, far & 3,
                      endless & 1),
           descriptor(spec::morphological::RunPart::kTail, end - half, half, shape & 12, far & 12,
                      endless & 2)},
          2};
}

std::vector<spec::morphological::RunDescriptor> find_runs(
    const spec::morphological::Parameters& parameters, const AxisEdges& edges) {
  std::vector<spec::morphological::RunDescriptor> descriptors;
  for (int line = 0; line < edges.along.height(); ++line) {
    for_each_run(edges, parameters.ends, line, [&](int first, int end) {
      for (const spec::morphological::RunDescriptor& descriptor :
           descriptors_of(parameters, edges, line, first, end)) {
        descriptors.push_back(descriptor);
      }
    });
  }
  return descriptors;
}

}  // namespace deburr::golden::morphological
