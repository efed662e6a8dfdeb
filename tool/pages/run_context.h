// SPDX-License-Identifier: MIT
// What surrounds one run of an engine: its parameters, inputs, output directory and manifest.
//
//   RunContext context(...);        // touches nothing
//   context.claim();                // may reject; then waves may be written to trace_file()
//   context.add_inputs(files);      // every file that was read
//   context.add_image(...);
//   context.finish(result);         // without it, an earlier run's results stay as they were
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tb/run/parameter_set.h"
#include "tb/run/picture_map.h"
#include "tb/run/result.h"
#include "tb/scene/image.h"
#include "tool/pages/run_directory.h"
#include "tool/pages/shared_inputs.h"

namespace deburr::tool {

inline constexpr std::string_view kIntervalsFile = "intervals.json",
                                  kTimelineFile = "timeline.json";

// Names of what a run may leave for people to look at, as its engine declares them.
struct Leaves {
  std::vector<std::string> pictures, maps;
  bool pixel_history = false;  // run.pixel gives something
};

// What a golden result depends on, by name and value; files by their names.
nlohmann::ordered_json golden_dependencies(const tb::ParameterSet& parameters, std::uint64_t seed,
                                           const std::vector<std::string_view>& built);

class RunContext {
 public:
  // `command` is the line that repeats the run.
  RunContext(std::filesystem::path directory, const tb::ParameterSet& parameters,
             std::string command, std::uint64_t seed);
  ~RunContext();
  // Nothing on the error stream but errors.
  void set_quiet(bool quiet) { quiet_ = quiet; }
  bool quiet() const { return quiet_; }
  // A run that ends where it would begin: everything that was given has been checked.
  void set_checking_only() { checking_only_ = true; }
  bool checking_only() const { return checking_only_; }
  // Without: no report.html, which `deburr report` makes of what is left.
  void set_report(bool wanted) { report_ = wanted; }
  // Runs that are given the same one make what they have in common once. `files` are all that this
  // one reads (Engine::input_files): what they hold is part of every key.
  void share(std::shared_ptr<SharedInputs> shared, std::vector<std::filesystem::path> files);
  // What `make` gives, kept for runs that agree in the seed, in what the files hold and in the
  // parameters whose names begin with one of `prefixes`. `what` tells one such thing from another.
  template <class T>
  std::shared_ptr<const T> shared(std::string_view what,
                                  std::initializer_list<std::string_view> prefixes,
                                  const std::function<T()>& make) const {
    if (!shared_) return std::make_shared<const T>(make());
    return shared_->get<T>(key_of(what, prefixes), make);
  }
  // The same of bytes, which processes can share too. FileError where a file has become another one
  // since its content went into the key.
  std::string shared_bytes(std::string_view what, std::initializer_list<std::string_view> prefixes,
                           const std::function<std::string()>& make) const;
  // The golden result that `make` gives, kept for the next runs that agree in what it depends on:
  // seed, inputs, rules, and `built`, names of what is built. Null where the run shares nothing, is
  // not checked, or reads lines of memory that fail, which only its own golden model knows.
  template <class T>
  std::shared_ptr<const T> shared_golden(const std::vector<std::string_view>& built,
                                         const std::function<T()>& make) const {
    if (!shared_ || !may_share_golden()) return nullptr;
    return shared_->last<T>("golden", key_of_golden(built), make);
  }
  void set_title(std::string title, std::string summary);
  // What had to be decided about an input (a mesh without normals): on the error stream, in result
  // and report.
  void add_note(const std::string& note);
  // Before claim(), which does not replace what somebody else left under one of these names.
  void set_leaves(Leaves leaves) { leaves_ = std::move(leaves); }
  // The directory is this run's from here on (RunDirectory::claim).
  void claim(IfTaken if_taken = IfTaken::kReject);
  // Lists files that the result depends on, those too that were looked for in vain. ConfigError if
  // the results would replace one.
  void add_inputs(const std::vector<std::filesystem::path>& files);
  // The same of a file that said how to run, as the parameters do, and what it said.
  void add_configuration(const std::filesystem::path& file, const std::string& text);
  // Where what is written while the run goes is until the run is over: waves, lines asked of
  // memory, fragments.
  std::filesystem::path trace_file() const { return draft_file("trace.vcd"); }
  std::filesystem::path line_trace_file() const { return draft_file("lines.trace"); }
  std::filesystem::path fragment_trace_file() const { return draft_file("fragments.trace"); }
  // Writes NAME.png and lists it for the report. NAME, which is the role too, is one of the
  // pictures that the run may leave.
  void add_image(const std::string& name, const tb::Image& image, std::string title,
                 std::string caption);
  // map_NAME.png, listed for the report, and map_NAME.pfm; NAME is one of its maps.
  void add_map(const tb::PictureMap& map);
  // A file of the run beside its result: `kind` is what the manifest's "records" calls it.
  void add_record(const std::string& kind, std::string_view file, std::string_view content);
  // Result, report and manifest; then all of it takes the place of an earlier run's results.
  void finish(const tb::Result& result);

  const std::filesystem::path& directory() const { return directory_.path(); }
  const tb::ParameterSet& parameters() const { return parameters_; }
  const std::string& command() const { return command_; }

 private:
  std::filesystem::path draft_file(const char* name) const;
  nlohmann::ordered_json& list(const std::filesystem::path& file, std::string_view content,
                               std::string_view role);
  bool may_share_golden() const;
  std::string key_of_golden(const std::vector<std::string_view>& built) const;
  std::string golden_key() const;
  std::string key_of(std::string_view what, std::initializer_list<std::string_view> prefixes) const;
  nlohmann::ordered_json manifest(const tb::Result& result) const;

  RunDirectory directory_;
  const tb::ParameterSet& parameters_;
  std::string command_, title_, summary_, started_;
  std::uint64_t seed_;
  bool quiet_ = false, checking_only_ = false, report_ = true;
  std::shared_ptr<SharedInputs> shared_;
  Leaves leaves_;
  std::vector<std::filesystem::path> shared_files_;
  std::vector<std::string> notes_;
  struct Listed;  // of the manifest
  std::unique_ptr<Listed> listed_;
};

}  // namespace deburr::tool
