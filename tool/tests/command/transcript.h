// SPDX-License-Identifier: MIT
// Command lines of `deburr` in this process, and all that they print.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace deburr::tb {

struct Said {
  int code = 0;
  std::string out, errors;
};

// Each test has a folder of its own, in which it is.
class Transcript : public testing::Test {
 protected:
  Transcript();
  ~Transcript() override;

  static Said deburr(std::vector<std::string> words);
  // Runs the command lines of a file beside this one, those behind "$ ", and expects what it says
  // that they print: lines of standard output, lines of the error stream behind "! " (behind
  // "| grep TEXT" those with the text), and the exit code behind "= " where that is not 0. Lines
  // behind "% " are steps of the test, or files of the lines behind "> " below them. What is
  // printed now is left beside the folder.
  void expect(const std::string& file);
  // Within a step: a line of what is printed.
  void said(const std::string& line) { said_ += line + "\n"; }
  static void write(const std::filesystem::path& file, const std::string& text);
  static std::string read(const std::filesystem::path& file);

  std::map<std::string, std::function<void()>> steps_;
  // What another build, or another day, would print otherwise: with what stands for it.
  std::map<std::string, std::string> replaced_;

 private:
  std::filesystem::path before_, folder_;
  std::string said_;
};

}  // namespace deburr::tb
