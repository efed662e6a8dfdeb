// SPDX-License-Identifier: MIT
// Parameters by name: every way to set one, and every reason for a rejection.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "spec/error.h"
#include "spec/texture/check_build.h"
#include "tb/run/parameter_set.h"

namespace deburr::tb::parameters_test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

enum class Colour : std::uint8_t { kRed, kGreen };
constexpr std::array<std::string_view, 2> kColourNames = {"red", "green"};

struct Sample {
  std::int32_t ways = 2;
  std::int64_t cycles = 0;
  Colour colour = Colour::kGreen;
  bool shuffle = false;
  double stalls = 0;
  std::string source = "plane";
};

template <class Visitor>
void describe(Sample& p, Visitor& v) {
  v.integer("cache.ways", p.ways, 1, 16, "way", "Associativity.");
  v.integer("cycles", p.cycles, 0, std::int64_t{1} << 40, "clk", "Limit.");
  v.choice("colour", p.colour, kColourNames, "Colour.");
  v.boolean("shuffle", p.shuffle, "Order.");
  v.real("stalls", p.stalls, 0, 0.9, "probability", "Stalls.");
  v.text("source", p.source, "name", "Scene.");
  v.is_work("source", GivenWork::kSource);
  v.is_work("cycles", GivenWork::kSetting);
}

class Parameters : public testing::Test {
 protected:
  Parameters() { set_.add("unit", ParameterKind::kInput, values_); }
  ~Parameters() override {
    for (const auto& file : files_) std::filesystem::remove(file);
  }

  std::string file(const std::string& content) {
    const auto path = std::filesystem::temp_directory_path() /
                      ("deburr_parameters_" + std::to_string(::getpid()) + "_" +
                       std::to_string(files_.size()) + ".yaml");
    std::ofstream(path) << content;
    files_.push_back(path);
    return path.string();
  }
  // The text of the ConfigError that `action` must throw.
  template <class Action>
  static std::string complaint(Action action) {
    try {
      action();
    } catch (const spec::ConfigError& error) {
      return error.what();
    }
    ADD_FAILURE() << "no ConfigError";
    return "";
  }
  std::string rejected(const std::string& yaml) {
    const std::string path = file(yaml);
    const std::string text = complaint([&] { set_.load(path); });
    EXPECT_THAT(text, StartsWith(path + ":"));
    return text.substr(std::min(text.size(), path.size()));
  }

  Sample values_;
  ParameterSet set_;
  std::vector<std::filesystem::path> files_;
};

TEST_F(Parameters, EveryKindIsSetByDottedName) {
  set_.set("unit.cache.ways", "4", "test");
  set_.set("unit.cycles", "10000000000", "test");
  set_.set("unit.colour", "red", "test");
  set_.set("unit.shuffle", "true", "test");
  set_.set("unit.stalls", "0.25", "test");
  set_.set_assignment("unit.source=a=b", "test");
  EXPECT_EQ(values_.ways, 4);
  EXPECT_EQ(values_.cycles, 10000000000);
  EXPECT_EQ(values_.colour, Colour::kRed);
  EXPECT_TRUE(values_.shuffle);
  EXPECT_EQ(values_.stalls, 0.25);
  EXPECT_EQ(values_.source, "a=b");
}

TEST_F(Parameters, ErrorNamesOriginValueAndRange) {
  struct Case {
    const char *name, *value, *expected;
  };
  for (const Case& c : {Case{"unit.cache.ways", "17", "is outside 1..16"},
                        Case{"unit.cache.ways", "0", "is outside 1..16"},
                        Case{"unit.cache.ways", "4.5", "must be an integer"},
                        Case{"unit.cache.ways", "", "must be an integer"},
                        Case{"unit.cache.ways", "99999999999999999999", "must be an integer"},
                        Case{"unit.colour", "gren", "did you mean 'green'?"},
                        Case{"unit.shuffle", "maybe", "must be true or false"},
                        Case{"unit.stalls", "1", "is outside 0..0.9"},
                        Case{"unit.stalls", "nan", "must be a number"}}) {
    const std::string text = complaint([&] { set_.set(c.name, c.value, "--set"); });
    EXPECT_THAT(text, StartsWith("--set: "));
    EXPECT_THAT(text, HasSubstr(c.name));
    EXPECT_THAT(text, HasSubstr(c.expected));
  }
  EXPECT_EQ(values_.ways, 2) << "a rejected value must not be kept";
}

