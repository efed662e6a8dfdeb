// SPDX-License-Identifier: MIT
#include "tb/base/atomic_file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <memory>
#include <vector>

#include "spec/error.h"

namespace deburr::tb {
namespace {

namespace fs = std::filesystem;

const char* remedy(int reason) {
  switch (reason) {
    case ENOSPC:
    case EDQUOT:
      return "free some space or choose another folder";
    case EFBIG:
      return "raise the limit of file sizes (ulimit -f)";
    default:
      return "choose another folder";
  }
}

// Temporary file that is removed unless it has been renamed to its final path.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target) : target_(target) {
    static std::atomic<unsigned> serial{0};
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    path_ = folder / fmt::format(".{}.{}-{}.tmp", target.filename().string(), ::getpid(), serial++);
    descriptor_ = ::open(path_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail("create a file in the folder of");
  }
  ~TemporaryFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!renamed_ && created()) ::unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail("write");
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
  }

  // fsync() is needed: with delayed allocation or a network file system a full disk is reported
  // only here.
  void finish(std::size_t expected_size) {
    if (::fsync(descriptor_) != 0) fail("flush");
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0) fail("examine");
    if (static_cast<std::size_t>(status.st_size) != expected_size) {
      errno = EIO;
      fail("write all of");
    }
    const int descriptor = descriptor_;
    descriptor_ = -1;
    if (::close(descriptor) != 0) fail("close");
  }

  void rename() {
    if (::rename(path_.c_str(), target_.c_str()) != 0) fail("rename a temporary file to");
    renamed_ = true;
  }

 private:
  bool created() const { return !path_.empty(); }
  [[noreturn]] void fail(const char* action) {
    const int reason = errno;
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
    if (created()) ::unlink(path_.c_str());
    throw spec::FileError(fmt::format("cannot {} '{}': {}; the partial file was removed: {}",
                                      action, target_.string(), std::strerror(reason),
                                      remedy(reason)));
  }

  fs::path target_, path_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

std::unique_ptr<TemporaryFile> written(const fs::path& path, std::string_view bytes) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw spec::FileError(
        fmt::format("cannot write '{}': it exists and is not a regular file; give another name",
                    path.string()));
  }
  auto file = std::make_unique<TemporaryFile>(path);
  file->write(bytes);
  file->finish(bytes.size());
  return file;
}

}  // namespace

void write_file_atomically(const fs::path& path, std::string_view bytes) {
  write_files_atomically({{path, bytes}});
}

void write_files_atomically(std::initializer_list<FileContent> contents) {
  std::vector<std::unique_ptr<TemporaryFile>> files;
  for (const auto& [path, bytes] : contents) files.push_back(written(path, bytes));
  for (const auto& file : files) file->rename();
}

void try_to_write(const fs::path& path, std::string_view bytes) { written(path, bytes); }

}  // namespace deburr::tb
