// SPDX-License-Identifier: MIT
// Traces of fragments: files are read back exactly, single fragments become the quads that their
// derivatives define, and corrupt files are either rejected or read without a crash.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "spec/error.h"
#include "tb/stimuli/texture_quads.h"
#include "tb/traces/fragment_reader.h"
#include "tb/traces/fragment_writer.h"

namespace deburr::tb::traces::fragment_trace_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr std::size_t kTextures = 16;

class FragmentTrace : public testing::TestWithParam<TraceFormat> {
 protected:
  FragmentTrace()
      : file_(fs::temp_directory_path() / ("deburr_fragments_" + std::to_string(::getpid()))) {}
  ~FragmentTrace() override { fs::remove(file_); }

  std::vector<TracedQuad> read() const {
    FragmentReader reader(file_, kTextures);
    std::vector<TracedQuad> quads;
    for (TracedQuad quad; reader.next(quad);) quads.push_back(quad);
    return quads;
  }
  std::string bytes() const {
    std::ifstream in(file_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void put(const std::string& bytes) const { std::ofstream(file_, std::ios::binary) << bytes; }

  std::vector<TracedQuad> write_random(std::uint64_t seed, std::uint32_t count) const {
    constexpr int kSide = 64;
    Random random(seed);
    FragmentWriter writer(file_, GetParam(), kSide, kSide);
    std::vector<TracedQuad> quads;
    for (std::uint32_t i = 0; i < count; ++i) {
      TracedQuad quad;
      quad.quad =
          stimuli::random_quad(random, i, static_cast<std::uint8_t>(random.below(kTextures)));
      quad.visible = static_cast<std::uint8_t>(random.below(16));
      quad.placed = random.chance(800);
      if (quad.placed) {
        quad.quad.x = static_cast<std::uint16_t>(2 * random.below(kSide / 2));
        quad.quad.y = static_cast<std::uint16_t>(2 * random.below(kSide / 2));
      }
      writer.put(quad);
      quads.push_back(quad);
    }
    writer.finish();
    return quads;
  }

  fs::path file_;
};

void expect_same(const std::vector<TracedQuad>& a, const std::vector<TracedQuad>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].quad, b[i].quad) << i;
    EXPECT_EQ(a[i].visible, b[i].visible) << i;
    EXPECT_EQ(a[i].placed, b[i].placed) << i;
  }
}

TEST_P(FragmentTrace, ReadsBackExactly) {
  const std::vector<TracedQuad> written = write_random(1, 5000);
  expect_same(written, read());
  const FragmentReader reader(file_, kTextures);
  EXPECT_EQ(reader.format(), GetParam());
  EXPECT_EQ(reader.width(), 64);
  const FragmentSummary summary = examine_fragments(file_, kTextures);
  EXPECT_EQ(summary.quads, 5000u);
  EXPECT_GT(summary.fragments, 5000u);
}

TEST_P(FragmentTrace, ReadsBackWithoutSize) {
  FragmentWriter writer(file_, GetParam(), 0, 0);
  TracedQuad quad;
  quad.quad.s = {0, spec::texture::kCoordinateOne, -1, 1};
  writer.put(quad);
  writer.finish();
  expect_same({quad}, read());
  EXPECT_EQ(FragmentReader(file_, 1).width(), 0);
}

// With any byte changed, or any number of bytes cut off, it is read or rejected with a FileError.
TEST_P(FragmentTrace, CorruptFileIsReadOrRejected) {
  write_random(2, 8);
  const std::string good = bytes();
  Random random(3);
  int rejected = 0;
  for (std::size_t i = 0; i < 3000; ++i) {
    std::string bad = good;
    if (i < good.size())
      bad.resize(i);
    else
      for (std::uint32_t n = 1 + random.below(3); n > 0; --n)
        bad[random.below(static_cast<std::uint32_t>(bad.size()))] =
            static_cast<char>(random.below(256));
    put(bad);
    try {
      read();
      EXPECT_GE(i, good.size()) << "cut off at " << i;
    } catch (const spec::FileError& error) {
      ++rejected;
      EXPECT_THAT(error.what(), HasSubstr(file_.string()));
    }
  }
  EXPECT_GT(rejected, 1000);
}

