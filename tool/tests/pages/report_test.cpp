// SPDX-License-Identifier: MIT
// Whole pages of small results, compared word by word: each value at its position, in its unit and
// format.
#include "tool/pages/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>

#include "spec/error.h"
#include "tb/base/file.h"
#include "tb/run/picture_map.h"
#include "tb/scene/image.h"
#include "tb/scene/image_io.h"
#include "tb/scene/png.h"
#include "tool/tests/pages/page_words.h"

namespace deburr::tool::report_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::ordered_json;

constexpr const char* kResult = R"json({
  "schema": 4, "unit": "texture", "verdict": "fail", "reason": "3 of <them>",
  "checks": {"comparisons": 1000, "mismatches": 3, "traffic_comparisons": 2000, "traffic_mismatches": 4},
  "cycles": 400000, "clock_mhz": 200,
  "throughput": {"value": 0.75, "unit": "pixel/clk", "bound": 0.8, "bound_meaning": "A clock each."},
  "latency": {"unit": "clk", "min": 11, "p50": 12, "p95": 13, "p99": 1400, "max": 1500,
              "histogram": [{"from": 8, "count": 2000}, {"from": 16, "count": 3}]},
  "memory": {"bytes_read": 5242880, "bytes_written": 1048576, "lines_filled": 7000},
  "units": {"luma": {"busy": 1000, "idle": 2000, "stalls": {"wait_fill": 4000, "full": 0, "late": 1}},
            "blend": {"busy": 7, "idle": 8, "stalls": {"full": 0}}},
  "bottleneck": {"unit": "luma", "cause": "wait_fill", "cycles": 4000, "meaning": "A fill was late."},
  "memories": {
    "lines": {"content": "Rows.", "kind": "sram", "words": 2048, "word_bits": 24, "ports": "1R1W",
      "read_latency": 2, "built_as": "3 banks", "logical_bits": 49152, "physical_bits": 65536,
      "logical_bits_at_frame_width": 12345},
    "ring": {"content": "Codes.", "kind": "flops", "words": 4, "word_bits": 5, "ports": "2R1W",
      "read_latency": 0, "built_as": "registers", "logical_bits": 20, "physical_bits": 21,
      "logical_bits_at_frame_width": 19}},
  "memory_bits": {
    "flops": {"memories": 1, "logical": 20, "physical": 21, "logical_at_frame_width": 19},
    "total": {"memories": 2, "logical": 1490000, "physical": 2510000, "logical_at_frame_width": 340000}},
  "cost": {"technology": "osu018", "gates": {"low": 390512, "value": 402166, "high": 413820},
    "flip_flops": 25918, "memory_bits": 49152, "ns": {"low": 3.64, "value": 4.856, "high": 6.07},
    "clock_mhz": {"low": 164.7, "value": 205.9, "high": 274.7},
    "frames_per_s": {"low": 411.9, "value": 514.8, "high": 686.8}, "run_frames_per_s": 500,
    "yardstick_ratio": 1.153, "limited_by": "luma stage 8",
    "estimate": {"gates": 1, "flip_flops": 2, "ns": 3}, "sram": {"cacti_45nm": {"mm2": 0.0512}},
    "units": {
      "luma": {"basis": "estimate", "gates": {"low": 6500, "value": 10000, "high": 13500}, "flip_flops": 300,
        "memory_bits": 49152, "ns": {"low": 3.64, "value": 4.856, "high": 6.07}, "stage": "8",
        "estimate": {"gates": 10000, "flip_flops": 300, "ns": 4.856}},
      "blend": {"basis": "mapped", "gates": {"low": 392166, "value": 392166, "high": 392166}, "flip_flops": 25618,
        "memory_bits": 0, "ns": {"low": 0, "value": 0, "high": 0}, "stage": "",
        "estimate": {"gates": 400000, "flip_flops": 25000, "ns": 0}}}},
  "not_implementable": {"lines": "nine ports", "ring": "no latency"},
  "links": {"codes": {"link": "top.codes", "depth": 4, "beats": 9000, "mean": 1.256, "most": 3, "full_percent": 2.56}},
  "maps": {
    "work": {"title": "Work", "meaning": "Of each pixel.", "unit": "sample", "picture": "map_work.png",
      "values": "map_work.pfm", "pixels": 1004, "min": 1, "max": 16, "mean": 2.5, "sum": 4000, "checked_against": ""},
    "empty": {"title": "Empty", "meaning": "None.", "unit": "u", "picture": "map_empty.png", "values": "map_empty.pfm",
      "pixels": 0, "min": 0, "max": 0, "mean": 0, "sum": 0, "checked_against": ""}},
  "work": {"hits": 12345, "share": 0.123456, "on": true, "unknown": null},
  "notes": ["16 bits made 8", "<b>"],
  "first_mismatches": [
    {"check": "colours", "where": "cycle 812", "item": "pixel (3, 0)", "field": "red", "expected": "17", "got": "18"},
    {"check": "lines", "where": "cycle 9", "item": "pixel (12, 7)", "field": "blue", "expected": "1", "got": "2"},
    {"check": "fills", "where": "end", "item": "line 5", "field": "-", "expected": "5", "got": "6"}],
  "pixel": {"x": 3, "y": 0, "note": "one fragment", "differences": 1, "steps": [
    {"part": "fragment 0", "step": "level", "item": "of it", "golden": "4", "hardware": "2", "clock": 812,
     "differs": true},
    {"part": "fragment 0", "step": "colour", "item": "red", "golden": "", "hardware": "7", "clock": 1200,
     "differs": false},
    {"part": "blend", "step": "out", "item": "red", "golden": "9", "hardware": "", "clock": null, "differs": false},
    {"part": "blend", "step": "end", "item": "all", "golden": "9", "hardware": "9", "clock": 34, "differs": false}]},
  "figures": [
    {"label": "Hits", "key": "work.hits", "against": {"label": "a remark"}},
    {"label": "Whole run", "key": "cycles", "against": {"label": "bound", "key": "work.bound"}},
    {"label": "Share", "key": "work.share", "against": {"label": "formula", "key": "work.share"}},
    {"label": "Switch", "key": "work.on"},
    {"label": "More", "key": "work.hits", "against": {"label": "Lines", "key": "memory.lines_filled"}},
    {"label": "Nothing", "key": "work.unknown", "against": {"label": "Lines", "key": "memory.lines_filled"}}],
  "quality": {"reference": "reference-16", "psnr_db": 41.256, "psnr_edge_db": 31.5, "psnr_silhouette_db": 22.126,
    "psnr_before_db": 35.5, "psnr_edge_before_db": 33.25, "psnr_silhouette_before_db": null,
    "identical": {"psnr_db": false}, "flip": 0.0125, "flip_before": 0.05, "ssim": 0.98765, "ssim_before": null},
  "change": {"over_2_percent": 12.5, "over_16_percent": 3.25, "right_over_2_percent": 1.5,
    "right_over_16_percent": 0.5, "psnr_db": null, "identical": {"psnr_db": true}},
  "host": {"seconds": 2.46, "mcycles_per_s": 1.376, "cpu_seconds": 1.33},
  "meaning": {
    "checks.mismatches": {"unit": "", "meaning": "Wrong."},
    "memory.bytes_read": {"unit": "byte", "meaning": "Read."}, "memory.lines_filled": {"unit": "line", "meaning": "Lines"},
    "memory.bytes_written": {"unit": "byte", "meaning": "Written."},
    "work.hits": {"unit": "hit", "meaning": "Found there."}, "cycles": {"unit": "clk", "meaning": "All cycles."}}
})json";

