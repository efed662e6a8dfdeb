// SPDX-License-Identifier: MIT
// `deburr run ENGINE`: collects parameters, runs the engine once, writes the results.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "spec/error.h"
#include "tb/base/file.h"
#include "tb/base/headline.h"
#include "tb/base/interrupt.h"
#include "tb/base/shell.h"
#include "tb/base/terminal.h"
#include "tb/run/amount.h"
#include "tool/command/commands.h"
#include "tool/run/engine.h"
#include "tool/run/run_once.h"
#include "tool/run/shorthands.h"

namespace deburr::tool {
namespace {

using spec::ConfigError;

// An option or a --set, as the user wrote it.
struct Assignment {
  std::string name, value, where;
};

struct RunOptions {
  std::optional<std::string> config, out;
  std::vector<std::string> sets;
  std::vector<Assignment> shorthands;
  bool resolve_only = false, wait = false, quiet = false;
};

std::vector<Assignment> expand(const Shorthand& shorthand, const std::string& value) {
  if (!shorthand.second_parameter.empty()) {  // WxH
    const std::size_t cross = value.find('x');
    if (cross == std::string::npos)
      throw ConfigError(
          fmt::format("{}: expected WIDTHxHEIGHT, got '{}'", shorthand.option, value));
    return {{shorthand.parameter, value.substr(0, cross), shorthand.option},
            {shorthand.second_parameter, value.substr(cross + 1), shorthand.option}};
  }
  return {{shorthand.parameter, value, shorthand.option}};
}

void reject_empty_names(const RunOptions& options) {
  for (const auto& [name, value] : {std::pair("--config", options.config), {"--out", options.out}})
    if (value && value->empty())
      throw ConfigError(
          fmt::format("{}: expected a name, got '': give one, or leave out {}", name, name));
}

// The contents of --config. It is read once, since it may be a pipe.
std::string configuration_of(const RunOptions& options) {
  if (!options.config) return "";
  return *options.config == tb::kStandardInput
             ? tb::read_standard_input(tb::kMaxConfigurationBytes)
             : tb::read_file(*options.config, tb::kMaxConfigurationBytes);
}

// Quoted for printf, in one line.
std::string printed(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\n')
      escaped += "\\n";
    else if (c == '\\')
      escaped += "\\\\";
    else if (static_cast<unsigned char>(c) < ' ')
      escaped += fmt::format("\\0{:03o}", static_cast<unsigned char>(c));
    else
      escaped += c;
  }
  return "printf %b " + tb::shell_quoted(escaped);
}

void apply(const RunOptions& options, const std::string& configuration, const std::string& engine,
           tb::ParameterSet& set) {
  if (options.config) set.load(*options.config, configuration, engine);
  // Without this check, a parameter given twice with different values would silently lose one of
  // them.
  std::map<std::string, Assignment> given;
  std::vector<Assignment> all = options.shorthands;
  for (const std::string& text : options.sets) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos)
      throw ConfigError(fmt::format("--set: expected name=value, got '{}'", text));
    all.push_back({text.substr(0, equals), text.substr(equals + 1), "--set"});
  }
  for (const Assignment& a : all) {
    const auto [first, inserted] = given.emplace(a.name, a);
    if (!inserted && first->second.value != a.value)
      throw ConfigError(fmt::format("{}: '{}' = '{}' contradicts {} ('{}')", a.where, a.name,
                                    a.value, first->second.where, first->second.value));
    set.set(a.name, a.value, a.where);
  }
}

std::string summary_of(const tb::Result& r, const std::filesystem::path& directory) {
  std::string text = r.unit + ": ";
  if (r.comparisons + r.traffic_comparisons > 0)
    text += fmt::format("{} outputs and {} memory accesses compared, {} mismatches, ",
                        tb::grouped(r.comparisons), tb::grouped(r.traffic_comparisons),
                        tb::grouped(r.mismatches + r.traffic_mismatches));
  text +=
      fmt::format("{} cycles, {:.3f} {}", tb::grouped(r.cycles), r.throughput, r.throughput_unit);
  std::string not_implementable;
  for (const tb::MemoryFigures& memory : r.memories)
    if (!memory.not_implementable.empty())
      not_implementable += fmt::format(
          "{} {}", not_implementable.empty() ? ", NOT IMPLEMENTABLE" : ",", memory.name);
  text += not_implementable;
  return text + fmt::format(", {}", (directory / "report.html").string());
}

std::string decibels(const std::optional<double>& after, const std::optional<double>& before) {
  if (!after) return "-";
  if (std::isinf(*after)) return "identical";
  std::string text = fmt::format("{:.2f} dB", *after);
  if (before && std::isfinite(*before)) text += fmt::format(" ({:+.2f})", *after - *before);
  return text;
}

