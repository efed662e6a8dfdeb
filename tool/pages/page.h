// SPDX-License-Identifier: MIT
// The kit of all pages: the frame around a page (page.mustache), tables and tiles. Charts, and
// tables that scripts fill, are in kit.js. Templates are read here alone: that is compiled once,
// and not for every page.
#pragma once

#include <kainjow/mustache.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace deburr::tool {

// Escaped; names may end a line after '_', '.' and '/', and not within their words.
std::string breakable(const std::string& text);

// A text, and HTML behind it; `look`: classes besides those of the column.
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
  // "Name|Name:classes|Name:classes:tip"; n: numbers; name, mono: breakable texts.
  explicit HtmlTable(std::string_view columns, std::string look = "");
  void column(const std::string& name, const std::string& look = "", const std::string& tip = "");
  void row(const std::vector<HtmlCell>& cells, const std::string& look = "",
           const std::string& tip = "");
  void part(const std::string& name);  // a row across all columns
  std::size_t rows() const { return rows_; }
  // With what it scrolls in; `around`: attributes of that.
  std::string html(const std::string& around = R"(class="scroll")") const;

 private:
  std::string look_, head_, body_;
  std::vector<std::string> looks_;  // of the columns
  std::size_t rows_ = 0;
};

struct Tile {
  std::string name, value, unit = {}, note = {}, state = {};
};
// In one row, or in two that are equally long.
std::string html_of(const std::vector<Tile>& tiles);

// The page with `content`, a template of `name`. Of `page` it shows title, brand, verdict with
// badge, and footer; data and script are the page's own.
std::string filled_page(std::string_view content, std::string_view name,
                        kainjow::mustache::data page, bool with_charts = true);

}  // namespace deburr::tool
