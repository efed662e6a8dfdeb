// SPDX-License-Identifier: MIT
// What runs have in common and what takes long to make: scenes, mip chains, references. Kept by key
// within a process, so that the children of a sweep's worker inherit it, and, where it can be
// written as bytes, in a folder that all processes of a sweep share.
//
// The key says everything that the content depends on; the model version goes into it here. A file
// of the folder begins with the hash of what follows, so that a damaged one is made again. Whoever
// makes one holds a lock, and who wants the same waits for it.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "tool/pages/input_files.h"

namespace deburr::tool {

class SharedInputs {
 public:
  // Without a folder only this process and its children share.
  explicit SharedInputs(std::filesystem::path folder = {}) : folder_(std::move(folder)) {}

  template <class T>
  std::shared_ptr<const T> get(const std::string& key, const std::function<T()>& make) {
    std::shared_ptr<const void>& slot = kept_[key];
    if (!slot) slot = std::make_shared<const T>(make());
    return std::static_pointer_cast<const T>(slot);
  }
  // The same of what is large and wanted by runs that follow each other: of each `what` the last
  // one is kept.
  template <class T>
  std::shared_ptr<const T> last(const std::string& what, const std::string& key,
                                const std::function<T()>& make) {
    auto& [kept_key, slot] = last_[what];
    if (!slot || kept_key != key) {
      slot.reset();
      slot = std::make_shared<const T>(make());
      kept_key = key;
    }
    return std::static_pointer_cast<const T>(slot);
  }
  // The bytes that `make` gives, from the folder if they are there. FileError when the folder
  // cannot be written.
  std::string bytes(const std::string& key, const std::function<std::string()>& make) const;
  // Of the runs that share.
  InputFiles& files() { return files_; }
  // Lets go of what the next group of runs has no use for.
  void forget() { kept_.clear(); }

 private:
  std::filesystem::path folder_;
  std::map<std::string, std::shared_ptr<const void>> kept_;
  std::map<std::string, std::pair<std::string, std::shared_ptr<const void>>> last_;
  InputFiles files_;
};

}  // namespace deburr::tool
