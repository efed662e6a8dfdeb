// SPDX-License-Identifier: MIT
// Errors of the command line, and commands without results: help, completion, params.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "tb/run/amount.h"
#include "tool/tests/command/in_process.h"
#include "tool/tests/command/made_engine.h"

namespace deburr::tool::line_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using Json = nlohmann::ordered_json;

void run_nothing(const RunParameters& /*run*/, RunContext& /*context*/, tb::Result& /*result*/) {}

// ---- errors -------------------------------------------------------------------------------------

constexpr const char* kKnown =
    "run, papers, train, params, compare, report, sweep, search, regress, completion, help";

// tool/tests/negative/app_bad_input_test.py has more mistakes, with real engines.
class WrongCommandLine : public InProcessTable {};

TEST_P(WrongCommandLine, MessageNamesMistake) {
  expect_failure(GetParam().given, GetParam().expected);
}

const Case kMistakes[] = {
    {"UnknownUnit", "params mad",
     "configuration: no unit 'mad': did you mean 'made'? (known: run, frame, made, other)"},
    {"CostWithoutEngine", "params --cost",
     "configuration: --cost needs an engine: deburr params texture --cost"},
    {"CostOfUnknownEngine", "params mad --cost",
     "configuration: no engine 'mad': did you mean 'made'? (known: made, other)"},
    {"CostWithoutDatasheets", "params other --cost",
     "configuration: other has no datasheets, so it has no cost"},
    {"SettingWithoutCost", "params made --set made.lanes=8",
     "usage: --set requires --cost (see deburr params --help)"},
    {"WrongValueForCost", "params made --cost --set made.lanes=99",
     "configuration: --set: 'made.lanes' = '99' is outside 1..16"},
    {"OneRunToCompare", "compare a",
     "usage: DIR: At least 2 required but received 1 (see deburr compare --help)"},
    {"HelpBelowCommandWithoutCommands", "help sweep plan",
     "configuration: no 'deburr sweep plan': 'deburr sweep' has no commands"},
    {"UnknownOption", "run made --sede 3",
     "usage: unknown option '--sede': did you mean '--seed', '--set' or '--size'? (see deburr run "
     "made --help)"},
    {"FirstOfTwoUnknownOptions", "run made --quiet --wrong 3 --sede",
     "usage: unknown option '--wrong' (see deburr run made --help)"},
    {"ValueIsNoCommand", "run --check made --wrong",
     "usage: unknown option '--check' (see deburr run --help)"},
    {"OptionThatIsGone", "search first.yaml run --no-guess",
     "usage: --no-guess: removed in 0.4.0: a search always runs every generation; leave it out "
     "(see deburr search --help)"},
    {"NotAnInteger", "run made --windows x",
     "configuration: --windows: 'run.interval_cycles' = 'x' must be an integer 0..1099511627776"},
    {"PopulationNotMultipleOf4", "search first.yaml --population 10",
     "usage: --population: '10' is not a multiple of 4 in 8..4096 (see deburr search --help)"},
    {"PopulationTooLarge", "search first.yaml --population 4100",
     "usage: --population: '4100' is not a multiple of 4 in 8..4096 (see deburr search --help)"},
};
INSTANTIATE_TEST_SUITE_P(All, WrongCommandLine, testing::ValuesIn(kMistakes), name_of_case);

using NumberOnCommandLine = InProcess;
TEST_F(NumberOnCommandLine, MessageNamesRange) {
  struct Row {
    const char *command, *arguments, *option, *value, *range;
  };
  for (const Row& row : {Row{"sweep", "first.yaml plan", "--jobs", "0", "1 to 4096"},
                         Row{"sweep", "first.yaml plan", "--jobs", "4097", "1 to 4096"},
                         Row{"search", "first.yaml", "--runs", "7", "8 to 1000000"},
                         Row{"regress", "night.yaml", "--divide", "0", "1 to 100000"},
                         Row{"regress", "night.yaml", "--divide", "100001", "1 to 100000"},
                         Row{"train", "--in a --truth b --out c", "--batches", "0", "1 to 100000"},
                         Row{"papers", "", "--size", "63", "64 to 4096"}})
    EXPECT_EQ(result(fmt::format("{} {} {} {}", row.command, row.arguments, row.option, row.value)),
              fmt::format("FAIL usage: {}: Value {} not in range {} (see deburr {} --help)",
                          row.option, row.value, row.range, row.command));
}

