// SPDX-License-Identifier: MIT
// The parts of report.html, by their names on it. Each sets what its section of report.mustache
// shows.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "tool/pages/page.h"

namespace deburr::tool {

struct ReportSource {
  const std::filesystem::path& directory;
  const nlohmann::ordered_json &result, &manifest;
};

constexpr std::size_t kMaxImageBytes = 256u << 20;

// First mismatches, and the history of a pixel with the commands that give another one or the waves
// around this one.
void fill_pixel(const ReportSource& source, kainjow::mustache::data& page);
// Pictures, and maps over them; returns what the script shows of maps.
nlohmann::ordered_json fill_pictures(const ReportSource& source, kainjow::mustache::data& page);
// Over time, and links, of a run with windows; returns what the script draws.
nlohmann::ordered_json fill_over_time(const ReportSource& source, kainjow::mustache::data& page);

// Numbers as a reader wants them: counts grouped, rates with four significant digits.
std::string report_text(const nlohmann::ordered_json& value);
// Of an object's key, as that.
std::string report_text(const nlohmann::ordered_json& object, const char* key);
double number(const nlohmann::ordered_json& object, const char* key);  // 0 for anything else
// The command of a run without some of its options, so that others can be given behind it.
std::string without_options(std::string command, std::initializer_list<std::string_view> options);
// Only names inside the directory: a manifest from elsewhere must not pull other files in.
void reject_path(const std::filesystem::path& directory, const std::filesystem::path& file);

}  // namespace deburr::tool