constexpr const char* kManifest = R"json({
  "title": "A <title>", "summary": "of a test", "command": "deburr run texture --trace 'a b' --size 4x3 --pixel=3,0 --maps",
  "pixel_history": true,
  "version": "1.2", "commit": "abc", "compiler": "gcc", "build_type": "Release", "systemc": "2.3", "seed": 7,
  "started": "today",
  "inputs": [{"file": "x.png", "sha256": "1234"}, {"file": "c.yaml", "sha256": "99", "role": "configuration"},
             {"file": "gone.obj", "missing": true}],
  "images": [{"file": "after.png", "role": "after", "title": "After", "caption": "Came out."},
             {"file": "map_work.png", "role": "map_work", "title": "Map: Work"}],
  "records": {"intervals": "intervals.json"},
  "parameters": [
    {"name": "cache.ways", "kind": "build", "value": "4", "default": "2", "range": "1..8", "unit": "way", "meaning": "Ways."},
    {"name": "rate", "kind": "run", "value": "8", "default": "8", "range": "1..9", "unit": "byte/clk", "meaning": "Rate."}]
})json";

constexpr const char* kIntervals = R"json({
  "schema": 1, "asked_cycles": 500, "interval_cycles": 1000, "intervals": 2, "from": [0, 1000], "cycles": [1000, 400],
  "throughput": [{"key": "work.pixels", "label": "Pixels", "unit": "pixel/clk", "bound": 1},
                 {"key": "work.absent", "label": "Absent", "unit": "x/clk", "bound": 0}],
  "series": {"units": {"luma": {"busy": [1, 2]}},
    "work": {"pixels": [900, 100], "hits": [1, 2], "port_bytes_read": [64, 0], "port_bytes_written": [0, 64]},
    "links": {"codes": {"beats": [1, 2]}},
    "ports": {"port": {"outstanding": [250, 300], "most": [2, 3]}}},
  "units": {"work.hits": "hit"}
})json";