class CommandLine : public InProcess {
 protected:
  CommandLine() { made_run() = run_nothing; }

  // The lines that begin with `start`, without it.
  std::vector<std::string> lines(const std::string& command, const std::string& start) {
    std::istringstream text(printed(command));
    std::vector<std::string> found;
    for (std::string line; std::getline(text, line);)
      if (line.starts_with(start)) found.push_back(line.substr(start.size()));
    return found;
  }
};

TEST_F(CommandLine, ErrorWithJsonPrintsOneObject) {
  for (const auto& [command, outcome] :
       {std::pair("run made --out --json",
                  "FAIL usage: --out needs a value, but '--json' is an option: to use it as the "
                  "value, write --out=--json"),
        {"params run --json --c-header",
         "FAIL usage: --c-header excludes --json (see deburr params --help)"},
        {"regress --json rerun",
         "FAIL configuration: rerun needs --failed: 'rerun --failed' repeats the runs that "
         "failed"}}) {
    const std::string line = std::string("deburr ") + command;
    EXPECT_EQ(json(command),
              (Json{{"exit_code", 2}, {"outcome", outcome}, {"command", line}, {"repro", line}}));
  }
}

TEST_F(CommandLine, VersionNamesTheBuild) {
  EXPECT_EQ(printed("--version"), "deburr VERSION (COMMIT), COMPILER, SystemC VERSION\n");
}

// ---- help ---------------------------------------------------------------------------------------

TEST_F(CommandLine, HelpListsCommandsExamplesAndExitCodes) {
  const std::string help = printed("help");
  std::string names;
  for (const std::string& line : lines("help", "  "))
    if (line.size() > 28 && line[27] == ' ' && line[0] != '-')
      names += line.substr(0, line.find(' ')) + ", ";
  EXPECT_EQ(names, std::string(kKnown) + ", ");
  EXPECT_THAT(help, HasSubstr("\nExamples:\n  deburr help run\n"));
  EXPECT_THAT(help, HasSubstr("\nExit codes: 0 pass, 1 mismatch or worse, 2 usage"));
  EXPECT_THAT(printed("help completion"),
              HasSubstr("\nUsage: deburr completion [OPTIONS] [SHELL]\n\nPositionals:\n"));
}

TEST_F(CommandLine, HelpOfRunShowsKindsAndDefaultsOfValues) {
  const std::string help = printed("run made --help");
  for (const char* const line :
       {"--config FILE               YAML file of parameters, or a run's manifest.json",
        "--set NAME=VALUE ...        Any parameter of `deburr params`; may be repeated",
        "--out DIR                   Directory for the results (out/made)",
        "--seed NUMBER               Seed of procedural textures (1)",
        "--check NAME                golden (default) or none",
        "--trace GLOB                Write waves of these units and links (glob) to trace.vcd",
        "--trace-to NUMBER           Cycle after the last one traced (2000)",
        "--maps                      Write maps of the work per pixel",
        "--pixel X,Y                 Record every step for this pixel",
        "--in FILE                   What goes in", "--size WxH                  Of the frame",
        "--gain NUMBER               Of the frame (0.5)",
        "--round                     To the nearest",
        "deburr run made --size 64x32\n  deburr run made --lanes 8"})
    EXPECT_THAT(help, HasSubstr(std::string("\n  ") + line + "\n"));
  EXPECT_THAT(printed("help run other"), HasSubstr("(out/other)\n"));
}

