// SPDX-License-Identifier: MIT
#include "tb/base/json_text.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace deburr::tb::json_text_test {
namespace {

TEST(JsonText, KeepsOrderOrSorts) {
  EXPECT_EQ(json_text(parse_json(R"({"b": 1, "a": [2]})")), R"({"b":1,"a":[2]})");
  EXPECT_EQ(json_text(try_parse_json(R"({"b": 1, "a": [2]})"), 1),
            "{\n \"b\": 1,\n \"a\": [\n  2\n ]\n}");
  EXPECT_EQ(try_parse_sorted_json(R"({"b": 1, "a": [2]})").dump(), R"({"a":[2],"b":1})");
}

TEST(JsonText, InvalidJsonIsDiscardedOrThrown) {
  EXPECT_TRUE(try_parse_json("{").is_discarded());
  EXPECT_TRUE(try_parse_sorted_json("{").is_discarded());
  EXPECT_THROW(parse_json("{"), nlohmann::json::parse_error);
}

TEST(JsonText, InvalidUtf8IsThrownOrReplaced) {
  const nlohmann::ordered_json text = "a\xff";
  EXPECT_THROW(json_text(text), nlohmann::json::type_error);
  EXPECT_EQ(json_text(text, -1, NotUtf8::kReplace), "\"a\xef\xbf\xbd\"");
}

}  // namespace
}  // namespace deburr::tb::json_text_test
