// SPDX-License-Identifier: MIT
#include "tool/sweep/evolution.h"

#include <dlfcn.h>
#include <fmt/core.h>

#include "spec/error.h"

namespace deburr::tool {
namespace {

using Entry = Evolution* (*)();

// The module is searched for on the program's run path: next to the program, or in the build tree.
Evolution* load() {
  void* const module = ::dlopen(kEvolutionModule, RTLD_LAZY | RTLD_LOCAL);
  void* const symbol = module != nullptr ? ::dlsym(module, kEvolutionModuleEntry) : nullptr;
  if (symbol == nullptr)
    throw spec::FileError(
        fmt::format("a search needs the module {0}, which cannot be loaded ({1}): install pagmo "
                    "(Debian's libpagmo-dev; in the repository: scripts/demo --complete), and put "
                    "the {0} of the same build next to the program",
                    kEvolutionModule, ::dlerror()));
  return reinterpret_cast<Entry>(symbol)();
}

}  // namespace

Evolution& evolution() {
  static Evolution* const module = load();
  return *module;
}

}  // namespace deburr::tool
