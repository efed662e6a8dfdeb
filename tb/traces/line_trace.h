// SPDX-License-Identifier: MIT
// Writes every line request of a simulation's memory ports and optionally every cache lookup, for
// memory and cache simulators (docs/reference/traces.md).
//
//   LineTrace trace(file, options);   // after elaboration
//   ...                               // cycles
//   trace.finish();
//
// Needs bounded memory. A run without a LineTrace has no overhead.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "rtl_model/fabric/clocked.h"
#include "tb/traces/trace_file.h"

namespace deburr::tb::traces {

struct LineTraceOptions {
  std::string engine;  // name as in `deburr run`
  double clock_mhz = 0;
  TraceFormat format = TraceFormat::kText;
  bool lookups = false;
};

enum class LineEvent : std::uint8_t { kRead, kWrite, kHit, kMerged, kMiss };
inline constexpr std::array<std::string_view, 5> kLineEventNames = {"read", "write", "hit",
                                                                    "merged", "miss"};

class LineTrace {
 public:
  static constexpr std::uint32_t kVersion = 1;
  static constexpr std::string_view kMagic = "DEBURRLT";
  static constexpr std::size_t kHeaderBytes = 64, kPortBytes = 64, kRecordBytes = 24;

  // Attaches to all memory ports and, if enabled, caches. Throws ConfigError if no port makes
  // requests or lookups are enabled without a cache; FileError.
  LineTrace(const std::filesystem::path& file, const LineTraceOptions& options);
  // Detaches. Removes the file unless finish() was called.
  ~LineTrace();
  LineTrace(const LineTrace&) = delete;
  LineTrace& operator=(const LineTrace&) = delete;

  // Completes the file or throws FileError.
  void finish();
  std::uint64_t records() const { return records_; }

 private:
  struct Port {
    std::string name;
    std::uint32_t line_bytes;  // for a cache: size of its lines
    bool cache;
  };
  struct Record {
    rtl::Cycle cycle;
    std::uint64_t address;
    std::uint32_t bytes;
    LineEvent event;
    std::uint8_t port;
  };

  void attach_ports();
  void attach_caches();
  void detach();
  void begin();
  std::string binary_header() const;
  void add(const Record& record);
  void write_clock();

  LineTraceOptions options_;
  TraceOutput output_;
  std::vector<Port> ports_;
  std::vector<Record> clock_;  // of the current cycle
  std::uint64_t records_ = 0;
};

}  // namespace deburr::tb::traces
