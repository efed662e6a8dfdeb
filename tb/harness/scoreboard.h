// SPDX-License-Identifier: MIT
// Compares outputs with expectations. A run passes only if every expected item came, no other item
// came, and at least the required number of comparisons was made.
//
// A lost, duplicated or late item counts as one mismatch, since the scoreboard resynchronises on
// the items after it.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <ostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "rtl_model/fabric/clocked.h"
#include "rtl_model/fabric/payload.h"
#include "tb/harness/verdict.h"

namespace deburr::tb {

// One mismatch: position in the run ("cycle 812"), item ("item 100", "pixel (3, 4)"), field,
// expected and actual value.
struct Difference {
  std::string check, where, item, field, expected, got;
};

// The part that is independent of the item type.
class ScoreboardBase {
 public:
  ScoreboardBase(std::string name, std::uint64_t minimum)
      : name_(std::move(name)), minimum_(minimum) {}
  virtual ~ScoreboardBase() = default;

  const std::string& name() const { return name_; }
  // Raises the minimum number of comparisons, if it is known only during the run.
  void require(std::uint64_t minimum) { minimum_ = std::max(minimum_, minimum); }
  // Fault: ignores all items and finds nothing wrong.
  void look_away() { blind_ = true; }

  std::uint64_t comparisons() const { return comparisons_; }
  std::uint64_t mismatches() const { return mismatches_; }
  virtual std::uint64_t leftovers() const = 0;  // expected items that never came
  bool passed() const { return mismatches_ == 0 && leftovers() == 0 && comparisons_ >= minimum_; }
  // The first few.
  const std::vector<Difference>& differences() const { return differences_; }
  // Throws Mismatch with the first few differences unless passed() is true.
  void check() const;

 protected:
  bool blind() const { return blind_; }
  void count() { ++comparisons_; }
  void fail(Difference difference);
  virtual std::string first_leftover() const = 0;

 private:
  static constexpr std::size_t kKept = 10;
  std::string name_;
  std::uint64_t minimum_, comparisons_ = 0, mismatches_ = 0;
  bool blind_ = false;
  std::vector<Difference> differences_;
};

// Without a key, items are compared in order. With a key, items with the same key are compared in
// order; items with different keys may come in any order.
template <class T>
class Scoreboard final : public ScoreboardBase {
 public:
  using Describe = std::function<std::string(const T&)>;
  using Key = std::function<std::uint64_t(const T&)>;

  Scoreboard(std::string name, std::uint64_t minimum, Describe describe = {}, Key key = {})
      : ScoreboardBase(std::move(name), minimum),
        describe_(std::move(describe)),
        key_(std::move(key)) {}

  // Replaces the item number in messages by a name such as "pixel (3, 4)".
  void call_items(Describe name) { name_ = std::move(name); }

  void expect(const T& value) {
    if (blind()) return;
    queue_of(value).waiting.push_back({value, number_++});
    ++waiting_;
  }
  // `where`: position in the run or cycle.
  void got(const T& value, const std::string& where = {}) {
    if (!came(value)) compare(value, where);
  }
  void got(const T& value, rtl::Cycle cycle) {
    if (!came(value)) compare(value, fmt::format("cycle {}", cycle));
  }
  std::uint64_t leftovers() const override { return waiting_; }
  // After a reset: discards pending expectations and keeps the comparisons so far.
  void restart() {
    all_ = {};
    by_key_.clear();
    waiting_ = 0;
  }

 private:
  // How many items ahead an item that came out of order is searched.
  static constexpr std::size_t kLookAhead = 64;
  struct Expected {
    T value;
    std::uint64_t number;
    friend bool operator==(const Expected& a, const T& b) { return a.value == b; }
  };
  struct Queue {
    std::deque<Expected> waiting, lost;
    std::optional<Expected> last;  // last item that came
  };
  Queue& queue_of(const T& value) { return key_ ? by_key_[key_(value)] : all_; }
  // Returns true if the item is the next expected one.
  bool came(const T& value) {
    if (blind()) return true;
    count();
    Queue& queue = queue_of(value);
    if (queue.waiting.empty() || !(queue.waiting.front().value == value)) return false;
    queue.last = queue.waiting.front();
    queue.waiting.pop_front();
    --waiting_;
    return true;
  }
  // Handles an item that is not the next expected one.
  [[gnu::noinline]] void compare(const T& value, const std::string& where) {
    Queue& queue = queue_of(value);
    auto& waiting = queue.waiting;
    // Out of order: a duplicate, a missing item that came late, or one that came early.
    if (const auto late = std::find(queue.lost.begin(), queue.lost.end(), value);
        late != queue.lost.end()) {
      fail({"", where, item(*late), "order", "it earlier", text(value)});
      queue.lost.erase(late);
      return;
    }
    const auto end = waiting.begin() +
                     static_cast<std::ptrdiff_t>(std::min<std::size_t>(waiting.size(), kLookAhead));
    const bool again = queue.last && queue.last->value == value;
    if (const auto found = std::find(waiting.begin(), end, value); !again && found != end) {
      for (auto lost = waiting.begin(); lost != found; ++lost) {
        fail({"", where, item(*lost), "order", text(lost->value),
              "nothing so far; next came " + text(value)});
        queue.lost.push_back(*lost);
        if (queue.lost.size() > kLookAhead) queue.lost.pop_front();
      }
      queue.last = *found;
      waiting_ -= static_cast<std::uint64_t>(found - waiting.begin()) + 1;
      waiting.erase(waiting.begin(), found + 1);
      return;
    }
    if (again) {
      fail({"", where, item(*queue.last), "order", "it once", "again " + text(value)});
      return;
    }
    if (waiting.empty()) {
      fail({"", where, "", "", "nothing", text(value)});
      return;
    }
    const Expected wanted = waiting.front();
    waiting.pop_front();
    --waiting_;
    queue.last = wanted;
    std::string fields;
    if constexpr (rtl::HasFields<T>) fields = rtl::payload_difference(wanted.value, value);
    fail({"", where, item(wanted), fields, text(wanted.value), text(value)});
  }
  std::string item(const Expected& e) const {
    return name_ ? name_(e.value) : fmt::format("item {}", e.number);
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
    const auto found = std::find_if(by_key_.begin(), by_key_.end(), [](const auto& entry) {
      return !entry.second.waiting.empty();
    });
    const Expected& first = (found == by_key_.end() ? all_ : found->second).waiting.front();
    return fmt::format("{}: {}", item(first), text(first.value));
  }

  Describe describe_, name_;
  Key key_;
  Queue all_;  // used without a key
  std::map<std::uint64_t, Queue> by_key_;
  std::uint64_t number_ = 0, waiting_ = 0;
};

}  // namespace deburr::tb
