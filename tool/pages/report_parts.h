// SPDX-License-Identifier: MIT
// The parts of report.html, by their names. Each fills its section of report.mustache.
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

// The first mismatches, and the history of a pixel with commands to show another one or its
// waveforms.
void fill_pixel(const ReportSource& source, kainjow::mustache::data& page);
// Pictures, and maps over them; returns the script's data for maps.
nlohmann::ordered_json fill_pictures(const ReportSource& source, kainjow::mustache::data& page);
// Charts over time and charts of links, for a run with sampling intervals; returns the script's
// data.
nlohmann::ordered_json fill_over_time(const ReportSource& source, kainjow::mustache::data& page);

// Formats numbers for readers: grouped counts, rates with four significant digits.
std::string report_text(const nlohmann::ordered_json& value);
// The same for one key of an object.
std::string report_text(const nlohmann::ordered_json& object, const char* key);
double number(const nlohmann::ordered_json& object, const char* key);  // 0 for anything else
// The run's command without some options, so that other options can be appended.
std::string without_options(std::string command, std::initializer_list<std::string_view> options);
// Throws for names outside the directory, since a manifest of unknown origin must not embed other
// files.
void reject_path(const std::filesystem::path& directory, const std::filesystem::path& file);

}  // namespace deburr::tool
