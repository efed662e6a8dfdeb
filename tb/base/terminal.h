// SPDX-License-Identifier: MIT
// Fits text to the width of the terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace deburr::tb {

// Width from the terminal, else from the variable COLUMNS, else 80.
std::size_t terminal_columns(int descriptor);

// Whether control sequences may be written: a terminal, and TERM is set and not "dumb".
bool takes_control_sequences(int descriptor);

// Columns available for lines on standard output; 0 if it is not a terminal, so lines are not
// limited. The last column stays free, because some terminals start a new line once it is filled.
std::size_t output_columns();

// Counts each character as one column.
std::size_t columns_of(std::string_view text);

// Wraps each line at blanks to at most `columns`; 0: no wrapping. Continuation rows start at column
// `indent`, or at half of the width if that is less. A longer word stays whole, so that a path can
// be copied.
std::string wrapped(std::string_view text, std::size_t columns, std::size_t indent);

// Prints to standard output.
inline constexpr std::size_t kAfterLabel = 12;  // "rate        "
void print_wrapped(std::string_view text, std::size_t indent = kAfterLabel);

// A table row that is too wide for one line: its first cell, and the others below it. `titles`
// are those of the columns; empty cells are omitted.
std::string row_in_lines(const std::vector<std::string>& row,
                         const std::vector<std::string>& titles, std::size_t columns);

}  // namespace deburr::tb
