// SPDX-License-Identifier: MIT
#include "tool/pages/report.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <tuple>
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
#include "tool/pages/page_template.h"

namespace deburr::tool {

using tb::amount;
using tb::grouped;

namespace {

namespace fs = std::filesystem;
namespace mustache = kainjow::mustache;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxImageBytes = 256u << 20;
constexpr std::size_t kMaxManifestBytes = 64u << 20, kMaxWindowsBytes = 64u << 20;

// Numbers as a reader wants them: counts grouped, rates with four significant digits.
std::string report_text(const Json& value) {
  if (value.is_number_unsigned()) return grouped(value.get<std::uint64_t>());
  if (value.is_number()) return amount(value.get<double>());
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_null()) return "-";
  return tb::json_text(value);
}

mustache::data row(std::initializer_list<std::pair<const char*, std::string>> cells) {
  mustache::data data;
  for (const auto& [name, value] : cells) data.set(name, value);
  return data;
}

// A count, 0 for anything else.
std::uint64_t count_of(const Json& json, const char* key) {
  const Json value = json.value(key, Json());
  return value.is_number_unsigned() ? value.get<std::uint64_t>() : 0;
}

double number(const Json& json, const char* key) {
  const Json value = json.value(key, Json(0.0));
  return value.is_number() ? value.get<double>() : 0.0;
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

// Columns and rows; nothing: it is no PNG.
std::pair<std::uint64_t, std::uint64_t> png_size(const std::string& bytes) {
  constexpr std::size_t kWidth = 16, kHeight = 20;  // in the first chunk, IHDR
  if (!bytes.starts_with("\x89PNG") || bytes.size() < kHeight + 4) return {0, 0};
  const auto number = [&](std::size_t at) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
      value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
  };
  return {number(kWidth), number(kHeight)};
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
    fill_head();
    fill_images(directory);
    fill_windows(directory);
    fill_tables();
    fill_origin();
  }

  std::string render() {
    page_.set("style", std::string(embedded::style_css()));
    page_.set("chart_js", embedded::charts());
    page_.set("copy_js", std::string(embedded::copy_js()));
    page_.set("report_js", std::string(embedded::report_js()));
    page_.set("data",
              fmt::format(R"({{"result":{},"windows":{},"maps":{},"map_colours":{}}})",
                          json_for_script(result_), json_for_script(windows_),
                          json_for_script(maps_), json_for_script(Json(tb::map_colours()))));
    return filled_page(embedded::report_template(), "report.mustache", page_);
  }

