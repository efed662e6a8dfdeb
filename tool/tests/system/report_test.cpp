// SPDX-License-Identifier: MIT
// Opens report.html and pages of `deburr compare` from disk in headless Chromium, without a
// network, and looks at the picture: the page obeys the colour scheme, charts and images are there,
// no script has failed. Skipped with a message where there is no Chromium.
// DEBURR_KEEP_SCREENSHOTS=DIR leaves the pictures in DIR.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <ostream>
#include <set>
#include <string>
#include <utility>

#include "tb/base/atomic_file.h"
#include "tb/base/file.h"
#include "tb/harness/test_paths.h"
#include "tb/scene/image.h"
#include "tb/scene/image_io.h"

namespace deburr::tb::report_test {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxLog = 1 << 24;

// Of report_style.css: --page, --busy and --accent.
struct Scheme {
  const char *name, *option;
  Rgba8 page, busy, accent;
  friend void PrintTo(const Scheme& scheme, std::ostream* stream) { *stream << scheme.name; }
};
constexpr Scheme kSchemes[] = {
    {"light", "", {0xF6, 0xF5, 0xF2, 255}, {0x2B, 0x7A, 0x8F, 255}, {0x26, 0x58, 0x8A, 255}},
    {"dark",
     "--force-dark-mode",
     {0x13, 0x15, 0x18, 255},
     {0x4F, 0xA3, 0xB8, 255},
     {0x7F, 0xB2, 0xE5, 255}}};

std::string browser() {
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"})
    if (std::system((std::string("command -v ") + name + " >/dev/null 2>&1").c_str()) == 0)
      return name;
  return "";
}

double share(const Image& image, const Rgba8& colour, int first_row, int last_row) {
  constexpr int kTolerance = 3;
  std::int64_t hits = 0;
  for (int y = first_row; y < last_row; ++y)
    for (int x = 0; x < image.width; ++x) {
      bool same = true;
      for (std::size_t c = 0; c < 3; ++c)
        same = same && std::abs(image.at(x, y)[c] - colour[c]) <= kTolerance;
      hits += same;
    }
  return static_cast<double>(hits) / (static_cast<double>(image.width) * (last_row - first_row));
}

class Report : public testing::TestWithParam<Scheme> {
 protected:
  Report() {
    directory_ = fs::temp_directory_path() / ("deburr_report_" + std::to_string(::getpid()));
    fs::create_directories(directory_);
  }
  ~Report() override { fs::remove_all(directory_); }

  // Exit code of a shell command whose output goes to `log`.
  int shell(const std::string& command, const char* log) const {
    return std::system((command + " >" + (directory_ / log).string() + " 2>&1").c_str());
  }
  std::string log(const char* name) const { return read_file(directory_ / name, kMaxLog); }

