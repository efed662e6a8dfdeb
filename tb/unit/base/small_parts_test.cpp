// SPDX-License-Identifier: MIT
// Headlines, shell quoting, settings by name, random numbers, reading and writing files, YAML
// nodes: tables of inputs and outputs.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "spec/error.h"
#include "tb/base/apply_settings.h"
#include "tb/base/atomic_file.h"
#include "tb/base/file.h"
#include "tb/base/headline.h"
#include "tb/base/near_matches.h"
#include "tb/base/random.h"
#include "tb/base/ready_file.h"
#include "tb/base/shell.h"
#include "tb/base/yaml_file.h"

namespace deburr::tb::small_parts_test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

std::string error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "none";
}

TEST(Headline, UsesOneLineOfFirstParagraph) {
  for (const auto& [text, line] : std::vector<std::pair<std::string, std::string>>{
           {"", ""},
           {"one", "one"},
           {"one\n", "one"},
           {"one\ntwo", "one, two"},
           {"one:\n  two\n\tthree \r\n", "one: two, three"},
           {"one,\ntwo", "one, two"},
           {"one\n\ntwo", "one"},
           {"one\n \ntwo", "one, two"},
           {"\none", "one"},
           {"\n\none", ""},
           {" a b ", "a b"}})
    EXPECT_EQ(headline(text), line) << text;
}

TEST(Shell, QuotesEverythingButPlainWords) {
  for (const auto& [word, quoted] : std::vector<std::pair<std::string, std::string>>{
           {"", "''"},
           {"plain_-./=,:+@%09azAZ", "plain_-./=,:+@%09azAZ"},
           {"two words", "'two words'"},
           {"it's", "'it'\\''s'"},
           {"a*", "'a*'"},
           {"~", "'~'"},
           {"$x", "'$x'"},
           {"a\nb", "'a\nb'"},
           {"\xc3\xa4", "'\xc3\xa4'"}})
    EXPECT_EQ(shell_quoted(word), quoted);
}

enum class Way : std::uint8_t { kNear, kFar };
struct Settings {
  std::int32_t width = 3, height = 4;
  Way way = Way::kNear;
  bool round = false;
};
template <class Visitor>
void describe(Settings& p, Visitor& v) {
  v.integer("width", p.width, -2, 9, "", "");
  v.integer("height", p.height, 0, 9, "", "");
  v.choice("way", p.way, std::array<std::string_view, 2>{"near", "far"}, "");
  v.boolean("round", p.round, "");
}

TEST(ApplySettings, SetsByNameAndRejectsTheRest) {
  Settings all;
  apply_settings(all, "width=-2 way=far round=true");
  EXPECT_EQ(all.width, -2);
  EXPECT_EQ(all.height, 4);
  EXPECT_EQ(all.way, Way::kFar);
  EXPECT_TRUE(all.round);
  apply_settings(all, "round=false width=9");
  EXPECT_EQ(all.width, 9);
  EXPECT_FALSE(all.round);
  apply_settings(all, "");
  for (const char* const bad : {"width=10", "width=-3", "width=", "width=1x", "width", "wide=1",
                                "way=nearer", "round=yes", "height=1 width=x", "=", "height=-1"})
    EXPECT_THAT(error_of([&] { apply_settings(all, bad); }), HasSubstr("is not a known setting"))
        << bad;
}

TEST(NearMatches, ListBestThree) {
  const std::vector<std::string> names = {"texture.cache.ways", "texture.cache.bytes", "frame.ways",
                                          "scene.width", "scene.height"};
  for (const auto& [name, found] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {"ways", {"texture.cache.ways", "frame.ways"}},
           {"scene.widht", {"scene.width", "scene.height"}},
           {"scene.wi", {"scene.width"}},
           {"texture.ways", {"texture.cache.ways", "frame.ways"}},
           {"SCENE.HEIGHT", {"scene.height", "scene.width"}},
           {"", {}},
           {"unlike", {}},
           {std::string(101, 'a'), {}}})
    EXPECT_EQ(near_matches(name, names), found) << name;
  EXPECT_THAT(near_matches("aaaa", {"aaab", "aaaa", "aaac", "aaad"}),
              ElementsAre("aaaa", "aaab", "aaac"));
  EXPECT_THAT(near_matches("aaa", {"bba", "aab"}), ElementsAre("aab"));
  EXPECT_THAT(near_matches("abcdef", {"abcdxx", "abcxxx"}), ElementsAre("abcdxx"));
}

