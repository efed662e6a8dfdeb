// SPDX-License-Identifier: MIT
// The program that `deburr train` starts.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "spec/error.h"
#include "studies/training/title_weights.h"
#include "tb/base/atomic_file.h"
#include "tb/base/file.h"
#include "tb/base/interrupt.h"
#include "tb/base/json_text.h"
#include "tb/base/terminal.h"
#include "tb/env/sequence.h"
#include "tb/run/progress.h"
#include "tb/scene/image_io.h"
#include "tb/stimuli/weight_file.h"
#include "tool/command/command_train.h"

namespace deburr::studies {
namespace {

using Json = nlohmann::ordered_json;
using training::KeptBack;
using training::TitlePair;
using training::TitleWeights;

constexpr double kLeastGain = 0.05;  // dB; smaller gains are noise

std::vector<TitlePair> read_pairs(const tool::TrainOptions& options, bool quiet) {
  const std::vector<std::string> frames = tb::listed_files("--in", options.in),
                                 references = tb::listed_files("--truth", options.reference);
  if (frames.size() != references.size())
    throw spec::ConfigError(fmt::format(
        "--in names {} frames and --truth {}: expected one reference per frame, in the same order",
        frames.size(), references.size()));
  std::vector<TitlePair> pairs;
  const auto read = [&](const std::string& file) {
    tb::ReadReport report;
    tb::Image image = tb::read_image(file, &report);
    if (!quiet)
      for (const std::string& conversion : report.conversions)
        fmt::print(stderr, "deburr: note: '{}': {}\n", file, conversion);
    return image;
  };
  for (std::size_t i = 0; i < frames.size(); ++i)
    pairs.push_back({frames[i], read(frames[i]), read(references[i])});
  return pairs;
}

// Called before the work, so that an output that cannot be written (full disk, read-only folder)
// fails at once.
void check_output(const tool::TrainOptions& options) {
  const std::filesystem::path out = options.out;
  for (const std::string& text : {options.in, options.reference})
    for (const std::string& file : tb::listed_files("--in", text))
      if (tb::is_there(out) && tb::is_there(file) && std::filesystem::equivalent(out, file))
        throw spec::ConfigError(
            fmt::format("--out '{}' is also an input: give another name", options.out));
  if (const std::filesystem::path folder = out.parent_path();
      !folder.empty() && !tb::is_folder(folder))
    throw spec::FileError(
        fmt::format("cannot write '{}': folder '{}' does not exist", options.out, folder.string()));
  if (tb::is_folder(out))
    throw spec::FileError(fmt::format("cannot write '{}': it is a folder", options.out));
  if (tb::is_there(out)) {
    try {
      tb::stimuli::read_weight_file(out);
    } catch (const spec::FileError&) {
      throw spec::ConfigError(
          fmt::format("'{}' exists and is not a file of weights: remove it, or give another --out",
                      options.out));
    }
  }
  tb::try_to_write(out, tb::stimuli::weight_file_text({}, {}));
}

std::string row(const KeptBack& k) {
  return fmt::format(
      "validation: {}: edges {:.2f} dB without smoothing, {:.2f} shipped, {:.2f} trained "
      "({:+.2f}); whole picture {:.2f}, {:.2f} ({:+.2f})\n",
      k.name, k.none, k.shipped, k.trained, k.trained - k.shipped, k.shipped_frame, k.trained_frame,
      k.trained_frame - k.shipped_frame);
}

Json to_json(const TitleWeights& weights, double seconds) {
  Json kept = Json::array();
  for (const KeptBack& k : weights.kept_back)
    kept.push_back({{"name", k.name},
                    {"edges_none_db", k.none},
                    {"edges_shipped_db", k.shipped},
                    {"edges_trained_db", k.trained},
                    {"frame_shipped_db", k.shipped_frame},
                    {"frame_trained_db", k.trained_frame}});
  return {{"training",
           {{"gain_db", weights.gain},
            {"frame_gain_db", weights.frame_gain},
            {"trained_on", weights.trained_on},
            {"kept_back", kept},
            {"seconds", seconds}}}};
}

tool::Outcome train(const tool::TrainOptions& options, const tool::CommandLine& line) {
  const bool quiet = options.quiet || line.json;
  check_output(options);
  const std::vector<TitlePair> pairs = read_pairs(options, quiet);
  tb::catch_interrupts();
  const auto begun = std::chrono::steady_clock::now();
  TitleWeights weights;
  const auto ask = [] {
    if (tb::interrupted()) throw tb::Interrupted();
  };
  try {
    tb::Progress progress("training", static_cast<std::uint64_t>(options.batches), "batch", quiet);
    const auto batch_done = [&](int done) {
      ask();
      progress.update(static_cast<std::uint64_t>(done));
    };
    weights = training::train_title(pairs, {options.batches, options.seed, batch_done, ask});
    ask();
  } catch (const tb::Interrupted&) {
    return {tb::kInterruptedExit, "INTERRUPTED train: no weights were written"};
  }
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  if (!quiet)
    for (const KeptBack& k : weights.kept_back) tb::print_wrapped(row(k));
  tool::Outcome outcome;
  outcome.details = tb::json_text(to_json(weights, seconds));
  const std::string gain =
      fmt::format("{:+.2f} dB on edges of the validation frames, {:+.2f} on whole frames",
                  weights.gain, weights.frame_gain);
  // Of pixels that must not change, such as lines of a user interface, only whole frames tell.
  if (!((weights.gain + weights.frame_gain) / 2 >= kLeastGain)) {
    fmt::print(stderr,
               "deburr: no weights were written: {}, expected at least {:+.2f} on average; the "
               "shipped weights are as good for these frames\n",
               gain, kLeastGain);
    outcome.code = static_cast<int>(spec::ExitCode::kMismatch);
    outcome.text = fmt::format("FAIL no gain: {}", gain);
    return outcome;
  }
  std::vector<std::string> notes = {
      fmt::format("{}; {} batches, seed {}", gain, options.batches, options.seed)};
  for (const std::string& name : weights.trained_on) notes.push_back("trained on " + name);
  tb::write_file_atomically(options.out, tb::stimuli::weight_file_text(weights.tables, notes));
  outcome.text = fmt::format("PASS train: {}, in {:.1f} s, {}", gain, seconds, options.out);
  return outcome;
}

}  // namespace
}  // namespace deburr::studies

int main(int argc, char** argv) {
  using deburr::tool::CommandLine;
  return deburr::tool::run_command_line(argc, argv, [](CLI::App& app, CommandLine& line) {
    deburr::tool::add_train(app, line, deburr::studies::train);
  });
}
