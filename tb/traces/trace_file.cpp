// SPDX-License-Identifier: MIT
#include "tb/traces/trace_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "spec/error.h"

namespace deburr::tb::traces {

TraceOutput::TraceOutput(std::filesystem::path file) : file_(std::move(file)) {
  descriptor_ = ::open(file_.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail("create", errno);
  struct stat status {};
  removable_ = ::fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode);
  buffer_.reserve(2 * kChunk);
}

TraceOutput::~TraceOutput() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  remove();
}

void TraceOutput::remove() const {
  if (removable_) ::unlink(file_.c_str());
}

void TraceOutput::fail(std::string_view action, int reason) {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
    remove();
    descriptor_ = -1;
  }
  throw spec::FileError(fmt::format(
      "cannot {} '{}': {}; a trace grows with the run: make room there, trace a smaller "
      "one, or choose another directory with --out",
      action, file_.string(), std::strerror(reason)));
}

void TraceOutput::flush() {
  DEBURR_CHECK(descriptor_ >= 0, "a trace is written after its end");
  for (std::size_t done = 0; done < buffer_.size();) {
    const ssize_t count = ::write(descriptor_, buffer_.data() + done, buffer_.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("write", errno);
    done += static_cast<std::size_t>(count);
  }
  size_ += buffer_.size();
  buffer_.clear();
}

void TraceOutput::finish(std::string_view beginning) {
  flush();
  for (std::size_t done = 0; done < beginning.size();) {
    const ssize_t count = ::pwrite(descriptor_, beginning.data() + done, beginning.size() - done,
                                   static_cast<off_t>(done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("write", errno);
    done += static_cast<std::size_t>(count);
  }
  // With delayed allocation or a network file system a full disk is reported only here.
  if (::fsync(descriptor_) != 0) fail("flush", errno);
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) fail("examine", errno);
  if (static_cast<std::uint64_t>(status.st_size) != size_) fail("write all of", EIO);
  const int descriptor = std::exchange(descriptor_, -1);
  if (::close(descriptor) != 0) {
    const int reason = errno;
    remove();
    fail("close", reason);
  }
}

}  // namespace deburr::tb::traces
