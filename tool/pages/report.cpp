// SPDX-License-Identifier: MIT
#include "tool/pages/report.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <utility>

#include "spec/error.h"
#include "tb/base/atomic_file.h"
#include "tb/base/file.h"
#include "tb/base/json_text.h"
#include "tb/run/amount.h"
#include "tb/run/picture_map.h"
#include "tb/run/result.h"
#include "tb/scene/png.h"
#include "tool/pages/embedded.h"
#include "tool/pages/input_files.h"
#include "tool/pages/report_parts.h"

namespace deburr::tool {

using tb::amount;
using tb::grouped;

namespace {

namespace fs = std::filesystem;
namespace mustache = kainjow::mustache;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxManifestBytes = 64u << 20;

// A count, 0 for anything else.
std::uint64_t count_of(const Json& json, const char* key) {
  const Json value = json.value(key, Json());
  return value.is_number_unsigned() ? value.get<std::uint64_t>() : 0;
}

std::string two_digits(const Json& value) {
  if (tb::is_infinite(value)) return "identical";
  return value.is_number() ? fmt::format("{:.2f}", value.get<double>()) : "-";
}

std::string gain_of(const Json& before, const Json& after, int digits = 2) {
  if (!before.is_number() || !after.is_number() || tb::is_infinite(before) ||
      tb::is_infinite(after))
    return "-";
  return fmt::format("{:+.{}f}", after.get<double>() - before.get<double>(), digits);
}

std::string fraction(const Json& value) {
  return value.is_number() ? fmt::format("{:.4f}", value.get<double>()) : "-";
}

Json read_manifest(const fs::path& directory) {
  const fs::path file = directory / "manifest.json";
  Json manifest = tb::try_parse_json(tb::read_file(file, kMaxManifestBytes));
  if (!manifest.is_object())
    throw spec::FileError(fmt::format("'{}' is not a valid manifest", file.string()));
  return manifest;
}

class ReportBuilder {
 public:
  ReportBuilder(const fs::path& directory, Json result, Json manifest)
      : result_(std::move(result)), manifest_(std::move(manifest)) {
    const ReportSource source{directory, result_, manifest_};
    fill_summary();
    fill_pixel(source, page_);
    maps_ = fill_pictures(source, page_);
    intervals_ = fill_over_time(source, page_);
    fill_figures();
    fill_quality();
    fill_units();
    fill_latency();
    fill_memories();
    fill_cost();
    fill_parameters();
    fill_origin();
  }

  std::string render() {
    page_.set("script", std::string(embedded::report_js()));
    page_.set("data",
              fmt::format(R"({{"result":{},"intervals":{},"maps":{},"map_colours":{}}})",
                          json_for_script(result_), json_for_script(intervals_),
                          json_for_script(maps_), json_for_script(Json(tb::map_colours()))));
    return filled_page(embedded::report_template(), "report.mustache", page_);
  }

