// SPDX-License-Identifier: MIT
// Does the golden give the numbers of docs/morphological_smaa.md, "Vectors"? Shares of every edge
// of the patterns, the limit of the searches, frames with their counters, and the tables.
#include <gmock/gmock.h>

#include <sstream>
#include <string>
#include <vector>

#include "golden/morphological/area_table.h"
#include "golden/morphological/arithmetic.h"
#include "golden/morphological/diagonals.h"
#include "spec/morphological/parameters.h"
#include "spec/morphological/tables.h"
#include "tb/unit/golden/morphological/support.h"

namespace deburr::smaa_vectors_test {
namespace {

using golden::morphological::EdgeShares;
using golden::morphological::MorphologicalGolden;
using golden::morphological::preset_parameters;
using spec::morphological::AreaSource;
using spec::morphological::BlendRule;
using spec::morphological::DynamicLuma;
using spec::morphological::Ends;
using spec::morphological::LocalContrast;
using spec::morphological::Parameters;
using spec::morphological::Preset;
using spec::morphological::Quality;
using tb::morphological::Frame;
using tb::morphological::grey;

// ---- patterns -----------------------------------------------------------------------------------

constexpr auto kMedium = Quality::kMedium;
constexpr auto kHigh = Quality::kHigh;

// A digit is a pixel, 0 black and 1 white.
Frame drawn(const std::vector<std::string>& rows) {
  return Frame(static_cast<int>(rows.front().size()), static_cast<int>(rows.size()),
               [&](int x, int y) {
                 const char digit = rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
                 return grey(digit == '1' ? 255 : 0);
               });
}

std::ostream& put(std::ostream& out, EdgeShares s) {
  return out << int{s.first} << '/' << int{s.second};
}

// Every edge with shares: those above pixels first, then those left of them.
std::string shares_of(const MorphologicalGolden& golden) {
  std::ostringstream all;
  const char* comma = "";
  const auto list = [&](const char* name, auto&& of) {
    for (int y = 0; y < golden.height(); ++y) {
      for (int x = 0; x < golden.width(); ++x) {
        if (of(x, y) == EdgeShares{}) continue;
        put(all << comma << name << '(' << x << ',' << y << ") ", of(x, y));
        comma = ", ";
      }
    }
  };
  list("t", [&](int x, int y) { return golden.top_shares(x, y); });
  list("l", [&](int x, int y) { return golden.left_shares(x, y); });
  return all.str();
}

struct Pattern {
  const char* name;
  Quality quality;
  std::vector<std::string> rows;
  const char* shares;
  std::uint64_t taken, hash;
};

const Pattern kPatterns[] = {
    {"L",
     kHigh,
     {"00000000", "00001111", "11111111"},
     "t(4,1) 0/92, t(5,1) 0/33, t(6,1) 0/6, t(1,2) 6/0, t(2,2) 33/0, t(3,2) 92/0, l(4,1) 20/20",
     0,
     0xdc434f535507471c},
    {"Z",
     kHigh,
     {"00000000", "00000011", "00011111", "11111111"},
     "t(6,1) 0/64, t(3,2) 0/80, t(4,2) 11/11, t(5,2) 80/0, t(1,3) 11/0, t(2,3) 80/0, l(6,1) 20/20, "
     "l(3,2) 20/20",
     0,
     0xb019acef57e519cc},
    {"U 1",
     kHigh,
     {"00000", "00100", "11111"},
     "t(2,1) 0/126, t(1,2) 64/0, t(3,2) 64/0, l(2,1) 20/20, l(3,1) 20/20",
     0,
     0x958723b268d2f185},
    {"U 4",
     kHigh,
     {"000000", "011110", "111111"},
     "t(1,1) 0/106, t(2,1) 0/76, t(3,1) 0/76, t(4,1) 0/106, t(0,2) 32/0, t(5,2) 32/0, l(1,1) "
     "32/20, l(5,1) 20/32",
     0,
     0xb8be7d490bcd6ccd},
    {"T",
     kHigh,
     {"000000", "000111", "111000", "111000"},
     "t(3,1) 0/20, t(4,1) 0/7, l(3,1) 20/8",
     0,
     0x6a61b9241869d9bf},
    {"box",
     kHigh,
     {"00000000", "00000000", "00111100", "00111100", "00111100", "00111100", "00000000",
      "00000000"},
     "t(2,2) 0/27, t(3,2) 0/19, t(4,2) 0/19, t(5,2) 0/27, t(2,6) 27/0, t(3,6) 19/0, t(4,6) 19/0, "
     "t(5,6) 27/0, l(2,2) 0/27, l(6,2) 27/0, l(2,3) 0/19, l(6,3) 19/0, l(2,4) 0/19, l(6,4) 19/0, "
     "l(2,5) 0/27, l(6,5) 27/0",
     0,
     0xebc16294237c987b},
    {"dot",
     kHigh,
     {"000", "010", "000"},
     "t(1,1) 0/126, t(1,2) 126/0, l(1,1) 0/126, l(2,1) 126/0",
     0,
     0x7a6d46cfea983378},
    {"/",
     kHigh,
     {"00000000", "00000001", "00000011", "00000111", "00001111", "00011111", "00111111",
      "01111111", "11111111"},
     "t(7,1) 62/66, t(6,2) 62/66, t(5,3) 62/66, t(4,4) 62/66, t(3,5) 62/66, t(2,6) 62/66, t(1,7) "
     "62/66, t(0,8) 62/66",
     8,
     0x558a9522fb4d9117},
    {"\\",
     kHigh,
     {"00000000", "10000000", "11000000", "11100000", "11110000", "11111000", "11111100",
      "11111110", "11111111"},
     "t(0,1) 66/62, t(1,2) 66/62, t(2,3) 66/62, t(3,4) 66/62, t(4,5) 66/62, t(5,6) 66/62, t(6,7) "
     "66/62, t(7,8) 66/62, l(1,1) 32/32, l(2,2) 32/32, l(3,3) 32/32, l(4,4) 32/32, l(5,5) 32/32, "
     "l(6,6) 32/32, l(7,7) 32/32",
     8,
     0x2304187888eafbd3},
    {"/, medium",
     kMedium,
     {"00000000", "00000001", "00000011", "00000111", "00001111", "00011111", "00111111",
      "01111111", "11111111"},
     "t(7,1) 0/32, t(6,2) 32/32, t(5,3) 32/32, t(4,4) 32/32, t(3,5) 32/32, t(2,6) 32/32, t(1,7) "
     "32/32, t(0,8) 32/0, l(7,1) 32/32, l(6,2) 32/32, l(5,3) 32/32, l(4,4) 32/32, l(3,5) 32/32, "
     "l(2,6) 32/32, l(1,7) 32/32",
     0,
     0xf80969849600eed9},
    {"/ of 3",
     kHigh,
     {"000000", "000001", "000011", "000111", "111111"},
     "t(5,1) 62/49, t(4,2) 68/23, t(3,3) 84/7, t(1,4) 11/0, t(2,4) 110/0",
     4,
     0x8543d3ea87aa57c7},
    {"line", kHigh, {"0000000", "1111111", "0000000", "0000000"}, "", 0, 0x7cc1f94de234a73e},
    {"X",
     kHigh,
     {"1000001", "0100010", "0010100", "0001000", "0010100", "0100010", "1000001"},
     "t(0,1) 66/62, t(1,1) 66/62, t(5,1) 62/66, t(6,1) 62/66, t(1,2) 66/62, t(2,2) 66/62, t(4,2) "
     "62/66, t(5,2) 62/66, t(2,3) 66/62, t(3,3) 128/128, t(4,3) 62/66, t(2,4) 62/66, t(3,4) "
     "128/128, t(4,4) 66/62, t(1,5) 62/66, t(2,5) 62/66, t(4,5) 66/62, t(5,5) 66/62, t(0,6) 62/66, "
     "t(1,6) 62/66, t(5,6) 66/62, t(6,6) 66/62, l(2,1) 20/32, l(3,2) 20/8, l(5,4) 20/32, l(6,5) "
     "20/32",
     22,
     0x895be1fc39db8046},
};

TEST(SmaaPatterns, HaveTheContractsShares) {
  for (const Pattern& pattern : kPatterns) {
    SCOPED_TRACE(pattern.name);
    const Frame input = drawn(pattern.rows);
    MorphologicalGolden golden(preset_parameters(Preset::kSmaa, pattern.quality));
    Frame output = input;
    output.pixels = golden.process(input.view());
    EXPECT_EQ(shares_of(golden), pattern.shares);
    EXPECT_EQ(golden.work().diagonal_pixels, pattern.taken);
    EXPECT_EQ(hash(output), pattern.hash);
  }
}

// ---- the limit of the searches ------------------------------------------------------------------

struct Limit {
  int length;
  const char* shares;
};

const Limit kLimits[] = {
    {7, "0/108 0/71 1/39 15/15 39/1 71/0 108/0"},
    {8, "0/111 0/77 1/47 3/20 20/3 47/1 77/0 111/0"},
    {9, "0/113 0/83 1/54 2/29 4/4 29/2 54/1 83/0 111/0"},
    {10, "0/113 0/88 1/61 1/37 3/13 13/3 37/1 61/1 83/0 111/0"},
    {16, "0/113 0/88 0/67 0/52 0/38 0/30 0/22 6/14 11/0 17/0 24/0 31/0 45/0 61/0 83/0 111/0"},
    {17, "0/113 0/88 0/67 0/52 0/38 0/30 0/22 0/14 6/0 11/0 17/0 24/0 31/0 45/0 61/0 83/0 111/0"},
    {18,
     "0/113 0/88 0/67 0/52 0/38 0/30 0/22 0/14 0/0 6/0 11/0 17/0 24/0 31/0 45/0 61/0 83/0 111/0"},
    {19,
     "0/113 0/88 0/67 0/52 0/38 0/30 0/22 0/14 0/0 0/0 6/0 11/0 17/0 24/0 31/0 45/0 61/0 83/0 "
     "111/0"},
};

// A Z of `length` pixels in row 2 from column 1 on.
Frame lone_z(int length) {
  return Frame(length + 2, 4, [&](int x, int y) {
    const bool white = y == 3 || (y == 2 && x > 0) || (y == 1 && x > length);
    return grey(white ? 255 : 0);
  });
}

TEST(SmaaLimits, CutTheSearchesOfEachPixel) {
  for (const Limit& limit : kLimits) {
    MorphologicalGolden golden(preset_parameters(Preset::kSmaa, Quality::kLow));
    const Frame frame = lone_z(limit.length);
    golden.process(frame.view());
    std::ostringstream shares;
    for (int x = 1; x <= limit.length; ++x)
      put(shares << (x > 1 ? " " : ""), golden.top_shares(x, 2));
    EXPECT_EQ(shares.str(), limit.shares) << limit.length;
  }
}

// ---- frames -------------------------------------------------------------------------------------

struct Vector {
  const char* image;
  const char* rules;
  Preset preset;
  Quality quality;
  void (*change)(Parameters&);
  std::uint64_t hash;
  std::uint64_t edges, runs, long_runs, taken, blended;
};

void PrintTo(const Vector& v, std::ostream* out) { *out << v.image << ' ' << v.rules; }

Frame image(const std::string& name) {
  if (name == "noise") return tb::morphological::noise_image();
  if (name == "line") return tb::morphological::line_image();
  if (name == "shades") return tb::morphological::shades_image();
  return tb::morphological::blocks_image();
}

const Vector kVectors[] = {
    {"noise", "smaa low", Preset::kSmaa, Quality::kLow, [](Parameters&) {}, 0x605145727a436382,
     4407, 4436, 0, 0, 3623},
    {"noise", "smaa medium", Preset::kSmaa, Quality::kMedium, [](Parameters&) {},
     0x605145727a436382, 4407, 4436, 0, 0, 3623},
    {"noise", "smaa high", Preset::kSmaa, Quality::kHigh, [](Parameters&) {}, 0x3d8c8d3867fd2bcc,
     4407, 4436, 0, 233, 3645},
    {"noise", "smaa ultra", Preset::kSmaa, Quality::kUltra, [](Parameters&) {}, 0x3d8c8d3867fd2bcc,
     4407, 4436, 0, 233, 3645},
    {"line", "smaa low", Preset::kSmaa, Quality::kLow, [](Parameters&) {}, 0x6d7640674377e6eb, 436,
     243, 0, 0, 491},
    {"line", "smaa medium", Preset::kSmaa, Quality::kMedium, [](Parameters&) {}, 0x5729d03a1f181768,
     436, 243, 0, 0, 491},
    {"line", "smaa high", Preset::kSmaa, Quality::kHigh, [](Parameters&) {}, 0x1038e74b0d3dfd71,
     436, 243, 0, 44, 480},
    {"line", "smaa ultra", Preset::kSmaa, Quality::kUltra, [](Parameters&) {}, 0x1038e74b0d3dfd71,
     436, 243, 0, 44, 480},
    {"blocks", "smaa low", Preset::kSmaa, Quality::kLow, [](Parameters&) {}, 0x21fbea358d934b64,
     1549, 1127, 0, 0, 1331},
    {"blocks", "smaa medium", Preset::kSmaa, Quality::kMedium, [](Parameters&) {},
     0xe378f8a6cdf4e692, 1549, 1127, 0, 0, 1371},
    {"blocks", "smaa high", Preset::kSmaa, Quality::kHigh, [](Parameters&) {}, 0x7091425e2ea8d179,
     1549, 1127, 0, 4, 1372},
    {"blocks", "smaa ultra", Preset::kSmaa, Quality::kUltra, [](Parameters&) {}, 0x8e93f1ba695ffc8a,
     1808, 1331, 0, 8, 1608},
    {"blocks", "smaa-dynamic high", Preset::kSmaaDynamic, Quality::kHigh, [](Parameters&) {},
     0x8954dcb4dfbc0839, 1698, 1232, 0, 4, 1502},
    {"blocks", "smaa high, blend longest", Preset::kSmaa, Quality::kHigh,
     [](Parameters& p) { p.blend = BlendRule::kLongest; }, 0x3394fabdc8ce9a00, 1549, 1127, 0, 4,
     1372},
    {"blocks", "smaa high, linear_light off", Preset::kSmaa, Quality::kHigh,
     [](Parameters& p) { p.linear_light = false; }, 0x04a67b4d5a8b7973, 1549, 1127, 0, 4, 1372},
    {"blocks", "smaa high, area analytic", Preset::kSmaa, Quality::kHigh,
     [](Parameters& p) { p.area = AreaSource::kAnalytic; }, 0xc0ea4a726d0468d5, 1549, 1127, 0, 4,
     1311},
    {"blocks", "smaa high, no diagonals, no corners", Preset::kSmaa, Quality::kHigh,
     [](Parameters& p) {
       p.diagonals = false;
       p.round_corners = false;
     },
     0x475b72ab303e54ac, 1549, 1127, 0, 0, 1376},
    {"blocks", "smaa high, ends gaps", Preset::kSmaa, Quality::kHigh,
     [](Parameters& p) { p.ends = Ends::kGaps; }, 0x3695452169102f8d, 1549, 1034, 0, 4, 1283},
    {"blocks", "smaa high, R, C = 9, 9, diagonal_steps 8", Preset::kSmaa, Quality::kHigh,
     [](Parameters& p) {
       p.window_rows = 20;
       p.reach_columns = 9;
       p.diagonal_steps = 8;
     },
     0x318127a57f0754f1, 1549, 1127, 13, 4, 1269},
    {"blocks", "smaa high, corner_rounding 256", Preset::kSmaa, Quality::kHigh,
     [](Parameters& p) { p.corner_rounding = 256; }, 0xcd1f206fe12a7f9f, 1549, 1127, 0, 4, 1376},
    {"blocks", "mlaa with ends crossings, diagonals 16, corners 64", Preset::kMlaa, Quality::kHigh,
     [](Parameters& p) {
       p.ends = Ends::kCrossings;
       p.diagonals = true;
       p.diagonal_steps = 16;
       p.round_corners = true;
       p.corner_rounding = 64;
     },
     0x79094ad57908c708, 1595, 1179, 0, 4, 1407},
    {"blocks", "smaa high, local contrast paper", Preset::kSmaa, Quality::kHigh,
     [](Parameters& p) { p.local_contrast = LocalContrast::kPaper; }, 0x7091425e2ea8d179, 1549,
     1127, 0, 4, 1372},
    {"blocks", "smaa ultra, search_steps 1, diagonal_steps 2", Preset::kSmaa, Quality::kUltra,
     [](Parameters& p) {
       p.search_steps = 1;
       p.diagonal_steps = 2;
     },
     0x890ac47d7405b8c7, 1808, 1331, 0, 2, 1407},
    {"shades", "smaa high", Preset::kSmaa, Quality::kHigh, [](Parameters&) {}, 0x707dcf0adeff2653,
     722, 233, 0, 0, 740},
    {"shades", "smaa high, T = 514", Preset::kSmaa, Quality::kHigh,
     [](Parameters& p) { p.threshold = 514; }, 0x6efbd85401fe9778, 1763, 745, 0, 0, 1446},
    {"shades", "smaa high, T = 514, local contrast paper", Preset::kSmaa, Quality::kHigh,
     [](Parameters& p) {
       p.threshold = 514;
       p.local_contrast = LocalContrast::kPaper;
     },
     0xcbdfbd0fa8c57f10, 1750, 739, 0, 0, 1455},
    {"shades", "smaa-dynamic high", Preset::kSmaaDynamic, Quality::kHigh, [](Parameters&) {},
     0xcbdfbd0fa8c57f10, 1750, 739, 0, 0, 1455},
    {"shades", "smaa-dynamic high, floor 1", Preset::kSmaaDynamic, Quality::kHigh,
     [](Parameters& p) { p.floor = 1; }, 0x2a0a4529eba2b538, 2771, 1813, 0, 19, 2203},
    {"shades", "smaa-dynamic high, alpha 13107", Preset::kSmaaDynamic, Quality::kHigh,
     [](Parameters& p) { p.alpha = 13107; }, 0x09daa7e5f48a7931, 1596, 663, 0, 0, 1353},
    {"shades", "smaa-dynamic high, current, alpha 52429, floor 1", Preset::kSmaaDynamic,
     Quality::kHigh,
     [](Parameters& p) {
       p.dynamic_luma = DynamicLuma::kCurrent;
       p.alpha = 52429;
       p.floor = 1;
     },
     0x86b25eb49b0d2fee, 1233, 837, 0, 10, 893},
    {"shades", "smaa-dynamic high, max, alpha 52429, floor 1", Preset::kSmaaDynamic, Quality::kHigh,
     [](Parameters& p) {
       p.dynamic_luma = DynamicLuma::kMax;
       p.alpha = 52429;
       p.floor = 1;
     },
     0xba424a04a7396185, 901, 531, 0, 6, 603},
    {"shades", "smaa-dynamic high, min, alpha 52429, floor 1", Preset::kSmaaDynamic, Quality::kHigh,
     [](Parameters& p) {
       p.dynamic_luma = DynamicLuma::kMin;
       p.alpha = 52429;
       p.floor = 1;
     },
     0x1a3348ed21c1d79c, 2068, 1224, 0, 15, 1672},
    {"shades", "smaa-dynamic high, mean, alpha 52429, floor 1", Preset::kSmaaDynamic,
     Quality::kHigh,
     [](Parameters& p) {
       p.dynamic_luma = DynamicLuma::kMean;
       p.alpha = 52429;
       p.floor = 1;
     },
     0x5e97e28f2b5f7944, 1661, 826, 0, 6, 1330},
};

class SmaaVector : public testing::TestWithParam<Vector> {};

TEST_P(SmaaVector, IsReproduced) {
  const Vector& v = GetParam();
  Parameters p = preset_parameters(v.preset, v.quality);
  v.change(p);
  const Frame input = image(v.image);
  for (const auto detail :
       {MorphologicalGolden::Detail::kPixels, MorphologicalGolden::Detail::kEverything}) {
    MorphologicalGolden golden(p, detail);
    Frame output = input;
    output.pixels = golden.process(input.view());
    EXPECT_EQ(hash(output), v.hash);
    const spec::morphological::Work& w = golden.work();
    EXPECT_EQ(w.edge_pixels, v.edges);
    EXPECT_EQ(w.horizontal_runs + w.vertical_runs, v.runs);
    EXPECT_EQ(w.long_runs, v.long_runs);
    EXPECT_EQ(w.diagonal_pixels, v.taken);
    EXPECT_EQ(w.blended_pixels, v.blended);
  }
}

INSTANTIATE_TEST_SUITE_P(Contract, SmaaVector, testing::ValuesIn(kVectors));

// ---- tables -------------------------------------------------------------------------------------

// FNV-1a of bytes, as the frames are hashed.
class ByteHash {
 public:
  void byte(std::uint64_t value) { hash_ = (hash_ ^ (value & 255)) * 1099511628211u; }
  void bytes(std::uint64_t value, int count) {  // highest first
    for (int i = count - 1; i >= 0; --i) byte(value >> (8 * i));
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 1469598103934665603u;
};

std::uint64_t hash_of(const golden::morphological::AreaTile& tile) {
  ByteHash hash;
  for (const auto& row : tile)
    for (const std::uint8_t entry : row) hash.byte(entry);
  return hash.value();
}

TEST(SmaaTables, HaveTheContractsHashes) {
  EXPECT_EQ(hash_of(golden::morphological::half_tile()), 0x08fb6f2f5185e12bu);
  EXPECT_EQ(hash_of(golden::morphological::dip_tile()), 0x4091cb22adf7523au);
  ByteHash roots, mix, diagonals;
  for (int d = 0; d < spec::morphological::kTableDistances; ++d)
    roots.bytes(static_cast<std::uint64_t>(golden::morphological::table_root(d)), 2);
  EXPECT_EQ(roots.value(), 0x0cdd319ff9fc3614u);
  for (int s = 0; s < spec::morphological::kMixSums; ++s)
    mix.bytes(golden::morphological::mix_reciprocal(s), 3);
  EXPECT_EQ(mix.value(), 0xd96f58a228eff378u);
  for (int e1 = 0; e1 < 4; ++e1)
    for (int e2 = 0; e2 < 4; ++e2)
      for (int d1 = 0; d1 < spec::morphological::kDiagonalDistances; ++d1)
        for (int d2 = 0; d2 < spec::morphological::kDiagonalDistances; ++d2) {
          const auto areas = golden::morphological::diagonal_table().at(e1, e2, d1, d2);
          diagonals.byte(areas.a);
          diagonals.byte(areas.b);
        }
  EXPECT_EQ(diagonals.value(), 0xbd207affdb832b8fu);
}

TEST(SmaaTables, GiveTheContractsShares) {
  struct Case {
    int before, after, half, dip;
  };
  for (const Case& c : {Case{0, 0, 32, 126}, Case{0, 1, 64, 89}, Case{1, 2, 33, 76},
                        Case{2, 3, 30, 67}, Case{3, 3, 15, 56}, Case{5, 7, 24, 47},
                        Case{31, 32, 7, 11}, Case{223, 224, 1, 1}, Case{0, 224, 128, 128}}) {
    // L-first-none and U-first.
    EXPECT_EQ(golden::morphological::table_shares(1, c.before, c.after),
              (EdgeShares{static_cast<std::uint8_t>(c.half), 0}))
        << c.before << ' ' << c.after;
    EXPECT_EQ(golden::morphological::table_shares(5, c.before, c.after),
              (EdgeShares{static_cast<std::uint8_t>(c.dip), 0}))
        << c.before << ' ' << c.after;
    // L-none-second: the mirror image on the other side.
    EXPECT_EQ(golden::morphological::table_shares(8, c.after, c.before),
              (EdgeShares{0, static_cast<std::uint8_t>(c.half)}));
  }
}

}  // namespace
}  // namespace deburr::smaa_vectors_test
