// SPDX-License-Identifier: MIT
#include "rtl_model/fabric/datasheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "spec/error.h"

namespace deburr::rtl {
namespace {

constexpr int kUsualMegahertz = 250;

std::string listed(std::span<const Operator> operators) {
  std::string text;
  for (const Operator& one : operators)
    if (one.count > 0) text += (text.empty() ? "" : ", ") + counted(one);
  return text;
}

// "multiply 23 x 23 (2); add 38 (28); 310 flip-flops"
std::string hardware_text(std::span<const Operator> operators, std::uint64_t registers) {
  std::string text = by_kind(operators);
  if (registers > 0) text += fmt::format("{}{} flip-flops", text.empty() ? "" : "; ", registers);
  return text;
}

void append_stages(const Datasheet& sheet, std::vector<Operator>& operators) {
  for (const Stage& stage : sheet.stages)
    for (const Operator& one : stage.operators) operators.push_back(stage.clocks() * one);
}

std::uint64_t stage_registers(const Datasheet& sheet) {
  std::uint64_t bits = 0;
  for (const Stage& stage : sheet.stages) bits += std::uint64_t{stage.clocks()} * stage.registers;
  return bits;
}

std::string cost_text(const Datasheet& sheet) {
  std::vector<Operator> operators;
  append_stages(sheet, operators);
  std::string text = hardware_text(operators, stage_registers(sheet));
  if (!text.empty() && !sheet.per.empty()) text = "per " + sheet.per + ": " + text;
  if (const std::string once = hardware_text(sheet.shared, sheet.shared_registers); !once.empty())
    text += (text.empty() ? "" : ". Once: ") + once;
  if (text.empty()) return sheet.cost;
  return text + (sheet.cost.empty() ? "." : ". " + sheet.cost);
}

std::string path_text(const Stage& stage) {
  std::string text = listed(stage.longest);
  return stage.path + (text.empty() || stage.path.empty() ? "" : ": ") + text;
}

// Equal except for the cycle counts of this build, where a text replaces them.
bool say_the_same(const Datasheet& a, const Datasheet& b) {
  return a.does == b.does && a.latency.shown() == b.latency.shown() &&
         a.interval.shown() == b.interval.shown() && a.stages == b.stages &&
         a.formats == b.formats && cost_text(a) == cost_text(b) && a.megahertz == b.megahertz;
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
      text += fmt::format("| {} | {} | {} |\n", stage.clock, stage.work, path_text(stage));
  }
  if (!sheet.formats.empty() && !(next && next->formats == sheet.formats))
    text += fmt::format("\nFormats: {}\n", sheet.formats);
  const std::string cost = cost_text(sheet);
  if (!cost.empty() && !(next && cost_text(*next) == cost)) text += "\nCost: " + cost + "\n";
  return text;
}

}  // namespace

std::uint32_t Stage::clocks() const {
  const std::size_t dash = clock.find('-');
  if (dash == std::string::npos)  // "3, 4"
    return static_cast<std::uint32_t>(1 + std::count(clock.begin(), clock.end(), ','));
  return static_cast<std::uint32_t>(std::atoi(clock.c_str() + dash + 1) - std::atoi(clock.c_str()) +
                                    1);
}

std::vector<Operator> operators_of(const Datasheet& sheet) {
  std::vector<Operator> operators;
  append_stages(sheet, operators);
  for (Operator& one : operators) one.count *= sheet.copies;
  operators.insert(operators.end(), sheet.shared.begin(), sheet.shared.end());
  return summed(operators);
}

std::uint64_t registers_of(const Datasheet& sheet) {
  return sheet.copies * stage_registers(sheet) + sheet.shared_registers;
}

std::string instance_name(const Datasheet& sheet) {
  constexpr std::string_view kWide = "Wide";
  std::string name;
  for (const char c : sheet.unit.substr(sheet.unit.starts_with(kWide) ? kWide.size() : 0)) {
    if (std::isupper(static_cast<unsigned char>(c)) && !name.empty()) name += '_';
    name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return name;
}

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
