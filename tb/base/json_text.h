// SPDX-License-Identifier: MIT
// JSON from text and to text. Reader and writer are templates: compiled here once, and not in every
// batch that reads or writes a file.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace deburr::tb {

// nlohmann::json::parse_error for what is no JSON.
nlohmann::ordered_json parse_json(const std::string& text);
// Discarded (is_discarded()) for what is no JSON.
nlohmann::ordered_json try_parse_json(const std::string& text);
nlohmann::json try_parse_sorted_json(const std::string& text);

// What becomes of bytes that are not UTF-8: nlohmann::json::type_error, or U+FFFD in their place.
enum class NotUtf8 { kThrow, kReplace };
// On one line; with `indent`, a value a line.
std::string json_text(const nlohmann::ordered_json& json, int indent = -1,
                      NotUtf8 not_utf8 = NotUtf8::kThrow);

}  // namespace deburr::tb
