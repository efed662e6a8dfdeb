// SPDX-License-Identifier: MIT
// Function  Decides for each edge whether it can be visible as an edge, and forwards those edges.
// Position  After the EdgeReader. With records = split it numbers the vertex pairs for the
//           PairFetch; otherwise it checks the vertex indices itself.
// Stalls    `downstream`.
// Source    Paper 002, eqs (1) to (4); docs/reference/geometric/algorithm.md.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/geometric/common/edge_latency.h"
#include "rtl_model/geometric/common/frame_configuration.h"
#include "rtl_model/geometric/common/tokens.h"
#include "spec/geometric/records.h"

namespace deburr::rtl::geometric {

class EdgeClassifier final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  In<EdgeBeat> edges_in{"edges_in"};
  std::optional<Out<KeptEdge>> edges_out;      // with records = joined
  std::optional<Out<PairNumber>> numbers_out;  // with records = split
  // Raised when an index is out of range.
  PulseOut invalid_edge_out{"invalid_edge_out"};

  EdgeClassifier(const sc_core::sc_module_name& name, ClockDomain& clock,
                 const spec::geometric::Parameters& parameters, Memory<std::uint32_t>& facing,
                 EdgeLatency& latency);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter edges{"edges", "edges", "edges read"};
  Counter boundary_edges{"boundary_edges", "edges", "boundary edges: edges of a single face"};
  Counter silhouette_edges{"silhouette_edges", "edges",
                           "edges between a front face and a back face"};
  Counter back_edges{"back_edges", "edges", "edges between two back faces, dropped by cull"};
  Counter crease_edges{"crease_edges", "edges", "creases between two front faces, or not culled"};
  Counter flat_edges{"flat_edges", "edges",
                     "edges between two front faces, or not culled, that are not creases"};
  Counter invalid_edges{"invalid_edges", "edges", "edges with an index out of range"};
  Counter kept_edges{
      "kept_edges", "edges",
      "edges whose vertices are fetched; with records = split, those passed to PairFetch"};
  Counter unpaired_edges{"unpaired_edges", "edges",
                         "records = split: edges to be kept without a vertex pair in the array"};

  static Datasheet datasheet(const spec::geometric::Parameters& parameters = {});

 private:
  struct Beat {
    EdgeBeat edges;
    std::uint8_t valid;   // bit k: the indices of lane k are in range
    std::uint8_t looked;  // bit k: its facing bits are being read
    std::uint8_t facing0, facing1;
    // Only with records = split.
    std::array<PairNumber, kLanes> number;
    std::uint8_t unpaired;  // bit k: number k is beyond its array
  };
  // Position of the next edge's vertex pair in an array.
  struct NextPair {
    std::uint32_t line = 0;   // U21
    std::uint8_t place = 0;   // U4, 0..9
    std::uint32_t count = 0;  // U24
  };
  void give_number(const FrameConfiguration& configuration, Beat& beat, std::size_t lane);
  bool can_leave(Cycle cycle) const {
    return split_ ? numbers_out->can_push(cycle) : edges_out->can_push(cycle);
  }
  void look(Cycle cycle, Beat& beat);
  void choose_bits(Cycle cycle, Beat& beat);
  void classify(Cycle cycle, const Beat& beat);
  static spec::geometric::EdgeClass class_of(const FrameConfiguration& configuration,
                                             const EdgeFields& edge, bool valid, bool facing0,
                                             bool facing1);
  Counter* counter_of(spec::geometric::EdgeClass c);
  void leave(Cycle cycle);

  static constexpr std::uint8_t kEnd = 1u << kLanes;  // bit of pending_
  EdgeLatency& latency_;                              // measuring instrument
  const bool split_;
  std::vector<ReadPort<std::uint32_t>> ports_;  // lane, face
  Pipe<Beat, 3> pipe_;
  std::uint8_t pending_ = 0;      // lanes of the beat in stage 3 that have not left yet
  std::uint8_t creases_ = 0;      // lanes that are creases
  std::array<NextPair, 2> next_;  // boundaries, other edges; of the beat that follows stage 1
};

}  // namespace deburr::rtl::geometric
