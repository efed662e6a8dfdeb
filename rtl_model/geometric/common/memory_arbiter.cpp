// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/common/memory_arbiter.h"

#include <algorithm>
#include <string>

#include "rtl_model/geometric/common/hardware_lists.h"

namespace deburr::rtl::geometric {
namespace {

std::string named(Client which, const char* what) {
  return std::string(kClientNames[static_cast<std::size_t>(which)]) + "_" + what;
}

// The port parameters as seen by this client's links.
MemoryPortParameters of(Client which, MemoryPortParameters port) {
  port.read_only = which != Client::kWeights && which != Client::kResolve && which != Client::kCopy;
  return port;
}

}  // namespace

std::vector<Client> clients_of(const spec::geometric::Parameters& p) {
  std::vector<Client> clients;
  for (std::size_t i = 0; i < kClients; ++i) {
    const auto client = static_cast<Client>(i);
    if (client == Client::kPairs && p.records != spec::geometric::RecordsLayout::kSplit) continue;
    if (client == Client::kCoarse && p.coarse_lines == spec::geometric::CoarseLines::kNone)
      continue;
    clients.push_back(client);
  }
  return clients;
}

MemoryArbiter::Side::Side(Client which, const MemoryPortParameters& port)
    : requests(named(which, "requests").c_str(), 2, request_shape(of(which, port), 32, kPlaceBits)),
      responses(named(which, "responses").c_str(), 2,
                response_shape(of(which, port), 32, kPlaceBits)),
      requests_in(named(which, "requests_in").c_str()),
      responses_out(named(which, "responses_out").c_str()),
      read_latency(named(which, "read_latency").c_str(), "clk",
                   "from accepting a read request to returning its response"),
      granted(std::size_t{1} << kPlaceBits) {
  requests_in(requests);
  responses_out(responses);
}

MemoryArbiter::MemoryArbiter(const sc_core::sc_module_name& name, ClockDomain& clock,
                             const MemoryPortParameters& port,
                             const spec::geometric::Parameters& parameters)
    : Unit(name, clock),
      clients_(clients_of(parameters)),
      round_robin_(static_cast<int>(clients_.size())) {
  for (const Client client : clients_) sides_.push_back(std::make_unique<Side>(client, port));
}

MemoryArbiter::Side& MemoryArbiter::side_of(Client which) const {
  const auto place = std::find(clients_.begin(), clients_.end(), which);
  DEBURR_CHECK(place != clients_.end(),
               named(which, "requests") + " are not built with these parameters");
  return *sides_[static_cast<std::size_t>(place - clients_.begin())];
}

void MemoryArbiter::connect(Client which, MemoryClient& client) {
  Side& side = side_of(which);
  client.requests_out(side.requests);
  client.responses_in(side.responses);
}

Activity MemoryArbiter::tick(Cycle cycle) {
  bool did = false;
  if (responses_in.can_pop(cycle)) {
    const MemoryResponse& response = responses_in.front(cycle);
    Side& side = *sides_[response.tag >> kPlaceBits];
    if (side.responses_out.can_push(cycle)) {
      if (response.status != MemoryStatus::kOk) {
        ++memory_errors;
        memory_error_out.raise(cycle);
      }
      MemoryResponse& out = side.responses_out.emplace(cycle);
      out = response;
      out.tag = response.tag & ((1u << kPlaceBits) - 1);
      if (!out.write) side.read_latency.record(cycle - side.granted[out.tag]);
      responses_in.pop(cycle);
      did = true;
    }
  }
  std::uint64_t waiting = 0, client_bit = 1;
  for (const std::unique_ptr<Side>& side : sides_) {
    if (side->requests_in.can_pop(cycle)) waiting |= client_bit;
    client_bit <<= 1;
  }
  if (waiting == 0) return did ? kBusy : kIdle;
  if (!requests_out.can_push(cycle)) return did ? kBusy : kStalledDownstream;
  const int chosen = round_robin_.choose(waiting);
  round_robin_.grant(chosen);
  const auto client = static_cast<std::uint32_t>(chosen);
  Side& side = *sides_[client];
  MemoryRequest& out = requests_out.emplace(cycle);
  out = side.requests_in.take(cycle);
  if (!out.write) side.granted[out.tag] = cycle;
  out.tag |= client << kPlaceBits;
  return kBusy;
}

Datasheet MemoryArbiter::datasheet(const spec::geometric::Parameters& p) {
  const auto clients = static_cast<std::uint32_t>(clients_of(p).size());
  constexpr std::uint32_t kAddress = 26 + kPlaceBits, kWriters = 3,
                          kData = 8 * kLineBytes + kLineBytes;
  return {
      .unit = "MemoryArbiter",
      .variant = std::to_string(clients) + " clients",
      .does =
          "Forwards the memory requests of all units to the memory port and returns the responses.",
      .latency = {1, "1 each way"},
      .interval = {1, "one request and one response per cycle"},
      .stages = {{.clock = "1",
                  .work = "round-robin choice of the clients",
                  .operators = {2 * op::priority(clients), op::mux(kAddress, clients),
                                op::mux(kData, kWriters), op::add(bits_below(clients)),
                                op::logic(10 * clients)},
                  .longest = {op::priority(clients), op::logic(4), op::mux(kAddress, clients)},
                  .registers = bits_below(clients)}}};
}

}  // namespace deburr::rtl::geometric