 private:
  void fill_head() {
    page_.set("unit", report_text(result_["unit"]));
    page_.set("title", manifest_.value("title", "Run"));
    page_.set("summary", manifest_.value("summary", ""));
    page_.set("verdict", report_text(result_["verdict"]));
    const std::string reason = result_.value("reason", "");
    if (!reason.empty()) {
      mustache::data list{mustache::data::type::list};
      list << row({{"reason", reason}});
      page_.set("reason", list);
    }
    mustache::data notes{mustache::data::type::list};
    for (const Json& note : result_.value("notes", Json::array()))
      notes << row({{"note", report_text(note)}});
    page_.set("notes", notes);
    mustache::data mismatches_table{mustache::data::type::list};
    fill_pixel();
    for (const Json& m : result_.value("first_mismatches", Json::array())) {
      mustache::data line = row({{"check", m.value("check", "")},
                                 {"where", m.value("where", "")},
                                 {"item", m.value("item", "")},
                                 {"field", m.value("field", "")},
                                 {"expected", m.value("expected", "")},
                                 {"got", m.value("got", "")}});
      const std::string pixel = pixel_in(m.value("item", ""));
      line.set("pixel", pixel);
      line.set("followed", !pixel.empty() && pixel == followed_);
      line.set("can_follow", !pixel.empty() && pixel != followed_);
      mismatches_table << line;
    }
    page_.set("has_mismatches", mismatches_table.is_non_empty_list());
    page_.set("mismatches", mismatches_table);
    page_.set("command", manifest_.value("command", ""));
    page_.set("cycles", report_text(result_["cycles"]));

    const Json& checks = result_["checks"];
    const Json& throughput = result_["throughput"];
    const Json& latency = result_["latency"];
    const double value = number(throughput, "value"), bound = number(throughput, "bound");
    const double mhz = number(result_, "clock_mhz");
    mustache::data tiles{mustache::data::type::list};
    const auto tile = [&](std::string name, std::string number_text, std::string unit,
                          std::string note, const char* state = "") {
      tiles << row({{"name", std::move(name)},
                    {"value", std::move(number_text)},
                    {"unit", std::move(unit)},
                    {"note", std::move(note)},
                    {"state", state}});
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
    const auto time = [&](double clocks) {
      return mhz > 0 ? fmt::format("{:.2f} ms at {:g} MHz", clocks / mhz / 1e3, mhz) : "";
    };
    // What an engine shows among the tiles takes the place of what all of them have.
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
           gain == "-" ? "of what came out" : gain + " dB, before " + two_digits(before));
    }
    tile("Simulation", fmt::format("{:.2f}", number(result_["host"], "mcycles_per_s")), "Mcycle/s",
         fmt::format("{:.1f} s, {:.1f} s of them computing", number(result_["host"], "seconds"),
                     number(result_["host"], "cpu_seconds")));
    page_.set("tiles", tiles);
    // One row of tiles, or two that are equally long.
    constexpr std::size_t kRow = 7;
    const std::size_t count = tiles.list_value().size();
    page_.set("columns", std::to_string(count <= kRow ? count : (count + 1) / 2));

