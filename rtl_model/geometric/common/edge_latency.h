// SPDX-License-Identifier: MIT
// Measures the latency of an edge, from leaving the EdgeReader to the write of its last group by
// the WeightCombiner. Only lines with a pixel that passes the depth test are recorded.
//
// A measuring instrument without hardware. Each unit reports in order what happened to its oldest
// input token, so no identification is needed. Tokens that were never announced (injected faults)
// stop the measurement until the next frame.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "rtl_model/fabric/clocked.h"

namespace deburr::rtl::geometric {

class EdgeLatency {
 public:
  void leave(Cycle cycle, std::uint32_t edges) { edges_.insert(edges_.end(), edges, cycle); }
  // An edge is kept (or dropped), or will be kept if its vertices turn out valid (paired_later).
  void decided(bool kept, bool paired_later = false) {
    const auto edge = take(edges_);
    if (edge && kept) (paired_later ? chosen_ : kept_).push_back(*edge);
  }
  // An edge that waited for its vertices is kept or dropped.
  void paired(bool kept) {
    const auto edge = take(chosen_);
    if (edge && kept) kept_.push_back(*edge);
  }
  // A kept edge becomes a line or is dropped.
  void set_up(bool is_line) {
    const auto edge = take(kept_);
    if (edge && is_line) lines_.push_back(*edge);
  }
  // A group of the oldest line.
  void walk(bool last) {
    if (lines_.empty()) return;
    walked_.push_back({lines_.front(), number_});
    if (!last) return;
    lines_.pop_front();
    ++number_;
  }
  // A group has a candidate (cover), or a candidate that passed (test).
  void cover(bool any) { hand_on(walked_, covered_, any); }
  void test(bool any) { hand_on(covered_, passed_, any); }
  // Returns the latency of the previous edge if this group is the first one of another edge.
  std::optional<Cycle> write(Cycle cycle) {
    const auto group = take(passed_);
    if (!group) return std::nullopt;
    std::optional<Cycle> latency;
    if (newest_ && newest_->line != group->line) latency = written_ - newest_->left;
    newest_ = group;
    written_ = cycle;
    return latency;
  }
  // End of frame: returns the latency of the last edge.
  std::optional<Cycle> end() {
    std::optional<Cycle> latency;
    if (newest_) latency = written_ - newest_->left;
    reset();
    return latency;
  }
  void reset() {
    edges_.clear();
    chosen_.clear();
    kept_.clear();
    lines_.clear();
    for (auto* groups : {&walked_, &covered_, &passed_}) groups->clear();
    newest_.reset();
  }

 private:
  struct Group {
    Cycle left;
    std::uint64_t line;
  };
  template <class Token>
  static std::optional<Token> take(std::deque<Token>& queue) {
    if (queue.empty()) return std::nullopt;
    const Token token = queue.front();
    queue.pop_front();
    return token;
  }
  static void hand_on(std::deque<Group>& from, std::deque<Group>& to, bool any) {
    const auto group = take(from);
    if (group && any) to.push_back(*group);
  }

  std::deque<Cycle> edges_, chosen_, kept_, lines_;
  std::deque<Group> walked_, covered_, passed_;
  std::uint64_t number_ = 0;     // of the line being walked
  std::optional<Group> newest_;  // the last written group
  Cycle written_ = 0;
};

}  // namespace deburr::rtl::geometric