TEST_P(FragmentTrace, EndsAtLastQuad) {
  write_random(4, 1);
  FragmentReader reader(file_, kTextures);
  TracedQuad quad;
  EXPECT_TRUE(reader.next(quad));
  EXPECT_FALSE(reader.next(quad));
  EXPECT_FALSE(reader.next(quad));
}

TEST_P(FragmentTrace, UnfinishedFileIsRemoved) {
  { FragmentWriter writer(file_, GetParam(), 0, 0); }
  EXPECT_FALSE(fs::exists(file_));
}

INSTANTIATE_TEST_SUITE_P(Format, FragmentTrace,
                         testing::Values(TraceFormat::kText, TraceFormat::kBinary),
                         [](const auto& format) {
                           return format.param == TraceFormat::kText ? "Text" : "Binary";
                         });

// One fragment at each position of a quad: neighbours by the derivatives, one lane covered.
TEST_F(FragmentTrace, SingleFragmentGetsItsQuad) {
  put("deburr-fragments 1\nsize 8 8\n"
      "fragment 0 2 4 0.5 0.25 0.125 0.0625 -0.25 -0.5\n"
      "fragment 1 3 5 0.5 0.25 0.125 0.0625 -0.25 -0.5\n"
      "fragment 1 - - 0.5 0.25 0.125 0.0625 -0.25 -0.5\nend 3\n");
  const std::vector<TracedQuad> quads = read();
  ASSERT_EQ(quads.size(), 3u);
  constexpr int kOne = spec::texture::kCoordinateOne;
  EXPECT_EQ(quads[0].quad.coverage, 1);
  EXPECT_THAT(quads[0].quad.s,
              testing::ElementsAre(kOne / 2, 5 * kOne / 8, kOne / 4, 3 * kOne / 8));
  EXPECT_THAT(quads[0].quad.t,
              testing::ElementsAre(kOne / 4, 5 * kOne / 16, -kOne / 4, -3 * kOne / 16));
  EXPECT_EQ(quads[1].quad.coverage, 8);
  EXPECT_EQ(quads[1].quad.texture, 1);
  EXPECT_EQ(quads[1].x(3), 3);
  EXPECT_EQ(quads[1].y(3), 5);
  EXPECT_TRUE(quads[1].shows(3));
  EXPECT_THAT(quads[1].quad.s,
              testing::ElementsAre(5 * kOne / 8, 3 * kOne / 4, 3 * kOne / 8, kOne / 2));
  EXPECT_EQ(quads[2].quad.coverage, 1);
  EXPECT_FALSE(quads[2].shows(0));
  EXPECT_EQ(quads[2].quad.s, quads[0].quad.s);
}

// The result of a file: the number of quads, or the error without the file's name.
constexpr const char* kBegin = "deburr-fragments 1\nsize 8 6\n";
constexpr const char* kValues = " 0 0 0 0 0 0 0 0\n";

std::string verdict_on(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
  try {
    const FragmentSummary summary = examine_fragments(file, 2);
    return fmt::format("{} quads, {} fragments of {} x {}", summary.quads, summary.fragments,
                       summary.width, summary.height);
  } catch (const spec::FileError& error) {
    std::string text = error.what();
    for (std::size_t at = text.find(file.string()); at != std::string::npos;
         at = text.find(file.string()))
      text.replace(at, file.string().size(), "F");
    return text;
  }
}

