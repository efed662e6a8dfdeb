// SPDX-License-Identifier: MIT
#include "tb/traces/fragment_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <limits>
#include <utility>

#include "spec/error.h"
#include "tb/scene/rasteriser.h"

namespace deburr::tb::traces {
namespace {

constexpr std::string_view kQuadUsage =
    "quad TEXTURE COVERAGE VISIBLE CLAMPED X Y s0 t0 s1 t1 s2 t2 s3 t3";
constexpr std::string_view kFragmentUsage = "fragment TEXTURE X Y s t ds/dx dt/dx ds/dy dt/dy";
constexpr std::size_t kQuadFields = 15, kFragmentFields = 10;
constexpr std::uint64_t kMostQuads = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t kNoPlace = ~std::uint32_t{0};

}  // namespace

void FragmentReader::fail(const std::string& what) const {
  if (format_ == TraceFormat::kText)
    throw spec::FileError(fmt::format("{}:{}: {}", file_.string(), line_, what));
  throw spec::FileError(fmt::format("'{}', record {}: {}", file_.string(), quads_, what));
}

FragmentReader::FragmentReader(const std::filesystem::path& file, std::size_t textures)
    : file_(file), textures_(textures) {
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw spec::FileError(fmt::format("cannot open '{}': there is no such file", file.string()));
  if (!std::filesystem::is_regular_file(file, error))
    throw spec::FileError(fmt::format("cannot read '{}': it is not a regular file", file.string()));
  input_.open(file, std::ios::binary);
  if (!input_)
    throw spec::FileError(fmt::format("cannot open '{}': permission denied", file.string()));
  std::array<char, kFragmentTraceTitle.size()> bytes{};
  const std::string_view begins(bytes.data(), read(bytes.data(), bytes.size()));
  input_.clear();
  input_.seekg(0);
  if (begins.starts_with(kFragmentTraceMagic)) {
    open_binary();
    return;
  }
  line_ = 1;
  if (begins != kFragmentTraceTitle)
    fail(
        fmt::format("{}: a fragment trace begins with '{} {}' as text, or with the bytes '{}' "
                    "(docs/reference/traces.md)",
                    begins.empty() ? "the file is empty" : "not a fragment trace",
                    kFragmentTraceTitle, kFragmentTraceVersion, kFragmentTraceMagic));
  line_ = 0;
  open_text();
}

std::size_t FragmentReader::read(char* bytes, std::size_t count) {
  input_.read(bytes, static_cast<std::streamsize>(count));
  if (input_.bad()) throw spec::FileError(fmt::format("cannot read '{}'", file_.string()));
  return static_cast<std::size_t>(input_.gcount());
}

void FragmentReader::set_size(std::uint64_t width, std::uint64_t height) {
  if (width == 0 || height == 0 || width > kMostPictureSide || height > kMostPictureSide)
    fail(fmt::format("an image of {} x {} pixels: each side must be 1 to {}", width, height,
                     kMostPictureSide));
  width_ = static_cast<int>(width);
  height_ = static_cast<int>(height);
}

// ---- text format -------------------------------------------------------------------------------

// Reads the next non-empty, non-comment line into fields_; false at the end of the file.
bool FragmentReader::next_line() {
  if (std::exchange(held_, false)) return true;
  for (;;) {
    ++line_;
    text_.clear();
    int c = 0;
    while ((c = input_.get()) != std::ifstream::traits_type::eof() && c != '\n') {
      if (text_.size() == kMostLine)
        fail(
            fmt::format("a line of more than {} characters: is this a fragment trace?", kMostLine));
      text_ += static_cast<char>(c);
    }
    if (input_.bad()) throw spec::FileError(fmt::format("cannot read '{}'", file_.string()));
    if (c == std::ifstream::traits_type::eof()) {
      if (text_.empty()) return false;
      fail("the file is truncated in the middle of a line; write it again");
    }
    split();
    if (!fields_.empty()) return true;
  }
}

void FragmentReader::split() {
  fields_.clear();
  std::string_view rest(text_);
  rest = rest.substr(0, rest.find('#'));
  constexpr std::string_view kSpace = " \t\r";
  for (;;) {
    const std::size_t from = rest.find_first_not_of(kSpace);
    if (from == std::string_view::npos) return;
    const std::size_t to = std::min(rest.find_first_of(kSpace, from), rest.size());
    fields_.push_back(rest.substr(from, to - from));
    rest.remove_prefix(to);
  }
}

void FragmentReader::need_fields(std::size_t count, std::string_view usage) const {
  if (fields_.size() != count)
    fail(fmt::format("{} fields, expected {}: {}", fields_.size(), count, usage));
}

std::uint32_t FragmentReader::integer(std::string_view field, std::string_view name,
                                      std::uint32_t most, int base) const {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value, base);
  if (error != std::errc() || end != field.data() + field.size() || value > most)
    fail(base == 16
             ? fmt::format("{} = '{}': expected a mask of lanes, 0 to {:x} in hexadecimal", name,
                           field, most)
             : fmt::format("{} = '{}': expected a whole number, 0 to {}", name, field, most));
  return value;
}