constexpr const char* kPage = R"page(
Deburr &middot;
texture
A &lt;title&gt;|badge fail|fail
of a test
Note: 16 bits made 8
Note: &lt;b&gt;
Not implementable:
this hardware cannot be built as it is.|Memories that no technology provides:
lines (nine ports);
ring (no latency);
the figures below do not apply to a real design.
3 of &lt;them&gt;
First mismatches|Pixel 3,0|Pictures|Key figures
Checks|Throughput|Units|Over time|Links|Memories|Cost|Work|Reproduce|Parameters|Made by
--columns: 7
tile bad|Mismatches|7|of 3,000 comparisons
tile|Cycles|400,000|clk|2.00 ms at 200 MHz
tile|Throughput|0.750|pixel/clk, 93.8 % of the bound 0.8
tile|Latency p50|12|clk|p99 1,400, max 1,500
tile|Read from memory|5.00|MiB|7,000 reads
tile|PSNR, edge pixels|31.50|dB|-1.75 dB, before 33.25
tile|Simulation|1.38|Mcycle/s|2.5 s, of which 1.3 s processor time
First mismatches
Check|Where|Item|Field|Expected|Got|History
colours|cycle 812|pixel (3, 0)|red|17|18|below
lines|cycle 9|pixel (12, 7)|blue|1|2|#follow-12,7|copy its command
fills|end|line 5|-|5|6
History of pixel 3,0
Golden model and hardware side by side, with the cycle in which the hardware did each step.
Steps that differ: 1;
one fragment.
Step|Value|Golden|Hardware|Cycle
fragment 0
differs|level|of it|4|2|812
colour|red|-|7|1,200
blend
out|red|9|-|-
end|all|9|9|34
Waveforms around this pixel
deburr run texture --size 4x3 --maps --pixel 3,0 --trace &apos;*&apos; --trace-from 34 --trace-to 1202
Pictures
Left
Right
Wheel:
zoom;
drag:
move the picture, or the divider.
Keyboard:
arrows select a pixel (with Shift, ten pixels on), + and &minus;
zoom, Home fits the picture.
Click or Enter copies the command that records the pixel's history.
deburr run texture --size 4x3 --maps --pixel X,Y
part|--ratio: 1.3333; --across: 100.00%; --down: 100.00%|PNG|After|After|after|After|Came out.
part|--ratio: 1.3333; --across: 150.00%; --down: 300.00%|PNG|Map: Work|Map: Work|map_work|Map: Work
Maps over the picture
Map|Minimum|Mean|Maximum|Unit|Sum|Pixels|Values|Meaning
work|1|2.5|16|sample|4,000|1,004|map_work.pfm|map_work.pfm|Of each pixel.
empty|0|0|0|u|0|0|map_empty.pfm|map_empty.pfm|None.
Key figures
What|Value|Unit|Against
Found there.|Hits|12,345|hit|a remark
All cycles.|Whole run|400,000|clk
Share|0.1235|= formula
Switch|yes
Found there.|More|12,345|hit|Lines 7,000, +76.4 %
Nothing|-
Quality against|reference-16
Measure|Before|After|Gain|Unit
PSNR, whole frame|35.50|41.26|+5.76|dB
PSNR, edge pixels|33.25|31.50|-1.75|dB
PSNR, silhouette pixels|-|22.13|-|dB
FLIP, less is better|0.0500|0.0125|-0.0375
SSIM|-|0.9877|-
Changed pixels
Pixels, compared with the input|All|Correct input|Unit
Changed by more than 2 codes|12.50|1.50|%
Changed by more than 16 codes|3.25|0.50|%
PSNR to the input|identical|dB
Checks
Check|Value|Meaning
comparisons|1,000
mismatches|3|Wrong.
traffic comparisons|2,000
traffic mismatches|4
Throughput and its limits
Rate over the whole run|0.75 of 0.8 pixel/clk (93.8 %)
width: 93.75%
Bound: A clock each.
Limited by luma:
stalled, wait fill|4,000 of 7,001 clk (57.1 %)
width: 57.13%
A fill was late.
At 200.00 MHz this is 150.0 Mpixel/s.
Memory traffic
What|Amount|Unit
Read|5,242,880|byte
Written|1,048,576|byte
Lines|7,000|line
Mean read bandwidth|13.107|byte/clk
Mean write bandwidth|2.621|byte/clk
Latency of a transaction
min|p50|p95|p99|max|Unit
11|12|13|1,400|1,500|clk
From|Transactions
8|2,000
16|3
Activity of each unit in 400,000 cycles
Busy:
work was done on at least one lane, or was in progress.
Stalled:
there was work, but none could be done.
Idle:
there was no work, or the unit only waited for memory responses.
Figures
Unit|Busy|Idle|Stalled, by cause
luma|1,000|2,000|wait_fill 4,000, late 1
blend|7|8|-
Unit|Busy|Idle|Stalled, by cause
luma|1,000|2,000|wait_fill 4,000, late 1
blend|7|8|-
Over time
2 intervals of 1,000 cycles;
intervals of 500 cycles were requested, which would be too many.
Click an interval in a chart to get the command that records its waveforms.
Unit
Memory
Waveforms of an interval
deburr run texture --size 4x3 --pixel=3,0 --maps --trace '*' --trace-from FROM --trace-to TO
Every interval
Cycles|Pixels, pixel/clk|port:
in flight, mean
0 to 1,000|0.900|0.250
1,000 to 1,400|0.250|0.750
Links and FIFOs
Number of stored beats at the end of each cycle.
Link
Every link
Link|Waveform|Depth|Beats|Mean|Maximum|Full, % of cycles
codes|top.codes|4|9,000|1.26|3|2.6
Memories
1.49 Mbit of words (0.34 Mbit for frames of this width), 2.51 Mbit built, including copies for more read ports and padding of the last bank.
Links, and registers outside the memory words, are not in the total.
Kind|Memories|Bits at this width|Logical bits|Physical bits
flops|1|19|20|21
total|2|340,000|1,490,000|2,510,000
Every memory
Memory|Kind|Words x bits|Ports|Read latency, clk|Built as|Bits at this width|Logical bits|Physical bits|Holds
lines|sram|2,048 x 24|1R1W|2|3 banks|12,345|49,152|65,536|Rows.
ring|flops|4 x 5|2R1W|0|registers|19|20|21|Codes.
Cost
Two-input NAND gates and nanoseconds of the standard cells osu018.
Basis|mapped|:
measured on RTL of these very parameters;|estimate|:
the sum of the unit's operators, registers and flip-flop memories, with its range.
The marked unit has the longest path.
What|Value|Unit
Clock limit by the longest path|206|165 to 275|MHz
Frames like this one at this limit|515|412 to 687|frame/s
The same at run.clock_mhz = 200|500|frame/s
Longest path, relative to a 24 x 24 multiply|1.15
Area of all SRAM in cacti_45nm|0.0512|mm²
Every unit
Unit|Gates|Flip-flops|Memory, bit|Longest path, ns|Stage|Basis
changed|luma|10,000|6,500 to 13,500|300|49,152|4.86|3.64 to 6.07|8|estimate
blend|392,000|25,618|0|-|mapped
all|402,000|391,000 to 414,000|25,918|49,152|4.86|3.64 to 6.07|luma stage 8
Not covered:
the register block, performance counters, wires and placement.
Work
Every counter
Counter|Value|Unit|Meaning
hits|12,345|hit|Found there.
share|0.1235
on|true
unknown|-
Reproduce
deburr run texture --trace &apos;a b&apos; --size 4x3 --pixel=3,0 --maps
Parameters
Marked rows differ from the default.
Parameters of kind rule change pixels, those of kind build change cycles and cost.
Runs with equal inputs and rules share one golden result.
Name|Kind|Value|Default|Range|Unit|Meaning
changed|cache.ways|build|4|2|1..8|way|Ways.
rate|run|8|8|1..9|byte/clk, 1.6 GB/s|Rate.
Made by
What|Value
version|1.2
commit|abc
compiler|gcc
build_type|Release
systemc|2.3
seed|7
started|today
input|x.png  sha256 1234
configuration|c.yaml  sha256 99
input|gone.obj  missing
)page";