TEST_F(Parameters, IntegersMayBeHexadecimal) {
  set_.set("unit.cycles", "0x7fFFffc0", "test");
  EXPECT_EQ(values_.cycles, 0x7fffffc0);
  set_.set("unit.cache.ways", "0x10", "test");
  EXPECT_EQ(values_.ways, 16);
  set_.load(file("unit.cycles: 0xff\n"));
  EXPECT_EQ(values_.cycles, 255);
  for (const char* value :
       {"0x", "0x-1", "-0x1", "0X10", "0x1g", "1f", "0x 1", "0xffffffffffffffffff"})
    EXPECT_THAT(complaint([&] { set_.set("unit.cycles", value, "--set"); }),
                HasSubstr("must be an integer"))
        << value;
  EXPECT_THAT(complaint([&] { set_.set("unit.cache.ways", "0x11", "--set"); }),
              HasSubstr("is outside 1..16"));
}

TEST_F(Parameters, AcceptsSynonymsOfValues) {
  EXPECT_THAT(complaint([&] { set_.set("unit.colour", "scarlet", "test"); }),
              HasSubstr("must be one of"));
  set_.alias("unit.colour", "scarlet", "red");
  set_.set("unit.colour", "scarlet", "test");
  EXPECT_EQ(values_.colour, Colour::kRed);
  EXPECT_EQ(set_.find("unit.colour")->text(), "red") << "results have one word for it";
  set_.set("unit.colour", "green", "test");
  EXPECT_EQ(values_.colour, Colour::kGreen);
  EXPECT_THAT(complaint([&] { set_.set("unit.colour", "carlet", "test"); }),
              testing::AllOf(HasSubstr("must be one of"), EndsWith("; scarlet is red")));
}

TEST_F(Parameters, UnknownNamesShowNearMatches) {
  EXPECT_THAT(complaint([&] { set_.set("unit.cache.wasy", "1", "--set"); }),
              HasSubstr("did you mean 'unit.cache.ways'?"));
  EXPECT_THAT(complaint([&] { set_.set("shuffle", "true", "--set"); }),
              HasSubstr("did you mean 'unit.shuffle'?"));
  EXPECT_THAT(complaint([&] { set_.set("completely.different.thing", "1", "--set"); }),
              testing::Not(HasSubstr("did you mean")));
  EXPECT_THAT(complaint([&] { set_.set_assignment("unit.shuffle", "--set"); }),
              HasSubstr("name=value"));
}

TEST_F(Parameters, YamlAcceptsNestedMapsAndDottedNames) {
  set_.load(file("# a comment\nunit:\n  cache: {ways: 8}\n  colour: red\nunit.stalls: 0.5\n"));
  EXPECT_EQ(values_.ways, 8);
  EXPECT_EQ(values_.colour, Colour::kRed);
  EXPECT_EQ(values_.stalls, 0.5);
  set_.load(file(""));
  set_.load(file("# nothing but a comment\n"));
}

