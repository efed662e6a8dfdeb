// SPDX-License-Identifier: MIT
// Weights are read back as written, and everything else is rejected with its line.
#include "tb/stimuli/weight_file.h"

#include <gmock/gmock.h>

#include <cstddef>
#include <string>

#include "spec/error.h"
#include "spec/morphological/learned_weights.h"

namespace deburr::tb::stimuli::weight_file_test {
namespace {

using golden::morphological::WeightTables;
using ::testing::HasSubstr;

// Every entry differs from its neighbours.
WeightTables counted() {
  WeightTables tables;
  int next = 0;
  for (auto& entry : tables.of_codes) entry = static_cast<std::int8_t>(next++ % 256 - 128);
  for (auto& entry : tables.of_near) entry = static_cast<std::int8_t>(next++ % 251 - 125);
  for (auto& entry : tables.of_far) entry = static_cast<std::int8_t>(next++ % 241 - 120);
  return tables;
}

std::string complaint(const std::string& text) {
  try {
    parse_weight_file("some.weights", text);
  } catch (const spec::FileError& error) {
    return error.what();
  }
  return "taken";
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(WeightFile, ReadsBackAsWritten) {
  const WeightTables tables = counted();
  const std::string text = weight_file_text(tables, {"a note", "# another"});
  EXPECT_THAT(text, HasSubstr("deburr-weights 1\n# a note\n# # another\ncodes 1024\n-128 -127 "));
  const WeightTables read = parse_weight_file("some.weights", text);
  EXPECT_EQ(read.of_codes, tables.of_codes);
  EXPECT_EQ(read.of_near, tables.of_near);
  EXPECT_EQ(read.of_far, tables.of_far);
  EXPECT_EQ(weight_file_text(read, {"a note", "# another"}), text);
}

TEST(WeightFile, EntriesFollowOrderOfRegisters) {
  const WeightTables tables = counted();
  const std::vector<std::int8_t> entries = entries_of(tables);
  ASSERT_EQ(entries.size(), 2304u);
  EXPECT_EQ(entries[5], tables.of_codes[5]);
  EXPECT_EQ(entries[1024 + 7], tables.of_near[7]);
  EXPECT_EQ(entries[1664 + 9], tables.of_far[9]);
  EXPECT_EQ(sum_of(WeightTables()), spec::morphological::kWeightsSum);
}

TEST(WeightFile, AllowsBlankLinesAndCommentsAnywhere) {
  const std::string text = weight_file_text(counted(), {});
  EXPECT_EQ(complaint(replaced(text, "near 640\n", "near 640\r\n\n  # nothing\n# more\r\n")),
            "taken");
  EXPECT_EQ(complaint(text.substr(0, text.size() - 1)), "taken");
}

TEST(WeightFile, ErrorNamesCauseAndLine) {
  const std::string text = weight_file_text(counted(), {});
  EXPECT_THAT(complaint(""), HasSubstr("'some.weights', line 0: expected 'deburr-weights', got the "
                                       "end of the file"));
  EXPECT_THAT(complaint("P6\n"), HasSubstr("line 1: expected 'deburr-weights', got 'P6'"));
  EXPECT_THAT(complaint(replaced(text, "weights 1", "weights 2")),
              HasSubstr("line 1: expected '1', got '2'"));
  EXPECT_THAT(complaint(replaced(text, "codes 1024", "near 1024")),
              HasSubstr("line 2: expected 'codes', got 'near'"));
  EXPECT_THAT(complaint(replaced(text, "codes 1024", "codes 1023")),
              HasSubstr("line 2: expected '1024', got '1023'"));
  EXPECT_THAT(complaint(replaced(text, "-128 ", "-129 ")),
              HasSubstr("line 3: expected a number from -128 to 127, got '-129'"));
  for (const char* const word : {"12x ", "1.5 ", "0x1 ", "--1 ", "99999999999999999999 "})
    EXPECT_THAT(complaint(replaced(text, "-128 ", word)), HasSubstr("line 3: expected a number"));
  EXPECT_THAT(complaint(replaced(text, "-128 -127", "-128")), HasSubstr("got 'near'"));
  EXPECT_THAT(complaint(text.substr(0, 300)), HasSubstr("line"));
  EXPECT_THAT(complaint(replaced(text, "-128 -127", "-128 -126")),
              HasSubstr("the file was changed"));
  EXPECT_THAT(complaint(replaced(text, "sum ", "sum -")), HasSubstr("expected a number from 0"));
  EXPECT_THAT(complaint(text + "1\n"), HasSubstr("expected the end of the file"));
  EXPECT_THAT(complaint(std::string("\x01\xFF\0z ", 5) + text), HasSubstr("got '???z'"));
}

}  // namespace
}  // namespace deburr::tb::stimuli::weight_file_test
