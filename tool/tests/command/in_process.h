// SPDX-License-Identifier: MIT
// Runs command lines of `deburr` in this process, with the engines of made_engine.cpp.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

namespace deburr::tool {

// A row of a table of tests.
struct Case {
  std::string name, given, expected;
};
inline void PrintTo(const Case& row, std::ostream* out) { *out << row.name; }
inline std::string name_of_case(const testing::TestParamInfo<Case>& row) { return row.param.name; }

// Each test gets an empty working folder.
class InProcess : public testing::Test {
 protected:
  InProcess();
  ~InProcess() override;

  // Everything that `deburr LINE` prints: standard output, the error stream with "! " before each
  // line, and "= CODE" if the exit code is not 0. LINE is split as by a shell.
  std::string printed(const std::string& line);
  // The object that a command with --json prints.
  nlohmann::ordered_json json(const std::string& line);
  // The line RESULT without "RESULT: ".
  std::string result(const std::string& line);
  // Expects that the command prints nothing but this failure, "KIND: MESSAGE", and ends with the
  // kind's code.
  void expect_failure(const std::string& line, const std::string& failure);

  static void write(const std::filesystem::path& file, const std::string& text);
  static std::string read(const std::filesystem::path& file);

  std::map<std::string, std::string>
      replaced_;  // text that differs from build to build -> its stand-in

 private:
  std::filesystem::path before_, folder_;
};

class InProcessTable : public InProcess, public testing::WithParamInterface<Case> {};

}  // namespace deburr::tool
