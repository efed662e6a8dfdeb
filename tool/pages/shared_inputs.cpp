// SPDX-License-Identifier: MIT
#include "tool/pages/shared_inputs.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <system_error>

#include "spec/error.h"
#include "tb/base/atomic_file.h"
#include "tb/base/file.h"
#include "tool/pages/build_info.h"

namespace deburr::tool {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxInputBytes = std::size_t{4} << 30;
constexpr std::size_t kHash = 64;  // digits, followed by a line end

// The kernel releases the lock of a dead process.
class FileLock {
 public:
  explicit FileLock(const fs::path& file)
      : descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0) fail(file);
    while (::flock(descriptor_, LOCK_EX) != 0)
      if (errno != EINTR) fail(file);
  }
  ~FileLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  [[noreturn]] void fail(const fs::path& file) {
    const int reason = errno;
    if (descriptor_ >= 0) ::close(descriptor_);
    throw spec::FileError(
        fmt::format("cannot lock '{}': {}", file.string(), std::strerror(reason)));
  }
  int descriptor_;
};

std::optional<std::string> read_whole(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  std::string content = tb::read_file(file, kMaxInputBytes);
  if (content.size() <= kHash || content[kHash] != '\n') return std::nullopt;
  const std::string_view payload = std::string_view(content).substr(kHash + 1);
  if (std::string_view(content).substr(0, kHash) != tb::sha256(payload)) return std::nullopt;
  content.erase(0, kHash + 1);
  return content;
}

}  // namespace

std::string SharedInputs::bytes(const std::string& key,
                                const std::function<std::string()>& make) const {
  if (folder_.empty()) return make();
  const std::string name = tb::sha256(fmt::format("{}\n{}", build_info().model, key));
  const fs::path folder = folder_ / name.substr(0, 2);
  const fs::path file = folder / name;
  if (auto kept = read_whole(file)) return *std::move(kept);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw spec::FileError(
        fmt::format("cannot make the folder '{}': {}", folder.string(), error.message()));
  const FileLock lock(folder / (name + ".lock"));
  if (auto kept = read_whole(file)) return *std::move(kept);
  std::string payload = make();
  tb::write_file_atomically(file, fmt::format("{}\n{}", tb::sha256(payload), payload));
  return payload;
}

}  // namespace deburr::tool
