// SPDX-License-Identifier: MIT
// Endpoints of a test: a Driver feeds a link and a Sink drains one, both with optional random
// stalls. A reset restarts both; stalls that come from the seed are then the same again.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <systemc>
#include <utility>
#include <vector>

#include "rtl_model/fabric/unit.h"
#include "tb/base/random.h"

namespace deburr::tb {

// Stalls in `stall_permille` of 1000 cycles. Each endpoint has its own random stream.
struct EndOptions {
  std::uint32_t stall_permille = 0;
  std::uint64_t seed = 1;
  // Replaces random stalls by a schedule, so that two benches can stall in the same cycles.
  std::function<bool(rtl::Cycle)> stalls_at = {};
};

// Stall generator of an endpoint.
class EndStalls {
 public:
  EndStalls(EndOptions options, const char* name)
      : options_(std::move(options)), random_(options_.seed, name) {}
  bool at(rtl::Cycle cycle) {
    if (options_.stalls_at) [[unlikely]]
      return options_.stalls_at(cycle);
    return random_.chance(options_.stall_permille);
  }
  void restart(const char* name) { random_ = Random(options_.seed, name); }

 private:
  EndOptions options_;
  Random random_;
};

template <class T>
class Driver final : public rtl::Unit {
 public:
  rtl::Out<T> beats_out{"beats_out"};
  // Fills in beat number `index`; returns false at the end.
  using Generator = std::function<bool(std::uint64_t index, T& beat)>;

  Driver(const sc_core::sc_module_name& name, rtl::ClockDomain& clock, EndOptions options = {})
      : Unit(name, clock),
        stalls_(std::move(options), this->name()),
        stalled_(declare_stall("random", "stalled on purpose")) {}

  // Send either a list of beats, which may grow during the run, or a generator.
  void send(const T& beat) { list_.push_back(beat); }
  void send(const std::vector<T>& beats) { list_.insert(list_.end(), beats.begin(), beats.end()); }
  // A new generator continues with the next index once the previous one has ended.
  void send(Generator generator) {
    generator_ = std::move(generator);
    ended_ = false;
  }

  bool done() const { return ended_ || (!generator_ && sent_ == list_.size()); }
  std::uint64_t sent() const { return sent_; }
  // Called at each push, before the link takes the beat.
  std::function<void(rtl::Cycle, const T&)> on_send;

  rtl::Activity tick(rtl::Cycle cycle) override {
    if (done()) return rtl::kIdle;
    if (stalls_.at(cycle)) return stalled_;
    if (!beats_out.can_push(cycle)) return rtl::kStalledDownstream;
    T beat{};
    if (!generator_) {
      beat = list_[sent_];
    } else if (!generator_(sent_, beat)) {
      ended_ = true;
      return rtl::kIdle;
    }
    ++sent_;
    if (on_send) on_send(cycle, beat);
    beats_out.push(cycle, beat);
    return rtl::kBusy;
  }
  void reset() override {
    sent_ = 0;
    ended_ = false;
    stalls_.restart(name());
  }

 private:
  EndStalls stalls_;
  rtl::Activity stalled_;
  std::vector<T> list_;
  Generator generator_;
  std::uint64_t sent_ = 0;
  bool ended_ = false;
};

template <class T>
class Sink final : public rtl::Unit {
 public:
  rtl::In<T> beats_in{"beats_in"};

  Sink(const sc_core::sc_module_name& name, rtl::ClockDomain& clock, EndOptions options = {})
      : Unit(name, clock),
        stalls_(std::move(options), this->name()),
        stalled_(declare_stall("random", "stalled on purpose")) {}

  std::function<void(rtl::Cycle, const T&)> on_beat;
  // Whether to keep all beats and their cycles. Default: on; turn it off for long runs.
  void keep(bool on) { keep_ = on; }

  std::uint64_t received() const { return received_; }
  const std::vector<T>& beats() const { return beats_; }
  const std::vector<rtl::Cycle>& cycles() const { return cycles_; }

  rtl::Activity tick(rtl::Cycle cycle) override {
    if (stalls_.at(cycle)) return stalled_;
    if (!beats_in.can_pop(cycle)) return rtl::kIdle;
    const T& beat = beats_in.take(cycle);
    ++received_;
    if (keep_) {
      beats_.push_back(beat);
      cycles_.push_back(cycle);
    }
    if (on_beat) on_beat(cycle, beat);
    return rtl::kBusy;
  }
  void reset() override {
    received_ = 0;
    beats_.clear();
    cycles_.clear();
    stalls_.restart(name());
  }

 private:
  EndStalls stalls_;
  rtl::Activity stalled_;
  bool keep_ = true;
  std::uint64_t received_ = 0;
  std::vector<T> beats_;
  std::vector<rtl::Cycle> cycles_;
};

}  // namespace deburr::tb
