// SPDX-License-Identifier: MIT
#include "tb/base/terminal.h"

#include <gtest/gtest.h>

namespace deburr::tb::terminal_test {
namespace {

TEST(Wrapped, BreaksAtBlanksAndIndentsContinuation) {
  EXPECT_EQ(wrapped("rate        one two three\n", 24, 12),
            "rate        one two\n            three\n");
  EXPECT_EQ(wrapped("rate        one two\n", 19, 12), "rate        one two\n") << "it fits";
  EXPECT_EQ(wrapped("a b\nc d", 1, 0), "a\nb\nc\nd");
  EXPECT_EQ(wrapped("", 10, 2), "");
  EXPECT_EQ(wrapped("\n\n", 10, 2), "\n\n");
}

TEST(Wrapped, KeepsLineWithoutTerminal) {
  const std::string line(500, 'x');
  EXPECT_EQ(wrapped(line + " " + line, 0, 12), line + " " + line);
}

TEST(Wrapped, KeepsWordsWhole) {
  EXPECT_EQ(wrapped("to /a/path/of/names now", 8, 2), "to\n  /a/path/of/names\n  now");
}

TEST(Wrapped, IndentsByAtMostHalf) {
  EXPECT_EQ(wrapped("name      one two", 10, 30), "name\n     one\n     two");
  EXPECT_EQ(wrapped(std::string(30, ' ') + "one two", 10, 30), "     one\n     two");
}

TEST(Wrapped, CountsCharactersAsColumns) {
  EXPECT_EQ(columns_of("ä→b"), 3U);
  EXPECT_EQ(wrapped("ää öö üü", 5, 0), "ää öö\nüü");
}

TEST(RowInLines, NamesShownColumns) {
  EXPECT_EQ(row_in_lines({"cycles", "1", "2", "", "worse"}, {"", "A", "B", "", ""}, 20),
            "cycles\n    A 1  B 2  worse\n");
  EXPECT_EQ(row_in_lines({"cycles", "1", "2", "", "worse"}, {"", "A", "B", "", ""}, 12),
            "cycles\n    A 1  B 2\n    worse\n");
  EXPECT_EQ(row_in_lines({"", "1"}, {}, 12), "    1\n");
  EXPECT_EQ(row_in_lines({"name"}, {}, 12), "name\n");
}

}  // namespace
}  // namespace deburr::tb::terminal_test
