// SPDX-License-Identifier: MIT
// Compares links, wires and memories of an engine with the tables of its page.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string>
#include <vector>

#include "rtl_model/fabric/engine.h"
#include "rtl_model/fabric/glob.h"
#include "rtl_model/fabric/wire.h"
#include "tb/unit/page_table.h"

namespace deburr::tb {

class EnginePage : public PageTable {
 public:
  using PageTable::PageTable;

  // One row per link, or for several (*, ?): its entries, and in the column `build` the bits of a
  // beat, or "-" if the link is not built.
  void expect_links(const std::string& build, const rtl::Engine& engine) const {
    const std::size_t places = column("entries"), bits = column(build);
    std::vector<bool> met(rows().size());
    for (const rtl::LinkBase* link : engine.links()) {
      const std::string name =
          std::string(link->name()).substr(std::string(engine.name()).size() + 1);
      const auto row = std::find_if(rows().begin(), rows().end(), [&](const auto& cells) {
        return cells[bits] != "-" && rtl::glob_match(cells[0], name);
      });
      const std::string built = fmt::format("{} {} {}", name, link->depth(), link->payload_bits());
      if (row == rows().end()) {
        ADD_FAILURE() << "not in the table of " << build << ": " << built;
        continue;
      }
      EXPECT_EQ(built, fmt::format("{} {} {}", name, (*row)[places], (*row)[bits])) << build;
      met[static_cast<std::size_t>(row - rows().begin())] = true;
    }
    for (std::size_t i = 0; i < rows().size(); ++i)
      EXPECT_TRUE(met[i] || rows()[i][bits] == "-") << build << " has no link " << rows()[i][0];
  }

  // One row per wire: its bits, the unit that drives it, and its readers in the order of binding.
  void expect_wires(rtl::Engine& engine) const {
    const auto below = [&](const std::string& name) {
      return name.substr(std::string(engine.name()).size() + 1);
    };
    const auto unit_of = [&](const std::string& port) {
      const std::string name = below(port);
      return name.substr(0, name.rfind('.'));
    };
    std::vector<std::string> built;
    rtl::for_each<rtl::WireBase>(engine, [&](const rtl::WireBase& wire) {
      std::string text =
          fmt::format("{} {} {}:", below(wire.name()), wire.bits(), unit_of(wire.driver()));
      for (const std::string& reader : wire.readers()) text += " " + unit_of(reader);
      built.push_back(text);
    });
    std::vector<std::string> written;
    for (const auto& cells : rows()) {
      std::string readers = cells[column("to")];
      std::erase(readers, ',');
      written.push_back(fmt::format("{} {} {}: {}", cells[0], cells[column("bits")],
                                    cells[column("from")], readers));
    }
    std::sort(built.begin(), built.end());
    std::sort(written.begin(), written.end());
    EXPECT_EQ(built, written);
  }

  // One row per memory, with its name first; the memory port has another page.
  void expect_memories(const rtl::Engine& engine) const {
    std::vector<bool> met(rows().size());
    for (const rtl::MemoryBase* memory : engine.memories()) {
      const std::string name =
          std::string(memory->name()).substr(std::string(engine.name()).size() + 1);
      if (name.find("memory_port.") != std::string::npos) continue;
      const auto row = std::find_if(rows().begin(), rows().end(), [&](const auto& cells) {
        return cells[0].substr(0, cells[0].find(' ')) == name;
      });
      if (row == rows().end()) {
        ADD_FAILURE() << "not in the table: " << name;
        continue;
      }
      met[static_cast<std::size_t>(row - rows().begin())] = true;
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
    for (std::size_t i = 0; i < rows().size(); ++i) EXPECT_TRUE(met[i]) << "no " << rows()[i][0];
  }
};

}  // namespace deburr::tb
