// SPDX-License-Identifier: MIT
// Function  Forwards the memory requests of all units to the single memory port, round robin, and
//           returns each response to its client.
// Position  Between the units and the MemoryPort.
// Stalls    `downstream` (the port does not accept the request). Responses never wait: units take
//           them in the cycle of arrival.
//
// The tag is the client index and the client's own number. A response with an error is counted,
// raises `memory_error` and reads as zeros.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/arbiter.h"
#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/histogram.h"
#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "spec/geometric/parameters.h"

namespace deburr::rtl::geometric {

enum class Client : std::uint8_t {
  kFacing,
  kEdges,
  kVertices,
  kDepth,
  kWeights,
  kBlocks,
  kResolve,
  kCopy,
  kPairs,  // records = split
  kCoarse  // coarse_lines
};
inline constexpr std::size_t kClients = 10;
inline constexpr std::array<const char*, kClients> kClientNames = {
    "facing", "edges",   "vertices", "depth", "weights",
    "blocks", "resolve", "copy",     "pairs", "coarse"};
inline constexpr std::uint32_t kPlaceBits = 12;  // of a client's own number

// In the order of Client.
std::vector<Client> clients_of(const spec::geometric::Parameters& parameters);
// Tag bits towards the port: client index and the client's own number.
inline std::uint32_t request_tag_bits(const spec::geometric::Parameters& parameters) {
  return kPlaceBits + static_cast<std::uint32_t>(std::bit_width(clients_of(parameters).size() - 1));
}

// Request and response ports of a client.
struct MemoryClient {
  Out<MemoryRequest> requests_out{"requests_out"};
  In<MemoryResponse> responses_in{"responses_in"};

  void read(Cycle cycle, std::uint32_t address, std::uint32_t place) {
    MemoryRequest& request = requests_out.emplace(cycle);
    request.address = address;
    request.tag = place;
    request.lines = 1;
    request.write = false;
    request.byte_mask = 0;
  }
  // Returns the data, which the caller fills in.
  Line& write(Cycle cycle, std::uint32_t address, std::uint32_t place, std::uint64_t mask) {
    MemoryRequest& request = requests_out.emplace(cycle);
    request.address = address;
    request.tag = place;
    request.lines = 1;
    request.write = true;
    request.byte_mask = mask;
    return request.data;
  }
};

class MemoryArbiter final : public Unit {
 public:
  Out<MemoryRequest> requests_out{"requests_out"};
  In<MemoryResponse> responses_in{"responses_in"};
  // Raised when a response has an error.
  PulseOut memory_error_out{"memory_error_out"};

  MemoryArbiter(const sc_core::sc_module_name& name, ClockDomain& clock,
                const MemoryPortParameters& port, const spec::geometric::Parameters& parameters);
  // Binds a unit to its client index.
  void connect(Client which, MemoryClient& client);
  Activity tick(Cycle cycle) override;
  void reset() override { round_robin_.reset(); }
  const Histogram& read_latency(Client which) const { return side_of(which).read_latency; }

  Counter memory_errors{"memory_errors", "responses", "memory responses with an error"};

  static Datasheet datasheet(const spec::geometric::Parameters& parameters = {});

 private:
  struct Side {
    Side(Client which, const MemoryPortParameters& port);
    Link<MemoryRequest> requests;
    Link<MemoryResponse> responses;
    In<MemoryRequest> requests_in;
    Out<MemoryResponse> responses_out;
    Histogram read_latency;      // of the client's reads
    std::vector<Cycle> granted;  // by the client's own number, used by one read at a time
  };
  Side& side_of(Client which) const;

  std::vector<Client> clients_;  // clients of this build
  std::vector<std::unique_ptr<Side>> sides_;
  RoundRobin round_robin_;
};

}  // namespace deburr::rtl::geometric
