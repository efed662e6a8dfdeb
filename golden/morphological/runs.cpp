// SPDX-License-Identifier: MIT
#include "golden/morphological/runs.h"

#include "golden/morphological/configuration.h"

namespace deburr::golden::morphological {

int run_shape(const AxisEdges& edges, int line, int first, int end) {
  return edges.crossings(first, line) + 4 * edges.crossings(end, line);
}

RunParts records_of(const AxisEdges& edges, int reach, int line, int first, int end) {
  const auto record = [&](spec::morphological::RunPart part, int start, int length, int shape) {
    return spec::morphological::RunRecord{edges.axis,
                                          part,
                                          static_cast<std::uint16_t>(line),
                                          static_cast<std::uint16_t>(start),
                                          static_cast<std::uint16_t>(length),
                                          static_cast<std::uint8_t>(shape)};
  };
  const int shape = run_shape(edges, line, first, end);
  if (end - first <= reach) {
    return {{record(spec::morphological::RunPart::kWhole, first, end - first, shape), {}}, 1};
  }
  const int half = reach / 2;
  return {{record(spec::morphological::RunPart::kHead, first, half, shape & 3),
           record(spec::morphological::RunPart::kTail, end - half, half, shape & 12)},
          2};
}

std::vector<spec::morphological::RunRecord> find_runs(
    const spec::morphological::Parameters& parameters, const AxisEdges& edges) {
  std::vector<spec::morphological::RunRecord> records;
  for (int line = 0; line < edges.along.height(); ++line) {
    for_each_run(edges.along, line, [&](int first, int end) {
      for (const spec::morphological::RunRecord& record :
           records_of(edges, reach(parameters, edges.axis), line, first, end)) {
        records.push_back(record);
      }
    });
  }
  return records;
}

}  // namespace deburr::golden::morphological
