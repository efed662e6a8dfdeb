// SPDX-License-Identifier: MIT
// Triggers the error text that OpenImageIO never frees and, with an argument, leaks memory itself:
// LeakSanitizer must ignore the first and report the second.
#include <cstdio>
#include <cstring>

#include "spec/error.h"
#include "tb/scene/image_io.h"

namespace {

constexpr std::size_t kBytes = 31;
char* volatile the_only_one = nullptr;

[[gnu::noinline]] void leaks_31_bytes() {
  the_only_one = new char[kBytes];
  std::memset(the_only_one, 1, kBytes);
  the_only_one = nullptr;
}

}  // namespace

int main(int argc, char**) {
  try {
    // The signature of a PNG whose first chunk is truncated.
    deburr::tb::read_image_memory("broken.png", "\x89PNG\r\n\x1a\njunkjunkjunkjunk");
    std::puts("a broken picture was read");
    return 1;
  } catch (const deburr::spec::FileError& error) {
    std::puts(error.what());
    if (std::strstr(error.what(), "PNG read error") == nullptr)
      return 1;  // not OpenImageIO's error
  }
  if (argc > 1) leaks_31_bytes();
  return 0;
}
