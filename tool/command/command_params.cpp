// SPDX-License-Identifier: MIT
// `deburr params [UNIT]`: every parameter with kind, default, range, unit and meaning.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "spec/error.h"
#include "tb/base/json_text.h"
#include "tb/base/near_matches.h"
#include "tb/base/terminal.h"
#include "tb/run/amount.h"
#include "tb/run/parameter_set.h"
#include "tool/command/commands.h"
#include "tool/run/engine.h"
#include "tool/run/reference_pages.h"
#include "tool/run/run_once.h"
#include "tool/run/shorthands.h"

namespace deburr::tool {

using tb::Parameter;

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLeastMeaning = 24;  // columns; narrower texts get their own lines

struct ParamsCommand {
  std::string unit, markdown;
  bool c_header = false, systemrdl = false, uvm = false, cost = false;
  std::vector<std::string> sets;
};

std::string ranged(const tb::Ranged& figure) {
  return tb::with_range(figure.low, figure.value, figure.high);
}

std::string cost_table(const tb::Cost& cost) {
  std::vector<std::array<std::string, 7>> rows = {
      {"unit", "basis", "gates", "flip-flops", "memory bits", "ns", "stage"}};
  const auto add = [&](const std::string& name, const std::string& basis, const auto& of,
                       const std::string& stage) {
    rows.push_back({name, basis, ranged(of.gates), tb::grouped(of.flip_flops),
                    tb::grouped(of.memory_bits), ranged(of.ns), stage});
  };
  for (const tb::UnitCost& unit : cost.units) add(unit.name, unit.basis, unit, unit.stage);
  add("total", "", cost, cost.limited_by);
  std::array<std::size_t, 7> widths{};
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i)
      line += i >= 2 && i <= 5 ? fmt::format("{:>{}}  ", row[i], widths[i])
                               : fmt::format("{:{}}  ", row[i], widths[i]);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  text += fmt::format("\nclock: {} MHz, {:.2f} x a 24 x 24 multiply ({})\n", ranged(cost.clock_mhz),
                      cost.yardstick_ratio, cost.technology);
  for (const tb::SramArea& sram : cost.sram)
    text += fmt::format("SRAM: {:.3f} mm2 ({})\n", sram.mm2, sram.technology);
  return text;
}

// The cost of a build, without a run.
Outcome print_cost(const ParamsCommand& command, bool json) {
  if (command.unit.empty())
    throw spec::ConfigError("--cost needs an engine: deburr params texture --cost");
  const std::unique_ptr<Engine> engine = engine_named(command.unit);
  BoundEngine bound(*engine);
  for (const std::string& text : command.sets) bound.set.set_assignment(text, "--set");
  bound.resolve();
  tb::Result result;
  engine->describe_build(result);
  if (result.sheets.empty())
    throw spec::ConfigError(fmt::format("{} has no datasheets, so it has no cost", command.unit));
  result.cost = cost_of(result, bound.set);
  Outcome outcome{
      0, fmt::format("PASS params: {} gates of {}", ranged(result.cost->gates), command.unit)};
  if (json)
    outcome.details = tb::json_text(Json{{"cost", to_json(result).at("cost")}});
  else
    fmt::print("{}", cost_table(*result.cost));
  return outcome;
}

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
  if (command.cost) return print_cost(command, json);
  const auto all = engines();
  if (command.c_header) {
    fmt::print("{}", registers_header(all));
    return {};
  }
  if (command.systemrdl) {
    fmt::print("{}", registers_systemrdl(all));
    return {};
  }
  if (command.uvm) {
    fmt::print("{}", registers_uvm(all));
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
                           "deburr params --c-header", "deburr params texture --cost"});
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
  CLI::Option* const uvm =
      command
          ->add_flag("--uvm", options->uvm,
                     "Print the registers of every engine as UVM register models instead")
          ->excludes(markdown)
          ->excludes(c_header)
          ->excludes(systemrdl);
  CLI::Option* const cost =
      command
          ->add_flag("--cost", options->cost,
                     "Print gates, flip-flops, memory and longest path of the engine UNIT instead, "
                     "without a run")
          ->excludes(markdown)
          ->excludes(c_header)
          ->excludes(systemrdl)
          ->excludes(uvm);
  command
      ->add_option("--set", options->sets,
                   "With --cost: any parameter of the engine; may be repeated")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("NAME=VALUE")
      ->needs(cost);
  command
      ->add_flag("--json", line.json,
                 "Print one JSON object: exit code, outcome, parameters, limits")
      ->excludes(markdown)
      ->excludes(c_header)
      ->excludes(systemrdl)
      ->excludes(uvm);
  command->callback([options, &line] {
    line.action = [options, &line] { return print_params(*options, line.json); };
  });
}

}  // namespace deburr::tool
