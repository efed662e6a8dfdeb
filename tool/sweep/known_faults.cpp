// SPDX-License-Identifier: MIT
#include "tool/sweep/known_faults.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string_view>

#include "spec/error.h"
#include "tb/base/forked.h"
#include "tb/base/near_matches.h"
#include "tb/run/result.h"
#include "tool/run/engine.h"

namespace deburr::tool {
namespace {

std::vector<std::string> faults_of(const std::string& engine) {
  std::istringstream words(tb::forked_text([&] {
    tb::Result result;
    engine_named(engine)->describe_statistics(result);
    return fmt::format("{}", fmt::join(result.faults, " "));
  }));
  std::vector<std::string> names;
  for (std::string name; words >> name;) names.push_back(name);
  return names;
}

// Accepts a part's fault by its short name too: "ENGINE.flip-bit" by "flip-bit".
bool is_named(std::string_view known, std::string_view given) {
  return known == given || (known.ends_with(given) && known.size() > given.size() &&
                            known[known.size() - given.size() - 1] == '.');
}

}  // namespace

void KnownFaults::require(const std::string& engine, const std::string& fault) {
  if (fault.empty() || fault.find(':') != std::string::npos) return;
  if (!of_engines_.contains(engine)) of_engines_[engine] = faults_of(engine);
  const std::vector<std::string>& known = of_engines_[engine];
  if (std::any_of(known.begin(), known.end(),
                  [&](const std::string& name) { return is_named(name, fault); }))
    return;
  throw spec::ConfigError(fmt::format(
      "run.fault: no run of '{}' has a fault '{}'{} (docs/reference/tests.md lists them)", engine,
      fault, tb::did_you_mean(tb::near_matches(fault, known))));
}

}  // namespace deburr::tool
