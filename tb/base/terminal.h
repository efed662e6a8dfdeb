// SPDX-License-Identifier: MIT
// Lines as wide as the terminal that shows them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace deburr::tb {

// What the terminal says, then the variable COLUMNS, else 80.
std::size_t terminal_columns(int descriptor);

// The columns that lines on standard output may fill; 0, where it is no terminal: as many as they
// like. The last column stays free: a terminal that has filled it may begin the next line.
std::size_t output_columns();

// A character is one column.
std::size_t columns_of(std::string_view text);

// Each line of the text broken at blanks, so that it fills at most so many columns; 0: as it is.
// What is broken off begins at column `indent`, or in the middle where that is less. A word that is
// wider stays whole, so that a path can be copied.
std::string wrapped(std::string_view text, std::size_t columns, std::size_t indent);

// To standard output.
inline constexpr std::size_t kAfterLabel = 12;  // "rate        "
void print_wrapped(std::string_view text, std::size_t indent = kAfterLabel);

// A row of a table that is too wide: its first cell, and below it the others. `titles`: of the
// columns; empty ones are left out.
std::string row_in_lines(const std::vector<std::string>& row,
                         const std::vector<std::string>& titles, std::size_t columns);

}  // namespace deburr::tb
