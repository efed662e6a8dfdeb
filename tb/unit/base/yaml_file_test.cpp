// SPDX-License-Identifier: MIT
// YAML constructs that would make a traversal endless or too long are rejected.
#include "tb/base/yaml_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "spec/error.h"

namespace deburr::tb::yaml_file_test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

class YamlFileTest : public testing::Test {
 protected:
  ~YamlFileTest() override { std::filesystem::remove(path_); }

  YamlFile read(const std::string& text) {
    std::ofstream(path_) << text;
    return YamlFile(path_);
  }
  std::string rejection(const std::string& text) {
    try {
      read(text);
    } catch (const spec::ConfigError& error) {
      return error.what();
    }
    return "accepted";
  }

 private:
  std::filesystem::path path_ = std::filesystem::temp_directory_path() /
                                ("deburr_yaml_file_" + std::to_string(::getpid()) + ".yaml");
};

// Each list contains the previous one ten times, so it has 10^levels values.
std::string lists_of_lists(int levels) {
  std::string text = "a0: &a0 x\n";
  for (int level = 1; level <= levels; ++level) {
    const std::string alias = "*a" + std::to_string(level - 1);
    std::string list = alias;
    for (int i = 1; i < 10; ++i) list += ", " + alias;
    text += "a" + std::to_string(level) + ": &a" + std::to_string(level) + " [" + list + "]\n";
  }
  return text;
}

TEST_F(YamlFileTest, AcceptsHexadecimalNumbers) {
  const YamlFile file = read("[0x7fC0, 0xffffffff, 0x1ffffffff, 0x, 0x-1, 16, 1.5]");
  const auto number = [&](int i) { return file.number<double>(file.root()[i], "from"); };
  EXPECT_EQ(number(0), 0x7fc0);
  EXPECT_EQ(number(1), 4294967295.0);
  for (int i = 2; i < 5; ++i) EXPECT_THROW(number(i), spec::ConfigError) << i;
  EXPECT_EQ(number(5), 16);
  EXPECT_EQ(number(6), 1.5);
}

TEST_F(YamlFileTest, AcceptsUtf8AndNamesInvalidLine) {
  EXPECT_EQ(read("a: 1\nb: Gr\xc3\xbc\xc3\x9f\x65 \xf0\x9f\x98\x80\n").root()["a"].Scalar(), "1");
  EXPECT_EQ(read(std::string("\xff\xfe"
                             "a\0:\0 \0"
                             "1\0\n\0",
                             12))
                .root()["a"]
                .Scalar(),
            "1")
      << "UTF-16, as its mark says";
  for (const std::string bad : {"Gr\xfc\xdf\x65", "\xc0\x80", "\xe0\x80\x80", "\xed\xa0\x80",
                                "\xf5\x80\x80\x80", "\xf4\x90\x80\x80", "\x80", "\xc3"})
    EXPECT_THAT(rejection("a: 1\nb: \"" + bad + "\"\n"),
                EndsWith(":2: not valid UTF-8: save the file as UTF-8"))
        << bad;
}

TEST_F(YamlFileTest, AcceptsAliasesOfAliases) {
  const YamlFile file = read(lists_of_lists(5));
  EXPECT_EQ(file.root()["a5"][9][8][7][6][5].Scalar(), "x");
  EXPECT_EQ(read("a: &a {b: 1}\nc: *a\nd: [*a, *a]\n").root()["d"][1]["b"].Scalar(), "1");
}

TEST_F(YamlFileTest, RejectsAliasesThatExpandTooMuch) {
  EXPECT_THAT(rejection(lists_of_lists(8)),
              HasSubstr(".yaml:7:45: aliases expand to more than 1000000 values"));
  EXPECT_THAT(rejection(lists_of_lists(100)), HasSubstr("aliases expand to more than"));
  // Maps count as lists do, keys as values.
  std::string maps = "m0: &m0 {x: y}\n";
  for (int level = 1; level <= 30; ++level) {
    const std::string before = std::to_string(level - 1), name = std::to_string(level);
    maps += "m" + name + ": &m" + name + " {a: *m" + before + ", b: *m" + before + "}\n";
  }
  EXPECT_THAT(rejection(maps), HasSubstr("aliases expand to more than"));
}

TEST_F(YamlFileTest, RejectsListThatContainsItself) {
  EXPECT_THAT(rejection("a: 1\nb: &b [2, *b]\n"),
              EndsWith(".yaml:2:11: an alias refers to a node that contains it"));
  EXPECT_THAT(rejection("a: &a {b: {c: *a}}\n"),
              HasSubstr("an alias refers to a node that contains it"));
}

// Where the library gives up, the error also names a line, and nothing crashes.
TEST_F(YamlFileTest, RejectsTooDeepNesting) {
  EXPECT_THAT(rejection(std::string(100'000, '[')), HasSubstr(".yaml:1:"));
  std::string text;
  for (int level = 0; level < 5'000; ++level) text += std::string(level, ' ') + "a:\n";
  EXPECT_THAT(rejection(text), HasSubstr("not valid YAML"));
}

}  // namespace
}  // namespace deburr::tb::yaml_file_test
