// SPDX-License-Identifier: MIT
#include "studies/papers/papers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "spec/error.h"
#include "tb/base/atomic_file.h"
#include "tb/base/interrupt.h"
#include "tb/run/progress.h"
#include "tb/scene/image_io.h"
#include "tb/scene/reference.h"
#include "tool/pages/build_info.h"
#include "tool/pages/embedded.h"
#include "tool/pages/page.h"
#include "tool/pages/report.h"

namespace deburr::studies {
namespace {

namespace mustache = kainjow::mustache;
using Json = nlohmann::ordered_json;

// Aligns columns by characters rather than bytes: the tables contain Greek letters and signs.
std::size_t characters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  }));
}

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, characters(text)), ' ');
}

// Columns that contain only numbers (and gaps) are aligned right.
bool is_numeric(const PaperTable& table, std::size_t column) {
  return !table.rows.empty() &&
         std::all_of(table.rows.begin(), table.rows.end(), [&](const auto& row) {
           return row[column].find_first_not_of("0123456789.,+-") == std::string::npos;
         });
}

mustache::data table_data(const PaperTable& table) {
  mustache::data data;
  data.set("title", table.title);
  data.set("note", table.note);
  data.set("has_note", !table.note.empty());
  tool::HtmlTable html("", "narrow");
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    html.column(table.columns[i], is_numeric(table, i) ? "n" : "");
  for (const auto& row : table.rows) {
    std::vector<tool::HtmlCell> cells;
    for (std::size_t i = 0; i < row.size(); ++i)
      cells.push_back(table.columns[i] == "verdict" ? tool::HtmlCell(row[i], "verdict " + row[i])
                                                    : row[i]);
    html.row(cells);
  }
  data.set("table", html.html());
  return data;
}

}  // namespace

const std::vector<PaperEntry>& papers() {
  static const std::vector<PaperEntry> entries = {{"000", &paper_000::build},
                                                  {"002", &paper_002::build},
                                                  {"003", &paper_003::build},
                                                  {"004", &paper_004::build}};
  return entries;
}

void PaperOptions::go_on() const {
  if (interrupted()) throw tb::Interrupted();
}

std::function<bool()> PaperOptions::watching(tb::Waiting& waiting) const {
  return [&waiting, ask = interrupted] {
    waiting.update();
    return ask();
  };
}

std::string decimals(double value, int digits) {
  return std::isinf(value) ? "identical" : fmt::format("{:.{}f}", value, digits);
}

std::string to_text(const Paper& paper) {
  std::string out = fmt::format("== {} {} ==\n", paper.id, paper.title);
  for (const PaperTable& table : paper.tables) {
    out += "\n" + table.title + "\n";
    if (!table.note.empty()) out += "  " + table.note + "\n";
    std::vector<std::size_t> widths;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      std::size_t width = characters(table.columns[i]);
      for (const auto& row : table.rows) width = std::max(width, characters(row[i]));
      widths.push_back(width);
    }
    const auto line = [&](const std::vector<std::string>& cells) {
      std::string text = " ";
      for (std::size_t i = 0; i < cells.size(); ++i)
        text += fmt::format(" {} ", padded(cells[i], widths[i]));
      text.erase(text.find_last_not_of(' ') + 1);
      out += text + "\n";
    };
    line(table.columns);
    for (const auto& row : table.rows) line(row);
  }
  return out;
}

nlohmann::ordered_json write_papers(const std::filesystem::path& directory,
                                    const std::vector<Paper>& papers) {
  Json json;
  json["schema"] = 1;
  json["commit"] = tool::build_info().commit;
  json["papers"] = Json::array();
  mustache::data list{mustache::data::type::list};
  for (const Paper& paper : papers) {
    Json entry{{"id", paper.id}, {"title", paper.title}, {"source", paper.source}};
    mustache::data page;
    page.set("title", fmt::format("{}: {}", paper.id, paper.title));
    page.set("id", paper.id);
    page.set("source", paper.source);
    entry["tables"] = Json::array();
    mustache::data tables{mustache::data::type::list};
    for (const PaperTable& table : paper.tables) {
      Json rows = Json::array();
      for (const auto& row : table.rows) {
        DEBURR_CHECK(row.size() == table.columns.size(), table.title + ": a row has gaps");
        Json cells = Json::object();
        for (std::size_t i = 0; i < row.size(); ++i) cells[table.columns[i]] = row[i];
        rows.push_back(cells);
      }
      entry["tables"].push_back({{"title", table.title}, {"note", table.note}, {"rows", rows}});
      tables << table_data(table);
    }
    page.set("tables", tables);
    entry["figures"] = Json::array();
    mustache::data figures{mustache::data::type::list};
    for (const PaperFigure& figure : paper.figures) {
      mustache::data block;
      block.set("title", figure.title);
      block.set("note", figure.note);
      Json files = Json::array();
      mustache::data images{mustache::data::type::list};
      for (const PaperImage& image : figure.images) {
        const std::string file = fmt::format("{}_{}.png", paper.id, image.file);
        write_image(directory / file, image.image);
        files.push_back({{"file", file}, {"title", image.title}, {"caption", image.caption}});
        mustache::data cell;
        cell.set("title", image.title);
        cell.set("caption", image.caption);
        cell.set("wide", image.wide);
        cell.set("source", tool::data_uri(directory / file));
        images << cell;
      }
      block.set("images", images);
      figures << block;
      entry["figures"].push_back({{"title", figure.title}, {"images", files}});
    }
    page.set("figures", figures);
    list << page;
    json["papers"].push_back(entry);
  }
  mustache::data root;
  root.set("title", "Claims of the papers, and whether they hold");
  root.set("brand", "papers");
  root.set("footer", "Built by deburr papers.");
  root.set("papers", list);
  tb::write_file_atomically(directory / "papers.json", json.dump(2) + "\n");
  tb::write_file_atomically(
      directory / "index.html",
      tool::filled_page(tool::embedded::papers_template(), "papers.mustache", root, false));
  Json ids = Json::array();
  for (const Paper& paper : papers) ids.push_back(paper.id);
  return {{"unit", "papers"}, {"papers", ids}, {"commit", tool::build_info().commit}};
}

}  // namespace deburr::studies
