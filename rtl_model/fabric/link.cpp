// SPDX-License-Identifier: MIT
#include "rtl_model/fabric/link.h"

#include <fmt/format.h>

#include <utility>

#include "rtl_model/fabric/counters.h"

namespace deburr::rtl {

LinkBase::LinkBase(const char* name, std::uint32_t depth, std::size_t payload_bytes,
                   Payload payload)
    : sc_object(name), depth_(depth), payload_bytes_(payload_bytes), payload_(std::move(payload)) {
  DEBURR_CHECK(depth >= 1 && depth <= (1U << 24),
               fmt::format("{}: depth {} is not in 1..2^24", this->name(), depth));
}

void LinkBase::adopt(Stamps* first, std::byte* payload, std::size_t slot_bytes) {
  first_ = first;
  payloads_ = payload;
  slot_bytes_ = slot_bytes;
  for (std::uint32_t i = 0; i < depth_; ++i) slot_of(i)->next = slot_of(i + 1);
  reset();
}

LinkBase::Stamps* LinkBase::slot_of(std::uint64_t beat) {
  return reinterpret_cast<Stamps*>(reinterpret_cast<std::byte*>(first_) +
                                   beat % depth_ * slot_bytes_);
}

void LinkBase::reset() {
  pushes_ = pops_ = 0;
  last_push_ = last_pop_ = kNever;
  tail_ = head_ = first_;
  for (std::uint32_t i = 0; i < depth_; ++i) {
    slot_of(i)->push_from = 0;
    slot_of(i)->pop_from = kNever;
  }
}

void LinkBase::fail(const char* what, Cycle cycle) const {
  throw spec::CheckFailed(
      fmt::format("{}: cycle {}: {} ({} of {} beats in the link; producer {}, consumer {})", name(),
                  cycle, what, occupancy(), depth_, producer_.empty() ? "unbound" : producer_,
                  consumer_.empty() ? "unbound" : consumer_));
}

bool LinkBase::drop_newest() {
  if (empty()) return false;
  tail_ = slot_of(--pushes_);
  tail_->pop_from = kNever;
  tail_->push_from = last_push_ + 1;
  return true;
}

bool LinkBase::duplicate_newest(Cycle cycle) {
  if (empty() || occupancy() == depth_) return false;
  std::memcpy(beat(pushes_), beat(pushes_ - 1), payload_bytes_);
  tail_->push_from = kNever;
  tail_->pop_from = cycle;
  tail_ = tail_->next;
  ++pushes_;
  return true;
}

std::string link_package(const std::string& name, sc_core::sc_object& root) {
  std::vector<const Payload*> payloads;
  for_each<LinkBase>(root, [&](const LinkBase& link) { payloads.push_back(&link.payload()); });
  return payload_package(name, payloads);
}

void PortBase::bind_link(LinkBase& link) {
  DEBURR_CHECK(!base_ && !outer_, fmt::format("{} is bound twice", name()));
  resolve(link);
}

void PortBase::bind_port(PortBase& outer) {
  DEBURR_CHECK(!base_ && !outer_, fmt::format("{} is bound twice", name()));
  DEBURR_CHECK(outer.inner_.empty(), fmt::format("{} already passes its link to {}", outer.name(),
                                                 outer.inner_.front()->name()));
  outer_ = &outer;
  outer.inner_.push_back(this);
  if (outer.base_) {
    // If the outer port has claimed the link already, the claim moves inwards.
    std::string& owner = side_ == Side::kProducer ? outer.base_->producer_ : outer.base_->consumer_;
    owner.clear();
    resolve(*outer.base_);
  }
}

void PortBase::resolve(LinkBase& link) {
  base_ = &link;
  resolved(link);
  if (!inner_.empty()) {
    for (PortBase* port : inner_) port->resolve(link);
    return;
  }
  std::string& owner = side_ == Side::kProducer ? link.producer_ : link.consumer_;
  DEBURR_CHECK(owner.empty(),
               fmt::format("{} has two {}s: {} and {}", link.name(),
                           side_ == Side::kProducer ? "producer" : "consumer", owner, name()));
  owner = name();
}

// Out of line, to keep the code of its users small.
LinkBase::~LinkBase() = default;

// Out of line, to keep the code of its users small.
PortBase::~PortBase() = default;

}  // namespace deburr::rtl
