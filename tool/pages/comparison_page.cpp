// SPDX-License-Identifier: MIT
#include "tool/pages/comparison_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "spec/error.h"
#include "tb/run/amount.h"
#include "tb/run/result.h"
#include "tool/pages/build_info.h"
#include "tool/pages/compare.h"
#include "tool/pages/embedded.h"
#include "tool/pages/page_template.h"
#include "tool/pages/report.h"

namespace deburr::tool {
namespace {

namespace fs = std::filesystem;
namespace mustache = kainjow::mustache;
using Json = nlohmann::ordered_json;

std::string text_of(const Json& value) { return value.is_null() ? "" : value_text(value); }

// Counts grouped, anything else as it is.
std::string figure_text(const Json& value) {
  if (value.is_number_unsigned()) return tb::grouped(value.get<std::uint64_t>());
  if (value.is_number_integer() && value.get<std::int64_t>() >= 0)
    return tb::grouped(value.get<std::uint64_t>());
  if (value.is_number_float() && !tb::is_infinite(value)) return tb::amount(value.get<double>(), 5);
  return value_text(value);
}

mustache::data cell(const std::string& text, const std::string& note = "",
                    const std::string& state = "") {
  mustache::data data;
  data.set("text", text);
  data.set("note", note);
  data.set("state", state);
  return data;
}

class ComparisonPage {
 public:
  explicit ComparisonPage(const Json& comparison) : comparison_(comparison) {}

  std::string render() {
    const bool runs = comparison_.at("kind") == "runs";
    page_.set("is_runs", runs);
    page_.set("is_sweeps", !runs);
    page_.set("kind", runs ? "runs" : "sweeps");
    page_.set("engine", text_of(comparison_.at("engine")));
    page_.set("worse", comparison_.at("worse").get<bool>());
    fill_warnings();
    runs ? fill_runs() : fill_sweeps();
    page_.set("style", std::string(embedded::style_css()));
    page_.set("chart_js", runs ? std::string() : embedded::charts());
    page_.set("comparison_js", std::string(embedded::comparison_js()));
    page_.set("data", json_for_script(runs ? Json{{"kind", "runs"}} : comparison_));
    page_.set("version", build_info().version);
    page_.set("commit", build_info().commit);
    return filled_page(embedded::comparison_template(), "comparison.mustache", page_);
  }

 private:
  void fill_warnings() {
    mustache::data warnings{mustache::data::type::list};
    for (const Json& warning : comparison_.at("warnings")) warnings << cell(text_of(warning));
    page_.set("warnings", warnings);
  }

  // Name, what it is, what came of it; the columns of every table.
  void fill_inputs(const Json& inputs, const char* what) {
    mustache::data list{mustache::data::type::list};
    for (const Json& input : inputs) {
      mustache::data data;
      data.set("name", text_of(input.at("name")));
      data.set("path", text_of(input.at("path")));
      data.set("title", text_of(input.at("title")));
      data.set("summary", text_of(input.value(what, Json())));
      data.set("command", text_of(input.value("command", Json())));
      data.set("state", text_of(input.value("verdict", Json())));
      data.set("is_base", &input == &inputs.front());
      list << data;
    }
    page_.set("inputs", list);
    std::string title;
    for (const Json& input : inputs)
      title +=
          (title.empty() ? "" : ", ") + fs::path(text_of(input.at("path"))).filename().string();
    page_.set("title", title);
  }

  void fill_parameters() {
    mustache::data rows{mustache::data::type::list};
    for (const Json& parameter : comparison_.at("parameters")) {
      mustache::data row;
      row.set("name", text_of(parameter.at("name")));
      row.set("unit", text_of(parameter.value("unit", Json())));
      row.set("meaning", text_of(parameter.value("meaning", Json())));
      mustache::data cells{mustache::data::type::list};
      for (const Json& value : parameter.at("values"))
        cells << cell(text_of(value), "", value == parameter.at("values").front() ? "" : "other");
      row.set("cells", cells);
      rows << row;
    }
    page_.set("has_parameters", rows.is_non_empty_list());
    page_.set("parameters", rows);
  }

  // ---- runs -------------------------------------------------------------------------------------

  void fill_runs() {
    fill_inputs(comparison_.at("runs"), "summary");
    fill_parameters();
    page_.set("figures", rows_of(comparison_.at("figures"), true));
    const mustache::data values = rows_of(comparison_.at("values"), false);
    page_.set("has_values", values.is_non_empty_list());
    page_.set("values_count", std::to_string(values.list_value().size()));
    page_.set("values", values);
    fill_tiles(comparison_.at("runs"));
    fill_pictures();
  }

  // Of each run but the first: what became better and worse.
  void fill_tiles(const Json& runs) {
    mustache::data tiles{mustache::data::type::list};
    for (std::size_t i = 1; i < runs.size(); ++i) {
      std::string better, worse;
      for (const Json& figure : comparison_.at("figures")) {
        const Json& checked = figure.at("cells").at(i);
        const std::string state = checked.value("judgement", "");
        std::string& list = state == "better" ? better : worse;
        if (state != "better" && state != "worse") continue;
        const std::string change = checked.value("change", "");
        list += (list.empty() ? "" : ", ") + figure.at("label").get<std::string>() +
                (change.empty() ? "" : " " + change);
      }
      mustache::data tile;
      tile.set("name", text_of(runs[i].at("name")) + " against " + text_of(runs[0].at("name")));
      tile.set("better", better.empty() ? "nothing" : better);
      tile.set("worse", worse.empty() ? "nothing" : worse);
      tiles << tile;
    }
    page_.set("tiles", tiles);
    page_.set("tile_columns", runs.size() > 2 ? "2" : "1");
  }

