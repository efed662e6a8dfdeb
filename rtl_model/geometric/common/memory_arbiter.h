// SPDX-License-Identifier: MIT
// Brings the requests of all units to the one memory port, and each answer back to who asked.
//
// Where: between the units and the MemoryPort. Round robin. The tag is the client and the client's
// own number. An answer with an error is counted, raises `memory_error` and reads as zeros. Stalls:
// `downstream` (the port takes nothing). Units take answers in the clock in which they come, so
// answers never wait.
#pragma once

#include <array>
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

namespace deburr::rtl::geometric {

enum class Client : std::uint8_t {
  kFacing,
  kEdges,
  kVertices,
  kDepth,
  kWeights,
  kBlocks,
  kResolve,
  kCopy
};
inline constexpr std::size_t kClients = 8;
inline constexpr std::array<const char*, kClients> kClientNames = {
    "facing", "edges", "vertices", "depth", "weights", "blocks", "resolve", "copy"};
inline constexpr std::uint32_t kPlaceBits = 12;  // of a client's own number
inline constexpr std::uint32_t kRequestTagBits = kPlaceBits + 3;

// A client's requests and answers.
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
  // The data are the caller's to fill in.
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
  // An answer has an error.
  PulseOut memory_error_out{"memory_error_out"};

  MemoryArbiter(const sc_core::sc_module_name& name, ClockDomain& clock,
                const MemoryPortParameters& port);
  // Binds a unit to its place.
  void connect(Client which, MemoryClient& client);
  Activity tick(Cycle cycle) override;
  void reset() override { round_robin_.reset(); }
  const Histogram& read_latency(Client which) const {
    return sides_[static_cast<std::size_t>(which)]->read_latency;
  }

  Counter memory_errors{"memory_errors", "responses", "memory responses with an error"};

  static Datasheet datasheet();

 private:
  struct Side {
    Side(Client which, const MemoryPortParameters& port);
    Link<MemoryRequest> requests;
    Link<MemoryResponse> responses;
    In<MemoryRequest> requests_in;
    Out<MemoryResponse> responses_out;
    Histogram read_latency;      // of its reads
    std::vector<Cycle> granted;  // by its own number, which one read has at a time
  };
  std::array<std::unique_ptr<Side>, kClients> sides_;
  RoundRobin round_robin_{static_cast<int>(kClients)};
};

}  // namespace deburr::rtl::geometric
