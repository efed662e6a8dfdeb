// SPDX-License-Identifier: MIT
// Are the links of an engine those of the table in its page: every one there, with its places and
// the bits of a beat in each build that the table has a column for?
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "rtl_model/fabric/engine.h"
#include "rtl_model/fabric/trace.h"

namespace deburr::tb {

class WireTable {
 public:
  // The table of a page whose first column is "link".
  explicit WireTable(const std::string& page) {
    std::ifstream file(std::string(DEBURR_DOCS "/") + page);
    for (std::string line; std::getline(file, line);) {
      if (line.starts_with("| link |"))
        titles_ = cells_of(line);
      else if (titles_.empty() || line.starts_with("|---"))
        continue;
      else if (line.starts_with("|"))
        rows_.push_back(cells_of(line));
      else
        break;
    }
    if (rows_.empty()) throw std::runtime_error(page + " has no table of links");
  }

  // `build` is the title of the column with the bits of a beat; "-" there: no such link.
  void expect_links(const std::string& build, const rtl::Engine& engine) const {
    const std::size_t places = column("places"), bits = column(build);
    std::vector<bool> met(rows_.size());
    for (const rtl::LinkBase* link : engine.links()) {
      const std::string name =
          std::string(link->name()).substr(std::string(engine.name()).size() + 1);
      const auto row = std::find_if(rows_.begin(), rows_.end(), [&](const auto& cells) {
        return cells[bits] != "-" && rtl::glob_match(cells[0], name);
      });
      const std::string built = fmt::format("{} {} {}", name, link->depth(), link->payload_bits());
      if (row == rows_.end()) {
        ADD_FAILURE() << "not in the table of " << build << ": " << built;
        continue;
      }
      EXPECT_EQ(built, fmt::format("{} {} {}", name, (*row)[places], (*row)[bits])) << build;
      met[static_cast<std::size_t>(row - rows_.begin())] = true;
    }
    for (std::size_t i = 0; i < rows_.size(); ++i)
      EXPECT_TRUE(met[i] || rows_[i][bits] == "-") << build << " has no link " << rows_[i][0];
  }

 private:
  static std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream stream(line.substr(1));
    for (std::string cell; std::getline(stream, cell, '|');) {
      std::erase(cell, '`');
      const std::size_t begin = cell.find_first_not_of(' '), end = cell.find_last_not_of(' ');
      cells.push_back(begin == std::string::npos ? "" : cell.substr(begin, end + 1 - begin));
    }
    return cells;
  }
  std::size_t column(const std::string& title) const {
    const auto found = std::find(titles_.begin(), titles_.end(), title);
    if (found == titles_.end()) throw std::runtime_error("the table has no column " + title);
    return static_cast<std::size_t>(found - titles_.begin());
  }

  std::vector<std::string> titles_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace deburr::tb
