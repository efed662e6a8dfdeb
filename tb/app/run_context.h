// SPDX-License-Identifier: MIT
// What surrounds one run of an engine: its parameters, inputs, output directory and manifest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tb/app/parameter_set.h"
#include "tb/app/result.h"
#include "tb/scene/image.h"

namespace deburr::tb {

class RunContext {
 public:
  // Proves the directory writable and removes the results of an earlier run from it, so that what
  // is found there afterwards belongs to this run. `command` is the line that repeats it.
  RunContext(std::filesystem::path directory, const ParameterSet& parameters, std::string command,
             std::uint64_t seed);

  void set_title(std::string title, std::string summary);
  // What had to be decided about an input (a mesh without normals): on the error stream and, with
  // the summary, in manifest and report.
  void add_note(const std::string& note);
  // The unit that bounds the rate; the report shows how busy it was.
  void set_bottleneck(std::string unit) { bottleneck_ = std::move(unit); }
  // Fingerprints a file that the result depends on.
  void add_input(const std::filesystem::path& file);
  // Writes NAME.png and lists it for the report. Role: before, after, golden, difference, truth.
  void add_image(const std::string& name, const Image& image, std::string title,
                 std::string caption);
  // manifest.json, result.json and report.html, in this order: a result.json is always complete.
  void finish(const Result& result);

  const std::filesystem::path& directory() const { return directory_; }
  const std::string& command() const { return command_; }

 private:
  void remove_old_results();
  nlohmann::ordered_json manifest(const Result& result) const;

  std::filesystem::path directory_;
  const ParameterSet& parameters_;
  std::string command_, title_, summary_, bottleneck_, started_;
  std::uint64_t seed_;
  nlohmann::ordered_json inputs_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json images_ = nlohmann::ordered_json::array();
};

}  // namespace deburr::tb
