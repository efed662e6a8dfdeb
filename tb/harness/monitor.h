// SPDX-License-Identifier: MIT
// Passive monitor of one link: calls back for each push and pop at the end of the cycle.
#pragma once

#include <functional>
#include <utility>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/link.h"

namespace deburr::tb {

template <class T>
class Monitor final : public rtl::Clocked {
 public:
  using Callback = std::function<void(rtl::Cycle, const T&)>;
  Monitor(rtl::ClockDomain& clock, const rtl::Link<T>& link, Callback on_push, Callback on_pop = {})
      : link_(link), on_push_(std::move(on_push)), on_pop_(std::move(on_pop)) {
    clock.add_after(*this);
  }
  rtl::Activity tick(rtl::Cycle cycle) override {
    if (on_push_ && link_.last_push() == cycle) on_push_(cycle, beat(link_.pushes() - 1));
    if (on_pop_ && link_.last_pop() == cycle) on_pop_(cycle, beat(link_.pops() - 1));
    return rtl::kIdle;
  }
  void reset() override {}

 private:
  const T& beat(std::uint64_t number) const {
    return *reinterpret_cast<const T*>(link_.beat(number));
  }
  const rtl::Link<T>& link_;
  Callback on_push_, on_pop_;
};

}  // namespace deburr::tb
