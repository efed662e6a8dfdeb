// SPDX-License-Identifier: MIT
#include "tool/pages/comparison_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "spec/error.h"
#include "tb/run/amount.h"
#include "tb/run/result.h"
#include "tool/pages/compare.h"
#include "tool/pages/embedded.h"
#include "tool/pages/page.h"
#include "tool/pages/report.h"

namespace deburr::tool {
namespace {

namespace fs = std::filesystem;
namespace mustache = kainjow::mustache;
using Json = nlohmann::ordered_json;

std::string text_of(const Json& value) { return value.is_null() ? "" : value_text(value); }

// Groups the digits of counts; other values are unchanged.
std::string figure_text(const Json& value) {
  if (value.is_number_unsigned()) return tb::grouped(value.get<std::uint64_t>());
  if (value.is_number_integer() && value.get<std::int64_t>() >= 0)
    return tb::grouped(value.get<std::uint64_t>());
  if (value.is_number_float() && !tb::is_infinite(value)) return tb::amount(value.get<double>(), 5);
  return value_text(value);
}

std::string muted(const std::string& text) {
  return "<span class=\"muted\">" + mustache::html_escape(text) + "</span>";
}

HtmlCell letter(const Json& name) {
  return HtmlCell("").add("<span class=\"letter\">" + mustache::html_escape(text_of(name)) +
                          "</span>");
}

class ComparisonPage {
 public:
  explicit ComparisonPage(const Json& comparison) : comparison_(comparison) {}

  std::string render() {
    const bool runs = comparison_.at("kind") == "runs";
    page_.set("is_runs", runs);
    page_.set("is_sweeps", !runs);
    page_.set("brand", fmt::format("comparison of {} \u00b7 {}", runs ? "runs" : "sweeps",
                                   text_of(comparison_.at("engine"))));
    const bool worse = comparison_.at("worse").get<bool>();
    page_.set("verdict", worse ? "worse" : "nothing is worse");
    page_.set("badge", worse ? "fail" : "pass");
    mustache::data warnings{mustache::data::type::list};
    for (const Json& warning : comparison_.at("warnings")) warnings << text_of(warning);
    page_.set("warnings", warnings);
    runs ? fill_runs() : fill_sweeps();
    page_.set("script", std::string(embedded::comparison_js()));
    page_.set("data", json_for_script(runs ? Json{{"kind", "runs"}} : comparison_));
    return filled_page(embedded::comparison_template(), "comparison.mustache", page_, !runs);
  }

 private:
  // The compared inputs: the columns of every table.
  void fill_inputs(const Json& inputs) {
    mustache::data list{mustache::data::type::list};
    HtmlTable table("|Directory:mono anywhere|Title");
    std::string title;
    for (const Json& input : inputs) {
      mustache::data data;
      data.set("name", text_of(input.at("name")));
      data.set("command", text_of(input.value("command", Json())));
      list << data;
      HtmlCell path = text_of(input.at("path"));
      if (&input == &inputs.front()) path.add(" " + muted("baseline"));
      table.row({letter(input.at("name")), path,
                 HtmlCell(text_of(input.at("title")))
                     .add(" " + muted(text_of(input.value("summary", Json()))))});
      title +=
          (title.empty() ? "" : ", ") + fs::path(text_of(input.at("path"))).filename().string();
      names_.push_back(text_of(input.at("name")));
    }
    page_.set("inputs", list);
    page_.set("inputs_table", table.html());
    page_.set("title", title);
  }

  // Rows of `what`, one column per input.
  HtmlTable table_of(const std::string& what, const char* look, bool described) const {
    HtmlTable table(what);
    for (const std::string& name : names_) table.column(name, look);
    if (described) table.column("Unit");
    if (described) table.column("Meaning", "muted meaning");
    return table;
  }

  static void add_row(HtmlTable& table, std::vector<HtmlCell> cells, const Json& described) {
    for (const char* key : {"unit", "meaning"})
      cells.emplace_back(text_of(described.value(key, Json())));
    table.row(cells);
  }

  void fill_parameters(bool described) {
    HtmlTable table = table_of("Parameter:name mono", "", described);
    for (const Json& parameter : comparison_.at("parameters")) {
      std::vector<HtmlCell> cells{text_of(parameter.at("name"))};
      for (const Json& value : parameter.at("values"))
        cells.emplace_back(text_of(value), value == parameter.at("values").front() ? "" : "other");
      described ? add_row(table, std::move(cells), parameter) : table.row(cells);
    }
    page_.set("has_parameters", table.rows() > 0);
    page_.set("parameters", table.html());
  }

  // ---- runs -------------------------------------------------------------------------------------

  void fill_runs() {
    fill_inputs(comparison_.at("runs"));
    fill_parameters(true);
    page_.set("figures", figures_in(comparison_.at("figures"), "Figure:name", true).html());
    const HtmlTable values = figures_in(comparison_.at("values"), "Value:name mono", false);
    page_.set("has_values", values.rows() > 0);
    page_.set("values_count", std::to_string(values.rows()));
    page_.set("values", values.html());
    page_.set("has_cost", std::any_of(comparison_.at("figures").begin(),
                                      comparison_.at("figures").end(), [](const Json& figure) {
                                        return text_of(figure.at("key")).starts_with("cost.");
                                      }));
    fill_tiles(comparison_.at("runs"));
    fill_pictures();
  }