TEST_F(Parameters, YamlErrorsNameFileAndLine) {
  EXPECT_THAT(rejected("unit:\n  colour: red\n  cache:\n    wais: 1\n"),
              testing::AllOf(StartsWith(":4"), HasSubstr("unit.cache.ways")));
  EXPECT_THAT(rejected("unit.shuffle: true\nunit:\n  shuffle: false\n"),
              testing::AllOf(StartsWith(":3"), HasSubstr("given twice"), HasSubstr(":1")));
  EXPECT_THAT(rejected("unit:\n  stalls: 0.1\n  stalls: 0.2\n"), HasSubstr("given twice"));
  EXPECT_THAT(rejected("unit:\n  cache.ways: 99\n"),
              testing::AllOf(StartsWith(":2"), HasSubstr("outside")));
  EXPECT_THAT(rejected("unit:\n  cache.ways: [1, 2]\n"), HasSubstr("a list"));
  EXPECT_THAT(rejected("unit:\n  cache.ways:\n"), HasSubstr("nothing"));
  EXPECT_THAT(rejected("- a\n- b\n"), HasSubstr("expected a map"));
  EXPECT_THAT(rejected("[\n"), HasSubstr("not valid YAML"));
  EXPECT_THAT(rejected("unit: {shuffle: true\n"), HasSubstr("not valid YAML"));
  EXPECT_THAT(rejected("[1, 2]: 3\n"), HasSubstr("a key must be a name"));
}

// yaml-cpp returns one empty document after another before the comma.
TEST_F(Parameters, ParserStopsAtLeadingComma) {
  EXPECT_THROW(set_.load(file(",a: b\n")), spec::ConfigError);
  EXPECT_THROW(set_.load(file("unit.stalls: 0.5\n---\nunit.stalls: 0.25\n")), spec::ConfigError);
  EXPECT_NO_THROW(set_.load(file("---\nunit.stalls: 0.5\n...\n")));
}

TEST_F(Parameters, MissingConfigurationIsFileError) {
  EXPECT_THROW(set_.load("/nonexistent/run.yaml"), spec::FileError);
  EXPECT_THROW(set_.load("/"), spec::FileError);
}

TEST_F(Parameters, ResolvedConfigurationLoadsAgain) {
  set_.set("unit.source", "a \"quoted\" # name: x", "test");
  set_.set("unit.cache.ways", "16", "test");
  const std::string yaml = set_.yaml();
  Sample other;
  ParameterSet again;
  again.add("unit", ParameterKind::kInput, other);
  again.load(file(yaml));
  EXPECT_EQ(other.source, values_.source);
  EXPECT_EQ(other.ways, 16);
  EXPECT_EQ(again.resolved(), set_.resolved());
}

TEST_F(Parameters, PresetFillsInUnsetParameters) {
  set_.set("unit.cache.ways", "8", "--set");
  set_.imply("unit.cache.ways", "4", "preset small");
  set_.imply("unit.colour", "red", "preset small");
  EXPECT_EQ(values_.ways, 8);
  EXPECT_EQ(values_.colour, Colour::kRed);
  ASSERT_EQ(set_.changed().size(), 1u);
  EXPECT_EQ(set_.changed()[0]->name, "unit.cache.ways");
  // Another preset given with the file replaces values of the first preset, but no explicit value.
  EXPECT_THAT(set_.yaml(), StartsWith("unit.cache.ways: 8  # Assoc"));
  EXPECT_THAT(set_.yaml(), HasSubstr("\n# unit.colour: \"red\"  # By preset small. Colour."));
}

