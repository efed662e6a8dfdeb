// SPDX-License-Identifier: MIT
// `deburr_soak --seconds 3600`: docs/explanation/verification.md, "Soak".
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "spec/error.h"
#include "tool/run/run_once.h"
#include "tool/soak/soak.h"

namespace deburr::tool {
namespace {

int run(int argc, char** argv) {
  SoakOptions options;
  std::vector<std::string> sets;
  CLI::App app("Check random configurations of all engines against their golden models");
  app.add_option("--seconds", options.seconds, "How long")->capture_default_str();
  app.add_option("--runs", options.runs, "End after N runs; 0: when the time is over");
  app.add_option("--seed", options.seed, "Seed of the first configuration of each engine")
      ->capture_default_str();
  app.add_option("--engines", options.engines, "Engines, separated by commas (all)")
      ->delimiter(',');
  app.add_option("--long-every", options.long_every,
                 "Of every N runs, the last ones are long, one of each engine; 0: no long runs")
      ->capture_default_str();
  app.add_option("--set", sets, "NAME=VALUE replaces a random value; may be repeated")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  CLI11_PARSE(app, argc, argv);
  for (const std::string& engine : options.engines) engine_named(engine);
  for (const std::string& text : sets) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) throw spec::ConfigError("--set: expected name=value");
    options.settings.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  return soak(options);
}

}  // namespace
}  // namespace deburr::tool

int main(int argc, char** argv) {
  try {
    return deburr::tool::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "deburr_soak: %s\n", error.what());
    return 2;
  }
}