 private:
  void fill_summary() {
    page_.set("brand", report_text(result_["unit"]));
    page_.set("footer", "Built from result.json and manifest.json.");
    page_.set("title", manifest_.value("title", "Run"));
    page_.set("summary", manifest_.value("summary", ""));
    page_.set("verdict", report_text(result_["verdict"]));
    page_.set("badge", report_text(result_["verdict"]));
    if (const std::string reason = result_.value("reason", ""); !reason.empty())
      page_.set("reason", reason);
    mustache::data notes{mustache::data::type::list};
    for (const Json& note : result_.value("notes", Json::array())) notes << report_text(note);
    page_.set("notes", notes);
    page_.set("command", manifest_.value("command", ""));
    page_.set("cycles", report_text(result_["cycles"]));

    const Json& checks = result_["checks"];
    const Json& throughput = result_["throughput"];
    const Json& latency = result_["latency"];
    const double value = number(throughput, "value"), bound = number(throughput, "bound");
    const double mhz = number(result_, "clock_mhz");
    std::vector<Tile> tiles;
    const auto tile = [&](std::string name, std::string number_text, std::string unit,
                          std::string note, const char* state = "") {
      tiles.push_back(
          {std::move(name), std::move(number_text), std::move(unit), std::move(note), state});
    };
    const bool interrupted = result_.value("interrupted", false);
    const std::uint64_t mismatches =
        count_of(checks, "mismatches") + count_of(checks, "traffic_mismatches");
    const std::uint64_t compared =
        count_of(checks, "comparisons") + count_of(checks, "traffic_comparisons");
    page_.set("incomplete", interrupted);
    if (compared == 0)
      tile("Mismatches", "-", "", "not checked against the golden model");
    else
      tile("Mismatches", grouped(mismatches), "",
           fmt::format("of {} comparisons{}", grouped(compared), interrupted ? ", incomplete" : ""),
           mismatches    ? "bad"
           : interrupted ? ""
                         : "good");
    const double cycles = number(result_, "cycles");
    const auto time = [&](double count) {
      return mhz > 0 ? fmt::format("{:.2f} ms at {:g} MHz", count / mhz / 1e3, mhz) : "";
    };
    // Tiles declared by the engine replace the common ones.
    bool own_cycles = false, own_latency = false, own_memory = false;
    for (const Json& figure : result_.value("figures", Json::array())) {
      if (!figure.value("tile", false)) continue;
      const std::string key = figure.value("key", ""), unit = described(key, "unit");
      const bool time_shown = unit == "clk" && !key.starts_with("latency.");
      own_cycles = own_cycles || time_shown;
      own_latency = own_latency || key.starts_with("latency.");
      own_memory = own_memory || key.find("memory") != std::string::npos;
      std::string note = against(figure);
      if (time_shown) note += (note.empty() ? "" : "; ") + time(value_at(key).get<double>());
      tile(figure.value("label", ""), figure_text(value_at(key)), unit, note);
    }
    if (!own_cycles) tile("Cycles", report_text(result_["cycles"]), "clk", time(cycles));
    tile("Throughput", fmt::format("{:.3f}", value), "",
         report_text(throughput.value("unit", Json(""))) +
             (bound > 0
                  ? fmt::format(", {:.1f} % of the bound {}", 100 * value / bound, amount(bound))
                  : ""));
    if (!own_latency)
      tile("Latency p50", report_text(latency.value("p50", Json())), "clk",
           fmt::format("p99 {}, max {}", report_text(latency.value("p99", Json())),
                       report_text(latency.value("max", Json()))));
    if (const double read = number(result_["memory"], "bytes_read"); read > 0 && !own_memory)
      tile("Read from memory", fmt::format("{:.2f}", read / 1048576), "MiB",
           fmt::format("{} reads", report_text(result_["memory"].value("lines_filled", Json()))));
    if (const auto quality = result_.find("quality"); quality != result_.end()) {
      const bool edges = !quality->value("psnr_edge_db", Json()).is_null();
      const Json after = quality->value(edges ? "psnr_edge_db" : "psnr_db", Json());
      const Json before = quality->value(edges ? "psnr_edge_before_db" : "psnr_before_db", Json());
      const std::string gain = gain_of(before, after);
      tile(edges ? "PSNR, edge pixels" : "PSNR", two_digits(after), "dB",
           gain == "-" ? "of the output" : gain + " dB, before " + two_digits(before));
    }
    tile("Simulation", fmt::format("{:.2f}", number(result_["host"], "mcycles_per_s")), "Mcycle/s",
         fmt::format("{:.1f} s, of which {:.1f} s processor time",
                     number(result_["host"], "seconds"), number(result_["host"], "cpu_seconds")));
    page_.set("tiles", html_of(tiles));

    mustache::data meters{mustache::data::type::list};
    const auto meter = [&](std::string name, double part, double whole, const std::string& unit,
                           std::string note) {
      const double percent = whole > 0 ? 100 * part / whole : 0;
      mustache::data one;
      one.set("name", std::move(name));
      one.set("text",
              fmt::format("{} of {} {} ({:.1f} %)", amount(part), amount(whole), unit, percent));
      one.set("percent", fmt::format("{:.2f}", std::clamp(percent, 0.0, 100.0)));
      one.set("note", std::move(note));
      meters << one;
    };
    meter("Rate over the whole run", value, bound, report_text(throughput.value("unit", Json(""))),
          bound_note(throughput));
    fill_bottleneck(meter);
    page_.set("meters", meters);
    page_.set("throughput_note",
              mhz > 0 && value > 0
                  ? fmt::format("At {:.2f} MHz this is {:.1f} M{}.", mhz, value * mhz,
                                per_second(report_text(throughput.value("unit", Json("")))))
                  : "");
  }

  static std::string bound_note(const Json& throughput) {
    const std::string meaning = throughput.value("bound_meaning", "");
    return meaning.empty() ? "" : "Bound: " + meaning;
  }

