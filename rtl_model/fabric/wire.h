// SPDX-License-Identifier: MIT
// A level signal between units: one driver, any number of readers, no handshake.
//
// A wire is registered or combinational, by its declaration:
//
//   Wire<Phase> phase_{"phase", Phase::kIdle, {.widths = {{"value", 2}}}};
//   CombinationalWire<bool> moves_{"moves"};
//
//   * Registered: a value driven in cycle t is read from t + 1 on, whichever unit is ticked first,
//     and stays until the wire is driven again. Latency 1. A reset loads the declared value;
//     without one (`kNoReset`) the wire is undriven until its first value.
//   * Combinational: a value driven in cycle t is read in t only. Latency 0. The domain ticks the
//     driver before its readers, also when it shuffles.
//
// A Pulse is a combinational wire of one bit that is low in every cycle in which it is not raised:
// an event that sets a status bit or loads a register. A register that is not written by a unit's
// tick receives it through OnPulse.
//
// Stalls    None. Reading an undriven wire, driving it twice in a cycle, a second driver and an
//           unbound port are errors that name the wire, its driver and its readers.
// Cost      The bits of T, as registers or as gates of the driver.
//
// The clock domain of the connected units resets the wire.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <systemc>
#include <type_traits>
#include <utility>
#include <vector>

#include "rtl_model/fabric/clocked.h"
#include "rtl_model/fabric/payload.h"
#include "spec/error.h"

namespace deburr::rtl {

enum class WireKind : std::uint8_t { kRegistered, kCombinational };
struct NoResetTag {};
inline constexpr NoResetTag kNoReset{};

// The part of a wire that does not depend on its type.
class WireBase : public sc_core::sc_object {
 public:
  ~WireBase() override;
  const char* kind() const override { return "deburr_wire"; }
  bool combinational() const { return kind_ == WireKind::kCombinational; }
  const Payload& payload() const { return payload_; }
  std::uint32_t bits() const { return payload_.bits(); }
  // The value that readers see in this cycle; nullptr if none was driven.
  virtual const std::byte* seen(Cycle cycle) const = 0;
  virtual void reset() = 0;
  // Resets at this edge; counting restarts in the next cycle.
  void reset_at(Cycle edge) {
    reset();
    since_ = edge + 1;
  }

  // Since reset: the number of changes of the driven value, and of cycles before `now` in which
  // readers saw a value other than zero.
  std::uint64_t changes() const { return changes_; }
  std::uint64_t high_cycles(Cycle now) const {
    return high_ + (level_ && now > since_ ? now - since_ : 0);
  }

  // The ports bound to it, for diagrams and error messages; empty if used without ports.
  const std::string& driver() const { return driver_; }
  const std::vector<std::string>& readers() const { return readers_; }

 protected:
  WireBase(const char* name, Payload payload, WireKind kind)
      : sc_object(name), payload_(std::move(payload)), kind_(kind) {}
  // Counts a value that readers see from cycle `from` on.
  void count(Cycle from, std::uint32_t changes, bool level) {
    changes_ += changes;
    if (combinational()) {
      high_ += level;
      return;
    }
    if (level == level_) return;
    if (level_) high_ += from - since_;
    level_ = level;
    since_ = from;
  }
  void forget(bool level) {
    changes_ = high_ = 0;
    level_ = level;
  }
  // Throws CheckFailed.
  [[noreturn, gnu::cold, gnu::noinline]] void fail(const char* what, Cycle cycle) const;

 private:
  friend class WirePortBase;
  friend class ClockDomain;
  Payload payload_;
  WireKind kind_;
  std::uint64_t changes_ = 0, high_ = 0;
  Cycle since_ = 0;              // first cycle in which readers saw a nonzero level
  bool level_ = false;           // of the driven value
  const void* clock_ = nullptr;  // the domain of all connected units
  std::string driver_;
  std::vector<std::string> readers_;
};

template <std::equality_comparable T, WireKind kKind = WireKind::kRegistered>
class Wire final : public WireBase {
  static_assert(std::is_trivially_copyable_v<T>, "a wire is a bundle of bits");
  static constexpr bool kRegister = kKind == WireKind::kRegistered;

 public:
  Wire(const char* name, const T& reset_value, const PayloadShape& shape = {}) requires kRegister
      : WireBase(name, Payload::of<T>(shape), kKind),
        reset_value_(reset_value),
        has_reset_(true) {
    reset();
  }
  Wire(const char* name, NoResetTag /*tag*/, const PayloadShape& shape = {}) requires kRegister
      : WireBase(name, Payload::of<T>(shape), kKind) {}
  explicit Wire(const char* name, const PayloadShape& shape = {}) requires(!kRegister)
      : WireBase(name, Payload::of<T>(shape), kKind) {}

  const T& read(Cycle cycle) const {
    if constexpr (kRegister) {
      if (cycle >= from_) [[likely]]
        return value_;
      if (!had_value_) [[unlikely]]
        fail("read before it was driven", cycle);
      return before_;
    } else {
      if (cycle != from_) [[unlikely]]
        fail("read before it was driven in this cycle", cycle);
      return value_;
    }
  }
  const T& driven() const { return value_; }
  void drive(Cycle cycle, const T& value) {
    const Cycle from = cycle + kRegister;
    if (from_ == from) [[unlikely]]
      fail("driven twice in a cycle", cycle);
    count(from, was_driven_ && !(value == value_), !(value == T{}));
    before_ = value_;
    had_value_ = was_driven_;
    value_ = value;
    was_driven_ = true;
    from_ = from;
  }
  const std::byte* seen(Cycle cycle) const override {
    const bool there = kRegister ? cycle >= from_ || had_value_ : cycle == from_;
    return there ? reinterpret_cast<const std::byte*>(&read(cycle)) : nullptr;
  }
  void reset() override {
    before_ = value_ = reset_value_;
    was_driven_ = had_value_ = has_reset_;
    from_ = has_reset_ ? 0 : kNever;
    forget(!(value_ == T{}));
  }

