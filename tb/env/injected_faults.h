// SPDX-License-Identifier: MIT
// Faults by name (`--fault NAME`), looked up in one place for every engine and every composition of
// engines; docs/reference/tests.md says what must catch each.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace deburr::tb {

// What an environment can plant. With a link fault the harness plants it (fault_injector.h), else
// the environment does.
struct InjectedFault {
  std::string name, meaning, link_fault{};
  std::string needs{};  // why it cannot be injected in this run; empty: it can
};

// What a memory can do wrong with request kFaultyRequest: `lost-response` and `memory-error`.
inline constexpr std::uint64_t kFaultyRequest = 20;
std::vector<InjectedFault> memory_faults(const std::string& needs = {});

// The faults that a run was given, against those that its environments know. An environment that
// has a name of its own in the simulation ("painter") may be named in front: painter.flip-bit.
class FaultPlan {
 public:
  explicit FaultPlan(std::vector<std::string> given) : given_(std::move(given)) {}

  void know(std::string_view environment, std::vector<InjectedFault> faults);
  // Before all environments are known too, since hardware is built with it: a name that turns out
  // to mean two faults is rejected by link_faults().
  bool injected(std::string_view environment, std::string_view name) const;
  // All that environments know, in their order.
  std::vector<std::string> known_names() const;
  // What the harness plants. ConfigError for a name that nobody knows, that two environments know,
  // or whose fault cannot be injected.
  std::vector<std::string> link_faults() const;

 private:
  struct Known {
    std::string environment;
    InjectedFault fault;
    std::string full_name() const;
  };
  static bool names(std::string_view given, std::string_view environment, std::string_view name);

  std::vector<std::string> given_;
  std::vector<Known> known_;
};

// Base of what an engine's environment can plant: its list, and hardware and inputs with them.
class EngineFaults {
 public:
  // The plan must outlive it.
  EngineFaults(const FaultPlan& plan, std::string environment)
      : plan_(plan), environment_(std::move(environment)) {}

 protected:
  bool injected(std::string_view fault) const { return plan_.injected(environment_, fault); }

 private:
  const FaultPlan& plan_;
  std::string environment_;
};

}  // namespace deburr::tb