double FragmentReader::real(std::string_view field, std::string_view name) const {
  double value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error == std::errc::result_out_of_range) return std::numeric_limits<double>::infinity();
  if (error != std::errc() || end != field.data() + field.size())
    fail(fmt::format("{} = '{}': expected a number, such as 0.25 or -1e-3", name, field));
  return value;
}

void FragmentReader::open_text() {
  if (!next_line()) fail("truncated header");
  need_fields(2, fmt::format("{} VERSION", kFragmentTraceTitle));
  if (const std::uint32_t version = integer(fields_[1], "version", 1'000'000);
      version != kFragmentTraceVersion)
    fail(fmt::format("version {}, but this program reads version {}: write the trace again",
                     version, kFragmentTraceVersion));
  if (!next_line()) fail("the file is truncated after its first line; write it again");
  if (fields_[0] != "size") {
    held_ = true;
    return;
  }
  need_fields(3, "size WIDTH HEIGHT");
  set_size(integer(fields_[1], "width", 1'000'000), integer(fields_[2], "height", 1'000'000));
}

void FragmentReader::place(Record& record, std::string_view x, std::string_view y) const {
  if (x == "-" && y == "-") return;
  constexpr std::uint32_t kMost = 1'000'000;
  record.placed = true;
  record.x = integer(x, "x", kMost);
  record.y = integer(y, "y", kMost);
}

bool FragmentReader::next_text(Record& record) {
  if (!next_line())
    fail(
        fmt::format("no line 'end {}' after the last record: the file is truncated; write it "
                    "again, or add that line if the trace is complete",
                    quads_));
  constexpr std::uint32_t kMask = 0xF, kMostTexture = 255;
  constexpr int kHex = 16;
  if (fields_[0] == "quad") {
    need_fields(kQuadFields, kQuadUsage);
    record.kind = FragmentRecord::kQuad;
    record.texture = integer(fields_[1], "texture", kMostTexture);
    record.coverage = integer(fields_[2], "coverage", kMask, kHex);
    record.visible = integer(fields_[3], "visible", kMask, kHex);
    record.clamped = integer(fields_[4], "clamped", kMask, kHex);
    place(record, fields_[5], fields_[6]);
    constexpr std::array<std::string_view, 8> kNames = {"s0", "t0", "s1", "t1",
                                                        "s2", "t2", "s3", "t3"};
    for (std::size_t i = 0; i < kNames.size(); ++i)
      record.values[i] = real(fields_[7 + i], kNames[i]);
    return true;
  }
  if (fields_[0] == "fragment") {
    need_fields(kFragmentFields, kFragmentUsage);
    record.kind = FragmentRecord::kFragment;
    record.texture = integer(fields_[1], "texture", kMostTexture);
    place(record, fields_[2], fields_[3]);
    constexpr std::array<std::string_view, 6> kNames = {"s",     "t",     "ds/dx",
                                                        "dt/dx", "ds/dy", "dt/dy"};
    for (std::size_t i = 0; i < kNames.size(); ++i)
      record.values[i] = real(fields_[4 + i], kNames[i]);
    return true;
  }
  if (fields_[0] != "end")
    fail(fmt::format("'{}': expected 'quad', 'fragment' or 'end'", fields_[0]));
  end_text();
  return false;
}

void FragmentReader::end_text() {
  need_fields(2, "end RECORDS");
  if (const std::uint32_t count =
          integer(fields_[1], "records", std::numeric_limits<std::uint32_t>::max());
      count != quads_)
    fail(fmt::format("'end {}' after {} records: records were lost or added; write the file again",
                     count, quads_));
  if (next_line()) fail("text after the line 'end'");
}

// ---- binary format -----------------------------------------------------------------------------

