// SPDX-License-Identifier: MIT
// Looks up faults by name (`--fault NAME`) for every engine and composition.
// docs/reference/tests.md says which check must detect each fault.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace deburr::tb {

// A fault that an environment can inject. With a link_fault, the harness injects it
// (fault_injector.h).
struct InjectedFault {
  std::string name, meaning, link_fault{};
  std::string needs{};  // why this run cannot inject it; empty: it can
};

// Faults of a memory in request kFaultyRequest: `lost-response` and `memory-error`.
inline constexpr std::uint64_t kFaultyRequest = 20;
std::vector<InjectedFault> memory_faults(const std::string& needs = {});

// Matches the requested faults with those that environments declare. A name may be prefixed by the
// environment's name in the simulation ("painter"): painter.flip-bit.
class FaultPlan {
 public:
  explicit FaultPlan(std::vector<std::string> given) : given_(std::move(given)) {}

  void know(std::string_view environment, std::vector<InjectedFault> faults);
  // May be called before all environments have declared their faults, since hardware is built from
  // the result. If a name turns out to be ambiguous, link_faults() rejects it.
  bool injected(std::string_view environment, std::string_view name) const;
  // All declared faults, in the order of environments.
  std::vector<std::string> known_names() const;
  // Faults that the harness injects. Throws ConfigError for an unknown name, a name that two
  // environments declare, or a fault that cannot be injected in this run.
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

// Base of an engine's faults: their list, and the modified hardware and inputs.
class EngineFaults {
 public:
  // `plan` must outlive it.
  EngineFaults(const FaultPlan& plan, std::string environment)
      : plan_(plan), environment_(std::move(environment)) {}

 protected:
  bool injected(std::string_view fault) const { return plan_.injected(environment_, fault); }

 private:
  const FaultPlan& plan_;
  std::string environment_;
};

}  // namespace deburr::tb
