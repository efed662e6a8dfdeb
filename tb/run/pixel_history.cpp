// SPDX-License-Identifier: MIT
#include "tb/run/pixel_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "spec/error.h"

namespace deburr::tb {
namespace {

constexpr std::size_t kMostRows = 40;  // of the terminal output

std::optional<int> whole_number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 0) return std::nullopt;
  return value;
}

std::string or_dash(const std::string& text) { return text.empty() ? "-" : text; }

}  // namespace

PixelAddress pixel_of(const std::string& text) {
  const std::size_t comma = text.find(',');
  const std::string_view all = text;
  const std::optional<int> x = whole_number(all.substr(0, comma));
  const std::optional<int> y =
      comma == std::string::npos ? std::nullopt : whole_number(all.substr(comma + 1));
  if (!x || !y)
    throw spec::ConfigError(
        fmt::format("run.pixel: expected X,Y, two whole numbers such as 12,7 (column from the "
                    "left, row from the top), got '{}'",
                    text));
  return {*x, *y};
}

void reject_outside(const PixelAddress& pixel, int width, int height) {
  if (pixel.x < width && pixel.y < height) return;
  throw spec::ConfigError(
      fmt::format("run.pixel = {},{} is outside of the picture of {} x {} pixels: give a column of "
                  "0..{} and a row of 0..{}",
                  pixel.x, pixel.y, width, height, width - 1, height - 1));
}

void PixelHistory::compare(PixelStep step) {
  step.differs = !step.golden.empty() && !step.hardware.empty() && step.golden != step.hardware;
  steps.push_back(std::move(step));
}

void PixelHistory::compare(PixelStep step, const PixelSides& came) {
  step.differs = step.golden.empty()     ? came.golden && !step.hardware.empty()
                 : step.hardware.empty() ? came.hardware
                                         : step.golden != step.hardware;
  steps.push_back(std::move(step));
}

void PixelHistory::compare_records(std::size_t golden, std::size_t hardware,
                                   const std::function<bool(std::size_t, std::size_t)>& same,
                                   const std::function<PixelStep(Record, Record)>& row,
                                   const PixelSides& came) {
  std::size_t g = 0, h = 0;
  while (g < golden || h < hardware) {
    Record mine = g < golden ? Record(g) : std::nullopt;
    Record its = h < hardware ? Record(h) : std::nullopt;
    bool differs = mine ? its || came.hardware : came.golden;
    if (mine && its) {
      differs = !same(g, h);
      // The nearest match with the other side's next record shows which side lacks one.
      std::size_t lost = 0, added = 0;
      while (g + lost < golden && !same(g + lost, h)) ++lost;
      while (h + added < hardware && !same(g, h + added)) ++added;
      const bool may_lose = g + lost < golden, may_add = h + added < hardware;
      if (differs && may_lose && (!may_add || lost <= added))
        its.reset();
      else if (differs && may_add) {
        mine.reset();
        differs = came.golden;
      }
    }
    if (mine) ++g;
    if (its) ++h;
    PixelStep step = row(mine, its);
    step.differs = differs;
    steps.push_back(std::move(step));
  }
}

void PixelHistory::append(const PixelHistory& other) {
  steps.insert(steps.end(), other.steps.begin(), other.steps.end());
  if (!other.note.empty()) note += (note.empty() ? "" : "; ") + other.note;
}

std::size_t PixelHistory::differences() const {
  return static_cast<std::size_t>(
      std::count_if(steps.begin(), steps.end(), [](const PixelStep& s) { return s.differs; }));
}

std::string text_of(const PixelHistory& history, const std::string& report) {
  std::string text =
      fmt::format("pixel       ({}, {}): {} steps, {} of them differ from the golden model{}{}\n",
                  history.pixel.x, history.pixel.y, history.steps.size(), history.differences(),
                  history.note.empty() ? "" : ": ", history.note);
  std::vector<const PixelStep*> rows;
  for (const PixelStep& step : history.steps)
    if (!step.detail || step.differs) rows.push_back(&step);
  // Steps that differ are taken first; other steps fill the remaining rows.
  std::size_t room = kMostRows - std::min(kMostRows, history.differences());
  std::erase_if(rows, [&](const PixelStep* row) {
    if (row->differs) return false;
    if (room == 0) return true;
    --room;
    return false;
  });
  if (rows.size() > kMostRows) rows.resize(kMostRows);
  std::size_t item = 4, golden = 6, hardware = 8;
  for (const PixelStep* row : rows) {
    item = std::max(item, row->step.size() + row->item.size() + 1);
    golden = std::max(golden, row->golden.size());
    hardware = std::max(hardware, row->hardware.size());
  }
  if (!rows.empty())
    text += fmt::format("  {:<{}}  {:<{}}  {:<{}}  {:>9}\n", "step", item, "golden", golden,
                        "hardware", hardware, "cycle");
  std::string part;
  for (const PixelStep* row : rows) {
    if (row->part != part) text += fmt::format("  {}\n", part = row->part);
    text += fmt::format("{} {:<{}}  {:<{}}  {:<{}}  {:>9}\n", row->differs ? '!' : ' ',
                        row->step + " " + row->item, item, or_dash(row->golden), golden,
                        or_dash(row->hardware), hardware,
                        row->clock ? fmt::format("{}", *row->clock) : "-");
  }
  if (rows.size() < history.steps.size())
    text += fmt::format("  {} more steps: {}#pixel\n", history.steps.size() - rows.size(), report);
  return text;
}

}  // namespace deburr::tb
