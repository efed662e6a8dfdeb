// SPDX-License-Identifier: MIT
// Runs a SystemC unit and its RTL counterpart in parallel with the same beats and the same stalls
// at both ends, and compares them in every cycle.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/unit.h"
#include "tb/base/random.h"
#include "tb/harness/driver.h"

namespace deburr::tb::hdl {

// Decides from the cycle number whether an end stalls, so that both sides have the same stalls.
// Long stalls are as frequent as short ones, so that a pipeline becomes full.
struct Stalls {
  std::uint32_t permille = 0;
  std::uint64_t seed = 1;
  bool at(rtl::Cycle cycle) const {
    Random coarse(seed + cycle / 64), fine(seed ^ (cycle * Random::kStride));
    // In every 64 cycles some have no stalls, some half, and some the maximum density.
    const std::uint32_t density[] = {0, permille, permille, 1000 - permille / 4};
    return permille != 0 && fine.chance(density[coarse.below(4)]);
  }
};

// An end with these stalls.
inline EndOptions stalled(const Stalls& stalls) {
  return {.stalls_at = [stalls](rtl::Cycle cycle) { return stalls.at(cycle); }};
}
// Sends a list of beats that is refilled before each reset; two ends send the same list.
template <class T>
typename Driver<T>::Generator those_of(const std::vector<T>& beats) {
  return [&beats](std::uint64_t index, T& beat) {
    if (index >= beats.size()) return false;
    beat = beats[index];
    return true;
  };
}

// Counts the cycles in which only one of two links had a push or a pop, and the beats that differ.
// Ticked after the units, so that it sees their actions in this cycle.
template <class T>
class LinkComparison final : public rtl::Unit {
 public:
  // Masks the don't-care fields of a beat; without it all fields are compared.
  using Normal = std::function<T(const T&)>;
  LinkComparison(const sc_core::sc_module_name& name, rtl::ClockDomain& clock,
                 const rtl::Link<T>& model, const rtl::Link<T>& counterpart, Normal normal = {})
      : Unit(name, clock), model_(model), counterpart_(counterpart), normal_(std::move(normal)) {}

  std::uint64_t beats() const { return beats_; }
  std::uint64_t cycles_that_differ() const { return cycles_; }
  std::uint64_t payloads_that_differ() const { return payloads_; }
  // Describes the first difference.
  const std::string& first() const { return first_; }

  rtl::Activity tick(rtl::Cycle cycle) override {
    if (model_.pushes() != counterpart_.pushes() || model_.pops() != counterpart_.pops()) {
      if (cycles_++ == 0)
        note(cycle, "pushes " + std::to_string(model_.pushes()) + "/" +
                        std::to_string(counterpart_.pushes()) + ", pops " +
                        std::to_string(model_.pops()) + "/" + std::to_string(counterpart_.pops()));
    }
    // A popped beat remains readable until its entry is refilled, at the earliest one cycle later.
    for (; beats_ < std::min(model_.pushes(), counterpart_.pushes()); ++beats_) compare(cycle);
    return rtl::kIdle;
  }
  void reset() override { beats_ = 0; }

 private:
  void compare(rtl::Cycle cycle) {
    T model, counterpart;
    std::memcpy(static_cast<void*>(&model), model_.beat(beats_), sizeof(T));
    std::memcpy(static_cast<void*>(&counterpart), counterpart_.beat(beats_), sizeof(T));
    if (normal_) model = normal_(model), counterpart = normal_(counterpart);
    const std::string difference = static_cast<const rtl::LinkBase&>(model_).payload().difference(
        reinterpret_cast<const std::byte*>(&model),
        reinterpret_cast<const std::byte*>(&counterpart));
    if (!difference.empty() && payloads_++ == 0)
      note(cycle, "beat " + std::to_string(beats_) + ": " + difference);
  }
  void note(rtl::Cycle cycle, const std::string& what) {
    if (first_.empty()) first_ = "clock " + std::to_string(cycle) + ": model/counterpart " + what;
  }

  const rtl::Link<T>& model_;
  const rtl::Link<T>& counterpart_;
  Normal normal_;
  std::uint64_t beats_ = 0, cycles_ = 0, payloads_ = 0;
  std::string first_;
};

// Compares the links inside a unit with those of its RTL counterpart: counts the cycles in which
// only one of them had a push or a pop. The counterpart reports one bit per link.
class InnerLinks final : public rtl::Unit {
 public:
  InnerLinks(const sc_core::sc_module_name& name, rtl::ClockDomain& clock,
             std::vector<const rtl::LinkBase*> model)
      : Unit(name, clock), model_(std::move(model)), pushes_(model_.size()), pops_(model_.size()) {}
  void counterpart_does(std::uint32_t pushes, std::uint32_t pops) {
    for (std::size_t i = 0; i < model_.size(); ++i)
      pushes_[i] += pushes >> i & 1, pops_[i] += pops >> i & 1;
  }
  std::uint64_t cycles_that_differ() const { return cycles_; }
  std::uint64_t beats() const { return beats_; }
  const std::string& first() const { return first_; }

  rtl::Activity tick(rtl::Cycle cycle) override {
    bool same = true;
    for (std::size_t i = 0; i < model_.size(); ++i) {
      const bool equal = model_[i]->pushes() == pushes_[i] && model_[i]->pops() == pops_[i];
      if (!equal && first_.empty())
        first_ = "clock " + std::to_string(cycle) + ": " + model_[i]->basename() +
                 " of model/counterpart: pushes " + std::to_string(model_[i]->pushes()) + "/" +
                 std::to_string(pushes_[i]) + ", pops " + std::to_string(model_[i]->pops()) + "/" +
                 std::to_string(pops_[i]);
      same &= equal;
    }
    cycles_ += !same;
    return rtl::kIdle;
  }
  void reset() override {
    for (const std::uint64_t pushes : pushes_) beats_ += pushes;
    std::fill(pushes_.begin(), pushes_.end(), 0);
    std::fill(pops_.begin(), pops_.end(), 0);
  }

 private:
  std::vector<const rtl::LinkBase*> model_;
  std::vector<std::uint64_t> pushes_, pops_;
  std::uint64_t cycles_ = 0, beats_ = 0;
  std::string first_;
};

}  // namespace deburr::tb::hdl
