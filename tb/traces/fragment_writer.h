// SPDX-License-Identifier: MIT
// Writes a fragment trace, quad by quad, in bounded memory. Reading it gives identical quads, to
// the bit.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tb/traces/fragment_trace.h"
#include "tb/traces/trace_file.h"

namespace deburr::tb::traces {

class FragmentWriter {
 public:
  // width x height: size of the picture; 0 x 0: none, so no quad has a position. Throws FileError.
  FragmentWriter(const std::filesystem::path& file, TraceFormat format, int width, int height);
  void put(const TracedQuad& quad);
  // Completes the file or throws FileError.
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
