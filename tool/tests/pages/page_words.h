// SPDX-License-Identifier: MIT
// The text of a page that a run or a comparison writes.
#pragma once

#include <regex>
#include <string>

namespace deburr::tool {

// The visible text, one line per row, with "|" between separate items; of the attributes only those
// that hold page content.
inline std::string words(std::string page) {
  const auto replaced = [&page](const char* what, const char* by) {
    page = std::regex_replace(page, std::regex(what), by);
  };
  page.erase(0, page.find("<body>"));
  replaced("<wbr>", "");
  page.erase(page.find("<footer"));
  replaced("<(script|noscript|select|button)\\b[^>]*>[^<]*</\\1>", "");
  replaced("<(tr|h1|h2|h3|p|pre|figure|div class=\"tile\\b|a href=\"#checks)", "\n<$1");
  replaced("data:image/png;base64,[^\"]*", "PNG");
  replaced(
      "<[^>]* (title|class)=\"(tile [a-z]*|badge "
      "[a-z]*|differs|changed|flat|tall|part|[A-Z][^\"]*)\"",
      "|$2<");
  replaced("<[^>]* class=\"(?:n )?(better|equal|worse|worse fails|other)\"", "|$1<");
  replaced("<[^>]*style=\"(--ratio[^\"]*|--columns[^\"]*|width: [^\"]*)\"", "|$1<");
  replaced("<[^>]*href=\"(#follow[^\"]*|[a-z_]+\\.pfm)\"", "|$1<");
  replaced(
      "<[^>]*src=\"([^\"]*)\" alt=\"([^\"]*)\"(?: data-title=\"([^\"]*)\" data-role=\"([^\"]*)\")?",
      "|$1|$2|$3|$4<");
  replaced("<[^>]*>", "|");
  replaced("\\. (?=[A-Z0-9]|\\|Click)", ".\n");
  replaced("([;:]) (?=[a-z])", "$1\n");
  replaced("[ \t]*\n[ \t\n|]*", "\n");
  replaced("\\|[| ]*", "|");
  replaced(" ?\\|", "|");
  replaced("\\|\n", "\n");
  return page;
}

}  // namespace deburr::tool