TEST_F(FragmentTrace, TextIsAcceptedOrErrorExplained) {
  const std::string begin = kBegin, values = kValues, quad = "quad 0 f f 0 2 4" + values;
  const std::string long_line = "#" + std::string(999, 'x') + "\n";
  const std::pair<std::string, std::string> rows[] = {
      {"",
       "F:1: the file is empty: a fragment trace begins with 'deburr-fragments 1' as text, or with "
       "the bytes 'DEBURRFT' (docs/reference/traces.md)"},
      {"deburr-fragment 1\n",
       "F:1: not a fragment trace: a fragment trace begins with 'deburr-fragments 1' as text, or "
       "with the bytes 'DEBURRFT' (docs/reference/traces.md)"},
      {"deburr-fragments 1\n", "F:2: the file is truncated after its first line; write it again"},
      {"deburr-fragments\n", "F:1: 1 fields, expected 2: deburr-fragments VERSION"},
      {"deburr-fragments 2\n",
       "F:1: version 2, but this program reads version 1: write the trace again"},
      {"deburr-fragments x\n", "F:1: version = 'x': expected a whole number, 0 to 1000000"},
      {"deburr-fragments 1\nend 0\n", "0 quads, 0 fragments of 0 x 0"},
      {begin + "end 0\n", "0 quads, 0 fragments of 8 x 6"},
      {begin + "end 0", "F:3: the file is truncated in the middle of a line; write it again"},
      {begin + "end 1\n",
       "F:3: 'end 1' after 0 records: records were lost or added; write the file again"},
      {begin + "end\n", "F:3: 1 fields, expected 2: end RECORDS"},
      {begin + "end 0\n# more\n\nend 0\n", "F:6: text after the line 'end'"},
      {begin + "end 0\n # more\n \t\r\n", "0 quads, 0 fragments of 8 x 6"},
      {begin + quad,
       "F:4: no line 'end 1' after the last record: the file is truncated; write it again, or add "
       "that line if the trace is complete"},
      {begin + quad + quad + "end 2\n", "2 quads, 8 fragments of 8 x 6"},
      {"deburr-fragments 1\nsize 0 6\nend 0\n",
       "F:2: an image of 0 x 6 pixels: each side must be 1 to 8192"},
      {"deburr-fragments 1\nsize 8 0\nend 0\n",
       "F:2: an image of 8 x 0 pixels: each side must be 1 to 8192"},
      {"deburr-fragments 1\nsize 8192 8192\nend 0\n", "0 quads, 0 fragments of 8192 x 8192"},
      {"deburr-fragments 1\nsize 8193 1\nend 0\n",
       "F:2: an image of 8193 x 1 pixels: each side must be 1 to 8192"},
      {"deburr-fragments 1\nsize 1 8193\nend 0\n",
       "F:2: an image of 1 x 8193 pixels: each side must be 1 to 8192"},
      {"deburr-fragments 1\nsize 8\nend 0\n", "F:2: 2 fields, expected 3: size WIDTH HEIGHT"},
      {begin + "size 8 6\nend 0\n", "F:3: 'size': expected 'quad', 'fragment' or 'end'"},
      {begin + "quad 0\n",
       "F:3: 2 fields, expected 15: quad TEXTURE COVERAGE VISIBLE CLAMPED X Y s0 t0 s1 t1 s2 t2 s3 "
       "t3"},
      {begin + "fragment 0 - - 0 0 0 0 0\n",
       "F:3: 9 fields, expected 10: fragment TEXTURE X Y s t ds/dx dt/dx ds/dy dt/dy"},
      {begin + "quad 2 f f 0 - -" + values,
       "F:3: texture 2, but the scene has 2: expected 0 to 1; choose a scene with more textures "
       "(--in FILE.gltf), or change the handle"},
      {begin + "quad 1 0 f 0 - -" + values + "end 1\n", "1 quads, 0 fragments of 8 x 6"},
      {begin + "quad 256 f f 0 - -" + values,
       "F:3: texture = '256': expected a whole number, 0 to 255"},
      {begin + "quad 0 10 f 0 - -" + values,
       "F:3: coverage = '10': expected a mask of lanes, 0 to f in hexadecimal"},
      {begin + "quad 0 f 10 0 - -" + values,
       "F:3: visible = '10': expected a mask of lanes, 0 to f in hexadecimal"},
      {begin + "quad 0 f f g - -" + values,
       "F:3: clamped = 'g': expected a mask of lanes, 0 to f in hexadecimal"},
      {begin + "quad 0 f f 0 2 -" + values, "F:3: y = '-': expected a whole number, 0 to 1000000"},
      {begin + "quad 0 f f 0 - 2" + values, "F:3: x = '-': expected a whole number, 0 to 1000000"},
      {begin + "quad 0 f f 0 1 2" + values,
       "F:3: a quad at (1, 2): x and y of lane 0 must be even"},
      {begin + "quad 0 f f 0 2 1" + values,
       "F:3: a quad at (2, 1): x and y of lane 0 must be even"},
      {begin + "quad 0 f f 0 6 4" + values + "end 1\n", "1 quads, 4 fragments of 8 x 6"},
      {begin + "quad 0 f f 0 8 4" + values,
       "F:3: position (8, 4) is outside the image of 8 x 6 pixels"},
      {begin + "quad 0 f f 0 6 6" + values,
       "F:3: position (6, 6) is outside the image of 8 x 6 pixels"},
      {"deburr-fragments 1\nquad 0 f f 0 0 0" + values,
       "F:2: a position, but the trace has no image size: begin with 'size WIDTH HEIGHT' (or set "
       "the header's fields), or omit x and y"},
      {"deburr-fragments 1\nquad 0 f f 0 - -" + values + "end 1\n",
       "1 quads, 4 fragments of 0 x 0"},
      {"deburr-fragments 1\nsize 7 5\nquad 0 2 f 0 6 4" + values,
       "F:3: lane 1 of the quad at (6, 4) is covered, but outside the image of 7 x 5 pixels"},
      {"deburr-fragments 1\nsize 7 5\nquad 0 4 f 0 6 4" + values,
       "F:3: lane 2 of the quad at (6, 4) is covered, but outside the image of 7 x 5 pixels"},
      {"deburr-fragments 1\nsize 7 5\nquad 0 1 f 0 6 4" + values + "end 1\n",
       "1 quads, 1 fragments of 7 x 5"},
      {begin + "quad 0 f f 0 - - 128 0 0 0 0 0 0 0\n",
       "F:3: s0 = 128: coordinates are numbers from -128 to below 128; subtract whole repeats of "
       "the texture, or leave the fragment out"},
      {begin + "quad 0 f f 0 - - 0 0 0 0 0 0 0 -129\n",
       "F:3: t3 = -129: coordinates are numbers from -128 to below 128; subtract whole repeats of "
       "the texture, or leave the fragment out"},
      {begin + "quad 0 f f 0 - - -128 127.999 0 0 0 0 0 0\nend 1\n",
       "1 quads, 4 fragments of 8 x 6"},
      {begin + "quad 0 f f 0 - - 0 0 1e999 0 0 0 0 0\n",
       "F:3: s1 = inf: coordinates are numbers from -128 to below 128; subtract whole repeats of "
       "the texture, or leave the fragment out"},
      {begin + "quad 0 f f 0 - - 0 0 0 0 0 x 0 0\n",
       "F:3: t2 = 'x': expected a number, such as 0.25 or -1e-3"},
      {begin + "fragment 0 7 5 0 0 0 0 0 0\nend 1\n", "1 quads, 1 fragments of 8 x 6"},
      {begin + "fragment 0 8 5 0 0 0 0 0 0\n",
       "F:3: position (8, 5) is outside the image of 8 x 6 pixels"},
      {begin + "fragment 0 - - 0 0 0 0 0 130\n",
       "F:3: dt/dy = 130: coordinates are numbers from -128 to below 128; subtract whole repeats "
       "of the texture, or leave the fragment out"},
      {begin + "fragment 0 - - 127 0 1 0 0 0\n",
       "F:3: s of a neighbour by the derivatives = 128: coordinates are numbers from -128 to below "
       "128; subtract whole repeats of the texture, or leave the fragment out"},
      {begin + "fragment 0 1 1 0 -127 0 2 0 0\n",
       "F:3: t of a neighbour by the derivatives = -129: coordinates are numbers from -128 to "
       "below 128; subtract whole repeats of the texture, or leave the fragment out"},
      {begin + long_line + "end 0\n", "0 quads, 0 fragments of 8 x 6"},
      {begin + "#" + long_line + "end 0\n",
       "F:3: a line of more than 1000 characters: is this a fragment trace?"}};
  for (const auto& [text, said] : rows) EXPECT_EQ(verdict_on(file_, text), said) << text;
}

