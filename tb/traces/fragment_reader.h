// SPDX-License-Identifier: MIT
// Reads a fragment trace in either format, quad by quad, in bounded memory. Input is untrusted: any
// error is a FileError with the line or record, the expectation and a remedy.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "tb/traces/fragment_trace.h"
#include "tb/traces/trace_file.h"

namespace deburr::tb::traces {

class FragmentReader {
 public:
  // Reads the header, up to the size of the picture. `textures`: number of textures of the unit,
  // with handles from 0.
  FragmentReader(const std::filesystem::path& file, std::size_t textures);

  // Returns false after the last quad, once the file has been found complete.
  bool next(TracedQuad& quad);

  TraceFormat format() const { return format_; }
  // Width of the picture; 0: none given.
  int width() const { return width_; }
  int height() const { return height_; }
  std::uint64_t quads() const { return quads_; }  // read so far

 private:
  // A record of either format, unchecked.
  struct Record {
    FragmentRecord kind = FragmentRecord::kQuad;
    std::uint32_t texture = 0, coverage = 0xF, visible = 0xF, clamped = 0;
    bool placed = false;
    std::uint32_t x = 0, y = 0;
    std::array<double, 8> values{};
  };
  static constexpr std::size_t kMostLine = 1000;

  [[noreturn]] void fail(const std::string& what) const;
  std::size_t read(char* bytes, std::size_t count);

  void open_text();
  void open_binary();
  void set_size(std::uint64_t width, std::uint64_t height);
  bool next_line();
  void split();
  void need_fields(std::size_t count, std::string_view usage) const;
  std::uint32_t integer(std::string_view field, std::string_view name, std::uint32_t most,
                        int base = 10) const;
  double real(std::string_view field, std::string_view name) const;
  void place(Record& record, std::string_view x, std::string_view y) const;

  bool next_text(Record& record);
  bool next_binary(Record& record);
  void end_text();
  void check(const Record& record, TracedQuad& quad) const;
  void check_quad(const Record& record, TracedQuad& quad) const;
  void check_fragment(const Record& record, TracedQuad& quad) const;
  std::int32_t coordinate(double value, std::string_view name) const;

  std::filesystem::path file_;
  std::size_t textures_;
  std::ifstream input_;
  TraceFormat format_ = TraceFormat::kText;
  int width_ = 0, height_ = 0;
  std::uint64_t quads_ = 0, expected_ = 0;  // expected_: number in a binary file's header
  bool ended_ = false;
  std::uint64_t line_ = 0;
  std::string text_;
  std::vector<std::string_view> fields_;
  bool held_ = false;  // the current line has not been processed
};

// What a run must know before it starts: the whole file is read and checked.
struct FragmentSummary {
  int width = 0, height = 0;
  std::uint64_t quads = 0, fragments = 0;
};
FragmentSummary examine_fragments(const std::filesystem::path& file, std::size_t textures);

}  // namespace deburr::tb::traces
