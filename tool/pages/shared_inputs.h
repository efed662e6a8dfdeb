// SPDX-License-Identifier: MIT
// Inputs that take long to prepare and that several runs share: scenes, mip chains, references.
// They are cached by key within a process, so that the children of a sweep's worker inherit them.
// Inputs that can be serialised are also cached in a folder that all processes of a sweep share.
//
// The key describes everything on which the content depends; the model version is added here. A
// file in the folder starts with the hash of its content, so that a damaged file is detected and
// made again. A process holds a lock while it makes a file; other processes that need the file
// wait.
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
  // Without a folder, inputs are shared only by this process and its children.
  explicit SharedInputs(std::filesystem::path folder = {}) : folder_(std::move(folder)) {}

  template <class T>
  std::shared_ptr<const T> get(const std::string& key, const std::function<T()>& make) {
    std::shared_ptr<const void>& slot = kept_[key];
    if (!slot) slot = std::make_shared<const T>(make());
    return std::static_pointer_cast<const T>(slot);
  }
  // The same for large objects used by consecutive runs: only the latest one of each `what` is
  // kept.
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
  // The bytes that `make` returns, or those cached in the folder. FileError if the folder is not
  // writable.
  std::string bytes(const std::string& key, const std::function<std::string()>& make) const;
  // Input files of the runs that share.
  InputFiles& files() { return files_; }
  // Releases objects that the next group of runs does not need.
  void forget() { kept_.clear(); }

 private:
  std::filesystem::path folder_;
  std::map<std::string, std::shared_ptr<const void>> kept_;
  std::map<std::string, std::pair<std::string, std::shared_ptr<const void>>> last_;
  InputFiles files_;
};

}  // namespace deburr::tool
