// SPDX-License-Identifier: MIT
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "tb/run/result.h"
#include "tb/run/result_description.h"

namespace deburr::tb {
namespace {

// Visitor that collects every key that a run may have.
class ResultKeys {
 public:
  ResultKeys() { describe(Result{}, *this); }
  std::span<const Statistic> all() const { return rows_; }

  bool has(bool) const { return true; }
  template <class T>
  void value(std::string_view name, const T& value, std::string_view unit,
             std::string_view meaning) {
    within(name, [&] { item(value, unit, meaning); });
  }
  template <class Body>
  void group(std::string_view name, const Body& body) {
    within(name, body);
  }
  template <class Items, class Key, class Body>
  void each(std::string_view name, const Items&, Key, const Body& body) {
    within(name, [&] { within("*", [&] { body(typename Items::value_type{}); }); });
  }
  template <class T>
  void item(const T&, std::string_view unit, std::string_view meaning, std::string_view = {}) {
    rows_.push_back({names_.emplace_back(path_), unit, meaning});
  }
  template <class T>
  void declared_item(const T&, std::string_view, std::string_view) {}

 private:
  template <class Body>
  void within(std::string_view name, const Body& body) {
    const std::size_t length = path_.size();
    if (!path_.empty()) path_ += '.';
    path_ += name;
    body();
    path_.resize(length);
  }

  std::string path_;
  std::deque<std::string> names_;
  std::vector<Statistic> rows_;
};

}  // namespace

std::span<const Statistic> statistics() {
  static const ResultKeys keys;
  return keys.all();
}

}  // namespace deburr::tb
