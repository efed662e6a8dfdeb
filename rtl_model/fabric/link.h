// SPDX-License-Identifier: MIT
// A registered valid/ready link between two units, and the ports that bind to it.
//
// Latency   1: a beat pushed in cycle t can be popped from t + 1 on; a slot freed in t can be
//           refilled from t + 1 on.
// Interval  1 with depth 2 or more, 2 with depth 1. At most one push and one pop per cycle.
// Stalls    `can_push` is "ready" as seen by the producer, `can_pop` is "valid" as seen by the
//           consumer.
// Cost      depth x payload bits of registers, two pointers, one counter.
//
// The link needs no clocked "next state". Each slot of its ring stores, for each side, the first
// cycle in which that side may use it; each push and pop updates these stamps for the next cycle.
// So a handshake is one comparison, and the order in which the two sides are ticked does not
// matter.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <systemc>
#include <type_traits>
#include <vector>

#include "rtl_model/fabric/clocked.h"
#include "rtl_model/fabric/payload.h"
#include "spec/error.h"

namespace deburr::rtl {

// The part of a link that does not depend on its payload. As an sc_object, it gets its name and
// position from the module that declares it.
class LinkBase : public sc_core::sc_object {
 public:
  ~LinkBase() override;
  const char* kind() const override { return "deburr_link"; }

  bool can_push(Cycle cycle) const { return cycle >= tail_->push_from; }
  bool can_pop(Cycle cycle) const { return cycle >= head_->pop_from; }

  std::uint32_t depth() const { return depth_; }
  std::uint32_t occupancy() const { return static_cast<std::uint32_t>(pushes_ - pops_); }
  bool empty() const { return pushes_ == pops_; }
  std::uint64_t pushes() const { return pushes_; }  // since reset
  std::uint64_t pops() const { return pops_; }      // since reset
  Cycle last_push() const { return last_push_; }    // kNever if none since reset
  Cycle last_pop() const { return last_pop_; }      // kNever if none since reset
  const Payload& payload() const { return payload_; }
  std::uint32_t payload_bits() const { return payload_.bits(); }
  std::size_t payload_bytes() const { return payload_bytes_; }  // of the C++ type

  void reset();

  // --- For testbenches: stalls, faults, checkers and traces. No cost when unused. ---

  // Makes the link not ready (not valid) in this cycle. Call before the units are ticked.
  void hold_push(Cycle cycle) { tail_->push_from = std::max(tail_->push_from, cycle + 1); }
  void hold_pop(Cycle cycle) { head_->pop_from = std::max(head_->pop_from, cycle + 1); }
  // The bytes of beat number `beat` (counted from reset). They are valid from its push until its
  // slot is refilled, which is at least one cycle after its pop.
  std::byte* beat(std::uint64_t beat) { return payloads_ + beat % depth_ * slot_bytes_; }
  const std::byte* beat(std::uint64_t beat) const {
    return payloads_ + beat % depth_ * slot_bytes_;
  }
  // The oldest beat in the link; requires !empty().
  const std::byte* head() const { return beat(pops_); }
  // Removes the newest beat, or pushes it a second time, unnoticed by both sides. Returns false if
  // the link is empty, or full.
  bool drop_newest();
  bool duplicate_newest(Cycle cycle);

  // The units bound to the two sides, for diagrams and error messages; empty if used without ports.
  const std::string& producer() const { return producer_; }
  const std::string& consumer() const { return consumer_; }

  // The memory that contains the link (a FIFO): both belong to one clock domain.
  void set_memory(const sc_core::sc_object& memory) { memory_ = &memory; }
  const sc_core::sc_object* memory() const { return memory_; }

 protected:
  // Header of a slot, followed by the payload. Beat n is in slot n modulo depth.
  struct Stamps {
    Cycle push_from = 0;      // kNever while the slot holds a beat
    Cycle pop_from = kNever;  // kNever while the slot is empty
    Stamps* next = nullptr;
  };

  LinkBase(const char* name, std::uint32_t depth, std::size_t payload_bytes, Payload payload);
  // Sets the ring after construction: first slot, its payload, and the slot pitch.
  void adopt(Stamps* first, std::byte* payload, std::size_t slot_bytes);

  // Updates the stamps for a push (pop) in `cycle` and returns the slot. The stamp of the next slot
  // limits pushes (pops) to one per cycle.
  Stamps* advance_push(Cycle cycle) {
    Stamps* const slot = tail_;
    if (cycle < slot->push_from) [[unlikely]]
      fail("push without can_push()", cycle);
    slot->push_from = kNever;
    slot->pop_from = cycle + 1;
    Stamps* const next = slot->next;
    next->push_from = std::max(next->push_from, cycle + 1);
    tail_ = next;
    ++pushes_;
    last_push_ = cycle;
    return slot;
  }
  Stamps* advance_pop(Cycle cycle) {
    Stamps* const slot = head_;
    if (cycle < slot->pop_from) [[unlikely]]
      fail("pop without can_pop()", cycle);
    slot->pop_from = kNever;
    slot->push_from = cycle + 1;
    Stamps* const next = slot->next;
    next->pop_from = std::max(next->pop_from, cycle + 1);
    head_ = next;
    ++pops_;
    last_pop_ = cycle;
    return slot;
  }
  // Throws CheckFailed. Out of line and without formatting at the caller, so that a check costs one
  // comparison and no stack frame.
  [[noreturn, gnu::cold, gnu::noinline]] void fail(const char* what, Cycle cycle) const;

