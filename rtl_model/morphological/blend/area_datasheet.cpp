// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/area_unit.h"

namespace deburr::rtl::morphological {
namespace {

using spec::morphological::AreaSource;

constexpr const char* kDoes = "Shares of the pixels across each edge, by its record's line.";

bool has_table(const spec::morphological::Parameters& p) {
  return p.area != AreaSource::kAnalytic && p.area != AreaSource::kLearned;
}

// From the choice of a record to the write back.
std::vector<Stage> stages_of_a_table() {
  return {{"4", "k - a, b - 1 - k; limits, cut shape, addresses of `sqrt_rom`",
           "two 13-bit subtracts, one behind the other, + choice"},
          {"5", "roots, addresses of `area_rom`", "ROM read + 5-bit add"},
          {"6", "entries, differences of neighbours in l", "ROM read + 9-bit subtract"},
          {"7", "first interpolation", "9 x 8 multiply + 17-bit add"},
          {"8", "second, rounding; sides; a beat of diagonals", "18 x 8 multiply + 25-bit add"},
          {"9", "corner factor; diagonal instead; shares, write back", "10 x 8 multiply, choice"}};
}

std::vector<Stage> stages_of_learned_shares() {
  return {
      {"4",
       "pixels to both ends, class of each distance; for each of both sides codes and classes "
       "of the ends as it sees them, the nearer end; addresses of `shares_a`, `_b`, `_c`; beside "
       "it the line's stages 4 to 7",
       "12-bit subtract and compare, choice of two"},
      {"5", "words of the three; A + B", "SRAM read + 9-bit add"},
      {"6", "+ C, limit, address of `share_rom`", "10-bit add, limit"},
      {"7", "share", "ROM read"},
      {"8", "its choice in place of the line's; limits, sides, address of the shares above"},
      {"9", "shares, write back"}};
}

std::vector<Stage> stages_of_a_line() {
  return {{"4", "k x growth", "26 x 12 multiply"},
          {"5", "t at both ends, quantised"},
          {"6", "squares, trapezoid", "12 x 12 multiply"},
          {"7", "triangles", "24 x 24 multiply"},
          {"8", "limits, sides, address of the shares above"},
          {"9", "shares, write back"}};
}

}  // namespace

Datasheet AreaUnit::slot_datasheet(const spec::morphological::Parameters& p) {
  const bool table = has_table(p), learned = p.area == AreaSource::kLearned;
  Datasheet sheet = {
      .unit = "AreaUnit",
      .variant = table     ? "slots, with a table"
                 : learned ? "slots, with learned shares"
                           : "slots",
      .does = kDoes,
      .latency = {9},
      .stages = {{"1", "address of the marks"},
                 {"2", "marks, address of the records", "SRAM read"},
                 {"3", "marks against the raster, k, choice of a record", "SRAM read"}},
      .formats = "t S4.24, q U1.12, a, b S13, shares U0.8.",
      .cost =
          "an axis and lane: a multiplier 26 x 12, two 12 x 12 and two 24 x 24 (triangles); at "
          "the entrance two multipliers 24 x 24; with a table two 18 x 24 more there, and "
          "AreaTable's; with learned shares a 12-bit subtract and SharesRom's; with corners two "
          "10 x 8."};
  const std::vector<Stage> rest = table     ? stages_of_a_table()
                                  : learned ? stages_of_learned_shares()
                                            : stages_of_a_line();
  sheet.stages.insert(sheet.stages.end(), rest.begin(), rest.end());
  return sheet;
}

Datasheet AreaUnit::line_datasheet(const spec::morphological::Parameters& p) {
  Datasheet sheet = {.unit = "AreaUnit",
                     .variant = "lines",
                     .does = kDoes,
                     .latency = {2},
                     .interval = {1, "1 a bank"},
                     .stages = {{"1", "choice of a line a bank, two products", "24 x 24 multiply"},
                                {"2", "t at the first edge, store"}}};
  if (has_table(p)) {
    sheet.variant = "lines, with a table";
    sheet.latency = {3};
    sheet.stages = {{"1", "choice of a line a bank, two products", "24 x 24 multiply"},
                    {"2", "t at the first edge"},
                    {"3", "a and b, store", "two 18 x 24 multiplies"}};
  }
  return sheet;
}

}  // namespace deburr::rtl::morphological
