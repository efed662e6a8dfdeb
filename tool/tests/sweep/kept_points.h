// SPDX-License-Identifier: MIT
// A folder with points whose results are made by a test.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tb/base/file.h"
#include "tb/run/result.h"
#include "tool/sweep/plan.h"
#include "tool/sweep/point.h"

namespace deburr::tool {

// Pages are too long to be shown.
inline void expect_in(const std::string& page, const std::string& text) {
  EXPECT_NE(page.find(text), std::string::npos) << text;
}

class KeptPoints : public testing::Test {
 protected:
  KeptPoints() {
    std::filesystem::remove_all(out_);
    std::filesystem::create_directories(out_);
  }
  ~KeptPoints() override { std::filesystem::remove_all(out_); }

  // Writes a file with this text into the folder.
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(out_ / name) << text;
    return out_ / name;
  }
  std::string read(const std::filesystem::path& file) const { return tb::read_file(file, 1 << 24); }
  SweepPlace place() const { return {out_, out_ / "here"}; }
  std::filesystem::path folder_of(const std::string& name) const {
    return point_directory(place().points(), name);
  }
  void keep(const std::string& name, nlohmann::ordered_json result,
            const std::string& verdict = "pass") const {
    nlohmann::ordered_json whole = {{"schema", tb::kResultSchema}, {"verdict", verdict}};
    whole.update(result);
    std::filesystem::create_directories(folder_of(name));
    std::ofstream(folder_of(name) / "result.json") << whole.dump(1);
    std::ofstream(folder_of(name) / "manifest.json") << "{}";
  }

 private:
  std::filesystem::path out_ =
      std::filesystem::path(testing::TempDir()) /
      (std::string("deburr_kept_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

}  // namespace deburr::tool