  // All data that a handshake uses besides the slot, in one cache line.
  alignas(64) Stamps* tail_ = nullptr;  // slot of the next beat to push
  Stamps* head_ = nullptr;              // slot of the oldest beat, or of the next one
  std::uint64_t pushes_ = 0, pops_ = 0;
  Cycle last_push_ = kNever, last_pop_ = kNever;

 private:
  friend class PortBase;
  friend class ClockDomain;
  Stamps* slot_of(std::uint64_t beat);
  std::uint32_t depth_;
  std::size_t payload_bytes_, slot_bytes_ = 0;
  Payload payload_;
  Stamps* first_ = nullptr;
  std::byte* payloads_ = nullptr;
  const void* clock_ = nullptr;  // the domain that both ends belong to
  const sc_core::sc_object* memory_ = nullptr;
  std::string producer_, consumer_;
};

// A payload is a bundle of wires: trivially copyable, without pointers to mutable data. The shape
// given with the link says which parts are built (lanes, narrower fields).
template <class T>
class Link final : public LinkBase {
  static_assert(std::is_trivially_copyable_v<T>, "a payload is a bundle of wires");

 public:
  explicit Link(const char* name, std::uint32_t depth = 2, const PayloadShape& shape = {})
      : LinkBase(name, depth, sizeof(T), Payload::of<T>(shape)),
        slots_(std::make_unique<Slot[]>(depth)) {
    adopt(slots_.get(), reinterpret_cast<std::byte*>(&slots_[0].payload), sizeof(Slot));
  }

  // The oldest beat. Requires can_pop(cycle).
  const T& front(Cycle cycle) const {
    if (!can_pop(cycle)) [[unlikely]]
      fail("front without can_pop()", cycle);
    return payload(head_);
  }
  void pop(Cycle cycle) { advance_pop(cycle); }
  // front and pop in one call. The reference is valid until the next cycle.
  const T& take(Cycle cycle) { return payload(advance_pop(cycle)); }

  // Requires can_push(cycle).
  void push(Cycle cycle, const T& value) { payload(advance_push(cycle)) = value; }
  // Pushes a beat that the caller fills in place within the same tick(). It initially holds old
  // data.
  T& emplace(Cycle cycle) { return payload(advance_push(cycle)); }

 private:
  struct Slot : Stamps {
    T payload{};
  };
  static T& payload(Stamps* slot) { return static_cast<Slot*>(slot)->payload; }
  std::unique_ptr<Slot[]> slots_;
};

// A SystemVerilog package with a packed struct for the payload of every link below `root`.
std::string link_package(const std::string& name, sc_core::sc_object& root);

// A named port at a unit's boundary. Bind it to a link, or to the same kind of port of the
// enclosing unit (in any order).
class PortBase : public sc_core::sc_object {
 public:
  ~PortBase() override;
  enum class Side { kConsumer, kProducer };
  Side side() const { return side_; }
  bool bound() const { return base_ != nullptr; }
  // The bound link, also through outer ports; nullptr if unbound.
  LinkBase* link_base() const { return base_; }

 protected:
  PortBase(const char* name, Side side) : sc_object(name), side_(side) {}
  void bind_link(LinkBase& link);
  void bind_port(PortBase& outer);

 private:
  virtual void resolved(LinkBase& link) = 0;
  void resolve(LinkBase& link);
  Side side_;
  LinkBase* base_ = nullptr;
  PortBase* outer_ = nullptr;
  std::vector<PortBase*> inner_;
};

template <class T>
class In final : public PortBase {
 public:
  explicit In(const char* name) : PortBase(name, Side::kConsumer) {}
  const char* kind() const override { return "deburr_in"; }
  void bind(Link<T>& link) { bind_link(link); }
  void bind(In<T>& outer) { bind_port(outer); }
  void operator()(Link<T>& link) { bind(link); }
  void operator()(In<T>& outer) { bind(outer); }

  bool can_pop(Cycle cycle) const { return link_->can_pop(cycle); }
  const T& front(Cycle cycle) const { return link_->front(cycle); }
  void pop(Cycle cycle) { link_->pop(cycle); }
  const T& take(Cycle cycle) { return link_->take(cycle); }
  Link<T>& link() const { return *link_; }

 private:
  void resolved(LinkBase& link) override { link_ = static_cast<Link<T>*>(&link); }
  Link<T>* link_ = nullptr;
};

template <class T>
class Out final : public PortBase {
 public:
  explicit Out(const char* name) : PortBase(name, Side::kProducer) {}
  const char* kind() const override { return "deburr_out"; }
  void bind(Link<T>& link) { bind_link(link); }
  void bind(Out<T>& outer) { bind_port(outer); }
  void operator()(Link<T>& link) { bind(link); }
  void operator()(Out<T>& outer) { bind(outer); }

  bool can_push(Cycle cycle) const { return link_->can_push(cycle); }
  void push(Cycle cycle, const T& value) { link_->push(cycle, value); }
  T& emplace(Cycle cycle) { return link_->emplace(cycle); }
  Link<T>& link() const { return *link_; }

 private:
  void resolved(LinkBase& link) override { link_ = static_cast<Link<T>*>(&link); }
  Link<T>* link_ = nullptr;
};

}  // namespace deburr::rtl
