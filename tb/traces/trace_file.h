// SPDX-License-Identifier: MIT
// What all traces have in common: two formats, little-endian fields, and a file that is written
// from its beginning to its end in bounded memory.
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

// As parameters name it.
enum class TraceChoice : std::uint8_t { kNone, kText, kBinary };
inline constexpr std::array<std::string_view, 3> kTraceChoiceNames = {"none", "text", "binary"};
inline TraceFormat format_of(TraceChoice choice) {
  return choice == TraceChoice::kBinary ? TraceFormat::kBinary : TraceFormat::kText;
}

// Least significant byte first, whatever the host has.
template <class T>
void put_little_endian(std::string& bytes, T value) {
  static_assert(std::is_unsigned_v<T>);
  for (std::size_t i = 0; i < sizeof(T); ++i)
    bytes += static_cast<char>(static_cast<std::uint8_t>(value >> (8 * i)));
}
inline void put_double(std::string& bytes, double value) {
  put_little_endian(bytes, std::bit_cast<std::uint64_t>(value));
}
// `bytes` has at least sizeof(T) of them from `at` on.
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

// A file that appears whole or not at all, if it lies in a run's draft
// (tool/pages/run_directory.h): every failure, a full disk above all, is a FileError, behind which
// it is gone.
class TraceOutput {
 public:
  explicit TraceOutput(std::filesystem::path file);
  // Without finish(): the file goes.
  ~TraceOutput();
  TraceOutput(const TraceOutput&) = delete;
  TraceOutput& operator=(const TraceOutput&) = delete;

  // Room for a record: append to it, and call written() behind it.
  std::string& buffer() { return buffer_; }
  void written() {
    if (buffer_.size() >= kChunk) flush();
  }
  // Overwrites what stands at the beginning; then everything is on the disk, or a FileError.
  void finish(std::string_view beginning = {});

 private:
  static constexpr std::size_t kChunk = std::size_t{1} << 18;
  void flush();
  void remove() const;
  [[noreturn]] void fail(std::string_view action, int reason);

  std::filesystem::path file_;
  int descriptor_ = -1;
  bool removable_ = false;  // a regular file: not /dev/null, where a run that only checks writes
  std::uint64_t size_ = 0;
  std::string buffer_;
};

}  // namespace deburr::tb::traces
