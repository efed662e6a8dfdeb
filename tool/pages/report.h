// SPDX-License-Identifier: MIT
// report.html of a run directory: one self-contained page from result.json, manifest.json and the
// images that the manifest names. It opens from disk, without a network, and is readable without
// JavaScript.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace deburr::tool {

// Reads the directory and returns the page; FileError for missing or invalid files.
std::string build_report(const std::filesystem::path& directory);
// The page of a result that has not been written yet; `pictures` are in a directory.
std::string build_report(const std::filesystem::path& pictures, nlohmann::ordered_json result,
                         nlohmann::ordered_json manifest);
// Writes build_report() atomically to report.html in the same directory.
void write_report(const std::filesystem::path& directory);

// A picture inside a page.
std::string data_uri(const std::filesystem::path& image_file);
std::string png_uri(const std::string& png);

// JSON that is safe inside a <script> element: it contains no '<'.
std::string json_for_script(const nlohmann::ordered_json& json);

}  // namespace deburr::tool
