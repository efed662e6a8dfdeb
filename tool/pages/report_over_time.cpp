// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>

#include "spec/error.h"
#include "tb/base/file.h"
#include "tb/base/json_text.h"
#include "tb/run/amount.h"
#include "tool/pages/report_parts.h"

namespace deburr::tool {
namespace {

namespace fs = std::filesystem;
namespace mustache = kainjow::mustache;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxIntervalsBytes = 64u << 20;

}  // namespace

Json fill_over_time(const ReportSource& source, mustache::data& page) {
  const std::string name = source.manifest.value("records", Json::object()).value("intervals", "");
  page.set("has_intervals", !name.empty());
  if (name.empty()) return Json();
  reject_path(source.directory, name);
  const fs::path file = source.directory / name;
  Json intervals = tb::try_parse_json(tb::read_file(file, kMaxIntervalsBytes));
  const auto demand = [&](bool valid) {
    if (!valid)
      throw spec::FileError(fmt::format("'{}' is not a valid file of intervals", file.string()));
  };
  demand(intervals.is_object());
  for (const char* key :
       {"series", "from", "cycles", "interval_cycles", "asked_cycles", "throughput"})
    demand(intervals.contains(key));
  intervals["command"] = without_options(source.manifest.value("command", ""),
                                         {"--trace", "--trace-from", "--trace-to"});
  page.set("intervals_command", intervals["command"].get<std::string>());
  intervals.erase("units");
  // From here on no key of `intervals` may be added or erased, since this would move its values.
  Json& series = intervals["series"];
  demand(series.is_object() && series.contains("work") && series["work"].is_object());
  const std::size_t count = intervals["from"].size();
  const auto column = [&](const Json& values) {
    demand(values.is_array() && values.size() == count);
    for (const Json& value : values) demand(value.is_number_unsigned());
    return values.get<std::vector<std::uint64_t>>();
  };
  const std::vector<std::uint64_t> from = column(intervals["from"]),
                                   cycles = column(intervals["cycles"]);
  page.set("intervals_note",
           fmt::format(
               "{} intervals of {} cycles{}.", tb::grouped(from.size()),
               report_text(intervals["interval_cycles"]),
               intervals["interval_cycles"] == intervals["asked_cycles"]
                   ? ""
                   : fmt::format("; intervals of {} cycles were requested, which would be too many",
                                 report_text(intervals["asked_cycles"]))));

  // A rate is a series divided by cycles.
  std::vector<std::vector<std::uint64_t>> columns;
  HtmlTable table("Cycles", "narrow");
  Json kept = Json::object();
  for (const Json& rate : intervals["throughput"]) {
    const std::string key = rate.value("key", "");
    const std::string counter = key.substr(key.find('.') + 1);
    if (!series["work"].contains(counter)) continue;
    kept[counter] = series["work"][counter];
    columns.push_back(column(kept[counter]));
    table.column(rate.value("label", "") + ", " + rate.value("unit", ""), "n");
  }
  const Json of_ports = series.value("ports", Json::object());
  for (const auto& [port, values] : of_ports.items()) {
    columns.push_back(column(values.value("outstanding", Json())));
    table.column(port + ": in flight, mean", "n");
    for (const char* bytes : {"_bytes_read", "_bytes_written"})
      if (series["work"].contains(port + bytes)) kept[port + bytes] = series["work"][port + bytes];
  }
  series["work"] = kept;  // the only part that the page uses
  page.set("has_ports", !of_ports.empty());
  for (std::size_t i = 0; i < from.size(); ++i) {
    std::vector<HtmlCell> cells{HtmlCell::link(
        fmt::format("#interval-{}", i),
        fmt::format("{} to {}", tb::grouped(from[i]), tb::grouped(from[i] + cycles[i])))};
    for (const std::vector<std::uint64_t>& counts : columns)
      cells.emplace_back(fmt::format(
          "{:.3f}", static_cast<double>(counts.at(i)) / static_cast<double>(cycles[i])));
    table.row(cells);
  }
  page.set("intervals", table.html());

  HtmlTable links(
      "Link:name|Waveform:name mono muted|Depth:n|Beats:n|Mean:n|Maximum:n|Full, % of cycles:n");
  const Json of_links = source.result.value("links", Json::object());
  for (const auto& [link, figures] : of_links.items())
    links.row({link, figures.value("link", ""), report_text(figures, "depth"),
               report_text(figures, "beats"), fmt::format("{:.2f}", number(figures, "mean")),
               report_text(figures, "most"),
               fmt::format("{:.1f}", number(figures, "full_percent"))});
  page.set("links", links.html());
  return intervals;
}

}  // namespace deburr::tool