  // Stall causes as fractions of that unit's cycles.
  template <class Meter>
  void fill_bottleneck(const Meter& meter) const {
    const auto found = result_.find("bottleneck");
    if (found == result_.end() || !found->is_object()) return;
    const std::string name = found->value("unit", ""), cause = found->value("cause", "");
    if (!result_["units"].contains(name)) return;
    const Json& unit = result_["units"][name];
    const Json stalls = unit.value("stalls", Json::object());
    double all = number(unit, "busy") + number(unit, "idle");
    for (const auto& [key, count] : stalls.items()) all += count.template get<double>();
    meter(
        fmt::format("Limited by {}: {}{}", name, cause == "busy" ? "" : "stalled, ", spaced(cause)),
        number(*found, "cycles"), all, "clk", found->value("meaning", ""));
  }

  static std::string spaced(std::string text) {
    std::replace(text.begin(), text.end(), '_', ' ');
    return text;
  }

  // The value under a dotted key; null if absent.
  Json value_at(const std::string& key) const {
    const Json* node = &result_;
    for (std::size_t from = 0; from <= key.size();) {
      const std::size_t dot = std::min(key.find('.', from), key.size());
      const std::string part = key.substr(from, dot - from);
      if (!node->is_object() || !node->contains(part)) return Json();
      node = &(*node)[part];
      from = dot + 1;
    }
    return *node;
  }

  static std::string figure_text(const Json& value) {
    if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
    if (tb::is_infinite(value)) return "identical";
    return value.is_number_float() ? amount(value.get<double>()) : report_text(value);
  }

  // "= formula", or "formula 281,094, +64.3 %".
  std::string against(const Json& figure) const {
    const auto other = figure.find("against");
    if (other == figure.end()) return "";
    std::string label = other->value("label", "");
    if (!other->contains("key")) return label;
    const Json value = value_at(figure.value("key", ""));
    const Json reference = value_at(other->value("key", ""));
    if (!value.is_number() || !reference.is_number()) return "";
    const double a = value.get<double>(), b = reference.get<double>();
    if (a == b) return "= " + label;
    return fmt::format("{} {}{}", label, figure_text(reference),
                       b > 0 ? fmt::format(", {:+.1f}\u00a0%", 100 * (a - b) / b) : "");
  }

  // "bilinear/clk" -> "bilinear/s".
  static std::string per_second(const std::string& unit) {
    return unit.ends_with("/clk") ? unit.substr(0, unit.size() - 3) + "s" : unit + "/s";
  }

  // Unit or meaning of a key, from the result itself.
  std::string described(const std::string& key, const char* what) const {
    const auto all = result_.find("meaning");
    if (all == result_.end() || !all->contains(key)) return "";
    return (*all)[key].value(what, "");
  }

  void fill_figures() {
    const Json figures = result_.value("figures", Json::array());
    const bool any_against = std::any_of(figures.begin(), figures.end(),
                                         [&](const Json& f) { return !against(f).empty(); });
    HtmlTable table("What|Value:n|Unit");
    if (any_against) table.column("Against");
    for (const Json& figure : figures) {
      const std::string key = figure.value("key", "");
      std::vector<HtmlCell> cells{figure.value("label", ""), figure_text(value_at(key)),
                                  described(key, "unit")};
      if (any_against) cells.emplace_back(against(figure));
      table.row(cells, "", described(key, "meaning"));
    }
    page_.set("has_figures", table.rows() > 0);
    page_.set("figures", table.html());

    HtmlTable memory("What|Amount:n|Unit");
    const double cycles = number(result_, "cycles");
    bool traffic = false;
    for (const auto& [name, value] : result_["memory"].items()) {
      std::string meaning = described("memory." + name, "meaning");
      if (meaning.ends_with('.')) meaning.pop_back();
      memory.row({meaning, report_text(value), described("memory." + name, "unit")});
      traffic = traffic || (value.is_number() && value.get<double>() > 0);
    }
    for (const auto& [label, key] : {std::pair("Mean read bandwidth", "bytes_read"),
                                     std::pair("Mean write bandwidth", "bytes_written")})
      if (const double bytes = number(result_["memory"], key); cycles > 0 && bytes > 0)
        memory.row({label, fmt::format("{:.3f}", bytes / cycles), "byte/clk"});
    page_.set("memory", memory.html());
    page_.set("has_traffic", traffic);

    HtmlTable work("Counter:name mono|Value:n|Unit|Meaning:muted meaning");
    for (const auto& [name, value] : result_["work"].items())
      work.row({name, report_text(value), described("work." + name, "unit"),
                described("work." + name, "meaning")});
    page_.set("work", work.html());

    HtmlTable checks("Check|Value:n|Meaning:muted meaning");
    for (const auto& [name, value] : result_["checks"].items())
      checks.row({spaced(name), report_text(value), described("checks." + name, "meaning")});
    page_.set("checks", checks.html());
  }