class Pages : public testing::Test {
 protected:
  Pages()
      : path_(fs::temp_directory_path() / ("deburr_report_page_" + std::to_string(::getpid()))) {
    fs::create_directories(path_);
    put("intervals.json", kIntervals);
    write_image(path_ / "after.png", tb::Image(4, 3, {10, 20, 30, 255}));
    write_image(path_ / "map_work.png", tb::Image(6, 9, {10, 20, 30, 255}));
    put("map_work.pfm", pfm_of(values()));
  }
  ~Pages() override { fs::remove_all(path_); }

  void put(const char* name, const std::string& text) const { std::ofstream(path_ / name) << text; }
  static tb::PictureMap values() {
    tb::PictureMap map("work", "Work", "sample", "Of each pixel.", 4, 3);
    for (int i = 0; i < 11; ++i) map.set(i % 4, i / 4, 1 + i / 2.0);
    return map;
  }
  std::string page_of(const Json& result, const Json& manifest) const {
    return build_report(path_, result, manifest);
  }

  fs::path path_;
  Json result_ = Json::parse(kResult), manifest_ = Json::parse(kManifest);
};

// Lines with this prefix.
std::string lines(const std::string& text, const std::string& begin) {
  std::string found;
  std::istringstream all(text);
  for (std::string line; std::getline(all, line);)
    if (line.starts_with(begin)) found += line + "\n";
  return found;
}