// The header and one record of the binary format, with some bytes changed.
std::string binary(std::initializer_list<std::pair<std::size_t, int>> changes,
                   std::size_t records = 1) {
  std::string bytes(kFragmentTraceMagic);
  for (const std::uint32_t word : {1u, 64u, 80u, 8u, 6u, 0u}) put_little_endian(bytes, word);
  put_little_endian(bytes, std::uint64_t{records});
  bytes.resize(64, '\0');
  for (std::size_t i = 0; i < records; ++i) {
    for (const std::uint32_t word : {2u, 4u}) put_little_endian(bytes, word);
    bytes += std::string({'\0', '\1', '\xf', '\xf', '\0', '\0', '\0', '\0'});
    for (int value = 0; value < 8; ++value) put_double(bytes, 0.125 * value);
  }
  for (const auto& [at, value] : changes) bytes[at] = static_cast<char>(value);
  return bytes;
}

TEST_F(FragmentTrace, BytesAreAcceptedOrErrorExplained) {
  const std::pair<std::string, std::string> rows[] = {
      {binary({}), "1 quads, 4 fragments of 8 x 6"},
      {binary({}, 3), "3 quads, 12 fragments of 8 x 6"},
      {binary({{8, 2}}), "'F': version 2, but this program reads version 1: write the trace again"},
      {binary({{12, 65}}), "'F': a header of 65 bytes and records of 80, expected 64 and 80"},
      {binary({{16, 81}}), "'F': a header of 64 bytes and records of 81, expected 64 and 80"},
      {binary({{20, 0}}), "'F', record 0: an image of 0 x 6 pixels: each side must be 1 to 8192"},
      {binary({{20, 0}, {24, 0}}),
       "'F', record 0: a position, but the trace has no image size: begin with 'size WIDTH HEIGHT' "
       "(or set the header's fields), or omit x and y"},
      {binary({{32, 2}}),
       "'F': the file has 144 bytes, but 2 records need 224: it is truncated; write it again"},
      {binary({{32, 0}}),
       "'F': the file has 144 bytes, but 0 records need 64: it is too long; write it again"},
      {binary({{36, 1}}),
       "'F': 4294967297 records, but the limit is 4294967295: split the trace into several runs"},
      {binary({}).substr(0, 63), "'F': truncated header, expected 64 bytes; write the file again"},
      {binary({{72, 2}}), "'F', record 0: kind 2: expected 0 (quad) or 1 (fragment)"},
      {binary({{72, 1}}), "1 quads, 1 fragments of 8 x 6"},
      {binary({{73, 2}}),
       "'F', record 0: texture 2, but the scene has 2: expected 0 to 1; choose a scene with more "
       "textures (--in FILE.gltf), or change the handle"},
      {binary({{74, 16}}), "'F', record 0: coverage = 0x10: a mask of four lanes is at most 0xf"},
      {binary({{75, 16}}), "'F', record 0: visible = 0x10: a mask of four lanes is at most 0xf"},
      {binary({{76, 16}}), "'F', record 0: clamped = 0x10: a mask of four lanes is at most 0xf"},
      {binary({{74, 3}, {75, 1}, {76, 15}}), "1 quads, 2 fragments of 8 x 6"},
      {binary({{77, 1}}), "'F', record 0: bytes 13 to 15 must be 0"},
      {binary({{78, 1}}), "'F', record 0: bytes 13 to 15 must be 0"},
      {binary({{79, 1}}), "'F', record 0: bytes 13 to 15 must be 0"},
      {binary({{64, 3}}), "'F', record 0: a quad at (3, 4): x and y of lane 0 must be even"},
      {binary({{144 + 4, 6}}, 2),
       "'F', record 1: position (2, 6) is outside the image of 8 x 6 pixels"},
      {binary({{64, 255},
               {65, 255},
               {66, 255},
               {67, 255},
               {68, 255},
               {69, 255},
               {70, 255},
               {71, 255}}),
       "1 quads, 4 fragments of 8 x 6"},
      {binary({{64, 255}, {65, 255}, {66, 255}, {67, 255}}),
       "'F', record 0: position (4294967295, 4) is outside the image of 8 x 6 pixels"},
      {binary({{86, 0xF0}, {87, 0x7F}}),
       "'F', record 0: s0 = inf: coordinates are numbers from -128 to below 128; subtract whole"
       " repeats of the texture, or leave the fragment out"},
      {binary({{86, 0xF8}, {87, 0x7F}}),
       "'F', record 0: s0 = nan: coordinates are numbers from -128 to below 128; subtract whole"
       " repeats of the texture, or leave the fragment out"}};
  for (const auto& [bytes, said] : rows) EXPECT_EQ(verdict_on(file_, bytes), said);
}

