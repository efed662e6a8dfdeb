// SPDX-License-Identifier: MIT
#include "tb/base/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "spec/error.h"

namespace deburr::tb {
namespace {

using spec::FileError;
namespace fs = std::filesystem;

// Closes the descriptor on every path. For reading only, so a failing close() loses no data.
class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int value() const { return value_; }

 private:
  int value_;
};

[[noreturn]] void fail(const fs::path& file, std::string_view action, int error) {
  throw FileError(fmt::format("cannot {} '{}': {}", action, file.string(), std::strerror(error)));
}

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
    DEBURR_CHECK(context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1,
                 "libcrypto offers no SHA-256");
  }
  void add(const void* bytes, std::size_t size) {
    DEBURR_CHECK(EVP_DigestUpdate(context_.get(), bytes, size) == 1, "SHA-256 update failed");
  }
  std::string hex() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int size = 0;
    DEBURR_CHECK(EVP_DigestFinal_ex(context_.get(), digest.data(), &size) == 1,
                 "SHA-256 final failed");
    std::string text;
    for (unsigned int i = 0; i < size; ++i) text += fmt::format("{:02x}", digest[i]);
    return text;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

// Calls take(bytes, size) for the rest of an open file.
template <class Take>
void read_chunks(const fs::path& file, int descriptor, Take take) {
  std::vector<char> buffer(1 << 16);
  for (;;) {
    const ssize_t got = ::read(descriptor, buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(file, "read", errno);
    if (got == 0) return;
    take(buffer.data(), static_cast<std::size_t>(got));
  }
}

// As above for the content of a regular file.
template <class Take>
void read_chunks(const fs::path& file, Take take) {
  // O_NONBLOCK: opening a pipe would otherwise wait for a writer.
  const Descriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (in.value() < 0) fail(file, "open", errno);
  struct stat info {};
  if (::fstat(in.value(), &info) != 0) fail(file, "examine", errno);
  if (!S_ISREG(info.st_mode))
    throw FileError(fmt::format("cannot read '{}': it is not a regular file", file.string()));
  read_chunks(file, in.value(), take);
}

// Appends chunks to a text, up to a size limit.
auto take_into(std::string& text, const fs::path& file, std::size_t max_bytes) {
  return [&text, &file, max_bytes](const char* bytes, std::size_t size) {
    if (text.size() + size > max_bytes)
      throw FileError(
          fmt::format("cannot read '{}': it is larger than {} bytes", file.string(), max_bytes));
    text.append(bytes, size);
  };
}

}  // namespace

bool is_there(const std::filesystem::path& path) {
  std::error_code why;
  return std::filesystem::exists(path, why);
}

bool is_folder(const std::filesystem::path& path) {
  std::error_code why;
  return std::filesystem::is_directory(path, why);
}

std::string read_file(const fs::path& file, std::size_t max_bytes) {
  std::string text;
  read_chunks(file, take_into(text, file, max_bytes));
  return text;
}

std::string read_standard_input(std::size_t max_bytes) {
  std::string text;
  const fs::path name(kStandardInput);
  read_chunks(name, STDIN_FILENO, take_into(text, name, max_bytes));
  return text;
}

std::string sha256_of_file(const fs::path& file) {
  Sha256 digest;
  read_chunks(file, [&](const char* bytes, std::size_t size) { digest.add(bytes, size); });
  return digest.hex();
}

std::string sha256(std::string_view bytes) {
  Sha256 digest;
  digest.add(bytes.data(), bytes.size());
  return digest.hex();
}

}  // namespace deburr::tb
