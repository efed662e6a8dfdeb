// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "tool/pages/report_parts.h"

namespace deburr::tool {
namespace {

using Json = nlohmann::ordered_json;

// "X,Y" of an item called "pixel (X, Y)"; empty for any other item.
std::string pixel_in(const std::string& item) {
  constexpr std::string_view kBegin = "pixel (";
  const std::size_t begin = item.find(kBegin), end = item.find(')', begin);
  if (begin == std::string::npos || end == std::string::npos) return "";
  std::string pixel = item.substr(begin + kBegin.size(), end - begin - kBegin.size());
  std::erase(pixel, ' ');
  return pixel;
}

HtmlCell history_of(const std::string& pixel, const std::string& followed) {
  if (pixel.empty()) return "";
  if (pixel == followed) return HtmlCell::link("#pixel", "below");
  return HtmlCell("").add(
      fmt::format(R"(<a class="needs-js" href="#follow-{}">copy its command</a>)", pixel));
}

void fill_mismatches(const ReportSource& source, const std::string& followed, bool has_history,
                     kainjow::mustache::data& page) {
  HtmlTable table("Check|Where|Item|Field:mono|Expected|Got");
  if (has_history) table.column("History");
  for (const Json& m : source.result.value("first_mismatches", Json::array())) {
    std::vector<HtmlCell> cells;
    for (const char* key : {"check", "where", "item", "field", "expected", "got"})
      cells.emplace_back(m.value(key, ""));
    if (has_history) cells.push_back(history_of(pixel_in(m.value("item", "")), followed));
    table.row(cells);
  }
  page.set("has_mismatches", table.rows() > 0);
  page.set("mismatches", table.html());
}

}  // namespace

void fill_pixel(const ReportSource& source, kainjow::mustache::data& page) {
  const bool has_history = source.manifest.value("pixel_history", false);
  page.set("has_history", has_history);
  const std::string command = without_options(source.manifest.value("command", ""),
                                              {"--pixel", "--trace", "--trace-from", "--trace-to"});
  page.set("pixel_command", command);
  const auto found = source.result.find("pixel");
  page.set("has_pixel", found != source.result.end());
  if (found == source.result.end()) return fill_mismatches(source, "", has_history, page);
  const std::string pixel = fmt::format("{:.0f},{:.0f}", number(*found, "x"), number(*found, "y"));
  fill_mismatches(source, pixel, has_history, page);
  page.set("pixel", pixel);
  if (const std::string note = found->value("note", ""); !note.empty())
    page.set("pixel_note", note);
  page.set("pixel_differences", report_text(*found, "differences"));
  HtmlTable steps("Step:name|Value:name|Golden:mono|Hardware:mono|Cycle:n", "history");
  std::string part;
  std::optional<std::uint64_t> first, last;
  for (const Json& step : found->value("steps", Json::array())) {
    if (const std::string own = step.value("part", ""); own != part) {
      part = own;
      steps.part(own);
    }
    const auto or_dash = [&](const char* key) {
      const std::string text = step.value(key, "");
      return text.empty() ? "-" : text;
    };
    steps.row({step.value("step", ""), step.value("item", ""), or_dash("golden"),
               or_dash("hardware"), report_text(step, "clock")},
              step.value("differs", false) ? "differs" : "");
    if (const Json clock = step.value("clock", Json()); clock.is_number_unsigned()) {
      const auto cycle = clock.get<std::uint64_t>();
      first = std::min(first.value_or(cycle), cycle);
      last = std::max(last.value_or(cycle), cycle);
    }
  }
  page.set("has_pixel_steps", steps.rows() > 0);
  page.set(
      "pixel_steps",
      steps.html(
          R"(class="scroll tall" tabindex="0" role="region" aria-label="Steps of the pixel")"));
  if (first)
    page.set("pixel_waves", fmt::format("{} --pixel {} --trace '*' --trace-from {} --trace-to {}",
                                        command, pixel, *first, *last + 2));
}

}  // namespace deburr::tool
