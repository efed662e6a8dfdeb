// SPDX-License-Identifier: MIT
// report.html of a run directory: one self-contained page from result.json, manifest.json and the
// images that the manifest names. It opens from disk, without a network, and is readable without
// JavaScript.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace deburr::tool {

// Reads the directory and returns the page; FileError when something is missing or not valid.
std::string build_report(const std::filesystem::path& directory);
// The page of a result that is not written yet; `pictures` are in a directory.
std::string build_report(const std::filesystem::path& pictures, nlohmann::ordered_json result,
                         nlohmann::ordered_json manifest);
// build_report, written atomically to report.html of the same directory.
void write_report(const std::filesystem::path& directory);

// A picture inside a page.
std::string data_uri(const std::filesystem::path& image_file);
std::string png_uri(const std::string& png);

// JSON that is safe inside a <script> element: no '<' in it.
std::string json_for_script(const nlohmann::ordered_json& json);

}  // namespace deburr::tool
