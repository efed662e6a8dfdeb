// SPDX-License-Identifier: MIT
// Compares what came with what was expected. A run passes only if everything expected came, nothing
// else did, and there were at least as many comparisons as the test promised.
#pragma once

#include <fmt/format.h>

#include <concepts>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <ostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "rtl_model/fabric/payload.h"
#include "tb/harness/verdict.h"

namespace deburr::tb {

// The part that does not depend on what is compared.
class ScoreboardBase {
 public:
  ScoreboardBase(std::string name, std::uint64_t minimum)
      : name_(std::move(name)), minimum_(minimum) {}
  virtual ~ScoreboardBase() = default;

  std::uint64_t comparisons() const { return comparisons_; }
  std::uint64_t mismatches() const { return mismatches_; }
  virtual std::uint64_t leftovers() const = 0;  // expected, but they never came
  bool passed() const { return mismatches_ == 0 && leftovers() == 0 && comparisons_ >= minimum_; }
  // Throws Mismatch with the first few differences unless passed().
  void check() const;

 protected:
  void count() { ++comparisons_; }
  void fail(const std::string& text);
  virtual std::string first_leftover() const = 0;

 private:
  static constexpr std::size_t kKept = 10;
  std::string name_;
  std::uint64_t minimum_, comparisons_ = 0, mismatches_ = 0;
  std::vector<std::string> texts_;
};

// In order by default; with a key, in any order between keys and in order within one.
template <class T>
class Scoreboard final : public ScoreboardBase {
 public:
  using Describe = std::function<std::string(const T&)>;
  using Key = std::function<std::uint64_t(const T&)>;

  Scoreboard(std::string name, std::uint64_t minimum, Describe describe = {}, Key key = {})
      : ScoreboardBase(std::move(name), minimum),
        describe_(std::move(describe)),
        key_(std::move(key)) {}

  void expect(const T& value) {
    expected_[key_ ? key_(value) : 0].push_back({value, number_++});
    ++waiting_;
  }
  void got(const T& value, const std::string& where = {}) {
    count();
    const auto found = expected_.find(key_ ? key_(value) : 0);
    if (found == expected_.end()) {
      fail(fmt::format("{}got {}, expected nothing", prefix(where), text(value)));
      return;
    }
    const Expected wanted = found->second.front();
    found->second.pop_front();
    if (found->second.empty()) expected_.erase(found);
    --waiting_;
    if (wanted.value == value) return;
    std::string mismatch = fmt::format("{}item {}: expected {}, got {}", prefix(where),
                                       wanted.number, text(wanted.value), text(value));
    if constexpr (rtl::HasFields<T>)
      mismatch += fmt::format(" (expected/got: {})", rtl::payload_difference(wanted.value, value));
    fail(mismatch);
  }
  std::uint64_t leftovers() const override { return waiting_; }
  // After a reset: what was expected will not come; comparisons so far count.
  void restart() {
    expected_.clear();
    waiting_ = 0;
  }

 private:
  struct Expected {
    T value;
    std::uint64_t number;
  };
  static std::string prefix(const std::string& where) {
    return where.empty() ? std::string() : where + ": ";
  }
  std::string text(const T& value) const {
    if (describe_) return describe_(value);
    if constexpr (rtl::HasFields<T>) {
      return rtl::payload_text(value);
    } else if constexpr (requires(std::ostream & stream) { stream << value; }) {
      std::ostringstream stream;
      stream << value;
      return stream.str();
    } else {
      std::string hex;
      const auto* bytes = reinterpret_cast<const unsigned char*>(&value);
      for (std::size_t i = 0; i < sizeof(T); ++i) hex += fmt::format("{:02x}", bytes[i]);
      return hex;
    }
  }
  std::string first_leftover() const override {
    const Expected& first = expected_.begin()->second.front();
    return fmt::format("item {}: {}", first.number, text(first.value));
  }

  Describe describe_;
  Key key_;
  std::map<std::uint64_t, std::deque<Expected>> expected_;
  std::uint64_t number_ = 0, waiting_ = 0;
};

}  // namespace deburr::tb