  // Compares with the reference and with the input.
  void fill_quality() {
    const auto quality = result_.find("quality");
    page_.set("has_quality", quality != result_.end());
    if (quality != result_.end()) {
      page_.set("quality_reference", quality->value("reference", ""));
      HtmlTable table("Measure|Before:n|After:n|Gain:n|Unit", "after");
      for (const auto& [label, key] :
           {std::pair("PSNR, whole frame", "psnr_"), std::pair("PSNR, edge pixels", "psnr_edge_"),
            std::pair("PSNR, silhouette pixels", "psnr_silhouette_")}) {
        const Json after = quality->value(std::string(key) + "db", Json());
        const Json before = quality->value(std::string(key) + "before_db", Json());
        if (after.is_null() && before.is_null()) continue;
        table.row({label, two_digits(before), two_digits(after), gain_of(before, after), "dB"});
      }
      for (const auto& [label, key] :
           {std::pair("FLIP, less is better", "flip"), std::pair("SSIM", "ssim")}) {
        const Json after = quality->value(key, Json());
        const Json before = quality->value(std::string(key) + "_before", Json());
        if (after.is_null()) continue;
        table.row({label, fraction(before), fraction(after), gain_of(before, after, 4), ""});
      }
      page_.set("quality", table.html());
    }
    const auto change = result_.find("change");
    page_.set("has_change", change != result_.end());
    if (change == result_.end()) return;
    HtmlTable table(
        "Pixels, compared with the input|All:n|Correct input:n:input within 2 codes of the "
        "reference|Unit",
        "after");
    const auto text = [&](const char* key) { return two_digits(change->value(key, Json())); };
    table.row({"Changed by more than 2 codes", text("over_2_percent"), text("right_over_2_percent"),
               "%"});
    table.row({"Changed by more than 16 codes", text("over_16_percent"),
               text("right_over_16_percent"), "%"});
    table.row({"PSNR to the input", text("psnr_db"), "", "dB"});
    page_.set("change", table.html());
  }

  void fill_units() {
    HtmlTable units("Unit:name|Busy:n|Idle:n|Stalled, by cause");
    for (const auto& [name, unit] : result_["units"].items()) {
      std::string stalls;
      for (const auto& [cause, count] : unit["stalls"].items())
        if (count != 0)
          stalls += fmt::format("{}{} {}", stalls.empty() ? "" : ", ", cause, report_text(count));
      units.row({name, report_text(unit["busy"]), report_text(unit["idle"]),
                 stalls.empty() ? "-" : stalls});
    }
    page_.set("units", units.html());
  }

  void fill_latency() {
    const Json& latency = result_["latency"];
    const std::string unit = report_text(latency.value("unit", Json("clk")));
    HtmlTable percentiles("min:n|p50:n|p95:n|p99:n|max:n|Unit");
    const auto text = [&](const char* key) { return report_text(latency, key); };
    percentiles.row({text("min"), text("p50"), text("p95"), text("p99"), text("max"), unit});
    page_.set("latency", percentiles.html());
    page_.set("latency_unit", unit);
    // A single value needs no histogram.
    page_.set("latency_spread", latency.value("min", Json()) != latency.value("max", Json()));
    page_.set("latency_single", text("max"));
    HtmlTable histogram("From:n|Transactions:n");
    for (const Json& bin : latency.value("histogram", Json::array()))
      histogram.row({report_text(bin, "from"), report_text(bin, "count")});
    page_.set("histogram", histogram.html());
  }

  void fill_parameters() {
    HtmlTable table(
        "Name:name mono|Kind:muted|Value:mono value|Default:mono value muted|Range:muted range|"
        "Unit:muted|Meaning:muted meaning");
    for (const Json& p : manifest_.value("parameters", Json::array())) {
      const std::string value = report_text(p, "value"), usual = p.value("default", "");
      table.row({p.value("name", ""), p.value("kind", ""), value, usual, p.value("range", ""),
                 unit_of_parameter(p), p.value("meaning", "")},
                value == usual ? "" : "changed");
    }
    page_.set("parameters", table.html());
  }

