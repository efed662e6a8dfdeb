// SPDX-License-Identifier: MIT
#include "rtl_model/fabric/datasheet.h"

#include <fmt/format.h>

#include <algorithm>

#include "spec/error.h"

namespace deburr::rtl {
namespace {

constexpr int kUsualMegahertz = 250;

// Equal except for the cycle counts of this build, where a text replaces them.
bool say_the_same(const Datasheet& a, const Datasheet& b) {
  return a.does == b.does && a.latency.shown() == b.latency.shown() &&
         a.interval.shown() == b.interval.shown() && a.stages == b.stages &&
         a.formats == b.formats && a.cost == b.cost && a.megahertz == b.megahertz;
}

// Text shared with the unit's next variant is printed after that variant.
std::string section(const Datasheet& sheet, bool first, const Datasheet* next) {
  std::string text;
  if (first) text += fmt::format("\n### {}\n\n{}\n", sheet.unit, sheet.does);
  if (!sheet.variant.empty()) text += fmt::format("\n**{}**\n", sheet.variant);
  text += fmt::format("\nLatency: {}; initiation interval: {}.", sheet.latency.shown(),
                      sheet.interval.shown());
  if (sheet.megahertz != kUsualMegahertz) text += fmt::format(" For {} MHz.", sheet.megahertz);
  text += "\n";
  if (!sheet.stages.empty()) {
    text += "\n| stage | work | longest path |\n|---|---|---|\n";
    for (const Stage& stage : sheet.stages)
      text += fmt::format("| {} | {} | {} |\n", stage.clock, stage.work, stage.path);
  }
  if (!sheet.formats.empty() && !(next && next->formats == sheet.formats))
    text += fmt::format("\nFormats: {}\n", sheet.formats);
  if (!sheet.cost.empty() && !(next && next->cost == sheet.cost))
    text += fmt::format("\nCost: {}\n", sheet.cost);
  return text;
}

}  // namespace

std::string title(const Datasheet& sheet) {
  return sheet.variant.empty() ? sheet.unit : sheet.unit + ", " + sheet.variant;
}

std::vector<Datasheet> merged(std::span<const std::vector<Datasheet>> builds) {
  std::vector<Datasheet> all;
  for (const std::vector<Datasheet>& build : builds) {
    auto behind = all.begin();  // after the preceding unit of its build
    for (const Datasheet& sheet : build) {
      const auto same = std::find_if(all.begin(), all.end(), [&](const Datasheet& other) {
        return title(other) == title(sheet);
      });
      DEBURR_CHECK(same == all.end() || say_the_same(*same, sheet),
                   "different datasheets have the same title: " + title(sheet));
      const auto of_unit = [&](const Datasheet& other) { return other.unit == sheet.unit; };
      if (const auto last = std::find_if(all.rbegin(), all.rend(), of_unit); last != all.rend())
        behind = last.base();
      if (same == all.end()) behind = all.insert(behind, sheet) + 1;
    }
  }
  return all;
}

std::string datasheets_markdown(std::span<const Datasheet> sheets) {
  std::string text = "\n| unit | latency | initiation interval |\n|---|---|---|\n";
  for (const Datasheet& sheet : sheets)
    text += fmt::format("| {} | {} | {} |\n", title(sheet), sheet.latency.shown(),
                        sheet.interval.shown());
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    const auto same_unit = [&](std::size_t other) {
      return other < sheets.size() && sheets[other].unit == sheets[i].unit;
    };
    text += section(sheets[i], i == 0 || !same_unit(i - 1),
                    same_unit(i + 1) ? &sheets[i + 1] : nullptr);
  }
  return text;
}

}  // namespace deburr::rtl