void FragmentReader::open_binary() {
  format_ = TraceFormat::kBinary;
  const auto reject = [this](const std::string& what) {
    throw spec::FileError(fmt::format("'{}': {}", file_.string(), what));
  };
  std::array<char, kFragmentHeaderBytes> bytes{};
  if (read(bytes.data(), bytes.size()) != bytes.size())
    reject(fmt::format("truncated header, expected {} bytes; write the file again",
                       kFragmentHeaderBytes));
  const std::string_view header(bytes.data(), bytes.size());
  const auto field = [&](std::size_t at) { return get_little_endian<std::uint32_t>(header, at); };
  if (field(8) != kFragmentTraceVersion)
    reject(fmt::format("version {}, but this program reads version {}: write the trace again",
                       field(8), kFragmentTraceVersion));
  if (field(12) != kFragmentHeaderBytes || field(16) != kFragmentRecordBytes)
    reject(fmt::format("a header of {} bytes and records of {}, expected {} and {}", field(12),
                       field(16), kFragmentHeaderBytes, kFragmentRecordBytes));
  if (field(20) != 0 || field(24) != 0) set_size(field(20), field(24));
  expected_ = get_little_endian<std::uint64_t>(header, 32);
  if (expected_ > kMostQuads)
    reject(fmt::format("{} records, but the limit is {}: split the trace into several runs",
                       expected_, kMostQuads));
  const std::uint64_t size = std::filesystem::file_size(file_);
  const std::uint64_t whole = kFragmentHeaderBytes + expected_ * kFragmentRecordBytes;
  if (size != whole)
    reject(fmt::format("the file has {} bytes, but {} records need {}: it {}; write it again", size,
                       expected_, whole, size < whole ? "is truncated" : "is too long"));
}

bool FragmentReader::next_binary(Record& record) {
  if (quads_ == expected_) return false;
  std::array<char, kFragmentRecordBytes> bytes{};
  if (read(bytes.data(), bytes.size()) != bytes.size())
    fail("the file ends here: it was changed while it was read");
  const std::string_view fields(bytes.data(), bytes.size());
  const auto byte = [&](std::size_t at) { return get_little_endian<std::uint8_t>(fields, at); };
  record.x = get_little_endian<std::uint32_t>(fields, 0);
  record.y = get_little_endian<std::uint32_t>(fields, 4);
  record.placed = record.x != kNoPlace || record.y != kNoPlace;
  if (byte(8) > 1) fail(fmt::format("kind {}: expected 0 (quad) or 1 (fragment)", byte(8)));
  record.kind = static_cast<FragmentRecord>(byte(8));
  record.texture = byte(9);
  record.coverage = byte(10);
  record.visible = byte(11);
  record.clamped = byte(12);
  if (byte(13) != 0 || byte(14) != 0 || byte(15) != 0) fail("bytes 13 to 15 must be 0");
  for (std::size_t i = 0; i < record.values.size(); ++i)
    record.values[i] = get_double(fields, 16 + 8 * i);
  return true;
}

// ---- checks ------------------------------------------------------------------------------------

bool FragmentReader::next(TracedQuad& quad) {
  if (ended_) return false;
  Record record;
  if (!(format_ == TraceFormat::kText ? next_text(record) : next_binary(record))) {
    ended_ = true;
    return false;
  }
  if (quads_ == kMostQuads)
    fail(fmt::format("more than {} records: split the trace into several runs", kMostQuads));
  quad = {};
  check(record, quad);
  quad.quad.tag = static_cast<std::uint32_t>(quads_++);
  return true;
}

void FragmentReader::check(const Record& record, TracedQuad& quad) const {
  if (record.texture >= textures_)
    fail(
        fmt::format("texture {}, but the scene has {}: expected 0 to {}; choose a scene with more "
                    "textures (--in FILE.gltf), or change the handle",
                    record.texture, textures_, textures_ - 1));
  quad.quad.texture = static_cast<std::uint8_t>(record.texture);
  if (record.placed) {
    if (width_ == 0)
      fail(
          "a position, but the trace has no image size: begin with 'size WIDTH HEIGHT' (or set the "
          "header's fields), or omit x and y");
    if (record.x >= static_cast<std::uint32_t>(width_) ||
        record.y >= static_cast<std::uint32_t>(height_))
      fail(fmt::format("position ({}, {}) is outside the image of {} x {} pixels", record.x,
                       record.y, width_, height_));
    quad.placed = true;
  }
  record.kind == FragmentRecord::kQuad ? check_quad(record, quad) : check_fragment(record, quad);
}