TEST_F(CommandLine, ManualPageListsEveryCommandAsRoff) {
  const std::string page = printed("help --man");
  EXPECT_THAT(page, HasSubstr("\n.TH DEBURR 1 \"\" \"deburr VERSION\" \"User Commands\"\n"));
  EXPECT_THAT(lines("help --man", ".SS deburr "),
              ElementsAre("run", "run made", "run other", "papers", "train", "params", "compare",
                          "report", "sweep", "search", "regress", "completion", "help"));
  EXPECT_EQ(lines("help --man", ".nf").size(), 14u) << "the whole program and 13 commands";
  EXPECT_EQ(lines("help --man", ".fi").size(), 14u);
  EXPECT_THAT(page, HasSubstr("\\-\\-markdown"));
  EXPECT_THAT(page, Not(HasSubstr("--markdown")));
}

// ---- completion ---------------------------------------------------------------------------------

// tool/tests/system/terminal_test.py runs the scripts in their shells.
TEST_F(CommandLine, CompletionKnowsCommandsOptionsAndValues) {
  std::map<std::string, std::string> words;
  const std::string script = printed("completion"),
                    filters = "near linear wide another-one-with-a-very-long-name";
  const std::regex entry("'(deburr[^']*)'\\) found='([^']*)'");
  for (std::sregex_iterator it(script.begin(), script.end(), entry), end; it != end; ++it)
    words[(*it)[1]] = (*it)[2];
  for (const auto& [place, expected] : std::map<std::string, std::string>{
           {"help@1", "made other "},
           {"params", "--help --markdown --c-header --systemrdl --uvm --cost --set --json "},
           {"params@0", "run frame made other "},
           {"regress@0", "plan run rerun status collect"},
           {"run", "made other --help "},
           {"run made:--fault", "made_late made_lost"},
           {"run made:--filter", filters + " bilinear"},
           {"run made:--size", ""},
           {"run made:made.filter", filters + " bilinear"},
           {"run other:run.fault", "other_late other_lost"},
           {"search",
            "--help --runs --population --seed --slurm --out --jobs --retry --quiet --json "},
           {"sweep:-j", ""}})
    EXPECT_EQ(words.contains("deburr " + place) ? words["deburr " + place] : "none", expected)
        << place;
  EXPECT_FALSE(words.contains("deburr run made:--maps")) << "a switch has no value";
  EXPECT_THAT(script, HasSubstr("'deburr run' | 'deburr run made' | 'deburr run other' | "));
}

TEST_F(CommandLine, CompletionKnowsTheSameWordsInEveryShell) {
  const auto places = [&](const std::string& shell, const char* pattern) {
    const std::string script = printed("completion " + shell);
    std::set<std::string> found;
    const std::regex entry(pattern);
    for (std::sregex_iterator it(script.begin(), script.end(), entry), end; it != end; ++it)
      found.insert((*it)[1]);
    return found;
  };
  const auto bash = places("bash", "\n    '(deburr[^']*)'\\) found=");
  EXPECT_GT(bash.size(), 100u);
  EXPECT_EQ(places("zsh", "\n    '(deburr[^']*)'\\) found="), bash);
  EXPECT_EQ(places("fish", "\n    case '(deburr[^']*)'"), bash);
}

// ---- params -------------------------------------------------------------------------------------

TEST_F(CommandLine, ParamsOfUnitPrintsTableAndLimits) {
  EXPECT_EQ(
      printed("params made"),
      R"(made.filter  rule   linear  near | linear | wide | another-one-with-a-very-long-name         How it looks.
made.round   rule   false   true | false                                     To the nearest.
made.lanes   build  4       1..16                                     pixel  So many at a time.
made.depth   build  8       1..64                                            Of its queue.

Build limits of the hardware, in addition to these ranges:
made.depth   must be at least lanes
)");
  EXPECT_EQ(lines("params", "run.clock_mhz ").size(), 1u) << "what engines share is listed once";
  EXPECT_THAT(printed("params frame"), Not(HasSubstr("must be")));
}

