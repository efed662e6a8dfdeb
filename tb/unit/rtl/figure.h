// SPDX-License-Identifier: MIT
// Compares the block diagram of an engine with its module tree. A figure is in the header of a
// module (the lines of its first comment that are indented by two or more blanks) or the first
// block of a page. A capitalised word (AreaUnit) is the name of a class; all other text is free.
#pragma once

#include <cxxabi.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <regex>
#include <set>
#include <string>
#include <systemc>
#include <typeinfo>
#include <vector>

#include "rtl_model/fabric/register_block.h"
#include "rtl_model/fabric/wire.h"
#include "tb/harness/test_paths.h"

namespace deburr::tb {

class Figure {
 public:
  static Figure of_header(const std::string& path) {
    std::ifstream file = opened(path);
    std::string text;
    for (std::string line; std::getline(file, line) && line.starts_with("//");)
      if (line.starts_with("//  ")) text += line.substr(2) + "\n";
    return {path, text};
  }
  static Figure of_page(const std::string& page) {
    std::ifstream file = opened("docs/" + page);
    std::string text;
    bool inside = false;
    for (std::string line; std::getline(file, line);) {
      if (line.starts_with("```")) {
        if (inside) break;
        inside = true;
      } else if (inside) {
        text += line + "\n";
      }
    }
    return {"docs/" + page, text};
  }
  Figure(std::string where, std::string text) : where_(std::move(where)), text_(std::move(text)) {}

  // A copy without this word, or with it appended.
  Figure without(const std::string& word) const {
    return {where_, std::regex_replace(text_, std::regex("\\b" + word + "\\b"), "")};
  }
  Figure with(const std::string& word) const { return {where_, text_ + " " + word}; }

  // Lists names that are built and not drawn, or drawn and not built; empty if the figure matches.
  // Built: the direct child modules of `module`, its register block (registers), its wires, and the
  // other public members of its header (memories and registers that are not modules). Private
  // members, deeper modules and members of the headers `below` may be drawn.
  std::vector<std::string> differences(const sc_core::sc_module& module, const std::string& header,
                                       const std::vector<std::string>& below = {}) const {
    const Members members = members_of(header);
    std::set<std::string> wanted = members.open, known = members.all;
    for (const std::string& inner : below) known.merge(members_of(inner).all);
    add_modules(module, known);
    for (const sc_core::sc_object* child : module.get_child_objects()) {
      if (dynamic_cast<const rtl::RegisterBlock*>(child) ||
          dynamic_cast<const rtl::WireBase*>(child))
        wanted.insert(child->basename());
      else if (dynamic_cast<const sc_core::sc_module*>(child))
        wanted.insert(class_of(*child));
    }
    std::vector<std::string> found;
    if (text_.empty()) found.push_back(where_ + " has no figure");
    const std::set<std::string> drawn = words(std::regex("[A-Za-z]\\w*"));
    for (const std::string& name : wanted)
      if (!drawn.contains(name)) found.push_back(where_ + " does not draw " + name);
    for (const std::string& name : words(std::regex("\\b[A-Z]\\w*[a-z]\\w*")))
      if (!known.contains(name)) found.push_back(where_ + " draws what is not built: " + name);
    return found;
  }

 private:
  static std::ifstream opened(const std::string& path) {
    std::ifstream file(source_folder() / path);
    if (!file) throw std::runtime_error("cannot read " + path);
    return file;
  }
  std::set<std::string> words(const std::regex& pattern) const {
    std::set<std::string> found;
    for (auto at = std::sregex_iterator(text_.begin(), text_.end(), pattern);
         at != std::sregex_iterator(); ++at)
      found.insert(at->str());
    return found;
  }
  static std::string class_of(const sc_core::sc_object& object) {
    const std::unique_ptr<char, decltype(&std::free)> name(
        abi::__cxa_demangle(typeid(object).name(), nullptr, nullptr, nullptr), &std::free);
    const std::string full = name ? name.get() : typeid(object).name();
    return full.substr(full.rfind(':') + 1);
  }
  static void add_modules(const sc_core::sc_object& object, std::set<std::string>& names) {
    for (const sc_core::sc_object* child : object.get_child_objects()) {
      if (dynamic_cast<const sc_core::sc_module*>(child)) names.insert(class_of(*child));
      add_modules(*child, names);
    }
  }
  // Classes of the members that a header declares as `Class name;`, also in a unique_ptr. Links,
  // wires and ports are templates; names of private members end in _.
  struct Members {
    std::set<std::string> open, all;
  };
  static Members members_of(const std::string& header) {
    std::ifstream file = opened(header);
    const std::regex member(R"(  (?:std::unique_ptr<)?([A-Z]\w+)>? (\w+)(?:, \w+)*(?:\{.*\})?;.*)");
    Members members;
    std::smatch match;
    for (std::string line; std::getline(file, line);) {
      if (!std::regex_match(line, match, member)) continue;
      members.all.insert(match[1]);
      if (!match[2].str().ends_with('_')) members.open.insert(match[1]);
    }
    return members;
  }

  std::string where_, text_;
};

// Expects a figure that matches, and that a missing unit and an additional name are reported.
inline void expect_figure(const Figure& figure, const sc_core::sc_module& module,
                          const std::string& header, const std::string& one_of_its_units,
                          const std::vector<std::string>& below = {}) {
  const auto differences = [&](const Figure& drawn) {
    return drawn.differences(module, header, below);
  };
  EXPECT_EQ(differences(figure), std::vector<std::string>{});
  EXPECT_EQ(differences(figure.without(one_of_its_units)).size(), 1u);
  EXPECT_EQ(differences(figure.with("SpareUnit")).size(), 1u);
}

}  // namespace deburr::tb
