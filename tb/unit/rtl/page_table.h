// SPDX-License-Identifier: MIT
// Are the links and memories of an engine those of the tables in its page?
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "rtl_model/fabric/engine.h"
#include "rtl_model/fabric/trace.h"

namespace deburr::tb {

class PageTable {
 public:
  // The table of a page whose first column has this title.
  PageTable(const std::string& page, const std::string& first) {
    std::ifstream file(std::string(DEBURR_DOCS "/") + page);
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

  // A row a link, or several (*, ?): its places, and in the column `build` the bits of a beat; "-"
  // there: no such link.
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

  // A row a memory, its name before anything else; those of the memory port have a page of their
  // own.
  void expect_memories(const rtl::Engine& engine) const {
    std::vector<bool> met(rows_.size());
    for (const rtl::MemoryBase* memory : engine.memories()) {
      const std::string name =
          std::string(memory->name()).substr(std::string(engine.name()).size() + 1);
      if (name.find("memory_port.") != std::string::npos) continue;
      const auto row = std::find_if(rows_.begin(), rows_.end(), [&](const auto& cells) {
        return cells[0].substr(0, cells[0].find(' ')) == name;
      });
      if (row == rows_.end()) {
        ADD_FAILURE() << "not in the table: " << name;
        continue;
      }
      met[static_cast<std::size_t>(row - rows_.begin())] = true;
      const bool flops = memory->memory_kind() == rtl::MemoryKind::kFlops;
      std::string kind = rtl::name_of(memory->memory_kind());
      std::transform(kind.begin(), kind.end(), kind.begin(),
                     [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
      EXPECT_EQ((*row)[column("kind")], flops ? "flip-flops" : kind) << name;
      EXPECT_EQ((*row)[column("words x bits")],
                fmt::format("{} x {}", memory->words(), memory->word_bits()))
          << name;
      const std::string& ports = (*row)[column("ports")];
      EXPECT_EQ(ports.substr(0, ports.find(',')), memory->ports()) << name;
      EXPECT_TRUE((*row)[column("read clock")].starts_with(
          memory->shape().latency == 0 ? "same clock" : "next clock"))
          << name << ": " << memory->shape().latency;
      EXPECT_EQ((*row)[column("built as")], memory->built_as()) << name;
      std::string bits = (*row)[column("physical bits")];
      std::erase(bits, ' ');
      EXPECT_EQ(bits, std::to_string(memory->physical_bits())) << name;
    }
    for (std::size_t i = 0; i < rows_.size(); ++i) EXPECT_TRUE(met[i]) << "no " << rows_[i][0];
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