  static mustache::data rows_of(const Json& figures, bool bars) {
    mustache::data rows{mustache::data::type::list};
    for (const Json& figure : figures) {
      mustache::data row;
      const std::string key = figure.at("key").get<std::string>();
      row.set("name", figure.value("label", key));
      row.set("unit", text_of(figure.value("unit", Json())));
      row.set("meaning", text_of(figure.value("meaning", Json())));
      double most = 0;
      for (const Json& entry : figure.at("cells"))
        if (const auto value = as_number(entry.at("value")); value && std::isfinite(*value))
          most = std::max(most, std::fabs(*value));
      mustache::data cells{mustache::data::type::list};
      for (const Json& entry : figure.at("cells")) {
        const std::string verdict = entry.value("judgement", "");
        const bool worse = entry.value("worse", false);
        mustache::data data = cell(entry.value("identical", false) ? entry.value("text", "")
                                                                   : figure_text(entry.at("value")),
                                   entry.value("change", ""), worse ? "worse fails" : verdict);
        const auto value = as_number(entry.at("value"));
        // A share of decibels says nothing.
        data.set("has_bar",
                 bars && !in_decibels(key) && value && most > 0 && std::isfinite(*value));
        if (value && most > 0)
          data.set("percent", fmt::format("{:.1f}", 100 * std::fabs(*value) / most));
        cells << data;
      }
      row.set("cells", cells);
      rows << row;
    }
    return rows;
  }

  // A row a role, in the order of the runs' lists, a column a run.
  void fill_pictures() {
    const Json& runs = comparison_.at("runs");
    std::vector<std::string> roles;
    const auto images = [](const Json& run) {
      return run.at("images").is_array() ? run.at("images") : Json::array();
    };
    for (const Json& run : runs)
      for (const Json& image : images(run))
        if (const std::string role = image.value("role", "");
            std::find(roles.begin(), roles.end(), role) == roles.end())
          roles.push_back(role);
    // What came out is what one wants to see first.
    std::stable_partition(roles.begin(), roles.end(),
                          [](const std::string& role) { return role == "after"; });
    mustache::data list{mustache::data::type::list};
    for (const std::string& role : roles) {
      mustache::data row, cells{mustache::data::type::list};
      std::string title = role;
      for (const Json& run : runs) {
        mustache::data data;
        data.set("name", text_of(run.at("name")));
        data.set("has_picture", false);
        const Json all = images(run);
        for (const Json& image : all) {
          if (image.value("role", "") != role) continue;
          const fs::path file = image.value("file", "");
          if (file.empty() || file.has_parent_path())
            throw spec::FileError(fmt::format("'{}': image '{}' is not a file name",
                                              text_of(run.at("folder")), file.string()));
          title = image.value("title", role);
          data.set("has_picture", true);
          data.set("caption", image.value("caption", ""));
          data.set("source", data_uri(fs::path(text_of(run.at("folder"))) / file));
        }
        cells << data;
      }
      row.set("role", role);
      row.set("title", title);
      row.set("cells", cells);
      list << row;
    }
    page_.set("has_pictures", list.is_non_empty_list());
    page_.set("pictures", list);
  }

  // ---- sweeps -----------------------------------------------------------------------------------

  void fill_sweeps() {
    Json sweeps = comparison_.at("sweeps");
    for (Json& sweep : sweeps) {
      const Json& counts = sweep.at("counts");
      std::string text = fmt::format(
          "{} points, {} done, {} on its front", figure_text(counts.value("points", Json(0))),
          figure_text(counts.value("done", Json(0))), figure_text(counts.value("front", Json(0))));
      if (sweep.contains("joint_front"))
        text += fmt::format(", {} on the front of all together", figure_text(sweep["joint_front"]));
      sweep["summary"] = text;
    }
    fill_inputs(sweeps, "summary");
    fill_parameters();
    page_.set("matched", tb::grouped(comparison_.at("points").size()));
    page_.set("only", tb::grouped(comparison_.at("only").size()));
    page_.set("has_only", !comparison_.at("only").empty());
    std::string axes;
    for (const Json& axis : comparison_.at("axes"))
      axes += (axes.empty() ? "" : ", ") + text_of(axis);
    page_.set("axes", axes);
    mustache::data rows{mustache::data::type::list};
    const Json& metrics = comparison_.at("metrics");
    for (std::size_t i = 0; i < comparison_.at("summary").size(); ++i)
      for (std::size_t m = 0; m < metrics.size(); ++m) {
        const Json& sum = comparison_.at("summary")[i][m];
        mustache::data row;
        row.set("sweep", text_of(sweeps[i + 1].at("name")));
        row.set("metric", text_of(metrics[m].at("name")));
        row.set("unit", text_of(metrics[m].at("unit")));
        row.set("meaning", text_of(metrics[m].at("meaning")));
        const bool has_direction = !metrics[m].at("maximise").is_null();
        for (const char* key : {"better", "equal", "worse"})
          row.set(key, has_direction ? figure_text(sum.at(key)) : "-");
        row.set("state", sum.at("worse") != 0 ? "worse" : "");
        for (const char* key : {"mean", "least", "most"})
          row.set(key, sum.contains(key) ? fmt::format("{:+.2f} {}", sum[key].get<double>(),
                                                       sum["unit"].get<std::string>())
                                         : "-");
        rows << row;
      }
    page_.set("summary", rows);
  }

  const Json& comparison_;
  mustache::data page_;
};

}  // namespace

std::string comparison_page(const Json& comparison) { return ComparisonPage(comparison).render(); }

}  // namespace deburr::tool
