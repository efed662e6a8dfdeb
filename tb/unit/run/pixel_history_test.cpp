// SPDX-License-Identifier: MIT
// A pixel address is parsed strictly, and its history shows the differences, even when it is
// shortened.
#include "tb/run/pixel_history.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "spec/error.h"
#include "tb/run/result.h"

namespace deburr::tb::pixel_history_test {
namespace {

std::string rejection(const std::string& text) {
  try {
    pixel_of(text);
  } catch (const spec::ConfigError& error) {
    return error.what();
  }
  return "";
}

PixelStep step(std::string item, std::string golden, std::string hardware) {
  return {.part = "fragment 0",
          .step = "level",
          .item = std::move(item),
          .golden = std::move(golden),
          .hardware = std::move(hardware),
          .clock = 12};
}

TEST(PixelAddress, ConsistsOfTwoIntegers) {
  EXPECT_EQ(pixel_of("12,7"), (PixelAddress{12, 7}));
  EXPECT_EQ(pixel_of("0,0"), (PixelAddress{0, 0}));
  for (const char* text : {"", "12", "12,", ",7", "12,7,3", "-1,2", "1,-2", "a,b", "1, 2", "1x2",
                           "99999999999,0", "1.5,2"}) {
    const std::string said = rejection(text);
    EXPECT_NE(said.find("run.pixel: expected X,Y"), std::string::npos) << text << ": " << said;
    EXPECT_NE(said.find(std::string("got '") + text + "'"), std::string::npos) << said;
  }
}

TEST(PixelAddress, MustLieWithinPicture) {
  EXPECT_NO_THROW(reject_outside({639, 479}, 640, 480));
  for (const PixelAddress pixel : {PixelAddress{640, 479}, {639, 480}}) try {
      reject_outside(pixel, 640, 480);
      ADD_FAILURE() << "outside";
    } catch (const spec::ConfigError& error) {
      const std::string said = error.what();
      EXPECT_NE(said.find("640 x 480"), std::string::npos) << said;
      EXPECT_NE(said.find("0..639"), std::string::npos) << said;
      EXPECT_NE(said.find("0..479"), std::string::npos) << said;
    }
}

TEST(PixelHistory, ValueDiffersIfBothSidesHaveIt) {
  PixelHistory history{{3, 4}};
  history.compare(step("same", "2", "2"));
  history.compare(step("other", "2", "3"));
  history.compare(step("golden alone", "2", ""));
  history.compare(step("hardware alone", "", "3"));
  EXPECT_EQ(history.differences(), 1U);
  EXPECT_TRUE(history.steps[1].differs);
}

// An event that one side lacks differs; an event that the other side has not reached yet is not
// missing.
TEST(PixelHistory, EventDiffersIfOneSideLacksIt) {
  PixelHistory history{{3, 4}};
  history.compare(step("same", "2", "2"), {true, true});
  history.compare(step("other", "2", "3"), {true, true});
  history.compare(step("lost", "2", ""), {true, true});
  history.compare(step("added", "", "3"), {true, false});
  history.compare(step("cut short", "2", ""), {true, false});
  history.compare(step("no golden model", "", "3"), {false, true});
  std::string differ;
  for (const PixelStep& one : history.steps) differ += one.differs ? '!' : '.';
  EXPECT_EQ(differ, ".!!!..");
}

// One word per step, the golden letter first: "A-" is an event that the hardware lacks, "AB!"
// differs.
std::string paired(const std::string& golden, const std::string& hardware, PixelSides came) {
  PixelHistory history{{3, 4}};
  history.compare_records(
      golden.size(), hardware.size(),
      [&](std::size_t g, std::size_t h) { return golden[g] == hardware[h]; },
      [&](PixelHistory::Record g, PixelHistory::Record h) {
        return step("letter", g ? std::string(1, golden[*g]) : "",
                    h ? std::string(1, hardware[*h]) : "");
      },
      came);
  std::string text;
  for (const PixelStep& one : history.steps)
    text += (one.golden.empty() ? "-" : one.golden) + (one.hardware.empty() ? "-" : one.hardware) +
            (one.differs ? "! " : " ");
  return text;
}

TEST(PixelHistory, LostEventDoesNotAffectOthers) {
  const PixelSides both{true, true}, cut{true, false}, alone{false, true};
  EXPECT_EQ(paired("ABC", "ABC", both), "AA BB CC ");
  EXPECT_EQ(paired("ABC", "AXC", both), "AA BX! CC ");
  EXPECT_EQ(paired("ABC", "BC", both), "A-! BB CC ");
  EXPECT_EQ(paired("ABC", "AC", cut), "AA B-! CC ");
  EXPECT_EQ(paired("ABC", "AABC", both), "AA -A! BB CC ");
  EXPECT_EQ(paired("AB", "BA", both), "A-! BB -A! ") << "as near both ways: it lacks one";
  EXPECT_EQ(paired("ABC", "CAB", both), "-C! AA BB C-! ") << "one added is nearer";
  EXPECT_EQ(paired("ABC", "A", both), "AA B-! C-! ");
  EXPECT_EQ(paired("ABC", "A", cut), "AA B- C- ");
  EXPECT_EQ(paired("", "A", alone), "-A ");
}

TEST(PixelHistory, KeepsPartsOfSeveralHistories) {
  PixelHistory all{{3, 4}}, one{{3, 4}, "first note"}, two{{3, 4}, "second note"};
  one.compare(step("a", "1", "1"));
  two.compare(step("b", "1", "2"));
  all.append(one);
  all.append(two);
  EXPECT_EQ(all.steps.size(), 2U);
  EXPECT_EQ(all.note, "first note; second note");
  EXPECT_EQ(all.differences(), 1U);
}

TEST(PixelHistory, TextOmitsDetailsExceptDifferences) {
  PixelHistory history{{3, 4}};
  history.compare(step("shown", "1", "1"));
  PixelStep detail = step("hidden", "1", "1");
  detail.detail = true;
  history.compare(detail);
  detail.item = "wrong detail";
  detail.hardware = "2";
  history.compare(detail);
  const std::string text = text_of(history, "out/report.html");
  EXPECT_NE(text.find("(3, 4): 3 steps, 1 of them differ"), std::string::npos) << text;
  EXPECT_NE(text.find("level shown"), std::string::npos) << text;
  EXPECT_EQ(text.find("hidden"), std::string::npos) << text;
  EXPECT_NE(text.find("! level wrong detail"), std::string::npos) << text;
  EXPECT_NE(text.find("1 more steps: out/report.html#pixel"), std::string::npos) << text;
}

TEST(PixelHistory, TextIsTable) {
  PixelHistory history{{3, 14}, "one fragment"};
  history.steps = {
      {.part = "fragment 0",
       .step = "level",
       .item = "of it",
       .golden = "4",
       .hardware = "2.25",
       .clock = 812,
       .differs = true},
      {.part = "fragment 0", .step = "colour", .item = "r", .golden = "", .hardware = "7"},
      {.part = "out",
       .step = "end",
       .item = "x",
       .golden = "123456789",
       .hardware = "",
       .clock = 1200,
       .detail = true},
      {.part = "out", .step = "end", .item = "y", .golden = "9", .hardware = "9", .clock = 3}};
  EXPECT_EQ(text_of(history, "r.html"),
            "pixel       (3, 14): 4 steps, 1 of them differ from the golden model: one fragment\n"
            "  step         golden  hardware      cycle\n"
            "  fragment 0\n"
            "! level of it  4       2.25            812\n"
            "  colour r     -       7                 -\n"
            "  out\n"
            "  end y        9       9                 3\n"
            "  1 more steps: r.html#pixel\n");
  EXPECT_EQ(text_of(PixelHistory{{0, 1}}, "r.html"),
            "pixel       (0, 1): 0 steps, 0 of them differ from the golden model\n");
  // At most forty rows: with thirty-nine differing rows, one more is shown.
  PixelHistory many{{0, 0}};
  for (int i = 0; i < 3; ++i) many.compare(step("right", "1", "1"));
  for (int i = 0; i < 39; ++i) many.compare(step("wrong", "1", "2"));
  const std::string text = text_of(many, "r");
  EXPECT_EQ(std::count(text.begin(), text.end(), '!'), 39);
  EXPECT_NE(text.find("  2 more steps: r#pixel"), std::string::npos) << text;
}

// The last of many rows is the wrong one.
TEST(PixelHistory, TextIsShortAndShowsDifferences) {
  PixelHistory history{{3, 4}};
  for (int i = 0; i < 200; ++i) history.compare(step("right", "1", "1"));
  history.compare(step("wrong", "1", "2"));
  const std::string text = text_of(history, "report");
  EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 50);
  EXPECT_NE(text.find("! level wrong"), std::string::npos) << text;
  for (int i = 0; i < 200; ++i) history.compare(step("wrong", "1", "2"));
  EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 50);
}

TEST(PixelHistory, ResultContainsHistory) {
  Result result;
  EXPECT_FALSE(to_json(result).contains("pixel"));
  result.pixel = PixelHistory{{3, 4}, "a note"};
  result.pixel->compare(step("N", "4", "5"));
  result.pixel->steps.push_back(
      {.part = {}, .step = "s", .item = "i", .golden = {}, .hardware = {}});
  const nlohmann::ordered_json json = to_json(result), pixel = json["pixel"];
  EXPECT_EQ(pixel["x"], 3);
  EXPECT_EQ(pixel["y"], 4);
  EXPECT_EQ(pixel["note"], "a note");
  EXPECT_EQ(pixel["differences"], 1);
  EXPECT_EQ(pixel["steps"][0], (nlohmann::ordered_json{{"part", "fragment 0"},
                                                       {"step", "level"},
                                                       {"item", "N"},
                                                       {"golden", "4"},
                                                       {"hardware", "5"},
                                                       {"clock", 12},
                                                       {"differs", true}}));
  EXPECT_TRUE(pixel["steps"][1]["clock"].is_null());
  EXPECT_TRUE(json["meaning"].contains("pixel.steps"));
}

}  // namespace
}  // namespace deburr::tb::pixel_history_test
