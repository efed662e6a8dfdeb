// SPDX-License-Identifier: MIT
// Shared by all pages: the layout (page.mustache), tables and tiles. Charts, and tables filled by
// scripts, are in kit.js. Only this file includes the template library, so it is compiled once.
#pragma once

#include <kainjow/mustache.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace deburr::tool {

// Escaped; names may wrap after '_', '.' and '/', but not within words.
std::string breakable(const std::string& text);

// A text, followed by HTML. `look`: classes in addition to those of the column.
struct HtmlCell {
  HtmlCell(std::string text_of_cell, std::string look_of_cell = "")
      : text(std::move(text_of_cell)), look(std::move(look_of_cell)) {}
  HtmlCell(const char* text_of_cell) : text(text_of_cell) {}
  static HtmlCell link(const std::string& target, const std::string& text);
  HtmlCell& add(const std::string& more) {
    html += more;
    return *this;
  }

  std::string text, html, look, tip;
};

class HtmlTable {
 public:
  // "Name|Name:classes|Name:classes:tip"; n: numbers; name, mono: texts that may wrap.
  explicit HtmlTable(std::string_view columns, std::string look = "");
  void column(const std::string& name, const std::string& look = "", const std::string& tip = "");
  void row(const std::vector<HtmlCell>& cells, const std::string& look = "",
           const std::string& tip = "");
  void part(const std::string& name);  // a row across all columns
  std::size_t rows() const { return rows_; }
  // The table in its scroll container. `around`: attributes of the container.
  std::string html(const std::string& around = R"(class="scroll")") const;

 private:
  std::string look_, head_, body_;
  std::vector<std::string> looks_;  // of the columns
  std::size_t rows_ = 0;
};

struct Tile {
  std::string name, value, unit = {}, note = {}, state = {};
};
// In one row, or in two rows of equal length.
std::string html_of(const std::vector<Tile>& tiles);

// The page with `content`, a template called `name`. Title, brand, verdict with badge and footer
// come from `page`; data and script belong to the page.
std::string filled_page(std::string_view content, std::string_view name,
                        kainjow::mustache::data page, bool with_charts = true);

}  // namespace deburr::tool