    mustache::data meters{mustache::data::type::list};
    const auto meter = [&](std::string name, double part, double whole, const std::string& unit,
                           std::string note) {
      const double percent = whole > 0 ? 100 * part / whole : 0;
      meters << row({{"name", std::move(name)},
                     {"text", fmt::format("{} of {} {} ({:.1f} %)", amount(part), amount(whole),
                                          unit, percent)},
                     {"percent", fmt::format("{:.2f}", std::clamp(percent, 0.0, 100.0))},
                     {"note", std::move(note)}});
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

  // "X,Y" of an item that is called by its pixel, "pixel (X, Y)"; empty: it is not.
  static std::string pixel_in(const std::string& item) {
    constexpr std::string_view kBegin = "pixel (";
    const std::size_t begin = item.find(kBegin), end = item.find(')', begin);
    if (begin == std::string::npos || end == std::string::npos) return "";
    std::string pixel = item.substr(begin + kBegin.size(), end - begin - kBegin.size());
    std::erase(pixel, ' ');
    return pixel;
  }

  // The history of a pixel, and the commands that give another one, or the waves around this one.
  void fill_pixel() {
    page_.set("has_history", manifest_.value("pixel_history", false));
    const std::string command = without_options(
        manifest_.value("command", ""), {"--pixel", "--trace", "--trace-from", "--trace-to"});
    page_.set("pixel_command", command);
    const auto found = result_.find("pixel");
    page_.set("has_pixel", found != result_.end());
    if (found == result_.end()) return;
    followed_ = fmt::format("{:.0f},{:.0f}", number(*found, "x"), number(*found, "y"));
    page_.set("pixel", followed_);
    page_.set("pixel_note", found->value("note", ""));
    page_.set("pixel_differences", report_text(found->value("differences", Json())));
    mustache::data steps{mustache::data::type::list};
    std::string part;
    std::optional<std::uint64_t> first, last;
    for (const Json& step : found->value("steps", Json::array())) {
      const Json clock = step.value("clock", Json());
      mustache::data line = row({{"step", step.value("step", "")},
                                 {"item", step.value("item", "")},
                                 {"golden", or_dash(step.value("golden", ""))},
                                 {"hardware", or_dash(step.value("hardware", ""))},
                                 {"clock", report_text(clock)}});
      line.set("differs", step.value("differs", false));
      if (const std::string own = step.value("part", ""); own != part) {
        part = own;
        line.set("begins", own);
      }
      if (clock.is_number_unsigned()) {
        const auto cycle = clock.get<std::uint64_t>();
        first = std::min(first.value_or(cycle), cycle);
        last = std::max(last.value_or(cycle), cycle);
      }
      steps << line;
    }
    page_.set("has_pixel_steps", steps.is_non_empty_list());
    page_.set("pixel_steps", steps);
    if (first)
      page_.set("pixel_waves",
                fmt::format("{} --pixel {} --trace '*' --trace-from {} --trace-to {}", command,
                            followed_, *first, *last + 2));
  }

  static std::string or_dash(const std::string& text) { return text.empty() ? "-" : text; }

  static std::string bound_note(const Json& throughput) {
    const std::string meaning = throughput.value("bound_meaning", "");
    return meaning.empty() ? "" : "Bound: " + meaning;
  }

  // What held the run back, as a share of that unit's cycles.
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

  // The value under a dotted key; null where there is none.
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

  void fill_images(const fs::path& directory) {
    fill_stills(directory);
    mustache::data maps{mustache::data::type::list};
    const Json of_maps = result_.value("maps", Json::object());
    for (const auto& [name, map] : of_maps.items()) {
      const auto text = [&of = map](const char* key) { return amount(number(of, key)); };
      maps << row({{"name", name},
                   {"min", text("min")},
                   {"mean", text("mean")},
                   {"max", text("max")},
                   {"unit", map.value("unit", "")},
                   {"sum", text("sum")},
                   {"pixels", report_text(map.value("pixels", Json()))},
                   {"file", map.value("values", "")},
                   {"meaning", map.value("meaning", "")}});
      keep_values(directory, map);
    }
    page_.set("has_maps", maps.is_non_empty_list());
    page_.set("maps", maps);
  }

  // Of a frame of a few rows or columns they would vanish: they are drawn out. Of a picture that is
  // larger than the frame, with the scale of a map, the frame's part is shown.
  void fill_stills(const fs::path& directory) {
    constexpr std::uint64_t kNarrow = 8;
    const Json list = manifest_.value("images", Json::array());
    std::vector<std::string> pngs;
    std::uint64_t width = UINT64_MAX, height = UINT64_MAX;
    for (const Json& image : list) {
      const fs::path file = image.value("file", "");
      reject_path(directory, file);
      pngs.push_back(tb::read_file(directory / file, kMaxImageBytes));
      const auto [across, down] = png_size(pngs.back());
      width = std::min(width, across);
      height = std::min(height, down);
    }
    width = std::max<std::uint64_t>(width, 1);  // of what is no PNG
    height = std::max<std::uint64_t>(height, 1);
    const char* const shape = width / kNarrow > height   ? "flat"
                              : height / kNarrow > width ? "tall"
                                                         : "part";
    mustache::data images{mustache::data::type::list};
    for (std::size_t i = 0; i < list.size(); ++i) {
      const auto [across, down] = png_size(pngs[i]);
      mustache::data still = row({{"title", list[i].value("title", list[i].value("file", ""))},
                                  {"caption", list[i].value("caption", "")},
                                  {"role", list[i].value("role", "")},
                                  {"shape", shape},
                                  {"source", png_uri(pngs[i])}});
      still.set("ratio", fmt::format("{:.4f}", double(width) / double(height)));
      still.set("across", fmt::format("{:.2f}", 100.0 * double(across) / double(width)));
      still.set("down", fmt::format("{:.2f}", 100.0 * double(down) / double(height)));
      images << still;
    }
    page_.set("has_images", images.is_non_empty_list());
    page_.set("images", images);
  }

  // What the page says of a pixel of a map; nothing where the file of its values is gone.
  void keep_values(const fs::path& directory, const Json& map) {
    const std::string picture = map.value("picture", ""), name = map.value("values", "");
    if (picture.empty() || name.empty() || number(map, "pixels") == 0) return;
    reject_path(directory, name);
    const fs::path file = directory / name;
    if (!fs::exists(file)) return;
    const std::string bytes = tb::read_file(file, kMaxImageBytes);
    int width = 0, height = 0;
    // Before there is memory for so many values: they must be there.
    if (std::sscanf(bytes.c_str(), "Pf %d %d", &width, &height) != 2 || width < 1 || height < 1 ||
        static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) > bytes.size() / 4)
      throw spec::FileError(fmt::format("'{}' is not a portable float map", file.string()));
    tb::PictureMap values("", "", "", "", width, height);
    try {
      read_pfm(bytes, values);
    } catch (const spec::ConfigError& error) {
      throw spec::FileError(fmt::format("'{}': {}", file.string(), error.what()));
    }
    const tb::MapScale scale = scale_of(values);
    const tb::MapCodes codes = codes_of(values);
    maps_[fs::path(picture).stem().string()] = {{"title", map.value("title", "")},
                                                {"unit", map.value("unit", "")},
                                                {"width", width},
                                                {"height", height},
                                                {"least", scale.least},
                                                {"knee", scale.knee},
                                                {"knee_part", scale.part(scale.knee)},
                                                {"most", scale.most},
                                                {"step", codes.step},
                                                {"source", png_uri(encode_png(codes.picture))}};
  }

