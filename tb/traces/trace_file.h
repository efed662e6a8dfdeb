// SPDX-License-Identifier: MIT
// Common parts of all traces: two formats, little-endian fields, and a file written sequentially in
// bounded memory.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>

namespace deburr::tb::traces {

enum class TraceFormat : std::uint8_t { kText, kBinary };

// Values of the trace parameters.
enum class TraceChoice : std::uint8_t { kNone, kText, kBinary };
inline constexpr std::array<std::string_view, 3> kTraceChoiceNames = {"none", "text", "binary"};
inline TraceFormat format_of(TraceChoice choice) {
  return choice == TraceChoice::kBinary ? TraceFormat::kBinary : TraceFormat::kText;
}

// Least significant byte first on every host.
template <class T>
void put_little_endian(std::string& bytes, T value) {
  static_assert(std::is_unsigned_v<T>);
  for (std::size_t i = 0; i < sizeof(T); ++i)
    bytes += static_cast<char>(static_cast<std::uint8_t>(value >> (8 * i)));
}
inline void put_double(std::string& bytes, double value) {
  put_little_endian(bytes, std::bit_cast<std::uint64_t>(value));
}
// `bytes` must hold at least sizeof(T) bytes from `at` on.
template <class T>
T get_little_endian(std::string_view bytes, std::size_t at) {
  static_assert(std::is_unsigned_v<T>);
  T value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i)
    value = static_cast<T>(
        value |
        static_cast<T>(static_cast<T>(static_cast<std::uint8_t>(bytes[at + i])) << (8 * i)));
  return value;
}
inline double get_double(std::string_view bytes, std::size_t at) {
  return std::bit_cast<double>(get_little_endian<std::uint64_t>(bytes, at));
}

// Output file that appears complete or not at all if it is in a run's draft folder
// (tool/pages/run_directory.h). Every failure, such as a full disk, throws FileError, and the file
// is removed.
class TraceOutput {
 public:
  explicit TraceOutput(std::filesystem::path file);
  // Removes the file unless finish() was called.
  ~TraceOutput();
  TraceOutput(const TraceOutput&) = delete;
  TraceOutput& operator=(const TraceOutput&) = delete;

  // Buffer for the next record: append to it, then call written().
  std::string& buffer() { return buffer_; }
  void written() {
    if (buffer_.size() >= kChunk) flush();
  }
  // Overwrites the start of the file with `beginning` and flushes everything to disk; throws
  // FileError.
  void finish(std::string_view beginning = {});

 private:
  static constexpr std::size_t kChunk = std::size_t{1} << 18;
  void flush();
  void remove() const;
  [[noreturn]] void fail(std::string_view action, int reason);

  std::filesystem::path file_;
  int descriptor_ = -1;
  bool removable_ = false;  // a regular file, unlike /dev/null, which check-only runs write to
  std::uint64_t size_ = 0;
  std::string buffer_;
};

}  // namespace deburr::tb::traces