std::int32_t FragmentReader::coordinate(double value, std::string_view name) const {
  bool clamped = false;
  const std::int32_t snapped = snap_coordinate(value, clamped);
  if (clamped)
    fail(
        fmt::format("{} = {}: coordinates are numbers from -128 to below 128; subtract whole "
                    "repeats of the texture, or leave the fragment out",
                    name, value));
  return snapped;
}

void FragmentReader::check_quad(const Record& record, TracedQuad& quad) const {
  for (const auto& [name, mask] :
       {std::pair("coverage", record.coverage), std::pair("visible", record.visible),
        std::pair("clamped", record.clamped)})
    if (mask > 0xF)
      fail(fmt::format("{} = {:#x}: a mask of four lanes is at most 0xf", name, mask));
  if (quad.placed) {
    if (record.x % 2 != 0 || record.y % 2 != 0)
      fail(fmt::format("a quad at ({}, {}): x and y of lane 0 must be even", record.x, record.y));
    for (unsigned lane = 0; lane < 4; ++lane)
      if ((record.coverage >> lane & 1) != 0 &&
          (record.x + (lane & 1) >= static_cast<std::uint32_t>(width_) ||
           record.y + (lane >> 1) >= static_cast<std::uint32_t>(height_)))
        fail(fmt::format(
            "lane {} of the quad at ({}, {}) is covered, but outside the image of {} x {} pixels",
            lane, record.x, record.y, width_, height_));
    quad.quad.x = static_cast<std::uint16_t>(record.x);
    quad.quad.y = static_cast<std::uint16_t>(record.y);
  }
  quad.quad.coverage = static_cast<std::uint8_t>(record.coverage);
  quad.visible = static_cast<std::uint8_t>(record.visible);
  quad.quad.clamped = static_cast<std::uint8_t>(record.clamped);
  constexpr std::array<std::string_view, 8> kNames = {"s0", "t0", "s1", "t1",
                                                      "s2", "t2", "s3", "t3"};
  for (std::size_t lane = 0; lane < 4; ++lane) {
    quad.quad.s[lane] = coordinate(record.values[2 * lane], kNames[2 * lane]);
    quad.quad.t[lane] = coordinate(record.values[2 * lane + 1], kNames[2 * lane + 1]);
  }
}

// Checks a fragment and builds the quad around it: the other lanes follow from its derivatives.
void FragmentReader::check_fragment(const Record& record, TracedQuad& quad) const {
  const auto& [s, t, dsdx, dtdx, dsdy, dtdy, unused1, unused2] = record.values;
  coordinate(s, "s");
  coordinate(t, "t");
  for (std::size_t i = 2; i < 6; ++i) {
    constexpr std::array<std::string_view, 6> kNames = {"s",     "t",     "ds/dx",
                                                        "dt/dx", "ds/dy", "dt/dy"};
    coordinate(record.values[i], kNames[i]);
  }
  const int column = static_cast<int>(record.x & 1), row = static_cast<int>(record.y & 1);
  const int own = quad.placed ? column + 2 * row : 0;
  if (quad.placed) {
    quad.quad.x = static_cast<std::uint16_t>(record.x & ~1u);
    quad.quad.y = static_cast<std::uint16_t>(record.y & ~1u);
  }
  quad.quad.coverage = static_cast<std::uint8_t>(1u << own);
  quad.visible = quad.quad.coverage;
  for (int lane = 0; lane < 4; ++lane) {
    const int x = (lane & 1) - (own & 1), y = (lane >> 1) - (own >> 1);
    const auto i = static_cast<std::size_t>(lane);
    quad.quad.s[i] = coordinate(s + x * dsdx + y * dsdy, "s of a neighbour by the derivatives");
    quad.quad.t[i] = coordinate(t + x * dtdx + y * dtdy, "t of a neighbour by the derivatives");
  }
}

FragmentSummary examine_fragments(const std::filesystem::path& file, std::size_t textures) {
  FragmentReader reader(file, textures);
  FragmentSummary summary{reader.width(), reader.height(), 0, 0};
  TracedQuad quad;
  while (reader.next(quad))
    summary.fragments += static_cast<std::uint64_t>(std::popcount(quad.quad.coverage));
  summary.quads = reader.quads();
  return summary;
}

}  // namespace deburr::tb::traces