  // Runs with windows: what the page draws over time, and the table of them.
  void fill_windows(const fs::path& directory) {
    const std::string name = manifest_.value("records", Json::object()).value("windows", "");
    page_.set("has_windows", !name.empty());
    if (name.empty()) return;
    reject_path(directory, name);
    const fs::path file = directory / name;
    windows_ = tb::try_parse_json(tb::read_file(file, kMaxWindowsBytes));
    const auto demand = [&](bool valid) {
      if (!valid)
        throw spec::FileError(fmt::format("'{}' is not a valid file of windows", file.string()));
    };
    demand(windows_.is_object() && windows_.contains("series"));
    Json& series = windows_["series"];
    const std::size_t count = windows_["from"].size();
    const auto column = [&](const Json& values) {
      demand(values.is_array() && values.size() == count);
      for (const Json& value : values) demand(value.is_number_unsigned());
      return values.get<std::vector<std::uint64_t>>();
    };
    const std::vector<std::uint64_t> from = column(windows_["from"]),
                                     cycles = column(windows_["cycles"]);
    page_.set("windows_note",
              fmt::format("{} windows of {} cycles{}.", grouped(from.size()),
                          report_text(windows_["window_cycles"]),
                          windows_["window_cycles"] == windows_["asked_cycles"]
                              ? ""
                              : fmt::format("; {} were asked for, which would be too many windows",
                                            report_text(windows_["asked_cycles"]))));
    windows_["command"] =
        without_options(manifest_.value("command", ""), {"--trace", "--trace-from", "--trace-to"});
    page_.set("windows_command", windows_["command"].get<std::string>());

    // A rate is a series over cycles.
    std::vector<std::vector<std::uint64_t>> columns;
    mustache::data rates{mustache::data::type::list}, ports{mustache::data::type::list};
    Json kept = Json::object();
    for (const Json& rate : windows_["throughput"]) {
      const std::string key = rate.value("key", "");
      const std::string counter = key.substr(key.find('.') + 1);
      if (!series["work"].contains(counter)) continue;
      kept[counter] = series["work"][counter];
      columns.push_back(column(kept[counter]));
      rates << row({{"label", rate.value("label", "")}, {"unit", rate.value("unit", "")}});
    }
    const Json of_ports = series.value("ports", Json::object());
    for (const auto& [port, values] : of_ports.items()) {
      columns.push_back(column(values.value("outstanding", Json())));
      ports << port;
      for (const char* bytes : {"_bytes_read", "_bytes_written"})
        if (series["work"].contains(port + bytes))
          kept[port + bytes] = series["work"][port + bytes];
    }
    series["work"] = kept;  // the page needs no more of them
    windows_.erase("units");
    page_.set("window_rates", rates);
    page_.set("window_ports", ports);
    page_.set("has_ports", ports.is_non_empty_list());
    mustache::data rows{mustache::data::type::list};
    for (std::size_t i = 0; i < from.size(); ++i) {
      mustache::data line = row({{"index", std::to_string(i)},
                                 {"from", grouped(from[i])},
                                 {"to", grouped(from[i] + cycles[i])}});
      mustache::data values{mustache::data::type::list};
      for (const std::vector<std::uint64_t>& counts : columns)
        values << fmt::format("{:.3f}",
                              static_cast<double>(counts.at(i)) / static_cast<double>(cycles[i]));
      line.set("values", values);
      rows << line;
    }
    page_.set("windows", rows);

    mustache::data links{mustache::data::type::list};
    const Json of_links = result_.value("links", Json::object());
    for (const auto& [link, figures] : of_links.items())
      links << row({{"name", link},
                    {"full", figures.value("link", "")},
                    {"depth", report_text(figures.value("depth", Json()))},
                    {"beats", report_text(figures.value("beats", Json()))},
                    {"mean", fmt::format("{:.2f}", number(figures, "mean"))},
                    {"most", report_text(figures.value("most", Json()))},
                    {"full_percent", fmt::format("{:.1f}", number(figures, "full_percent"))}});
    page_.set("links", links);
  }

