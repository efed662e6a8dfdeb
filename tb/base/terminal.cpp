// SPDX-License-Identifier: MIT
#include "tb/base/terminal.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>

namespace deburr::tb {
namespace {

constexpr std::size_t kUsualColumns = 80;

bool begins_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }

// Wraps one line, without its newline.
void wrap_line(std::string_view line, std::size_t columns, std::size_t indent, std::string& out) {
  std::size_t column = 0;
  bool begun = false;  // the row already has a word
  while (!line.empty()) {
    const std::size_t found = std::min(line.find_first_not_of(' '), line.size());
    const std::size_t blanks = begun ? found : std::min(found, indent);
    line.remove_prefix(found - blanks);
    const std::size_t end = std::min(line.find(' ', blanks), line.size());
    const std::string_view word = line.substr(blanks, end - blanks);
    const std::size_t width = columns_of(word);
    if (begun && column + blanks + width > columns) {
      out += '\n';
      out.append(indent, ' ');
      column = indent;
    } else {
      out.append(blanks, ' ');
      column += blanks;
    }
    out += word;
    column += width;
    begun = begun || width > 0;
    line.remove_prefix(end);
  }
}

}  // namespace

std::size_t terminal_columns(int descriptor) {
  winsize size{};
  if (::ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  std::size_t columns = 0;
  if (const char* const said = std::getenv("COLUMNS"))
    std::from_chars(said, said + std::strlen(said), columns);
  return columns > 0 ? columns : kUsualColumns;
}

bool takes_control_sequences(int descriptor) {
  const char* const kind = std::getenv("TERM");
  return ::isatty(descriptor) == 1 && kind != nullptr && *kind != '\0' &&
         std::string_view(kind) != "dumb";
}

std::size_t output_columns() {
  if (::isatty(STDOUT_FILENO) != 1) return 0;
  return std::max<std::size_t>(terminal_columns(STDOUT_FILENO), 2) - 1;
}

std::size_t columns_of(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), begins_character));
}

std::string wrapped(std::string_view text, std::size_t columns, std::size_t indent) {
  if (columns == 0) return std::string(text);
  // In a narrow terminal half of the width is reserved for text.
  const std::size_t inside = std::min(indent, columns / 2);
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    if (columns_of(line) <= columns)
      out += line;
    else
      wrap_line(line, columns, inside, out);
    if (end < text.size()) out += '\n';
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

std::string row_in_lines(const std::vector<std::string>& row,
                         const std::vector<std::string>& titles, std::size_t columns) {
  constexpr std::size_t kIndent = 4;
  std::string others;
  for (std::size_t i = 1; i < row.size(); ++i) {
    if (row[i].empty()) continue;
    others += others.empty() ? std::string(kIndent, ' ') : "  ";
    if (i < titles.size() && !titles[i].empty()) others += titles[i] + " ";
    others += row[i];
  }
  std::string text = row[0].empty() ? "" : wrapped(row[0], columns, 2) + "\n";
  if (!others.empty()) text += wrapped(others, columns, kIndent) + "\n";
  return text;
}

void print_wrapped(std::string_view text, std::size_t indent) {
  fmt::print("{}", wrapped(text, output_columns(), indent));
}

}  // namespace deburr::tb