 private:
  const T reset_value_{};
  const bool has_reset_ = false;
  // Readers see value_ from this cycle on (combinational: only in it), before_ until then.
  Cycle from_ = kNever;
  T value_{}, before_{};
  bool was_driven_ = false, had_value_ = false;  // value_, before_ are valid
};
template <class T>
using CombinationalWire = Wire<T, WireKind::kCombinational>;

class Pulse final : public WireBase {
 public:
  explicit Pulse(const char* name)
      : WireBase(name, Payload::of<bool>({}), WireKind::kCombinational) {}
  bool read(Cycle cycle) const { return cycle == raised_; }
  // At most once per cycle.
  void raise(Cycle cycle);
  const std::byte* seen(Cycle cycle) const override;
  void reset() override {
    raised_ = kNever;
    forget(false);
  }

 private:
  friend class OnPulse;
  Cycle raised_ = kNever;
  std::vector<const std::function<void(Cycle)>*> takers_;
};

// A named port at a unit's boundary. Bind it to a wire, or to the same kind of port of the
// enclosing unit (in any order).
class WirePortBase : public sc_core::sc_object {
 public:
  ~WirePortBase() override;
  enum class Side { kReader, kDriver };
  Side side() const { return side_; }
  bool bound() const { return base_ != nullptr; }
  // The bound wire, also through outer ports; nullptr if unbound.
  WireBase* wire_base() const { return base_; }

 protected:
  WirePortBase(const char* name, Side side) : sc_object(name), side_(side) {}
  void bind_wire(WireBase& wire);
  void bind_port(WirePortBase& outer);

 private:
  virtual void resolved(WireBase& wire) = 0;
  void resolve(WireBase& wire);
  Side side_;
  WireBase* base_ = nullptr;
  WirePortBase* outer_ = nullptr;
  std::vector<WirePortBase*> inner_;
};

template <class T, WireKind kKind = WireKind::kRegistered>
class WireIn final : public WirePortBase {
 public:
  explicit WireIn(const char* name) : WirePortBase(name, Side::kReader) {}
  const char* kind() const override { return "deburr_wire_in"; }
  void operator()(Wire<T, kKind>& wire) { bind_wire(wire); }
  void operator()(WireIn<T, kKind>& outer) { bind_port(outer); }

  const T& read(Cycle cycle) const { return wire_->read(cycle); }

 private:
  void resolved(WireBase& wire) override { wire_ = static_cast<Wire<T, kKind>*>(&wire); }
  Wire<T, kKind>* wire_ = nullptr;
};

template <class T, WireKind kKind = WireKind::kRegistered>
class WireOut final : public WirePortBase {
 public:
  explicit WireOut(const char* name) : WirePortBase(name, Side::kDriver) {}
  const char* kind() const override { return "deburr_wire_out"; }
  void operator()(Wire<T, kKind>& wire) { bind_wire(wire); }
  void operator()(WireOut<T, kKind>& outer) { bind_port(outer); }

  void drive(Cycle cycle, const T& value) { wire_->drive(cycle, value); }
  // The value driven last, or the reset value: readers may see it one cycle later.
  const T& driven() const { return wire_->driven(); }

 private:
  void resolved(WireBase& wire) override { wire_ = static_cast<Wire<T, kKind>*>(&wire); }
  Wire<T, kKind>* wire_ = nullptr;
};

class PulseIn final : public WirePortBase {
 public:
  explicit PulseIn(const char* name) : WirePortBase(name, Side::kReader) {}
  const char* kind() const override { return "deburr_wire_in"; }
  void operator()(Pulse& pulse) { bind_wire(pulse); }

  bool read(Cycle cycle) const { return pulse_->read(cycle); }

 private:
  void resolved(WireBase& wire) override { pulse_ = static_cast<Pulse*>(&wire); }
  Pulse* pulse_ = nullptr;
};

class PulseOut final : public WirePortBase {
 public:
  explicit PulseOut(const char* name) : WirePortBase(name, Side::kDriver) {}
  const char* kind() const override { return "deburr_wire_out"; }
  void operator()(Pulse& pulse) { bind_wire(pulse); }

  void raise(Cycle cycle) { pulse_->raise(cycle); }

 private:
  void resolved(WireBase& wire) override { pulse_ = static_cast<Pulse*>(&wire); }
  Pulse* pulse_ = nullptr;
};

// A register that a pulse sets or loads at the end of its cycle, for objects that are not ticked
// (registers on a bus). The action only writes registers, so the order relative to the units of
// that cycle does not matter.
class OnPulse final : public WirePortBase {
 public:
  OnPulse(const char* name, std::function<void(Cycle)> action)
      : WirePortBase(name, Side::kReader), action_(std::move(action)) {}
  const char* kind() const override { return "deburr_wire_in"; }
  void operator()(Pulse& pulse) { bind_wire(pulse); }

 private:
  void resolved(WireBase& wire) override { static_cast<Pulse&>(wire).takers_.push_back(&action_); }
  const std::function<void(Cycle)> action_;
};

}  // namespace deburr::rtl
