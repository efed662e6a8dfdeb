// SPDX-License-Identifier: MIT
#include "golden/geometric/classify.h"

namespace deburr::golden::geometric {

using spec::geometric::Crease;
using spec::geometric::Edge;
using spec::geometric::EdgeClass;
using spec::geometric::Select;
namespace flag = spec::geometric::flag;

bool are_faces_there(Select select, const Edge& edge, std::uint32_t face_count) {
  if (select != Select::kEdges) return true;
  return edge.f0 < face_count && ((edge.flags & flag::kBoundary) != 0 || edge.f1 < face_count);
}

bool is_crease(Crease crease, std::uint8_t flags) {
  const bool angle = (flags & flag::kAngle) != 0;
  const bool split = (flags & flag::kSplitNormals) != 0;
  const bool seam = (flags & flag::kSeam) != 0;
  switch (crease) {
    case Crease::kOff:
      return false;
    case Crease::kPaper:
      return angle;
    case Crease::kShading:
      return (angle && split) || seam;
  }
  return false;
}

EdgeClass classify(const spec::geometric::Configuration& configuration, const Edge& edge,
                   std::uint32_t vertex_count, const FacingBits& facing) {
  if (!are_vertices_there(edge.v0, edge.v1, vertex_count)) return EdgeClass::kInvalid;
  return classify_faces(configuration, edge, facing);
}

EdgeClass classify_faces(const spec::geometric::Configuration& configuration, const Edge& edge,
                         const FacingBits& facing) {
  if (!are_faces_there(configuration.select, edge, facing.count)) return EdgeClass::kInvalid;
  if ((edge.flags & flag::kBoundary) != 0) return EdgeClass::kBoundary;
  if (configuration.select == Select::kAll) return EdgeClass::kUnclassified;
  if (configuration.select == Select::kEdges) {
    const bool first = facing.at(edge.f0), second = facing.at(edge.f1);
    if (first != second) return EdgeClass::kSilhouette;
    if (!first && configuration.cull == spec::geometric::Cull::kBack) return EdgeClass::kBack;
  }
  return is_crease(configuration.crease, edge.flags) ? EdgeClass::kCrease : EdgeClass::kFlat;
}

}  // namespace deburr::golden::geometric
