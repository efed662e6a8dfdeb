// SPDX-License-Identifier: MIT
// Measures how long an edge is under way: from its record's leaving the EdgeReader to its last
// group's being written by the WeightCombiner. Of edges that are lines with a pixel that passes.
//
// Each unit says in its turn what became of the oldest token in front of it; everything is in
// order, so nothing else is needed to know whose it is. A measuring instrument: no hardware. Tokens
// that were never announced (injected faults) end it until the next frame.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "rtl_model/fabric/clocked.h"

namespace deburr::rtl::geometric {

class EdgeLatency {
 public:
  void leave(Cycle cycle, std::uint32_t edges) { edges_.insert(edges_.end(), edges, cycle); }
  // Of an edge: whether it is kept, or is to be once its vertices are known.
  void decided(bool kept, bool paired_later = false) {
    const auto edge = take(edges_);
    if (edge && kept) (paired_later ? chosen_ : kept_).push_back(*edge);
  }
  // Of an edge that was to be: whether it is kept.
  void paired(bool kept) {
    const auto edge = take(chosen_);
    if (edge && kept) kept_.push_back(*edge);
  }
  // Of a kept edge: whether it is a line.
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
  // Of a group: whether a candidate is in it, and whether one of them passed.
  void cover(bool any) { hand_on(walked_, covered_, any); }
  void test(bool any) { hand_on(covered_, passed_, any); }
  // The latency of the edge before, if this group is the first one of another.
  std::optional<Cycle> write(Cycle cycle) {
    const auto group = take(passed_);
    if (!group) return std::nullopt;
    std::optional<Cycle> latency;
    if (newest_ && newest_->line != group->line) latency = written_ - newest_->left;
    newest_ = group;
    written_ = cycle;
    return latency;
  }
  // The frame's end: the latency of its last edge.
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
  std::uint64_t number_ = 0;     // of the line that is walked
  std::optional<Group> newest_;  // the last one that was written
  Cycle written_ = 0;
};

}  // namespace deburr::rtl::geometric
