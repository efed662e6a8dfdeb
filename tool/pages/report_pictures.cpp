// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "spec/error.h"
#include "tb/base/file.h"
#include "tb/run/amount.h"
#include "tb/run/picture_map.h"
#include "tb/scene/png.h"
#include "tool/pages/report.h"
#include "tool/pages/report_parts.h"

namespace deburr::tool {
namespace {

namespace fs = std::filesystem;
namespace mustache = kainjow::mustache;
using Json = nlohmann::ordered_json;

// Width and height; {0, 0} if it is not a PNG.
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

// Frames with only a few rows or columns are stretched, so that they can be seen. Pictures larger
// than the frame (with the scale of a map) are cropped to the frame.
void fill_stills(const ReportSource& source, mustache::data& page) {
  constexpr std::uint64_t kNarrow = 8;
  const Json list = source.manifest.value("images", Json::array());
  std::vector<std::string> pngs;
  std::uint64_t width = UINT64_MAX, height = UINT64_MAX;
  for (const Json& image : list) {
    const fs::path file = image.value("file", "");
    reject_path(source.directory, file);
    pngs.push_back(tb::read_file(source.directory / file, kMaxImageBytes));
    const auto [across, down] = png_size(pngs.back());
    width = std::min(width, across);
    height = std::min(height, down);
  }
  width = std::max<std::uint64_t>(width, 1);  // not a PNG
  height = std::max<std::uint64_t>(height, 1);
  const char* const shape = width / kNarrow > height   ? "flat"
                            : height / kNarrow > width ? "tall"
                                                       : "part";
  mustache::data images{mustache::data::type::list};
  for (std::size_t i = 0; i < list.size(); ++i) {
    const auto [across, down] = png_size(pngs[i]);
    mustache::data still;
    still.set("title", list[i].value("title", list[i].value("file", "")));
    still.set("role", list[i].value("role", ""));
    still.set("caption", breakable(list[i].value("caption", "")));
    still.set("shape", std::string(shape));
    still.set("source", png_uri(pngs[i]));
    still.set("ratio", fmt::format("{:.4f}", double(width) / double(height)));
    still.set("across", fmt::format("{:.2f}", 100.0 * double(across) / double(width)));
    still.set("down", fmt::format("{:.2f}", 100.0 * double(down) / double(height)));
    images << still;
  }
  page.set("has_images", images.is_non_empty_list());
  page.set("images", images);
}

// The page's text for a pixel of a map; empty if its value file is missing.
void keep_values(const fs::path& directory, const Json& map, Json& kept) {
  const std::string picture = map.value("picture", ""), name = map.value("values", "");
  if (picture.empty() || name.empty() || number(map, "pixels") == 0) return;
  reject_path(directory, name);
  const fs::path file = directory / name;
  if (!fs::exists(file)) return;
  const std::string bytes = tb::read_file(file, kMaxImageBytes);
  int width = 0, height = 0;
  // Checks that the values exist before memory for them is allocated.
  if (std::sscanf(bytes.c_str(), "Pf %d %d", &width, &height) != 2 || width < 1 || height < 1 ||
      static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) > bytes.size() / 4)
    throw spec::FileError(fmt::format("'{}' is not a portable float map", file.string()));
  tb::PictureMap values("", "", "", "", width, height);
  try {
    tb::read_pfm(bytes, values);
  } catch (const spec::ConfigError& error) {
    throw spec::FileError(fmt::format("'{}': {}", file.string(), error.what()));
  }
  const tb::MapScale scale = tb::scale_of(values);
  const tb::MapCodes codes = tb::codes_of(values);
  kept[fs::path(picture).stem().string()] = {{"title", map.value("title", "")},
                                             {"unit", map.value("unit", "")},
                                             {"width", width},
                                             {"height", height},
                                             {"least", scale.least},
                                             {"knee", scale.knee},
                                             {"knee_part", scale.part(scale.knee)},
                                             {"most", scale.most},
                                             {"step", codes.step},
                                             {"source", png_uri(tb::encode_png(codes.picture))}};
}

}  // namespace

Json fill_pictures(const ReportSource& source, mustache::data& page) {
  fill_stills(source, page);
  Json kept = Json::object();
  HtmlTable table(
      "Map|Minimum:n|Mean:n|Maximum:n|Unit|Sum:n|Pixels:n|Values:mono|Meaning:muted meaning");
  const Json maps = source.result.value("maps", Json::object());
  for (const auto& [name, map] : maps.items()) {
    const auto text = [&of = map](const char* key) { return tb::amount(number(of, key)); };
    const std::string file = map.value("values", "");
    table.row({name, text("min"), text("mean"), text("max"), map.value("unit", ""), text("sum"),
               report_text(map, "pixels"), HtmlCell::link(file, file), map.value("meaning", "")});
    keep_values(source.directory, map, kept);
  }
  page.set("has_maps", table.rows() > 0);
  page.set("maps", table.html());
  return kept;
}

}  // namespace deburr::tool
