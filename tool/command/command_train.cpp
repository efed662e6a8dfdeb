// SPDX-License-Identifier: MIT
#include "tool/command/command_train.h"

#include <CLI/CLI.hpp>
#include <memory>

namespace deburr::tool {

void add_train(CLI::App& app, CommandLine& line, TrainAction action) {
  CLI::App* command = app.add_subcommand(
      "train", "Train blend weights for a title from frames and their supersampled references");
  show_examples(*command,
                {"deburr train --in 'plain/*.png' --truth 'smooth/*.png' --out title.shares",
                 "deburr train --in frame.png --truth frame_256.png --out title.shares"});
  const auto options = std::make_shared<TrainOptions>();
  command
      ->add_option("--in", options->in, "Frames without anti-aliasing: a file, a list or a pattern")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--truth", options->reference,
                   "The same frames with supersampling, in the same order")
      ->required()
      ->type_name("FILE");
  command->add_option("--out", options->out, "File for the trained weights")
      ->required()
      ->type_name("FILE");
  command->add_option("--seed", options->seed, "Seed of the random choice of pixels")
      ->capture_default_str();
  command->add_option("--batches", options->batches, "Training steps, of 8192 pixels each")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000));
  command->add_flag("--quiet", options->quiet, "Print only errors and the line RESULT: ...");
  command->add_flag("--json", line.json, "Print one JSON object: exit code, outcome, training");
  command->callback([options, action, &line] {
    line.action = [options, action, &line] { return action(*options, line); };
  });
}

}  // namespace deburr::tool