TEST(Random, DrawsFromRequestedRange) {
  Random numbers(7), named(7, "a");
  EXPECT_EQ(numbers.next(), 0x63CBE1E459320DD7u);
  EXPECT_EQ(named.next(), Random((7 ^ 'a') * 0x100000001B3u + Random::kStride).next());
  Random first(7), second(7);
  EXPECT_EQ(first.word(), second.next() >> 32);
  EXPECT_EQ(Random(1 + Random::kStride).next(), (second = Random(1), second.next(), second.next()));
  std::array<int, 5> seen{};
  int least = 9, most = 0;
  double low = 9, high = 0;
  for (int i = 0; i < 2000; ++i) {
    ++seen.at(first.below(5));
    const int between = first.between(3, 6);
    least = std::min(least, between);
    most = std::max(most, between);
    const double uniform = first.uniform(2, 4);
    low = std::min(low, uniform);
    high = std::max(high, uniform);
  }
  for (const int count : seen) EXPECT_NEAR(count, 400, 80);
  EXPECT_EQ(std::pair(least, most), std::pair(3, 6));
  EXPECT_NEAR(low, 2, 0.01);
  EXPECT_NEAR(high, 4, 0.01);
  EXPECT_LT(high, 4);
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE(first.chance(0));
    EXPECT_TRUE(first.chance(1000));
    EXPECT_EQ(first.below(1), 0u);
  }
}

class Files : public testing::Test {
 protected:
  Files() {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "sub");
  }
  ~Files() override { fs::remove_all(folder_); }
  fs::path put(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  std::size_t entries() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  fs::path folder_ = fs::path(testing::TempDir()) / "deburr_small_parts";
};

