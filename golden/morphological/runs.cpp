// SPDX-License-Identifier: MIT
#include "golden/morphological/runs.h"

#include <algorithm>

#include "golden/morphological/configuration.h"

namespace deburr::golden::morphological {

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
  return edges.crossings(first, line) + 4 * edges.crossings(end, line);
}

RunParts records_of(const spec::morphological::Parameters& parameters, const AxisEdges& edges,
                    int line, int first, int end) {
  const auto record = [&](spec::morphological::RunPart part, int start, int length, int shape,
                          int far) {
    return spec::morphological::RunRecord{edges.axis,
                                          part,
                                          static_cast<std::uint16_t>(line),
                                          static_cast<std::uint16_t>(start),
                                          static_cast<std::uint16_t>(length),
                                          static_cast<std::uint8_t>(shape),
                                          static_cast<std::uint8_t>(far)};
  };
  const int shape = run_shape(edges, line, first, end);
  const int far = parameters.round_corners
                      ? edges.far_crossings(first, line) + 4 * edges.far_crossings(end, line)
                      : 0;
  const int longest = reach(parameters, edges.axis);
  if (end - first <= longest) {
    return {{record(spec::morphological::RunPart::kWhole, first, end - first, shape, far), {}}, 1};
  }
  const int half = longest / 2;
  return {{record(spec::morphological::RunPart::kHead, first, half, shape & 3, far & 3),
           record(spec::morphological::RunPart::kTail, end - half, half, shape & 12, far & 12)},
          2};
}

std::vector<spec::morphological::RunRecord> find_runs(
    const spec::morphological::Parameters& parameters, const AxisEdges& edges) {
  std::vector<spec::morphological::RunRecord> records;
  for (int line = 0; line < edges.along.height(); ++line) {
    for_each_run(edges, parameters.ends, line, [&](int first, int end) {
      for (const spec::morphological::RunRecord& record :
           records_of(parameters, edges, line, first, end)) {
        records.push_back(record);
      }
    });
  }
  return records;
}

}  // namespace deburr::golden::morphological
