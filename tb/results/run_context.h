// SPDX-License-Identifier: MIT
// What surrounds one run of an engine: its parameters, inputs, output directory and manifest.
//
//   RunContext context(...);        // touches nothing
//   context.add_input(file);        // every file that was read
//   context.claim();                // may refuse; then waves may be written to trace_file()
//   context.begin();                // earlier results go; the simulation follows
//   context.add_image(...);
//   context.finish(result);         // without it, what this run wrote is removed again
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tb/results/parameter_set.h"
#include "tb/results/result.h"
#include "tb/scene/image.h"

namespace deburr::tb {

// Every picture that a run may leave.
inline constexpr std::array<std::string_view, 9> kPictureNames = {
    "before", "after", "golden", "difference", "truth", "error", "change", "edges", "weights"};

class RunContext {
 public:
  // `command` is the line that repeats the run.
  RunContext(std::filesystem::path directory, const ParameterSet& parameters, std::string command,
             std::uint64_t seed);
  ~RunContext();
  RunContext(const RunContext&) = delete;
  RunContext& operator=(const RunContext&) = delete;

  void set_title(std::string title, std::string summary);
  // What had to be decided about an input (a mesh without normals): on the error stream and, with
  // the summary, in manifest and report.
  void add_note(const std::string& note);
  // Fingerprints a file that the result depends on. Before claim().
  void add_input(const std::filesystem::path& file);
  // A file that was read and must not be overwritten, without being listed. Before claim().
  void protect(const std::filesystem::path& file) { protected_.push_back(file); }
  // Makes the directory and proves it writable; removes nothing. ConfigError where this run would
  // replace a file that it reads, or one that is not an earlier run's: no manifest names it.
  // Interrupted if Ctrl-C came while the input was made: there is nothing to keep.
  void claim();
  // Removes the results of an earlier run, so that what is found there afterwards belongs to this
  // one.
  void begin();
  // Where waves go until the run is over; finish() gives the file its name.
  std::filesystem::path trace_file() const;
  // Writes NAME.png and lists it for the report. NAME, which is the role too, is one of
  // kPictureNames.
  void add_image(const std::string& name, const Image& image, std::string title,
                 std::string caption);
  // manifest.json, result.json and report.html, in this order: a result.json is always complete.
  void finish(const Result& result);

  const std::filesystem::path& directory() const { return directory_; }
  const ParameterSet& parameters() const { return parameters_; }
  const std::string& command() const { return command_; }

 private:
  std::vector<std::string> old_results() const;
  std::string golden_key() const;
  nlohmann::ordered_json manifest(const Result& result) const;

  std::filesystem::path directory_;
  std::vector<std::filesystem::path> protected_;
  std::vector<std::string> written_;  // removed again by a run that does not finish
  bool claimed_ = false, begun_ = false, finished_ = false;
  const ParameterSet& parameters_;
  std::string command_, title_, summary_, started_;
  std::uint64_t seed_;
  nlohmann::ordered_json inputs_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json images_ = nlohmann::ordered_json::array();
};

}  // namespace deburr::tb