TEST_F(FragmentTrace, FieldsLieWhereDocumented) {
  constexpr int kEighth = spec::texture::kCoordinateOne / 8;
  put(binary({{72, 0}, {73, 1}, {74, 7}, {75, 3}, {76, 5}}));
  const std::vector<TracedQuad> quads = read();
  ASSERT_EQ(quads.size(), 1u);
  EXPECT_THAT(quads[0].quad.s, testing::ElementsAre(0, 2 * kEighth, 4 * kEighth, 6 * kEighth));
  EXPECT_THAT(quads[0].quad.t,
              testing::ElementsAre(kEighth, 3 * kEighth, 5 * kEighth, 7 * kEighth));
  EXPECT_EQ(quads[0].quad.texture, 1);
  EXPECT_EQ(quads[0].quad.coverage, 7);
  EXPECT_EQ(quads[0].visible, 3);
  EXPECT_EQ(quads[0].quad.clamped, 5);
  EXPECT_EQ(quads[0].quad.x, 2);
  EXPECT_EQ(quads[0].quad.y, 4);
  TracedQuad unplaced = quads[0];
  unplaced.placed = false;
  for (const TraceFormat format : {TraceFormat::kText, TraceFormat::kBinary}) {
    FragmentWriter writer(file_, format, 8, 6);
    writer.put(quads[0]);
    if (format == TraceFormat::kText) writer.put(unplaced);
    writer.finish();
    const std::string text =
        "deburr-fragments 1\nsize 8 6\n"
        "# quad texture coverage visible clamped x y s0 t0 s1 t1 s2 t2 s3 t3\n"
        "quad 1 7 3 5 2 4 0 0.125 0.25 0.375 0.5 0.625 0.75 0.875\n"
        "quad 1 7 3 5 - - 0 0.125 0.25 0.375 0.5 0.625 0.75 0.875\nend 2\n";
    EXPECT_EQ(bytes(), format == TraceFormat::kText
                           ? text
                           : binary({{72, 0}, {73, 1}, {74, 7}, {75, 3}, {76, 5}}));
  }
}

}  // namespace
}  // namespace deburr::tb::traces::fragment_trace_test