  fs::path directory_;
};

TEST_P(Report, OpensFromDiskAndShowsChartsAndPictures) {
  const std::string chromium = browser();
  if (chromium.empty()) GTEST_SKIP() << "no Chromium here (Debian package chromium)";
  const fs::path run = directory_ / "run", picture = directory_ / "page.png";
  ASSERT_EQ(
      shell(command_path().string() + " run texture --size 128x128 --truth --out " + run.string(),
            "run.log"),
      0)
      << log("run.log");
  shell(chromium +
            " --headless --no-sandbox --disable-gpu --disable-background-networking --no-first-run"
            " --hide-scrollbars --host-resolver-rules='MAP * ~NOTFOUND' --enable-logging=stderr " +
            GetParam().option + " --user-data-dir=" + (directory_ / "profile").string() +
            " --window-size=1280,3200 --screenshot=" + picture.string() + " file://" +
            (run / "report.html").string(),
        "browser.log");
  ASSERT_TRUE(fs::exists(picture)) << log("browser.log");
  EXPECT_EQ(log("browser.log").find("CONSOLE"), std::string::npos) << log("browser.log");
  if (const char* keep = std::getenv("DEBURR_KEEP_SCREENSHOTS"))
    fs::copy_file(picture, fs::path(keep) / (std::string("report_") + GetParam().name + ".png"),
                  fs::copy_options::overwrite_existing);

  const Image page = read_image(picture);
  std::set<Rgba8> colours(page.pixels.begin(), page.pixels.end());
  EXPECT_GT(colours.size(), 200u) << "the page is blank";
  EXPECT_GT(share(page, GetParam().page, 0, page.height), 0.02)
      << "not in the " << GetParam().name << " scheme";
  EXPECT_GT(share(page, GetParam().busy, page.height / 3, page.height), 0.01)
      << "no chart has been drawn";
  // The viewer shows a checkerboard in the upper part of the page.
  EXPECT_GT(share(page, {0, 0, 0, 255}, 0, page.height / 3), 0.02) << "no picture in the viewer";
  EXPECT_GT(share(page, {255, 255, 255, 255}, 0, page.height / 3), 0.02)
      << "no picture in the viewer";
}

// A run that was watched: curves over time, histograms of links, maps with their pictures; the link
// of a window gives the command that writes its waves.
TEST_P(Report, ShowsARunOverTimeAndOverThePicture) {
  const std::string chromium = browser();
  if (chromium.empty()) GTEST_SKIP() << "no Chromium here (Debian package chromium)";
  const fs::path run = directory_ / "run", picture = directory_ / "page.png";
  ASSERT_EQ(
      shell(command_path().string() +
                " run texture --size 128x128 --windows 1000 --maps --trace 'colours' --trace-to "
                "9 --out " +
                run.string(),
            "run.log"),
      0)
      << log("run.log");
  const auto browse = [&](const std::string& what, const char* log) {
    shell(chromium +
              " --headless --no-sandbox --disable-gpu --disable-background-networking "
              "--no-first-run --hide-scrollbars --host-resolver-rules='MAP * ~NOTFOUND' "
              "--enable-logging=stderr " +
              GetParam().option + " --user-data-dir=" + (directory_ / "profile").string() +
              " --window-size=1280,5200 " + what + " 'file://" + (run / "report.html").string() +
              "#window-3'",
          log);
  };
  browse("--screenshot=" + picture.string(), "browser.log");
  ASSERT_TRUE(fs::exists(picture)) << log("browser.log");
  EXPECT_EQ(log("browser.log").find("CONSOLE"), std::string::npos) << log("browser.log");
  if (const char* keep = std::getenv("DEBURR_KEEP_SCREENSHOTS"))
    fs::copy_file(picture, fs::path(keep) / (std::string("windows_") + GetParam().name + ".png"),
                  fs::copy_options::overwrite_existing);
  if (GetParam().name != std::string("light")) return;  // the text is that of either scheme
  browse("--dump-dom", "dom.log");
  const std::string dom = log("dom.log");
  EXPECT_THAT(dom, testing::HasSubstr("Window 3: cycles 3,004 to 4,004."));
  EXPECT_THAT(dom, testing::ContainsRegex("--maps --out [^ ]*run --trace '\\*' --trace-from 3004 "
                                          "--trace-to 4004</pre>"));
  for (const char* const text :
       {"data-role=\"map_samples\"", "map_latency.pfm", "latency_fifo_entries",
        "<option>tag_stage</option>", "href=\"#window-3\">3,004 to 4,004</a>"})
    EXPECT_THAT(dom, testing::HasSubstr(text));
  // Chart.js has given the canvas the size of its box.
  for (const char* const canvas :
       {"rate-time", "unit-time", "port-time", "link-time", "link-histogram"})
    EXPECT_THAT(dom, testing::ContainsRegex(std::string("<canvas id=\"") + canvas +
                                            "\"[^>]*style=\"[^\"]*height: 2[0-9]+px"));
}

// What no scheme changes.
class ReportOfAnyScheme : public Report {};

// The link of a mismatch's row gives the command that follows its pixel; such a run has the table.
TEST_P(ReportOfAnyScheme, FollowsAPixel) {
  const std::string chromium = browser();
  if (chromium.empty()) GTEST_SKIP() << "no Chromium here (Debian package chromium)";
  const fs::path run = directory_ / "run";
  shell(command_path().string() + " run texture --size 64x48 --fault flip-bit --pixel 36,0 --out " +
            run.string(),
        "run.log");
  ASSERT_TRUE(fs::exists(run / "report.html")) << log("run.log");
  for (const int width : {1200, 390}) {
    SCOPED_TRACE(width);
    shell(chromium +
              " --headless --no-sandbox --disable-gpu --disable-background-networking "
              "--no-first-run --hide-scrollbars --host-resolver-rules='MAP * ~NOTFOUND' "
              "--enable-logging=stderr " +
              GetParam().option + " --user-data-dir=" + (directory_ / "profile").string() +
              " --window-size=" + std::to_string(width) + ",3000 --dump-dom 'file://" +
              (run / "report.html").string() + "#follow-7,9'",
          "dom.log");
    const std::string dom = log("dom.log");
    EXPECT_THAT(dom, testing::Not(testing::HasSubstr("CONSOLE")));
    EXPECT_THAT(dom, testing::HasSubstr("<h2 id=\"pixel\">What happened to pixel 36,0</h2>"));
    EXPECT_THAT(dom, testing::HasSubstr("id=\"follow\"><pre id=\"pixel-command\">"));  // not hidden
    EXPECT_THAT(dom, testing::ContainsRegex("--fault flip-bit --out [^ ]*run --pixel 7,9</pre>"));
    EXPECT_THAT(dom, testing::ContainsRegex("--pixel 36,0 --trace '\\*' --trace-from [0-9]+"));
  }
}

// The checks above can fail: a page whose script is broken draws no chart.
TEST_P(ReportOfAnyScheme, ABrokenPageIsNoticed) {
  const std::string chromium = browser();
  if (chromium.empty()) GTEST_SKIP() << "no Chromium here (Debian package chromium)";
  const fs::path file = directory_ / "broken.html", picture = directory_ / "page.png";
  write_file_atomically(file, "<!doctype html><script>undefined_function();</script>");
  shell(chromium +
            " --headless --no-sandbox --disable-gpu --disable-background-networking --no-first-run"
            " --enable-logging=stderr --user-data-dir=" +
            (directory_ / "profile").string() +
            " --window-size=640,480 --screenshot=" + picture.string() + " file://" + file.string(),
        "browser.log");
  ASSERT_TRUE(fs::exists(picture)) << log("browser.log");
  EXPECT_NE(log("browser.log").find("CONSOLE"), std::string::npos);
  const Image page = read_image(picture);
  EXPECT_LT(std::set<Rgba8>(page.pixels.begin(), page.pixels.end()).size(), 200u);
  EXPECT_LT(share(page, GetParam().busy, 0, page.height), 0.01);
}

// Runs side by side, and sweeps with their fronts over each other.
class ComparisonPage : public Report {
 protected:
  // Exit code 0 or 1 of the command, which writes its page.
  void compare(const std::string& a, const std::string& b) const {
    const int code =
        shell(command_path().string() + " compare " + (directory_ / a).string() + " " +
                  (directory_ / b).string() + " --html " + (directory_ / "page.html").string(),
              "compare.log");
    ASSERT_TRUE(WIFEXITED(code) && WEXITSTATUS(code) <= 1) << log("compare.log");
  }
  Image screenshot(const std::string& name, int height) const {
    const fs::path picture = directory_ / "page.png";
    shell(browser() +
              " --headless --no-sandbox --disable-gpu --disable-background-networking"
              " --no-first-run --hide-scrollbars --host-resolver-rules='MAP * ~NOTFOUND'"
              " --enable-logging=stderr " +
              GetParam().option + " --user-data-dir=" + (directory_ / "profile").string() +
              " --window-size=1280," + std::to_string(height) + " --screenshot=" +
              picture.string() + " file://" + (directory_ / "page.html").string(),
          "browser.log");
    EXPECT_TRUE(fs::exists(picture)) << log("browser.log");
    EXPECT_EQ(log("browser.log").find("CONSOLE"), std::string::npos) << log("browser.log");
    if (const char* keep = std::getenv("DEBURR_KEEP_SCREENSHOTS"))
      fs::copy_file(picture, fs::path(keep) / (name + "_" + GetParam().name + ".png"),
                    fs::copy_options::overwrite_existing);
    return read_image(picture);
  }
};

TEST_P(ComparisonPage, ShowsFiguresAndPicturesOfRuns) {
  if (browser().empty()) GTEST_SKIP() << "no Chromium here (Debian package chromium)";
  for (const auto& [name, more] : {std::pair("small", " --set texture.cache.bytes=1024"),
                                   std::pair("large", " --set texture.cache.ways=4")})
    ASSERT_EQ(shell(command_path().string() + " run texture --size 128x128 --truth --out " +
                        (directory_ / name).string() + more,
                    "run.log"),
              0)
        << log("run.log");
  compare("small", "large");
  const Image page = screenshot("compare_runs", 2200);
  EXPECT_GT(share(page, GetParam().page, 0, page.height), 0.02);
  EXPECT_GT(share(page, GetParam().busy, 0, page.height), 0.0002) << "no bars";
  // Two checkerboards side by side.
  for (const Rgba8& colour : {Rgba8{0, 0, 0, 255}, Rgba8{255, 255, 255, 255}})
    EXPECT_GT(share(page, colour, page.height / 3, page.height), 0.02) << "no pictures";
}

TEST_P(ComparisonPage, ShowsTheFrontsOfSweeps) {
  if (browser().empty()) GTEST_SKIP() << "no Chromium here (Debian package chromium)";
  for (const auto& [name, latency] : {std::pair("before", "100"), std::pair("after", "30")}) {
    const std::string file = (directory_ / name).string() + ".yaml";
    write_file_atomically(
        file,
        std::string("engine: texture\nbase:\n  scene: {source: tunnel, width: 48, height: 48, "
                    "texture_size: 64}\n  run.images: false\n  memory.latency: ") +
            latency +
            "\naxes:\n  texture.cache.bytes: [1024, 2048, 4096]\n  texture.cache.ways: "
            "[1, 2, 4]\nmetrics: {cycles: cycles, bits: memory_bits.total.physical}\n"
            "objectives: {minimise: [cycles, bits]}\n");
    for (const char* action : {"run", "collect"})
      ASSERT_EQ(shell("cd " + directory_.string() + " && " + command_path().string() + " sweep " +
                          file + " " + action,
                      "run.log"),
                0)
          << log("run.log");
  }
  compare("out/sweeps/before", "out/sweeps/after");
  const Image page = screenshot("compare_sweeps", 1800);
  EXPECT_GT(share(page, GetParam().page, 0, page.height), 0.02);
  EXPECT_GT(share(page, GetParam().accent, page.height / 4, page.height), 0.0005)
      << "no points of A";
  EXPECT_GT(share(page, {0xC2, 0x57, 0x1A, 255}, page.height / 4, page.height), 0.0001)
      << "no points of B";
}

INSTANTIATE_TEST_SUITE_P(Scheme, ComparisonPage, testing::ValuesIn(kSchemes),
                         [](const auto& scheme) { return std::string(scheme.param.name); });

INSTANTIATE_TEST_SUITE_P(Scheme, Report, testing::ValuesIn(kSchemes),
                         [](const auto& scheme) { return std::string(scheme.param.name); });

INSTANTIATE_TEST_SUITE_P(Scheme, ReportOfAnyScheme, testing::Values(kSchemes[0]),
                         [](const auto& scheme) { return std::string(scheme.param.name); });

}  // namespace
}  // namespace deburr::tb::report_test