TEST_F(Pages, ShowEveryPartOfACompleteRun) { EXPECT_EQ(words(page_of(result_, manifest_)), kPage); }

Json data_of(const std::string& page) {
  const std::string begin = R"(<script type="application/json" id="data">)";
  const std::size_t at = page.find(begin) + begin.size();
  return Json::parse(page.substr(at, page.find("</script>", at) - at));
}

// The data that the page's scripts draw.
TEST_F(Pages, HoldTheDataOfTheirCharts) {
  const Json data = data_of(page_of(result_, manifest_));
  Json expected = result_;
  EXPECT_EQ(data["result"].dump(1), expected.dump(1));
  expected = Json::parse(kIntervals);
  expected.erase("units");
  expected["series"]["work"].erase("hits");
  expected["command"] = "deburr run texture --size 4x3 --pixel=3,0 --maps";
  EXPECT_EQ(data["intervals"], expected);
  Json map = data["maps"];
  ASSERT_EQ(map.size(), 1u) << "of the empty one there is nothing to say";
  const tb::Image codes = codes_of(values()).picture;
  EXPECT_EQ(map["map_work"]["source"], png_uri(encode_png(codes)));
  map["map_work"].erase("source");
  EXPECT_EQ(map, (Json{{"map_work",
                        {{"title", "Work"},
                         {"unit", "sample"},
                         {"width", 4},
                         {"height", 3},
                         {"least", 1.0},
                         {"knee", 6.0},
                         {"knee_part", 1.0},
                         {"most", 6.0},
                         {"step", 1.0 / 256}}}}));
  EXPECT_EQ(data["map_colours"], Json(tb::map_colours()));
}

