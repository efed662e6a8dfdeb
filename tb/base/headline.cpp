// SPDX-License-Identifier: MIT
#include "tb/base/headline.h"

#include <algorithm>

namespace deburr::tb {

std::string headline(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  text = text.substr(0, text.find("\n\n"));
  std::string line;
  while (!text.empty()) {
    std::string_view part = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), part.size() + 1));
    part.remove_prefix(std::min(part.size(), part.find_first_not_of(kBlank)));
    part = part.substr(0, part.find_last_not_of(kBlank) + 1);
    if (part.empty()) continue;
    if (!line.empty()) line += line.back() == ':' || line.back() == ',' ? " " : ", ";
    line += part;
  }
  return line;
}

}  // namespace deburr::tb
