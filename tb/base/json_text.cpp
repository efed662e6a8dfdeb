// SPDX-License-Identifier: MIT
#include "tb/base/json_text.h"

#include <nlohmann/json.hpp>

namespace deburr::tb {

nlohmann::ordered_json parse_json(const std::string& text) {
  return nlohmann::ordered_json::parse(text);
}

nlohmann::ordered_json try_parse_json(const std::string& text) {
  return nlohmann::ordered_json::parse(text, nullptr, /*allow_exceptions=*/false);
}

nlohmann::json try_parse_sorted_json(const std::string& text) {
  return nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
}

std::string json_text(const nlohmann::ordered_json& json, int indent, NotUtf8 not_utf8) {
  return json.dump(indent, ' ', false,
                   not_utf8 == NotUtf8::kReplace ? nlohmann::ordered_json::error_handler_t::replace
                                                 : nlohmann::ordered_json::error_handler_t::strict);
}

}  // namespace deburr::tb