  // A memory rate is shown in both common units.
  std::string unit_of_parameter(const Json& parameter) const {
    std::string unit = parameter.value("unit", "");
    if (unit != "byte/clk") return unit;
    const double rate =
        std::strtod(shown_plain(parameter.value("value", Json())).c_str(), nullptr) *
        number(result_, "clock_mhz") / 1000;
    return rate > 0 ? fmt::format("{}, {} GB/s", unit, amount(rate)) : unit;
  }

  void fill_memories() {
    const Json& memories = result_["memories"];
    const Json& bits = result_["memory_bits"];
    const auto total = [&](const char* key) {
      return count_of(bits.value("total", Json::object()), key);
    };
    const std::uint64_t logical = total("logical"), at_width = total("logical_at_frame_width");
    const bool widths = at_width != 0 && at_width != logical;
    HtmlTable rows("Memory:name|Kind|Words x bits:n|Ports|Read latency, clk:n|Built as"),
        kinds("Kind|Memories:n");
    const auto add_bits = [&](HtmlTable& table) {
      if (widths) table.column("Bits at this width", "n");
      for (const char* name : {"Logical bits", "Physical bits"}) table.column(name, "n");
    };
    add_bits(rows);
    rows.column("Holds", "meaning");
    add_bits(kinds);
    for (const auto& [name, m] : memories.items()) {
      const auto text = [&of = m](const char* key) { return report_text(of, key); };
      std::vector<HtmlCell> cells{name,
                                  text("kind"),
                                  fmt::format("{} x {}", text("words"), text("word_bits")),
                                  text("ports"),
                                  text("read_latency"),
                                  text("built_as")};
      if (widths) cells.emplace_back(text("logical_bits_at_frame_width"));
      for (const char* key : {"logical_bits", "physical_bits", "content"})
        cells.emplace_back(text(key));
      rows.row(cells);
    }
    page_.set("memories", rows.html());
    for (const auto& [kind, sum] : bits.items()) {
      std::vector<HtmlCell> cells{kind, report_text(sum, "memories")};
      if (widths) cells.emplace_back(report_text(sum, "logical_at_frame_width"));
      for (const char* key : {"logical", "physical"}) cells.emplace_back(report_text(sum, key));
      kinds.row(cells);
    }
    page_.set("memory_kinds", kinds.html());
    page_.set("memory_widths", widths);
    const auto megabits = [](std::uint64_t value) {
      return fmt::format("{:.2f} Mbit", static_cast<double>(value) / 1e6);
    };
    page_.set("memory_note", megabits(logical));
    page_.set("memory_physical_note", megabits(total("physical")));
    page_.set("memory_width_note", megabits(at_width));
    mustache::data not_implementable{mustache::data::type::list};
    for (const std::string& memory : tb::not_implementable_memories(result_))
      not_implementable << memory;
    page_.set("not_implementable", not_implementable);
    page_.set("is_not_implementable", !tb::not_implementable_memories(result_).empty());
  }

  // The range stands below the value.
  static HtmlCell ranged(const Json& figure) {
    const double low = number(figure, "low"), high = number(figure, "high");
    const double value = number(figure, "value");
    HtmlCell cell(value > 0 ? tb::rounded(value) : "-");
    if (low < high)
      cell.add(fmt::format("<small>{} to {}</small>", tb::rounded(low), tb::rounded(high)));
    return cell;
  }

  void fill_cost() {
    const auto found = result_.find("cost");
    page_.set("has_cost", found != result_.end());
    if (found == result_.end()) return;
    const Json& cost = *found;
    page_.set("cost_technology", report_text(cost, "technology"));
    HtmlTable units(
        "Unit:name|Gates:n|Flip-flops:n|Memory, bit:n|Longest path, ns:n|Stage:meaning|Basis");
    const auto row = [&](const std::string& name, const std::string& basis, const Json& of,
                         const std::string& stage, const char* look) {
      units.row({name, ranged(of["gates"]), report_text(of, "flip_flops"),
                 report_text(of, "memory_bits"), ranged(of["ns"]), stage, basis},
                look);
    };
    const double longest = number(cost["ns"], "value");
    for (const auto& [name, unit] : cost["units"].items())
      row(name, report_text(unit, "basis"), unit, report_text(unit, "stage"),
          longest > 0 && number(unit["ns"], "value") == longest ? "changed" : "");
    row("all", "", cost, report_text(cost, "limited_by"), "");
    page_.set("cost_units", units.html());

    HtmlTable figures("What|Value:n|Unit", "narrow");
    if (longest > 0) {
      figures.row({"Clock limit by the longest path", ranged(cost["clock_mhz"]), "MHz"});
      if (cost.contains("frames_per_s")) {
        figures.row(
            {"Frames like this one at this limit", ranged(cost["frames_per_s"]), "frame/s"});
        figures.row({fmt::format("The same at run.clock_mhz = {:g}", number(result_, "clock_mhz")),
                     tb::rounded(number(cost, "run_frames_per_s")), "frame/s"});
      }
      figures.row({"Longest path, relative to a 24 x 24 multiply",
                   fmt::format("{:.2f}", number(cost, "yardstick_ratio")), ""});
    }
    for (const auto& [technology, sram] : cost["sram"].items())
      figures.row({fmt::format("Area of all SRAM in {}", technology),
                   tb::rounded(number(sram, "mm2")), "mm\u00b2"});
    page_.set("cost_figures", figures.html());
  }

