// SPDX-License-Identifier: MIT
#include "tb/harness/link_checker.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>
#include <utility>

#include "rtl_model/fabric/glob.h"
#include "rtl_model/fabric/ownership.h"
#include "spec/error.h"

namespace deburr::tb {
namespace {

[[noreturn, gnu::cold, gnu::noinline]] void fail(const rtl::LinkBase& link, rtl::Cycle cycle,
                                                 const std::string& what) {
  throw spec::SimulationError(fmt::format("{}: cycle {}: {} (producer {}, consumer {})",
                                          link.name(), cycle, what, link.producer(),
                                          link.consumer()));
}

template <class Word>
inline Word word(const std::byte* at) {
  Word value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

// Compares kBytes bytes; kBytes is a multiple of 4.
template <std::size_t kBytes>
inline bool differ(const std::byte* a, const std::byte* b) {
  std::uint64_t difference = 0;
  for (std::size_t at = 0; at + 8 <= kBytes; at += 8)
    difference |= word<std::uint64_t>(a + at) ^ word<std::uint64_t>(b + at);
  if constexpr (kBytes % 8 != 0)
    difference |= word<std::uint32_t>(a + kBytes - 4) ^ word<std::uint32_t>(b + kBytes - 4);
  return difference != 0;
}

constexpr std::size_t kLargest = 128;  // largest payload, in bytes, with its own template instance

}  // namespace

LinkChecker::LinkChecker(rtl::ClockDomain& clock, const std::string& glob, bool widths) {
  rtl::for_each_of<rtl::LinkBase>(clock, [&](rtl::LinkBase& link) {
    if (!rtl::glob_match(glob, link.name())) return;
    Watched watched;
    watched.link = &link;
    watched.slots = link.beat(0);
    watched.slot_bytes = static_cast<std::uint32_t>(
        link.depth() == 1 ? link.payload_bytes()
                          : static_cast<std::size_t>(link.beat(1) - link.beat(0)));
    const std::uint64_t ring_bytes = std::uint64_t{link.depth()} * watched.slot_bytes;
    DEBURR_CHECK(
        ring_bytes <= ~std::uint32_t{0},
        fmt::format("{}: a link of {} beats is too deep to check", link.name(), link.depth()));
    watched.ring_bytes = static_cast<std::uint32_t>(ring_bytes);
    watched.copies = std::make_unique<std::byte[]>(ring_bytes);
    watched.follow = widths ? &LinkChecker::follow<true> : follower_of(link.payload_bytes());
    adopt(watched);
    // A beat that is already in the link is recorded as it is.
    for (std::uint64_t n = link.pops(); n < link.pushes(); ++n)
      std::memcpy(&watched.copies[place_of(watched, n)], link.beat(n), link.payload_bytes());
    watched_.push_back(std::move(watched));
  });
  clock.add_after(*this);
}

std::uint32_t LinkChecker::place_of(const Watched& watched, std::uint64_t beat) {
  return static_cast<std::uint32_t>(beat % watched.link->depth()) * watched.slot_bytes;
}

void LinkChecker::adopt(Watched& watched) {
  watched.pushes = watched.link->pushes();
  watched.pops = watched.link->pops();
  beats_ -= watched.pops;
  watched.tail = place_of(watched, watched.pushes);
  watched.head = place_of(watched, watched.pops);
}

void (*LinkChecker::follower_of(std::size_t payload_bytes))(Watched& watched, rtl::Cycle cycle) {
  static constexpr auto kFollowers = []<std::size_t... kWords>(std::index_sequence<kWords...>) {
    return std::array{&LinkChecker::follow_stream<4 * (kWords + 1)>...};
  }
  (std::make_index_sequence<kLargest / 4>());
  return payload_bytes % 4 == 0 && payload_bytes <= kLargest ? kFollowers[payload_bytes / 4 - 1]
                                                             : &LinkChecker::follow<false>;
}

void LinkChecker::reject_counts(const Watched& w, rtl::Cycle cycle) {
  const rtl::LinkBase& link = *w.link;
  const std::uint64_t pushed = link.last_push() == cycle, popped = link.last_pop() == cycle;
  if (link.pushes() != w.pushes + pushed)
    fail(link, cycle,
         fmt::format("{} beats entered, but {} were pushed: a beat vanished or appeared",
                     link.pushes(), w.pushes + pushed));
  if (link.pops() != w.pops + popped)
    fail(link, cycle,
         fmt::format("{} beats left, but {} were popped: a beat vanished", link.pops(),
                     w.pops + popped));
  if (pushed && w.pushes - w.pops == link.depth()) fail(link, cycle, "a push into a full link");
  fail(link, cycle, "a pop of a beat that was pushed in the same cycle");
}

void LinkChecker::reject_change(const Watched& w, rtl::Cycle cycle) {
  const std::string fields = w.link->payload().difference(w.expected(), w.oldest());
  if (!fields.empty())
    fail(*w.link, cycle,
         fmt::format("beat {} changed while it waited (was/is): {}", w.pops, fields));
}

void LinkChecker::reject_width(const Watched& w, rtl::Cycle cycle) {
  if (const rtl::Field* wide = w.link->payload().misfit(w.newest()))
    fail(*w.link, cycle,
         fmt::format("beat {}: the value of {} needs more than its {} bits", w.pushes, wide->name,
                     wide->bits));
}

template <bool kWidths>
void LinkChecker::follow(Watched& w, rtl::Cycle cycle) {
  const rtl::LinkBase& link = *w.link;
  const bool pushed = link.last_push() == cycle, popped = link.last_pop() == cycle;
  const std::uint64_t before = w.pushes - w.pops;
  if (link.pushes() != w.pushes + pushed || link.pops() != w.pops + popped ||
      before + pushed > link.depth() || before < popped)
    reject_counts(w, cycle);
  if (popped) {
    // Compare raw bytes first; fields are listed only for the error message.
    if (std::memcmp(w.expected(), w.oldest(), link.payload_bytes()) != 0) reject_change(w, cycle);
    w.head = w.after(w.head);
    ++w.pops;
  }
  if (pushed) {
    std::memcpy(w.kept(), w.newest(), link.payload_bytes());
    if (kWidths) reject_width(w, cycle);
    w.tail = w.after(w.tail);
    ++w.pushes;
  }
}

// The next push and the next pop use the same slot if the link is empty or full.
template <std::size_t kBytes>
void LinkChecker::follow_beats(Watched& w, rtl::Cycle cycle) {
  const rtl::LinkBase& link = *w.link;
  const bool pushed = link.last_push() == cycle, popped = link.last_pop() == cycle;
  const bool empty = w.pushes == w.pops;
  if (link.pushes() != w.pushes + pushed || link.pops() != w.pops + popped || (popped && empty) ||
      (pushed && !empty && w.tail == w.head))
    reject_counts(w, cycle);
  if (popped) {
    if (differ<kBytes>(w.expected(), w.oldest())) reject_change(w, cycle);
    w.head = w.after(w.head);
    ++w.pops;
  }
  if (pushed) {
    std::memcpy(w.kept(), w.newest(), kBytes);
    w.tail = w.after(w.tail);
    ++w.pushes;
  }
}

// A push and a pop in the same cycle. The link was neither empty nor full, so their slots differ.
template <std::size_t kBytes>
void LinkChecker::follow_stream(Watched& w, rtl::Cycle cycle) {
  const rtl::LinkBase& link = *w.link;
  if (link.last_push() != cycle || link.last_pop() != cycle || w.tail == w.head ||
      link.pushes() != w.pushes + 1 || link.pops() != w.pops + 1 ||
      differ<kBytes>(w.expected(), w.oldest()))
    return follow_beats<kBytes>(w, cycle);
  std::memcpy(w.kept(), w.newest(), kBytes);
  w.head = w.after(w.head);
  w.tail = w.after(w.tail);
  ++w.pops;
  ++w.pushes;
}

rtl::Activity LinkChecker::tick(rtl::Cycle cycle) {
  for (Watched& watched : watched_) {
    const rtl::LinkBase& link = *watched.link;
    // Most links are idle in most cycles. A push that replaces a revoked beat leaves the count
    // unchanged, so last_push() is checked too; a pop always counts.
    const bool rests =
        link.pushes() == watched.pushes && link.pops() == watched.pops && link.last_push() != cycle;
    if (!rests) watched.follow(watched, cycle);
  }
  return rtl::kIdle;
}

void LinkChecker::reset() {
  for (Watched& watched : watched_) {
    beats_ += watched.pops;
    adopt(watched);
  }
}

std::uint64_t LinkChecker::beats() const {
  return std::accumulate(
      watched_.begin(), watched_.end(), beats_,
      [](std::uint64_t sum, const Watched& watched) { return sum + watched.pops; });
}

void LinkChecker::check_empty() const {
  std::string text;
  for (const Watched& watched : watched_)
    if (!watched.link->empty())
      text += fmt::format("\n  {}: {} beats left, {} in, {} out", watched.link->name(),
                          watched.link->occupancy(), watched.link->pushes(), watched.link->pops());
  if (!text.empty()) throw spec::SimulationError("links are not empty at the end:" + text);
}

}  // namespace deburr::tb