TEST_F(Files, ReadUpToSizeLimit) {
  const fs::path five = put("five", "12345");
  EXPECT_EQ(read_file(five, 5), "12345");
  EXPECT_EQ(error_of([&] { read_file(five, 4); }),
            "cannot read '" + five.string() + "': it is larger than 4 bytes");
  const std::string long_text(200'000, 'x');
  EXPECT_EQ(read_file(put("long", long_text), 200'000), long_text);
  EXPECT_THAT(error_of([&] { read_file(folder_ / "long", 199'999); }), HasSubstr("larger than"));
  EXPECT_THAT(error_of([&] { read_file(folder_ / "none", 4); }),
              HasSubstr("cannot open '" + (folder_ / "none").string() + "': No such file"));
  EXPECT_THAT(error_of([&] { read_file(folder_, 4); }), HasSubstr("it is not a regular file"));
  EXPECT_EQ(read_file(put("empty", ""), 0), "");
  const char* const kOfAbc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
  EXPECT_EQ(sha256("abc"), kOfAbc);
  EXPECT_EQ(sha256_of_file(put("abc", "abc")), kOfAbc);
  EXPECT_EQ(sha256_of_file(folder_ / "long"), sha256(long_text));
  EXPECT_EQ(ready_file(five), five);
  EXPECT_EQ(ready_file("no/such/file"), fs::path("no/such/file"));
}

TEST_F(Files, WrittenCompletelyOrNotAtAll) {
  write_file_atomically(folder_ / "a", "one");
  EXPECT_EQ(read_file(folder_ / "a", 10), "one");
  write_files_atomically({{folder_ / "a", "two"}, {folder_ / "b", ""}});
  EXPECT_EQ(read_file(folder_ / "a", 10), "two");
  EXPECT_EQ(read_file(folder_ / "b", 10), "");
  EXPECT_EQ(
      error_of([&] {
        write_files_atomically({{folder_ / "a", "three"}, {folder_ / "none" / "b", "x"}});
      }),
      "cannot create a file in the folder of '" + (folder_ / "none" / "b").string() +
          "': No such file or directory; the partial file was removed: choose another folder");
  EXPECT_EQ(read_file(folder_ / "a", 10), "two") << "all of them or none";
  EXPECT_EQ(error_of([&] { write_file_atomically(folder_ / "sub", "x"); }),
            "cannot write '" + (folder_ / "sub").string() +
                "': it exists and is not a regular file; give another name");
  try_to_write(folder_ / "a", "four");
  try_to_write(folder_ / "c", "five");
  EXPECT_EQ(read_file(folder_ / "a", 10), "two");
  EXPECT_EQ(entries(), 3u) << "no temporary file is left";
  struct stat status {};
  const mode_t mask = ::umask(0);
  ::umask(mask);
  ASSERT_EQ(::stat((folder_ / "a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0666 & ~mask);
}

TEST_F(Files, YamlNodesReturnTypedValues) {
  const YamlFile yaml("f.yaml",
                      std::string("a: 1\nlist: [1, -2, 1e3, x]\nmap: {b: true, c: False}\n"
                                  "none:\nempty: []\nno: {}\ntwice: {b: 1, b: 2}\nzero: 0\n"));
  const YAML::Node& root = yaml.root();
  EXPECT_EQ(yaml.where(root["list"]), "f.yaml:2");
  for (const auto& [key, kind] :
       std::vector<std::pair<std::string, std::string>>{{"a", "a single value"},
                                                        {"list", "a list"},
                                                        {"map", "a map"},
                                                        {"none", "nothing"},
                                                        {"empty", "an empty list"},
                                                        {"no", "an empty map"}})
    EXPECT_EQ(YamlFile::kind(root[key]), kind);
  EXPECT_EQ(yaml.number<double>(root["list"][2], "x"), 1000);
  EXPECT_EQ(yaml.number<std::int64_t>(root["list"][1], "x"), -2);
  EXPECT_TRUE(yaml.boolean(root["map"]["b"], "b"));
  EXPECT_EQ(yaml.count(root["a"], "a", 1), 1u);
  const std::vector<std::string> keys = {"a",     "list", "map",   "none",
                                         "empty", "no",   "twice", "zero"};
  EXPECT_EQ(error_of([&] { yaml.require_keys(root, keys); }), "none");
  for (const auto& [work, said] : std::vector<std::pair<std::function<void()>, std::string>>{
           {[&] { yaml.count(root["a"], "a", 0); }, "f.yaml:1: 'a' = '1' is outside 1..0"},
           {[&] { yaml.count(root["zero"], "z", 9); }, "f.yaml:8: 'z' = '0' is outside 1..9"},
           {[&] { yaml.count(root["list"][1], "n", 9); }, "f.yaml:2: 'n' = '-2' is outside 1..9"},
           {[&] { yaml.number<std::int64_t>(root["list"][2], "n"); },
            "f.yaml:2: 'n' = '1e3' must be a number"},
           {[&] { yaml.number<double>(root["list"][3], "n"); },
            "f.yaml:2: 'n' = 'x' must be a number"},
           {[&] { yaml.boolean(root["map"]["c"], "c"); },
            "f.yaml:3: 'c' = 'False' must be true or false"},
           {[&] { yaml.scalar(root["map"], "m"); },
            "f.yaml:3: 'm' must be a single value, got a map"},
           {[&] { yaml.require_keys(root["list"], keys); }, "f.yaml:2: expected a map, got a list"},
           {[&] {
              yaml.require_keys(root["map"], {"b", "d"});
            },
            "f.yaml:3: unknown key 'c': did you mean 'b' or 'd'? (known: b, d)"},
           {[&] { yaml.require_keys(root["twice"], {"b"}); }, "f.yaml:7: 'b' is given twice"},
           {[&] { YamlFile("g.yaml", std::string("a: 1\n---\nb: 2\n")); },
            "g.yaml: expected one YAML document, got several, or text before the first, such as "
            "','"},
           {[&] { YamlFile("g.yaml", std::string("a: [1")); },
            "g.yaml:1:1: not valid YAML: end of sequence flow not found"},
           {[&] { YamlFile(put("long.yaml", "a: 123"), 5); },
            "cannot read '" + (folder_ / "long.yaml").string() + "': it is larger than 5 bytes"}})
    EXPECT_EQ(error_of(work), said);
}

}  // namespace
}  // namespace deburr::tb::small_parts_test
