// SPDX-License-Identifier: MIT
#include "tb/scene/image_codec.h"

#include <dlfcn.h>
#include <fmt/core.h>

#include "spec/error.h"

namespace deburr::tb {
namespace {

using Entry = const ImageCodec* (*)();

// Searched in the program's run path: next to the program, or in the build folder.
const ImageCodec* load() {
  void* const module = ::dlopen(kImageModule, RTLD_LAZY | RTLD_LOCAL);
  void* const symbol = module != nullptr ? ::dlsym(module, kImageModuleEntry) : nullptr;
  if (symbol == nullptr)
    throw spec::FileError(
        fmt::format("images can only be written as PNG, and not read: the module {0} cannot be "
                    "loaded ({1}); copy the {0} of the same build next to the program, and install "
                    "OpenImageIO (in the repository: scripts/demo --complete)",
                    kImageModule, ::dlerror()));
  return reinterpret_cast<Entry>(symbol)();
}

}  // namespace

const ImageCodec& image_codec() {
  static const ImageCodec* const codec = load();
  return *codec;
}

}  // namespace deburr::tb