  // The command of a run without some of its options, so that others can be given behind it. Not
  // with a regular expression: it would be a sixth of this library's build.
  static std::string without_options(std::string command,
                                     std::initializer_list<std::string_view> options) {
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

  // Only names inside the directory: a manifest from elsewhere must not pull other files in.
  static void reject_path(const fs::path& directory, const fs::path& file) {
    if (file.empty() || file.has_parent_path())
      throw spec::FileError(fmt::format("'{}': '{}' is not a file name",
                                        (directory / "manifest.json").string(), file.string()));
  }

  // Unit or meaning of a key, from the result itself.
  std::string described(const std::string& key, const char* what) const {
    const auto all = result_.find("meaning");
    if (all == result_.end() || !all->contains(key)) return "";
    return (*all)[key].value(what, "");
  }

  void fill_tables() {
    mustache::data figures{mustache::data::type::list};
    bool any_against = false;
    for (const Json& figure : result_.value("figures", Json::array())) {
      const std::string key = figure.value("key", "");
      any_against = any_against || !against(figure).empty();
      figures << row({{"label", figure.value("label", "")},
                      {"value", figure_text(value_at(key))},
                      {"unit", described(key, "unit")},
                      {"against", against(figure)},
                      {"meaning", described(key, "meaning")}});
    }
    page_.set("has_figures", figures.is_non_empty_list());
    page_.set("has_against", any_against);
    page_.set("figures", figures);

    mustache::data memory{mustache::data::type::list};
    const double cycles = number(result_, "cycles");
    bool traffic = false;
    for (const auto& [name, value] : result_["memory"].items()) {
      std::string meaning = described("memory." + name, "meaning");
      if (meaning.ends_with('.')) meaning.pop_back();
      memory << row({{"name", meaning},
                     {"value", report_text(value)},
                     {"unit", described("memory." + name, "unit")}});
      traffic = traffic || (value.is_number() && value.get<double>() > 0);
    }
    for (const auto& [label, key] : {std::pair("Mean read bandwidth", "bytes_read"),
                                     std::pair("Mean write bandwidth", "bytes_written")})
      if (const double bytes = number(result_["memory"], key); cycles > 0 && bytes > 0)
        memory << row({{"name", label},
                       {"value", fmt::format("{:.3f}", bytes / cycles)},
                       {"unit", "byte/clk"}});
    page_.set("memory", memory);
    page_.set("has_traffic", traffic);

    mustache::data units{mustache::data::type::list};
    for (const auto& [name, unit] : result_["units"].items()) {
      std::string stalls;
      for (const auto& [cause, count] : unit["stalls"].items())
        if (count != 0)
          stalls += fmt::format("{}{} {}", stalls.empty() ? "" : ", ", cause, report_text(count));
      units << row({{"name", name},
                    {"busy", report_text(unit["busy"])},
                    {"idle", report_text(unit["idle"])},
                    {"stalls", stalls.empty() ? "-" : stalls}});
    }
    page_.set("units", units);
    page_.set("units_table", mustache::partial{[] {
                return std::string(
                    "<table><tr><th>Unit</th><th class=\"n\">Busy</th><th class=\"n\">Idle</th>"
                    "<th>Stalled, by cause</th></tr>{{#units}}<tr><td>{{name}}</td>"
                    "<td class=\"n\">{{busy}}</td><td class=\"n\">{{idle}}</td><td>{{stalls}}</td>"
                    "</tr>{{/units}}</table>");
              }});

    const Json& latency = result_["latency"];
    mustache::data percentiles{mustache::data::type::list};
    for (const char* key : {"min", "p50", "p95", "p99", "max"})
      percentiles << row({{"value", report_text(latency.value(key, Json()))}});
    page_.set("latency", percentiles);
    page_.set("latency_unit", report_text(latency.value("unit", Json("clk"))));
    // One value needs no histogram.
    const bool spread = latency.value("min", Json()) != latency.value("max", Json());
    page_.set("latency_spread", spread);
    page_.set("latency_single", report_text(latency.value("max", Json())));
    mustache::data histogram{mustache::data::type::list};
    for (const Json& bin : latency.value("histogram", Json::array()))
      histogram << row({{"from", report_text(bin.value("from", Json()))},
                        {"count", report_text(bin.value("count", Json()))}});
    page_.set("histogram", histogram);

    fill_memories();

    mustache::data work{mustache::data::type::list};
    for (const auto& [name, value] : result_["work"].items()) {
      work << row({{"name", name},
                   {"value", report_text(value)},
                   {"unit", described("work." + name, "unit")},
                   {"meaning", described("work." + name, "meaning")}});
    }
    page_.set("work", work);

    mustache::data checks{mustache::data::type::list};
    for (const auto& [name, value] : result_["checks"].items()) {
      std::string label = name;
      std::replace(label.begin(), label.end(), '_', ' ');
      checks << row({{"name", label},
                     {"value", report_text(value)},
                     {"meaning", described("checks." + name, "meaning")}});
    }
    page_.set("checks", checks);

    const auto quality = result_.find("quality");
    page_.set("has_quality", quality != result_.end());
    if (quality != result_.end()) {
      page_.set("quality_reference", quality->value("reference", ""));
      mustache::data rows{mustache::data::type::list};
      for (const auto& [label, key] :
           {std::pair("PSNR, whole frame", "psnr_"), std::pair("PSNR, edge pixels", "psnr_edge_"),
            std::pair("PSNR, silhouette pixels", "psnr_silhouette_")}) {
        const Json after = quality->value(std::string(key) + "db", Json());
        const Json before = quality->value(std::string(key) + "before_db", Json());
        if (after.is_null() && before.is_null()) continue;
        rows << row({{"name", label},
                     {"before", two_digits(before)},
                     {"after", two_digits(after)},
                     {"gain", gain_of(before, after)},
                     {"unit", "dB"}});
      }
      for (const auto& [label, key] :
           {std::pair("FLIP, less is better", "flip"), std::pair("SSIM", "ssim")}) {
        const Json after = quality->value(key, Json());
        const Json before = quality->value(std::string(key) + "_before", Json());
        if (after.is_null()) continue;
        rows << row({{"name", label},
                     {"before", fraction(before)},
                     {"after", fraction(after)},
                     {"gain", gain_of(before, after, 4)},
                     {"unit", ""}});
      }
      page_.set("quality", rows);
    }

    const auto change = result_.find("change");
    page_.set("has_change", change != result_.end());
    if (change != result_.end()) {
      mustache::data rows{mustache::data::type::list};
      for (const auto& [label, all, right] :
           {std::tuple("Changed by more than 2 codes", "over_2_percent", "right_over_2_percent"),
            std::tuple("Changed by more than 16 codes", "over_16_percent",
                       "right_over_16_percent")}) {
        rows << row({{"name", label},
                     {"all", two_digits(change->value(all, Json()))},
                     {"right", two_digits(change->value(right, Json()))},
                     {"unit", "%"}});
      }
      rows << row({{"name", "PSNR to what went in"},
                   {"all", two_digits(change->value("psnr_db", Json()))},
                   {"right", ""},
                   {"unit", "dB"}});
      page_.set("change", rows);
    }

    mustache::data parameters{mustache::data::type::list};
    for (const Json& p : manifest_.value("parameters", Json::array())) {
      const std::string value = report_text(p.value("value", Json()));
      mustache::data line = row({{"name", p.value("name", "")},
                                 {"kind", p.value("kind", "")},
                                 {"value", value},
                                 {"default", p.value("default", "")},
                                 {"range", p.value("range", "")},
                                 {"unit", unit_of_parameter(p)},
                                 {"meaning", p.value("meaning", "")}});
      line.set("changed", value != p.value("default", ""));
      parameters << line;
    }
    page_.set("parameters", parameters);
  }

  // A rate of memory is given in both units that its reader knows.
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
    mustache::data rows{mustache::data::type::list};
    for (const auto& [name, m] : memories.items()) {
      const auto text = [&of = m](const char* key) { return report_text(of.value(key, Json())); };
      rows << row({{"name", name},
                   {"content", text("content")},
                   {"kind", text("kind")},
                   {"size", fmt::format("{} x {}", text("words"), text("word_bits"))},
                   {"ports", text("ports")},
                   {"latency", text("read_latency")},
                   {"built", text("built_as")},
                   {"at_width", text("logical_bits_at_frame_width")},
                   {"logical", text("logical_bits")},
                   {"physical", text("physical_bits")}});
    }
    page_.set("memories", rows);
    mustache::data kinds{mustache::data::type::list};
    for (const auto& [kind, sum] : bits.items()) {
      const auto text = [&of = sum](const char* key) { return report_text(of.value(key, Json())); };
      kinds << row({{"kind", kind},
                    {"number", text("memories")},
                    {"at_width", text("logical_at_frame_width")},
                    {"logical", text("logical")},
                    {"physical", text("physical")}});
    }
    page_.set("memory_kinds", kinds);
    page_.set("memory_widths", at_width != 0 && at_width != logical);
    const auto megabits = [](std::uint64_t value) {
      return fmt::format("{:.2f} Mbit", static_cast<double>(value) / 1e6);
    };
    page_.set("memory_note", megabits(logical));
    page_.set("memory_physical_note", megabits(total("physical")));
    page_.set("memory_width_note", megabits(at_width));
    mustache::data idealised{mustache::data::type::list};
    for (const std::string& memory : tb::idealised_memories(result_))
      idealised << row({{"memory", memory}});
    page_.set("idealised", idealised);
    page_.set("is_idealised", !tb::idealised_memories(result_).empty());
  }

  void fill_origin() {
    mustache::data origin{mustache::data::type::list};
    for (const char* key :
         {"version", "commit", "compiler", "build_type", "systemc", "seed", "started"})
      if (manifest_.contains(key))
        origin << row({{"name", key}, {"value", shown_plain(manifest_[key])}});
    for (const Json& input : manifest_.value("inputs", Json::array()))
      origin << row({{"name", input.value("role", "input")},
                     {"value", fmt::format("{}  {}{}", input.value("file", ""),
                                           input.contains("sha256") ? "sha256 " : "",
                                           listed_content(input))}});
    page_.set("origin", origin);
  }

  static std::string shown_plain(const Json& value) {
    return value.is_string() ? value.get<std::string>() : tb::json_text(value);
  }

  Json result_, manifest_, windows_, maps_ = Json::object();
  std::string followed_;  // pixel whose history there is, "X,Y"
  mustache::data page_;
};

}  // namespace

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