TEST_F(CommandLine, ParamsWithJsonListsEveryEngine) {
  const Json made = json("params made --json");
  EXPECT_EQ(made["parameters"][0], Json::parse(R"({"engine": "made", "name": "made.filter",
      "kind": "rule", "default": "linear", "range": "near | linear | wide | another-one-with-a-very-long-name",
      "unit": "", "meaning": "How it looks.", "aliases": ["bilinear"]})"));
  EXPECT_FALSE(made["parameters"][2].contains("aliases"));
  EXPECT_EQ(made["limits"], Json::parse(R"([{"parameters": ["made.depth", "made.lanes"],
      "must": "must be at least lanes"}])"));
  const Json frame = json("params frame --json");
  EXPECT_EQ(frame["outcome"], "PASS params: 4 parameters");
  EXPECT_EQ(frame["parameters"].size(), 8u) << "of two engines";
  EXPECT_TRUE(frame["options"].empty());
  EXPECT_TRUE(frame["limits"].empty());
}

TEST_F(CommandLine, ParamsWithJsonListsOptions) {
  std::map<std::string, Json> options;
  const Json all = json("params --json");
  for (const Json& option : all["options"]) options.emplace(option["option"], option);
  EXPECT_EQ(options["--no-images"]["given"], "false");
  EXPECT_EQ(options["--round"]["given"], "true");
  EXPECT_EQ(options["--size"], Json::parse(R"({"engine": "made", "option": "--size",
      "parameters": ["frame.width", "frame.height"], "given": null, "meaning": "Of the frame"})"));
}

TEST_F(CommandLine, ParamsPrintsReferencePages) {
  for (const auto& [option, line] : {std::pair("--markdown", "# Parameters"),
                                     {"--markdown parameters", "# Parameters"},
                                     {"--markdown statistics", "# Statistics"},
                                     {"--markdown registers", "# Registers"},
                                     {"--markdown datasheets", "# Datasheets"},
                                     {"--c-header", "#ifndef DEBURR_REGISTERS_H"},
                                     {"--uvm", "package deburr_registers_pkg;"},
                                     {"--systemrdl",
                                      "// Registers of Deburr's engines as SystemRDL 2.0, one "
                                      "address map each. Bits without a field, and"}})
    EXPECT_THAT("\n" + printed(std::string("params ") + option),
                HasSubstr(std::string("\n") + line + "\n"))
        << option;
}

TEST_F(CommandLine, ParamsPrintsCostOfBuild) {
  const Json cost = json("params made --cost --json")["cost"];
  EXPECT_EQ(cost["flip_flops"], 32u);
  EXPECT_EQ(cost["units"]["adder"]["basis"], "estimate");
  EXPECT_EQ(cost["limited_by"], "adder stage 1");
  EXPECT_FALSE(cost.contains("frames_per_s")) << "nothing ran";
  const Json wide = json("params made --cost --json --set made.lanes=8")["cost"];
  EXPECT_EQ(wide["flip_flops"], 64u);
  EXPECT_GT(wide["gates"]["value"], cost["gates"]["value"]);
  EXPECT_GT(wide["ns"]["value"], cost["ns"]["value"]);

  const auto ranged = [](const Json& figure) {
    return tb::with_range(figure["low"], figure["value"], figure["high"]);
  };
  const std::string text = std::regex_replace(printed("params made --cost"), std::regex(" +"), " ");
  EXPECT_THAT(text, HasSubstr("unit basis gates flip-flops memory bits ns stage\n"));
  EXPECT_THAT(text,
              HasSubstr(fmt::format("adder estimate {} 32 0 {} 1\n",
                                    ranged(cost["units"]["adder"]["gates"]), ranged(cost["ns"]))));
  EXPECT_THAT(text, HasSubstr(fmt::format("total {} 32 0 {} adder stage 1\n", ranged(cost["gates"]),
                                          ranged(cost["ns"]))));
  EXPECT_THAT(text, HasSubstr(fmt::format("clock: {} MHz, ", ranged(cost["clock_mhz"]))));
}

}  // namespace
}  // namespace deburr::tool::line_test
