// SPDX-License-Identifier: MIT
// Corrupted user text: configuration files, definitions of sweeps, injected faults. It is accepted,
// or rejected with a named error; an accepted text runs to a named end. In the worst case an
// injected fault fails the run, never the program.
//
// libFuzzer cannot be used: the whole command runs after the parser, and SystemC elaborates once
// per process. Inputs are therefore generated from seeds with the typical shape of such texts.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "spec/error.h"
#include "tb/base/random.h"
#include "tb/harness/register_noise.h"
#include "tb/harness/test_paths.h"
#include "tool/run/random_configuration.h"
#include "tool/run/run_once.h"
#include "tool/sweep/definition.h"

namespace deburr::tool::text_noise_test {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kEngines = [] {
  std::vector<std::string> names;
  for (const auto& engine : engines()) names.emplace_back(engine->name());
  return names;
}();
const std::vector<std::string> kOddities = {"0",      "-1",    "99999999999999999999",
                                            "1e999",  "nan",   "",
                                            "true",   "~",     "[1, 2]",
                                            "{a: b}", "&a *a", "<<:",
                                            "\"",     "'",     "|",
                                            "!!x",    "\t",    "a.b.",
                                            "? x",    "- - -", "%",
                                            "0x10",   "1.5.2", "..",
                                            "golden", "#",     ":",
                                            "*",      "\xff",  "\xc3\x28"};

std::string odd(tb::Random& random) {
  return kOddities[random.below(static_cast<std::uint32_t>(kOddities.size()))];
}

// Duplicated, lost and exchanged lines, odd values, random bytes.
std::string spoilt(std::string text, tb::Random& random) {
  std::vector<std::string> lines;
  std::istringstream input(text);
  for (std::string line; std::getline(input, line);) lines.push_back(line);
  for (int change = random.between(1, 4); change > 0 && !lines.empty(); --change) {
    std::string& line = lines[random.below(static_cast<std::uint32_t>(lines.size()))];
    const std::size_t colon = line.find(':');
    switch (random.below(7)) {
      case 0:
        line = line.substr(0, colon) + ": " + odd(random);
        break;
      case 1:
        line = odd(random) + line;
        break;
      case 2:
        lines.push_back(line);
        break;
      case 3:
        line.clear();
        break;
      case 4:
        line = "  " + line;
        break;
      case 5:
        std::swap(line, lines[random.below(static_cast<std::uint32_t>(lines.size()))]);
        break;
      default:
        if (!line.empty())
          line[random.below(static_cast<std::uint32_t>(line.size()))] =
              static_cast<char>(random.below(256));
    }
  }
  text.clear();
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

class TextNoise : public testing::Test {
 protected:
  ~TextNoise() override {
    std::error_code ignored;
    fs::remove_all(directory_, ignored);
  }
  fs::path written(const std::string& text) const {
    fs::create_directories(directory_);
    const fs::path file = directory_ / "noise.yaml";
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }
  fs::path directory() const { return directory_; }

 private:
  fs::path directory_ =
      fs::temp_directory_path() / ("deburr-text-noise-" + std::to_string(::getpid()));
};

// Many per child process, since none elaborates.
constexpr std::uint64_t kTextsAChild = 40;

TEST_F(TextNoise, ConfigurationsAreAcceptedOrRejectedByName) {
  EXPECT_EQ(
      tb::first_complaint(12,
                          [&](std::uint64_t seed) -> std::string {
                            tb::Random random(seed, "configurations");
                            const std::string engine = kEngines[seed % kEngines.size()];
                            std::string whole;
                            for (const auto& [name, value] : random_configuration(engine, seed))
                              whole += name + ": " + value + "\n";
                            for (std::uint64_t i = 0; i < kTextsAChild; ++i) {
                              const std::string text = spoilt(whole, random);
                              const std::unique_ptr<Engine> made = engine_named(engine);
                              BoundEngine bound(*made);
                              try {
                                bound.set.load(written(text));
                                bound.resolve();
                              } catch (const spec::Error&) {
                              } catch (const std::exception& error) {
                                return std::string(error.what()) + " of\n" + text;
                              }
                            }
                            return "";
                          }),
      "");
}

TEST_F(TextNoise, SweepsAreAcceptedOrRejectedByName) {
  std::vector<std::string> sweeps;
  for (const fs::directory_entry& entry : fs::directory_iterator(tb::source_folder() / "sweeps")) {
    std::ostringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    sweeps.push_back(text.str());
  }
  ASSERT_FALSE(sweeps.empty());
  std::sort(sweeps.begin(), sweeps.end());
  EXPECT_EQ(tb::first_complaint(
                12,
                [&](std::uint64_t seed) -> std::string {
                  tb::Random random(seed, "sweeps");
                  for (std::uint64_t i = 0; i < kTextsAChild; ++i) {
                    const std::string text = spoilt(
                        sweeps[random.below(static_cast<std::uint32_t>(sweeps.size()))], random);
                    try {
                      read_sweep(written(text));
                    } catch (const spec::Error&) {
                    } catch (const std::exception& error) {
                      return std::string(error.what()) + " of\n" + text;
                    }
                  }
                  return "";
                }),
            "");
}

// ---- injected faults --------------------------------------------------------------------------

// Runs with this fault; returns the message if the run did not end with a named error.
std::string run_with(const std::string& engine, const std::string& fault, const fs::path& directory,
                     std::string* said = nullptr) {
  const std::unique_ptr<Engine> made = engine_named(engine);
  BoundEngine bound(*made);
  const auto is_width = [](const tb::Parameter& p) { return p.name.ends_with(".width"); };
  const auto& all = bound.set.all();
  const std::string width = std::find_if(all.begin(), all.end(), is_width)->name;
  const std::string size = width.substr(0, width.find('.') + 1);
  for (const auto& [name, value] :
       std::vector<std::pair<std::string, std::string>>{{size + "width", "19"},
                                                        {size + "height", "17"},
                                                        {"run.images", "false"},
                                                        {"run.max_cycles", "60000"},
                                                        {"run.watchdog_cycles", "3000"},
                                                        {"run.fault", fault}})
    bound.set.set(name, value, "--set");
  if (bound.set.find("frame.reference_samples"))
    bound.set.set("frame.reference_samples", "0", "--set");
  try {
    bound.resolve();
    RunContext context(directory, bound.set, "", 1);
    context.set_quiet(true);
    context.set_report(false);
    const RunEnd end = run_once(bound, context, IfTaken::kWait);
    if (said) *said = end.result.reason;
  } catch (const spec::Error& error) {
    if (said) *said = error.what();
  } catch (const std::exception& error) {
    return std::string(error.what()) + " by the fault " + fault;
  }
  return "";
}

// From the list in the message about an unknown link.
std::vector<std::string> links_of(const std::string& engine, const fs::path& directory) {
  std::istringstream lines(tb::forked_text([&] {
    std::string said;
    run_with(engine, "drop:none:1", directory, &said);
    return said;
  }));
  std::vector<std::string> links;
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("  ")) links.push_back(line.substr(2));
  return links;
}

TEST_F(TextNoise, FaultsEndByName) {
  std::vector<std::vector<std::string>> links;
  for (const std::string& engine : kEngines) {
    links.push_back(links_of(engine, directory()));
    ASSERT_GT(links.back().size(), 10u) << engine;
  }
  EXPECT_EQ(
      tb::first_complaint(
          60,
          [&](std::uint64_t seed) -> std::string {
            tb::Random random(seed, "faults");
            const std::size_t engine = random.below(static_cast<std::uint32_t>(kEngines.size()));
            const auto& known = links[engine];
            const auto either = [&](const std::string& right) {
              return random.chance(100) ? odd(random) : right;
            };
            const std::vector<std::string> kinds = {"drop", "duplicate", "flip", "stuck_ready"};
            std::string fault = kinds[random.below(4)];
            const bool flip = fault == "flip";
            fault = either(fault) + ":" +
                    either(known[random.below(static_cast<std::uint32_t>(known.size()))]) + ":" +
                    either(std::to_string(random.below(300)));
            if (flip) fault += ":" + either(std::to_string(random.below(60)));
            return run_with(kEngines[engine], fault, directory());
          }),
      "");
}

}  // namespace
}  // namespace deburr::tool::text_noise_test
