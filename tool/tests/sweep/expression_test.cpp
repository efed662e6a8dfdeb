// SPDX-License-Identifier: MIT
// Conditions and objectives of sweeps: results of operators, precedence, rejected expressions.
#include "tool/sweep/expression.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace deburr::tool::expression_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::map<std::string, Expression::Value> kValues = {
    {"a", 7.0},   {"b.c", 2.0},   {"zero", 0.0},
    {"on", true}, {"off", false}, {"mode", std::string("fast")}};
const Expression::Lookup kLookup = [](const std::string& name) { return kValues.at(name); };

ExpressionNames names() {
  return {"constraint", "a parameter",
          [](const std::string& name) -> std::optional<std::string> {
            if (name == "mode") return "fast | slow | 2x";
            return kValues.contains(name) ? std::optional<std::string>("1..9") : std::nullopt;
          },
          [](const std::string&) { return std::vector<std::string>{"b.c"}; }};
}
Expression made(const std::string& text) { return Expression(text, "here", names()); }
double number(const std::string& text) { return made(text).number(kLookup); }
bool reference(const std::string& text) { return made(text).reference(kLookup); }
double violation(const std::string& text) { return made(text).violation(kLookup); }
std::string complaint(const std::string& text) {
  try {
    const Expression expression = made(text);
    expression.reference(kLookup);
  } catch (const spec::ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(Expression, EvaluatesArithmetic) {
  EXPECT_EQ(number("a + b.c * 3"), 13);
  EXPECT_EQ(number("(a + b.c) * 3"), 27);
  EXPECT_EQ(number("a - b.c - 1"), 4) << "from the left";
  EXPECT_EQ(number("a - (b.c - 1)"), 6);
  EXPECT_EQ(number("a / b.c / 2"), 1.75);
  EXPECT_EQ(number("a % 4 * b.c"), 6);
  EXPECT_EQ(number("-a + 1"), -6);
  EXPECT_EQ(number("2 - -a"), 9);
  EXPECT_EQ(number("- - a"), 7);
  EXPECT_EQ(number("-a % 4"), -3) << "the sign binds first";
  EXPECT_EQ(number("0x10 + 1e-1"), 16.1);
  EXPECT_EQ(number("1e2-1"), 99);
  EXPECT_EQ(number("0xe-1"), 13) << "no exponent";
  EXPECT_EQ(number("2.5"), 2.5);
}

TEST(Expression, EvaluatesComparisons) {
  for (const auto& [text, holds] : std::vector<std::pair<const char*, bool>>{
           {"a < 7", false},          {"a < 7.1", true},         {"a <= 7", true},
           {"a <= 6.9", false},       {"a > 7", false},          {"a > 6.9", true},
           {"a >= 7", true},          {"a >= 7.1", false},       {"a == 7", true},
           {"a == b.c", false},       {"a != 7", false},         {"a != b.c", true},
           {"mode == fast", true},    {"mode != fast", false},   {"mode == slow", false},
           {"slow != mode", true},    {"on == true", true},      {"on == off", false},
           {"a + 1 > b.c * 3", true}, {"a - 1 > b.c * 3", false}})
    EXPECT_EQ(reference(text), holds) << text;
}

TEST(Expression, EvaluatesLogicalOperators) {
  for (const auto& [text, holds] :
       std::vector<std::pair<const char*, bool>>{{"on", true},
                                                 {"not on", false},
                                                 {"not not on", true},
                                                 {"on and off", false},
                                                 {"off and on", false},
                                                 {"on and on", true},
                                                 {"off or on", true},
                                                 {"on or off", true},
                                                 {"off or off", false},
                                                 {"on or off and off", true},
                                                 {"(on or off) and off", false},
                                                 {"not off and off", false},
                                                 {"not (off and off)", true},
                                                 {"not a > 3", false},
                                                 {"a > 3 and b.c > 3 or on", true},
                                                 {"a > 3 and (b.c > 3 or off)", false},
                                                 {"off or a > 3 and b.c < 3", true}})
    EXPECT_EQ(reference(text), holds) << text;
}

// Distance from the required value, relative to the right side.
TEST(Expression, MeasuresViolationOfAComparison) {
  EXPECT_TRUE(made("a < 3").is_comparison());
  EXPECT_TRUE(made("(a < 3)").is_comparison());
  EXPECT_FALSE(made("a == 3").is_comparison());
  EXPECT_FALSE(made("a < 3 and b.c < 3").is_comparison());
  EXPECT_FALSE(made("a < 3 or b.c < 3").is_comparison());
  EXPECT_FALSE(made("not a < 3").is_comparison());
  EXPECT_FALSE(made("on").is_comparison());
  EXPECT_EQ(violation("a < 8"), 0);
  EXPECT_EQ(violation("a <= 7"), 0);
  EXPECT_DOUBLE_EQ(violation("a <= 4"), 0.75);
  EXPECT_DOUBLE_EQ(violation("a >= 28"), 0.75);
  EXPECT_DOUBLE_EQ(violation("a < -14"), 1.5);
  EXPECT_DOUBLE_EQ(violation("a > 14"), 0.5);
  EXPECT_GT(violation("a < 7"), 0) << "equal is not less";
  EXPECT_LT(violation("a < 7"), 1e-9);
  EXPECT_GT(violation("a <= 0"), 1e6);
  EXPECT_EQ(violation("a / zero < 1"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(violation("a < 1 / zero"), std::numeric_limits<double>::infinity());
  const Expression missing = made("a < 1");
  EXPECT_EQ(missing.violation([](const std::string&) {
    return Expression::Value(std::numeric_limits<double>::quiet_NaN());
  }),
            std::numeric_limits<double>::infinity());
}

TEST(Expression, ListsEachNameOnceInOrder) {
  const Expression e = made("b.c > 1 and a > b.c or a > 2 and on");
  EXPECT_THAT(e.names(), ElementsAre("b.c", "a", "on"));
  EXPECT_EQ(e.text(), "b.c > 1 and a > b.c or a > 2 and on");
  EXPECT_EQ(e.where(), "here");
  EXPECT_THAT(made("1 < 2").names(), testing::IsEmpty());
}

TEST(Expression, RejectsInvalidExpressions) {
  EXPECT_THAT(complaint("a <"), HasSubstr("here: constraint 'a <': unexpected end"));
  EXPECT_THAT(complaint("(a < 3"), HasSubstr("a ')' is missing"));
  EXPECT_THAT(complaint("a < 3)"), HasSubstr("unexpected ')'"));
  EXPECT_THAT(complaint("a < 3 4"), HasSubstr("unexpected '4'"));
  EXPECT_THAT(complaint("a & 3"), HasSubstr("unexpected '&'"));
  EXPECT_THAT(complaint("d < 3"),
              HasSubstr("'d' is neither a parameter nor a number: did you mean 'b.c'?"));
  EXPECT_THAT(complaint("mode == fst"), HasSubstr("'fst' is not a value of mode"));
  EXPECT_THAT(complaint("on < 3"), HasSubstr("expected a number, got true or false"));
  EXPECT_THAT(complaint("a and on"), HasSubstr("expected true or false, got a number"));
  EXPECT_THAT(complaint("a == on"), HasSubstr("a number is compared with true or false"));
  EXPECT_THAT(complaint("a"), HasSubstr("it is a number, not true or false"));
  EXPECT_THAT(complaint("a / zero > 1"), HasSubstr("division by zero"));
  EXPECT_THAT(complaint("a % zero > 1"), HasSubstr("division by zero"));
  EXPECT_EQ(complaint(std::string(100, '(') + "on" + std::string(100, ')')), "");
  EXPECT_THAT(complaint(std::string(101, '(') + "on" + std::string(101, ')')),
              HasSubstr("nested more than 100 deep"));
  EXPECT_EQ(complaint("on" + std::string(3998, ' ')), "");
  EXPECT_THAT(complaint("on" + std::string(3999, ' ')), HasSubstr("4001 characters"));
}

}  // namespace
}  // namespace deburr::tool::expression_test
