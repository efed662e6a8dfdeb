// SPDX-License-Identifier: MIT
#include "tb/harness/link_checker.h"

#include <fmt/format.h>

#include <cstring>

#include "rtl_model/fabric/counters.h"
#include "rtl_model/fabric/glob.h"
#include "spec/error.h"

namespace deburr::tb {
namespace {

[[noreturn, gnu::cold, gnu::noinline]] void fail(const rtl::LinkBase& link, rtl::Cycle cycle,
                                                 const std::string& what) {
  throw spec::SimulationError(fmt::format("{}: cycle {}: {} (producer {}, consumer {})",
                                          link.name(), cycle, what, link.producer(),
                                          link.consumer()));
}

}  // namespace

LinkChecker::LinkChecker(rtl::ClockDomain& clock, const std::string& glob, bool widths)
    : widths_(widths) {
  rtl::for_each<rtl::LinkBase>([&](rtl::LinkBase& link) {
    if (!rtl::glob_match(glob, link.name())) return;
    Watched watched;
    watched.link = &link;
    watched.depth = link.depth();
    watched.slots = link.beat(0);
    watched.slot_bytes = static_cast<std::size_t>(link.beat(watched.after(0)) - link.beat(0));
    watched.payload_bytes = link.payload_bytes();
    watched.copies.resize(watched.depth * watched.payload_bytes);
    adopt(watched);
    // A beat that is there already is taken as it is.
    for (std::uint64_t n = link.pops(); n < link.pushes(); ++n) {
      const auto slot = static_cast<std::uint32_t>(n % watched.depth);
      std::memcpy(watched.copy(slot), watched.slot(slot), watched.payload_bytes);
    }
    watched_.push_back(std::move(watched));
  });
  clock.add_after(*this);
}

void LinkChecker::adopt(Watched& watched) {
  watched.pushes = watched.link->pushes();
  watched.pops = watched.link->pops();
  watched.tail = static_cast<std::uint32_t>(watched.pushes % watched.depth);
  watched.head = static_cast<std::uint32_t>(watched.pops % watched.depth);
}

void LinkChecker::reject_counts(const Watched& w, rtl::Cycle cycle) {
  const rtl::LinkBase& link = *w.link;
  const std::uint64_t pushed = link.last_push() == cycle, popped = link.last_pop() == cycle;
  if (link.pushes() != w.pushes + pushed)
    fail(link, cycle,
         fmt::format("{} beats have gone in, {} were pushed: a beat vanished or appeared",
                     link.pushes(), w.pushes + pushed));
  if (link.pops() != w.pops + popped)
    fail(link, cycle,
         fmt::format("{} beats have gone out, {} were popped: a beat vanished", link.pops(),
                     w.pops + popped));
  if (pushed && w.pushes - w.pops == w.depth) fail(link, cycle, "a push into a link that was full");
  fail(link, cycle, "a pop of a beat that was pushed in the same cycle");
}

void LinkChecker::reject_change(const Watched& w, rtl::Cycle cycle) {
  const std::string fields = w.link->payload().difference(w.copy(w.head), w.slot(w.head));
  if (!fields.empty())
    fail(*w.link, cycle,
         fmt::format("beat {} changed while it waited (was/is): {}", w.pops, fields));
}

void LinkChecker::reject_width(const Watched& w, rtl::Cycle cycle) {
  if (const rtl::Field* wide = w.link->payload().misfit(w.slot(w.tail)))
    fail(*w.link, cycle,
         fmt::format("beat {}: the value of {} needs more than its {} bits", w.pushes, wide->name,
                     wide->bits));
}

inline void LinkChecker::follow(Watched& w, rtl::Cycle cycle) {
  const rtl::LinkBase& link = *w.link;
  const bool pushed = link.last_push() == cycle, popped = link.last_pop() == cycle;
  const std::uint64_t before = w.pushes - w.pops;
  if (link.pushes() != w.pushes + pushed || link.pops() != w.pops + popped ||
      before + pushed > w.depth || before < popped) [[unlikely]]
    reject_counts(w, cycle);
  if (popped) {
    // All bytes first: the list of fields is needed for the text only.
    if (std::memcmp(w.slot(w.head), w.copy(w.head), w.payload_bytes) != 0) [[unlikely]]
      reject_change(w, cycle);
    ++w.compared;
    w.head = w.after(w.head);
    ++w.pops;
  }
  if (pushed) {
    std::memcpy(w.copy(w.tail), w.slot(w.tail), w.payload_bytes);
    if (widths_) reject_width(w, cycle);
    w.tail = w.after(w.tail);
    ++w.pushes;
  }
}

rtl::Activity LinkChecker::tick(rtl::Cycle cycle) {
  for (Watched& watched : watched_) {
    const rtl::LinkBase& link = *watched.link;
    // Most links rest in most cycles, and nothing has happened to those behind anyone's back. A
    // push may have been in the place of a beat that was taken back; a pop always counts.
    const bool rests =
        link.pushes() == watched.pushes && link.pops() == watched.pops && link.last_push() != cycle;
    if (!rests) follow(watched, cycle);
  }
  return rtl::kIdle;
}

void LinkChecker::reset() {
  for (Watched& watched : watched_) adopt(watched);
}

std::uint64_t LinkChecker::beats() const {
  std::uint64_t sum = 0;
  for (const Watched& watched : watched_) sum += watched.compared;
  return sum;
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