TEST_F(Parameters, IneffectiveParameterIsRejectedAtItsOrigin) {
  const auto complaint = [&] {
    try {
      set_.reject_all("unit.cache", "there is no cache");
    } catch (const spec::ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(complaint(), "") << "not given";
  set_.load(file("unit.cache.ways: 2\n"));
  EXPECT_EQ(complaint(), "") << "a file may hold a default";
  set_.load(file("\nunit.cache.ways: 4\n"));
  EXPECT_THAT(complaint(),
              HasSubstr(".yaml:2: 'unit.cache.ways' = '4' has no effect: there is no"));
  set_.imply("unit.cache.ways", "4", "preset small");
  EXPECT_EQ(complaint(), "") << "a file may hold the preset's value";
  set_.set("unit.cache.ways", "2", "--ways");
  EXPECT_THAT(complaint(), StartsWith("--ways: "));
  set_.set("unit.cache.ways", "4", "--ways");
  EXPECT_THAT(complaint(), StartsWith("--ways: "))
      << "the command line rejects every ineffective value";
}

TEST_F(Parameters, EveryTextureDefaultIsWithinItsRange) {
  spec::texture::Parameters texture;
  ParameterSet set;
  set.add_engine("texture", texture);
  EXPECT_FALSE(set.all().empty());
  for (const Parameter& p : set.all()) {
    EXPECT_EQ(p.parse(p.default_value), "") << p.name;
    EXPECT_FALSE(p.meaning.empty()) << p.name;
    EXPECT_EQ(p.meaning.back(), '.') << p.name;
  }
}

TEST_F(Parameters, SwitchHasThreeWordsPerPosition) {
  for (const char* word : {"true", "on", "yes"}) {
    values_.shuffle = false;
    set_.set("unit.shuffle", word, "test");
    EXPECT_TRUE(values_.shuffle) << word;
  }
  for (const char* word : {"false", "off", "no"}) {
    values_.shuffle = true;
    set_.set("unit.shuffle", word, "test");
    EXPECT_FALSE(values_.shuffle) << word;
  }
  for (const char* word : {"True", "1", "0", "", "yes "})
    EXPECT_THAT(complaint([&] { set_.set("unit.shuffle", word, "test"); }),
                HasSubstr("must be true or false"));
}

// The whole resolved configuration of a run, as text and typed.
TEST_F(Parameters, ExportAsTextAndJson) {
  set_.imply("unit.colour", "red", "preset small");
  set_.set("unit.stalls", "0.25", "test");
  set_.set("unit.source", "a\"b", "test");
  EXPECT_EQ(set_.yaml(),
            "unit.cache.ways: 2  # Associativity.\nunit.cycles: 0  # Limit.\n"
            "# unit.colour: \"red\"  # By preset small. Colour.\nunit.shuffle: false  # Order.\n"
            "unit.stalls: 0.25  # Stalls.\nunit.source: \"a\\\"b\"  # Scene.\n");
  EXPECT_EQ(
      set_.resolved().dump(),
      R"({"unit.cache.ways":2,"unit.cycles":0,"unit.colour":"red","unit.shuffle":false,"unit.stalls":0.25,"unit.source":"a\"b"})");
  const Parameter& ways = *set_.find("unit.cache.ways");
  EXPECT_EQ(ways.range + "|" + ways.unit + "|" + ways.meaning + "|" + ways.default_value,
            "1..16|way|Associativity.|2");
  EXPECT_EQ(set_.find("unit.colour")->range, "red | green");
  EXPECT_EQ(set_.find("unit.shuffle")->range, "true | false");
  EXPECT_EQ(set_.find("unit.stalls")->range, "0..0.9");
  EXPECT_EQ(set_.find("unit.cycles")->range, "0..1099511627776");
  EXPECT_EQ(set_.origin(*set_.find("unit.cycles")), "default");
  EXPECT_EQ(set_.origin(*set_.find("unit.colour")), "preset small");
  EXPECT_EQ(set_.origin(*set_.find("unit.stalls")), "given");
}

// The bounds of a range are included.
TEST_F(Parameters, RangesIncludeTheirBounds) {
  for (const auto& [name, low, below, high, above] :
       {std::tuple("unit.cache.ways", "1", "0", "16", "17"),
        std::tuple("unit.cycles", "0", "-1", "1099511627776", "1099511627777"),
        std::tuple("unit.stalls", "0", "-0.0001", "0.9", "0.9001")}) {
    EXPECT_NO_THROW(set_.set(name, low, "test"));
    EXPECT_NO_THROW(set_.set(name, high, "test"));
    for (const char* wrong : {below, above})
      EXPECT_THAT(complaint([this, at = name, wrong] { set_.set(at, wrong, "test"); }),
                  HasSubstr("is outside"));
  }
}

TEST_F(Parameters, MapsMayBeNestedSixteenDeep) {
  const auto nested = [](int depth) {
    std::string yaml;
    for (int i = 0; i < depth; ++i) yaml += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
    return yaml + std::string(static_cast<std::size_t>(depth), ' ') + "b: 1\n";
  };
  EXPECT_THAT(rejected(nested(16)), HasSubstr("unknown parameter"));
  EXPECT_THAT(rejected(nested(17)), HasSubstr("nested too deeply"));
}

// Explicit values of the run are set again; derived values are derived again, except a default that
// has changed since.
TEST_F(Parameters, ManifestRestoresParametersOfItsRun) {
  const std::string manifest =
      R"({"schema": 4, "unit": "unit", "working_directory": "/elsewhere",
          "configuration": {"unit.cache.ways": 8, "unit.cycles": 7, "unit.colour": "red", "unit.shuffle": false, "unit.stalls": 0.5,
                            "unit.source": "in/x.png"},
          "inputs": [{"file": "in/x.png"}, {"file": "c.yaml", "role": "configuration"}],
          "parameters": [{"name": "unit.cache.ways", "from": "given"}, {"name": "unit.cycles", "from": "default"},
                         {"name": "unit.colour", "from": "preset small"}, {"name": "unit.shuffle", "from": "default"},
                         {"name": "unit.source", "from": "given"}]})";
  set_.load("manifest.json", manifest, "unit");
  EXPECT_EQ(values_.ways, 8);
  EXPECT_EQ(values_.cycles, 7) << "the default has changed";
  EXPECT_EQ(values_.colour, Colour::kGreen) << "derived again from the preset";
  EXPECT_EQ(values_.stalls, 0.5) << "the manifest does not list it";
  EXPECT_EQ(values_.source, "/elsewhere/in/x.png");
  EXPECT_TRUE(set_.given("unit.cache.ways"));
  EXPECT_TRUE(set_.given("unit.cycles"));
  EXPECT_FALSE(set_.given("unit.colour"));
  EXPECT_FALSE(set_.given("unit.shuffle")) << "as it is by default";
  EXPECT_THAT(complaint([&] { set_.load("manifest.json", manifest, "frame"); }),
              HasSubstr("this manifest belongs to a run of 'unit', not of 'frame'"));
}

