// SPDX-License-Identifier: MIT
// A table of a page in docs/, for tests that compare it with the implementation.
#pragma once

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tb/harness/test_paths.h"

namespace deburr::tb {

class PageTable {
 public:
  // The table of a page whose first columns have these titles ("image | rules").
  PageTable(const std::string& page, const std::string& first) {
    std::ifstream file(source_folder() / "docs" / page);
    for (std::string line; std::getline(file, line);) {
      if (line.starts_with("| " + first + " |"))
        titles_ = cells_of(line);
      else if (titles_.empty() || line.starts_with("|---"))
        continue;
      else if (line.starts_with("|"))
        rows_.push_back(cells_of(line));
      else
        break;
    }
    if (rows_.empty()) throw std::runtime_error(page + " has no table of a " + first);
  }

  // Cells without the spaces around them, and without `.
  const std::vector<std::vector<std::string>>& rows() const { return rows_; }
  std::size_t column(const std::string& title) const {
    const auto found = std::find(titles_.begin(), titles_.end(), title);
    if (found == titles_.end()) throw std::runtime_error("the table has no column " + title);
    return static_cast<std::size_t>(found - titles_.begin());
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

  std::vector<std::string> titles_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace deburr::tb
