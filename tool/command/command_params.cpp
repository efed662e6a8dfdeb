// SPDX-License-Identifier: MIT
// `deburr params [UNIT]`: every parameter with kind, default, range, unit and meaning.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "spec/error.h"
#include "tb/base/json_text.h"
#include "tb/base/near_matches.h"
#include "tb/base/terminal.h"
#include "tb/run/parameter_set.h"
#include "tool/command/commands.h"
#include "tool/run/engine.h"
#include "tool/run/reference_pages.h"
#include "tool/run/shorthands.h"

namespace deburr::tool {

using tb::Parameter;

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLeastMeaning = 24;  // columns; narrower texts get their own lines

struct ParamsCommand {
  std::string unit, markdown;
  bool c_header = false, systemrdl = false;
};

Json to_json(const Engine& engine, const Parameter& p) {
  Json json = {{"engine", engine.name()}, {"name", p.name},   {"kind", kind_name(p)},
               {"default", p.json()},     {"range", p.range}, {"unit", p.unit},
               {"meaning", p.meaning}};
  if (!p.aliases.empty()) json["aliases"] = p.aliases;
  return json;
}

// Short options of `deburr run ENGINE`, and the parameters that they set.
void list_options(const Engine& engine, const tb::ParameterSet& set, Json& listed) {
  for (const Shorthand& shorthand : shorthands_of(engine)) {
    Json parameters = {shorthand.parameter};
    if (!shorthand.second_parameter.empty()) parameters.push_back(shorthand.second_parameter);
    const Parameter* const parameter = set.find(shorthand.parameter);
    DEBURR_CHECK(parameter, shorthand.option + " sets an unknown parameter");
    const bool is_switch = parameter->range == "true | false";
    listed.push_back({{"engine", engine.name()},
                      {"option", shorthand.option},
                      {"parameters", parameters},
                      {"given", is_switch ? Json(shorthand.given) : Json()},
                      {"meaning", shorthand.help}});
  }
}

Outcome print_params(const ParamsCommand& command, bool json) {
  const auto all = engines();
  if (command.c_header) {
    fmt::print("{}", registers_header(all));
    return {};
  }
  if (command.systemrdl) {
    fmt::print("{}", registers_systemrdl(all));
    return {};
  }
  if (command.markdown == "parameters") {
    fmt::print("{}", parameters_page(all));
    return {};
  }
  if (command.markdown == "statistics") {
    fmt::print("{}", statistics_page(all));
    return {};
  }
  if (command.markdown == "registers") {
    fmt::print("{}", registers_page(all));
    return {};
  }
  if (command.markdown == "coverage") {
    fmt::print("{}", coverage_page(all));
    return {};
  }
  if (command.markdown == "datasheets") {
    fmt::print("{}", datasheets_page(all));
    return {};
  }
  std::vector<std::string> groups;
  std::vector<Parameter> shown;
  std::vector<tb::BuildLimit> limits;
  Json listed = Json::array();  // per engine, since defaults may differ
  Json options = Json::array();
  for (const auto& engine : all) {
    tb::ParameterSet set;
    RunParameters run = engine->run_parameters();
    set.add("run", tb::ParameterKind::kRun, run);
    engine->add_parameters(set);
    for (const Parameter& p : set.all()) {
      const std::string group = p.name.substr(0, p.name.find('.'));
      if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
      const bool known = std::any_of(shown.begin(), shown.end(),
                                     [&](const Parameter& other) { return other.name == p.name; });
      if (!command.unit.empty() && command.unit != group) continue;
      if (!known) shown.push_back(p);
      listed.push_back(to_json(*engine, p));
    }
    if (command.unit.empty()) list_options(*engine, set, options);
    for (const tb::BuildLimit& limit : set.build_limits()) {
      const std::string& about = limit.parameters.front();
      const bool known = std::find(limits.begin(), limits.end(), limit) != limits.end();
      if (!known && (command.unit.empty() || command.unit == about.substr(0, about.find('.'))))
        limits.push_back(limit);
    }
  }
  if (shown.empty())
    throw spec::ConfigError(fmt::format("no unit '{}'{} (known: {})", command.unit,
                                        tb::did_you_mean(tb::near_matches(command.unit, groups)),
                                        fmt::join(groups, ", ")));
  if (json) {
    Json rules = Json::array();
    for (const tb::BuildLimit& limit : limits)
      rules.push_back({{"parameters", limit.parameters}, {"must", limit.must}});
    Outcome outcome{0, fmt::format("PASS params: {} parameters", shown.size())};
    outcome.details =
        tb::json_text(Json{{"parameters", listed}, {"options", options}, {"limits", rules}});
    return outcome;
  }
  std::size_t name = 0, kind = 0, value = 0, range = 0, unit = 0;
  for (const Parameter& p : shown) {
    kind = std::max(kind, kind_name(p).size());
    name = std::max(name, p.name.size());
    value = std::max(value, p.default_value.size());
    range = std::max(range, std::min<std::size_t>(p.range.size(), 40));
    unit = std::max(unit, p.unit.size());
  }
  const std::size_t columns = tb::output_columns(),
                    meaning = name + kind + value + range + unit + 10;
  const bool fits = columns == 0 || meaning + kLeastMeaning <= columns;
  for (const Parameter& p : shown)
    if (fits)
      tb::print_wrapped(
          fmt::format("{:{}}  {:{}}  {:{}}  {:{}}  {:{}}  {}\n", p.name, name, kind_name(p), kind,
                      p.default_value, value, p.range, range, p.unit, unit, p.meaning),
          meaning);
    else
      fmt::print("{}", tb::row_in_lines({p.name, std::string(kind_name(p)), p.default_value,
                                         p.range, p.unit, p.meaning},
                                        {}, columns));
  if (!limits.empty())
    tb::print_wrapped("\nBuild limits of the hardware, in addition to these ranges:\n", 0);
  for (const tb::BuildLimit& limit : limits)
    tb::print_wrapped(fmt::format("{:{}}  {}\n", limit.parameters.front(), name, limit.must),
                      fits ? name + 2 : 4);
  return {};
}

}  // namespace

void add_params(CLI::App& app, CommandLine& line) {
  CLI::App* command =
      app.add_subcommand("params", "List every parameter: kind, default, range, unit, meaning");
  show_examples(*command, {"deburr params memory", "deburr params --markdown registers",
                           "deburr params --c-header"});
  const auto options = std::make_shared<ParamsCommand>();
  command->add_option("UNIT", options->unit,
                      "Only parameters of this group: run, scene, sampler, texture, memory, ...");
  CLI::Option* const markdown =
      command->add_option("--markdown", options->markdown,
                          "Print a page of the docs instead: parameters, statistics, registers, "
                          "coverage, datasheets");
  markdown->expected(0, 1)
      ->default_str("parameters")
      ->check(CLI::IsMember({"parameters", "statistics", "registers", "coverage", "datasheets"}));
  CLI::Option* const c_header =
      command
          ->add_flag("--c-header", options->c_header,
                     "Print the registers of every engine as a C header instead")
          ->excludes(markdown);
  CLI::Option* const systemrdl =
      command
          ->add_flag("--systemrdl", options->systemrdl,
                     "Print the registers of every engine as SystemRDL instead")
          ->excludes(markdown)
          ->excludes(c_header);
  command
      ->add_flag("--json", line.json,
                 "Print one JSON object: exit code, outcome, parameters, limits")
      ->excludes(markdown)
      ->excludes(c_header)
      ->excludes(systemrdl);
  command->callback([options, &line] {
    line.action = [options, &line] { return print_params(*options, line.json); };
  });
}

}  // namespace deburr::tool
