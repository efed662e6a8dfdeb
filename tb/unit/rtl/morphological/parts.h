// SPDX-License-Identifier: MIT
// For tests of single blocks of the morphological engine: the registers that they read, ends that
// send and take at given clocks, and what a block says of its clocks.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tb/unit/rtl/morphological/support.h"

namespace deburr::tb::morphological_rtl {

// A ParameterStore with its bus, and a frame inside.
struct Registers {
  explicit Registers(const Parameters& p) : store(control, p), bus("bus"), software(bus, p) {
    bus.bus.bind(control.registers.bus);
  }
  Registers(const Parameters& p, int width, int height) : Registers(p) { frame(width, height); }
  void frame(int width, int height) {
    software.set_size(width, height);
    EXPECT_TRUE(store.latch());
  }
  // As the reset of the engine does.
  void reset() {
    control.reset();
    store.reset();
  }
  rtl::ControlRegisters control{"registers", spec::morphological::kRegisters,
                                rtl::morphological::control_layout()};
  rtl::morphological::ParameterStore store;
  platform::RegisterHost bus;
  platform::MorphologicalDriver software;
};

// Sends each beat in its clock or, if there is no room, as soon as there is.
template <class T>
class TimedDriver final : public rtl::Unit {
 public:
  rtl::Out<T> beats_out{"beats_out"};
  TimedDriver(const sc_core::sc_module_name& name, ClockDomain& clock) : Unit(name, clock) {}
  void send(Cycle from, const T& beat) { list_.push_back({from, beat}); }
  // Number `index` and those after it, not before clock `from`.
  void delay(std::size_t index, Cycle from) {
    for (; index < list_.size(); ++index) list_[index].first = from;
  }
  rtl::Activity tick(Cycle cycle) override {
    if (sent_ == list_.size() || list_[sent_].first > cycle) return rtl::kIdle;
    if (!beats_out.can_push(cycle)) return rtl::kStalledDownstream;
    beats_out.push(cycle, list_[sent_++].second);
    return rtl::kBusy;
  }
  void reset() override {
    sent_ = 0;
    list_.clear();
  }
  std::size_t sent() const { return sent_; }

 private:
  std::vector<std::pair<Cycle, T>> list_;
  std::size_t sent_ = 0;
};

// Takes nothing before clock `opens`, and from then on a beat a clock.
template <class T>
class Gate final : public rtl::Unit {
 public:
  rtl::In<T> beats_in{"beats_in"};
  Gate(const sc_core::sc_module_name& name, ClockDomain& clock, Cycle opens = 0)
      : Unit(name, clock), opens_(opens) {}
  rtl::Activity tick(Cycle cycle) override {
    if (cycle < opens_ || !beats_in.can_pop(cycle)) return rtl::kIdle;
    cycles.push_back(cycle);
    beats.push_back(beats_in.take(cycle));
    return rtl::kBusy;
  }
  void reset() override {
    beats.clear();
    cycles.clear();
  }
  std::vector<T> beats;
  std::vector<Cycle> cycles;

 private:
  Cycle opens_;
};

// source -> block -> sink, with the clock of each beat.
template <class From, class To>
struct Ends {
  explicit Ends(ClockDomain& clock, const std::string& name = "")
      : in((name + "in").c_str()),
        out((name + "out").c_str()),
        source((name + "source").c_str(), clock),
        sink((name + "sink").c_str(), clock) {
    source.beats_out(in);
    sink.beats_in(out);
  }
  Link<From> in;
  Link<To> out;
  Driver<From> source;
  Sink<To> sink;
};

using unit_bench::of_a_stage_less;

// An engine small enough for single blocks: four rows of reach, no predictor.
inline constexpr int kReach = 4, kLag = kReach + spec::morphological::kRowLag;

inline Parameters small(int lanes_code = 0) {
  Parameters p = preset(spec::morphological::Preset::kMlaa, kReach, 8);
  p.lanes = static_cast<spec::morphological::Lanes>(lanes_code);
  p.line_pixels = 64;
  return p;
}

inline Parameters deburr_without_trim() {
  Parameters p = preset(spec::morphological::Preset::kDeburrLine);
  p.trim = false;
  return p;
}
inline constexpr std::uint32_t kTrimBit = 1u << 17;  // of RULES

inline rtl::morphological::RunToken run_of(int length, int start, std::uint32_t slot = 0) {
  rtl::morphological::RunToken token{};
  token.run = {
      spec::morphological::Axis::kHorizontal, spec::morphological::RunPart::kWhole, 12,
      static_cast<std::uint16_t>(start),      static_cast<std::uint16_t>(length),   1 + 4 * 2};
  token.slot = slot;
  return token;
}

}  // namespace deburr::tb::morphological_rtl
