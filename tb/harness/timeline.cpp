// SPDX-License-Identifier: MIT
#include "tb/harness/timeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "rtl_model/fabric/ownership.h"
#include "tb/base/json_text.h"

namespace deburr::tb {
namespace {

constexpr int kProcess = 1;
// Depth of a link that sustains one beat per cycle without further buffering.
constexpr std::uint32_t kSkidDepth = 2;

std::string quoted(const std::string& text) { return json_text(nlohmann::ordered_json(text)); }

}  // namespace

Timeline::Timeline(rtl::ClockDomain& clock, const TimelineOptions& options)
    : clock_(clock), options_(options) {
  clock.add_after(*this);
}

void Timeline::see(const std::string& name, const rtl::Unit& unit,
                   const std::vector<std::string>& activities) {
  rtl::check_owned(clock_, unit);
  tracks_.push_back({name, &unit, activities, {}, {}, 0});
}

void Timeline::see(const std::string& name, const rtl::LinkBase& link) {
  rtl::check_owned(clock_, link);
  if (link.depth() <= kSkidDepth) return;
  levels_.push_back({fmt::format("{}, of {}", name, link.depth()), "fifo", "beats",
                     [&link] { return static_cast<std::uint32_t>(link.occupancy()); }});
}

void Timeline::see(const std::string& name, const rtl::MemoryPort& port) {
  rtl::check_owned(clock_, port);
  ports_.push_back({name, &port, {}, 0});
  levels_.push_back({fmt::format("{}, in flight", name), "port", "transactions",
                     [&port] { return static_cast<std::uint32_t>(port.in_flight()); }});
}

// ---- running ------------------------------------------------------------------------------------

// Transactions are tracked from the first cycle, so that those in flight when recording begins are
// shown.
rtl::Activity Timeline::tick(rtl::Cycle cycle) {
  if (cycle >= options_.to) return rtl::kIdle;
  end_ = cycle + 1;
  for (std::size_t i = 0; i < ports_.size(); ++i) look_at(ports_[i], i, cycle);
  if (cycle + 1 >= options_.from)
    for (std::size_t i = 0; i < tracks_.size(); ++i) look_at(tracks_[i], i, cycle);
  if (cycle >= options_.from)
    for (std::size_t i = 0; i < levels_.size(); ++i) look_at(levels_[i], i, cycle);
  return rtl::kIdle;
}

void Timeline::look_at(Level& level, std::size_t number, rtl::Cycle cycle) {
  const std::uint32_t now = level.now();
  if (level.last == now) return;
  level.last = now;
  samples_.push_back({number, cycle, now});
}

// The activity of the unit is the one whose count rose in the last cycle.
void Timeline::look_at(Track& track, std::size_t number, rtl::Cycle cycle) {
  const std::array<std::uint64_t, rtl::kActivities> now = track.unit->counts();
  if (cycle >= options_.from) {
    std::string activity;
    for (std::size_t code = 0; code < track.activities.size(); ++code)
      if (now[code] > track.before[code] && track.activities[code] != "idle")
        activity = track.activities[code];
    if (activity != track.open) {
      end_slice(track, number, cycle);
      track.open = activity;
      track.since = cycle;
    }
  }
  track.before = now;
}

void Timeline::end_slice(Track& track, std::size_t number, rtl::Cycle cycle) {
  if (track.open.empty()) return;
  const bool stalled = track.open != "busy";
  slices_.push_back({number, track.open.substr(stalled ? track.open.find('.') + 1 : 0),
                     stalled ? "stall" : "busy", track.since, cycle});
  track.open.clear();
}

void Timeline::look_at(Port& port, std::size_t number, rtl::Cycle cycle) {
  const rtl::Link<rtl::MemoryRequest>& requests = port.port->requests_in.link();
  if (requests.last_pop() == cycle) {
    const auto& request =
        *reinterpret_cast<const rtl::MemoryRequest*>(requests.beat(requests.pops() - 1));
    if (port.beats_left > 0) {
      --port.beats_left;
    } else {
      if (request.write) port.beats_left = request.lines - 1U;
      port.in_flight.push_back({number, ++transactions_, request, cycle, 0, false});
    }
  }
  const rtl::Link<rtl::MemoryResponse>& responses = port.port->responses_out.link();
  if (responses.last_push() != cycle) return;
  const auto& response =
      *reinterpret_cast<const rtl::MemoryResponse*>(responses.beat(responses.pushes() - 1));
  if (!response.last) return;
  // Tags are local to a unit and need not be unique. If a tag is ambiguous, the address decides.
  const auto answers = [&](const Transaction& t, bool by_address) {
    return t.request.tag == response.tag && t.request.write == response.write &&
           (!by_address || t.request.address == response.address);
  };
  auto& list = port.in_flight;
  for (const bool by_address : {true, false}) {
    const auto found = std::find_if(list.begin(), list.end(),
                                    [&](const Transaction& t) { return answers(t, by_address); });
    if (found == list.end()) continue;
    found->to = cycle;
    found->answered = true;
    keep(*found);
    list.erase(found);
    return;
  }
}

void Timeline::keep(Transaction transaction) {
  if (transaction.to <= options_.from || transaction.from >= options_.to) return;
  kept_.push_back(transaction);
}

void Timeline::finish() {
  for (std::size_t i = 0; i < tracks_.size(); ++i) end_slice(tracks_[i], i, end_);
  for (Port& port : ports_) {
    for (Transaction& transaction : port.in_flight) {
      transaction.to = end_;
      keep(transaction);
    }
    port.in_flight.clear();
  }
}

void Timeline::reset() {
  for (Track& track : tracks_) {
    track.before = {};
    track.open.clear();
  }
  for (Port& port : ports_) {
    port.in_flight.clear();
    port.beats_left = 0;
  }
  for (Level& level : levels_) level.last.reset();
  slices_.clear();
  kept_.clear();
  samples_.clear();
  transactions_ = 0;
  end_ = 0;
}

// ---- output file --------------------------------------------------------------------------------

std::string Timeline::json() const {
  // Sorted by time; at the same time ends come before begins.
  std::multimap<std::pair<rtl::Cycle, int>, std::string> events;
  for (const Slice& s : slices_)
    events.emplace(std::pair(s.from, 1),
                   fmt::format(R"({{"ph":"X","name":{},"cat":{},"pid":{},"tid":{},"ts":{},)"
                               R"("dur":{}}})",
                               quoted(s.name), quoted(s.category), kProcess, s.track + 1, s.from,
                               s.to - s.from));
  for (const Transaction& t : kept_) {
    const std::string port = quoted(ports_[t.port].name);
    const std::string name = quoted(t.request.write ? "write" : "read");
    const rtl::Cycle from = std::max(t.from, options_.from), to = std::min(t.to, options_.to);
    const auto event = [&](char phase, rtl::Cycle at, const std::string& arguments) {
      return fmt::format(R"({{"ph":"{}","name":{},"cat":{},"id":{},"pid":{},"tid":0,"ts":{},)"
                         R"("args":{{{}}}}})",
                         phase, name, port, t.id, kProcess, at, arguments);
    };
    events.emplace(std::pair(from, 2),
                   event('b', from,
                         fmt::format(R"("address":"{:#x}","lines":{},"tag":{},"since":{})",
                                     t.request.address, t.request.lines, t.request.tag, t.from)));
    events.emplace(
        std::pair(to, 0),
        event('e', to, fmt::format(R"("answered":{})", t.answered && t.to <= options_.to)));
  }
  for (const Sample& s : samples_) {
    const Level& level = levels_[s.level];
    events.emplace(std::pair(s.at, 3),
                   fmt::format(R"({{"ph":"C","name":{},"cat":{},"pid":{},"tid":0,"ts":{},)"
                               R"("args":{{{}:{}}}}})",
                               quoted(level.name), quoted(level.category), kProcess, s.at,
                               quoted(level.unit), s.value));
  }
  std::string text = fmt::format(
      "{{\"displayTimeUnit\":\"ns\",\n\"otherData\":{{\"time\":\"a microsecond is a cycle\","
      "\"from\":{},\"to\":{}}},\n\"traceEvents\":[\n"
      R"({{"ph":"M","name":"process_name","pid":{},"tid":0,"args":{{"name":"units"}}}})",
      options_.from, std::min(options_.to, end_), kProcess);
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    text += fmt::format(
        ",\n"
        R"({{"ph":"M","name":"thread_name","pid":{0},"tid":{1},"args":{{"name":{2}}}}},)"
        "\n"
        R"({{"ph":"M","name":"thread_sort_index","pid":{0},"tid":{1},"args":{{"sort_index":{1}}}}})",
        kProcess, i + 1, quoted(tracks_[i].name));
  }
  for (const auto& [at, event] : events) text += ",\n" + event;
  return text + "\n]}\n";
}

}  // namespace deburr::tb
