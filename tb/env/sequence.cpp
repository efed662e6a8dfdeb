// SPDX-License-Identifier: MIT
#include "tb/env/sequence.h"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <utility>

#include "spec/error.h"
#include "tb/base/file.h"
#include "tb/run/result.h"

namespace deburr::tb {
namespace {

constexpr std::string_view kPattern = "*?[", kBlanks = " \t";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

// Natural sort order: f2 before f10.
bool in_order(std::string_view a, std::string_view b) {
  while (!a.empty() && !b.empty()) {
    if (!is_digit(a.front()) || !is_digit(b.front())) {
      if (a.front() != b.front()) return a.front() < b.front();
      a.remove_prefix(1);
      b.remove_prefix(1);
      continue;
    }
    const auto number = [](std::string_view& text) {
      while (text.size() > 1 && text.front() == '0' && is_digit(text[1])) text.remove_prefix(1);
      const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
      const std::string_view digits = text.substr(0, static_cast<std::size_t>(end - text.begin()));
      text.remove_prefix(digits.size());
      return digits;
    };
    const std::string_view x = number(a), y = number(b);
    if (x.size() != y.size()) return x.size() < y.size();
    if (x != y) return x < y;
  }
  return a.size() < b.size();
}

std::vector<std::string> matching(std::string_view parameter, const std::string& pattern) {
  glob_t found{};
  const int error = ::glob(pattern.c_str(), 0, nullptr, &found);
  const std::unique_ptr<glob_t, decltype(&::globfree)> guard(&found, &::globfree);
  if (error != 0)
    throw spec::ConfigError(fmt::format("{}: no file matches '{}'", parameter, pattern));
  std::vector<std::string> files(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  std::stable_sort(files.begin(), files.end(), in_order);
  return files;
}

}  // namespace

std::vector<std::string> listed(std::string_view text) {
  std::vector<std::string> entries;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(kListSeparator, from), text.size());
    entries.emplace_back(trimmed(text.substr(from, to - from)));
    from = to + 1;
  }
  return entries;
}

std::vector<std::string> listed_files(std::string_view parameter, const std::string& text) {
  if (text.empty() || is_there(text)) return {text};
  std::vector<std::string> files;
  for (std::string& entry : listed(text)) {
    if (entry.find_first_of(kPattern) == std::string::npos || is_there(entry)) {
      files.push_back(std::move(entry));
      continue;
    }
    for (std::string& file : matching(parameter, entry)) files.push_back(std::move(file));
  }
  return files;
}

void FrameLists::add(std::string parameter, std::vector<std::string> entries) {
  if (entries.size() > 1) {
    if (std::find(entries.begin(), entries.end(), "") != entries.end())
      throw spec::ConfigError(
          fmt::format("{}: the list has an empty entry: remove a '{}'", parameter, kListSeparator));
    const int count = static_cast<int>(entries.size());
    if (frames_ > 1 && count != frames_)
      throw spec::ConfigError(fmt::format(
          "{} lists {} frames, but {} lists {}: all lists of a run must have the same length",
          longest_, frames_, parameter, count));
    frames_ = count;
    longest_ = parameter;
  }
  entries_.insert_or_assign(std::move(parameter), std::move(entries));
}

const std::string& FrameLists::at(std::string_view parameter, int frame) const {
  const auto found = entries_.find(parameter);
  DEBURR_CHECK(found != entries_.end() && !found->second.empty(),
               fmt::format("{} is not a list", parameter));
  const std::vector<std::string>& all = found->second;
  return all.size() == 1 ? all.front() : all.at(static_cast<std::size_t>(frame));
}

void add_camera(FrameLists& lists, const CameraParameters& camera) {
  lists.add("scene.eye", listed(camera.eye));
  lists.add("scene.target", listed(camera.target));
}

void choose_camera(CameraParameters& camera, const FrameLists& lists, int frame) {
  camera.eye = lists.at("scene.eye", frame);
  camera.target = lists.at("scene.target", frame);
}

void add_flicker(Result& result, const FlickerMeter& after, const FlickerMeter& before) {
  result.work.push_back({"flicker", after.mean(), "1/255",
                         "Flicker in runs of several frames (sequence.frames, lists): root mean "
                         "square of a pixel's change from frame to frame, minus the change of its "
                         "reference (without one, of the input)."});
  result.work.push_back(
      {"flicker_worst", after.worst(), "1/255", "Largest flicker between two successive frames."});
  const bool flickers = after.worst() > 0;
  result.work.push_back(
      {"flicker_worst_frame",
       flickers ? WorkValue(static_cast<std::uint64_t>(after.worst_frame())) : WorkValue(), "",
       "Second frame of that pair, counted from 0; null without flicker."});
  result.work.push_back({"flicker_before", before.mean(), "1/255", "Flicker of the input."});
}

}  // namespace deburr::tb