std::string measured(const std::optional<double>& after, const std::optional<double>& before) {
  std::string text = fmt::format("{:.4f}", after.value_or(0));
  if (before) text += fmt::format(" ({:+.4f})", *after - *before);
  return text;
}

// Rate, bound, bottleneck, quality and changed pixels in a few lines.
std::string figures_of(const tb::Result& r) {
  if (r.cycles == 0) return "";
  std::string text = fmt::format("rate        {:.3f} {}", r.throughput, r.throughput_unit);
  if (r.throughput_bound > 0)
    text += fmt::format(", {:.1f} % of {:.4g}: {}", 100 * r.throughput / r.throughput_bound,
                        r.throughput_bound, r.throughput_bound_meaning);
  text += "\n";
  if (r.bottleneck)
    text +=
        fmt::format("limited by  {}, {} in {:.1f} % of the cycles: {}\n", r.bottleneck->unit,
                    r.bottleneck->cause,
                    100 * static_cast<double>(r.bottleneck->cycles) / static_cast<double>(r.cycles),
                    r.bottleneck->meaning);
  for (const tb::TerminalLine& line : r.terminal)
    text += fmt::format("{:<11} {}\n", line.name, line.text);
  if (r.bytes_read + r.bytes_written > 0)
    text += fmt::format("memory      {:.3g} GB/s read, {:.3g} written at {:g} MHz\n",
                        r.gb_per_s(r.bytes_read), r.gb_per_s(r.bytes_written), r.clock_mhz);
  if (r.cost) {
    const tb::Cost& cost = *r.cost;
    const auto ranged = [](const tb::Ranged& f) { return tb::with_range(f.low, f.value, f.high); };
    text += fmt::format("cost        {} gates", ranged(cost.gates));
    if (cost.ns.value > 0)
      text += fmt::format(", {} ns in {}, {} MHz", ranged(cost.ns), cost.limited_by,
                          ranged(cost.clock_mhz));
    text += "\n";
  }
  if (r.quality) {
    text += fmt::format("quality     {}", decibels(r.quality->psnr_db, r.quality->psnr_before_db));
    if (r.quality->psnr_edge_db)
      text += ", edges " + decibels(r.quality->psnr_edge_db, r.quality->psnr_edge_before_db);
    if (r.quality->psnr_silhouette_db)
      text += ", silhouettes " +
              decibels(r.quality->psnr_silhouette_db, r.quality->psnr_silhouette_before_db);
    if (r.quality->flip) text += ", FLIP " + measured(r.quality->flip, r.quality->flip_before);
    if (r.quality->ssim) text += ", SSIM " + measured(r.quality->ssim, r.quality->ssim_before);
    text += fmt::format(" against {}\n", r.quality->reference);
  }
  if (r.change) {
    const tb::Change& c = *r.change;
    text += fmt::format(
        "changed     {:.2f} % of the pixels by more than {} codes, {:.2f} % by more "
        "than {}",
        c.small_percent, tb::Change::kSmall, c.large_percent, tb::Change::kLarge);
    if (c.right_small_percent && c.right_large_percent)
      text += fmt::format(" (of correct input pixels {:.2f} % and {:.2f} %)",
                          *c.right_small_percent, *c.right_large_percent);
    text += fmt::format("; {} to the input\n", decibels(c.psnr_db, std::nullopt));
  }
  return text;
}

Outcome run_engine(Engine& engine, const RunOptions& options, CommandLine& line) {
  reject_empty_names(options);
  const std::string configuration = configuration_of(options);
  if (options.config == tb::kStandardInput)
    line.text = fmt::format("{} | {}", printed(configuration), line.text);
  BoundEngine bound(engine);
  apply(options, configuration, std::string(engine.name()), bound.set);
  bound.resolve();
  RunContext context(options.out.value_or(fmt::format("out/{}", engine.name())), bound.set,
                     line.text, static_cast<std::uint64_t>(bound.run.seed));
  context.set_quiet(options.quiet || line.json);
  if (options.resolve_only) {
    context.set_checking_only();
    tb::Result result;
    engine.run(bound.run, context, result);
    fmt::print("{}", bound.set.yaml());
    return {};
  }
  tb::catch_interrupts();
  const RunEnd end =
      run_once(bound, context, options.wait ? IfTaken::kWait : IfTaken::kReject, [&] {
        if (options.config) context.add_configuration(*options.config, configuration);
        return true;
      });
  const tb::Result& result = end.result;
  if (!end.begun) {
    fmt::print(stderr,
               "deburr: interrupted before the simulation began; no results were written\n");
    return {tb::kInterruptedExit,
            fmt::format("INTERRUPTED {}: before the simulation began, no results were written",
                        result.unit)};
  }
  for (const tb::MemoryFigures& memory : result.memories)
    if (!memory.not_implementable.empty() && !context.quiet())
      fmt::print(stderr, "deburr: warning: this hardware cannot be built: memory {}: {}\n",
                 memory.name, memory.not_implementable);
  context.finish(result);
  if (!context.quiet()) tb::print_wrapped(figures_of(result));
  if (result.pixel && !context.quiet())
    tb::print_wrapped(text_of(*result.pixel, (context.directory() / "report.html").string()), 4);
  const std::filesystem::path& directory = context.directory();
  const std::string summary = summary_of(result, directory);
  if (end.code != 0)
    return {end.code,
            fmt::format("FAIL {}: {} ({})", end.kind, tb::headline(result.reason), summary),
            directory};
  if (result.interrupted) {
    fmt::print(stderr,
               "deburr: interrupted; the partial results are kept. Run the same command again for "
               "complete results.\n");
    return {tb::kInterruptedExit, fmt::format("INTERRUPTED {}", summary), directory};
  }
  return {
      0, fmt::format("{} {}", result.verdict == tb::Verdict::kPass ? "PASS" : "UNCHECKED", summary),
      directory};
}