TEST_F(Pages, ShowTilesForAvailableFigures) {
  const auto tiles = [&] {
    return lines(words(page_of(result_, Json::object())), "tile") +
           lines(words(page_of(result_, Json::object())), "--columns");
  };
  result_.erase("bottleneck");
  result_["checks"]["mismatches"] = 0u;
  result_["throughput"] = {{"value", 1.5}, {"unit", "pixel"}, {"bound", 0}};
  result_["memory"]["bytes_read"] = 0;
  result_["quality"] = {{"psnr_db", 41.256}, {"psnr_before_db", 35.5}};
  result_["clock_mhz"] = 0;
  result_["checks"]["traffic_mismatches"] = 0u;
  result_["interrupted"] = true;
  EXPECT_EQ(tiles(),
            "tile|Mismatches|0|of 3,000 comparisons, incomplete\n"
            "tile|Cycles|400,000|clk\n"
            "tile|Throughput|1.500|pixel\n"
            "tile|Latency p50|12|clk|p99 1,400, max 1,500\n"
            "tile|PSNR|41.26|dB|+5.76 dB, before 35.50\n"
            "tile|Simulation|1.38|Mcycle/s|2.5 s, of which 1.3 s processor time\n"
            "--columns: 6\n");
  // Tiles of the engine replace the common ones; more than seven are placed in two rows.
  result_["interrupted"] = false;
  result_["clock_mhz"] = 100;
  result_["quality"] = {{"psnr_db", nullptr}, {"identical", {{"psnr_db", true}}}};
  const auto figure = [](const char* label, const char* key) {
    return Json{{"label", label}, {"key", key}, {"tile", true}};
  };
  Json whole = figure("Whole run", "cycles");
  whole["against"] = {{"label", "bound"}, {"key", "work.hits"}};
  result_["figures"] = {whole, figure("Late", "latency.p99"),
                        figure("Lines", "memory.lines_filled"), figure("On", "work.on")};
  result_["memory"]["bytes_read"] = 9;
  result_["checks"]["traffic_mismatches"] = 1u;
  EXPECT_EQ(tiles(),
            "tile bad|Mismatches|1|of 3,000 comparisons\n"
            "tile|Whole run|400,000|clk|bound 12,345, +3140.2\u00a0%; 4.00 ms at 100 MHz\n"
            "tile|Late|1,400\n"
            "tile|Lines|7,000|line\n"
            "tile|On|yes\n"
            "tile|Throughput|1.500|pixel\n"
            "tile|PSNR|identical|dB|of the output\n"
            "tile|Simulation|1.38|Mcycle/s|2.5 s, of which 1.3 s processor time\n"
            "--columns: 4\n");
  result_["checks"] = {{"comparisons", 0u},
                       {"mismatches", 0u},
                       {"traffic_comparisons", 1u},
                       {"traffic_mismatches", 0u}};
  EXPECT_THAT(tiles(), HasSubstr("tile good|Mismatches|0|of 1 comparisons\n"));
  result_["checks"]["traffic_comparisons"] = 0u;
  EXPECT_THAT(tiles(), HasSubstr("tile|Mismatches|-|not checked against the golden model\n"));
  result_["figures"].push_back(figure("Off", "work.on"));
  EXPECT_THAT(tiles(), HasSubstr("--columns: 5\n")) << "of nine";
  EXPECT_THAT(words(page_of(result_, Json::object())),
              HasSubstr("At 100.00 MHz this is 150.0 Mpixel/s."));
}