  // For each run after the first: what became better and worse, as the verdict counts it, and what
  // costs more.
  void fill_tiles(const Json& runs) {
    mustache::data tiles{mustache::data::type::list};
    for (std::size_t i = 1; i < runs.size(); ++i) {
      std::string better, worse, cost;
      for (const Json& figure : comparison_.at("figures")) {
        const Json& checked = figure.at("cells").at(i);
        const std::string state = checked.value("judgement", "");
        if (state != "better" && state != "worse") continue;
        std::string& list = state == "better"               ? better
                            : checked.value("worse", false) ? worse
                                                            : cost;
        const std::string change = checked.value("change", "");
        list += (list.empty() ? "" : ", ") + figure.at("label").get<std::string>() +
                (change.empty() ? "" : " " + change);
      }
      mustache::data tile;
      tile.set("name", text_of(runs[i].at("name")) + " against " + text_of(runs[0].at("name")));
      tile.set("better", better.empty() ? "nothing" : better);
      tile.set("worse", worse.empty() ? "nothing" : worse);
      tile.set("has_cost", !cost.empty());
      tile.set("cost", cost);
      tiles << tile;
    }
    page_.set("tiles", tiles);
    page_.set("tile_columns", runs.size() > 2 ? "2" : "1");
  }

  HtmlTable figures_in(const Json& figures, const char* what, bool bars) const {
    HtmlTable table = table_of(what, "n", true);
    for (const Json& figure : figures) {
      const std::string key = figure.at("key").get<std::string>();
      double most = 0;
      for (const Json& entry : figure.at("cells"))
        if (const auto value = as_number(entry.at("value")); value && std::isfinite(*value))
          most = std::max(most, std::fabs(*value));
      std::vector<HtmlCell> cells{figure.value("label", key)};
      for (const Json& entry : figure.at("cells")) {
        const bool identical = entry.value("identical", false);
        const bool words = entry.at("value").is_string();
        const std::string shown =
            identical ? entry.value("text", "") : figure_text(entry.at("value"));
        std::string look =
            entry.value("worse", false) ? "worse fails" : entry.value("judgement", "");
        if (words) look += " words";
        HtmlCell cell(words ? "" : shown, look);
        if (words) cell.add(breakable(shown));
        for (const char* more : {"range", "change"})
          if (const std::string text = entry.value(more, ""); !text.empty())
            cell.add("<small>" + mustache::html_escape(text) + "</small>");
        // A percentage of decibels is meaningless.
        const auto value = as_number(entry.at("value"));
        if (bars && !in_decibels(key) && value && most > 0 && std::isfinite(*value))
          cell.add(fmt::format(R"(<div class="bar"><i style="width: {:.1f}%"></i></div>)",
                               100 * std::fabs(*value) / most));
        cells.push_back(cell);
      }
      add_row(table, std::move(cells), figure);
    }
    return table;
  }

  // One row per role, in the order of the runs' lists; one column per run.
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
    // Output pictures come first.
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
        text += fmt::format(", {} on the joint front", figure_text(sweep["joint_front"]));
      sweep["summary"] = text;
    }
    fill_inputs(sweeps);
    fill_parameters(false);
    page_.set("matched", tb::grouped(comparison_.at("points").size()));
    page_.set("only", tb::grouped(comparison_.at("only").size()));
    page_.set("has_only", !comparison_.at("only").empty());
    std::string axes;
    for (const Json& axis : comparison_.at("axes"))
      axes += (axes.empty() ? "" : ", ") + text_of(axis);
    page_.set("axes", axes);
    HtmlTable rows(
        "|Metric:name|Better:n|Equal:n|Worse:n|Mean change:n|Smallest:n|Largest:n|Unit|"
        "Meaning:muted meaning");
    const Json& metrics = comparison_.at("metrics");
    for (std::size_t i = 0; i < comparison_.at("summary").size(); ++i)
      for (std::size_t m = 0; m < metrics.size(); ++m) {
        const Json& sum = comparison_.at("summary")[i][m];
        std::vector<HtmlCell> cells{letter(sweeps[i + 1].at("name")),
                                    text_of(metrics[m].at("name"))};
        const bool has_direction = !metrics[m].at("maximise").is_null();
        for (const char* key : {"better", "equal", "worse"})
          cells.emplace_back(has_direction ? figure_text(sum.at(key)) : "-");
        if (sum.at("worse") != 0 && metrics[m].at("counts") == true) cells.back().look = "worse";
        for (const char* key : {"mean", "least", "most"})
          cells.emplace_back(sum.contains(key) ? fmt::format("{:+.2f} {}", sum[key].get<double>(),
                                                             sum["unit"].get<std::string>())
                                               : "-");
        add_row(rows, std::move(cells), metrics[m]);
      }
    page_.set("summary", rows.html());
  }

  const Json& comparison_;
  std::vector<std::string> names_;  // of the compared inputs
  mustache::data page_;
};

}  // namespace

std::string comparison_page(const Json& comparison) { return ComparisonPage(comparison).render(); }

}  // namespace deburr::tool