// The placeholder for the option's value in --help.
std::string value_name(const Shorthand& shorthand, const tb::Parameter& parameter) {
  if (!shorthand.second_parameter.empty()) return "WxH";
  if (parameter.range.find_first_not_of("0123456789.| ") == std::string::npos) return "NUMBER";
  if (parameter.range == "file") return "FILE";
  if (parameter.range == "glob") return "GLOB";
  if (parameter.range == "X,Y") return "X,Y";
  return shorthand.option == "--in" ? "FILE" : "NAME";
}

// The help text of the option, with the default if the default is a number.
std::string help_of(const Shorthand& shorthand, const tb::Parameter& parameter) {
  if (shorthand.help.empty() || parameter.range.find("..") == std::string::npos ||
      !shorthand.second_parameter.empty())
    return shorthand.help;
  return fmt::format("{} ({})", shorthand.help, parameter.default_value);
}

void add_shorthand(CLI::App& command, const Shorthand& shorthand, RunOptions& options,
                   const tb::Parameter& parameter) {
  if (parameter.range == "true | false") {
    command.add_flag_callback(
        shorthand.option,
        [&options, shorthand] {
          options.shorthands.push_back({shorthand.parameter, shorthand.given, shorthand.option});
        },
        shorthand.help);
    return;
  }
  command
      .add_option_function<std::string>(
          shorthand.option,
          [&options, shorthand](const std::string& value) {
            for (Assignment& a : expand(shorthand, value))
              options.shorthands.push_back(std::move(a));
          },
          help_of(shorthand, parameter))
      ->type_name(value_name(shorthand, parameter));
}

}  // namespace

void add_run(CLI::App& app, CommandLine& line) {
  CLI::App* run =
      app.add_subcommand("run", "Simulate an engine and check it against its golden model");
  run->require_subcommand(1);
  std::vector<std::string> examples;
  for (std::unique_ptr<Engine>& owned : engines()) {
    const std::shared_ptr<Engine> engine = std::move(owned);
    CLI::App* command =
        run->add_subcommand(std::string(engine->name()), std::string(engine->summary()));
    std::vector<std::string> lines;
    for (const std::string_view arguments : engine->examples())
      lines.push_back(fmt::format("deburr run {} {}", engine->name(), arguments));
    examples.push_back(lines.front());
    show_examples(*command, lines);
    const auto options = std::make_shared<RunOptions>();
    command
        ->add_option("--config", options->config,
                     "YAML file of parameters, or a run's manifest.json")
        ->type_name("FILE");
    command->add_option("--set", options->sets, "Any parameter of `deburr params`; may be repeated")
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->type_name("NAME=VALUE");
    command
        ->add_option("--out", options->out,
                     fmt::format("Directory for the results (out/{})", engine->name()))
        ->type_name("DIR");
    command->add_flag("--wait", options->wait,
                      "Wait while another run uses the directory, instead of failing");
    command->add_flag("--quiet", options->quiet, "Print only errors and the line RESULT: ...");
    command->add_flag("--json", line.json,
                      "Print one JSON object: exit code, outcome, directory, result");
    command->add_flag("--show-config", options->resolve_only,
                      "Check the configuration as a run would, print it and stop");
    // The parameters tell which shorthands are switches.
    const BoundEngine probe(*engine);
    for (const Shorthand& shorthand : shorthands_of(*engine)) {
      const tb::Parameter* parameter = probe.set.find(shorthand.parameter);
      DEBURR_CHECK(parameter, shorthand.option + " sets an unknown parameter");
      add_shorthand(*command, shorthand, *options, *parameter);
    }
    command->callback([engine, options, &line] {
      line.action = [engine, options, &line] { return run_engine(*engine, *options, line); };
    });
  }
  show_examples(*run, examples);
}

}  // namespace deburr::tool