// Pictures of a frame with few rows or columns are enlarged; a picture larger than the frame is
// cropped.
TEST_F(Pages, PicturesHaveTheFramesShape) {
  const auto shape = [&](int width, int height) {
    write_image(path_ / "after.png", tb::Image(width, height));
    const Json manifest = {
        {"images", {{{"file", "after.png"}}, {{"file", "large.png"}, {"title", "L"}}}}};
    return lines(words(page_of(result_, manifest)), "flat") +
           lines(words(page_of(result_, manifest)), "tall") +
           lines(words(page_of(result_, manifest)), "part");
  };
  write_image(path_ / "large.png", tb::Image(80, 80));
  EXPECT_EQ(
      shape(8, 1),
      "part|--ratio: 8.0000; --across: 100.00%; --down: 100.00%|PNG|after.png|after.png|after.png\n"
      "part|--ratio: 8.0000; --across: 1000.00%; --down: 8000.00%|PNG|L|L|L\n");
  EXPECT_THAT(shape(16, 1), testing::StartsWith("flat|--ratio: 16.0000;"));
  EXPECT_THAT(shape(1, 8), testing::StartsWith("part|--ratio: 0.1250;"));
  EXPECT_THAT(shape(1, 16), testing::StartsWith("tall|--ratio: 0.0625;"));
}

TEST_F(Pages, DamagedFilesAreRejected) {
  const auto says = [&](const char* file, const std::string& text, const std::string& expected) {
    const std::string before = tb::read_file(path_ / file, 1 << 20);
    put(file, text);
    try {
      page_of(result_, manifest_);
      ADD_FAILURE() << file << ": " << text;
    } catch (const spec::FileError& error) {
      EXPECT_THAT(error.what(), HasSubstr((path_ / file).string() + "' " + expected));
    }
    put(file, before);
  };
  const auto intervals = [](const char* at, Json value) {
    Json changed = Json::parse(kIntervals);
    changed[Json::json_pointer(at)] = std::move(value);
    return changed.dump();
  };
  const std::string is_none = "is not a valid file of intervals";
  says("intervals.json", "[]", is_none);
  says("intervals.json", "{}", is_none);
  says("intervals.json", intervals("/cycles", {1000}), is_none);
  says("intervals.json", intervals("/cycles/1", -400), is_none);
  says("intervals.json", intervals("/series/work/pixels", {900, 100, 1}), is_none);
  says("intervals.json", intervals("/series/ports/port/outstanding/0", "1"), is_none);
  for (const char* const map :
       {"", "Pf 4", "Pf 0 3\n-1.0\n", "Pf 4 0\n-1.0\n", "Pf 4 3\n-1.0\n1234"})
    says("map_work.pfm", map, "is not a portable float map");
  fs::remove(path_ / "map_work.pfm");
  EXPECT_EQ(data_of(page_of(result_, manifest_))["maps"], Json::object()) << "its values are gone";
}

}  // namespace
}  // namespace deburr::tool::report_test