struct Misnamed : Sample {};
template <class Visitor>
void describe(Misnamed& p, Visitor& v) {
  describe(static_cast<Sample&>(p), v);
  v.is_work("sauce", GivenWork::kSource);
}

TEST_F(Parameters, StateWhichOnesDefineTheWork) {
  EXPECT_EQ(set_.find("unit.source")->work, GivenWork::kSource);
  EXPECT_EQ(set_.find("unit.cycles")->work, GivenWork::kSetting);
  EXPECT_EQ(set_.find("unit.shuffle")->work, GivenWork::kNone);
  Misnamed wrong;
  ParameterSet set;
  EXPECT_THROW(set.add("unit", ParameterKind::kInput, wrong), spec::CheckFailed);
}

// Tells a sweep which points share a golden result.
TEST_F(Parameters, EngineParametersAreConfigurationOrBuild) {
  spec::texture::Parameters texture;
  ParameterSet set;
  set.add_engine("texture", texture);
  set.add("unit", ParameterKind::kRun, values_);
  EXPECT_EQ(set.find("texture.footprint")->kind, ParameterKind::kRule);
  EXPECT_EQ(set.find("texture.cache.bytes")->kind, ParameterKind::kBuild);
  EXPECT_EQ(set.find("unit.cache.ways")->kind, ParameterKind::kRun);
  EXPECT_TRUE(set.resolved(ParameterKind::kRule).contains("texture.footprint"));
  EXPECT_FALSE(set.resolved(ParameterKind::kRule).contains("texture.cache.bytes"));
  EXPECT_EQ(set.resolved(ParameterKind::kBuild)["texture.cache.bytes"], 16384);
  EXPECT_EQ(set.resolved(ParameterKind::kRule).size() + set.resolved(ParameterKind::kBuild).size() +
                set.resolved(ParameterKind::kRun).size(),
            set.all().size());
}

}  // namespace
}  // namespace deburr::tb::parameters_test
