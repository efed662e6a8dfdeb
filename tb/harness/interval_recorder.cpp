// SPDX-License-Identifier: MIT
#include "tb/harness/interval_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "rtl_model/fabric/ownership.h"
#include "spec/error.h"

namespace deburr::tb {

using Json = nlohmann::ordered_json;

namespace {

// Stores a value under a dotted key such as "units.filter_pipeline.busy".
void put(Json& root, const std::string& key, Json value) {
  Json* node = &root;
  std::size_t from = 0;
  for (std::size_t dot; (dot = key.find('.', from)) != std::string::npos; from = dot + 1)
    node = &(*node)[key.substr(from, dot - from)];
  const std::string last = key.substr(from);
  DEBURR_CHECK(!node->contains(last), "two parts of the design have the same name: " + key);
  (*node)[last] = std::move(value);
}

}  // namespace

IntervalRecorder::IntervalRecorder(rtl::ClockDomain& clock, const IntervalOptions& options)
    : clock_(clock), options_(options), interval_(options.cycles) {
  DEBURR_CHECK(options.cycles > 0 && options.most >= 2 && options.most % 2 == 0,
               "intervals need a length above 0, and an even maximum of at least 2");
  clock.add_after(*this);
}

// ---- setup --------------------------------------------------------------------------------------

void IntervalRecorder::add(std::string key, std::string unit,
                           std::function<std::uint64_t()> total) {
  counted_.push_back({{std::move(key), std::move(unit), false, {}}, std::move(total)});
}

void IntervalRecorder::add_largest(std::string key, std::string unit, std::uint64_t& most) {
  largest_.push_back({{std::move(key), std::move(unit), true, {}}, &most});
}

void IntervalRecorder::see(const std::string& name, const rtl::Unit& unit,
                           const std::vector<std::string>& activities) {
  rtl::check_owned(clock_, unit);
  // Key by activity code; several codes may share a key.
  std::vector<std::string> keys;
  for (const std::string& key : activities)
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  for (const std::string& key : keys) {
    std::vector<rtl::Activity> codes;
    for (std::size_t code = 0; code < activities.size(); ++code)
      if (activities[code] == key) codes.push_back({static_cast<std::uint8_t>(code)});
    add(fmt::format("units.{}.{}", name, key), "clk", [&unit, codes] {
      std::uint64_t cycles = 0;
      for (const rtl::Activity code : codes) cycles += unit.cycles_of(code);
      return cycles;
    });
  }
}

void IntervalRecorder::see(const std::string& name, const rtl::Counter& counter) {
  rtl::check_owned(clock_, counter);
  add(fmt::format("work.{}", name), counter.unit(), [&counter] { return counter.value(); });
  counted_.back().counter = &counter;
}

void IntervalRecorder::see(const std::string& name, const rtl::LinkBase& link) {
  rtl::check_owned(clock_, link);
  WatchedLink& watched = *links_.emplace_back(std::make_unique<WatchedLink>());
  watched.link = &link;
  watched.name = name;
  watched.cycles.assign(link.depth() + 1, 0);
  add(fmt::format("links.{}.beats", name), "beat", [&link] { return link.pushes(); });
  add(fmt::format("links.{}.occupancy", name), "beat x clk",
      [&watched] { return watched.occupied; });
  add_largest(fmt::format("links.{}.most", name), "beat", watched.most);
}

void IntervalRecorder::see(const std::string& name, const rtl::MemoryPort& port) {
  rtl::check_owned(clock_, port);
  WatchedPort& watched = *ports_.emplace_back(std::make_unique<WatchedPort>());
  watched.port = &port;
  add(fmt::format("ports.{}.outstanding", name), "transaction x clk",
      [&watched] { return watched.outstanding; });
  add_largest(fmt::format("ports.{}.most", name), "transaction", watched.most);
}

// ---- running ------------------------------------------------------------------------------------

rtl::Activity IntervalRecorder::tick(rtl::Cycle cycle) {
  if (!begun_) {
    begun_ = true;
    begin_ = cycle;
  }
  end_ = cycle + 1;
  for (const std::unique_ptr<WatchedLink>& watched : links_) {
    const std::uint32_t inside = watched->link->occupancy();
    ++watched->cycles[std::min(inside, watched->link->depth())];
    watched->occupied += inside;
    if (inside > watched->most) watched->most = inside;
  }
  for (const std::unique_ptr<WatchedPort>& watched : ports_) {
    const std::uint32_t outstanding = watched->port->in_flight();
    watched->outstanding += outstanding;
    if (outstanding > watched->most) watched->most = outstanding;
  }
  if (end_ - begin_ == interval_) close();
  return rtl::kIdle;
}

void IntervalRecorder::close() {
  const bool lost = options_.lose == from_.size();
  for (Counted& counted : counted_) {
    const std::uint64_t now = counted.total();
    counted.restarts |= now < counted.before;
    counted.series.values.push_back(lost ? 0 : now - counted.before);
    counted.before = now;
  }
  for (Largest& largest : largest_) {
    largest.series.values.push_back(*largest.most);
    *largest.most = 0;
  }
  from_.push_back(begin_);
  cycles_.push_back(end_ - begin_);
  begin_ = end_;
  if (from_.size() == options_.most) merge();
}

void IntervalRecorder::merge() {
  const std::size_t half = from_.size() / 2;
  const auto pairwise = [half](std::vector<std::uint64_t>& values, const auto& together) {
    for (std::size_t i = 0; i < half; ++i) values[i] = together(values[2 * i], values[2 * i + 1]);
    values.resize(half);
  };
  const auto sum = [](std::uint64_t a, std::uint64_t b) { return a + b; };
  const auto first = [](std::uint64_t a, std::uint64_t) { return a; };
  const auto larger = [](std::uint64_t a, std::uint64_t b) { return std::max(a, b); };
  for (Counted& counted : counted_) pairwise(counted.series.values, sum);
  for (Largest& largest : largest_) pairwise(largest.series.values, larger);
  pairwise(from_, first);
  pairwise(cycles_, sum);
  interval_ *= 2;
}

void IntervalRecorder::finish() {
  if (end_ > begin_) close();
}

void IntervalRecorder::reset() {
  for (Counted& counted : counted_) {
    counted.series.values.clear();
    counted.before = 0;
    counted.restarts = false;
  }
  for (Largest& largest : largest_) {
    largest.series.values.clear();
    *largest.most = 0;
  }
  for (const std::unique_ptr<WatchedLink>& watched : links_) {
    watched->occupied = 0;
    std::fill(watched->cycles.begin(), watched->cycles.end(), 0);
  }
  for (const std::unique_ptr<WatchedPort>& watched : ports_) watched->outstanding = 0;
  from_.clear();
  cycles_.clear();
  interval_ = options_.cycles;
  begun_ = false;
  begin_ = end_ = 0;
}

// ---- results ------------------------------------------------------------------------------------

std::vector<IntervalRecorder::Series> IntervalRecorder::series() const {
  std::vector<Series> all;
  for (const Counted& counted : counted_)
    if (!counted.restarts && (!counted.counter || !counted.counter->is_largest()))
      all.push_back(counted.series);
  for (const Largest& largest : largest_) all.push_back(largest.series);
  return all;
}

std::vector<IntervalRecorder::Occupancy> IntervalRecorder::occupancy() const {
  std::vector<Occupancy> all;
  all.reserve(links_.size());
  for (const std::unique_ptr<WatchedLink>& watched : links_)
    all.push_back({watched->name, watched->link->name(), watched->link->pushes(), watched->cycles});
  return all;
}

Json IntervalRecorder::json() const {
  Json json{{"schema", 2},
            {"asked_cycles", options_.cycles},
            {"interval_cycles", interval_},
            {"intervals", from_.size()},
            {"from", from_},
            {"cycles", cycles_},
            {"throughput", Json::array()},
            {"series", Json::object()},
            {"units", Json::object()}};
  for (const ThroughputSeries& each : throughput_)
    json["throughput"].push_back({{"label", each.label},
                                  {"key", "work." + each.counter},
                                  {"unit", each.unit},
                                  {"bound", each.bound}});
  for (Series& each : series()) {
    put(json["series"], each.key, std::move(each.values));
    json["units"][each.key] = each.unit;
  }
  return json;
}

}  // namespace deburr::tb
