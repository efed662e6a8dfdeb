// SPDX-License-Identifier: MIT
// Parses and prints JSON. nlohmann's templates are instantiated here once, to save compile time.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace deburr::tb {

// Throws nlohmann::json::parse_error for invalid JSON.
nlohmann::ordered_json parse_json(const std::string& text);
// Returns a discarded value (is_discarded()) for invalid JSON.
nlohmann::ordered_json try_parse_json(const std::string& text);
nlohmann::json try_parse_sorted_json(const std::string& text);

// Handling of bytes that are not UTF-8: throw nlohmann::json::type_error, or replace them by
// U+FFFD.
enum class NotUtf8 { kThrow, kReplace };
// Prints on one line; with `indent`, one value per line.
std::string json_text(const nlohmann::ordered_json& json, int indent = -1,
                      NotUtf8 not_utf8 = NotUtf8::kThrow);

}  // namespace deburr::tb
