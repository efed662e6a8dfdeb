// SPDX-License-Identifier: MIT
// C interface of the geometric engine: vertices, edges and facing bits in the layout of memory
// (docs/reference/geometric/memory.md, "What is in memory").
#include <array>
#include <vector>

#include "golden/c/frame_handle.h"
#include "golden/c/geometric_handle.h"
#include "golden/geometric/geometric_golden.h"
#include "spec/geometric/check_build.h"
#include "spec/geometric/records.h"

namespace deburr::golden::c {
namespace {

constexpr std::size_t kRecordWords = 4;
static_assert(spec::geometric::kVertexBytes == 4 * kRecordWords &&
              spec::geometric::kEdgeBytes == 4 * kRecordWords);

enum class GeometricPlane : std::size_t { kPixels, kWeights };
constexpr std::array<Plane, 2> kGeometricPlanes = {{{"pixels", 4, false}, {"weights", 4, false}}};

using GeometricModel = ModelHandle<geometric::GeometricGolden, spec::geometric::Parameters>;

struct GeometricHandle final : GeometricModel {
  GeometricHandle() : GeometricModel(geometric_texts()) {}
  static constexpr const char* kWanted = "geometric";

  const char* engine() const override { return "geometric"; }
  std::span<const Counter> counters() override {
    shown = counters_of(spec::geometric::kWorkCounts, spec::geometric::kRegisters,
                        model.get() ? model.get()->work() : spec::geometric::Work{});
    return shown;
  }

  std::span<const Plane> planes() const override { return kGeometricPlanes; }
  void process() override {
    require(has_depth || texts.values().depth_test == spec::geometric::DepthTest::kOff,
            "the frame has no depth: call deburr_frame_depth, or set depth_test = off");
    const int w = static_cast<int>(width), h = static_cast<int>(height);
    geometric::FrameInput input;
    input.image = {pixels, w, h};
    input.depth = {depth, w, h};
    input.edges = edges;
    input.vertices = vertices;
    input.facing = {facing, faces};
    input.bases = bases;
    model.process(texts.values(), everything, [&](geometric::GeometricGolden& golden) {
      golden.set_memory_errors(error_lines);
      golden.process(input);
    });
  }
  Rgba8 plane_pixel(std::size_t plane, int x, int y) const override {
    const geometric::GeometricGolden& golden = *model.get();
    const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(golden.width()) +
                          static_cast<std::size_t>(x);
    return static_cast<GeometricPlane>(plane) == GeometricPlane::kWeights ? golden.weights()[i]
                                                                          : golden.pixels()[i];
  }

  std::vector<spec::geometric::Vertex> vertices;
  std::vector<spec::geometric::Edge> edges;
  std::vector<std::uint8_t> facing;
  std::uint32_t faces = 0;
  geometric::Bases bases;
};

// Decodes records from words. Throws ArgumentError for an incomplete record or too many records.
template <class Record, class Decode>
std::vector<Record> records_of(const std::uint32_t* words, std::size_t size, std::size_t most,
                               const char* what, Decode&& decode) {
  const auto given = array_of(words, size, "words");
  require(size % kRecordWords == 0,
          "words_size is " + std::to_string(size) + "; " + what + " have four words each");
  require(size / kRecordWords <= most,
          std::to_string(size / kRecordWords) + " " + what + "; the limit is 2^24");
  std::vector<Record> records;
  records.reserve(size / kRecordWords);
  for (std::size_t i = 0; i < size; i += kRecordWords)
    records.push_back(decode(given.subspan(i, kRecordWords)));
  return records;
}

}  // namespace
}  // namespace deburr::golden::c

using deburr::golden::c::GeometricHandle;

extern "C" {

deburr_golden* deburr_geometric_new(void) {
  return deburr::golden::c::new_handle<GeometricHandle>();
}

int deburr_geometric_base(deburr_golden* golden, const char* region, uint32_t address) {
  namespace c = deburr::golden::c;
  return c::call_of<GeometricHandle>(golden, __func__, [&](GeometricHandle& h) {
    c::require_pointer(region, "region");
    c::set_base(h.bases, region, address);
  });
}

int deburr_geometric_vertices(deburr_golden* golden, const uint32_t* words, size_t words_size) {
  namespace c = deburr::golden::c;
  namespace spec = deburr::spec::geometric;
  return c::call_of<GeometricHandle>(golden, __func__, [&](GeometricHandle& h) {
    h.vertices = c::records_of<spec::Vertex>(
        words, words_size, spec::kMaxVertices, "vertices", [](auto w) -> spec::Vertex {
          return {static_cast<std::int32_t>(w[0]), static_cast<std::int32_t>(w[1]), w[2] & 0xFFFFFF,
                  (w[3] & 1) != 0};
        });
  });
}

int deburr_geometric_edges(deburr_golden* golden, const uint32_t* words, size_t words_size) {
  namespace c = deburr::golden::c;
  namespace spec = deburr::spec::geometric;
  return c::call_of<GeometricHandle>(golden, __func__, [&](GeometricHandle& h) {
    h.edges = c::records_of<spec::Edge>(
        words, words_size, spec::kMaxEdges, "edges", [](auto w) -> spec::Edge {
          return {w[0] & spec::kIndexMask, w[1] & spec::kIndexMask, w[2] & spec::kIndexMask,
                  w[3] & spec::kIndexMask, static_cast<std::uint8_t>(w[2] >> spec::kFlagShift)};
        });
  });
}

int deburr_geometric_facing(deburr_golden* golden, uint32_t faces, const uint8_t* bits,
                            size_t bits_size) {
  namespace c = deburr::golden::c;
  return c::call_of<GeometricHandle>(golden, __func__, [&](GeometricHandle& h) {
    const auto given = c::array_of(bits, bits_size, "bits");
    const std::size_t needed = (std::size_t{faces} + 7) / 8;
    c::require(bits_size >= needed, "bits_size is " + std::to_string(bits_size) + "; the bits of " +
                                        std::to_string(faces) + " faces need " +
                                        std::to_string(needed) + " bytes");
    h.facing.assign(given.begin(), given.begin() + static_cast<std::ptrdiff_t>(needed));
    h.faces = faces;
  });
}

int deburr_geometric_classes(deburr_golden* golden, uint8_t* classes, size_t classes_size) {
  namespace c = deburr::golden::c;
  return c::call_of<GeometricHandle>(golden, __func__, [&](GeometricHandle& h) {
    const auto to = c::array_of(classes, classes_size, "classes");
    c::require(h.has_detail(),
               "classes were not kept: call deburr_frame_detail with 1 before "
               "deburr_frame_process");
    const auto& from = h.model.get()->classes();
    c::require(to.size() >= from.size(), "classes_size is " + std::to_string(to.size()) +
                                             ", but there are " + std::to_string(from.size()) +
                                             " edges");
    std::size_t i = 0;
    for (const auto each : from) to[i++] = static_cast<std::uint8_t>(each);
  });
}

}  // extern "C"