  void fill_origin() {
    HtmlTable origin("What|Value:mono anywhere");
    for (const char* key :
         {"version", "commit", "compiler", "build_type", "systemc", "seed", "started"})
      if (manifest_.contains(key)) origin.row({key, shown_plain(manifest_[key])});
    for (const Json& input : manifest_.value("inputs", Json::array()))
      origin.row({input.value("role", "input"),
                  fmt::format("{}  {}{}", input.value("file", ""),
                              input.contains("sha256") ? "sha256 " : "", listed_content(input))});
    page_.set("origin", origin.html());
  }

  static std::string shown_plain(const Json& value) {
    return value.is_string() ? value.get<std::string>() : tb::json_text(value);
  }

  Json result_, manifest_, intervals_, maps_;
  mustache::data page_;
};

}  // namespace

std::string report_text(const Json& value) {
  if (value.is_number_unsigned()) return grouped(value.get<std::uint64_t>());
  if (value.is_number()) return amount(value.get<double>());
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_null()) return "-";
  return tb::json_text(value);
}

std::string report_text(const Json& object, const char* key) {
  return report_text(object.value(key, Json()));
}

double number(const Json& json, const char* key) {
  const Json value = json.value(key, Json(0.0));
  return value.is_number() ? value.get<double>() : 0.0;
}

// Not a regular expression: it would take a sixth of this library's compile time.
std::string without_options(std::string command, std::initializer_list<std::string_view> options) {
  std::size_t at = 0;
  while ((at = command.find(" --", at)) != std::string::npos) {
    const std::size_t value = command.find_first_of(" =", at + 1);
    const std::string name = command.substr(at + 1, value - at - 1);
    if (value == std::string::npos ||
        std::find(options.begin(), options.end(), name) == options.end()) {
      ++at;
      continue;
    }
    std::size_t end = value + 1;
    for (bool quoted = false; end < command.size() && (quoted || command[end] != ' '); ++end)
      if (command[end] == '\'') quoted = !quoted;
    command.erase(at, end - at);
  }
  return command;
}

void reject_path(const fs::path& directory, const fs::path& file) {
  if (file.empty() || file.has_parent_path())
    throw spec::FileError(fmt::format("'{}': '{}' is not a file name",
                                      (directory / "manifest.json").string(), file.string()));
}

std::string json_for_script(const Json& json) {
  std::string text = tb::json_text(json);
  constexpr std::string_view kEscaped = "\\u003c";
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos; at += kEscaped.size())
    text.replace(at, 1, kEscaped);
  return text;
}

std::string data_uri(const fs::path& image_file) {
  return png_uri(tb::read_file(image_file, kMaxImageBytes));
}

std::string png_uri(const std::string& bytes) {
  std::string encoded(4 * ((bytes.size() + 2) / 3) + 1, '\0');
  const int size = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(encoded.data()),
                                   reinterpret_cast<const unsigned char*>(bytes.data()),
                                   static_cast<int>(bytes.size()));
  encoded.resize(static_cast<std::size_t>(size));
  return "data:image/png;base64," + encoded;
}

std::string build_report(const fs::path& pictures, Json result, Json manifest) {
  return ReportBuilder(pictures, tb::with_infinity(std::move(result)), std::move(manifest))
      .render();
}

std::string build_report(const fs::path& directory) {
  Json result = tb::read_result(directory);
  return build_report(directory, std::move(result), read_manifest(directory));
}

void write_report(const fs::path& directory) {
  tb::write_file_atomically(directory / "report.html", build_report(directory));
}

}  // namespace deburr::tool
