// SPDX-License-Identifier: MIT
// The context of one run of an engine: its parameters, inputs, output directory and manifest.
//
//   RunContext context(...);        // touches nothing
//   context.claim();                // may reject; then waveforms may be written to trace_file()
//   context.add_inputs(files);      // every file that was read
//   context.add_image(...);
//   context.finish(result);         // without it, the results of an earlier run stay
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

// Names of the output files that a run may write, as declared by its engine.
struct Leaves {
  std::vector<std::string> pictures, maps;
  bool pixel_history = false;  // run.pixel has an effect
};

// What a golden result depends on: names and values of parameters, and names of files.
nlohmann::ordered_json golden_dependencies(const tb::ParameterSet& parameters, std::uint64_t seed,
                                           const std::vector<std::string_view>& built);

class RunContext {
 public:
  // `command` is the command line that repeats the run.
  RunContext(std::filesystem::path directory, const tb::ParameterSet& parameters,
             std::string command, std::uint64_t seed);
  ~RunContext();
  // Prints only errors to the error stream.
  void set_quiet(bool quiet) { quiet_ = quiet; }
  bool quiet() const { return quiet_; }
  // Makes the run end after all inputs have been checked, before simulation.
  void set_checking_only() { checking_only_ = true; }
  bool checking_only() const { return checking_only_; }
  // If false, report.html is not written; `deburr report` can create it later.
  void set_report(bool wanted) { report_ = wanted; }
  // Runs with the same SharedInputs prepare common inputs only once. `files` are all files that
  // this run reads (Engine::input_files); their contents are part of every key.
  void share(std::shared_ptr<SharedInputs> shared, std::vector<std::filesystem::path> files);
  // Returns the result of `make`, cached for runs that agree in the seed, in the contents of the
  // files and in the parameters whose names start with one of `prefixes`. `what` distinguishes
  // kinds of objects.
  template <class T>
  std::shared_ptr<const T> shared(std::string_view what,
                                  std::initializer_list<std::string_view> prefixes,
                                  const std::function<T()>& make) const {
    if (!shared_) return std::make_shared<const T>(make());
    return shared_->get<T>(key_of(what, prefixes), make);
  }
  // The same for bytes, which can also be shared between processes. FileError if a file has changed
  // since its content became part of the key.
  std::string shared_bytes(std::string_view what, std::initializer_list<std::string_view> prefixes,
                           const std::function<std::string()>& make) const;
  // Returns the golden result of `make`, cached for later runs with the same seed, inputs,
  // configuration and values of `built` (names of build parameters). Null if the run shares
  // nothing, if it is not checked, or if it reads failing memory lines, since these are known only
  // to its own golden model.
  template <class T>
  std::shared_ptr<const T> shared_golden(const std::vector<std::string_view>& built,
                                         const std::function<T()>& make) const {
    if (!shared_ || !may_share_golden()) return nullptr;
    return shared_->last<T>("golden", key_of_golden(built), make);
  }
  void set_title(std::string title, std::string summary);
  // Notes a decision about an input (a mesh without normals) on the error stream, in the result and
  // in the report.
  void add_note(const std::string& note);
  // Call before claim(): it then does not replace files of the user that have one of these names.
  void set_leaves(Leaves leaves) { leaves_ = std::move(leaves); }
  // Claims the directory for this run (RunDirectory::claim).
  void claim(IfTaken if_taken = IfTaken::kReject);
  // Records files on which the result depends, including those not found. ConfigError if the
  // results would replace one of them.
  void add_inputs(const std::vector<std::filesystem::path>& files);
  // The same for a configuration file, with the text that was read.
  void add_configuration(const std::filesystem::path& file, const std::string& text);
  // Temporary paths of files that are written during the run: waveforms, requested memory lines,
  // fragments.
  std::filesystem::path trace_file() const { return draft_file("trace.vcd"); }
  std::filesystem::path line_trace_file() const { return draft_file("lines.trace"); }
  std::filesystem::path fragment_trace_file() const { return draft_file("fragments.trace"); }
  // Writes NAME.png and lists it for the report. NAME is also its role and must be one of the
  // pictures that the run may write.
  void add_image(const std::string& name, const tb::Image& image, std::string title,
                 std::string caption);
  // Writes frame_NNNN.png, the output for a frame of a sequence; returns the file's name, or
  // nothing without pictures.
  std::string add_frame(int number, const tb::Image& image);
  // Writes map_NAME.png, which is listed for the report, and map_NAME.pfm. NAME must be one of the
  // maps that the run may write.
  void add_map(const tb::PictureMap& map);
  // Adds a file next to the result: `kind` is its name in the manifest's "records".
  void add_record(const std::string& kind, std::string_view file, std::string_view content);
  // Writes result, report and manifest, then replaces an earlier run's results with them.
  void finish(const tb::Result& result);

  const std::filesystem::path& directory() const { return directory_.path(); }
  const tb::ParameterSet& parameters() const { return parameters_; }
  const std::string& command() const { return command_; }

 private:
  bool writes_images() const;
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
  struct Listed;  // entries of the manifest
  std::unique_ptr<Listed> listed_;
};

}  // namespace deburr::tool
