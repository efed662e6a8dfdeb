// SPDX-License-Identifier: MIT
#include "tb/traces/fragment_writer.h"

#include <fmt/format.h>

#include <iterator>

namespace deburr::tb::traces {
namespace {

double real(std::int32_t coordinate) {
  return static_cast<double>(coordinate) / spec::texture::kCoordinateOne;
}

void put_text(std::string& out, const TracedQuad& q) {
  fmt::format_to(std::back_inserter(out), "quad {} {:x} {:x} {:x} ", q.quad.texture,
                 q.quad.coverage, q.visible, q.quad.clamped);
  if (q.placed)
    fmt::format_to(std::back_inserter(out), "{} {}", q.quad.x, q.quad.y);
  else
    out += "- -";
  for (std::size_t lane = 0; lane < 4; ++lane)
    fmt::format_to(std::back_inserter(out), " {} {}", real(q.quad.s[lane]), real(q.quad.t[lane]));
  out += '\n';
}

void put_binary(std::string& out, const TracedQuad& q) {
  const auto place = [&](std::uint32_t value) { return q.placed ? value : ~std::uint32_t{0}; };
  put_little_endian(out, place(q.quad.x));
  put_little_endian(out, place(q.quad.y));
  put_little_endian(out, static_cast<std::uint8_t>(FragmentRecord::kQuad));
  for (const std::uint8_t field : {q.quad.texture, q.quad.coverage, q.visible, q.quad.clamped})
    put_little_endian(out, field);
  out.append(3, '\0');
  for (std::size_t lane = 0; lane < 4; ++lane) {
    put_double(out, real(q.quad.s[lane]));
    put_double(out, real(q.quad.t[lane]));
  }
}

}  // namespace

FragmentWriter::FragmentWriter(const std::filesystem::path& file, TraceFormat format, int width,
                               int height)
    : format_(format), width_(width), height_(height), output_(file) {
  std::string& out = output_.buffer();
  if (format == TraceFormat::kBinary) {
    out += binary_header();
    return;
  }
  out += fmt::format("{} {}\n", kFragmentTraceTitle, kFragmentTraceVersion);
  if (width > 0) out += fmt::format("size {} {}\n", width, height);
  out += "# quad texture coverage visible clamped x y s0 t0 s1 t1 s2 t2 s3 t3\n";
}

std::string FragmentWriter::binary_header() const {
  std::string out(kFragmentTraceMagic);
  put_little_endian(out, kFragmentTraceVersion);
  put_little_endian(out, static_cast<std::uint32_t>(kFragmentHeaderBytes));
  put_little_endian(out, static_cast<std::uint32_t>(kFragmentRecordBytes));
  put_little_endian(out, static_cast<std::uint32_t>(width_));
  put_little_endian(out, static_cast<std::uint32_t>(height_));
  put_little_endian(out, std::uint32_t{0});
  put_little_endian(out, quads_);
  out.resize(kFragmentHeaderBytes, '\0');
  return out;
}

void FragmentWriter::put(const TracedQuad& quad) {
  format_ == TraceFormat::kBinary ? put_binary(output_.buffer(), quad)
                                  : put_text(output_.buffer(), quad);
  ++quads_;
  output_.written();
}

void FragmentWriter::finish() {
  if (format_ == TraceFormat::kBinary) {
    output_.finish(binary_header());
    return;
  }
  output_.buffer() += fmt::format("end {}\n", quads_);
  output_.finish();
}

}  // namespace deburr::tb::traces
