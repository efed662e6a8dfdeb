// SPDX-License-Identifier: MIT
#include "tb/env/injected_faults.h"

#include <fmt/format.h>

#include <utility>

#include "spec/error.h"

namespace deburr::tb {

std::vector<InjectedFault> memory_faults(const std::string& needs) {
  return {{"lost-response", "Memory never answers request 20.", "", needs},
          {"memory-error", "Memory answers request 20 with an error.", "", needs}};
}

std::string FaultPlan::Known::full_name() const {
  return environment.empty() ? fault.name : fmt::format("{}.{}", environment, fault.name);
}

bool FaultPlan::names(std::string_view given, std::string_view environment, std::string_view name) {
  return given == name ||
         (!environment.empty() && given == fmt::format("{}.{}", environment, name));
}

void FaultPlan::know(std::string_view environment, std::vector<InjectedFault> faults) {
  for (InjectedFault& fault : faults)
    known_.push_back({std::string(environment), std::move(fault)});
}

bool FaultPlan::injected(std::string_view environment, std::string_view name) const {
  for (const std::string& given : given_)
    if (names(given, environment, name)) return true;
  return false;
}

std::vector<std::string> FaultPlan::known_names() const {
  std::vector<std::string> names;
  names.reserve(known_.size());
  for (const Known& known : known_) names.push_back(known.full_name());
  return names;
}

std::vector<std::string> FaultPlan::link_faults() const {
  std::vector<std::string> links;
  for (const std::string& given : given_) {
    if (given.find(':') != std::string::npos) {
      links.push_back(given);
      continue;
    }
    const Known* found = nullptr;
    std::string all;
    for (const Known& known : known_) {
      all += fmt::format(" {}", known.full_name());
      if (!names(given, known.environment, known.fault.name)) continue;
      if (found)
        throw spec::ConfigError(fmt::format("fault '{}' is ambiguous: give {} or {}", given,
                                            found->full_name(), known.full_name()));
      found = &known;
    }
    if (!found)
      throw spec::ConfigError(fmt::format(
          "unknown fault '{}'; known:{}, and link faults such as drop:LINK:100", given, all));
    if (!found->fault.needs.empty())
      throw spec::ConfigError(fmt::format("fault '{}' needs {}", given, found->fault.needs));
    if (!found->fault.link_fault.empty()) links.push_back(found->fault.link_fault);
  }
  return links;
}

}  // namespace deburr::tb
