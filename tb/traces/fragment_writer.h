// SPDX-License-Identifier: MIT
// Writes a trace of fragments, quad by quad, in bounded memory. What is read back is what was
// written, to the bit.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tb/traces/fragment_trace.h"
#include "tb/traces/trace_file.h"

namespace deburr::tb::traces {

class FragmentWriter {
 public:
  // width x height: of the picture; 0 x 0: there is none, and no quad is placed. FileError.
  FragmentWriter(const std::filesystem::path& file, TraceFormat format, int width, int height);
  void put(const TracedQuad& quad);
  // The file is complete, or this is a FileError.
  void finish();
  std::uint64_t quads() const { return quads_; }

 private:
  std::string binary_header() const;

  TraceFormat format_;
  int width_, height_;
  std::uint64_t quads_ = 0;
  TraceOutput output_;
};

}  // namespace deburr::tb::traces
