// SPDX-License-Identifier: MIT
#include "tool/pages/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "spec/error.h"
#include "tool/pages/build_info.h"
#include "tool/pages/embedded.h"

namespace deburr::tool {
namespace {

namespace mustache = kainjow::mustache;

std::string attribute(const char* name, const std::string& value) {
  return value.empty() ? "" : fmt::format(" {}=\"{}\"", name, mustache::html_escape(value));
}

std::string joined(const std::string& one, const std::string& other) {
  return one.empty() || other.empty() ? one + other : one + " " + other;
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

}  // namespace

std::string breakable(const std::string& text) {
  const std::string html = mustache::html_escape(text);
  std::string broken;
  for (std::size_t i = 0; i < html.size(); ++i) {
    broken += html[i];
    const bool separator = html[i] == '_' || html[i] == '.' || html[i] == '/';
    if (separator && i > 0 && i + 1 < html.size() && is_letter(html[i + 1])) broken += "<wbr>";
  }
  return broken;
}

HtmlCell HtmlCell::link(const std::string& target, const std::string& text) {
  return HtmlCell("").add(
      fmt::format("<a{}>{}</a>", attribute("href", target), mustache::html_escape(text)));
}

HtmlTable::HtmlTable(std::string_view columns, std::string look) : look_(std::move(look)) {
  while (!columns.empty()) {
    const std::string one(columns.substr(0, columns.find('|')));
    columns.remove_prefix(std::min(one.size() + 1, columns.size()));
    const std::size_t end = std::min(one.find(':'), one.size()),
                      tip = std::min(one.find(':', end + 1), one.size());
    column(one.substr(0, end), end < one.size() ? one.substr(end + 1, tip - end - 1) : "",
           tip < one.size() ? one.substr(tip + 1) : "");
  }
}

void HtmlTable::column(const std::string& name, const std::string& look, const std::string& tip) {
  head_ += fmt::format("<th{}{}>{}</th>", look == "n" ? " class=\"n\"" : "",
                       attribute("title", tip), mustache::html_escape(name));
  looks_.push_back(look);
}

void HtmlTable::row(const std::vector<HtmlCell>& cells, const std::string& look,
                    const std::string& tip) {
  DEBURR_CHECK(cells.size() == looks_.size(), "a row has a cell for each column");
  body_ += "<tr" + attribute("class", look) + attribute("title", tip) + ">";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const HtmlCell& cell = cells[i];
    const bool named = looks_[i].starts_with("name") || looks_[i].starts_with("mono");
    body_ +=
        fmt::format("<td{}{}>{}{}</td>", attribute("class", joined(looks_[i], cell.look)),
                    attribute("title", cell.tip),
                    named ? breakable(cell.text) : mustache::html_escape(cell.text), cell.html);
  }
  body_ += "</tr>\n";
  ++rows_;
}

void HtmlTable::part(const std::string& name) {
  body_ += fmt::format("<tr><th colspan=\"{}\">{}</th></tr>\n", looks_.size(),
                       mustache::html_escape(name));
}

std::string HtmlTable::html(const std::string& around) const {
  return fmt::format("<div {}><table{}><thead><tr>{}</tr></thead><tbody>\n{}</tbody></table></div>",
                     around, attribute("class", look_), head_, body_);
}

std::string html_of(const std::vector<Tile>& tiles) {
  constexpr std::size_t kRow = 7;
  const std::size_t count = tiles.size();
  std::string html = fmt::format("<div class=\"tiles\" style=\"--columns: {}\">",
                                 count <= kRow ? count : (count + 1) / 2);
  const auto text = [](const std::string& plain) { return mustache::html_escape(plain); };
  for (const Tile& tile : tiles)
    html += fmt::format(
        "\n<div class=\"tile {}\"><div class=\"name\">{}</div><div class=\"value\">{} "
        "<small>{}</small></div><div class=\"note\">{}</div></div>",
        tile.state, text(tile.name), text(tile.value), text(tile.unit), text(tile.note));
  return html + "\n</div>";
}

std::string filled_page(std::string_view content, std::string_view name, mustache::data page,
                        bool with_charts) {
  page.set("content", mustache::partial([content] { return std::string(content); }));
  page.set("style", std::string(embedded::style_css()));
  page.set("charts", with_charts);
  page.set("chart_js", std::string(with_charts ? embedded::chart_js() : ""));
  page.set("kit_js", std::string(embedded::kit_js()));
  page.set("version", build_info().version);
  page.set("commit", build_info().commit);
  mustache::mustache frame{std::string(embedded::page_template())};
  std::string text = frame.render(page);
  DEBURR_CHECK(frame.is_valid(), std::string(name) + ": " + frame.error_message());
  return text;
}

}  // namespace deburr::tool
